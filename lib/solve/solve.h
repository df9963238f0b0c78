// SPDX-License-Identifier: GPL-3.0-or-later
// The one way to move a state on, whatever the scene's method is.
#ifndef VSC_SOLVE_SOLVE_H
#define VSC_SOLVE_SOLVE_H

#include "mech/state.h"
#include "solve/newton.h"

// Prepares a new state at time 0: vsc_start of the explicit method, vsc_implicit_start,
// vsc_equilibrium_start, vsc_relax_start.
vsc_status vsc_solve_start(const vsc_model *model, vsc_state *state, vsc_error *error);

// The same for a state that what a checkpoint holds is put into next: explicit steps compute nothing then.
vsc_status vsc_solve_resume(const vsc_model *model, vsc_state *state, vsc_error *error);

// Moves the state on to `until` (ms): vsc_advance, vsc_implicit_to, vsc_equilibrium_to, vsc_relax_to. After a failure the state is the
// last good one of the method, or as the explicit method left it. VSC_INPUT before vsc_solve_start.
vsc_status vsc_solve_to(const vsc_model *model, vsc_state *state, double until, vsc_error *error);

// Lets methods give up with VSC_SYSTEM as soon as *interrupted is not 0, on the way to where vsc_solve_to was to go: the
// state then is to be thrown away. For after vsc_solve_start; `interrupted` may be NULL.
void vsc_solve_heed(const vsc_model *model, vsc_state *state, const volatile sig_atomic_t *interrupted);

// Newton's iterations since the start, or NULL where the method has none or has not started.
vsc_newton *vsc_solve_newton(const vsc_model *model, vsc_state *state);

#endif
