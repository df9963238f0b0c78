// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/pvd.h"

#include <errno.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
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

// The five characters that XML cannot hold as they are.
static const struct {
  char plain;
  const char *escaped;
} ESCAPES[] = {{'&', "&amp;"}, {'<', "&lt;"}, {'>', "&gt;"}, {'"', "&quot;"}, {'\'', "&apos;"}};

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

static void unescape(char *text)
{
  char *to = text;
  while (*text != '\0') {
    size_t e = 0;
    while (e < ESCAPE_COUNT &&
           strncmp(text, ESCAPES[e].escaped, strlen(ESCAPES[e].escaped)) != 0) e++;
    *to++ = e < ESCAPE_COUNT ? ESCAPES[e].plain : *text;
    text += e < ESCAPE_COUNT ? strlen(ESCAPES[e].escaped) : 1;
  }
  *to = '\0';
}

// The value of attribute `name` inside the tag [tag, end), as a copy; NULL when it is not there
// (*memory stays true) or when memory is short (false).
static char *copy_attribute(const char *tag, const char *end, const char *name, bool *memory)
{
  const size_t length = strlen(name);
  for (const char *at = tag; at + length + 2 < end; at++) {
    if ((at[-1] != ' ' && at[-1] != '\t' && at[-1] != '\n' && at[-1] != '\r') ||
        strncmp(at, name, length) != 0 || at[length] != '=') continue;
    const char quote = at[length + 1];
    if (quote != '"' && quote != '\'') continue;
    const char *value = at + length + 2;
    const char *close = memchr(value, quote, (size_t)(end - value));
    if (close == NULL) return NULL;
    char *copy = copy_text(value, (size_t)(close - value));
    if (copy == NULL) *memory = false;
    else unescape(copy);
    return copy;
  }
  return NULL;
}

static vsc_status fail_damaged(const vsc_pvd *pvd, const char *what, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT, "%s: is not a complete PVD file (%s): remove it or start anew",
                  pvd->file, what);
}

static vsc_status read_frame(vsc_pvd *pvd, const char *tag, const char *end, double keep_until,
                             vsc_error *error)
{
  bool memory = true;
  char *text = copy_attribute(tag, end, "timestep", &memory);
  char *file = copy_attribute(tag, end, "file", &memory);
  char *rest = text;
  const double time = text != NULL ? strtod(text, &rest) : 0;
  const bool number = text != NULL && rest != text && *rest == '\0' && isfinite(time);
  const bool sound = number && file != NULL;
  vsc_free(text);
  if (!sound) {
    vsc_free(file);
    return memory ? fail_damaged(pvd, "a DataSet without timestep or file", error)
                  : vsc_fail_memory(error, "the list of frames");
  }
  if (time >= keep_until - SAME_TIME) {
    vsc_free(file);
    return VSC_OK;
  }
  return append(pvd, time, file) ? VSC_OK : vsc_fail_memory(error, "the list of frames");
}

// Keeps the frames before `keep_until` of the PVD file in `text`.
static vsc_status read_frames(vsc_pvd *pvd, const char *text, double keep_until, vsc_error *error)
{
  if (strstr(text, "<VTKFile") == NULL || strstr(text, "<Collection") == NULL)
    return fail_damaged(pvd, "no VTKFile with a Collection", error);
  if (strstr(text, "</VTKFile>") == NULL) return fail_damaged(pvd, "cut short", error);
  static const char opening[] = "<DataSet";
  for (const char *tag = strstr(text, opening); tag != NULL; tag = strstr(tag, opening)) {
    tag += strlen(opening);
    const char *end = strchr(tag, '>');
    if (end == NULL) return fail_damaged(pvd, "cut short", error);
    const vsc_status status = read_frame(pvd, tag + 1, end, keep_until, error);
    if (status != VSC_OK) return status;
  }
  return VSC_OK;
}

static vsc_status read_stream(vsc_pvd *pvd, FILE *stream, double keep_until, vsc_error *error)
{
  if (fseek(stream, 0, SEEK_END) != 0) return fail_damaged(pvd, "not a regular file", error);
  const long size = ftell(stream);
  rewind(stream);
  if (size < 0 || size > LONGEST_FILE) return fail_damaged(pvd, "not a regular file", error);
  char *text;
  if (!VSC_NEW(text, (size_t)size + 1)) return vsc_fail_memory(error, "the list of frames");
  vsc_status status;
  if (fread(text, 1, (size_t)size, stream) != (size_t)size)
    status = fail_damaged(pvd, "reading failed", error);
  else
    status = read_frames(pvd, text, keep_until, error);
  vsc_free(text);
  return status;
}

static vsc_status read_existing(vsc_pvd *pvd, double keep_until, vsc_error *error)
{
  FILE *stream = fopen(pvd->file, "rb");
  if (stream == NULL) {
    if (errno == ENOENT) return VSC_OK;
    return vsc_fail(error, VSC_INPUT, "%s: cannot be opened: %s: remove it or start anew",
                    pvd->file, strerror(errno));
  }
  const vsc_status status = read_stream(pvd, stream, keep_until, error);
  fclose(stream);
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
  fwrite(pvd->text, 1, pvd->text_size, stream);
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
