// SPDX-License-Identifier: GPL-3.0-or-later
// The edges of a mesh's elements, each once; the sides of triangles, edge by edge.
#ifndef VSC_MESH_EDGES_H
#define VSC_MESH_EDGES_H

#include <stdbool.h>

#include "mesh/mesh.h"

#define VSC_NO_MIDDLE UINT32_MAX  // what an edge of a linear element has in its middle

typedef struct vsc_edge {
  uint32_t low, high;  // nodes at its ends, low < high
  uint32_t middle;     // the node in its middle, or VSC_NO_MIDDLE
} vsc_edge;

typedef struct vsc_edges {
  size_t count;
  vsc_edge *items;  // count, by low, then high; owned
  bool apart;       // elements disagree on the middle of an edge
} vsc_edges;

// Lists the edges of all elements. Where neighbours disagree on the middle of an edge it is that of the
// smallest number. The content of *edges is owned by the caller; VSC_SYSTEM when memory is short.
vsc_status vsc_edges_list(const vsc_mesh *mesh, vsc_edges *edges, vsc_error *error);

void vsc_edges_free(vsc_edges *edges);  // frees the content

// The edge between nodes a and b, in any order, or NULL.
const vsc_edge *vsc_edges_find(const vsc_edges *edges, uint32_t a, uint32_t b);

// A side of a triangle, from one of its corners to the next.
typedef struct vsc_side {
  uint32_t low, high;  // nodes at its ends, low <= high
  uint32_t triangle;
  uint32_t corner;     // 0, 1, 2: where it begins
  uint32_t rising;     // 1: it runs from low to high
} vsc_side;

// Lists the sides of `count` triangles by low, then high, then triangle, so that those of one edge follow one another. The
// corners of triangle t are corners[stride t] and the two behind. *sides (3 count) is owned by the caller (vsc_free), NULL
// after a failure: VSC_SYSTEM when memory is short.
vsc_status vsc_sides_list(const uint32_t *corners, size_t stride, size_t count, vsc_side **sides, vsc_error *error);

// The place behind the sides of the edge whose first side is at `first` among `side_count`.
size_t vsc_sides_end(const vsc_side *sides, size_t side_count, size_t first);

#endif
