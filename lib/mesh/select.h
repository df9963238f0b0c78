// SPDX-License-Identifier: GPL-3.0-or-later
// Named node sets and surfaces: how they are described, and the nodes and triangles they name.
#ifndef VSC_MESH_SELECT_H
#define VSC_MESH_SELECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/text.h"
#include "mesh/mesh.h"

typedef enum vsc_select_kind {
  VSC_SELECT_BOUNDARY,    // the whole boundary
  VSC_SELECT_NODE_ARRAY,  // nodes whose value of a node array lies in [low, high]; of those that mesh.order: 2
                          // puts in the middle of edges, the ones both ends of whose edge do
  VSC_SELECT_TRIANGLE_ARRAY,  // triangles of the file whose cell array's value is in [low, high]
  VSC_SELECT_BOX,         // inside or on a box, middles of edges too, wherever these end
  VSC_SELECT_PLANE,       // within a distance of a plane
  VSC_SELECT_SURFACE,     // the nodes of a surface that has a name of its own
} vsc_select_kind;

// Describes a set of nodes or, read as a surface, the boundary triangles all of whose nodes are in
// that set (for VSC_SELECT_TRIANGLE_ARRAY: the boundary triangles that the file lists, quadrilateral faces cut along
// either diagonal). Of quadratic elements the corners of triangles decide, so that a surface does not depend on the order.
typedef struct vsc_selector {
  char name[VSC_NAME];   // what supports and loads call it
  vsc_select_kind kind;
  char array[VSC_NAME];  // NODE_ARRAY, TRIANGLE_ARRAY: the array; SURFACE: the surface
  double low, high;      // NODE_ARRAY, TRIANGLE_ARRAY: values taken, both ends included; of an array in single
                         // precision both are rounded to that first
  double box_low[3];     // BOX: mm
  double box_high[3];    // BOX: mm
  double point[3];       // PLANE: a point of it, mm
  double normal[3];      // PLANE: its normal, any length
  double tolerance;      // PLANE: distance from the plane that still counts, mm
} vsc_selector;

typedef struct vsc_node_set {
  char name[VSC_NAME];
  size_t count;
  uint32_t *nodes;  // count, ascending, owned
} vsc_node_set;

typedef struct vsc_surface {
  char name[VSC_NAME];
  size_t count;
  uint32_t *triangles;  // count x 3, turned so that the normal points out of the tissue; owned
  uint32_t *mid;        // count x 3: the nodes in the middle of edges 01, 12, 20; NULL where elements
                        // are linear; owned
  uint8_t *paired;      // count: 1 where this triangle and the next one are a quadrilateral face with corners
                        // (a, b, c), (a, c, d); or NULL: no face is one; owned
} vsc_surface;

// Whether a selector by array takes a value of the array.
bool vsc_selector_takes(const vsc_selector *selector, const vsc_array *array, double value);

// The boundary of the mesh: faces that belong to one element, turned outwards, in the order of
// their elements; of a mesh without elements its triangles as they are. A quadrilateral is cut into
// two triangles by the diagonal through its smallest node number, whichever element it belongs to; sums
// over the surface take both cuts (mesh/facets.h). `boundary` is filled and owned by the caller.
vsc_status vsc_boundary(const vsc_mesh *mesh, vsc_surface *boundary, vsc_error *error);

// Finds the nodes that `selector` describes. `surfaces` (surface_count) are those that a selector
// of kind SURFACE may name. An empty set is an error of status VSC_INPUT that says what was near.
vsc_status vsc_select_nodes(const vsc_mesh *mesh, const vsc_selector *selector,
                            const vsc_surface *surfaces, size_t surface_count, vsc_node_set *set,
                            vsc_error *error);

// Finds the boundary triangles that `selector` describes; none is VSC_INPUT, and so are triangles of a triangle array
// that are no faces of the boundary.
vsc_status vsc_select_surface(const vsc_mesh *mesh, const vsc_surface *boundary,
                              const vsc_selector *selector, vsc_surface *surface, vsc_error *error);

// The triangles of a surface that another one of the same boundary does not have, perhaps none; the middles of
// their edges where it has them. `rest` is filled and owned by the caller.
vsc_status vsc_surface_without(const vsc_surface *surface, const vsc_surface *other, vsc_surface *rest,
                               vsc_error *error);

void vsc_node_set_free(vsc_node_set *set);        // frees the content
void vsc_surface_free(vsc_surface *surface);      // frees the content

#endif
