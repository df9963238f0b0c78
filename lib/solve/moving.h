// SPDX-License-Identifier: GPL-3.0-or-later
// Supports that move: their nodes go where they are told, and what that takes goes to the state's sums.
#ifndef VSC_SOLVE_MOVING_H
#define VSC_SOLVE_MOVING_H

#include "mech/state.h"

// dc/dt at `time` (ms) from values of the curve dt apart, 1/ms; of second order, and without looking behind the table
// of a curve that ends with the run.
double vsc_moving_rate(const vsc_model *model, const vsc_curve *curve, double time, double dt);

// Whether the speed of a moving support jumps between two times (ms): whether it changes by more than a tenth of the
// curve's greatest within two places of the curve's table. Not where the table ends with the run.
bool vsc_moving_jumps(const vsc_model *model, double from, double to);

// To be called once the forces at the start are known and the nodes are in place: begins the sums, with
// nodes at rest.
void vsc_moving_start(const vsc_model *model, vsc_state *state);

// The same for equilibria that begin under load: the forces are those at the state's positions and time.
void vsc_moving_begin_loaded(const vsc_model *model, vsc_state *state);

// For methods that take velocities at the start from the state: nodes move as fast there as on the mean of a step of dt
// (ms), so that those of the trapezoidal rule do not swing about it for ever.
void vsc_moving_begin_rates(const vsc_model *model, vsc_state *state, double dt);

// The same at the end of each of their steps, of dt (ms): velocities and accelerations are those of the curve,
//   v = motion . dc/dt,  a = motion . (c(t + dt) - 2 c(t) + c(t - dt)) / dt^2;
// what Newmark's formulas make of a motion that begins within the run swings about it, with the trapezoidal rule
// for ever.
void vsc_moving_end_rates(const vsc_model *model, vsc_state *state, double dt);

// To be called when the positions have drifted to state->time in a step of dt (ms): puts the nodes to
// rest + motion . c(t) and gives them the velocity of the middle of the step that takes them there,
//   v = motion . (c(t) - c(t - dt)) / dt,
// and, where velocities are predicted, the one of its end, motion . (c(t + dt) - c(t - dt)) / (2 dt).
void vsc_moving_place(const vsc_model *model, vsc_state *state, double dt);

// To be called when the forces f at the end of that step are known: adds the support's work and impulse,
//   m motion^2 (r^2 - r_0^2)/2 - (f + f_0)/2 . motion (c - c_0),   m motion (r - r_0) - dt (f + f_0)/2,
// with the rates r of c that the velocities have at both ends: what Stoermer-Verlet's own balance of the
// nodes leaves for the support. `last` of a row of steps: velocities become those of its end.
void vsc_moving_account(const vsc_model *model, vsc_state *state, double dt, bool last);

// For methods whose balance the nodes follow as they are told: with `force` (node_count x 4, mN) what is
// on the nodes at state->time beside the support, less their mass times acceleration, and the part `load` of
// the motion taken there, adds the work and impulse of a step of dt (ms) by the trapezoidal rule,
//   -(f + f_0)/2 . motion (c - c_0),   -dt (f + f_0)/2.
void vsc_moving_reckon(const vsc_model *model, vsc_state *state, const double *force, double load,
                       double dt);

#endif
