// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/signals.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"

// Whether a simulation writes the file: a last line without its end may be half a line.
static bool may_grow(const char *file)
{
  const char *slash = strrchr(file, '/');
  return strcmp(slash != NULL ? slash + 1 : file, "signals.csv") == 0;
}

// The whole file as one text, zero-terminated; to be released with vsc_free.
static vsc_status read_text(const char *file, char **text, vsc_error *error)
{
  FILE *stream = fopen(file, "rb");
  if (stream == NULL) return vsc_fail(error, VSC_INPUT, "%s: %s", file, strerror(errno));
  size_t used = 0, room = 0;
  vsc_status status = VSC_OK;
  do {
    if (!vsc_grow((void **)text, room, 2 * room + 65536, 1)) {
      status = vsc_fail_memory(error, "the signals");
      break;
    }
    room = 2 * room + 65536;
    used += fread(*text + used, 1, room - used - 1, stream);
  } while (used == room - 1);
  if (status == VSC_OK && used > 0 && (*text)[used - 1] != '\n' && !may_grow(file)) (*text)[used] = '\n';
  if (status == VSC_OK && ferror(stream))
    status = vsc_fail(error, VSC_INPUT, "%s: can't be read", file);
  fclose(stream);
  return status;
}

// Cuts a header cell `name [unit]` into its two parts.
static void read_header_cell(const char *cell, size_t length, char name[VSC_NAME],
                             char unit[VSC_NAME])
{
  char copy[2 * VSC_NAME];
  snprintf(copy, sizeof copy, "%.*s", (int)length, cell);
  char *start = copy + strspn(copy, " \t\"#");
  char *bracket = strchr(start, '[');
  unit[0] = '\0';
  if (bracket != NULL) {
    *bracket = '\0';
    bracket[1 + strcspn(bracket + 1, "]")] = '\0';
    vsc_copy_name(unit, bracket + 1);
  }
  size_t end = strlen(start);
  while (end > 0 && strchr(" \t\r\"", start[end - 1]) != NULL) end--;
  start[end] = '\0';
  vsc_copy_name(name, start);
}

static size_t count_cells(const char *line)
{
  size_t count = 1;
  for (; *line != '\0' && *line != '\n'; line++) count += *line == ',';
  return count;
}

// Counts the complete lines after the first.
static size_t count_rows(const char *text)
{
  size_t lines = 0;
  for (; *text != '\0'; text++) lines += *text == '\n';
  return lines > 0 ? lines - 1 : 0;
}

static vsc_status read_row(const char *file, vsc_signals *table, size_t row, const char *line,
                           vsc_error *error)
{
  const size_t cells = count_cells(line);
  if (cells != table->columns)
    return vsc_fail(error, VSC_INPUT, "%s:%zu: %zu values where the header names %zu", file,
                    row + 2, cells, table->columns);
  for (size_t c = 0; c < cells; c++) {
    char *end;
    table->values[c * table->rows + row] = strtod(line, &end);
    end += strspn(end, " \t\r");
    if (end == line || (*end != ',' && *end != '\n'))
      return vsc_fail(error, VSC_INPUT, "%s:%zu: value %zu (%s) is not a number", file, row + 2,
                      c + 1, table->names[c]);
    line = end + 1;
  }
  return VSC_OK;
}

static vsc_status read_table(const char *file, const char *text, vsc_signals *table,
                             vsc_error *error)
{
  table->columns = count_cells(text);
  table->rows = count_rows(text);
  if (!VSC_NEW(table->names, table->columns) || !VSC_NEW(table->units, table->columns) ||
      !VSC_NEW(table->values, table->columns * table->rows))
    return vsc_fail_memory(error, "the signals");
  const char *cell = text;
  for (size_t c = 0; c < table->columns; c++) {
    const size_t length = strcspn(cell, ",\n");
    read_header_cell(cell, length, table->names[c], table->units[c]);
    cell += length + 1;
  }
  for (size_t row = 0; row < table->rows; row++) {
    if (read_row(file, table, row, cell, error) != VSC_OK) return error->status;
    cell = strchr(cell, '\n') + 1;
  }
  return VSC_OK;
}

vsc_status vsc_signals_read(const char *file, vsc_signals **signals, vsc_error *error)
{
  vsc_error own;
  if (error == NULL) error = &own;
  char *text = NULL;
  vsc_signals *table = NULL;
  vsc_status status = read_text(file, &text, error);
  if (status == VSC_OK && strchr(text, '\n') == NULL)
    status = vsc_fail(error, VSC_INPUT, "%s: the file is empty", file);
  if (status == VSC_OK && !VSC_NEW(table, 1)) status = vsc_fail_memory(error, "the signals");
  if (status == VSC_OK) status = read_table(file, text, table, error);
  vsc_free(text);
  if (status == VSC_OK)
    *signals = table;
  else
    vsc_signals_free(table);
  return status;
}

const double *vsc_signals_find(const vsc_signals *signals, const char *name)
{
  for (size_t c = 0; c < signals->columns; c++)
    if (strcmp(signals->names[c], name) == 0) return signals->values + c * signals->rows;
  return NULL;
}

size_t vsc_signals_next(const vsc_signals *signals, const char *prefix, size_t from)
{
  while (from < signals->columns && strncmp(signals->names[from], prefix, strlen(prefix)) != 0)
    from++;
  return from;
}

void vsc_signals_free(vsc_signals *signals)
{
  if (signals == NULL) return;
  vsc_free(signals->names);
  vsc_free(signals->units);
  vsc_free(signals->values);
  vsc_free(signals);
}
