// SPDX-License-Identifier: GPL-3.0-or-later
// What the two kinds of vessels share: the walk over the elements.
#ifndef VSC_FIBERS_VESSEL_PARTS_H
#define VSC_FIBERS_VESSEL_PARTS_H

#include "fibers/boxes.h"
#include "fibers/cell_points.h"
#include "fibers/vessels.h"

// Of one thread: the points of an element, and numbers of triangles or segments.
typedef struct vsc_vessel_scratch {
  double places[VSC_CELL_POINTS][3], weights[VSC_CELL_POINTS];
  uint32_t *found;  // pieces
} vsc_vessel_scratch;

typedef struct vsc_vessel_walk vsc_vessel_walk;

// Sets fraction and direction of one element.
typedef void vsc_vessel_visit(const vsc_vessel_walk *walk, size_t element,
                              vsc_vessel_scratch *scratch);

struct vsc_vessel_walk {
  const vsc_mesh *mesh;
  const vsc_polydata *polydata;
  vsc_boxes near;            // boxes round the triangles or segments, as wide as they reach
  double *fraction;          // element_count
  double *direction;         // element_count x 3
  const void *own;           // of the kind of vessel
  vsc_vessel_visit *visit;
  vsc_cell_points *points[VSC_CELLS];  // of the kinds that the mesh has
  vsc_vessel_scratch *scratch;         // of each thread
};

// Visits all elements, on all threads.
vsc_status vsc_vessel_walk_all(vsc_vessel_walk *walk, vsc_error *error);

// The box round an element's corners.
void vsc_vessel_element_box(const vsc_mesh *mesh, size_t element, double low[3], double high[3]);

// The two kinds. `near` of the walk is made by them.
vsc_status vsc_vessel_surface(vsc_vessel_walk *walk, vsc_vessel_report *report, vsc_error *error);
vsc_status vsc_vessel_lines(vsc_vessel_walk *walk, const vsc_vessel_def *definition,
                            vsc_vessel_report *report, vsc_error *error);

#endif
