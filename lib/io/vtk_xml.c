// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtk_xml.h"

#include <expat.h>
#include <limits.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "io/load.h"

enum { HEADER = 3, CODE = 32 };  // numbers of a compressed array's header that are looked at; their base64 at most

// Cells of an image from low to high, its points too.
typedef struct box {
  long long low[3], high[3];
} box;

// A file on its way through expat.
typedef struct walk {
  const char *file, *text;
  size_t size;
  XML_Parser parser;
  const char *appended;         // what offsets count from; NULL: nothing is appended
  bool raw;                     // not in base64
  bool compressed, big, wide;   // as VTKFile says: compressor, byte order, headers of 64 bits
  double most;                  // numbers that the file can hold
  double points, cells;         // of the piece
  double tuples;                // of arrays in the group that is open
  bool is_image, coding;        // coding: in an inline compressed array
  char code[CODE];
  size_t code_length;
  box whole, *pieces;
  size_t piece_count, piece_room;
  vsc_status status;
  vsc_error *error;
} walk;

// Ends the walk with a failure, whose message is written.
static void stop(walk *w, vsc_status status)
{
  w->status = status;
  XML_StopParser(w->parser, XML_FALSE);
}

static const char *find(const char **attributes, const char *name)
{
  for (; *attributes != NULL; attributes += 2)
    if (strcmp(attributes[0], name) == 0) return attributes[1];
  return NULL;
}

// The count that attribute `name` of the element announces, `other` without one; each goes with `width` numbers.
static double read_count(walk *w, const char *element, const char **attributes, const char *name, double width,
                         double other)
{
  const char *text = find(attributes, name);
  char *rest;
  if (text == NULL || w->status != VSC_OK) return other;
  const double count = strtod(text, &rest);
  if (rest == text || (count >= 0 && count * width <= w->most)) return rest == text ? other : count;
  stop(w, vsc_fail(w->error, VSC_INPUT,
                   "%s: line %lu: %.40s with %s=\"%.40s\", more than a file of %zu bytes can hold or below zero: it is "
                   "damaged; write it again",
                   w->file, (unsigned long)XML_GetCurrentLineNumber(w->parser), element, name, text, w->size));
  return other;
}

// The six numbers of an extent; false where they are none.
static bool read_box(const char *text, box *b)
{
  for (int k = 0; k < 6; k++) {
    char *rest;
    const long long value = text != NULL ? strtoll(text, &rest, 10) : 0;
    if (text == NULL || rest == text || value < INT_MIN || value > INT_MAX) return false;
    (k % 2 == 0 ? b->low : b->high)[k / 2] = value;
    text = rest;
  }
  return true;
}

static double count_points(const box *b)
{
  double count = 1;
  for (int a = 0; a < 3; a++) count *= fmax(0, (double)(b->high[a] - b->low[a] + 1));
  return count;
}

// Of the part of `b` that lies in `other`; an axis along which the whole image has one point counts one cell.
static double count_cells(const box *whole, const box *b, const box *other)
{
  double count = 1;
  for (int a = 0; a < 3; a++) {
    const long long low = b->low[a] > other->low[a] ? b->low[a] : other->low[a];
    const long long high = b->high[a] < other->high[a] ? b->high[a] : other->high[a];
    count *= whole->low[a] == whole->high[a] ? 1 : fmax(0, (double)(high - low));
  }
  return count;
}

static void add_piece(walk *w, const char **attributes)
{
  const char *text = find(attributes, "Extent");
  box piece;
  if (!read_box(text, &piece)) {
    stop(w, vsc_fail(w->error, VSC_INPUT, "%s: piece %zu has no Extent of six whole numbers: write it again", w->file,
                     w->piece_count));
    return;
  }
  bool inside = true;
  for (int a = 0; a < 3; a++) inside = inside && piece.low[a] >= w->whole.low[a] && piece.high[a] <= w->whole.high[a];
  if (!inside || count_points(&piece) > w->most) {
    stop(w, vsc_fail(w->error, VSC_INPUT, "%s: piece %zu with Extent=\"%.80s\" %s: it is damaged; write it again", w->file,
                     w->piece_count, text, inside ? "is more than a file of that size can hold" : "leaves WholeExtent"));
    return;
  }
  if (w->piece_count == w->piece_room) {
    if (!vsc_grow((void **)&w->pieces, w->piece_room, 2 * w->piece_room + 16, sizeof *w->pieces)) {
      stop(w, vsc_fail_memory(w->error, "the pieces of an image"));
      return;
    }
    w->piece_room = 2 * w->piece_room + 16;
  }
  w->pieces[w->piece_count++] = piece;
  w->points = count_points(&piece);
  w->cells = fmax(1, count_cells(&w->whole, &piece, &piece));
}

static int digit_of(char c)
{
  static const char digits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const char *place = c != '\0' ? strchr(digits, c) : NULL;
  return place != NULL ? (int)(place - digits) : -1;
}

// The first bytes of what `code` says in base64; how many, a multiple of three.
static size_t decode(const char *code, size_t length, unsigned char bytes[CODE])
{
  size_t count = 0;
  for (size_t i = 0; i + 4 <= length; i += 4) {
    uint32_t value = 0;
    for (size_t k = 0; k < 4; k++) {
      const int digit = digit_of(code[i + k]);
      if (digit < 0) return count;
      value = value << 6 | (uint32_t)digit;
    }
    for (int k = 2; k >= 0; k--) bytes[count++] = (unsigned char)(value >> 8 * k);
  }
  return count;
}

// The header of a compressed array: number of blocks, size of one, size of the last where that is smaller (else 0). Fewer
// bytes than that pass.
static void check_header(walk *w, const unsigned char *bytes, size_t count)
{
  const size_t word = w->wide ? 8 : 4;
  uint64_t header[HEADER] = {0};
  if (count < HEADER * word) return;
  for (size_t k = 0; k < HEADER; k++)
    for (size_t i = 0; i < word; i++)
      header[k] = header[k] << 8 | bytes[k * word + (w->big ? i : word - 1 - i)];
  const bool sound = header[2] <= header[1] && (header[0] > 0 || header[2] == 0) && header[0] <= w->size / word &&
                     (double)header[1] <= fmax(w->most, 1 << 30);
  if (sound) return;
  stop(w, vsc_fail(w->error, VSC_INPUT,
                   "%s: line %lu: a compressed array begins with %llu blocks of %llu bytes, the last of %llu: it is damaged, or "
                   "header_type (here %s) is wrong; write it again",
                   w->file, (unsigned long)XML_GetCurrentLineNumber(w->parser), (unsigned long long)header[0],
                   (unsigned long long)header[1], (unsigned long long)header[2], w->wide ? "UInt64" : "UInt32"));
}

static void check_appended(walk *w, const char *offset)
{
  const size_t room = w->appended != NULL ? (size_t)(w->text + w->size - w->appended) : 0;
  const unsigned long long at = offset != NULL ? strtoull(offset, NULL, 10) : 0;
  if (at >= room) return;
  unsigned char bytes[CODE];
  const char *begin = w->appended + at;
  const size_t length = room - at < CODE ? room - at : CODE;
  if (w->raw) check_header(w, (const unsigned char *)begin, length);
  else check_header(w, bytes, decode(begin, length, bytes));
}

// The text of an inline array has ended.
static void end_code(walk *w)
{
  unsigned char bytes[CODE];
  if (w->coding && w->status == VSC_OK) check_header(w, bytes, decode(w->code, w->code_length, bytes));
  w->coding = false;
}

static void open_array(walk *w, const char *name, const char **attributes)
{
  const char *format = find(attributes, "format");
  const double tuples = read_count(w, name, attributes, "NumberOfTuples", 1, w->tuples);
  read_count(w, name, attributes, "NumberOfComponents", fmax(tuples, 1), 1);
  if (w->status != VSC_OK || !w->compressed || format == NULL) return;
  if (strcmp(format, "appended") == 0) check_appended(w, find(attributes, "offset"));
  w->coding = strcmp(format, "binary") == 0;
  w->code_length = 0;
}

static void open_piece(walk *w, const char *name, const char **attributes)
{
  static const char *const counts[] = {"NumberOfVerts", "NumberOfLines", "NumberOfStrips", "NumberOfPolys"};
  if (w->is_image) {
    add_piece(w, attributes);
    return;
  }
  w->points = read_count(w, name, attributes, "NumberOfPoints", 1, 0);
  w->cells = read_count(w, name, attributes, "NumberOfCells", 1, 0);
  for (size_t i = 0; i < sizeof counts / sizeof counts[0]; i++)
    w->cells += read_count(w, name, attributes, counts[i], 1, 0);
}

// zlib packs 1032 numbers into one at most, LZ4 255, LZMA some thousands.
static void open_file(walk *w, const char **attributes)
{
  const char *order = find(attributes, "byte_order"), *header = find(attributes, "header_type");
  const char *compressor = find(attributes, "compressor");
  w->big = order != NULL && strcmp(order, "BigEndian") == 0;
  w->wide = header != NULL && strcmp(header, "UInt64") == 0;
  w->compressed = compressor != NULL && compressor[0] != '\0';
  const double packed = !w->compressed ? 8 : strstr(compressor, "LZMA") != NULL ? 1e4 : 1100;
  w->most = packed * (double)w->size;
}

static void XMLCALL open_element(void *context, const char *name, const char **attributes)
{
  walk *w = context;
  end_code(w);
  if (w->status != VSC_OK) return;
  if (strcmp(name, "VTKFile") == 0) open_file(w, attributes);
  if (strcmp(name, "ImageData") == 0) w->is_image = read_box(find(attributes, "WholeExtent"), &w->whole);
  if (strcmp(name, "Piece") == 0) open_piece(w, name, attributes);
  if (strcmp(name, "PointData") == 0 || strcmp(name, "Points") == 0) w->tuples = w->points;
  if (strcmp(name, "CellData") == 0) w->tuples = w->cells;
  if (strcmp(name, "DataArray") == 0 || strcmp(name, "Array") == 0) open_array(w, name, attributes);
  if (strcmp(name, "InformationKey") == 0) read_count(w, name, attributes, "length", 1, 0);
}

static void XMLCALL close_element(void *context, const char *name)
{
  walk *w = context;
  const char *const groups[] = {"PointData", "Points", "CellData"};
  for (size_t i = 0; i < 3; i++)
    if (strcmp(name, groups[i]) == 0) w->tuples = 1;
  end_code(w);
}

static void XMLCALL read_text(void *context, const char *text, int length)
{
  walk *w = context;
  if (!w->coding) return;
  for (int i = 0; i < length && w->code_length < CODE; i++)
    if (text[i] != ' ' && text[i] != '\n' && text[i] != '\t' && text[i] != '\r') w->code[w->code_length++] = text[i];
}

static vsc_status check_pieces(const walk *w)
{
  const box *whole = &w->whole;
  const double cells = count_cells(whole, whole, whole);
  double filled = 0;
  if (count_points(whole) > w->most)
    return vsc_fail(w->error, VSC_INPUT, "%s: WholeExtent announces %g points, more than a file of %zu bytes can hold: write "
                                         "it again", w->file, count_points(whole), w->size);
  for (size_t i = 0; i < w->piece_count; i++) filled += count_cells(whole, &w->pieces[i], &w->pieces[i]);
  if (filled != cells)
    return vsc_fail(w->error, VSC_INPUT,
                    "%s: its %zu pieces hold %.0f cells, WholeExtent has %.0f: it is not complete; write it again", w->file,
                    w->piece_count, filled, cells);
  for (size_t i = 0; i < w->piece_count; i++)
    for (size_t k = 0; k < i; k++)
      if (count_cells(whole, &w->pieces[i], &w->pieces[k]) > 0)
        return vsc_fail(w->error, VSC_INPUT, "%s: pieces %zu and %zu overlap: write it again", w->file, k, i);
  return VSC_OK;
}

// Data may be appended as they are, which is no XML: expat sees what comes before.
static void find_appended(walk *w)
{
  const char *tag = strstr(w->text, "<AppendedData");
  if (tag == NULL) return;
  const char *close = strchr(tag, '>'), *encoding = strstr(tag, "encoding=");
  w->raw = encoding != NULL && close != NULL && encoding < close && strncmp(encoding + 10, "raw", 3) == 0;
  const char *mark = close != NULL ? strchr(close, '_') : NULL;
  w->appended = mark != NULL ? mark + 1 : NULL;
}

static vsc_status walk_through(walk *w)
{
  enum { PART = 1 << 24 };
  w->parser = XML_ParserCreate(NULL);
  if (w->parser == NULL) return vsc_fail_memory(w->error, "the mesh file");
  XML_SetUserData(w->parser, w);
  XML_SetElementHandler(w->parser, open_element, close_element);
  XML_SetCharacterDataHandler(w->parser, read_text);
  const char *tag = strstr(w->text, "<AppendedData");
  size_t left = tag != NULL ? (size_t)(tag - w->text) : w->size;
  bool good = true;
  for (const char *at = w->text; left > 0 && good;) {
    const size_t part = left < PART ? left : PART;
    good = XML_Parse(w->parser, at, (int)part, XML_FALSE) == XML_STATUS_OK;
    at += part;
    left -= part;
  }
  XML_ParserFree(w->parser);
  if (w->status == VSC_OK && w->is_image && good) return check_pieces(w);
  return w->status;
}

vsc_status vsc_xml_check(const char *file, vsc_error *error)
{
  char *text;
  walk w = {.file = file, .tuples = 1, .error = error, .most = INFINITY};
  const vsc_status loaded = vsc_load(file, &text, &w.size, error);
  if (loaded != VSC_OK) return loaded;
  w.text = text;
  find_appended(&w);
  const vsc_status status = walk_through(&w);
  vsc_free(w.pieces);
  vsc_free(text);
  return status;
}
