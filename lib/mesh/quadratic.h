// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic tetrahedra from linear ones, and nodes put on curved surfaces.
#ifndef VSC_MESH_QUADRATIC_H
#define VSC_MESH_QUADRATIC_H

#include "mesh/mesh.h"
#include "mesh/select.h"

// A surface of the mesh that lies on an ellipsoid, sum_a ((x_a - centre_a)/radii_a)^2 = 1.
typedef struct vsc_curved_def {
  char surface[VSC_NAME];
  double centre[3];  // mm
  double radii[3];   // mm, along x, y, z
} vsc_curved_def;

// Replaces a clean mesh of linear elements by one of quadratic tets with straight edges: other kinds are cut into tets
// first (vsc_mesh_cut); its nodes, then one in the middle of each edge, in the order of vsc_edges_list. Node arrays become the mean of the edge's
// ends there (which vsc_select_nodes does not select by), arrays on elements and triangles stay, and so does
// element_source; node_source goes on behind the file's last point. A quadratic mesh stays as it is. VSC_INPUT,
// with `name` (a file) before it, for a surface, for elements that cannot be cut, and for triangles across the cuts. After a failure
// *mesh may have been cut but is whole.
vsc_status vsc_mesh_raise(vsc_mesh **mesh, const char *name, vsc_error *error);

// Moves the middles of the edges of a surface of a quadratic mesh onto an ellipsoid, along its gradient;
// on the surface's rim, where another part of the boundary begins, within the plane of that part's
// triangle, so that a flat base stays flat. Corners stay: VSC_INPUT when one is further from the
// ellipsoid than a tenth of its triangle's longest edge, when an edge meets it nowhere, and when an
// element folds (vsc_mesh_check_folds). `boundary` is that of the mesh, `surface` a part of it.
vsc_status vsc_mesh_bend(vsc_mesh *mesh, const vsc_surface *boundary, const vsc_surface *surface,
                         const vsc_curved_def *curved, vsc_error *error);

#endif
