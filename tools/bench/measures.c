// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/measures.h"

#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "mesh/place.h"
#include "tools/bench/curves.h"
#include "tools/results.h"

// ---- points of the tissue

static double body_size(const vsc_mesh *mesh)
{
  double low[3], high[3];
  vsc_mesh_box(mesh, low, high);
  return hypot(hypot(high[0] - low[0], high[1] - low[1]), high[2] - low[2]);
}

vsc_status vsc_moved_point(const vsc_outcome *outcome, const double at[3], double now[3],
                           vsc_error *error)
{
  vsc_place place;
  double moved[3];
  vsc_place_find(outcome->mesh, at, &place);
  // straight edges of coarse meshes may pass inside of a round wall
  if (place.distance > 0.01 * body_size(outcome->mesh))
    return vsc_fail(error, VSC_INPUT, "(%g, %g, %g) mm lies outside the body, by %g mm", at[0], at[1],
                    at[2], place.distance);
  vsc_place_value(outcome->mesh, &place, 3, outcome->moved, moved);
  for (int a = 0; a < 3; a++) now[a] = at[a] + moved[a];
  return VSC_OK;
}

vsc_status vsc_measure_place(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                             vsc_measured *measured, vsc_error *error)
{
  double now[3] = {0};
  const vsc_status status = vsc_moved_point(outcome, quantity->at, now, error);
  measured->value = now[quantity->axis];
  return status;
}

vsc_status vsc_measure_move(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                            vsc_measured *measured, vsc_error *error)
{
  const vsc_status status = vsc_measure_place(outcome, quantity, measured, error);
  measured->value -= quantity->at[quantity->axis];
  return status;
}

// Mean length of the first `axes` coordinates at rest and now, of the nodes that rest at `radius`.
static vsc_status mean_radius(const vsc_outcome *outcome, double radius, int axes, double *mean,
                              vsc_error *error)
{
  const vsc_mesh *mesh = outcome->mesh;
  double sum = 0, count = 0;
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double *x = mesh->nodes + 3 * n, *u = outcome->moved + 3 * n;
    double rest = 0, now = 0;
    for (int a = 0; a < axes; a++) {
      rest += x[a] * x[a];
      now += (x[a] + u[a]) * (x[a] + u[a]);
    }
    if (fabs(sqrt(rest) - radius) > 1e-6 * radius) continue;
    sum += sqrt(now);
    count++;
  }
  *mean = sum / count;
  if (count > 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "no node rests at a radius of %g mm", radius);
}

vsc_status vsc_measure_sphere(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_measured *measured, vsc_error *error)
{
  return mean_radius(outcome, quantity->at[0], 3, &measured->value, error);
}

vsc_status vsc_measure_cylinder(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                vsc_measured *measured, vsc_error *error)
{
  return mean_radius(outcome, quantity->at[0], 2, &measured->value, error);
}

vsc_status vsc_measure_sphere_move(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                   vsc_measured *measured, vsc_error *error)
{
  const vsc_status status = vsc_measure_sphere(outcome, quantity, measured, error);
  measured->value -= quantity->at[0];
  return status;
}

vsc_status vsc_measure_cylinder_move(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                     vsc_measured *measured, vsc_error *error)
{
  const vsc_status status = vsc_measure_cylinder(outcome, quantity, measured, error);
  measured->value -= quantity->at[0];
  return status;
}

// ---- signals

vsc_status vsc_find_column(const vsc_outcome *outcome, const char *name, const double **values,
                           vsc_error *error)
{
  *values = vsc_signals_find(outcome->signals, name);
  if (*values != NULL && outcome->signals->rows > 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "signals.csv has no values of '%s'", name);
}

vsc_status vsc_measure_signal(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_measured *measured, vsc_error *error)
{
  const double *values;
  const vsc_status status = vsc_find_column(outcome, quantity->column, &values, error);
  if (status == VSC_OK) measured->value = values[outcome->signals->rows - 1];
  return status;
}

vsc_status vsc_measure_least(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                             vsc_measured *measured, vsc_error *error)
{
  const double *values;
  const vsc_status status = vsc_find_column(outcome, quantity->column, &values, error);
  if (status != VSC_OK) return status;
  measured->value = gsl_stats_min(values, 1, outcome->signals->rows);
  return VSC_OK;
}

vsc_status vsc_measure_most(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                            vsc_measured *measured, vsc_error *error)
{
  const double *values;
  const vsc_status status = vsc_find_column(outcome, quantity->column, &values, error);
  if (status != VSC_OK) return status;
  measured->value = gsl_stats_max(values, 1, outcome->signals->rows);
  return VSC_OK;
}

vsc_status vsc_measure_frequency(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                 vsc_measured *measured, vsc_error *error)
{
  const double *time, *values;
  vsc_status status = vsc_find_column(outcome, "time", &time, error);
  if (status == VSC_OK) status = vsc_find_column(outcome, quantity->column, &values, error);
  if (status == VSC_OK)
    measured->value = vsc_curve_frequency(outcome->signals->rows, time, values);
  return status;
}

vsc_status vsc_measure_tone(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                            vsc_measured *measured, vsc_error *error)
{
  const double *time, *values;
  vsc_status status = vsc_find_column(outcome, "time", &time, error);
  if (status == VSC_OK) status = vsc_find_column(outcome, quantity->column, &values, error);
  if (status != VSC_OK) return status;
  measured->value = vsc_curve_tone(outcome->signals->rows, time, values, quantity->at[0], quantity->at[1]);
  if (!isnan(measured->value)) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "'%s' has no tone from %g to %g Hz", quantity->column, quantity->at[0],
                  quantity->at[1]);
}

// How far a column falls below its first value.
static double fall(size_t rows, const double *values)
{
  return values[0] - gsl_stats_min(values, 1, rows);
}

vsc_status vsc_measure_stroke(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_measured *measured, vsc_error *error)
{
  const double *values;
  const char *const at = strstr(outcome->folder, "-implicit-");
  vsc_status status = vsc_find_column(outcome, quantity->column, &values, error);
  if (status != VSC_OK) return status;
  measured->value = fall(outcome->signals->rows, values);
  if (strcmp(outcome->of->variant->name, "implicit") != 0 || at == NULL) return VSC_OK;
  char file[VSC_RESULT_PATH];
  vsc_signals *other;
  snprintf(file, sizeof file, "%.*s-explicit-%s/signals.csv", (int)(at - outcome->folder),
           outcome->folder, at + strlen("-implicit-"));
  if (access(file, R_OK) != 0) return VSC_OK;
  status = vsc_signals_read(file, &other, error);
  if (status != VSC_OK) return status;
  if ((values = vsc_signals_find(other, quantity->column)) != NULL)
    measured->reference = fall(other->rows, values);
  vsc_signals_free(other);
  return VSC_OK;
}

// ---- reference curves

vsc_status vsc_open_reference(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_signals **table, vsc_measured *measured, vsc_error *error)
{
  char file[VSC_RESULT_PATH];
  snprintf(file, sizeof file, "%s/%s", outcome->reference != NULL ? outcome->reference : "",
           quantity->file);
  *table = NULL;
  measured->skipped = outcome->reference == NULL || access(file, R_OK) != 0;
  return measured->skipped ? VSC_OK : vsc_signals_read(file, table, error);
}

// A column of the reference's component: NAME_u<x|y|z>_<what>_mm.
static const double *reference_column(const vsc_signals *table, const char *name, int axis,
                                      const char *what)
{
  char column[VSC_NAME];
  snprintf(column, sizeof column, "%s_u%c_%s_mm", name, "xyz"[axis], what);
  return vsc_signals_find(table, column);
}

// The history of component `axis` at the reference's times into values[table->rows].
static vsc_status sample_history(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                 const vsc_signals *table, int axis, double *values,
                                 vsc_error *error)
{
  char column[VSC_NAME];
  const double *time, *history, *at = vsc_signals_find(table, "time_s");
  snprintf(column, sizeof column, "%s%c", quantity->column, "xyz"[axis]);
  vsc_status status = vsc_find_column(outcome, "time", &time, error);
  if (status == VSC_OK) status = vsc_find_column(outcome, column, &history, error);
  if (status != VSC_OK) return status;
  if (at == NULL || reference_column(table, quantity->file_column, axis, "mean") == NULL)
    return vsc_fail(error, VSC_INPUT, "%s: no columns time_s and %s_u%c_mean_mm", quantity->file,
                    quantity->file_column, "xyz"[axis]);
  for (size_t r = 0; r < table->rows; r++)
    values[r] = vsc_curve_at(outcome->signals->rows, time, history, at[r]);
  return VSC_OK;
}

vsc_status vsc_measure_history(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                               vsc_measured *measured, vsc_error *error)
{
  vsc_signals *table;
  vsc_status status = vsc_open_reference(outcome, quantity, &table, measured, error);
  if (status != VSC_OK || table == NULL) return status;
  double *ours, *mean = NULL;
  const size_t rows = table->rows;
  if (!VSC_NEW(ours, 3 * rows) || !VSC_NEW(mean, 3 * rows))
    status = vsc_fail_memory(error, "a history");
  for (int a = 0; a < 3 && status == VSC_OK; a++) {
    status = sample_history(outcome, quantity, table, a, ours + (size_t)a * rows, error);
    for (size_t r = 0; r < rows && status == VSC_OK; r++)
      mean[(size_t)a * rows + r] = reference_column(table, quantity->file_column, a, "mean")[r];
  }
  if (status == VSC_OK) measured->value = vsc_relative_distance(3 * rows, ours, mean);
  vsc_free(ours);
  vsc_free(mean);
  vsc_signals_free(table);
  return status;
}

// Reference curves are given to 1e-4 mm, and differ by less at rest.
static const double band_slack = 0.01;

vsc_status vsc_measure_band(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                            vsc_measured *measured, vsc_error *error)
{
  vsc_signals *table;
  vsc_status status = vsc_open_reference(outcome, quantity, &table, measured, error);
  if (status != VSC_OK || table == NULL) return status;
  double *ours;
  if (!VSC_NEW(ours, table->rows)) status = vsc_fail_memory(error, "a history");
  if (status == VSC_OK) status = sample_history(outcome, quantity, table, quantity->axis, ours, error);
  if (status == VSC_OK)
    measured->value =
        100 * vsc_band_share(table->rows, ours,
                             reference_column(table, quantity->file_column, quantity->axis, "min"),
                             reference_column(table, quantity->file_column, quantity->axis, "max"),
                             band_slack);
  vsc_free(ours);
  vsc_signals_free(table);
  return status;
}

vsc_status vsc_measure_team_band(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                 vsc_measured *measured, vsc_error *error)
{
  vsc_signals *table;
  vsc_status status = vsc_open_reference(outcome, quantity, &table, measured, error);
  if (status != VSC_OK || table == NULL) return status;
  const double *teams[VSC_MOST_CURVES];
  char ending[VSC_NAME];
  size_t count = 0;
  snprintf(ending, sizeof ending, "_%s_u%c_mm", quantity->file_column, "xyz"[quantity->axis]);
  for (size_t c = 0; c < table->columns && count < VSC_MOST_CURVES; c++) {
    const size_t length = strlen(table->names[c]), tail = strlen(ending);
    if (length > tail && strcmp(table->names[c] + length - tail, ending) == 0)
      teams[count++] = table->values + c * table->rows;
  }
  measured->value = 100 * vsc_left_out_share(count, table->rows, teams, band_slack);
  if (count < 2)
    status = vsc_fail(error, VSC_INPUT, "%s: fewer than two columns end in %s", quantity->file, ending);
  vsc_signals_free(table);
  return status;
}
