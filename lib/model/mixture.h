// SPDX-License-Identifier: GPL-3.0-or-later
// Elements a part of whose volume is another material (a vessel in liver): their moduli and densities are
// mixed by volume. Internal to the model room.
#ifndef VSC_MODEL_MIXTURE_H
#define VSC_MODEL_MIXTURE_H

#include "mesh/mesh.h"
#include "model/model.h"

// Sets mixed[e] (element_count) to 1 for elements with an inclusion of more than nothing. VSC_INPUT
// for an unknown material, one with another law or with inclusions, a missing array, for
// fractions outside [0, 1] or of a sum above 1, and where such an element's own law is not springs.
vsc_status vsc_mixture_find(const vsc_mesh *mesh, const vsc_definition *definition,
                            const uint32_t *material_of, uint8_t *mixed, vsc_error *error);

// density[e] (element_count, mg/mm^3) of each element: rho = rho_own + sum phi_j (rho_j - rho_own). VSC_INPUT as above,
// and for inclusions of another density than their tissue's with masses: consistent, which know the tissue's alone.
vsc_status vsc_mixture_densities(const vsc_mesh *mesh, const vsc_definition *definition, const uint32_t *material_of,
                                 double *density, vsc_error *error);

// Fills the mixtures of mixed patches: E = (1 - sum phi_j) E_own + sum phi_j E_j for all moduli.
vsc_status vsc_mixture_fill(const vsc_mesh *mesh, const vsc_definition *definition,
                            vsc_model *model, vsc_error *error);

#endif
