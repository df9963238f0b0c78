// SPDX-License-Identifier: GPL-3.0-or-later
// Boxes and walls of bricks, and how a brick is cut into elements, for the shapes.
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

// What becomes of bricks.
typedef enum vsc_block_kind {
  VSC_BLOCK_TETS,    // each is cut into 5 or 6 tets
  VSC_BLOCK_HEXES,   // each is a hexahedron
  VSC_BLOCK_WEDGES,  // each is cut into two wedges that stand on their triangles
  VSC_BLOCK_MIXED,   // blocks only, along x: hexahedra, wedges, a layer of five pyramids and two tets
                     // round the centre of each brick, tets; at least four bricks
} vsc_block_kind;

// A piece of a brick, by the brick's corners.
typedef struct vsc_brick_piece {
  vsc_cell kind;
  int corners[8];
} vsc_brick_piece;

extern const vsc_brick_piece vsc_brick_whole[1];   // the hexahedron
extern const vsc_brick_piece vsc_brick_halves[2];  // two wedges, the diagonal is from corner 0 to 2

// A wall of bricks: `layers` of them over each of `columns` quadrilaterals, which share nodes. Node i of
// layer l, 0 to `layers`, is node l per_layer + i of the mesh.
typedef struct vsc_wall {
  size_t per_layer;        // nodes
  size_t columns, layers;  // bricks
  vsc_block_kind element;  // TETS (5 of a brick), HEXES or WEDGES
} vsc_wall;

// A mesh with room for a wall and `triangles`, its kinds set and all else zero; NULL when memory is
// short.
vsc_mesh *vsc_wall_create(const vsc_wall *wall, size_t triangles);

// Makes the elements over quadrilateral `column`, whose corners (in the numbers of a layer) go round
// anti-clockwise seen from where layers rise. Tets fit to those of the neighbours when `parity` is even
// where the first corner is one of every second node, and odd where it is one of the others.
void vsc_wall_cut(const vsc_wall *wall, vsc_mesh *mesh, size_t column, const uint32_t quad[4],
                  size_t parity);

// Notes where the parts of a finished mesh came from. False when an element is inside out.
bool vsc_shape_finish(vsc_mesh *mesh);

#endif
