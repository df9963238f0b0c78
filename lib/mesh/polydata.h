// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces and lines beside the mesh, as VTK polydata hold them: a vessel's wall or its centre line.
#ifndef VSC_MESH_POLYDATA_H
#define VSC_MESH_POLYDATA_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/mesh.h"

typedef struct vsc_polydata {
  size_t point_count;
  double *points;  // point_count x 3, mm
  size_t triangle_count;
  uint32_t *triangles;  // triangle_count x 3
  size_t segment_count;
  uint32_t *segments;     // segment_count x 2, of the polylines in their order
  vsc_arrays point_data;  // on the points
} vsc_polydata;

// Room for the given counts, all zero; NULL when memory is short (2^32 points are always too many).
vsc_polydata *vsc_polydata_create(size_t points, size_t triangles, size_t segments);

void vsc_polydata_free(vsc_polydata *polydata);  // NULL is fine

// first[i] (point_count): the first of the points that lie just where point i lies.
vsc_status vsc_polydata_weld(const vsc_polydata *polydata, uint32_t *first, vsc_error *error);

// How the triangles hang together, points at the same place being one.
typedef struct vsc_closure {
  size_t open_edges;    // edges that have not just two triangles
  size_t turned_edges;  // edges that both their triangles pass in the same direction
  double volume;        // enclosed, mm^3: sum of a . (b x c) / 6, seen from the box's middle, positive
                        // where triangles turn counter-clockwise seen from outside
} vsc_closure;

vsc_status vsc_polydata_closure(const vsc_polydata *polydata, vsc_closure *closure,
                                vsc_error *error);

// The smallest box round the points that triangles and segments use; empty (low > high) without any.
void vsc_polydata_box(const vsc_polydata *polydata, double low[3], double high[3]);

#endif
