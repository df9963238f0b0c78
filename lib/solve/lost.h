// SPDX-License-Identifier: GPL-3.0-or-later
// Where explicit steps lose their first number.
#ifndef VSC_SOLVE_LOST_H
#define VSC_SOLVE_LOST_H

#include "mech/culprit.h"

typedef struct vsc_lost {
  double time, steps;   // of the state in which a number is not finite, ms, 1
  size_t node;          // whose position or velocity that is; of several the one that was accelerated most before
  vsc_culprit culprit;  // what pulled most there a step before, when all numbers were finite
} vsc_lost;

// Goes on from a state of explicit steps, one of them at a time as vsc_advance takes them, until a position or velocity
// is no longer finite, to `until` (ms) at most. False where that does not come, where vsc_advance ends for another
// reason, and where memory is short. The state is to be thrown away.
bool vsc_find_lost(const vsc_model *model, vsc_state *state, double until, vsc_lost *lost);

#endif
