// SPDX-License-Identifier: GPL-3.0-or-later
// A volume mesh as it came from a file or from arrays: nodes, elements (tetrahedra, hexahedra,
// wedges, pyramids, in any mixture, or quadratic tetrahedra), surface triangles, and the named arrays
// that lie on them. Lengths in mm, whatever the file's unit was.
#ifndef VSC_MESH_MESH_H
#define VSC_MESH_MESH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/text.h"
#include "mesh/cell.h"

// A named array of numbers on nodes, elements or triangles.
typedef struct vsc_array {
  char name[VSC_NAME];
  int components;  // numbers per tuple
  size_t tuples;   // one per node, element or triangle
  double *values;  // tuples x components, owned
  bool single;     // the file had them in single precision (Float32): 0.7 there is not the double 0.7
} vsc_array;

typedef struct vsc_arrays {
  size_t count;
  vsc_array *items;  // count, owned
} vsc_arrays;

// What was set right or left out while the mesh was made; `viscera check` prints it.
typedef struct vsc_mesh_report {
  size_t file_nodes;       // points in the file
  size_t file_cells;       // cells in the file, of all kinds
  size_t turned_elements;  // left-handed ones whose corners were put into another order
  size_t unused_nodes;     // points that no element (on a surface: no triangle) uses, dropped
  size_t ignored_cells;    // cells that are neither elements nor triangles
  char ignored_kinds[128]; // their kinds and counts, in words; empty when none
  size_t loose_triangles;  // triangles dropped because one of their points is on no element, or (of
                           // quadratic elements) one of their edges
} vsc_mesh_report;

// Nodes, elements and triangles are in the order of the file. A mesh may have no elements but
// triangles only: a surface.
typedef struct vsc_mesh {
  size_t node_count;
  double *nodes;             // node_count x 3, mm
  size_t element_count;
  uint8_t *kinds;            // element_count: a vsc_cell each
  size_t *start;             // element_count + 1: element e has corners[start[e] .. start[e + 1] - 1]
  uint32_t *corners;         // start[element_count] nodes, right-handed (mesh/cell.h). When all are
                             // tets: element_count x 4
  size_t triangle_count;     // triangles given by the file; 0 when it has none
  uint32_t *triangles;       // triangle_count x 3
  uint32_t *triangle_mid;    // triangle_count x 3: of quadratic elements the nodes in the middle of
                             // edges 01, 12, 20, which vsc_mesh_clean finds; else NULL
  uint32_t *node_source;     // node_count: the point's number in the file
  uint32_t *element_source;  // element_count: the cell's number in the file
  vsc_arrays node_data;
  vsc_arrays element_data;
  vsc_arrays triangle_data;
  vsc_mesh_report report;
} vsc_mesh;

// A mesh of tets with room for the given counts, all zero, sources counting up; NULL when memory is
// short (2^32 nodes or 2^31 tets are always too many).
vsc_mesh *vsc_mesh_create(size_t nodes, size_t tets, size_t triangles);

// The same with elements of the given kinds (element_count of them, a vsc_cell each; copied).
vsc_mesh *vsc_mesh_create_cells(size_t nodes, size_t elements, const uint8_t *kinds,
                                size_t triangles);

// What a node or an element is called in messages: its number in the file. `source`: of all of them, or NULL, where they
// have that number themselves.
static inline uint32_t vsc_source_number(const uint32_t *source, uint32_t number)
{
  return source != NULL ? source[number] : number;
}

// The corners of element `element`, as many as its kind has.
static inline const uint32_t *vsc_mesh_corners(const vsc_mesh *mesh, size_t element)
{
  return mesh->corners + mesh->start[element];
}

// The facts of its kind.
static inline const vsc_cell_kind *vsc_mesh_kind(const vsc_mesh *mesh, size_t element)
{
  return &vsc_cells[mesh->kinds[element]];
}

// Whether its elements are quadratic: all are then, of a clean mesh.
static inline bool vsc_mesh_is_quadratic(const vsc_mesh *mesh)
{
  return mesh->element_count > 0 && mesh->kinds[0] == VSC_TET10;
}

// "12 tetrahedra, 1 wedge" for the counts of each kind, "no elements" when all are 0. Writes at most
// `size` bytes with the terminating zero and returns `text`.
const char *vsc_spell_kinds(const size_t counts[VSC_CELLS], char *text, size_t size);

// The same for the elements of a mesh.
const char *vsc_mesh_kinds_text(const vsc_mesh *mesh, char *text, size_t size);

// Releases a mesh and its arrays; NULL is fine.
void vsc_mesh_free(vsc_mesh *mesh);

// Appends an array of `tuples` x `components` zeros named `name` and returns it, owned by `arrays`
// and valid until the next append; NULL when memory is short.
vsc_array *vsc_arrays_add(vsc_arrays *arrays, const char *name, int components, size_t tuples);

// Releases the arrays' content and leaves an empty list.
void vsc_arrays_free(vsc_arrays *arrays);

// The array of that name, or NULL.
const vsc_array *vsc_arrays_find(const vsc_arrays *arrays, const char *name);

// ", known arrays: a, b, c; did you mean b?", for a message about the missing array `name`.
// Writes at most `size` bytes with the terminating zero.
void vsc_arrays_hint(const vsc_arrays *arrays, const char *name, char *text, size_t size);

// Makes a raw mesh fit for use. Refuses (VSC_INPUT), naming kinds and up to five ids in the file's
// numbering: a mesh without elements and triangles, node numbers out of range, non-finite nodes of
// elements, repeated nodes, degenerate elements (|volume| < 1e-12 of the cube of the longest edge),
// folded ones (a Jacobian that is not positive at a point of vsc_cell_rule_of), and quadrilateral
// faces on which triangles of another element lie; of quadratic tets neighbours that do not share the
// middles of their common edges, and other kinds beside them. Turns left-handed elements: a tet's last
// two corners and a pyramid's corners 1 and 3 are exchanged, a hexahedron's bottom and top, a wedge's
// triangles. Drops nodes that no element uses, with their data, and triangles that touch such a
// node, with theirs. A mesh of triangles only is a surface: its triangles and their nodes stay,
// degenerate ones (area < 1e-12 of the longest edge squared) are refused. Fills the report
// (file_nodes and file_cells only where they are 0). `name` (a file name) begins each message.
// After a failure the mesh is good for vsc_mesh_free only.
vsc_status vsc_mesh_clean(vsc_mesh *mesh, const char *name, vsc_error *error);

// A clean mesh from a caller's arrays: nodes (node_count x 3, mm), tets (element_count x 4). Both are
// copied. On success *mesh is owned by the caller.
vsc_status vsc_mesh_from_arrays(size_t node_count, const double *nodes, size_t element_count,
                                const uint32_t *tets, vsc_mesh **mesh, vsc_error *error);

// Refuses (VSC_INPUT) elements with a Jacobian that is not positive at a point of vsc_cell_rule_of, as
// vsc_mesh_clean does; for meshes whose nodes were moved since.
vsc_status vsc_mesh_check_folds(const vsc_mesh *mesh, const char *name, vsc_error *error);

// det J at the points of the rule of the element's kind, J_ka = sum_i d N_i / d xi_k x_ia, mm^3.
void vsc_mesh_jacobians(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule,
                        double det[VSC_MOST_POINTS]);

// The volume of an element, mm^3, exact for straight edges: the flux through its faces, each
// four-cornered face being the mean of its two pairs of triangles; of a quadratic tet the sum over
// the points of vsc_cell_rule_of, as a model has it.
double vsc_mesh_element_volume(const vsc_mesh *mesh, size_t element);

// The same, for who has the rule of the element's kind at hand.
double vsc_mesh_volume_by(const vsc_mesh *mesh, size_t element, const vsc_cell_rule *rule);

// For passes over all elements: asks for the nodes of one that comes some elements behind `element`, which lie anywhere
// where a mesh comes in random order.
static inline void vsc_mesh_prefetch(const vsc_mesh *mesh, size_t element)
{
  enum { AHEAD = 16 };
  if (element + AHEAD >= mesh->element_count) return;
  for (size_t i = mesh->start[element + AHEAD]; i < mesh->start[element + AHEAD + 1]; i++)
    __builtin_prefetch(mesh->nodes + 3 * (size_t)mesh->corners[i]);
}

// The size of the elements: (volume/elements)^(1/3), mm; NAN of a surface.
double vsc_mesh_element_size(const vsc_mesh *mesh);

// The mean of an element's vertices, mm.
void vsc_mesh_element_centre(const vsc_mesh *mesh, size_t element, double centre[3]);

// The smallest box round all nodes, mm.
void vsc_mesh_box(const vsc_mesh *mesh, double low[3], double high[3]);

#endif
