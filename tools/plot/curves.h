// SPDX-License-Identifier: GPL-3.0-or-later
// One signal of several runs against time, in one graph.
#ifndef VSC_TOOLS_PLOT_CURVES_H
#define VSC_TOOLS_PLOT_CURVES_H

#include <stdbool.h>

#include "base/status.h"
#include "tools/plot/panels.h"

typedef struct vsc_curves {
  size_t count;
  const vsc_panel *items;  // folders of results and their captions
  const char *title;       // may be empty
  const char *column;      // of signals.csv
  bool relative;           // as the change from its first value, %
} vsc_curves;

// Draws them into one PNG. VSC_INPUT for a missing table or column.
vsc_status vsc_curves_draw(const vsc_curves *curves, const char *file, vsc_error *error);

#endif
