// SPDX-License-Identifier: GPL-3.0-or-later
// Equilibrium: positions at which all forces balance, for loads that vary in time so slowly that inertia
// does not count.
#ifndef VSC_SOLVE_EQUILIBRIUM_H
#define VSC_SOLVE_EQUILIBRIUM_H

#include "mech/state.h"
#include "solve/newton.h"

// Prepares a new state: nothing is loaded at its time, whatever the curves say then, and the loads come up
// on the way to the first time that is asked for; state->loaded: they are borne already. VSC_INPUT where the
// model has no tangent.
vsc_status vsc_equilibrium_start(const vsc_model *model, vsc_state *state, vsc_error *error);

// The equilibrium at `until` (ms), found from that at state->time in increments of the way between
// them: the first is the whole way, each next 1.6 times as long after at most 5 iterations, 0.4 times
// where Newton's method fails, starting from where the last two lead. Nothing moves: velocities
// are 0. VSC_NUMERICAL, with a row of words on what went wrong, when even an increment of
// 1/4000 fails; the state is then that of the last increment that succeeded. The whole way is tried first because most
// loads are borne at once, a beam that bends to a third of its length in nine iterations, where five increments would take
// more; one that fails has cost its iterations only.
vsc_status vsc_equilibrium_to(const vsc_model *model, vsc_state *state, double until,
                              vsc_error *error);

#endif
