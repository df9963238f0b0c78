// SPDX-License-Identifier: GPL-3.0-or-later
// Selective mass scaling: inertia against the motion of neighbours relative to one another, so that explicit steps may
// be long; bodies that move as a whole do not feel it (Olovsson, Simonsson and Unosson 2005).
//
// Accelerations are a = P(M^-1 L) M^-1 f, that is masses M P^-1, with the lumped masses M and
//   L_ij = sum_e V (E + K) B_i . B_j + sum_beds (k + 2/dt c) int N_i N_j dA,
// of the moduli that bound the tangent (vsc_limit_couplings): rows of L add up to 0, but for those beside beds. With
// y = lambda / lambda_max of an eigenvalue lambda of M^-1 L,
//   y P(y) = (T_m(w0) - T_m(w0 - w1 y)) / (w1 T_m'(w0)),  w0 = 1 + nu^2/(2 m^2), w1 = 1 + w0, nu = 1,
// T_m the Chebyshev polynomial: P(0) = 1, and y P(y) <= 1.08/m^2, so that steps may be m/1.04 times as long where the
// tangent is as L is; elsewhere less. It is the polynomial of leapfrog-Chebyshev steps (Carle, Hochbruck and Sturm 2020;
// damping after van der Houwen and Sommeijer 1980), of L instead of the forces. D_k = (T_k(w0) - T_k(w0 - w1 y))/(w1 y) has
//   D_0 = 0, D_1 = 1, D_k+1 = 2 (w0 - w1 y) D_k - D_k-1 + 2 T_k(w0), and P = D_m / D_m(0):
// m - 1 passes over the nodes.
#ifndef VSC_MECH_COUPLED_MASS_H
#define VSC_MECH_COUPLED_MASS_H

#include "mech/state.h"

// Makes L and the bound of its eigenvalues, with `rate` (1/ms) for 2/dt; the degree stays 0: masses are lumped.
// VSC_SYSTEM when memory is short.
vsc_status vsc_coupled_mass_create(vsc_model *model, double rate, vsc_error *error);

// Sets the number of passes, m - 1. States that were made before are of no use any more.
vsc_status vsc_coupled_mass_set_degree(vsc_model *model, int degree, vsc_error *error);

// P a of accelerations or velocities a (node_count x 4, 0 in held directions), which is valid until the next call; only
// where the degree is not 0.
const double *vsc_coupled_mass_spread(const vsc_model *model, vsc_scratch *scratch, const double *a);

#endif
