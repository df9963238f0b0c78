// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/report.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/text.h"
#include "io/replace.h"
#include "tools/bench/curves.h"

// Whether the targets of its quantity are for the row's kind and mesh.
static bool is_held(const vsc_bench_row *row)
{
  const vsc_bench_quantity *q = row->quantity;
  return (q->held == 0 || (q->held & row->of.kind->bit) != 0) && row->elements >= q->from &&
         (q->upto == 0 || row->elements <= q->upto);
}

vsc_bench_verdict vsc_bench_judge(const vsc_bench_row *row)
{
  const vsc_bench_quantity *q = row->quantity;
  if (row->failure[0] != '\0') return VSC_BENCH_MISSED;
  if (row->skipped || !is_held(row)) return VSC_BENCH_UNJUDGED;
  const double allowed = fmax(0.01 * q->percent * fabs(row->reference), q->within);
  const bool near = !isnan(row->reference) && allowed > 0, ordered = q->order[1] > 0 && !isnan(row->order);
  if (!near && !ordered) return VSC_BENCH_UNJUDGED;
  return (!near || fabs(row->value - row->reference) <= allowed) &&
                 (!ordered || (row->order >= q->order[0] && row->order <= q->order[1]))
             ? VSC_BENCH_MET
             : VSC_BENCH_MISSED;
}

bool vsc_bench_keep(vsc_bench_report *report, const vsc_bench_row *row)
{
  if (!vsc_grow((void **)&report->rows, report->count, report->count + 1, sizeof *row)) return false;
  vsc_bench_row *kept = &report->rows[report->count++];
  *kept = *row;
  kept->order = kept->quantity != NULL ? vsc_bench_order(report, kept) : NAN;
  return true;
}

void vsc_bench_report_free(vsc_bench_report *report)
{
  vsc_free(report->rows);
  *report = (vsc_bench_report){0};
}

static double error_of(const vsc_bench_row *row)
{
  return row->failure[0] == '\0' && !row->skipped ? fabs(row->value - row->reference) : NAN;
}

// The order in the parameter of the row's variant and the two before it.
static double order_of_steps(const vsc_bench_report *report, const vsc_bench_row *of)
{
  double h[3] = {0}, values[3] = {0};
  int found = 0;
  for (int k = 0; k < 3; k++) {
    const vsc_bench_variant *variant = of->of.variant - (2 - k);
    if (variant < of->of.problem->variants || variant->parameter == 0) return NAN;
    h[k] = variant->parameter;
    for (size_t r = 0; r < report->count; r++) {
      const vsc_bench_row *row = &report->rows[r];
      if (row->quantity != of->quantity || row->of.variant != variant || row->of.kind != of->of.kind ||
          row->of.size != of->of.size || row->failure[0] != '\0')
        continue;
      values[k] = row->value;
      found++;
    }
  }
  return found == 3 ? vsc_own_order(h, values) : NAN;
}

double vsc_bench_order(const vsc_bench_report *report, const vsc_bench_row *of)
{
  if (isnan(of->reference)) return order_of_steps(report, of);
  enum { MOST = 32 };
  double h[MOST], errors[MOST];
  size_t count = 0;
  for (size_t k = 0; k < report->count && count < MOST; k++) {
    const vsc_bench_row *row = &report->rows[k];
    if (row->quantity != of->quantity || row->of.variant != of->of.variant ||
        row->of.kind != of->of.kind)
      continue;
    h[count] = 1 / cbrt(row->elements);
    errors[count++] = error_of(row);
  }
  return vsc_observed_order(count, h, errors);
}

// ---- as it comes

// A target in words: "0.3 %", "0.13 mm", "order 2", "-".
static void write_target(const vsc_bench_row *row, char *text, size_t size)
{
  const vsc_bench_quantity *q = row->quantity;
  if (q == NULL || vsc_bench_judge(row) == VSC_BENCH_UNJUDGED)
    snprintf(text, size, "-");
  else if (isnan(row->reference))
    snprintf(text, size, "order %.2g", 0.5 * (q->order[0] + q->order[1]));
  else if (q->percent > 0)
    snprintf(text, size, "%g %%", q->percent);
  else
    snprintf(text, size, "%g %s", q->within, q->unit);
}

// "-" without one.
static void write_order(const vsc_bench_row *row, char *text, size_t size)
{
  if (isnan(row->order))
    snprintf(text, size, "-");
  else
    snprintf(text, size, "%.2f", row->order);
}

// The error in percent of the reference, or, of a reference that is 0, in its unit; "-" without one.
static void write_error(const vsc_bench_row *row, char *text, size_t size)
{
  if (row->skipped || isnan(row->reference))
    snprintf(text, size, "-");
  else if (row->reference == 0)
    snprintf(text, size, "%.4g %s", row->value, row->quantity->unit);
  else
    snprintf(text, size, "%+.3f %%", 100 * (row->value / row->reference - 1));
}

static const char *const verdicts[] = {
    [VSC_BENCH_UNJUDGED] = "", [VSC_BENCH_MET] = "met", [VSC_BENCH_MISSED] = "missed"};

void vsc_bench_print_heading(void)
{
  printf("%-32s %8s %8s %9s %8s %8s %6s  %-30s %12s %12s %11s %6s %8s\n", "case", "elements", "nodes",
         "unknowns", "CPU s", "MB", "Newton", "quantity", "value", "reference", "error", "order", "target");
}

void vsc_bench_print(const vsc_bench_row *row)
{
  char target[VSC_NAME], error[VSC_NAME], order[VSC_NAME];
  printf("%-32s ", row->of.name);
  if (row->failure[0] != '\0') {
    printf("FAILED  %s\n", row->failure);
  } else {
    write_target(row, target, sizeof target);
    write_error(row, error, sizeof error);
    write_order(row, order, sizeof order);
    printf("%8.0f %8.0f %9.0f %8.2f %8.0f %6.0f  %-30s ", row->elements, row->nodes, row->unknowns,
           row->cpu_seconds, row->megabytes, row->iterations, row->quantity->name);
    if (row->skipped)
      printf("skipped: there is no %s\n", row->quantity->file);
    else
      printf("%12.6g %12.6g %11s %6s %8s %s\n", row->value, row->reference, error, order, target,
             verdicts[vsc_bench_judge(row)]);
  }
  fflush(stdout);
}

// ---- for programs

vsc_status vsc_bench_write_csv(const vsc_bench_report *report, const char *folder, vsc_error *error)
{
  char file[VSC_FILE_NAME];
  vsc_replacement table;
  snprintf(file, sizeof file, "%s/accuracy.csv", folder);
  const vsc_status status = vsc_replace_begin(file, &table, error);
  if (status != VSC_OK) return status;
  FILE *stream = table.stream;
  fputs("case,problem,variant,kind,elements,nodes,unknowns,cpu_seconds,megabytes,newton_iterations,"
        "steps,quantity,unit,value,reference,order,target_percent,target_within,verdict,remark\n",
        stream);
  for (size_t k = 0; k < report->count; k++) {
    const vsc_bench_row *row = &report->rows[k];
    const vsc_bench_quantity *q = row->quantity;
    fprintf(stream, "%s,%s,%s,%s,%.0f,%.0f,%.0f,%.3f,%.1f,%.0f,%.0f,", row->of.name,
            row->of.problem->name, row->of.variant->name, row->of.kind->name, row->elements,
            row->nodes, row->unknowns, row->cpu_seconds, row->megabytes, row->iterations, row->steps);
    if (q == NULL)
      fputs(",,,,,,,", stream);
    else if (row->skipped)
      fprintf(stream, "\"%s\",%s,,,,%g,%g,", q->name, q->unit, q->percent, q->within);
    else
      fprintf(stream, "\"%s\",%s,%.10g,%.10g,%.4g,%g,%g,", q->name, q->unit, row->value, row->reference,
              row->order, q->percent, q->within);
    fprintf(stream, "%s,\"", verdicts[vsc_bench_judge(row)]);
    for (const char *c = row->failure; *c != '\0'; c++) fputc(*c == '"' ? '\'' : *c, stream);
    fprintf(stream, "%s\"\n", row->skipped ? "skipped: no reference curve" : "");
  }
  return vsc_replace_end(&table, false, error);
}
