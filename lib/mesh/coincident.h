// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes that lie at one place though they are several, as where two meshes touch that were never joined.
#ifndef VSC_MESH_COINCIDENT_H
#define VSC_MESH_COINCIDENT_H

#include <stddef.h>

#include "base/status.h"
#include "mesh/mesh.h"

// Counts the nodes that have another one within 1e-4 of the mean edge of the elements. Its time grows as
// the number of nodes does. VSC_SYSTEM when memory is short.
vsc_status vsc_mesh_coincident(const vsc_mesh *mesh, size_t *count, vsc_error *error);

#endif
