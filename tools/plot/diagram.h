// SPDX-License-Identifier: GPL-3.0-or-later
// Diagrams of lines with points, both axes logarithmic, side by side in one picture.
#ifndef VSC_TOOLS_PLOT_DIAGRAM_H
#define VSC_TOOLS_PLOT_DIAGRAM_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { VSC_MOST_DIAGRAMS = 4, VSC_MOST_SERIES = 10, VSC_MOST_POINTS = 16, VSC_DIAGRAM_TEXT = 96 };

typedef struct vsc_series {
  char name[VSC_DIAGRAM_TEXT];
  size_t count;
  double x[VSC_MOST_POINTS], y[VSC_MOST_POINTS];  // above 0
} vsc_series;

typedef struct vsc_diagram {
  char name[VSC_DIAGRAM_TEXT];  // by which vsc_diagram_keep finds it
  const char *title;            // NULL: its name
  size_t count;
  vsc_series items[VSC_MOST_SERIES];
} vsc_diagram;

typedef struct vsc_diagrams {
  const char *title, *x_label, *y_unit;  // the unit is written behind each number of the vertical axes
  size_t count;
  vsc_diagram items[VSC_MOST_DIAGRAMS];
} vsc_diagrams;

// Adds a point to a series of a diagram, both made where they are new. False when there are too many of something.
bool vsc_diagram_keep(vsc_diagrams *all, const char *diagram, const char *series, double x, double y);

// Draws them into the PNG `file`. VSC_SYSTEM when it cannot be written.
vsc_status vsc_diagrams_draw(const vsc_diagrams *all, const char *file, vsc_error *error);

#endif
