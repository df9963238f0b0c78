// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of signals.csv that the run which is resumed has left.
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "io/replace.h"
#include "run/watch.h"

#define SAME_TIME 1e-6  // ms, by which times of rows are rounded

static size_t count_columns(const char *line)
{
  size_t count = 1;
  for (; *line != '\0'; line++) count += *line == ',';
  return count;
}

// Whether the row stays, a line of `length` in a file of so many columns: it was not cut short and is not after
// `keep_until`. Its time is *time, ms.
static bool is_kept(const char *line, ssize_t length, size_t columns, double keep_until, double *time)
{
  *time = 1e3 * strtod(line, NULL);
  return line[length - 1] == '\n' && count_columns(line) == columns && !(*time > keep_until + SAME_TIME);
}

// Writes what stays of the rows.
static void copy_rows(FILE *from, FILE *to, double keep_until)
{
  char *line = NULL;
  size_t room = 0, columns = 0;
  double time;
  for (ssize_t length; (length = getline(&line, &room, from)) > 0;) {
    if (columns == 0 || is_kept(line, length, columns, keep_until, &time)) fputs(line, to);
    if (columns == 0) columns = count_columns(line);
  }
  free(line);
}

vsc_status vsc_watch_trim(const char *file, double keep_until, vsc_error *error)
{
  vsc_replacement rows;
  FILE *from = fopen(file, "r");
  if (from == NULL) return VSC_OK;
  const vsc_status status = vsc_replace_begin(file, &rows, error);
  if (status == VSC_OK) copy_rows(from, rows.stream, keep_until);
  fclose(from);
  return status == VSC_OK ? vsc_replace_end(&rows, false, error) : status;
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

typedef struct kept_rows {
  size_t count;
  double first, last;   // times, ms
  double gap;           // between the last two, ms
  double widest, from;  // between any two, and where that begins, ms
} kept_rows;

// The rows that stay, behind a header of so many columns.
static kept_rows read_rows(FILE *stream, size_t columns, double keep_until)
{
  kept_rows kept = {0};
  char *line = NULL;
  size_t room = 0;
  double time;
  for (ssize_t length; (length = getline(&line, &room, stream)) > 0;) {
    if (!is_kept(line, length, columns, keep_until, &time)) continue;
    if (kept.count++ == 0) kept.first = kept.last = time;
    kept.gap = time - kept.last;
    if (kept.gap > kept.widest) kept.widest = kept.gap, kept.from = kept.last;
    kept.last = time;
  }
  free(line);
  return kept;
}

#define REMEDY "remove it to go on without the rows before, or begin anew without --resume"

// Compares the rows with those that the run has counted, whose times reach from low to high of the first column. The last
// may have been lost as the machine stopped; rows that begin later are of a file that was removed once.
static vsc_status compare_rows(const vsc_watch *watch, const kept_rows *kept, double now, double interval,
                               const char *file, vsc_error *error)
{
  if (now - kept->last > fmax(kept->gap, interval) + SAME_TIME)
    return vsc_fail(error, VSC_INPUT,
                    "%s: its rows end at %.6g ms, but the checkpoint is of %.6g ms: those between are lost; " REMEDY, file,
                    kept->last, now);
  const bool whole = fabs(kept->first - 1e3 * watch->low[0]) <= SAME_TIME;
  const bool cut = kept->count == 0 || kept->last < 1e3 * watch->high[0] - SAME_TIME;
  if (!whole || kept->count + cut >= (size_t)watch->rows) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: it has %zu of the %.0f rows that were written up to %.6g ms, and its widest gap is from %.6g to %.6g ms; "
                  REMEDY, file, kept->count, watch->rows, now, kept->from, kept->from + kept->widest);
}

vsc_status vsc_watch_continues(const vsc_problem *problem, const vsc_state *state, const vsc_watch *watch, const char *file,
                               vsc_error *error)
{
  char *header = NULL;
  size_t room = 0;
  FILE *stream = fopen(file, "r");
  if (stream == NULL) return VSC_OK;
  vsc_status status = VSC_OK;
  if (getline(&header, &room, stream) > 0) {
    const size_t columns = count_columns(header);
    status = compare_columns(watch, header, file, error);
    if (status == VSC_OK) {
      const kept_rows kept = read_rows(stream, columns, state->time);
      status = compare_rows(watch, &kept, state->time, problem->scene->output.signal_interval, file, error);
    }
  }
  fclose(stream);
  free(header);
  return status;
}
