// SPDX-License-Identifier: GPL-3.0-or-later
// The longest stable step of a small body, from all eigenvalues: what the estimate of mech/step_limit.h is
// held against.
#ifndef VSC_TOOLS_BENCH_TRUE_STEP_H
#define VSC_TOOLS_BENCH_TRUE_STEP_H

#include "mech/state.h"

// The largest stable step (ms) of explicit steps about the state's positions and time, into *step: the dt with
//   dt^2/4 lambda(dt) = 1,  lambda(dt) the largest eigenvalue of M^-1/2 (K + 2/dt C) M^-1/2,
// K (which has to be symmetric: not of law PAPER) and C as dense matrices by central differences of forces. The
// state is not changed. Memory and time go with the square and the cube of the number of coordinates: some
// hundred nodes at most. Kept volumes are not seen. VSC_SYSTEM when memory is short. *step is INFINITY when
// nothing is stiff.
vsc_status vsc_true_step(const vsc_model *model, vsc_state *state, double *step, vsc_error *error);

// `count` explicit steps of `dt` from rest with small random velocities: how many times as large as with these the
// root of the kinetic energy then is, into *growth; INFINITY when it is no number. The state is what that leads to.
vsc_status vsc_step_growth(const vsc_model *model, vsc_state *state, double dt, double count, double *growth,
                           vsc_error *error);

#endif
