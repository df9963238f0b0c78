// SPDX-License-Identifier: GPL-3.0-or-later
// The page of pictures that a simulation's results make.
#ifndef VSC_TOOLS_PLOT_PAGE_H
#define VSC_TOOLS_PLOT_PAGE_H

#include "mesh/mesh.h"
#include "tools/plot/signals.h"
#include "tools/plot/view.h"

typedef struct vsc_page {
  char title[VSC_NAME];
  const vsc_signals *signals;  // not owned
  const vsc_mesh *mesh;        // not owned: the frame to show, its points at rest
  const double *displacement;  // node_count x 3, mm, not owned
  const double *tension;       // element_count, kPa, not owned; NULL: none
  double time;                 // of that frame, s
  bool chosen;                 // the user chose the time; else it is the most contracted one
  vsc_camera camera;
} vsc_page;

// Draws graphs and pictures into one PNG file, by way of a temporary name.
vsc_status vsc_page_draw(const vsc_page *page, const char *file, vsc_error *error);

#endif
