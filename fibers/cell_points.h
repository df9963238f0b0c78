// SPDX-License-Identifier: GPL-3.0-or-later
// Many points spread evenly over an element of any kind.
#ifndef VSC_FIBERS_CELL_POINTS_H
#define VSC_FIBERS_CELL_POINTS_H

#include "mesh/mesh.h"

enum { VSC_POINTS_PER_EDGE = 10, VSC_CELL_POINTS = 1000 };  // the second is the cube of the first

// The points of one kind: the middles of the n^3 equal parts (n = VSC_POINTS_PER_EDGE) into which
// planes cut the reference element: cubes for the hexahedron and the (collapsed) pyramid, prisms for
// the wedge, tetrahedra for the tetrahedron.
typedef struct vsc_cell_points {
  double N[VSC_CELL_POINTS][VSC_MOST_CORNERS];     // shape functions
  double D[VSC_CELL_POINTS][3][VSC_MOST_CORNERS];  // their derivatives
} vsc_cell_points;

// Fills *points for a kind.
void vsc_cell_points_fill(vsc_cell kind, vsc_cell_points *points);

// The places (VSC_CELL_POINTS x 3, mm) of the points of an element, and the weight of each: its part
// of the element's volume up to a factor, |det dx/dxi|.
void vsc_cell_points_place(const vsc_mesh *mesh, size_t element, const vsc_cell_points *points,
                           double (*places)[3], double *weights);

#endif
