// SPDX-License-Identifier: GPL-3.0-or-later
// Work-precision diagrams of `viscera bench error`: error against processor time, both logarithmic.
#ifndef VSC_TOOLS_PLOT_ERRORS_H
#define VSC_TOOLS_PLOT_ERRORS_H

#include "base/status.h"

// Draws error.csv into the PNG `file`: a diagram for each of its tables, in it a line for each series. VSC_INPUT when
// the CSV is not of that kind or has more than it can draw, VSC_SYSTEM when the picture cannot be written.
vsc_status vsc_errors_draw(const char *csv, const char *file, vsc_error *error);

#endif
