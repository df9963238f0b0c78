// SPDX-License-Identifier: GPL-3.0-or-later
// Soft isotropic tissue (Veronda & Westmann 1970, skin; used for liver):
//
//   psi = c1 (e^(c2 (I_1 - 3)) - 1) - c1 c2/2 (I_2 - 3)
//
// free of stress at rest, shear modulus c1 c2.
#ifndef VSC_MODEL_LAW_VERONDA_WESTMANN_H
#define VSC_MODEL_LAW_VERONDA_WESTMANN_H

#include "model/law_mooney_rivlin.h"

VSC_INLINE void vsc_law_veronda_westmann(const vsc_invariants_def *constants, const vsc_wide e[6],
                                         vsc_law_depth depth, vsc_law_answer *answer)
{
  const double slope = constants->c1 * constants->c2;
  vsc_add_exponential_ground(2 * slope, constants->c2, e, depth, answer);
  vsc_add_second_invariant(-0.5 * slope, e, depth, answer);
}

#endif
