// SPDX-License-Identifier: GPL-3.0-or-later
// Who touches whom in a mesh: the elements round each node, the element across each face.
#ifndef VSC_MESH_TOPOLOGY_H
#define VSC_MESH_TOPOLOGY_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/mesh.h"

// What a face has across it, where it isn't an element.
enum {
  VSC_OUTSIDE = -1,  // nothing: it is on the boundary, or the kind has fewer faces
  VSC_SPLIT = -2,    // a quadrilateral face on which triangles of other elements lie; vsc_mesh_clean
                     // lets none through
};

typedef struct vsc_topology {
  size_t node_count;
  size_t element_count;
  size_t *node_start;       // node_count + 1: the elements of node i are node_elements[node_start[i]
                            // .. node_start[i + 1] - 1]
  uint32_t *node_elements;  // as many as elements have corners, ascending for each node
  int32_t (*neighbours)[VSC_MOST_FACES];  // element_count: [i] is the element across face i of
                                          // vsc_mesh_kind(mesh, element), or VSC_OUTSIDE, VSC_SPLIT
  size_t crowded_faces;  // faces that three or more elements claim (they overlap): 0 in a sound
                         // mesh; such a face counts as inside, and each of its elements names the
                         // next of them as its neighbour
  uint32_t crowded_element;  // one that claims such a face, where there is one
  size_t one_sided_faces;    // faces on the same side of which both their elements lie (they overlap, the mesh is folded
                             // there), of elements that are the right way out: 0 in a sound mesh
  uint32_t one_sided_element;  // one that has such a face, where there is one
} vsc_topology;

// Fills `topology` for the elements of `mesh`; its content is owned by the caller. When memory is short
// it fails with VSC_SYSTEM and leaves it empty.
vsc_status vsc_topology_make(const vsc_mesh *mesh, vsc_topology *topology, vsc_error *error);

// Frees the content; an empty (zeroed) one is fine.
void vsc_topology_free(vsc_topology *topology);

// Marks the faces with nothing across (VSC_OUTSIDE, VSC_SPLIT): bit i of open[e] for face i of element e of
// element_count. What a boundary needs, in less time and memory than a topology. VSC_SYSTEM when memory is short.
vsc_status vsc_open_faces(const vsc_mesh *mesh, uint8_t *open, vsc_error *error);

#endif
