// SPDX-License-Identifier: GPL-3.0-or-later
// What Land et al. 2015 look at: the beam of their problem 1, the ventricles of problems 2 and 3.
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "tools/bench/curves.h"
#include "tools/bench/measures.h"
#include "tools/results.h"

// The point of the wall at depth t, part s of the meridian and azimuth `turn` (0: y = 0, x <= 0):
//   x = rs sin u cos v, y = rs sin u sin v, z = rl cos u,  u = -pi + s (pi - arccos (5 / rl))
static void wall_point(double t, double s, double turn, double at[3])
{
  const double rs = 7 + 3 * t, rl = 17 + 3 * t;
  const double u = -M_PI + s * (M_PI - acos(5 / rl));
  at[0] = rs * sin(u) * cos(turn);
  at[1] = rs * sin(u) * sin(turn);
  at[2] = rl * cos(u);
}

vsc_status vsc_midline_point(const vsc_outcome *outcome, double s, double now[3], vsc_error *error)
{
  double at[3];
  wall_point(0.5, s, 0, at);
  return vsc_moved_point(outcome, at, now, error);
}

vsc_status vsc_measure_midline_peak(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                    vsc_measured *measured, vsc_error *error)
{
  (void)quantity;
  measured->value = -INFINITY;
  for (int k = 2; k <= 100; k++) {
    double now[3];
    const vsc_status status = vsc_midline_point(outcome, 0.01 * k, now, error);
    if (status != VSC_OK) return status;
    measured->value = fmax(measured->value, now[1]);
  }
  return VSC_OK;
}

vsc_status vsc_measure_midline(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                               vsc_measured *measured, vsc_error *error)
{
  static const char *const names[3] = {"x_mm", "y_mm", "z_mm"};
  vsc_signals *table;
  vsc_status status = vsc_open_reference(outcome, quantity, &table, measured, error);
  if (status != VSC_OK || table == NULL) return status;
  measured->value = 0;
  const double *s = vsc_signals_find(table, "s");
  for (size_t r = 0; r < table->rows && status == VSC_OK; r++) {
    if (s[r] < 0.02) continue;
    double now[3], apart = 0;
    status = vsc_midline_point(outcome, s[r], now, error);
    for (int a = 0; a < 3 && status == VSC_OK; a++)
      apart += pow(now[a] - vsc_signals_find(table, names[a])[r], 2);
    measured->value = fmax(measured->value, sqrt(apart));
  }
  vsc_signals_free(table);
  return status;
}

// Percent by which the distance of two points of the wall has changed.
static vsc_status strain(const vsc_outcome *outcome, const double a[3], const double b[3],
                         double *percent, vsc_error *error)
{
  double now_a[3], now_b[3], rest = 0, now = 0;
  vsc_status status = vsc_moved_point(outcome, a, now_a, error);
  if (status == VSC_OK) status = vsc_moved_point(outcome, b, now_b, error);
  if (status != VSC_OK) return status;
  for (int k = 0; k < 3; k++) {
    rest += (a[k] - b[k]) * (a[k] - b[k]);
    now += (now_a[k] - now_b[k]) * (now_a[k] - now_b[k]);
  }
  *percent = 100 * (sqrt(now / rest) - 1);
  return VSC_OK;
}

// ---- the beam

vsc_status vsc_measure_beam_line(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                 vsc_measured *measured, vsc_error *error)
{
  static const double rest[4] = {5, 7.5, 9, 10};
  static const double there[4][3] = {
      {4.8307, 0.5, 1.6581}, {7.1204, 0.5, 2.6611}, {8.4814, 0.5, 3.2919}, {9.388, 0.5, 3.714}};
  (void)quantity;
  measured->value = 0;
  for (int k = 0; k < 4; k++) {
    const double at[3] = {rest[k], 0.5, 0.5};
    double now[3];
    const vsc_status status = vsc_moved_point(outcome, at, now, error);
    if (status != VSC_OK) return status;
    measured->value =
        fmax(measured->value, hypot(hypot(now[0] - there[k][0], now[1] - there[k][1]), now[2] - there[k][2]));
  }
  return VSC_OK;
}

vsc_status vsc_measure_beam_strains(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                                    vsc_measured *measured, vsc_error *error)
{
  static const double step[3] = {1, 0.4, 0.4};
  static const double there[3][10] = {
      {-0.1561, -0.1049, -0.0645, -0.0346, -0.0153, -0.0039, 0.0020, 0.0046, 0.0054, NAN},
      {0, 0.3813, 0.2474, 0.1553, 0.0947, 0.0576, 0.0369, 0.0270, 0.0233, 0.0223},
      {0, 0.8831, 0.7253, 0.5749, 0.4326, 0.3043, 0.1940, 0.1051, 0.0399, 0}};
  (void)quantity;
  measured->value = 0;
  for (int axis = 0; axis < 3; axis++)
    for (int k = 0; k < 10; k++) {
      const double at[3] = {k, 0.5, 0.5};
      double next[3] = {k, 0.5, 0.5}, here;
      next[axis] += step[axis];
      if (isnan(there[axis][k])) continue;
      const vsc_status status = strain(outcome, at, next, &here, error);
      if (status != VSC_OK) return status;
      measured->value = fmax(measured->value, fabs(here - there[axis][k]));
    }
  return VSC_OK;
}

// ---- the strains of the ventricles

// The strain at point `k` (1 to 10) of a layer ("endo", "mid", "epi") in a direction ("circ", "long",
// "trans").
static vsc_status strain_at(const vsc_outcome *outcome, const char *layer, const char *direction, int k,
                            double *percent, vsc_error *error)
{
  const int number = strcmp(layer, "endo") == 0 ? 0 : strcmp(layer, "mid") == 0 ? 1 : 2;
  // through the wall: from inside to its middle, from inside to outside, from the middle to outside
  static const double from[3] = {0.1, 0.1, 0.5}, to[3] = {0.5, 0.9, 0.9};
  const double depth = 0.1 + 0.4 * number, s = 0.095 * k;
  double a[3], b[3];
  wall_point(depth, s, 0, a);
  if (strcmp(direction, "circ") == 0) {
    wall_point(depth, s, M_PI / 10, b);
  } else if (strcmp(direction, "long") == 0) {
    wall_point(depth, s + 0.095, 0, b);
  } else {
    wall_point(from[number], s, 0, a);
    wall_point(to[number], s, 0, b);
  }
  return strain(outcome, a, b, percent, error);
}

// One line of the table: problem, layer, direction, then a number for each point. Widens *most to the
// largest difference; lines of other problems do nothing.
static vsc_status compare_line(const vsc_outcome *outcome, int problem, const char *line, double *most,
                               vsc_error *error)
{
  int number, used = 0;
  char layer[VSC_NAME], direction[VSC_NAME];
  if (sscanf(line, "%d,%63[^,],%63[^,]%n", &number, layer, direction, &used) != 3 || number != problem)
    return VSC_OK;
  double there, here = 0;
  for (int k = 1, step = 0; k <= 9 && sscanf(line + used, ",%lf%n", &there, &step) == 1; k++) {
    used += step;
    if (k < 2) continue;
    const vsc_status status = strain_at(outcome, layer, direction, k, &here, error);
    if (status != VSC_OK) return status;
    *most = fmax(*most, fabs(here - there));
  }
  return VSC_OK;
}

vsc_status vsc_measure_strains(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                               vsc_measured *measured, vsc_error *error)
{
  char file[VSC_RESULT_PATH], line[512];
  snprintf(file, sizeof file, "%s/%s", outcome->reference != NULL ? outcome->reference : "",
           quantity->file);
  measured->skipped = outcome->reference == NULL || access(file, R_OK) != 0;
  if (measured->skipped) return VSC_OK;
  FILE *table = fopen(file, "r");
  if (table == NULL) return vsc_fail(error, VSC_INPUT, "%s: can't be read", file);
  vsc_status status = VSC_OK;
  measured->value = 0;
  while (status == VSC_OK && fgets(line, sizeof line, table) != NULL)
    status = compare_line(outcome, quantity->axis, line, &measured->value, error);
  fclose(table);
  return status;
}
