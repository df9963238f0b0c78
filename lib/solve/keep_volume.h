// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes kept to rounding by Lagrange multipliers (Witkin's constrained dynamics, to which Bourguignon
// & Cani 2000 point), in the form of SHAKE and RATTLE: energy-neutral and second order.
#ifndef VSC_SOLVE_KEEP_VOLUME_H
#define VSC_SOLVE_KEEP_VOLUME_H

#include "mech/state.h"

// Part of its volume by which a kept one differs after a step; where rounding allows no better, up to
// 100 times as much is accepted.
#define VSC_KEPT_TOLERANCE 1e-12

// Loads CHOLMOD where volumes are kept, so that no step has to: that changes the environment for a moment
// (solve/cholmod.h), which no other thread may look at then. VSC_SYSTEM when it is missing.
vsc_status vsc_keep_volume_ready(const vsc_model *model, vsc_error *error);

// To be called when the positions have drifted in a step of dt (ms), after contact: finds multipliers
// lambda so that with the gradients g_k of the volumes at the step's start, x_0 = x - dt v,
//   x <- x + sum_k lambda_k M^-1 g_k(x_0),  v <- v + the same / dt,  v_k(x) = V_k for all k,
// by Newton's iteration with the matrix g M^-1 g^T (CHOLMOD), which is factorised anew in the first step of a row,
// when it converges slowly, and with obstacles each time, since contact changes what can move. The velocity predicted
// for the step's end, where half a step more of these forces has acted, gets one and a half times as much; in the
// `first` step, in which they have moved nodes for half a step only, twice as much. Nodes in contact do not move
// along the contact's normal, those in contact with several obstacles not at all. lambda_k/dt^2 is a pressure (kPa,
// added to state->kept_pressure). VSC_NUMERICAL when the volumes cannot be kept.
vsc_status vsc_keep_volume(const vsc_model *model, vsc_state *state, double dt, bool first,
                           vsc_error *error);

// To be called when a row of steps of dt (ms) has ended, and before the first: takes from the velocities what would change the volumes,
//   v <- v - M^-1 g^T (g M^-1 g^T)^-1 g v.
vsc_status vsc_keep_volume_settle(const vsc_model *model, vsc_state *state, double dt, vsc_error *error);

#endif
