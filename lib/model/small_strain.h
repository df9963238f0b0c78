// SPDX-License-Identifier: GPL-3.0-or-later
// What a built material of any law of strain is at small strain.
#ifndef VSC_MODEL_SMALL_STRAIN_H
#define VSC_MODEL_SMALL_STRAIN_H

#include "model/model.h"

// D of the passive material at rest (model/law.h), kPa; 6 x 6, row by row: ff, ss, nn, fs, sn, nf,
// shears being twice E_ab. Fibres that are switched off in compression count as pulled. Without what
// the logarithm -m ln J adds, 2 m E : E, and without U(J).
void vsc_rest_tangent(const vsc_model *model, const vsc_material *material, double D[36]);

// Largest shear modulus at small strain, kPa, of the axes' planes and of those at 45 degrees to two
// axes: max of D_abab + m and (D_aaaa + D_bbbb - 2 D_aabb)/4 + m. 0 for laws PAPER and CLASSICAL,
// whose constants are none of a material.
double vsc_material_shear(const vsc_model *model, const vsc_material *material);

// Whether the passive material acts otherwise along f than along s or n: by D, to 1 %, or by its axial damping. Law
// PAPER by its constants; CLASSICAL, which has no axes, never does.
bool vsc_depends_on_direction(const vsc_model *model, const vsc_material *material);

// How many elements of such materials have no known fibre, so that their axes are the global ones.
size_t vsc_undirected_elements(const vsc_model *model);

// Largest stiffness of the passive material at rest, kPa: the energy of a change dG of the axes is at
// most this times |dG|^2 / 2, volume energy aside. The largest eigenvalue of D with E's own
// components (|E| <= |dG|), and 2 m.
double vsc_material_stiffest(const vsc_model *model, const vsc_material *material);

#endif
