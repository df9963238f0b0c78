// SPDX-License-Identifier: GPL-3.0-or-later
// The stable time step of explicit stepping, from the largest eigenvalue of the actual system.
#ifndef VSC_MECH_STEP_LIMIT_H
#define VSC_MECH_STEP_LIMIT_H

#include "mech/state.h"

// Re-estimates the largest eigenvalue lambda of M^-1 (K + 2/dt C), K and C the tangent stiffness and
// damping at the state's positions and the given time, and sets
//   limit.step = safety . 2 / sqrt(1.1 lambda),  with C as it counts at 2 / sqrt(1.1 lambda).
// Velocity Verlet with a damping force of the velocity v + dt/4 (a + a') (solve/explicit.h) is stable for
// dt^2 k + 2 dt c <= 4, that is for dt = 2 / sqrt(lambda): of a mode of stiffness k and damping c the steps multiply
// by the roots z of
//   (z - 1)^2 (z^2 + dt c (z + 1)/4) + dt^2 k z^3 + dt c z^2 (z - 1) = 0,
// the first of which leaves the unit circle at z = -1. (With v + dt/2 a it would be dt^2 k + 4 dt c <= 4.)
// Images under the operator are differences of forces: `iterations` of them, more while the eigenvalue rises, and with
// damping one each time that dt has changed too much. Each image is of the way in which the quotient <x, A x>/<x, x>
// of the mass norm is raised next, conjugate to the one before (conjugate gradients: as good as Lanczos's method, whose
// eigenvalue after k images is about that of power iteration after k^2); of law PAPER, whose stiffness is not
// symmetric, that of the vector itself (power iteration). What is taken for lambda is |A x|/|x|, which is below it.
// Where masses are coupled A is M^-1 (K + 2/dt C) P, which has the eigenvalues of P M^-1 (K + 2/dt C), and products are
// <a, b> = a . M P b (coupled_mass.h).
// It goes on from the vector of the last estimate, stirred with noise: else a mode that becomes the stiffest elsewhere
// would be seen too late. Changes limit.mode, limit.eigenvalue, limit.step, limit.refreshes, the state's force and
// scratch.
void vsc_limit_refresh(const vsc_model *model, vsc_state *state, double time, int iterations);

// The iterations after which an estimate from nothing may end: so many that a mode which is a tenth stiffer than all
// others, of one element among a hundred thousand, has grown from its part in a random vector.
int vsc_limit_enough(const vsc_model *model);

// An upper bound of lambda at rest without damping that needs no iteration, with the element behind it:
//   lambda <= max_e sum_{i in e} D_i / M_i,  D_i = sum_e V (K + A) |B_i|^2
// (the element eigenvalue with the assembled nodal mass shared in proportion to stiffness). `slot` is the
// element that limits the step. A = max(E_a, 2 G_ab) with full activation, or of a tissue law
// its stiffest (model/small_strain.h); with node-averaged volume
// K is the mean of the nodes' (the average of J is never stiffer), so that the bound is further off.
double vsc_limit_bound(const vsc_model *model, vsc_scratch *scratch, size_t *slot);

// A bound of each node's stiffness at rest (node_count, mN/mm): the sum over its elements of their stiffest
// modulus times sum_q V |B_i|^2, with `rate` (1/ms) times the strongest damping of cells and surfaces beside it.
void vsc_limit_stiffness(const vsc_model *model, double rate, double *stiffness);

// Takes what motions of nodes a and b cost against one another, mN/mm.
typedef void vsc_coupling_sink(void *context, uint32_t a, uint32_t b, double k);

// Gives `sink` both (a, b) and (b, a) of each pair of nodes of an element, and (a, a):
//   k = V (E + K) sum_q B_a . B_b,
// E + K the moduli of vsc_limit_stiffness, with `rate` (1/ms); the same of edges with springs and
// of membranes, and (k + rate c) int N_a N_b dA of springs and dashpots on surfaces. Bending is left out, and what
// radial forces of law PAPER add.
void vsc_limit_couplings(const vsc_model *model, double rate, vsc_coupling_sink *sink, void *context);

#endif
