// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces made of triangles: a flat sheet and a tube.
#ifndef VSC_TOOLS_SHAPES_SHEET_H
#define VSC_TOOLS_SHAPES_SHEET_H

#include "mesh/mesh.h"

// A rectangle in the plane z = 0, from the origin to `size`, cut into rectangles of two triangles
// each, whose diagonals lie this way and that by turns.
typedef struct vsc_sheet_shape {
  size_t cells[2];     // rectangles along x, y
  double size[2];      // mm
  double jitter;       // inner nodes are moved by up to this part of a cell along x and y, 0 to 0.3
  unsigned long seed;  // of the jitter
} vsc_sheet_shape;

// 20 x 20 cells of a square of 10 mm, no jitter.
vsc_sheet_shape vsc_sheet_default(void);

// The mesh of the sheet, triangles only, normals along +z: node arrays x0, x1, y0, y1, 0 or 1, for
// its four edges. VSC_INPUT for an empty sheet. The caller owns *mesh.
vsc_status vsc_sheet_mesh(const vsc_sheet_shape *shape, vsc_mesh **mesh, vsc_error *error);

// The surface of a cylinder about z, from z = 0 to `length`, cut in the same way.
typedef struct vsc_tube_shape {
  double radius;  // mm
  double length;  // mm
  size_t around;  // cells round the circumference; the first nodes lie at +x
  size_t along;   // cells along z
} vsc_tube_shape;

// Radius 10 mm, length 40 mm, 32 x 20 cells.
vsc_tube_shape vsc_tube_default(void);

// The mesh of the tube, triangles only, normals outwards: node arrays z0, z1, 0 or 1, for its two
// ends. VSC_INPUT for an empty tube. The caller owns *mesh.
vsc_status vsc_tube_mesh(const vsc_tube_shape *shape, vsc_mesh **mesh, vsc_error *error);

#endif
