// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of what `viscera bench throughput`, `growth`, `skipping` and `start` have measured.
#ifndef VSC_TOOLS_PLOT_BENCH_H
#define VSC_TOOLS_PLOT_BENCH_H

#include "base/status.h"

// Draws the table of one of these sections, which is told by its heading, into the PNG `file`: bars, of growth two diagrams.
// VSC_INPUT when the CSV is of none of them or has more than can be drawn, VSC_SYSTEM when the picture cannot be written.
vsc_status vsc_bench_picture(const char *csv, const char *file, vsc_error *error);

#endif
