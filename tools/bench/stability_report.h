// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of `viscera bench stability`.
#ifndef VSC_TOOLS_BENCH_STABILITY_REPORT_H
#define VSC_TOOLS_BENCH_STABILITY_REPORT_H

#include "tools/bench/verdict.h"

typedef struct vsc_stability_row {
  vsc_stress_case of;
  vsc_verdict verdict;
} vsc_stability_row;

// Writes FOLDER/stability.csv, a line for each case. VSC_SYSTEM when that fails.
vsc_status vsc_stability_write(const vsc_stability_row *rows, size_t count, const char *folder, vsc_error *error);

// The counts of outcomes by stress and method, the cases that are wrong with the reason, each message of those that
// end inside out, were refused or stopped once, and the distribution of claimed over true steps, on stdout.
void vsc_stability_say(const vsc_stability_row *rows, size_t count);

// Whether nothing speaks against the step that is claimed: it is not above the true limit, small velocities stay
// below a hundred times what they were just below it, and grow 10^4 times above the limit. True where no step was
// measured.
bool vsc_step_holds(const vsc_verdict *verdict);

// No case is wrong, and each claimed step holds.
bool vsc_stability_holds(const vsc_stability_row *rows, size_t count);

#endif
