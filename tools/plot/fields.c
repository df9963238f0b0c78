// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/plot/fields.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The next field of a line; NULL behind the last.
static char *next_field(char **line)
{
  char *field = *line;
  if (field == NULL) return NULL;
  if (*field == '"') {
    char *end = strchr(++field, '"');
    if (end == NULL) return NULL;
    *end = '\0';
    *line = end[1] == ',' ? end + 2 : NULL;
    return field;
  }
  return strsep(line, ",");
}

static bool take_line(char *line, vsc_fields_line *take, void *context)
{
  char *field[VSC_MOST_FIELDS];
  size_t count = 0;
  line[strcspn(line, "\r\n")] = '\0';
  while (count < VSC_MOST_FIELDS && (field[count] = next_field(&line)) != NULL) count++;
  return take(field, count, context);
}

vsc_status vsc_fields_read(const char *csv, vsc_fields_line *take, void *context, bool *good, vsc_error *error)
{
  FILE *stream = fopen(csv, "r");
  *good = false;
  if (stream == NULL) return vsc_fail(error, VSC_INPUT, "%s: cannot be read: %s", csv, strerror(errno));
  char *line = NULL;
  size_t room = 0;
  *good = getline(&line, &room, stream) > 0;
  while (*good && getline(&line, &room, stream) > 0) *good = take_line(line, take, context);
  free(line);
  fclose(stream);
  return VSC_OK;
}
