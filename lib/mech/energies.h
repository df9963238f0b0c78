// SPDX-License-Identifier: GPL-3.0-or-later
// What a pack of elements stores and dissipates. Internal to mech.
#ifndef VSC_MECH_ENERGIES_H
#define VSC_MECH_ENERGIES_H

#include "mech/element.h"
#include "mech/smoothed.h"

// Of four elements; uJ and uJ/ms.
typedef struct vsc_pack_energies {
  vsc_wide axial;    // axial springs at their passive moduli and their couplings, classical springs;
                     // of tissue laws all but volume
  vsc_wide angular;  // angular springs
  vsc_wide volume;   // the elements' own volume energies (not those of node groups)
  vsc_wide membrane;  // of membranes, in their planes
  vsc_wide bending;   // of membranes
  vsc_wide dissipation;
  vsc_wide continued;  // number of frames beyond the law's largest exponent
} vsc_pack_energies;

// Energies of the laws of pack `k` of a block of edges, whose tets have the gradients of `work`.
vsc_pack_energies vsc_edge_energies_of(const vsc_model *model, const vsc_edge_work *work, size_t k);

// Energies of pack `k` of a patch of cells: of a law with axes[q] of each frame q, and velocities v (node_count x 4, in
// the model's order); of smoothed tets the volume's only. Law PAPER, which looks at positions x too, stores
// k (|l|-r)^2/2 in an axis, k (r_a + r_b)/2 c^2/2 between two and k (sum d - sum d at rest)^2/2 radially: the energies
// whose gradients its forces come nearest to.
vsc_pack_energies vsc_cell_energies_of(const vsc_model *model, const vsc_patch *patch, size_t k,
                                       const vsc_pack_law *law, vsc_wide3 (*axes)[3], const double *x,
                                       const double *v);

// Energies of pack `k` of triangles, bends or classical springs.
vsc_pack_energies vsc_surface_energies_of(const vsc_model *model, const vsc_patch *patch, size_t k,
                                          const double *x, const double *v);

#endif
