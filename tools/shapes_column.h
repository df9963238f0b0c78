// SPDX-License-Identifier: GPL-3.0-or-later
// A column that is set in motion: the bending and the twisting column of elastodynamics.
#ifndef VSC_TOOLS_SHAPES_COLUMN_H
#define VSC_TOOLS_SHAPES_COLUMN_H

#include "tools/shapes_block.h"

// A box about the axis z, from z = 0 up, and how fast its points are:
//   v = (bend z / H, 0, 0) + twist sin(pi z / (2 H)) (-y, x, 0),   H its height.
typedef struct vsc_column_shape {
  vsc_block_shape block;
  vsc_block_kind element;  // any
  double bend;             // of the top, m/s
  double twist;            // of the top, rad/s
} vsc_column_shape;

vsc_column_shape vsc_column_default(void);  // 4 x 4 x 24 bricks of 5 tets, 1 m x 1 m x 6 m, at rest

// The mesh: node arrays x0, x1, y0, y1, z0, z1, 0 or 1, and velocity, three numbers in m/s; cell array region, 1.
// VSC_INPUT for what vsc_block_of refuses, and for a motion that is not finite. The caller owns *mesh.
vsc_status vsc_column_mesh(const vsc_column_shape *shape, vsc_mesh **mesh, vsc_error *error);

#endif
