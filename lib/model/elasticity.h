// SPDX-License-Identifier: GPL-3.0-or-later
// The springs law at small strain: which elastic material its springs are equivalent to, in every
// direction, also those that are no axes.
//
// Strain in the frame f, s, n as six numbers with engineering shears (Voigt):
//   e = (e_ff, e_ss, e_nn, g_sn, g_fn, g_fs),  stress likewise,  stress = C e,  e = S stress.
// At rest each spring stores m (r . e)^2 / 2 per volume, r a row of six numbers, so that C is the
// sum of m r r^T:
//   axial, along a unit vector d:    r . e = d . e d
//   angular, between d and e:        r . e = 2 d . e e' - c0 (d . e d + e' . e e'), c0 = d . e'
//   volume, K = U''(1):              r . e = e_ff + e_ss + e_nn
// and a coupling H_ab of two of the frame's axes adds H_ab to C_ab and C_ba.
// For the three axes alone that is C_ab = E_a delta_ab + K, C_44 = G_sn, C_55 = G_nf, C_66 = G_fs,
// and S_ab = delta_ab / E_a - K / (1 + K s) / (E_a E_b), s = 1/E_f + 1/E_s + 1/E_n.
#ifndef VSC_MODEL_ELASTICITY_H
#define VSC_MODEL_ELASTICITY_H

#include "model/definition.h"

// r of an axial spring along the unit vector `d`. The same six numbers are the unit tension along d
// as stress.
void vsc_axis_row(const double d[3], double row[6]);

// r of an angular spring between the unit vectors `d` and `e`. For orthogonal ones the same six
// numbers are the unit shear stress in the plane of d and e.
void vsc_pair_row(const double d[3], const double e[3], double row[6]);

// C += modulus row row^T; 6 x 6, row by row.
void vsc_stiffness_add(double C[36], double modulus, const double row[6]);

// C (kPa) of a passive material of law SPRINGS with its further axes and pairs; K is its
// volume_modulus, with `volume` NODAL plus its stabilization, as in a model of linear tets. Inclusions are not
// in it. VSC_INPUT for another law: constants per element are no stiffness per volume.
vsc_status vsc_stiffness_of(const vsc_material_def *material, vsc_volume_kind volume, double C[36],
                            vsc_error *error);

// `inverse` of a symmetric positive definite 6 x 6 matrix; S from C or C from S. VSC_NUMERICAL when
// it is not positive definite: some deformation costs nothing.
vsc_status vsc_invert_six(const double matrix[36], double inverse[36], vsc_error *error);

// a . M b for 6 x 6 M.
double vsc_product_six(const double a[6], const double M[36], const double b[6]);

// Young's modulus along the unit vector `d`: the stress over the strain of a bar pulled along d
// with free sides, 1/Y = d d : S : d d; kPa.
double vsc_young(const double S[36], const double d[3]);

// Shear modulus of two orthogonal unit vectors, kPa.
double vsc_shear(const double S[36], const double d[3], const double e[3]);

// Poisson's ratio nu_de: by how much a bar pulled along d shortens along e, over how much it gets
// longer.
double vsc_poisson(const double S[36], const double d[3], const double e[3]);

// Young's modulus over all directions: 20,000 points evenly on the sphere (a golden spiral), and
// the axes, face and space diagonals of the frame for its extremes.
typedef struct vsc_young_range {
  double low, high, mean;                    // kPa
  double low_direction[3], high_direction[3];
} vsc_young_range;

vsc_young_range vsc_young_over_sphere(const double S[36]);

// The three axes, six face diagonals and four space diagonals of the frame, as unit vectors.
enum { VSC_DIRECTIONS = 13 };

typedef struct vsc_named_direction {
  const char *name;  // "f", "f+s", "f+s-n"
  double d[3];
} vsc_named_direction;

vsc_named_direction vsc_direction(int number);  // 0 ... VSC_DIRECTIONS - 1

#endif
