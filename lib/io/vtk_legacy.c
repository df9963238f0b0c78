// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtk_legacy.h"

#include <ctype.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"
#include "io/load.h"

#define MOST INT64_MAX
#define FIRST_WITH_OFFSETS 5  // version of the format

// Walks over the numbers of the list.
typedef struct reading {
  const char *at, *end;
  bool binary;
} reading;

// The whole number in the text behind `*at`, MOST where it is larger; moves behind it. False: there is none.
static bool next_count(const char **at, long long *count)
{
  const char *c = *at;
  while (isspace((unsigned char)*c)) c++;
  const bool negative = *c == '-';
  if (negative || *c == '+') c++;
  const char *first = c;
  long long value = 0;
  for (; isdigit((unsigned char)*c); c++) value = value < MOST / 10 ? 10 * value + (*c - '0') : MOST;
  *count = negative ? -value : value;
  *at = c;
  return c > first;
}

// The next number of the list; false where there is none.
static bool next_number(reading *list, int64_t *number)
{
  if (list->binary) {
    if (list->end - list->at < 4) return false;
    const unsigned char *b = (const unsigned char *)list->at;
    *number = (int32_t)((uint32_t)b[0] << 24 | (uint32_t)b[1] << 16 | (uint32_t)b[2] << 8 | b[3]);
    list->at += 4;
    return true;
  }
  long long value;
  const bool found = next_count(&list->at, &value);
  *number = value;
  return found;
}

// Whether `count` lists (a length and that many numbers) fill `size` numbers.
static bool fills(reading list, long long count, long long size)
{
  int64_t length, point;
  for (; count > 0 && size > 0; count--) {
    if (!next_number(&list, &length) || length < 0 || length >= size) return false;
    size -= length + 1;
    if (list.binary) {
      if ((list.end - list.at) / 4 < length) return false;
      list.at += 4 * length;
    } else {
      for (; length > 0; length--)
        if (!next_number(&list, &point)) return false;
    }
  }
  return count == 0 && size == 0;
}

// Whether a cell of the list, of which `fills` holds, names a point that is none of `points`: that one.
static bool goes_astray(reading list, long long count, int64_t points, int64_t *point)
{
  int64_t length;
  for (; count > 0 && next_number(&list, &length); count--)
    for (; length > 0 && next_number(&list, point); length--)
      if (*point < 0 || *point >= points) return true;
  return false;
}

// The start of the line after `at`, or `end`.
static const char *next_line(const char *at, const char *end)
{
  const char *newline = memchr(at, '\n', (size_t)(end - at));
  return newline != NULL ? newline + 1 : end;
}

// The start of the next word after the blank behind `at`, or `end`.
static const char *next_word(const char *at, const char *end)
{
  while (at < end && !isspace((unsigned char)*at)) at++;
  while (at < end && isspace((unsigned char)*at)) at++;
  return at;
}

// The word, of those that begin a list, that `word` begins with; NULL when it is none.
static const char *list_name(const char *word, bool polydata)
{
  static const char *const of_polydata[] = {"VERTICES", "LINES", "POLYGONS", "TRIANGLE_STRIPS"};
  if (!polydata) return strncasecmp(word, "cells", 5) == 0 ? "CELLS" : NULL;
  for (size_t i = 0; i < sizeof of_polydata / sizeof of_polydata[0]; i++)
    if (strncasecmp(word, of_polydata[i], strlen(of_polydata[i])) == 0) return of_polydata[i];
  return NULL;
}

// What is known of the file on the way through its words.
typedef struct walk {
  const char *file, *end;
  bool binary, polydata;
  long long version; // of the format, its first number
  bool listed;       // lists of cells cannot follow
  int64_t points;    // as POINTS says; below zero: not yet
  long long places;  // as POINT_DATA or CELL_DATA says
} walk;

// Refuses what the rest of the file, from `at` on, cannot hold: each number takes a bit at least.
static vsc_status check_room(const walk *w, const char *at, const char *what, long long tuples,
                             long long width, vsc_error *error)
{
  const long long most = 8 * (long long)(w->end - at);
  if (tuples == 0 || width == 0 || (tuples > 0 && width > 0 && tuples <= most / width)) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: %.*s announces %lld times %lld numbers, %lld bytes are left: it is damaged or cut short; "
                  "write it again",
                  w->file, (int)(strcspn(what, " \t\r\n") % 40), what, tuples, width, (long long)(w->end - at));
}

// The list `name` whose name is `*word`; *word is moved behind what was understood. A name that no
// two numbers follow is none.
static vsc_status check_list(const walk *w, const char *name, const char **word, vsc_error *error)
{
  long long count, size;
  int64_t point;
  const char *numbers = next_word(*word, w->end);
  if (!next_count(&numbers, &count) || !next_count(&numbers, &size)) return VSC_OK;
  const char *list = next_word(numbers, w->end);
  *word = list;
  if (count > 0 && w->points < 0)
    return vsc_fail(error, VSC_INPUT, "%s: has %s but no POINTS before them: write the file again", w->file, name);
  if (strncasecmp(list, "offsets", 7) == 0) {
    if (w->version < FIRST_WITH_OFFSETS)
      return vsc_fail(error, VSC_INPUT, "%s: %s come as OFFSETS, which the version in its first line does not have: write the "
                                        "file again", w->file, name);
    const vsc_status status = check_room(w, list, name, count, 1, error);
    return status == VSC_OK ? check_room(w, list, name, size, 1, error) : status;
  }
  if (w->binary) list = next_line(numbers, w->end);
  const reading cells = {list, w->end, w->binary};
  if (!fills(cells, count, size))
    return vsc_fail(error, VSC_INPUT,
                    "%s: the cells do not fill the list announced by %s %lld %lld (cells, "
                    "numbers with the lengths): correct that line or write the file again",
                    w->file, name, count, size);
  if (goes_astray(cells, count, w->points, &point))
    return vsc_fail(error, VSC_INPUT, "%s: %s names point %lld, the file has points 0 to %lld: mesh again", w->file,
                    name, (long long)point, (long long)w->points - 1);
  if (w->binary) *word = list + 4 * size;
  return VSC_OK;
}

// What comes before the data: points and lists. A list is where a word begins with its name and two
// numbers follow, as VTK sees it; of an unstructured grid's, the first counts.
static vsc_status check_geometry(walk *w, const char **word, vsc_error *error)
{
  long long count;
  const char *at = next_word(*word, w->end), *former = *word;
  if (strncasecmp(*word, "dataset", 7) == 0) {
    w->polydata = strncasecmp(at, "polydata", 8) == 0;
    w->listed = strncasecmp(at, "structured_points", 17) == 0;
  }
  if (strncasecmp(*word, "points", 6) == 0 && next_count(&at, &count)) {
    w->points = count;
    return check_room(w, at, "POINTS", count, 3, error);
  }
  if (strncasecmp(*word, "cell_types", 10) == 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: has CELL_TYPES but no CELLS before them: write the file again", w->file);
  const char *name = list_name(*word, w->polydata);
  if (name == NULL) return VSC_OK;
  const vsc_status status = check_list(w, name, word, error);
  w->listed = !w->polydata && *word != former;
  return status;
}

// Whether `word` is the name of an array of a FIELD: how wide it is, how many tuples and the type follow.
static bool is_array(const walk *w, const char *word, long long *width, long long *tuples, const char **behind)
{
  static const char *const types[] = {
    "bit", "char", "signed_char", "unsigned_char", "short", "unsigned_short", "int", "unsigned_int", "long",
    "unsigned_long", "vtktypeint64", "vtktypeuint64", "vtkidtype", "float", "double", "string", "utf8_string", "variant"};
  const char *at = next_word(word, w->end);
  *behind = word;
  if (!next_count(&at, width) || !next_count(&at, tuples)) return false;
  while (isspace((unsigned char)*at)) at++;
  for (size_t i = 0; i < sizeof types / sizeof types[0]; i++) {
    const size_t length = strlen(types[i]);
    if (strncasecmp(at, types[i], length) != 0 || !isspace((unsigned char)at[length])) continue;
    *behind = at + length;
    return true;
  }
  return false;
}

// Arrays on points or cells that belong to no FIELD. The table that scalars name is no table of its own.
static vsc_status check_attribute(walk *w, const char **word, vsc_error *error)
{
  static const char *const names[] = {"scalars", "vectors", "normals", "tensors", "texture_coordinates",
                                      "global_ids", "pedigree_ids", "edge_flags"};
  const char *name = *word, *at = next_word(next_word(name, w->end), w->end);
  long long width = 1;
  if (strncasecmp(name, "color_scalars", 13) == 0 && next_count(&at, &width))
    return check_room(w, at, name, w->places, width, error);
  if (strncasecmp(name, "lookup_table", 12) == 0 && next_count(&at, &width))
    return check_room(w, at, name, width, 4, error);
  for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
    if (strncasecmp(name, names[i], strlen(names[i])) != 0) continue;
    at = next_word(at, w->end);
    if (i == 0 && !next_count(&at, &width)) width = 1;
    while (isspace((unsigned char)*at)) at++;
    if (i == 0 && strncasecmp(at, "lookup_table", 12) == 0) *word = next_word(next_word(at, w->end), w->end);
    return check_room(w, at, name, w->places, width, error);
  }
  return VSC_OK;
}

// The word and what belongs to it; *word is moved where that was understood.
static vsc_status check_word(walk *w, const char **word, vsc_error *error)
{
  long long count, width;
  const char *at = *word;
  if (is_array(w, *word, &width, &count, &at)) {
    const vsc_status status = check_room(w, at, *word, count, width, error);
    *word = at;
    return status;
  }
  at = next_word(*word, w->end);
  const bool on_points = strncasecmp(*word, "point_data", 10) == 0;
  if (on_points || strncasecmp(*word, "cell_data", 9) == 0) {
    if (w->polydata) w->listed = true;
    if (next_count(&at, &count)) w->places = count;
    return VSC_OK;
  }
  const bool counted = strncmp(*word, "DATA ", 5) == 0 || (w->listed && strncasecmp(*word, "cell_types", 10) == 0);
  if (counted && next_count(&at, &count)) return check_room(w, at, *word, count, 1, error);
  const vsc_status status = check_attribute(w, word, error);
  return status == VSC_OK && !w->listed ? check_geometry(w, word, error) : status;
}

// The first of the two numbers of the version, as VTK understands it; else 0, as it takes that for an old one.
static long long read_version(const char *text, size_t size)
{
  static const char head[] = "# vtk DataFile Version";
  long long major, minor;
  const char *at = text + sizeof head - 1;
  if (size < sizeof head || !next_count(&at, &major) || *at != '.') return 0;
  at++;
  return isdigit((unsigned char)*at) && next_count(&at, &minor) && major < 1000 ? major : 0;
}

vsc_status vsc_legacy_check(const char *file, vsc_error *error)
{
  char *text;
  size_t size;
  vsc_status status = vsc_load(file, &text, &size, error);
  if (status != VSC_OK) return status;
  walk w = {.file = file, .end = text + size, .version = read_version(text, size), .points = -1};
  const char *word = next_line(next_line(text, w.end), w.end);
  w.binary = strncasecmp(word, "binary", 6) == 0;
  while (word < w.end && status == VSC_OK) {
    const char *former = word;
    status = check_word(&w, &word, error);
    if (word == former) word = next_word(word, w.end);
    while (word < w.end && isspace((unsigned char)*word)) word++;
  }
  vsc_free(text);
  return status;
}
