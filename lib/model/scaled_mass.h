// SPDX-License-Identifier: GPL-3.0-or-later
// What explicit steps of a wanted length have cost in mass.
#ifndef VSC_MODEL_SCALED_MASS_H
#define VSC_MODEL_SCALED_MASS_H

#include <stddef.h>

// What mass scaling has done (solve/mass_scaling.h); all 0 without it.
typedef struct vsc_scaled_mass {
  double step;   // that is stable now, at rest and at full activation, ms
  double added;  // mg
  double most;   // at one node, as a part of its own mass
  size_t nodes;  // that have more than their own
} vsc_scaled_mass;

#endif
