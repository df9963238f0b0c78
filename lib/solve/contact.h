// SPDX-License-Identifier: GPL-3.0-or-later
// Contact of nodes with obstacles: no node is inside one at the end of a step, friction is Coulomb's.
#ifndef VSC_SOLVE_CONTACT_H
#define VSC_SOLVE_CONTACT_H

#include "mech/state.h"

// To be called when the positions have drifted to state->time in a step of dt (ms) and velocities are
// those of its middle. Each node inside an obstacle is put back onto its surface along the normal,
//   x <- x + d n,  v <- v + (d/dt) n,
// so that it loses of its normal velocity just what would take it inside; then its velocity along the
// surface, seen from the obstacle, is shortened by friction . d/dt at most and to nothing at least,
//   v_t <- v_t max(0, 1 - friction d / (dt |v_t|)),  x follows.
// That is the impulse form of Coulomb's law: tangential impulse <= friction x normal impulse. Held
// directions do not move. Between several obstacles it goes round until no node is inside any, or 8
// times. Impulses and work go to the state's contact sums: the impulse J on a node works
// J . (v before + v after)/2, v before being the middle velocity of the last step, which is how
// Stoermer-Verlet itself counts the work of forces.
//
// state->contact_count (node_count) counts the obstacles that a node touches in this step, and
// state->contact_normal (node_count x 4) holds the normal of the last; `fresh` clears both first.
// Returns the number of nodes that were put back.
size_t vsc_contact_resolve(const vsc_model *model, vsc_state *state, double dt, bool fresh);

// To be called when a row of steps of dt has ended and velocities are those of its end: nodes that
// touched an obstacle in the last step lose the velocity that leads into it, and friction takes its
// part, because the reaction that does so would come only in the next step.
void vsc_contact_settle(const vsc_model *model, vsc_state *state, double dt);

#endif
