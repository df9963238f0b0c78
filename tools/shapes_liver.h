// SPDX-License-Identifier: GPL-3.0-or-later
// A liver-like organ and the trees of its vessels, by formulas of our own.
#ifndef VSC_TOOLS_SHAPES_LIVER_H
#define VSC_TOOLS_SHAPES_LIVER_H

#include "mesh/mesh.h"
#include "mesh/polydata.h"

// The mesh: a cube of `cells` bricks a side (at least 2) rounded half-way to the ball,
// x (sqrt(1 - y^2/2 - z^2/2 + y^2 z^2/3) + 0.82)/2, and drawn out into the liver, five tets a brick. Node arrays `top`,
// `bottom`, `front` (three sides of the cube) and `back` (the bare area: the middle of the fourth),
// 0 or 1; tet array `region`, 1. The caller owns *mesh.
vsc_status vsc_liver_mesh(size_t cells, vsc_mesh **mesh, vsc_error *error);

typedef enum vsc_liver_tree {
  VSC_PORTAL_TREE,   // from the middle of the bottom
  VSC_HEPATIC_TREE,  // from the back of the top
} vsc_liver_tree;

// The centre lines of a tree of vessels within that liver: each branch parts in two, in planes at right
// angles to one another, five generations; radii by Murray's law, r^3 = r1^3 + r2^3 (PNAS 12, 1926);
// point array `radius`, mm. The caller owns *tree.
vsc_status vsc_liver_vessels(vsc_liver_tree kind, vsc_polydata **tree, vsc_error *error);

#endif
