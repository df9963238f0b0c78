// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/verdict.h"

#include <limits.h>
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "tools/plot/signals.h"
#include "tools/results.h"

// A run's watch says 0.1; rows see less of the largest energy than its looks.
#define MOST_BALANCE 0.12
#define MOST_MADE 0.25
// The least energy that counts, mJ: far below that of 1 % strain in the block.
#define NO_ENERGY 1e-6
// Of an element, times its own: what no load of the list explains.
#define MOST_RATIO 1e3

const char *const vsc_verdict_names[VSC_VERDICTS] = {
    [VSC_SURVIVES] = "survives", [VSC_INSIDE_OUT] = "inside out", [VSC_REFUSED] = "refused", [VSC_STOPS] = "stops",
    [VSC_UNENDED] = "unended",   [VSC_WRONG] = "wrong"};

__attribute__((format(printf, 2, 3))) static void call_wrong(vsc_verdict *verdict, const char *format, ...)
{
  va_list list;
  va_start(list, format);
  verdict->kind = VSC_WRONG;
  vsnprintf(verdict->why, sizeof verdict->why, format, list);
  va_end(list);
}

static bool holds_one_of(const char *text, const char *const *words)
{
  for (; *words != NULL; words++)
    if (strstr(text, *words) != NULL) return true;
  return false;
}

// What of time, element or node, place, remedy and, where the balance has failed, energy, or where numbers are lost or
// forces do not balance the term that pulls most, a failure does not name.
static const char *missing_in(const char *text)
{
  static const char *const things[] = {"element ", "node ", NULL};
  static const char *const remedies[] = {"take ", "use ", "give ", "hold ", NULL};
  static const char *const forces[] = {" is no longer a finite number", " furthest out of balance, ", NULL};
  if (strstr(text, "at ") == NULL || strstr(text, " ms") == NULL) return "time";
  if (!holds_one_of(text, things)) return "element or node";
  if (strstr(text, ") mm") == NULL) return "place";
  if (strstr(text, "the energy balance ") != NULL && strstr(text, " most in the ") == NULL) return "energy";
  if (holds_one_of(text, forces) && strstr(text, " is that of ") == NULL) return "term";
  return holds_one_of(text, remedies) ? NULL : "remedy";
}

static double largest_of(const vsc_signals *table, const char *name)
{
  const double *column = vsc_signals_find(table, name);
  double most = 0;
  for (size_t r = 0; column != NULL && r < table->rows; r++) most = fmax(most, fabs(column[r]));
  return most;
}

// The largest energy or work of the run, mJ: that of the body, or what was done to it.
static double energy_scale(const vsc_signals *table)
{
  static const char *const stored[] = {"energy_kinetic", "energy_axial", "energy_angular", "energy_volume"};
  static const char *const works[] = {"work_active", "work_pressure", "dissipated", "energy_gravity", "work_supports"};
  double most = NO_ENERGY;
  for (size_t k = 0; k < sizeof works / sizeof works[0]; k++) most = fmax(most, largest_of(table, works[k]));
  for (size_t r = 0; r < table->rows; r++) {
    double sum = 0;
    for (size_t k = 0; k < sizeof stored / sizeof stored[0]; k++) sum += vsc_signals_find(table, stored[k])[r];
    most = fmax(most, sum);
  }
  return most;
}

static void judge_balance(const vsc_stress_case *at, const vsc_signals *table, vsc_verdict *verdict)
{
  const double *error = vsc_signals_find(table, "balance_error");
  const bool paper = strcmp(vsc_stress_laws[at->law], "paper") == 0;
  verdict->balance = NAN;
  if (at->method == VSC_STRESS_EQUILIBRIUM || paper) return;
  const double scale = energy_scale(table);
  double off = 0;
  for (size_t r = 0; r < table->rows; r++)
    off = fmax(off, (at->method == VSC_STRESS_IMPLICIT ? error[r] : fabs(error[r])) / scale);
  verdict->balance = off;
  if (off > (at->method == VSC_STRESS_IMPLICIT ? MOST_MADE : MOST_BALANCE))
    call_wrong(verdict, "the energy balance is off by %.0f %%", 100 * off);
}

static void judge_signals(const vsc_stress_case *at, const vsc_signals *table, vsc_verdict *verdict)
{
  for (size_t c = 0; c < table->columns; c++)
    for (size_t r = 0; r < table->rows; r++)
      if (!isfinite(table->values[c * table->rows + r])) {
        call_wrong(verdict, "%s is not finite", table->names[c]);
        return;
      }
  const double *low = vsc_signals_find(table, "J_min"), *high = vsc_signals_find(table, "J_max");
  const double *inside_out = vsc_signals_find(table, "inverted_elements");
  verdict->J_low = INFINITY;
  verdict->J_high = -INFINITY;
  for (size_t r = 0; r < table->rows; r++) {
    verdict->J_low = fmin(verdict->J_low, low[r]);
    verdict->J_high = fmax(verdict->J_high, high[r]);
    if (fmax(fabs(low[r]), fabs(high[r])) > MOST_RATIO || (low[r] <= 0 && inside_out[r] == 0)) {
      call_wrong(verdict, "volume ratios from %.3g to %.3g, %.0f elements inside out", low[r], high[r], inside_out[r]);
      return;
    }
  }
  verdict->inverted = inside_out[table->rows - 1];
  judge_balance(at, table, verdict);
}

// Elements that end inside out are no survival like others, and have to be told.
static void judge_inverted(const char *run, vsc_verdict *verdict)
{
  verdict->kind = VSC_INSIDE_OUT;
  snprintf(verdict->why, sizeof verdict->why, "%.0f elements inside out in the end", verdict->inverted);
  if (vsc_results_number(run, "inverted_elements") != verdict->inverted)
    call_wrong(verdict, "the summary does not tell of %.0f elements inside out", verdict->inverted);
}

// Nor is a body with corners inside out, or wound round edges, of which no signal tells.
static void judge_wound(const char *run, vsc_verdict *verdict)
{
  verdict->folded = vsc_results_number(run, "folded_elements");
  verdict->wound = vsc_results_number(run, "wound_edges");
  if (verdict->kind != VSC_SURVIVES || (verdict->folded == 0 && verdict->wound == 0)) return;
  if (isnan(verdict->folded) || isnan(verdict->wound)) {
    call_wrong(verdict, "the summary does not tell of corners inside out, or of edges with the body wound round them");
    return;
  }
  verdict->kind = VSC_INSIDE_OUT;
  snprintf(verdict->why, sizeof verdict->why, "%.0f elements inside out at a corner, the body wound round %.0f edges in the end",
           verdict->folded, verdict->wound);
}

void vsc_judge(const vsc_stress_case *at, const char *folder, vsc_status status, const vsc_error *error,
               vsc_verdict *verdict)
{
  char run[PATH_MAX], file[PATH_MAX];
  verdict->code = (int)status;
  snprintf(run, sizeof run, "%.4000s/run", folder);
  snprintf(file, sizeof file, "%.4000s/signals.csv", run);
  if (status != VSC_OK) snprintf(verdict->why, sizeof verdict->why, "%s", error->text);
  if (status == VSC_INPUT) {
    verdict->kind = strstr(error->text, ": ") != NULL ? VSC_REFUSED : VSC_WRONG;
    return;
  }
  if (status != VSC_OK && status != VSC_NUMERICAL) {
    verdict->kind = VSC_WRONG;
    return;
  }
  if (status == VSC_NUMERICAL && strstr(error->text, "larger --limit") != NULL) {
    verdict->kind = VSC_UNENDED;
    return;
  }
  vsc_signals *table;
  vsc_error unread;
  verdict->steps = vsc_results_number(run, "steps");
  verdict->repeated = vsc_results_number(run, at->method <= VSC_STRESS_COUPLED ? "stretches_repeated_with_shorter_steps"
                                                                                : "steps_rejected_this_run");
  if (vsc_signals_read(file, &table, &unread) != VSC_OK || table->rows == 0) {
    call_wrong(verdict, "nothing is left of the run");
    return;
  }
  verdict->kind = status == VSC_OK ? VSC_SURVIVES : VSC_STOPS;
  judge_signals(at, table, verdict);  // of a run that stops: the rows before
  if (verdict->kind == VSC_SURVIVES && verdict->inverted > 0) judge_inverted(run, verdict);
  judge_wound(run, verdict);
  vsc_signals_free(table);
  const char *missing = status == VSC_NUMERICAL ? missing_in(error->text) : NULL;
  if (missing != NULL) call_wrong(verdict, "no %s in: %.500s", missing, error->text);
}
