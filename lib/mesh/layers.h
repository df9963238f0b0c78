// SPDX-License-Identifier: GPL-3.0-or-later
// How few elements lie through the walls of a body.
#ifndef VSC_MESH_LAYERS_H
#define VSC_MESH_LAYERS_H

#include "mesh/mesh.h"

// What vsc_mesh_layers says of an element; each of the last two has the one before.
enum {
  VSC_ON_SURFACE = 1,   // all its corners are on the boundary
  VSC_FEW_LAYERS = 2,   // no element that has a corner in common with it lies wholly inside: two layers at most
  VSC_ONE_LAYER = 4,    // none of these has a corner inside either: one layer
};

// Fills flags (element_count, the caller's) with the sums of these for each element. VSC_SYSTEM when memory is short.
vsc_status vsc_mesh_layers(const vsc_mesh *mesh, uint8_t *flags, vsc_error *error);

// How slender a body is: the diagonal of its box over the mean thickness of its walls, twice the volume over the surface.
// A cube has 5, a beam of ten cubes 21; 0 for a mesh without elements, and when memory is short.
double vsc_mesh_slenderness(const vsc_mesh *mesh);

#endif
