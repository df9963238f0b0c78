// SPDX-License-Identifier: GPL-3.0-or-later
// Kept volumes in Newton's method: each of the few volumes v_k (model/model.h) has a pressure p_k, an unknown like the
// positions. Forces balance and volumes are what they were,
//   r(x) + sum_k p_k g_k(x) = 0,  v_k(x) = V_k,  g_k = dv_k/dx,
// so that each iteration solves, with A = -d(r + sum p_k g_k)/dx,
//   A d - sum_l dp_l g_l = r + sum_l p_l g_l,  g_k . d = V_k - v_k:
//   A d_0 = r + sum p_l g_l,  A z_k = g_k,  sum_l (g_k . z_l) dp_l = V_k - v_k - g_k . d_0,  d = d_0 + sum dp_k z_k.
// In implicit steps forces balance at a moment within the step, whose g_k push, and volumes are kept at the step's end,
// whose g_k change them. A volume costs up to one more solution with A in each iteration, and 12 numbers a node. A by itself
// must be positive definite: a body that its kept volume alone holds up is not found.
#ifndef VSC_SOLVE_KEPT_BALANCE_H
#define VSC_SOLVE_KEPT_BALANCE_H

#include "mech/state.h"
#include "mech/tangent.h"
#include "solve/linear.h"

// Part of its volume by which a kept one may be off in the end.
#define VSC_KEPT_BALANCE 1e-11

typedef struct vsc_kept_balance {
  const vsc_model *model;
  double *pressure;  // count: p_k, kPa; owned
  double *change;    // count: dp_k of the last solution; owned
  double *defect;    // count: V_k - v_k, or what else g_k . d has to be, mm^3; owned
  double *push;      // count x node_count x 4: g_k where forces balance, mm^2; owned
  double *flux;      // count x node_count x 4: g_k where volumes are kept; owned
  double *answer;    // count x node_count x 4: z_k, from which the next solution starts; owned
  double *rest;      // 2 x node_count x 4: memory of vsc_kept_solve; owned
  double *small;     // count x count: g_k . z_l; owned
} vsc_kept_balance;

// Memory for `model`, which must outlive it; *kept is NULL where it keeps no volumes, with which the functions below
// do nothing. The caller owns *kept.
vsc_status vsc_kept_create(const vsc_model *model, vsc_kept_balance **kept, vsc_error *error);

void vsc_kept_free(vsc_kept_balance *kept);  // NULL is fine

// Forgets what solutions start from, which a restart would not know.
void vsc_kept_forget(vsc_kept_balance *kept);

// Pressures from the state, and back.
void vsc_kept_take(vsc_kept_balance *kept, const vsc_state *state);
void vsc_kept_give(const vsc_kept_balance *kept, vsc_state *state);

// r += sum_k p_k g_k(x), mN; x and r node_count x 4. These g_k push in the next solution.
void vsc_kept_add_force(vsc_kept_balance *kept, const double *x, double *r);

// matrix -= factor sum_k p_k d^2 v_k/dx^2 at x, mN/mm. Its pattern must have the nodes of each face of an element.
void vsc_kept_add_tangent(const vsc_kept_balance *kept, const double *x, double factor, vsc_block_matrix *matrix);

// Takes x as the place where volumes are kept; returns the largest |V_k - v_k|/V_k, 0 without any.
double vsc_kept_look(vsc_kept_balance *kept, const double *x);

// Likewise for accelerations a of a body that moves with v: volumes have to stay, g_k . a = -v . d^2 v_k/dx^2 v.
void vsc_kept_look_moving(vsc_kept_balance *kept, const double *x, const double *v);

// vsc_linear_solve with the volumes: b is r + sum p_k g_k; d, and dp_k. VSC_NUMERICAL where nothing that could change
// a volume can move.
vsc_status vsc_kept_solve(vsc_kept_balance *kept, vsc_linear *linear, vsc_tangent *tangent, const double *free,
                          const double *x, const double *b, double tolerance, double *d, bool *indefinite,
                          vsc_error *error);

// p_k += part dp_k
void vsc_kept_advance(vsc_kept_balance *kept, double part);

// Takes from velocities v (node_count x 4) what would change the volumes where they are kept,
//   v <- v - M^-1 g^T (g M^-1 g^T)^-1 g v, M lumped.
vsc_status vsc_kept_settle(vsc_kept_balance *kept, double *v, vsc_error *error);

#endif
