// SPDX-License-Identifier: GPL-3.0-or-later
// What it costs a whole run that points and signals are asked for.
#ifndef VSC_TOOLS_BENCH_LOOKING_H
#define VSC_TOOLS_BENCH_LOOKING_H

#include <stddef.h>
#include <stdio.h>

#include "base/status.h"

// Runs a block of springs of `tets` tets, twenty thousand at most, in `folder`, several times in turns: without points and
// with signals once, then with more of them. Says each one's processor time, ns a tet and step, and that over the first one
// on stdout, and in `csv` as rows of `viscera bench skipping`. Must not be called by a process whose threads have begun to
// work.
vsc_status vsc_bench_looking(FILE *csv, const char *folder, size_t tets, vsc_error *error);

#endif
