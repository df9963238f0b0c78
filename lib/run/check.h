// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene would do, said before it is run.
#ifndef VSC_RUN_CHECK_H
#define VSC_RUN_CHECK_H

#include <stdio.h>

#include "run/problem.h"

// Writes to `stream`, in some twenty lines, what was read, where the fibres came from, which force
// terms exist, the time step and the element that limits it, and what the run will cost (the time
// by doing a few steps); then what looks suspicious, one line each beginning with "warning".
// *warnings (may be NULL) is their number. Fails as vsc_start does.
vsc_status vsc_check(const vsc_problem *problem, FILE *stream, int *warnings, vsc_error *error);

// Only the warnings, to `stream`, each with `prefix` before it; those that would cost a run time only when `thorough`.
// Returns their number.
int vsc_check_warnings(const vsc_problem *problem, bool thorough, FILE *stream, const char *prefix);

#endif
