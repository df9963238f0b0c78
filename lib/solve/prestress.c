// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/prestress.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"

#define LEAST_RELAXATION 0.01

// The iteration's memory: where it stands, and the try from there.
typedef struct search {
  const vsc_prestress *problem;
  double *rest, *x;          // the best rest shape so far and its loaded shape
  double *try_rest, *try_x;  // node_count x 4
  vsc_prestress_row best;
  vsc_error reason;  // why the last try has no loaded shape
} search;

// A number that is no number counts as infinitely far.
static void measure(const vsc_prestress *problem, const double *x, vsc_prestress_row *row)
{
  double sum = 0, most = 0;
  for (size_t n = 0; n < problem->node_count; n++) {
    double way[3];
    vsc_subtract(problem->target + 4 * n, x + 4 * n, way);
    sum += vsc_dot(way, way);
    most = fmax(most, vsc_norm(way));
  }
  row->mean = isfinite(sum) ? sqrt(sum / (double)problem->node_count) : INFINITY;
  row->largest = isfinite(sum) ? most : INFINITY;
}

static void swap(double **a, double **b)
{
  double *kept = *a;
  *a = *b;
  *b = kept;
}

// Loads the shape that is tried and, when it is nearer, goes on from there.
static vsc_status try_shape(search *s, int iteration, double relaxation, bool *nearer,
                            vsc_error *error)
{
  const vsc_prestress *problem = s->problem;
  vsc_prestress_row row = {.iteration = iteration, .relaxation = relaxation,
                           .largest = INFINITY, .mean = INFINITY};
  const vsc_status status = problem->load(problem->context, s->try_rest, s->try_x, &s->reason);
  if (status != VSC_OK && status != VSC_NUMERICAL) return vsc_fail(error, status, "%s", s->reason.text);
  if (status == VSC_OK) measure(problem, s->try_x, &row);
  *nearer = row.mean < s->best.mean;
  if (*nearer) {
    s->best = row;
    swap(&s->rest, &s->try_rest);
    swap(&s->x, &s->try_x);
  }
  if (problem->watch != NULL) problem->watch(problem->context, &row);
  return VSC_OK;
}

static vsc_status iterate(search *s, vsc_error *error)
{
  const vsc_prestress *problem = s->problem;
  const size_t count = 4 * problem->node_count;
  double relaxation = 1;
  bool nearer;
  memcpy(s->try_rest, problem->target, count * sizeof *s->try_rest);
  vsc_status status = try_shape(s, 0, 0, &nearer, error);
  if (status != VSC_OK) return status;
  if (!nearer)
    return vsc_fail(error, VSC_NUMERICAL,
                    "prestress: the shape that is given does not bear the loads as a rest shape; take smaller loads or "
                    "stiffer tissue: %s", s->reason.text);
  for (int k = 1; k <= problem->most && s->best.largest > problem->tolerance; k++) {
    for (size_t i = 0; i < count; i++)
      s->try_rest[i] = s->rest[i] + relaxation * (problem->target[i] - s->x[i]);
    status = try_shape(s, k, relaxation, &nearer, error);
    if (status != VSC_OK) return status;
    if (!nearer) relaxation /= 2;
    if (relaxation < LEAST_RELAXATION) break;
  }
  if (s->best.largest <= problem->tolerance) return VSC_OK;
  return vsc_fail(error, VSC_NUMERICAL,
                  "prestress: the loaded shape stays %.3g mm off (%.3g mm on average), wanted are %.3g "
                  "mm; take more iterations, smaller loads or stiffer tissue",
                  s->best.largest, s->best.mean, problem->tolerance);
}

vsc_status vsc_prestress_find(const vsc_prestress *problem, double *rest, double *x, vsc_error *error)
{
  const size_t count = 4 * problem->node_count;
  search s = {.problem = problem, .best = {.largest = INFINITY, .mean = INFINITY}};
  vsc_status status;
  if (VSC_NEW(s.rest, count) && VSC_NEW(s.x, count) && VSC_NEW(s.try_rest, count) &&
      VSC_NEW(s.try_x, count))
    status = iterate(&s, error);
  else
    status = vsc_fail_memory(error, "prestress");
  if (status == VSC_OK) memcpy(rest, s.rest, count * sizeof *rest);
  if (status == VSC_OK && x != NULL) memcpy(x, s.x, count * sizeof *x);
  vsc_free(s.rest);
  vsc_free(s.x);
  vsc_free(s.try_rest);
  vsc_free(s.try_x);
  return status;
}
