// SPDX-License-Identifier: GPL-3.0-or-later
// Where a deformed mesh is not one to one with itself at rest though the frames of its elements are the right way out: edges
// round which elements lie more than once, and elements that are inside out at a corner.
#ifndef VSC_MESH_WOUND_H
#define VSC_MESH_WOUND_H

#include "mesh/mesh.h"

// Round an edge inside a body the angles between the faces of its elements sum to 2 pi; where the body is wound k times
// round it, to 2 pi k. All elements may be the right way out then and near their volumes: none of them shows it.
typedef struct vsc_wound {
  size_t count;      // edges with a sum above 3 pi
  uint32_t ends[2];  // the nodes at the ends of the first of them, where there is one
  size_t folded;     // hexahedra, wedges and pyramids that are inside out at a corner; of tets their frames and nodes tell
  uint32_t element;  // the first of them, where there is one
} vsc_wound;

// Counts these edges and elements of a clean mesh when its nodes are at `x` (node_count x 3, mm). Edges are all inside with
// k >= 2, all of the surface with a sum from 4 pi on, and some from 3 pi on. Where the mesh itself has its nodes, k is 1
// everywhere. Angles are those between the edges' tangents at the elements' corners, at both ends of an edge, either of which
// may have the sum; of elements that are inside out there they count as negative. In O(elements), most of it only where
// elements are strained much; the same on any number of threads. A surface has none. VSC_SYSTEM when memory is short.
vsc_status vsc_wound_find(const vsc_mesh *mesh, const double *x, vsc_wound *wound, vsc_error *error);

#endif
