// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium by viscous relaxation: explicit steps of a body with masses of its own choice, damped so
// that its slowest motion just does not swing (Papadrakakis 1981, Underwood 1983). It needs no matrix, and
// suits compact bodies; slender ones take very long.
#ifndef VSC_SOLVE_RELAX_H
#define VSC_SOLVE_RELAX_H

#include "mech/state.h"

// Prepares a new state.
vsc_status vsc_relax_start(const vsc_model *model, vsc_state *state, vsc_error *error);

// The equilibrium at `until` (ms), to solve.tolerance of the forces at work:
//   v <- [(2 - c h) v + 2 h f/m] / (2 + c h),  x <- x + h v,  c = 2 omega,
//   omega^2 = v . (f_before - f) / (h v . m v)   (Rayleigh's quotient of what still moves)
// with masses that make all nodes about equally fast and the step h that is stable for them. Loads and
// activity go from their values at state->time to those at `until` within the first steps. VSC_NUMERICAL
// when 200 000 steps are not enough or numbers are no longer finite; positions are then those of the last equilibrium.
vsc_status vsc_relax_to(const vsc_model *model, vsc_state *state, double until, vsc_error *error);

#endif
