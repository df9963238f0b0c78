// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/stability_report.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "io/replace.h"

static void write_text(FILE *file, const char *text)
{
  for (; *text != '\0'; text++) fputc(*text == '"' ? '\'' : *text, file);
}

vsc_status vsc_stability_write(const vsc_stability_row *rows, size_t count, const char *folder, vsc_error *error)
{
  char name[PATH_MAX];
  vsc_replacement table;
  snprintf(name, sizeof name, "%.4000s/stability.csv", folder);
  const vsc_status status = vsc_replace_begin(name, &table, error);
  if (status != VSC_OK) return status;
  FILE *file = table.stream;
  fputs("stress,law,element,method,outcome,exit_code,balance_error,J_min,J_max,inverted_at_end,folded_at_end,wound_at_end,"
        "repeated,steps,cpu_seconds,estimated_step_ms,true_step_ms,growth_below,growth_above,message\n", file);
  for (size_t k = 0; k < count; k++) {
    const vsc_stress_case *at = &rows[k].of;
    const vsc_verdict *v = &rows[k].verdict;
    fprintf(file, "%s,%s,%s,%s,%s,%d,%.3g,%.4g,%.4g,%g,%g,%g,%g,%g,%.3g,%.8g,%.8g,%.3g,%.3g,\"", vsc_stresses[at->stress].name,
            vsc_stress_laws[at->law], vsc_stress_kinds[at->kind], vsc_stress_methods[at->method],
            vsc_verdict_names[v->kind], v->code, v->balance, v->J_low, v->J_high, v->inverted, v->folded, v->wound,
            v->repeated, v->steps, v->cpu_seconds, v->claimed, v->limit, v->below, v->above);
    write_text(file, v->why);
    fputs("\"\n", file);
  }
  return vsc_replace_end(&table, false, error);
}

// ---- counts

static void say_line(const char *name, const size_t of[VSC_VERDICTS], const char *what)
{
  printf("  %-12s", name);
  for (int v = 0; v < VSC_VERDICTS; v++) printf(" %10zu", of[v]);
  printf("  %s\n", what);
}

// By stress (`which` 0), method (1), law (2), kind of element (3), or all (4).
static void say_counts(const vsc_stability_row *rows, size_t count, int which, size_t groups, const char *const *names)
{
  for (size_t g = 0; g < groups; g++) {
    size_t of[VSC_VERDICTS] = {0};
    for (size_t k = 0; k < count; k++) {
      const vsc_stress_case *at = &rows[k].of;
      const size_t place[] = {at->stress, at->method, at->law, at->kind, 0};
      of[rows[k].verdict.kind] += place[which] == g;
    }
    say_line(which == 0 ? vsc_stresses[g].name : names[g], of, which == 0 ? vsc_stresses[g].what : "");
  }
}

// Messages alike but for their numbers are told once.
static bool is_alike(const char *a, const char *b)
{
  static const char digits[] = "0123456789.+-e";
  while (*a != '\0' && *b != '\0') {
    a += strspn(a, digits);
    b += strspn(b, digits);
    if (*a != *b) return false;
    if (*a != '\0') a++, b++;
  }
  return *a == *b;
}

static void say_messages(const vsc_stability_row *rows, size_t count, vsc_verdict_kind kind)
{
  for (size_t k = 0; k < count; k++) {
    if (rows[k].verdict.kind != kind) continue;
    bool told = false;
    size_t alike = 0;
    for (size_t m = 0; m < count; m++) {
      if (rows[m].verdict.kind != kind || !is_alike(rows[m].verdict.why, rows[k].verdict.why)) continue;
      told = told || m < k;
      alike++;
    }
    if (!told) printf("  %4zu x %-44s %s\n", alike, rows[k].of.name, rows[k].verdict.why);
  }
}

// ---- steps

static bool has_steps(const vsc_verdict *v)
{
  return v->claimed > 0 && isfinite(v->limit);
}

bool vsc_step_holds(const vsc_verdict *v)
{
  return !has_steps(v) || (v->claimed <= v->limit && v->below < 100 && v->above > 1e4);
}

static void say_steps(const vsc_stability_row *rows, size_t count)
{
  double *part;
  size_t found = 0, above = 0, grown = 0, kept = 0;
  if (!VSC_NEW(part, count)) return;
  for (size_t k = 0; k < count; k++)
    if (has_steps(&rows[k].verdict)) {
      part[found++] = rows[k].verdict.claimed / rows[k].verdict.limit;
      above += rows[k].verdict.claimed > rows[k].verdict.limit;
      grown += !(rows[k].verdict.below < 100);
      kept += !(rows[k].verdict.above > 1e4);
      if (!vsc_step_holds(&rows[k].verdict))
        printf("  %s: estimated %g, true %g ms, times %.3g below, times %.3g above\n", rows[k].of.name,
               rows[k].verdict.claimed, rows[k].verdict.limit, rows[k].verdict.below, rows[k].verdict.above);
    }
  qsort(part, found, sizeof *part, vsc_compare_doubles);
  if (found > 0)
    printf("\nestimated over true stable step (before safety, by which it is multiplied), %zu cases:\n"
           "  least %.3f, a tenth below %.3f, half below %.3f, nine tenths below %.3f, most %.3f; above 1: %zu\n"
           "  10^5 steps of 0.98 of the estimate grow in %zu cases, 2000 steps of 1.1 of the true limit stay small in %zu\n",
           found, part[0], part[found / 10], part[found / 2], part[9 * found / 10], part[found - 1], above, grown, kept);
  vsc_free(part);
}

void vsc_stability_say(const vsc_stability_row *rows, size_t count)
{
  static const char *const all[] = {"all"};
  printf("  %-12s", "");
  for (int v = 0; v < VSC_VERDICTS; v++) printf(" %10s", vsc_verdict_names[v]);
  printf("\n");
  say_counts(rows, count, 0, vsc_stress_count, NULL);
  say_counts(rows, count, 1, VSC_STRESS_METHODS, vsc_stress_methods);
  say_counts(rows, count, 2, vsc_stress_law_count, vsc_stress_laws);
  say_counts(rows, count, 3, vsc_stress_kind_count, vsc_stress_kinds);
  say_counts(rows, count, 4, 1, all);
  for (vsc_verdict_kind kind = VSC_INSIDE_OUT; kind < VSC_VERDICTS; kind++) {
    printf("\n%s:\n", vsc_verdict_names[kind]);
    say_messages(rows, count, kind);
  }
  say_steps(rows, count);
}

bool vsc_stability_holds(const vsc_stability_row *rows, size_t count)
{
  for (size_t k = 0; k < count; k++)
    if (rows[k].verdict.kind == VSC_WRONG || !vsc_step_holds(&rows[k].verdict)) return false;
  return true;
}
