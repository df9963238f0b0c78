// SPDX-License-Identifier: GPL-3.0-or-later
// Who touches whom in a mesh: the tets round each node, the tet across each face.
#ifndef VSC_MESH_TOPOLOGY_H
#define VSC_MESH_TOPOLOGY_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/mesh.h"

typedef struct vsc_topology {
  size_t node_count;
  size_t element_count;
  size_t *node_start;        // node_count + 1: the tets of node i are node_elements[node_start[i] ..]
  uint32_t *node_elements;       // 4 element_count, ascending for each node
  int32_t (*neighbours)[4];  // element_count: [i] is the tet across the face opposite corner i, -1 on
                             // the boundary
  size_t crowded_faces;      // faces that three or more tets claim (tets overlap): 0 in a sound
                             // mesh; such a face counts as inside, and each of its tets names the
                             // next of them as its neighbour
} vsc_topology;

// The corners of the face opposite corner i of a right-handed tet, counter-clockwise from outside.
extern const int vsc_tet_faces[4][3];

// Fills `topology` for the tets of `mesh`; its content is owned by the caller. When memory is short
// it fails with VSC_SYSTEM and leaves it empty.
vsc_status vsc_topology_make(const vsc_mesh *mesh, vsc_topology *topology, vsc_error *error);

// Frees the content; an empty (zeroed) one is fine.
void vsc_topology_free(vsc_topology *topology);

#endif
