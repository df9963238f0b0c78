// SPDX-License-Identifier: GPL-3.0-or-later
// Contact with obstacles, without friction, where forces balance: equilibria and implicit steps. By the augmented
// Lagrangian (Alart & Curnier 1991, Simo & Laursen 1992) each pair of an obstacle and a node that it stops has a
// multiplier l >= 0. With the node's gap g(x) to the obstacle where that stands at the end, below 0 inside, and the
// unit vector n out of the obstacle there, the force on the node and its tangent are
//
//   t n,  t = max(l - k g, 0) = -dE/dx,  E = (t^2 - l^2)/(2 k),
//   k n n^T - t/(r + g) (1 - n n^T)  where l - k g >= 0,
//
// the second part for spheres of radius r only, and with l for t, which is the same in the end: nodes that an iterate
// has far inside would take the body's own stiffness away. Nodes come and go between Newton's iterations
// (Hintermueller, Ito & Kunisch 2003). After each solution l <- t, and it is solved again, until |g| of each node with
// t > 0 is below 1e-8 of the body's size. k is 30 times what the node resists by itself, and ten times more from round
// to round where depths do not fall to a quarter: so the solution does not depend on it.
//
// Implicit steps (not BDF2, from whose past an impact would come back): obstacles act on x_1, so that it is outside of
// them, as the impulse dt F over the step, which moves it by dt^2 F/(2 M); velocities get it, accelerations never have
// it (Kane, Repetto, Ortiz & Marsden 1999). With R = t d beside the forces f of solve/implicit.h that is
//   M [(1 - m) (A x_1 + h_a) + m a_0] = f + R,  a_1 = A x_1 + h_a - R/((1 - m) M),  F = 2 beta R/(1 - m),
//   v_1 = V x_1 + h_v + dt (2 beta - gamma) R/((1 - m) M),
// and viscosity sees V x_1 + h_v without what h_v has of the part of a_0 that obstacles stop. Then a node that is
// touched gets its obstacle's velocity along n, so that none bounces by itself, and none that rests swings with the
// steps. Of the trapezoid's energy F takes F . ((p - p_0) - (x_1 - x_0)) beside what the obstacle's way p - p_0 gives,
// at a plane never below 0, and the stop takes more: contact makes none. So that it makes none round spheres, along
// whose n nodes that slide move by d^2/(2 r) in a step, they push along the way that makes up for the gap's change
// (Simo & Tarnow 1992, Gonzalez 2000): with the way y from the centre to the node,
//   t d,  d = (y_1 + y_0)/(|y_1| + |y_0|),  d . (y_1 - y_0) = g_1 - g_0,
// whose tangent k d n^T - t (1 - d n^T)/(|y_1| + |y_0|) is taken with d for n. Were R a force as any other at x_1,
// nodes that rest would swing for ever, and an impact would give back in the next step what it has taken.
#ifndef VSC_SOLVE_TOUCH_H
#define VSC_SOLVE_TOUCH_H

#include "mech/state.h"
#include "mech/tangent.h"

typedef struct vsc_touch {
  const vsc_model *model;
  double *stiffness;   // node_count: bound of each node's own at rest, mN/mm; owned
  double *multiplier;  // l, vsc_state_contacts, obstacle after obstacle, mN; owned
  double *force;       // t of the last vsc_touch_push, likewise; owned
  double time;         // at which obstacles stand, ms
  double factor[2];    // of a node's stiffness (1) and mass (1/ms^2) in k
  double raise;        // of k, since the multipliers were begun
  double size;         // of the body, mm
  double off;          // largest |g| of the round before, mm
  const double *from;  // node_count x 4: what a first iterate is seen from; NULL in later rounds
  bool step;           // whether this is an implicit step or an increment of an equilibrium
  double *start;       // node_count x 4: where it began; owned
  double former;       // when that was, ms
} vsc_touch;

// Memory for `model`, of a body of `size` (mm): NULL without obstacles. VSC_SYSTEM when memory is short. The caller
// owns *touch.
vsc_status vsc_touch_create(const vsc_model *model, double size, vsc_touch **touch, vsc_error *error);

void vsc_touch_free(vsc_touch *touch);  // NULL is fine

// All that follows does nothing where `touch` is NULL.

// To be called before a solution: multipliers begin as the state's, obstacles stand where they are at `time`, at the
// end of an implicit `step` from the state or an increment; the balance has stiffness_factor times the stiffness and
// mass_factor (1/ms^2) times the masses in its tangent.
void vsc_touch_begin(vsc_touch *touch, const vsc_state *state, double time, bool step, double stiffness_factor,
                     double mass_factor);

// Adds t n, in steps t d, to r (node_count x 4, mN) at x (node_count x 4), found from the iterate `before` (likewise;
// NULL: none). Nodes are pushed that are so as seen from there, l - k (g_b + n_b . (x - x_b)) > 0, with t = l - k g
// that may be below 0 on the way: a node that a step along its tangent has put a little off a sphere is not let go.
void vsc_touch_push(vsc_touch *touch, const double *x, const double *before, double *r);

// Adds its tangent at the x of the last vsc_touch_push to that of the balance.
void vsc_touch_tangent(const vsc_touch *touch, const double *x, vsc_tangent *tangent);

// Whether a node goes through a sphere on its straight way from x to `next` (node_count x 4): nearer to the centre than
// half the radius, from where it might be put out on the other side. Writes then into `what` (of `size` bytes) which.
bool vsc_touch_goes_through(const vsc_touch *touch, const double *x, const double *next, char *what, size_t size);

// l <- max(t, 0), at a solution x. Returns whether depths are small enough and no node was pulled.
bool vsc_touch_update(vsc_touch *touch, const double *x);

// sqrt(sum t^2) of the last vsc_touch_push, mN.
double vsc_touch_norm(const vsc_touch *touch);

// VSC_NUMERICAL, in words, after VSC_MOST_ROUNDS of multipliers.
vsc_status vsc_touch_fail(const vsc_touch *touch, const double *x, vsc_error *error);

// To be called when the equilibrium at state->x and state->time is accepted, found by an increment of dt (ms): keeps
// the multipliers in the state, and adds to its sums the obstacles' work and impulse by the trapezoidal rule,
//   (F + F_0)/2 . (p - p_0),  dt (F + F_0)/2,   F = sum t n,  p the place of the obstacle.
void vsc_touch_reckon(const vsc_touch *touch, vsc_state *state, double dt);

// ---- implicit steps; state is that at the step's start until it is accepted

// Puts nodes of x (node_count x 4) that are inside an obstacle onto its surface.
void vsc_touch_put_out(vsc_touch *touch, double *x);

// Fills `part` (node_count x 4) with the part of `vector` (likewise) along n of nodes that were touched when the state
// was accepted, and 0.
void vsc_touch_part(const vsc_touch *touch, vsc_state *state, const double *vector, double *part);

// Adds factor R/M, R = t d, of nodes that are touched at x to `vector` (node_count x 4).
void vsc_touch_kick(const vsc_touch *touch, const double *x, double factor, double *vector);

// Takes from `vector` (node_count x 4) what is along n of nodes that are touched at x.
void vsc_touch_strike(const vsc_touch *touch, const double *x, double *vector);

// To be called before the positions x of a step of dt (ms) are accepted: adds what obstacles do with F = push t d,
//   impulse dt F,  work F . (p - p_0),  of which F . ((p - p_0) - (x - x_0)) is lost.
void vsc_touch_reckon_step(const vsc_touch *touch, vsc_state *state, const double *x, double dt, double push);

// To be called when the step is accepted: nodes that are touched get the obstacle's velocity s along n, by the impulse
// J = m (s - v) n, whose work is J . s and of which m (s - v)^2/2 is lost where the node was not touched before. Keeps
// the multipliers in the state.
void vsc_touch_stop(const vsc_touch *touch, vsc_state *state, double dt);

// Adds push t d to `force` (node_count x 4, mN) at x.
void vsc_touch_add(const vsc_touch *touch, const double *x, double push, double *force);

#endif
