// SPDX-License-Identifier: GPL-3.0-or-later
// A picture of a deformed mesh of any kind: its boundary with the edges of the elements, and the
// rigid things round it.
#ifndef VSC_TOOLS_PLOT_SOLID_H
#define VSC_TOOLS_PLOT_SOLID_H

#include "mesh/mesh.h"
#include "tools/plot/raster.h"
#include "tools/plot/view.h"

enum { VSC_MOST_SPHERES = 4 };

typedef struct vsc_solid {
  const vsc_mesh *mesh;        // triangles alone are drawn from both sides
  const double *displacement;  // node_count x 3, mm; NULL: at rest
  const double *values;        // node_count; NULL: 0
  double low, high;            // values that get the first and the last colour
  size_t sphere_count;
  double spheres[VSC_MOST_SPHERES][4];  // centre and radius, mm
} vsc_solid;

// Draws it whole; `low` (mm from the camera's centre) is the picture's lower left corner, `scale`
// its pixels per mm.
vsc_status vsc_solid_draw(const vsc_camera *camera, const vsc_solid *solid, const double low[2],
                          double scale, vsc_raster *raster, vsc_error *error);

#endif
