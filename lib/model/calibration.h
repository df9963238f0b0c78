// SPDX-License-Identifier: GPL-3.0-or-later
// From the moduli that an engineer measures to the constants of springs.
#ifndef VSC_MODEL_CALIBRATION_H
#define VSC_MODEL_CALIBRATION_H

#include "model/elasticity.h"

// An orthotropic elastic material: S_aa = 1/Y_a, S_ab = -nu_ab / Y_a, S_44 = 1/G_sn, ...
typedef struct vsc_moduli {
  double young[3];  // Y_f, Y_s, Y_n, kPa
  double shear[3];  // G_fs, G_sn, G_nf, kPa
  double
      poisson[3];  // nu_fs, nu_sn, nu_nf: pulled along the first, how much thinner along the second
} vsc_moduli;

// The isotropic material of Young's modulus E (kPa) and Poisson's ratio nu in (-1, 1/2).
vsc_status vsc_moduli_isotropic(double E, double nu, vsc_moduli *moduli, vsc_error *error);

// Fills in the Poisson ratios of a material that resists all-round compression with the bulk
// modulus `K` (kPa), alike in all directions; Young's moduli stay exactly as given:
//   S_ab = (c - a - b)/2 + 1/(9K), a = 1/Y_a - 1/(9K) and likewise b, c for the other two axes.
// VSC_INPUT where no material has these Young's moduli (sqrt a, sqrt b, sqrt c make no triangle) or
// K is too small for them.
vsc_status vsc_moduli_incompressible(double K, vsc_moduli *moduli, vsc_error *error);

// The compliance of moduli that an elastic material can have.
void vsc_moduli_compliance(const vsc_moduli *moduli, double S[36]);

// Springs: constants of a scene's material.
typedef struct vsc_spring_constants {
  double axial[3];        // E_f, E_s, E_n, kPa
  double angular[3];      // G_fs, G_sn, G_nf, kPa
  double volume_modulus;  // K, kPa
  double face[3];         // of the two face diagonals f+s and f-s each, then s+-n, n+-f, kPa
  double space;           // of each of the four space diagonals, kPa
  // The energy of these springs over the wanted one, in the strain where it is least and where it
  // is largest: 1 and 1 where everything is matched.
  double least_energy, most_energy;
} vsc_spring_constants;

// The incompressible limit in closed form: on e_f + e_s + e_n = 0 three axial springs make any
// three Young's moduli. With a, b, c = 1/Y_f, 1/Y_s, 1/Y_n:
//   D = 4/(2ab + 2bc + 2ca - a^2 - b^2 - c^2), E_f = D (b + c - a)/2, and cyclically.
// One of them is negative where a > b + c: no spring. VSC_INPUT unless D > 0.
vsc_status vsc_axial_incompressible(const double young[3], double axial[3], vsc_error *error);

// The springs nearest to `moduli`, none with a negative constant: with M = C_wanted^-1/2 C_springs
// C_wanted^-1/2 they minimise |M - 1| (Frobenius), the relative error of the energy over all
// strains; linear least squares with non-negative unknowns (Lawson & Hanson's active set on GSL's
// solver). `axes`: 3 (f, s, n), 9 (and the face diagonals) or 13 (and the space diagonals); of
// equally good answers the one that puts least into the further axes. K is at least a thousandth of
// the largest Young's modulus, because a scene needs one above zero.
// Exact with three axes where C_fs = C_sn = C_nf >= 0 and C_aa > C_ab: all isotropic materials with
// nu > 0 (E_a = 2 mu, G = mu, K = lambda) are such.
vsc_status vsc_calibrate(const vsc_moduli *moduli, int axes, vsc_spring_constants *springs,
                         vsc_error *error);

// Fills in least_energy and most_energy of springs that came from elsewhere.
vsc_status vsc_compare_springs(const vsc_moduli *moduli, vsc_spring_constants *springs,
                               vsc_error *error);

// The springs as a material, its further axes among them (released with vsc_free(material->axes)).
vsc_status vsc_material_of_springs(const vsc_spring_constants *springs, vsc_material_def *material,
                                   vsc_error *error);

#endif
