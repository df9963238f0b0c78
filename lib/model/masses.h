// SPDX-License-Identifier: GPL-3.0-or-later
// How the volume of an element is shared among its corners.
#ifndef VSC_MODEL_MASSES_H
#define VSC_MODEL_MASSES_H

#include "mesh/mesh.h"

// Row sums of the consistent mass at density 1: volumes[c] = int N_c dV, mm^3, for each corner of
// `element`; a quarter each of a tet.
void vsc_lumped_volumes(const vsc_mesh *mesh, size_t element, double volumes[VSC_MOST_CORNERS]);

// The part of each element that is nearer to a corner than to its others, mm^3: volumes[i] belongs
// to mesh->corners[i]. Where the mesh is Delaunay and its boundary well-centred, a node's sum is the
// volume of its Voronoi cell in the body; elsewhere it is still positive, and the sum over an
// element its volume.
vsc_status vsc_voronoi_volumes(const vsc_mesh *mesh, double *volumes, vsc_error *error);

#endif
