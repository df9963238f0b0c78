// SPDX-License-Identifier: GPL-3.0-or-later
// Incompressibility to a tolerance by the augmented Lagrangian (Glowinski & Le Tallec 1989; Simo & Taylor
// 1991): each group that shares a volume ratio J has a multiplier beside its pressure,
//   p = lambda + U'(J),  and after each equilibrium  lambda <- lambda + f(lambda),  f = U'(J),
// until no ratio is off 1 by more than the tolerance. K need not be large then. These updates alone get nowhere where
// moves that change volumes are far stiffer than K: by 1 - K/stiffness each time. So they are extrapolated (Anderson
// 1965; Walker & Ni 2011): of the last rounds' differences dlambda_k, made so that their df_k are orthonormal,
//   lambda <- lambda + f - sum_k (df_k . f) (dlambda_k + df_k),
// which is conjugate gradients' pace for what changes little from round to round.
#ifndef VSC_SOLVE_INCOMPRESSIBLE_H
#define VSC_SOLVE_INCOMPRESSIBLE_H

#include "mech/state.h"

enum { VSC_MOST_ROUNDS = 30 };  // of multipliers for one equilibrium

typedef struct vsc_multipliers vsc_multipliers;

// Memory for `model`, which must outlive it; *multipliers is NULL without solve.incompressible. The caller owns
// *multipliers.
vsc_status vsc_multipliers_create(const vsc_model *model, vsc_multipliers **multipliers, vsc_error *error);

void vsc_multipliers_free(vsc_multipliers *multipliers);  // NULL is fine

// Before the rounds of an equilibrium: keeps the multipliers in the scratch, and forgets earlier rounds.
void vsc_multipliers_begin(vsc_multipliers *multipliers, const vsc_scratch *scratch);

// One round: returns the largest |J - 1| of all groups at x (node_count x 4), where forces balance with the multipliers
// in the scratch; above solve.incompressible these are updated. Groups: node-averaged tets round a node; each element
// of the other kinds.
double vsc_multipliers_update(vsc_multipliers *multipliers, const double *x, vsc_scratch *scratch);

// Puts those of vsc_multipliers_begin back, after an equilibrium that was not found.
void vsc_multipliers_restore(const vsc_multipliers *multipliers, vsc_scratch *scratch);

#endif
