// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of nodes with obstacles: no node is inside one at the end of a step, friction is Coulomb's.
#ifndef VSC_SOLVE_CONTACT_H
#define VSC_SOLVE_CONTACT_H

#include "mech/state.h"

// To be called when the positions have drifted to state->time in a step of dt (ms) and velocities are
// those of its middle. Each node inside an obstacle is put back onto its surface along the normal, of a sphere that
// where the step has begun (lib/solve/contact.c: no energy of sliding round it),
//   x <- x + d n,  v <- v + (d/dt) n,
// so that it loses of its normal velocity just what would take it inside; then its velocity along the
// surface, seen from the obstacle, is shortened by friction . d/dt at most and to nothing at least,
//   v_t <- v_t max(0, 1 - friction d / (dt |v_t|)),  x follows.
// That is the impulse form of Coulomb's law: tangential impulse <= friction x normal impulse. Held
// directions do not move: a support that stands still bears what is pushed there. Between several obstacles it goes
// round until no node is inside any, or 8 times. Impulses go to the state's contact sums.
//
// state->contact_count (node_count) says whether a node touches no, one or several obstacles
// in this step, and state->contact_normal (node_count x 4) holds the normal of the last and its
// number; `fresh` forgets them first. Returns the number of nodes that were put back.
size_t vsc_contact_resolve(const vsc_model *model, vsc_state *state, double dt, bool fresh);

// Adds an impulse (mN ms) with which an obstacle holds a node that it touches against the multipliers of
// kept volumes.
void vsc_contact_load(const vsc_model *model, vsc_state *state, uint32_t node,
                      const double impulse[3], double dt);

// To be called when the positions of a step are settled, where obstacles have given impulses in it or at the end of the
// row of steps before: the impulse J on a node works J . (v_0 + v)/2 with the middle velocities v_0 of the step before
// (state->former; of a first step what it began with) and v of this one, which is how Stoermer-Verlet itself counts the
// work of forces; what of the obstacle's J . speed is not found there is lost.
void vsc_contact_account(const vsc_model *model, vsc_state *state);

// To be called when a row of steps of dt has ended and velocities are those of its end: nodes that
// touched an obstacle in the last step lose the velocity that leads into it, and friction takes its
// part, because the reaction that does so would come only in the next step. Those that it does not stop are marked as
// leaving (state->contact_count). Returns how many nodes were stopped.
size_t vsc_contact_settle(const vsc_model *model, vsc_state *state, double dt);

#endif
