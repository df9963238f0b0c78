// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compare_order.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>

#include "io/vtk.h"
#include "tools/compare_fields.h"
#include "tools/order.h"
#include "tools/plot/signals.h"
#include "tools/results.h"

enum { FILE_NAME = 2 * VSC_RESULT_PATH };

// The runs with what is known of them. Zeroed it is empty.
typedef struct series {
  size_t count;
  vsc_signals *signals[VSC_MOST_RUNS];
  size_t elements[VSC_MOST_RUNS];
  double size[VSC_MOST_RUNS];
  const char *unit;                         // of the sizes
  char last[VSC_MOST_RUNS][FILE_NAME];  // file of the last frame
  double end[VSC_MOST_RUNS];                // its time, s
} series;

static vsc_status read_run(const char *folder, size_t k, series *s, vsc_error *error)
{
  char file[FILE_NAME];
  vsc_results results;
  vsc_mesh *mesh = NULL;
  snprintf(file, sizeof file, "%s/signals.csv", folder);
  vsc_status status = vsc_signals_read(file, &s->signals[k], error);
  if (status == VSC_OK && s->signals[k]->rows == 0)
    status = vsc_fail(error, VSC_INPUT, "%s: there is no row in it: let the run finish", file);
  if (status == VSC_OK) status = vsc_results_open(folder, &results, error);
  if (status != VSC_OK) return status;
  const size_t last = vsc_pvd_count(results.series) - 1;
  vsc_pvd_frame_path(results.pvd, results.series, last, s->last[k], sizeof s->last[k]);
  s->end[k] = vsc_pvd_time(results.series, last);
  vsc_results_close(&results);
  status = vsc_vtk_read_mesh(s->last[k], 1, &mesh, error);
  if (status != VSC_OK) return status;
  s->elements[k] = mesh->element_count;
  s->size[k] = vsc_mesh_element_size(mesh);
  vsc_mesh_free(mesh);
  return VSC_OK;
}

static vsc_status choose_sizes(const vsc_order_wish *wish, series *s, vsc_error *error)
{
  bool one_mesh = true;
  s->unit = "mm";
  for (size_t k = 1; k < s->count; k++)
    one_mesh = one_mesh && s->elements[k] == s->elements[0] &&
               fabs(s->size[k] - s->size[0]) <= 1e-9 * s->size[0];
  for (size_t k = 0; k < s->count; k++) {
    const double *steps = vsc_signals_find(s->signals[k], "step");
    if (wish->size_count > 0) s->size[k] = wish->sizes[k];
    else if (one_mesh && steps != NULL) s->size[k] = steps[s->signals[k]->rows - 1];
  }
  if (wish->size_count > 0) s->unit = "given";
  else if (one_mesh) s->unit = "ms";
  for (size_t k = 0; k < s->count; k++)
    if (!(s->size[k] > 0) || (k > 0 && !(s->size[k] < s->size[k - 1])))
      return vsc_fail(error, VSC_INPUT,
                      "%s: its size %g is not below that of the run before it (%g): name the runs from "
                      "coarse to fine, or give --sizes",
                      wish->runs[k], s->size[k], k > 0 ? s->size[k - 1] : INFINITY);
  return VSC_OK;
}

static vsc_status read_runs(const vsc_order_wish *wish, series *s, vsc_error *error)
{
  for (size_t k = 0; k < wish->run_count; k++) {
    const vsc_status status = read_run(wish->runs[k], k, s, error);
    s->count++;
    if (status != VSC_OK) return status;
  }
  for (size_t k = 1; k < s->count; k++)
    if (fabs(s->end[k] - s->end[0]) > 1e-9 * fabs(s->end[0]))
      return vsc_fail(error, VSC_INPUT, "%s ends at %g s and %s at %g s: runs of one end are compared",
                      wish->runs[k], s->end[k], wish->runs[0], s->end[0]);
  return choose_sizes(wish, s, error);
}

static void print_runs(const vsc_order_wish *wish, const series *s)
{
  printf("%-4s %13s %10s  %s\n", "run", "size", "elements", "folder");
  for (size_t k = 0; k < s->count; k++)
    printf("%-4zu %13.6g %10zu  %s\n", k + 1, s->size[k], s->elements[k], wish->runs[k]);
  printf("sizes: %s\n", strcmp(s->unit, "mm") == 0   ? "(volume/elements)^(1/3), mm"
                        : strcmp(s->unit, "ms") == 0 ? "time steps, ms"
                                                     : "as given");
}

// The orders of each three runs of a signal, and of its errors.
static void print_orders(const vsc_order_wish *wish, const series *s, const double *f)
{
  double e[VSC_MOST_RUNS];
  for (size_t k = 2; k < s->count; k++) {
    const vsc_order o = vsc_order_of(s->size + k - 2, f + k - 2);
    printf("runs %zu %zu %zu: ", k - 1, k, k + 1);
    if (o.trend == VSC_TREND_CONVERGES)
      printf("order %.4g, extrapolated %.10g, run %zu uncertain by %.3g\n", o.order, o.limit, k + 1,
             o.uncertainty);
    else
      printf("%s\n", vsc_trend_text(o.trend));
  }
  if (isnan(wish->exact)) return;
  printf("errors:");
  for (size_t k = 0; k < s->count; k++) printf(" %.6g", e[k] = fabs(f[k] - wish->exact));
  printf("; slope %.4g\n", vsc_order_slope(s->count, s->size, e));
}

static vsc_status print_signal(const vsc_order_wish *wish, const series *s, const char *name,
                               vsc_error *error)
{
  double f[VSC_MOST_RUNS];
  for (size_t k = 0; k < s->count; k++) {
    const double *values = vsc_signals_find(s->signals[k], name);
    if (values == NULL)
      return vsc_fail(error, VSC_INPUT, "%s/signals.csv has no column '%s'", wish->runs[k], name);
    f[k] = values[s->signals[k]->rows - 1];
  }
  printf("\n%s\n%-4s %17s %13s\n", name, "run", "value", "difference");
  for (size_t k = 0; k < s->count; k++) {
    printf("%-4zu %17.10g", k + 1, f[k]);
    if (k > 0) printf(" %13.6g", f[k] - f[k - 1]);
    putchar('\n');
  }
  print_orders(wish, s, f);
  return VSC_OK;
}

static vsc_status print_signals(const vsc_order_wish *wish, const series *s, vsc_error *error)
{
  vsc_status status = VSC_OK;
  for (size_t k = 0; k < wish->signal_count && status == VSC_OK; k++)
    status = print_signal(wish, s, wish->signals[k], error);
  const vsc_signals *first = s->signals[0];
  for (size_t c = 0; wish->signal_count == 0 && c < first->columns && status == VSC_OK; c++)
    if (strncmp(first->names[c], "cavity_", 7) == 0 || strncmp(first->names[c], "point_", 6) == 0)
      status = print_signal(wish, s, first->names[c], error);
  return status;
}

// The errors of one array by run, and their slope.
static void print_slope(const series *s, const vsc_comparison *errors, const vsc_norms *of_last)
{
  double e[VSC_MOST_RUNS];
  printf("%-24s %-8s", of_last->name, of_last->where);
  for (size_t k = 0; k + 1 < s->count; k++) {
    e[k] = NAN;
    for (size_t i = 0; i < errors[k].count; i++)
      if (strcmp(errors[k].arrays[i].name, of_last->name) == 0 &&
          strcmp(errors[k].arrays[i].where, of_last->where) == 0)
        e[k] = vsc_norms_rms(&errors[k].arrays[i], true);
    printf(" %12.5g", e[k]);
  }
  const double slope = vsc_order_slope(s->count - 1, s->size, e);
  if (isnan(slope)) puts("       -");
  else printf(" %7.3g\n", slope);
}

// The finest run itself is off by a part of its error, so that slopes come out steeper than the order,
// most of all between the last two.
static vsc_status print_fields(const vsc_order_wish *wish, const series *s, vsc_error *error)
{
  vsc_comparison errors[VSC_MOST_RUNS] = {{0}};
  vsc_status status = VSC_OK;
  const size_t coarser = s->count - 1;
  for (size_t k = 0; k < coarser && status == VSC_OK; k++) {
    vsc_pair pair = {.reach = wish->reach};
    status = vsc_compare_files(&errors[k], &pair, s->last[k], s->last[coarser], error);
    if (pair.left_out > 0)
      printf("\nrun %zu: %zu nodes lie outside run %zu, by up to %.3g mm, and are left out", k + 1,
             pair.left_out, s->count, pair.furthest);
    vsc_pair_free(&pair);
  }
  if (status == VSC_OK) {
    printf("\nRMS by volume of the last frames' differences from run %zu\n%-24s %-8s", s->count,
           "array", "on");
    for (size_t k = 0; k < coarser; k++) printf("        run %zu", k + 1);
    printf(" %7s\n", "slope");
    for (size_t i = 0; i < errors[0].count; i++) print_slope(s, errors, &errors[0].arrays[i]);
  }
  for (size_t k = 0; k < coarser; k++) vsc_comparison_free(&errors[k]);
  return status;
}

int vsc_compare_order(const vsc_order_wish *wish)
{
  vsc_error error;
  static series s;  // its names are long
  s = (series){0};
  vsc_status status = read_runs(wish, &s, &error);
  if (status == VSC_OK) {
    print_runs(wish, &s);
    status = print_signals(wish, &s, &error);
  }
  if (status == VSC_OK) status = print_fields(wish, &s, &error);
  for (size_t k = 0; k < s.count; k++) vsc_signals_free(s.signals[k]);
  if (status == VSC_OK) return VSC_OK;
  fflush(stdout);
  fprintf(stderr, "viscera: compare: %s\n", error.text);
  return (int)status;
}
