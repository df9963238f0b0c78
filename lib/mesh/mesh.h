// SPDX-License-Identifier: GPL-3.0-or-later
// A tetrahedral mesh as it came from a file or from arrays: nodes, tets, surface triangles, and the
// named arrays that lie on them. Lengths in mm, whatever the file's unit was.
#ifndef VSC_MESH_MESH_H
#define VSC_MESH_MESH_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "base/text.h"

// A named array of numbers on nodes, tets or triangles.
typedef struct vsc_array {
  char name[VSC_NAME];
  int components;  // numbers per tuple
  size_t tuples;   // one per node, tet or triangle
  double *values;  // tuples x components, owned
} vsc_array;

typedef struct vsc_arrays {
  size_t count;
  vsc_array *items;  // count, owned
} vsc_arrays;

// What was set right or left out while the mesh was made; `viscera check` prints it.
typedef struct vsc_mesh_report {
  size_t file_nodes;       // points in the file
  size_t file_cells;       // cells in the file, of all kinds
  size_t turned_tets;      // left-handed ones whose last two nodes were exchanged
  size_t unused_nodes;     // points that no tet uses, dropped
  size_t ignored_cells;    // cells that are neither tets nor triangles
  char ignored_kinds[128]; // their kinds and counts, in words; empty when none
  size_t loose_triangles;  // triangles dropped because one of their points is on no tet
} vsc_mesh_report;

// Nodes, tets and triangles are in the order of the file.
typedef struct vsc_mesh {
  size_t node_count;
  double *nodes;           // node_count x 3, mm
  size_t tet_count;
  uint32_t *tets;          // tet_count x 4, right-handed (vsc_tet_volume > 0)
  size_t triangle_count;   // triangles given by the file; 0 when it has none
  uint32_t *triangles;     // triangle_count x 3
  uint32_t *node_source;   // node_count: the point's number in the file
  uint32_t *tet_source;    // tet_count: the cell's number in the file
  vsc_arrays node_data;
  vsc_arrays tet_data;
  vsc_arrays triangle_data;
  vsc_mesh_report report;
} vsc_mesh;

// A mesh with room for the given counts, all zero, sources counting up; NULL when memory is short
// (2^32 nodes or 2^31 tets are always too many).
vsc_mesh *vsc_mesh_create(size_t nodes, size_t tets, size_t triangles);

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

// Makes a raw mesh fit for use: refuses (VSC_INPUT) a mesh without tets, node numbers out of range,
// non-finite nodes of tets, repeated nodes and degenerate tets (|volume| < 1e-12 of the cube of the
// longest edge), naming up to five ids in the file's numbering; turns left-handed tets; drops nodes
// that no tet uses, with their data, and triangles that touch such a node, with theirs; fills the
// report (file_nodes and file_cells only where they are 0). `name` (a file name) begins each
// message. After a failure the mesh is good for vsc_mesh_free only.
vsc_status vsc_mesh_clean(vsc_mesh *mesh, const char *name, vsc_error *error);

// A clean mesh from a caller's arrays: nodes (node_count x 3, mm), tets (tet_count x 4). Both are
// copied. On success *mesh is owned by the caller.
vsc_status vsc_mesh_from_arrays(size_t node_count, const double *nodes, size_t tet_count,
                                const uint32_t *tets, vsc_mesh **mesh, vsc_error *error);

// The volume of tet `tet`, mm^3.
double vsc_mesh_tet_volume(const vsc_mesh *mesh, size_t tet);

// The mean of the four nodes of tet `tet`, mm.
void vsc_mesh_tet_centre(const vsc_mesh *mesh, size_t tet, double centre[3]);

// The smallest box round all nodes, mm.
void vsc_mesh_box(const vsc_mesh *mesh, double low[3], double high[3]);

#endif
