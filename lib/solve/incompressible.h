// SPDX-License-Identifier: GPL-3.0-or-later
// Incompressibility to a tolerance by the augmented Lagrangian (Glowinski & Le Tallec 1989; Simo & Taylor
// 1991): each group that shares a volume ratio J has a multiplier beside its pressure,
//   p = lambda + U'(J),  and after each equilibrium  lambda <- lambda + U'(J),
// until no ratio is off 1 by more than the tolerance. K need not be large then.
#ifndef VSC_SOLVE_INCOMPRESSIBLE_H
#define VSC_SOLVE_INCOMPRESSIBLE_H

#include "mech/state.h"

enum { VSC_MOST_ROUNDS = 30 };  // of multipliers for one equilibrium

// Takes U'(J) of all groups at x (node_count x 4) into their multipliers, in the scratch. Returns the largest
// |J - 1|. Groups: node-averaged tets round a node; each element of the other kinds.
double vsc_multipliers_update(const vsc_model *model, const double *x, vsc_scratch *scratch);

#endif
