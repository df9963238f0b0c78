// SPDX-License-Identifier: GPL-3.0-or-later
// How the volume of elements is shared among nodes.
#ifndef VSC_MODEL_MASSES_H
#define VSC_MODEL_MASSES_H

#include "mesh/mesh.h"

// Row sums of the consistent mass at density 1: volumes[c] = int N_c dV, mm^3, for each corner of
// `element`; a quarter each of a tet. Of a quadratic tet the diagonal of the consistent mass scaled to
// the element's (Hinton, Rock & Zienkiewicz 1976), as with straight edges: 1/36 of the volume to each
// corner, 4/27 to each middle. `rule` is that of its kind.
void vsc_lumped_volumes(const vsc_mesh *mesh, const vsc_cell_rule *rule, size_t element,
                        double volumes[VSC_MOST_CORNERS]);

// int N_i N_j dV / V of nodes i, j of a quadratic tet with straight edges; consistent masses take it for bent ones
// too.
double vsc_quadratic_mass(int i, int j);

// masses[n] (node_count) = density x the volume of what is nearest to node n, mg: each element (of
// density[e], mg/mm^3) is shared among its own corners and those of its neighbours across faces by
// which is nearest. In a Delaunay mesh whose cells reach no further than that it is the volume of
// the node's Voronoi cell within the body; elsewhere still not negative, and the sum is the mass of
// the body.
vsc_status vsc_voronoi_masses(const vsc_mesh *mesh, const double *density, double *masses,
                              vsc_error *error);

#endif
