// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/compare_signals.h"

#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "tools/bench/curves.h"
#include "tools/results.h"

enum { DIFFERENT = 1 };
static const double SAME_TIME = 1e-9;  // part of the time

vsc_status vsc_curve_pair_read(const char *text, vsc_curve_pair *pair, vsc_error *error)
{
  char *const parts[4] = {pair->column, pair->reference, pair->low, pair->high};
  *pair = (vsc_curve_pair){.column = ""};
  const char *at = text;
  for (int k = 0; k < 4; k++) {
    const size_t length = strcspn(at, k == 0 ? "=" : ",");
    if (length == 0 || length >= VSC_NAME || (k == 0 && at[length] == '\0') ||
        (k == 2 && at[length] == '\0') || (k == 3 && at[length] != '\0'))
      return vsc_fail(error, VSC_INPUT,
                      "--column %s: expected COLUMN=REFERENCE or COLUMN=REFERENCE,LOW,HIGH", text);
    memcpy(parts[k], at, length);
    if (k == 1 && at[length] == '\0') return VSC_OK;
    at += length + 1;
  }
  return VSC_OK;
}

static vsc_status find_column(const vsc_signals *table, const char *name, const char *whose,
                              const double **values, vsc_error *error)
{
  const char *names[256];
  size_t count = 0;
  *values = vsc_signals_find(table, name);
  if (*values != NULL) return VSC_OK;
  for (; count < table->columns && count < 256; count++) names[count] = table->names[count];
  const char *nearest = vsc_nearest(name, names, count);
  return vsc_fail(error, VSC_INPUT, "%s has no column '%s'%s%s%s", whose, name,
                  nearest != NULL ? "; did you mean '" : "", nearest != NULL ? nearest : "",
                  nearest != NULL ? "'?" : "");
}

// The columns' values where the run has something to say.
typedef struct columns {
  const double *time, *value;  // of the run
  size_t rows;
  const double *when, *reference, *low, *high;
} columns;

static vsc_status find_columns(const vsc_signals *run, const vsc_signals *reference,
                               const vsc_curve_pair *pair, columns *c, vsc_error *error)
{
  *c = (columns){.time = run->values, .rows = run->rows, .when = reference->values};
  vsc_status status = find_column(run, pair->column, "the run", &c->value, error);
  if (status == VSC_OK)
    status = find_column(reference, pair->reference, "the reference", &c->reference, error);
  if (status == VSC_OK && pair->low[0] != '\0')
    status = find_column(reference, pair->low, "the reference", &c->low, error);
  if (status == VSC_OK && pair->high[0] != '\0')
    status = find_column(reference, pair->high, "the reference", &c->high, error);
  return status;
}

// The run's value at a time, linear between rows; false before the first and after the last.
static bool value_at(const columns *c, double time, double *value)
{
  const double rounding = SAME_TIME * fabs(time);
  if (c->rows == 0 || time < c->time[0] - rounding || time > c->time[c->rows - 1] + rounding)
    return false;
  *value = vsc_curve_at(c->rows, c->time, c->value, time);
  return true;
}

vsc_status vsc_curve_compare(const vsc_signals *run, const vsc_signals *reference,
                             const vsc_curve_pair *pair, vsc_curve_distance *distance,
                             vsc_error *error)
{
  columns c;
  vsc_curve_distance d = {.largest = -1};
  double before[3] = {0};  // time, (a - b)^2, b^2 of the last point
  const vsc_status status = find_columns(run, reference, pair, &c, error);
  if (status != VSC_OK) return status;
  for (size_t k = 0; k < reference->rows; k++) {
    double a;
    if (!value_at(&c, c.when[k], &a)) {
      d.missing++;
      continue;
    }
    const double b = c.reference[k], apart = fabs(a - b);
    const double now[3] = {c.when[k], apart * apart, b * b};
    if (d.points++ > 0) {
      d.squares += 0.5 * (now[0] - before[0]) * (now[1] + before[1]);
      d.reference += 0.5 * (now[0] - before[0]) * (now[2] + before[2]);
    }
    memcpy(before, now, sizeof now);
    if (!(apart <= d.largest)) {
      d.largest = apart;
      d.when = now[0];
    }
    if (c.low == NULL) continue;
    d.banded++;
    d.within += a >= c.low[k] && a <= c.high[k];
  }
  if (d.points < 2)
    return vsc_fail(error, VSC_INPUT,
                    "%s: the run has %zu of the reference's %zu times: is the first column of both the "
                    "time, in one unit?",
                    pair->column, d.points, reference->rows);
  *distance = d;
  return VSC_OK;
}

double vsc_curve_relative(const vsc_curve_distance *distance)
{
  if (distance->squares == 0) return 0;
  return distance->reference > 0 ? sqrt(distance->squares / distance->reference) : INFINITY;
}

static void add(vsc_curve_distance *all, const vsc_curve_distance *one)
{
  all->points += one->points;
  all->missing += one->missing;
  all->squares += one->squares;
  all->reference += one->reference;
  if (one->largest > all->largest) {
    all->largest = one->largest;
    all->when = one->when;
  }
  all->banded += one->banded;
  all->within += one->within;
}

static double share_of(const vsc_curve_distance *d)
{
  return d->banded > 0 ? (double)d->within / (double)d->banded : NAN;
}

static void print_row(const char *name, const char *reference, const vsc_curve_distance *d)
{
  printf("%-24s %-20s %7zu %13.6g %13.6g %11.6g", name, reference, d->points, vsc_curve_relative(d),
         d->largest, d->when);
  if (d->banded > 0) printf(" %8.1f %%\n", 100 * share_of(d));
  else puts("          -");
}

static vsc_status print_all(const vsc_signals *run, const vsc_signals *reference, size_t count,
                            const vsc_curve_pair *pairs, vsc_curve_distance *all, vsc_error *error)
{
  *all = (vsc_curve_distance){.largest = -1};
  printf("%-24s %-20s %7s %13s %13s %11s %10s\n", "column", "reference", "times", "relative L2",
         "max abs", "at", "in band");
  for (size_t k = 0; k < count; k++) {
    vsc_curve_distance one;
    const vsc_status status = vsc_curve_compare(run, reference, &pairs[k], &one, error);
    if (status != VSC_OK) return status;
    print_row(pairs[k].column, pairs[k].reference, &one);
    add(all, &one);
  }
  if (count > 1) print_row("together", "", all);
  if (all->missing > 0)
    printf("times of the reference that the run does not reach: %zu\n", all->missing / count);
  return VSC_OK;
}

int vsc_compare_signals(const char *run, const char *reference, size_t count,
                        const vsc_curve_pair *pairs, double tolerance, double share)
{
  vsc_error error;
  vsc_signals *first = NULL, *second = NULL;
  vsc_curve_distance all;
  char file[VSC_RESULT_PATH];
  struct stat facts;
  const bool folder = stat(run, &facts) == 0 && S_ISDIR(facts.st_mode);
  snprintf(file, sizeof file, "%s%s", run, folder ? "/signals.csv" : "");
  vsc_status status = vsc_signals_read(file, &first, &error);
  if (status == VSC_OK) status = vsc_signals_read(reference, &second, &error);
  if (status == VSC_OK) status = print_all(first, second, count, pairs, &all, &error);
  vsc_signals_free(first);
  vsc_signals_free(second);
  if (status != VSC_OK) {
    fflush(stdout);
    fprintf(stderr, "viscera: compare: %s\n", error.text);
    return (int)status;
  }
  const bool near = vsc_curve_relative(&all) <= tolerance;
  const bool inside = !(share > 0) || share_of(&all) >= share;
  if (!near) printf("above the tolerance: relative L2 %.6g\n", vsc_curve_relative(&all));
  if (!inside) printf("outside the bands too often: %.1f %% within\n", 100 * share_of(&all));
  const bool reached = all.missing == 0 || !(isfinite(tolerance) || share > 0);
  return near && inside && reached ? VSC_OK : DIFFERENT;
}
