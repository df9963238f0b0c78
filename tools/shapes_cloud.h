// SPDX-License-Identifier: GPL-3.0-or-later
// A box of unstructured tets: well-spaced points, scattered by chance, and their Delaunay
// tetrahedralisation.
#ifndef VSC_TOOLS_SHAPES_CLOUD_H
#define VSC_TOOLS_SHAPES_CLOUD_H

#include "mesh/mesh.h"

// A box from the origin to `size`.
typedef struct vsc_cloud_shape {
  double size[3];      // mm
  size_t points;       // nodes, at least 9
  unsigned long seed;  // of chance
} vsc_cloud_shape;

// 400 points in a cube of 10 mm.
vsc_cloud_shape vsc_cloud_default(void);

// The mesh: nodes in the corners, evenly along the edges, scattered over the faces and inside at
// about the same distance from one another; points inside and on faces are moved to the mean of
// their neighbours a few times, then those of the worst tets by chance until none is flat. The tets
// fill the box exactly. Node arrays x0, x1, y0, y1, z0, z1, 0 or 1, for its six faces; tet array
// `region`, 1. VSC_INPUT for an empty box, for fewer points than its edges want, and for more than
// 100,000; VSC_NUMERICAL where chance finds no sound mesh. The caller owns *mesh.
vsc_status vsc_cloud_mesh(const vsc_cloud_shape *shape, vsc_mesh **mesh, vsc_error *error);

#endif
