// SPDX-License-Identifier: GPL-3.0-or-later
// Curves given as tables: in the scene itself or in a CSV file.
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "io/scene_reading.h"

// Two numbers parted by a comma, a semicolon or blanks, and nothing else.
static bool two_numbers(const char *line, double *first, double *second)
{
  char *end;
  *first = strtod(line, &end);
  if (end == line) return false;
  const char *rest = end + strspn(end, " \t");
  if (*rest == ',' || *rest == ';') rest++;
  if (rest == end) return false;
  *second = strtod(rest, &end);
  return end != rest && end[strspn(end, " \t\r\n")] == '\0';
}

static vsc_status add_point(vsc_reading *reading, vsc_curve_def *curve, double time, double value)
{
  const size_t count = curve->point_count;
  if ((count & (count - 1)) == 0) {  // room doubles at 0, 1, 2, 4, ...
    const size_t room = count == 0 ? 1 : 2 * count;
    if (!vsc_grow((void **)&curve->times, count, room, sizeof(double)) ||
        !vsc_grow((void **)&curve->values, count, room, sizeof(double)))
      return vsc_fail_memory(reading->error, "a curve");
  }
  curve->times[count] = time;
  curve->values[count] = value;
  curve->point_count = count + 1;
  return VSC_OK;
}

static vsc_status read_lines(vsc_reading *reading, FILE *stream, const char *file, double unit,
                             vsc_curve_def *curve)
{
  char line[256];
  bool headed = false;
  for (size_t number = 1; fgets(line, sizeof line, stream) != NULL; number++) {
    double time, value;
    const char *text = line + strspn(line, " \t\r\n");
    if (strchr(line, '\n') == NULL && !feof(stream))
      return vsc_reading_fail(reading, "%s: line %zu is too long; expected time,value", file,
                              number);
    if (*text == '\0' || *text == '#') continue;
    const bool good = two_numbers(text, &time, &value);
    const bool header = !good && !headed && curve->point_count == 0;
    headed = true;
    if (header) continue;
    if (!good || !isfinite(time * unit) || !isfinite(value))
      return vsc_reading_fail(reading, "%s: line %zu: \"%.40s\"; expected two numbers, time,value",
                              file, number, text);
    if (curve->point_count > 0 && time * unit <= curve->times[curve->point_count - 1])
      return vsc_reading_fail(reading, "%s: line %zu: time %g does not rise; sort the lines", file,
                              number, time);
    const vsc_status status = add_point(reading, curve, time * unit, value);
    if (status != VSC_OK) return status;
  }
  if (curve->point_count >= 2) return VSC_OK;
  return vsc_reading_fail(reading,
                          "%s: %zu points; expected a header line and at least two lines "
                          "time,value",
                          file, curve->point_count);
}

// Reads a CSV file of two columns, times (of `unit` ms each) and values, into the curve.
static vsc_status read_table(vsc_reading *reading, const char *file, double unit, vsc_curve_def *curve)
{
  vsc_status status = vsc_scene_file_exists(reading, file);
  if (status != VSC_OK) return status;
  FILE *stream = fopen(file, "r");
  if (stream == NULL) return vsc_reading_fail(reading, "%s: %s", file, strerror(errno));
  status = read_lines(reading, stream, file, unit, curve);
  if (status == VSC_OK && ferror(stream))
    status = vsc_fail(reading->error, VSC_SYSTEM, "%s: cannot be read: %s", file, strerror(errno));
  fclose(stream);
  return status;
}

static vsc_status read_file(vsc_reading *reading, const char *name, const char *unit_text,
                            vsc_curve_def *curve)
{
  char file[VSC_PATH];
  double unit;
  size_t length = vsc_enter(reading, "time_unit");
  if (unit_text == NULL)
    return vsc_reading_fail(reading, "missing; give the unit of the file's times, such as ms");
  const vsc_row row = {
      .key = "time_unit", .kind = VSC_ROW_UNIT, .quantity = VSC_TIME, .text = "ms"};
  vsc_status status = vsc_row_read(reading, &row, &(vsc_slot){.value = (void *)unit_text}, &unit);
  if (status != VSC_OK) return status;
  vsc_leave(reading, length);
  length = vsc_enter(reading, "file");
  status = vsc_scene_resolve(reading, name, file);
  if (status == VSC_OK) status = read_table(reading, file, unit, curve);
  if (status == VSC_OK) vsc_leave(reading, length);
  return status;
}

vsc_status vsc_curve_finish(vsc_reading *reading, const vsc_slot *slots, void *target)
{
  vsc_curve_def *curve = target;
  const char *file = vsc_slot_value(&vsc_curve_group, slots, "file");
  const char *unit = vsc_slot_value(&vsc_curve_group, slots, "time_unit");
  if (curve->kind != VSC_CURVE_TABLE) return VSC_OK;
  if (file != NULL && curve->point_count > 0)
    return vsc_reading_fail(reading, "both file and times or values; keep one of the two");
  if (file != NULL) return read_file(reading, file, unit, curve);
  if (unit != NULL)
    return vsc_reading_fail(reading, "time_unit without file; give file: curve.csv");
  if (curve->times == NULL || curve->values == NULL)
    return vsc_reading_fail(reading, "a table without %s; give file, or times and values",
                            curve->times == NULL ? "times" : "values");
  return VSC_OK;
}
