// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes of bricks and how a brick is cut into tets, for the shapes.
#ifndef VSC_TOOLS_SHAPES_BRICKS_H
#define VSC_TOOLS_SHAPES_BRICKS_H

#include <stdbool.h>

#include "mesh/mesh.h"

// The nodes at the corners of brick `brick` of a box of cells[0] x cells[1] x cells[2] bricks, bricks
// and nodes being counted along x first, z last: 0 to 3 round the bottom, 4 to 7 above them. Returns
// whether the brick is a mirrored one, as every second one of a chessboard is.
bool vsc_brick_corners(const size_t cells[3], size_t brick, uint32_t corner[8]);

// Cuts a brick into 5 tets (corners 0 2 5 7 hold the middle one; in a mirrored brick 1 3 4 6) or 6
// (round its main diagonal, mirrored or not): tets[4 x count].
void vsc_brick_cut(const uint32_t corner[8], int count, bool mirrored, uint32_t *tets);

// Adds the element array `region`, 1 everywhere; false when memory is short.
bool vsc_region_add(vsc_mesh *mesh);

#endif
