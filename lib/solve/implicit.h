// SPDX-License-Identifier: GPL-3.0-or-later
// Implicit time steps. With the unknown x = x_1 at the step's end, velocity and acceleration there are
//
//   a_1 = A x_1 + h_a,  v_1 = V x_1 + h_v,
//
// the scheme's numbers A and V and what it takes from the past; forces balance at a moment within the
// step,
//
//   M [(1 - m) a_1 + m a_0] = f((1 - f) x_1 + f x_0, (1 - f) v_1 + f v_0, (1 - f) t_1 + f t_0).
//
// Generalised alpha (Chung & Hulbert 1993): m = (2 rho - 1)/(rho + 1), f = rho/(rho + 1), Newmark's
// gamma = 1/2 - m + f and beta = (1 - m + f)^2/4: second order, and what is too fast for the step
// decays by rho in each. Trapezoid: m = f = 0, gamma = 1/2, beta = 1/4: keeps energy best, damps
// nothing. BDF2: both derivatives by the second backward difference, for steps of any ratio. Obstacles: solve/touch.h.
// Branches of Prony series go from the step's start over (1 - f) dt to the strain where forces balance, within f
// (mech/prony.h), and over dt to x_1 once the step is accepted: both are off by dt^2 at most, so the order stays two, and
// what has relaxed under a strain that is held is exact in steps of any length.
#ifndef VSC_SOLVE_IMPLICIT_H
#define VSC_SOLVE_IMPLICIT_H

#include "mech/state.h"
#include "solve/newton.h"

// What the steps have been since the start.
typedef struct vsc_implicit_counts {
  double steps;     // accepted
  double rejected;  // by the error estimate
  double failed;    // Newton's method did not converge; tried again shorter
} vsc_implicit_counts;

// Prepares a new state: the first acceleration. VSC_INPUT where the model has no tangent.
vsc_status vsc_implicit_start(const vsc_model *model, vsc_state *state, vsc_error *error);

// Steps from state->time to `until` (ms). With a step given by the user in equal steps of at most that
// length; else the estimate of a step's error,
//   e = c dt^2 rms |a_1 - a_0|,  c = |beta - 1/6|, BDF2: 2/9,
// is kept below solve.accuracy times the size of the body: a step with a larger one is done again,
// shorter; and no step is longer than loads keep to a straight line and obstacles may move (model/calm.h). Where
// Newton's method fails the step is cut to 0.4. VSC_NUMERICAL when the step falls below 1e-6 of the way.
vsc_status vsc_implicit_to(const vsc_model *model, vsc_state *state, double until, vsc_error *error);

// Newton's part of a state that has been started, and the counts of its steps.
vsc_newton *vsc_implicit_newton(vsc_state *state);
vsc_implicit_counts vsc_implicit_counted(const vsc_state *state);

#endif
