// SPDX-License-Identifier: GPL-3.0-or-later
// Explicit stepping: Stoermer-Verlet in its velocity form.
#ifndef VSC_SOLVE_EXPLICIT_H
#define VSC_SOLVE_EXPLICIT_H

#include "mech/state.h"

// Prepares a new state for stepping: the first estimate of the stable step, at rest and at full
// activation (the smaller counts), and the first acceleration. Refuses (VSC_INPUT) a user's step
// above the stable one, with both numbers, unless the model forces it. VSC_NUMERICAL, with a node, where the
// state is so crushed, or what loads it so large, that its stable step is below 1e-4 of that at rest, or without loads, which
// the first steps do not exceed. Where volumes
// are kept, vsc_keep_volume_ready.
// Where masses are coupled the model's initial velocity times its lumped masses is the momentum that the body has.
vsc_status vsc_start(const vsc_model *model, vsc_state *state, vsc_error *error);

// `count` (at least 1) steps of length dt (ms), each
//   v <- v + dt/2 a;  x <- x + dt v;  a <- f(x, v + dt/4 (a + a'), t + dt) / m;  v <- v + dt/2 a.
// Where masses are coupled a <- P f / m (mech/coupled_mass.h), with f / m and the momenta over m beside them.
// After the drift nodes are put out of obstacles (contact.h) and kept volumes back to what they were
// (keep_volume.h), whose failure is the only one.
// Second order, symplectic without damping. Damping sees the velocity predicted for the step's end, with the mean of
// the last two accelerations a and a': from step to step what alternates fastest cancels there, so that steps may be
// up to twice as long as with a alone (mech/step_limit.h).
// Neither the limit nor the result is checked: vsc_advance does.
vsc_status vsc_steps(const vsc_model *model, vsc_state *state, double dt, double count,
                     vsc_error *error);

// Steps from state->time to `until` (ms) in equal steps not longer than the stable one, which is
// re-estimated at least every 4 ms or 128 steps, and where activity has changed a material's stiffness by 4 %;
// with a step given by the user, in steps of just that length to
// the first of its multiples that is not before `until`. VSC_NUMERICAL when a position or velocity is no longer
// finite, the stable step has fallen below a thousandth of that at the start or at rest, or a user's step has become
// unstable: the message names node, place and time.
vsc_status vsc_advance(const vsc_model *model, vsc_state *state, double until, vsc_error *error);

#endif
