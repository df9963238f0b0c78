// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of signals.csv that the run which is resumed has left.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/replace.h"
#include "run/watch.h"

#define SAME_TIME 1e-6  // ms, by which times of rows are rounded

typedef struct kept_rows {
  size_t columns, count;
  double last, gap;  // time of the last row and its distance from the one before, ms
} kept_rows;

static size_t count_columns(const char *line)
{
  size_t count = 1;
  for (; *line != '\0'; line++) count += *line == ',';
  return count;
}

// Writes what stays of the rows.
static kept_rows copy_rows(FILE *from, FILE *to, double keep_until)
{
  kept_rows kept = {0};
  char *line = NULL;
  size_t room = 0;
  for (ssize_t length; (length = getline(&line, &room, from)) > 0;) {
    const bool header = kept.columns == 0, whole = line[length - 1] == '\n';
    if (header) kept.columns = count_columns(line);
    const double time = 1e3 * strtod(line, NULL);
    if (!header && (!whole || count_columns(line) != kept.columns || time > keep_until + SAME_TIME)) continue;
    fputs(line, to);
    if (header) continue;
    kept.gap = kept.count++ > 0 ? time - kept.last : 0;
    kept.last = time;
  }
  free(line);
  return kept;
}

vsc_status vsc_watch_trim(const char *file, double keep_until, double interval, vsc_error *error)
{
  vsc_replacement rows;
  FILE *from = fopen(file, "r");
  if (from == NULL) return VSC_OK;
  vsc_status status = vsc_replace_begin(file, &rows, error);
  if (status != VSC_OK) {
    fclose(from);
    return status;
  }
  const kept_rows kept = copy_rows(from, rows.stream, keep_until);
  fclose(from);
  if (kept.columns > 0 && keep_until - kept.last > fmax(kept.gap, interval) + SAME_TIME) {
    vsc_replace_cancel(&rows);
    return vsc_fail(error, VSC_INPUT,
                    "%s: its rows end at %.6g ms, but the checkpoint is of %.6g ms: those between are lost; remove it "
                    "to go on without the rows before, or begin anew without --resume",
                    file, kept.last, keep_until);
  }
  return vsc_replace_end(&rows, false, error);
}

// Compares the columns of `header`, which is cut into them.
static vsc_status compare_columns(const vsc_watch *watch, char *header, const char *file, vsc_error *error)
{
  const char *more = NULL, *lacks = NULL;
  bool seen[VSC_SIGNALS] = {false}, same = true;
  size_t count = 0;
  char *rest;
  for (char *column = strtok_r(header, ",\r\n", &rest); column != NULL; column = strtok_r(NULL, ",\r\n", &rest)) {
    size_t k = 0;
    while (k < watch->signal_count && strcmp(watch->names[k], column) != 0) k++;
    same = same && k == count++;
    if (k < watch->signal_count)
      seen[k] = true;
    else if (more == NULL)
      more = column;
  }
  for (size_t k = watch->signal_count; k-- > 0;)
    if (!seen[k]) lacks = watch->names[k];
  if (same && lacks == NULL) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: its columns are not those of this scene: %s%s%s%s%s%s; resume with the outputs that the run was "
                  "begun with (output.cavities, output.points), or begin anew in another folder with -o",
                  file, lacks ? "it lacks " : "", lacks ? lacks : "", lacks && more ? ", " : "",
                  more ? "it has " : lacks ? "" : "another order", more ? more : "", more ? " besides" : "");
}

vsc_status vsc_watch_continues(const vsc_watch *watch, const char *file, vsc_error *error)
{
  char *header = NULL;
  size_t room = 0;
  FILE *stream = fopen(file, "r");
  if (stream == NULL) return VSC_OK;
  const bool any = getline(&header, &room, stream) > 0;
  fclose(stream);
  const vsc_status status = any ? compare_columns(watch, header, file, error) : VSC_OK;
  free(header);
  return status;
}
