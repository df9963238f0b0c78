// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of a mesh: seen from the side, cut open along its long axis, coloured by an array.
#ifndef VSC_TOOLS_PLOT_VIEW_H
#define VSC_TOOLS_PLOT_VIEW_H

#include <stdbool.h>

#include "mesh/mesh.h"
#include "tools/plot/raster.h"

// What a pixel shows: a boundary face or the face of the cut.
enum { VSC_KIND_SURFACE = 1, VSC_KIND_CUT = 2 };

// Where the viewer stands. The picture plane has x to the right and y upwards.
typedef struct vsc_camera {
  double right[3], up[3], into[3];  // orthonormal: the picture's axes, and away from the viewer
  double axis[3];                   // the long axis, apex to base
  double cut[3];                    // normal of the cutting plane, towards the viewer
  double centre[3];                 // middle of the mesh at rest, on the cutting plane, mm
  bool whole;                       // not cut open
} vsc_camera;

// A camera that looks at the mesh across `axis` (any length) from the direction `from`, or, where
// that is NULL, from the side on which the mesh looks widest, raised by 18 degrees.
vsc_camera vsc_camera_make(const vsc_mesh *mesh, const double axis[3], const double *from,
                           bool whole);

// The extent of the deformed mesh in the picture plane, mm from the camera's centre, joined to what
// `low` and `high` say already.
void vsc_camera_extend(const vsc_camera *camera, const vsc_mesh *mesh, const double *displacement,
                       double low[2], double high[2]);

// The colour of a share (0 to 1) of the largest value: from resting tissue to dark red.
void vsc_view_colour(double share, double colour[3]);

// The mean of the elements' values at each node: node_values (node_count).
vsc_status vsc_to_nodes(const vsc_mesh *mesh, const double *element_values, double *node_values,
                        vsc_error *error);

// Draws the mesh, moved by `displacement` (node_count x 3, mm; NULL: at rest), coloured by
// `values` (one per element, averaged to the nodes; NULL: 0) as shares of `largest`. `low` (mm) is the
// picture's lower left corner, `scale` its pixels per mm.
vsc_status vsc_view_draw(const vsc_camera *camera, const vsc_mesh *mesh, const double *displacement,
                         const double *values, double largest, const double low[2], double scale,
                         vsc_raster *raster, vsc_error *error);

#endif
