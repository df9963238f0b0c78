// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera bench accuracy` has measured: on stdout as it comes, then as a table for programs and a
// page for people.
#ifndef VSC_TOOLS_BENCH_REPORT_H
#define VSC_TOOLS_BENCH_REPORT_H

#include <stdio.h>

#include "tools/bench/problem.h"

typedef struct vsc_bench_row {
  vsc_bench_case of;
  const vsc_bench_quantity *quantity;  // NULL: the case failed before there was any
  double value, reference;             // in the quantity's unit; reference NAN: there is none
  double order;                        // observed (vsc_bench_order); NAN: there is none
  bool skipped;                        // what it is compared with is not there
  double elements, nodes, unknowns, iterations, steps;
  double cpu_seconds, megabytes;
  char failure[VSC_ERROR_TEXT];        // why there is no value; empty when there is one
} vsc_bench_row;

typedef struct vsc_bench_report {
  size_t count;
  vsc_bench_row *rows;  // owned; in the order of the cases
} vsc_bench_report;

typedef enum vsc_bench_verdict {
  VSC_BENCH_UNJUDGED,  // no target, or nothing to compare with
  VSC_BENCH_MET,
  VSC_BENCH_MISSED,    // or failed
} vsc_bench_verdict;

// Whether the row keeps to its quantity's targets: |value - reference| <= percent/100 |reference|, or
// <= within; order[0] <= order <= order[1]. Kinds and meshes that the quantity's targets are not for are not judged,
// nor what there is nothing to compare with.
vsc_bench_verdict vsc_bench_judge(const vsc_bench_row *row);

// Copies the row behind the others, finding its order; false when memory is short.
bool vsc_bench_keep(vsc_bench_report *report, const vsc_bench_row *row);

// The heading of the table on stdout, and a row of it that is kept.
void vsc_bench_print_heading(void);
void vsc_bench_print(const vsc_bench_row *row);

// Writes FOLDER/accuracy.csv and FOLDER/index.html. The page draws curves over those of the folder `reference` (NULL:
// there is none). VSC_SYSTEM when that fails.
vsc_status vsc_bench_write_csv(const vsc_bench_report *report, const char *folder, vsc_error *error);
vsc_status vsc_bench_write_page(const vsc_bench_report *report, const char *folder, const char *reference,
                                vsc_error *error);

void vsc_bench_report_free(vsc_bench_report *report);

// The observed order of the row's quantity, over the meshes of its kind and variant that are in the report, as they
// are up to the row's own when it is kept: the error goes with the size of an element, elements^(-1/3), to this power
// (vsc_observed_order). Where there is no
// reference, over its variant and the two before it, whose parameters are steps (vsc_own_order). NAN where
// there is none.
double vsc_bench_order(const vsc_bench_report *report, const vsc_bench_row *of);

#endif
