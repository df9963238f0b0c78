// SPDX-License-Identifier: GPL-3.0-or-later
// Rubber: psi = mu/2 (I_1 - 3), I_1 = tr C (Rivlin 1948). At small strain, with the logarithm of
// model/law_volume.h or on the isochoric deformation, mu is the shear modulus.
#ifndef VSC_MODEL_LAW_NEO_HOOKEAN_H
#define VSC_MODEL_LAW_NEO_HOOKEAN_H

#include "model/law_exponential.h"

VSC_INLINE void vsc_law_neo_hookean(double shear, const vsc_wide e[6], vsc_law_depth depth,
                                    vsc_law_answer *answer)
{
  answer->energy += 0.5 * shear * vsc_first_invariant(e);
  vsc_add_linear(vsc_first_invariant_slope, vsc_splat(0.5 * shear), vsc_splat(0), depth, answer);
}

#endif
