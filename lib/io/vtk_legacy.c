// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/vtk_legacy.h"

#include <ctype.h>
#include <errno.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "base/mem.h"

// Walks over the numbers of the list.
typedef struct reading {
  const char *at, *end;
  bool binary;
} reading;

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
  while (list->at < list->end && isspace((unsigned char)*list->at)) list->at++;
  const bool negative = list->at < list->end && *list->at == '-';
  if (negative) list->at++;
  const char *first = list->at;
  int64_t value = 0;
  while (list->at < list->end && isdigit((unsigned char)*list->at) && value < INT64_MAX / 16)
    value = 10 * value + (*list->at++ - '0');
  *number = negative ? -value : value;
  return list->at > first;
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

// The list `name` whose name is `*word`; *word is moved behind what was understood. A name that no
// two numbers follow is none.
static vsc_status check_list(const char *file, const char *name, bool binary, const char **word,
                             const char *end, vsc_error *error)
{
  long long count, size;
  int used = 0;
  const char *numbers = next_word(*word, end);
  if (sscanf(numbers, "%lld %lld%n", &count, &size, &used) != 2) return VSC_OK;
  const char *list = next_word(numbers + used, end);
  *word = list;
  if (strncasecmp(list, "offsets", 7) == 0) return VSC_OK;
  if (binary) list = next_line(numbers + used, end);
  if (!fills((reading){list, end, binary}, count, size))
    return vsc_fail(error, VSC_INPUT,
                    "%s: the cells do not fill the list announced by %s %lld %lld (cells, "
                    "numbers with the lengths): correct that line or write the file again",
                    file, name, count, size);
  if (binary) *word = list + 4 * size;
  return VSC_OK;
}

// `text` ends with a zero at `end`. A list is where a word begins with its name and two numbers
// follow, as VTK sees it; of an unstructured grid's, the first counts.
static vsc_status check_text(const char *file, const char *text, const char *end, vsc_error *error)
{
  const char *word = next_line(next_line(text, end), end);
  const bool binary = strncasecmp(word, "binary", 6) == 0;
  bool polydata = false;
  while (word < end) {
    if (strncasecmp(word, "dataset", 7) == 0)
      polydata = strncasecmp(next_word(word, end), "polydata", 8) == 0;
    if (polydata && (strncasecmp(word, "point_data", 10) == 0 ||
                     strncasecmp(word, "cell_data", 9) == 0))
      return VSC_OK;
    if (strncasecmp(word, "cell_types", 10) == 0)
      return vsc_fail(error, VSC_INPUT,
                      "%s: has CELL_TYPES but no CELLS before them: write the file again", file);
    const char *name = list_name(word, polydata), *former = word;
    if (name != NULL) {
      const vsc_status status = check_list(file, name, binary, &word, end, error);
      if (status != VSC_OK || (!polydata && word != former)) return status;
    }
    if (word == former) word = next_word(word, end);
    while (word < end && isspace((unsigned char)*word)) word++;
  }
  return VSC_OK;
}

static vsc_status check_stream(const char *file, FILE *stream, vsc_error *error)
{
  if (fseek(stream, 0, SEEK_END) != 0)
    return vsc_fail(error, VSC_INPUT, "%s: is not a regular file", file);
  const long size = ftell(stream);
  rewind(stream);
  char *text;
  if (size < 0 || !VSC_NEW(text, (size_t)size + 1)) return vsc_fail_memory(error, "the mesh file");
  vsc_status status;
  if (fread(text, 1, (size_t)size, stream) == (size_t)size)
    status = check_text(file, text, text + size, error);
  else
    status = vsc_fail(error, VSC_INPUT, "%s: cannot be read: %s", file, strerror(errno));
  vsc_free(text);
  return status;
}

vsc_status vsc_legacy_check_cells(const char *file, vsc_error *error)
{
  FILE *stream = fopen(file, "rb");
  if (stream == NULL)
    return vsc_fail(error, VSC_INPUT, "%s: cannot be opened: %s: check the name", file,
                    strerror(errno));
  const vsc_status status = check_stream(file, stream, error);
  fclose(stream);
  return status;
}
