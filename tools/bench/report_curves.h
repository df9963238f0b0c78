// SPDX-License-Identifier: GPL-3.0-or-later
// Curves on the page of `viscera bench accuracy`: what runs have left, over what it is compared with.
#ifndef VSC_TOOLS_BENCH_REPORT_CURVES_H
#define VSC_TOOLS_BENCH_REPORT_CURVES_H

#include <stdio.h>

#include "tools/bench/report.h"

// Draws, as SVG, for each quantity of the problem whose rows begin at `first`: of a history (vsc_measure_history) each
// component over time, every case over the teams' band and mean; of a mid-wall line (vsc_measure_midline) its x and y over
// z, the finest mesh of each kind over the reference. Results are read from FOLDER/runs, curves of others from the folder
// `reference`; where either is not there nothing is drawn.
void vsc_bench_put_curves(FILE *page, const vsc_bench_report *report, size_t first, const char *folder,
                          const char *reference);

#endif
