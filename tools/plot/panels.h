// SPDX-License-Identifier: GPL-3.0-or-later
// Several results side by side, in one scale and one colour bar.
#ifndef VSC_TOOLS_PLOT_PANELS_H
#define VSC_TOOLS_PLOT_PANELS_H

#include <stdbool.h>

#include "tools/plot/solid.h"

typedef struct vsc_panel {
  const char *source;   // a VTU file, or a folder with one series: the frame nearest to the time
  const char *caption;  // may be empty
} vsc_panel;

typedef struct vsc_panels {
  size_t count;
  vsc_panel *items;   // not owned
  const char *title;  // may be empty
  const char *array;  // point or cell array that gives the colours; NULL: length of displacement
  const char *unit;   // behind its name at the bar; may be empty
  double low, high;   // of the colours; NAN: what the panels have
  double time;        // s; NAN: the last frame
  double from[3];     // direction from which to look, across z
  int columns;        // panels in a row
  size_t sphere_count;
  double spheres[VSC_MOST_SPHERES][4];
} vsc_panels;

// Draws them into one PNG. VSC_INPUT for a missing file, folder or array.
vsc_status vsc_panels_draw(const vsc_panels *panels, const char *file, vsc_error *error);

#endif
