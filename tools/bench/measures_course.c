// SPDX-License-Identifier: GPL-3.0-or-later
// What becomes of a column that is set in motion.
#include <math.h>
#include <stdio.h>

#include "base/mem.h"
#include "tools/bench/curves.h"
#include "tools/bench/measures.h"

// The displacement of a point over the rows of signals.csv, and their times.
typedef struct course {
  size_t rows;
  const double *time, *u[3];
} course;

static vsc_status open_course(const vsc_outcome *outcome, const char *name, course *course,
                              vsc_error *error)
{
  char column[VSC_NAME];
  course->rows = outcome->signals->rows;
  vsc_status status = vsc_find_column(outcome, "time", &course->time, error);
  for (int a = 0; a < 3 && status == VSC_OK; a++) {
    snprintf(column, sizeof column, "%s%c", name, "xyz"[a]);
    status = vsc_find_column(outcome, column, &course->u[a], error);
  }
  return status;
}

// ---- against a reference

// Ours and theirs at the reference's times, component by component, mm.
static vsc_status compare(const course *course, const vsc_bench_quantity *quantity,
                          const vsc_signals *table, double *ours, double *theirs, vsc_error *error)
{
  const double *at = vsc_signals_find(table, "t_s");
  for (int a = 0; a < 3; a++) {
    char column[VSC_NAME];
    snprintf(column, sizeof column, "u%c_%s_m", "xyz"[a], quantity->file_column);
    const double *metres = vsc_signals_find(table, column);
    if (at == NULL || metres == NULL)
      return vsc_fail(error, VSC_INPUT, "%s: no columns t_s and %s", quantity->file, column);
    for (size_t r = 0; r < table->rows; r++) {
      ours[(size_t)a * table->rows + r] = vsc_curve_at(course->rows, course->time, course->u[a], at[r]);
      theirs[(size_t)a * table->rows + r] = 1000 * metres[r];
    }
  }
  return VSC_OK;
}

vsc_status vsc_measure_course(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_measured *measured, vsc_error *error)
{
  course course;
  vsc_signals *table;
  double *ours, *theirs = NULL;
  vsc_status status = vsc_open_reference(outcome, quantity, &table, measured, error);
  if (status != VSC_OK || table == NULL) return status;
  if (!VSC_NEW(ours, 3 * table->rows) || !VSC_NEW(theirs, 3 * table->rows))
    status = vsc_fail_memory(error, "a history");
  if (status == VSC_OK) status = open_course(outcome, quantity->column, &course, error);
  if (status == VSC_OK) status = compare(&course, quantity, table, ours, theirs, error);
  if (status == VSC_OK) measured->value = vsc_relative_distance(3 * table->rows, ours, theirs);
  vsc_free(ours);
  vsc_free(theirs);
  vsc_signals_free(table);
  return status;
}

// ---- alone

static double square_at(const course *course, size_t row)
{
  double sum = 0;
  for (int a = 0; a < 3; a++) sum += course->u[a][row] * course->u[a][row];
  return sum;
}

vsc_status vsc_measure_return(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                              vsc_measured *measured, vsc_error *error)
{
  course course;
  const vsc_status status = open_course(outcome, quantity->column, &course, error);
  if (status != VSC_OK) return status;
  double most = 0;
  bool away = false;
  for (size_t r = 0; r < course.rows; r++) most = fmax(most, square_at(&course, r));
  for (size_t r = 1; r + 1 < course.rows; r++) {
    const double before = square_at(&course, r - 1), now = square_at(&course, r),
                 after = square_at(&course, r + 1);
    away |= now > most / 4;
    if (!away || course.time[r] < quantity->at[0] || now > most / 100 || now > before || now > after) continue;
    const double bend = before - 2 * now + after;
    measured->value = course.time[r] + (bend > 0 ? 0.5 * (before - after) / bend : 0) *
                                           (course.time[r + 1] - course.time[r]);
    return VSC_OK;
  }
  return vsc_fail(error, VSC_INPUT, "%s does not come back", quantity->column);
}

vsc_status vsc_measure_balance(const vsc_outcome *outcome, const vsc_bench_quantity *quantity,
                               vsc_measured *measured, vsc_error *error)
{
  (void)quantity;
  const double *lost, *kinetic;
  double worst = 0, most = 0;
  vsc_status status = vsc_find_column(outcome, "balance_error", &lost, error);
  if (status == VSC_OK) status = vsc_find_column(outcome, "energy_kinetic", &kinetic, error);
  if (status != VSC_OK) return status;
  for (size_t r = 0; r < outcome->signals->rows; r++) {
    worst = fmax(worst, fabs(lost[r]));
    most = fmax(most, kinetic[r]);
  }
  measured->value = 100 * worst / most;
  return VSC_OK;
}
