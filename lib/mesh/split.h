// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of any kind as tets, where linear functions are wanted on them.
#ifndef VSC_MESH_SPLIT_H
#define VSC_MESH_SPLIT_H

#include "mesh/mesh.h"

enum { VSC_MOST_TETS = 8 };

// The tets of element `element`, right-handed: itself when it is one; else its corner with the
// smallest number joined to the triangles of the faces that do not hold that corner, faces of four
// corners being cut from their corner with the smallest number (a pyramid 2, a wedge 3, a
// hexahedron 6; fewer where three corners of a face lie in line and make a flat tet, which is left
// out). A quadratic tet gives eight between its nodes: four at its corners, four round the edge between
// the middles of edges 01 and 23. Neighbours cut a common face alike, so that the tets of a mesh fit
// together. Returns how many there are; corners of elements with strongly bent faces may make tets of
// negative volume.
int vsc_mesh_split(const vsc_mesh *mesh, size_t element, uint32_t tets[VSC_MOST_TETS][4]);

// Replaces a clean mesh of linear elements by one of their tets (vsc_mesh_split): nodes, triangles, their arrays and sources
// stay, a tet has its element's source and data. Of elements whose faces are no planes the tets fill a little more or less.
// Triangles that do not fit the cut faces stay, too: vsc_mesh_raise refuses them. VSC_INPUT, with `name` (a file) before
// it, for an element that is bent so much that a tet would be inside out. After a failure *mesh is what it was.
vsc_status vsc_mesh_cut(vsc_mesh **mesh, const char *name, vsc_error *error);

// A face of an element (places among `corners`; face[3] < 0: a triangle) as triangles that turn like
// it: a quadrilateral is cut from its corner with the smallest number. Returns how many.
int vsc_face_cut(const uint32_t *corners, const int face[4], uint32_t triangles[2][3]);

#endif
