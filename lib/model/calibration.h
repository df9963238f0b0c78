// SPDX-License-Identifier: GPL-3.0-or-later
// From the constants of an orthotropic elastic material to springs.
#ifndef VSC_MODEL_CALIBRATION_H
#define VSC_MODEL_CALIBRATION_H

#include "model/elasticity.h"

// Engineering constants in the frame f, s, n.
typedef struct vsc_orthotropic {
  double young[3];    // Y_f, Y_s, Y_n, kPa
  double shear[3];    // G_fs, G_sn, G_nf, kPa
  double poisson[3];  // nu_fs, nu_sn, nu_nf (nu_ab: shortening along b over lengthening along a)
} vsc_orthotropic;

// Young's modulus and Poisson's ratio of an isotropic material as an orthotropic one.
vsc_orthotropic vsc_isotropic(double young, double poisson);

// The compliance S (1/kPa): S_aa = 1/Y_a, S_ab = -nu_ab/Y_a, S_44 = 1/G_sn, S_55 = 1/G_nf,
// S_66 = 1/G_fs. VSC_INPUT, naming the number, for one that no elastic material has: moduli not
// above zero, a compliance that is not positive definite.
vsc_status vsc_compliance_of(const vsc_orthotropic *wanted, double S[36], vsc_error *error);

// Its constants back from a compliance.
vsc_orthotropic vsc_constants_of(const double S[36]);

// Which springs a calibration may use beside the three axes, their pairs and K.
typedef enum vsc_calibration_axes {
  VSC_THREE_AXES = 3,
  VSC_NINE_AXES = 9,        // with the six face diagonals of the frame
  VSC_THIRTEEN_AXES = 13,   // and the four space diagonals
} vsc_calibration_axes;

// Springs whose stiffness C comes nearest to that of `wanted`: moduli m_i >= 0 that minimise
//   |S^1/2 (sum_i m_i r_i r_i^T) S^1/2 - 1|  (Frobenius),
// S the wanted compliance, so that each direction counts by its own stiffness; the rows r_i are
// elasticity.h's. Least squares by GSL within the active set of Lawson & Hanson (Solving Least
// Squares Problems, 1974, ch. 23). Isotropic materials of nu >= 0 come out exactly, E_a = 2 mu,
// G = mu, K = lambda. `material` (vsc_default_material) gets axial, angular, volume_modulus and,
// with more than three axes, `axes`, which the caller owns; *residual is the minimum. VSC_INPUT as
// above.
vsc_status vsc_calibrate(const vsc_orthotropic *wanted, vsc_calibration_axes axes,
                         vsc_material_def *material, double *residual, vsc_error *error);

// Springs of an incompressible material of the given Young's and shear moduli (poisson is not read), K =
// volume_modulus being large: with a, b, c = 1/Y_f, 1/Y_s, 1/Y_n and
// D = 4/(2ab + 2bc + 2ca - a^2 - b^2 - c^2),
//   E_f = D (b + c - a)/2,  E_s = D (c + a - b)/2,  E_n = D (a + b - c)/2,
// exact for K -> infinity. VSC_INPUT when the moduli are no stable material's (D < 0), or want a spring
// of negative modulus (a > b + c).
vsc_status vsc_calibrate_incompressible(const vsc_orthotropic *wanted, double volume_modulus,
                                        vsc_material_def *material, vsc_error *error);

#endif
