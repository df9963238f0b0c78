// SPDX-License-Identifier: GPL-3.0-or-later
// Where a point of space lies in a mesh: in which element, and where within it.
#ifndef VSC_MESH_PLACE_H
#define VSC_MESH_PLACE_H

#include "mesh/mesh.h"

typedef struct vsc_place {
  size_t element;
  double xi[3];                // within its reference element (mesh/cell.h)
  double N[VSC_MOST_CORNERS];  // shape functions there; 0 behind the kind's nodes
  double distance;             // mm from the point; within rounding of 0 when the point is inside
} vsc_place;

// The place of an element of the mesh that is nearest to the point `at` (mm): of all xi in its reference
// element the one of least |x(xi) - at|, x = sum_i N_i x_i, for straight and curved elements of every
// kind. Gauss-Newton: each step d minimises |J d - (at - x)| within the reference element. Exact in one
// step for linear tets; of strongly curved elements it may be a local minimum.
void vsc_place_within(const vsc_mesh *mesh, size_t element, const double at[3], vsc_place *place);

// The nearest place of the whole mesh, which has elements; of several the one in the first element.
// Looks through all elements: meant for few points.
void vsc_place_find(const vsc_mesh *mesh, const double at[3], vsc_place *place);

// value[c] = sum_i N_i values[components n_i + c] of an array on the mesh's nodes.
void vsc_place_value(const vsc_mesh *mesh, const vsc_place *place, int components,
                     const double *values, double *value);

#endif
