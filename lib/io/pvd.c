// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/pvd.h"

#include <errno.h>
#include <expat.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "io/load.h"
#include "io/replace.h"

static const double SAME_TIME = 1e-9;  // seconds
enum { LONGEST_FILE = 64 << 20 };      // bytes of a PVD that is read
enum { UNWRITTEN_PART = 64 };          // of the frames that may lack in the file: else a long list is written too often

typedef struct pvd_frame {
  double time;  // seconds
  char *file;   // owned
} pvd_frame;

struct vsc_pvd {
  char *file;
  size_t count, room;
  size_t written;  // frames that the file has
  pvd_frame *frames;
  FILE *lines;  // the frames' lines as they stand in the file, in memory:
  char *text;   // text_size bytes, since the last fflush(lines)
  size_t text_size;
};

static char *copy_text(const char *text, size_t length)
{
  char *copy;
  if (!VSC_NEW(copy, length + 1)) return NULL;
  memcpy(copy, text, length);
  return copy;
}

// The characters that XML cannot hold as they are; of spaces in attributes it keeps only plain ones.
static const struct {
  char plain;
  const char *escaped;
} ESCAPES[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"},
              {'\'', "&apos;"}, {'\t', "&#9;"}, {'\n', "&#10;"}, {'\r', "&#13;"}};

enum { ESCAPE_COUNT = sizeof ESCAPES / sizeof ESCAPES[0] };

static void write_escaped(FILE *stream, const char *text)
{
  for (; *text != '\0'; text++) {
    size_t e = 0;
    while (e < ESCAPE_COUNT && ESCAPES[e].plain != *text) e++;
    if (e < ESCAPE_COUNT) fputs(ESCAPES[e].escaped, stream);
    else fputc(*text, stream);
  }
}

// With the shortest decimal of the time that reads back as the same double. False when memory is short.
static bool add_line(vsc_pvd *pvd, const pvd_frame *frame)
{
  char time[32];
  for (int digits = 6; digits <= 17; digits++) {
    snprintf(time, sizeof time, "%.*g", digits, frame->time);
    if (strtod(time, NULL) == frame->time) break;
  }
  fprintf(pvd->lines, "    <DataSet timestep=\"%s\" part=\"0\" file=\"", time);
  write_escaped(pvd->lines, frame->file);
  fputs("\"/>\n", pvd->lines);
  return fflush(pvd->lines) == 0;
}

// Appends a frame whose file name `name` (from vsc_alloc) the list then owns, also on failure.
static bool append(vsc_pvd *pvd, double time, char *name)
{
  if (name != NULL && pvd->count == pvd->room) {
    void *frames = pvd->frames;
    const size_t longer = 2 * pvd->room + 16;
    if (vsc_grow(&frames, pvd->count, longer, sizeof *pvd->frames)) {
      pvd->frames = frames;
      pvd->room = longer;
    }
  }
  if (name == NULL || pvd->count == pvd->room) {
    vsc_free(name);
    return false;
  }
  pvd->frames[pvd->count] = (pvd_frame){.time = time, .file = name};
  return add_line(pvd, &pvd->frames[pvd->count++]);
}

void vsc_pvd_frame_path(const char *file, const vsc_pvd *pvd, size_t frame, char *path,
                        size_t size)
{
  const char *name = vsc_pvd_frame(pvd, frame), *slash = strrchr(file, '/');
  const int folder = slash == NULL || name[0] == '/' ? 0 : (int)(slash - file) + 1;
  snprintf(path, size, "%.*s%s", folder, file, name);
}

void vsc_pvd_free(vsc_pvd *pvd)
{
  if (pvd == NULL) return;
  for (size_t i = 0; i < pvd->count; i++) vsc_free(pvd->frames[i].file);
  vsc_free(pvd->frames);
  if (pvd->lines != NULL) fclose(pvd->lines);
  free(pvd->text);  // open_memstream's
  vsc_free(pvd->file);
  vsc_free(pvd);
}

size_t vsc_pvd_count(const vsc_pvd *pvd)
{
  return pvd->count;
}

double vsc_pvd_time(const vsc_pvd *pvd, size_t frame)
{
  return pvd->frames[frame].time;
}

const char *vsc_pvd_frame(const vsc_pvd *pvd, size_t frame)
{
  return pvd->frames[frame].file;
}

static vsc_status fail_damaged(const vsc_pvd *pvd, const char *what, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT, "%s: is not a complete PVD file (%s): remove it or start anew",
                  pvd->file, what);
}

// A file on its way through expat, VTKFile > Collection > DataSet.
typedef struct reading {
  vsc_pvd *pvd;
  double keep_until;
  XML_Parser parser;
  int depth;                      // elements that are open
  bool in_file, in_collection;    // they are those that frames lie in
  bool has_collection;            // there was one so far
  vsc_status status;
  vsc_error *error;
} reading;

// With the line where that is; expat hands out nothing more.
static void stop_at(reading *r, const char *what)
{
  char text[120];
  snprintf(text, sizeof text, "line %lu: %.80s", (unsigned long)XML_GetCurrentLineNumber(r->parser), what);
  r->status = fail_damaged(r->pvd, text, r->error);
  XML_StopParser(r->parser, XML_FALSE);
}

static void read_frame(reading *r, const char **attributes)
{
  const char *file = NULL, *text = "";
  for (; *attributes != NULL; attributes += 2) {
    if (strcmp(attributes[0], "timestep") == 0) text = attributes[1];
    if (strcmp(attributes[0], "file") == 0) file = attributes[1];
  }
  char *rest;
  const double time = strtod(text, &rest);
  if (rest == text || *rest != '\0' || !isfinite(time) || file == NULL) {
    stop_at(r, "a DataSet without timestep or file");
  } else if (time < r->keep_until - SAME_TIME && !append(r->pvd, time, copy_text(file, strlen(file)))) {
    r->status = vsc_fail_memory(r->error, "the list of frames");
    XML_StopParser(r->parser, XML_FALSE);
  }
}

static void XMLCALL open_element(void *context, const char *name, const char **attributes)
{
  reading *r = context;
  const int depth = r->depth++;
  if (depth == 0) r->in_file = strcmp(name, "VTKFile") == 0;
  if (depth == 1) r->in_collection = r->in_file && strcmp(name, "Collection") == 0;
  r->has_collection = r->has_collection || r->in_collection;
  if (depth == 2 && r->in_collection && strcmp(name, "DataSet") == 0) read_frame(r, attributes);
}

static void XMLCALL close_element(void *context, const char *name)
{
  (void)name;
  reading *r = context;
  if (--r->depth == 1) r->in_collection = false;
}

// Keeps the frames before `keep_until` of the PVD file in `text`.
static vsc_status read_frames(vsc_pvd *pvd, const char *text, size_t size, double keep_until, vsc_error *error)
{
  reading r = {.pvd = pvd, .keep_until = keep_until, .parser = XML_ParserCreate(NULL), .error = error};
  if (r.parser == NULL) return vsc_fail_memory(error, "the list of frames");
  XML_SetUserData(r.parser, &r);
  XML_SetElementHandler(r.parser, open_element, close_element);
  if (XML_Parse(r.parser, text, (int)size, XML_TRUE) != XML_STATUS_OK && r.status == VSC_OK) {
    const enum XML_Error why = XML_GetErrorCode(r.parser);
    if (why == XML_ERROR_NO_MEMORY) r.status = vsc_fail_memory(error, "the list of frames");
    else stop_at(&r, XML_ErrorString(why));
  }
  if (r.status == VSC_OK && !r.has_collection) r.status = fail_damaged(pvd, "no VTKFile with a Collection", error);
  XML_ParserFree(r.parser);
  return r.status;
}

static vsc_status read_existing(vsc_pvd *pvd, double keep_until, vsc_error *error)
{
  char *text;
  size_t size;
  if (access(pvd->file, F_OK) != 0 && errno == ENOENT) return VSC_OK;
  vsc_status status = vsc_load(pvd->file, &text, &size, error);
  if (status != VSC_OK) return status;
  status = size > LONGEST_FILE ? fail_damaged(pvd, "far too long", error) : read_frames(pvd, text, size, keep_until, error);
  vsc_free(text);
  return status;
}

vsc_status vsc_pvd_open(const char *file, double keep_until, vsc_pvd **pvd, vsc_error *error)
{
  vsc_pvd *made;
  if (!VSC_NEW(made, 1) || (made->file = copy_text(file, strlen(file))) == NULL ||
      (made->lines = open_memstream(&made->text, &made->text_size)) == NULL) {
    vsc_pvd_free(made);
    return vsc_fail_memory(error, "the list of frames");
  }
  vsc_status status = VSC_OK;
  if (keep_until >= 0) status = read_existing(made, keep_until, error);
  if (status != VSC_OK) {
    vsc_pvd_free(made);
    return status;
  }
  *pvd = made;
  return VSC_OK;
}

static void write_list(const vsc_pvd *pvd, FILE *stream)
{
  fputs("<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "  <Collection>\n", stream);
  if (pvd->count > 0) fwrite(pvd->text, 1, pvd->text_size, stream);
  fputs("  </Collection>\n</VTKFile>\n", stream);
}

vsc_status vsc_pvd_write(vsc_pvd *pvd, vsc_error *error)
{
  vsc_replacement list;
  vsc_status status = vsc_replace_begin(pvd->file, &list, error);
  if (status != VSC_OK) return status;
  write_list(pvd, list.stream);
  status = vsc_replace_end(&list, false, error);
  if (status == VSC_OK) pvd->written = pvd->count;
  return status;
}

vsc_status vsc_pvd_finish(vsc_pvd *pvd, vsc_error *error)
{
  return pvd->written == pvd->count ? VSC_OK : vsc_pvd_write(pvd, error);
}

vsc_status vsc_pvd_add(vsc_pvd *pvd, double time, const char *frame, vsc_error *error)
{
  if (!isfinite(time) || (pvd->count > 0 && time <= pvd->frames[pvd->count - 1].time))
    return vsc_fail(error, VSC_INPUT,
                    "%s: time %g s of frame %s does not follow that of the last one: frames must "
                    "come in order",
                    pvd->file, time, frame);
  if (!append(pvd, time, copy_text(frame, strlen(frame))))
    return vsc_fail_memory(error, "the list of frames");
  return pvd->count - pvd->written > pvd->written / UNWRITTEN_PART ? vsc_pvd_write(pvd, error) : VSC_OK;
}
