// SPDX-License-Identifier: GPL-3.0-or-later
// Signals against time, drawn by PLplot into a cairo context.
#ifndef VSC_TOOLS_PLOT_GRAPHS_H
#define VSC_TOOLS_PLOT_GRAPHS_H

#include <cairo.h>

#include "tools/plot/signals.h"

// Draws cavity volumes, change of the wall volume and active tension, one under the other, into the
// upper left `width` x `height` pixels of the context, each with a mark at the time `mark`
// (seconds; NAN: none). A graph whose columns are missing is left out with a message to stderr.
vsc_status vsc_graphs_draw(cairo_t *cairo, double width, double height, const vsc_signals *signals,
                           double mark, vsc_error *error);

#endif
