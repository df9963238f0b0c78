// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of the reference problems of solid mechanics: Cook's membrane, thick cylinders and spheres.
#ifndef VSC_TOOLS_SHAPES_SHELLS_H
#define VSC_TOOLS_SHAPES_SHELLS_H

#include "tools/shapes_block.h"

// Cook's membrane: the panel with the corners (0, 0), (48, 44), (48, 60), (0, 44) mm, from z = 0 to
// `thickness`. Bricks of a block whose lines x and y run along its edges.
typedef struct vsc_panel_shape {
  size_t cells[3];         // bricks from left to right, from bottom to top, through the thickness
  double thickness;        // mm
  int tets_per_cell;       // TETS: 5 or 6
  vsc_block_kind element;  // any
} vsc_panel_shape;

vsc_panel_shape vsc_panel_default(void);  // 8 x 8 x 1 bricks of 5 tets, 1 mm thick

// The mesh of the panel: node arrays left, right, bottom, top, back (z = 0), front, 0 or 1; cell array
// region, 1. VSC_INPUT for what vsc_block_of refuses. The caller owns *mesh.
vsc_status vsc_panel_mesh(const vsc_panel_shape *shape, vsc_mesh **mesh, vsc_error *error);

// A quarter of a thick cylinder about z (x, y >= 0), or an eighth of a thick sphere (x, y, z >= 0).
typedef struct vsc_shell_shape {
  double inner, outer;     // radii, mm
  double length;           // of the cylinder, from z = 0, mm
  size_t layers;           // bricks through the wall
  size_t around;           // of the quarter's arc; of the sphere along each side of a patch
  size_t along;            // of the cylinder's length
  vsc_block_kind element;  // TETS (5 of a brick), HEXES or WEDGES; of the cylinder MIXED, too
} vsc_shell_shape;

vsc_shell_shape vsc_shell_default(void);  // radii 1 and 2, length 1; 4 layers, 4 around, 1 along, tets

// The mesh of the cylinder: node arrays inner, outer, y0 (the cut at y = 0), x0, z0, z1, 0 or 1; cell
// array region, 1. VSC_INPUT for radii, lengths and counts that make no wall. The caller owns *mesh.
vsc_status vsc_cylinder_mesh(const vsc_shell_shape *shape, vsc_mesh **mesh, vsc_error *error);

// The mesh of the eighth of a sphere: three patches of around x around bricks each, which meet on the
// line x = y = z. Node arrays inner, outer, x0, y0, z0, 0 or 1; cell array region, 1. VSC_INPUT
// likewise, also for MIXED. The caller owns *mesh.
vsc_status vsc_octant_mesh(const vsc_shell_shape *shape, vsc_mesh **mesh, vsc_error *error);

#endif
