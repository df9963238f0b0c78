// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers as bars, one under the other, in groups.
#ifndef VSC_TOOLS_PLOT_BARS_H
#define VSC_TOOLS_PLOT_BARS_H

#include <stddef.h>

#include "base/status.h"

enum { VSC_MOST_BARS = 128, VSC_BAR_TEXT = 96 };

typedef struct vsc_bar {
  char group[VSC_BAR_TEXT];  // its heading is written where it changes
  char name[VSC_BAR_TEXT], text[VSC_BAR_TEXT];  // before the bar and behind it
  double value;
  double pale;  // a pale bar behind it, NAN: none
  double mark;  // a stroke across it, likewise
} vsc_bar;

typedef struct vsc_bars {
  const char *title, *value_name, *pale_name, *mark_name;  // the names for the legend; NULL: none
  double line;  // a line through all of them; NAN: none
  size_t count;
  vsc_bar items[VSC_MOST_BARS];
} vsc_bars;

// Draws them into the PNG `file`, all on one scale from 0. VSC_SYSTEM when it cannot be written.
vsc_status vsc_bars_draw(const vsc_bars *bars, const char *file, vsc_error *error);

#endif
