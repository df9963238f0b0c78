// SPDX-License-Identifier: GPL-3.0-or-later
// Active tension along the fibre, as second Piola-Kirchhoff stress: S_ff += T (Land et al. 2015).
#ifndef VSC_MODEL_LAW_ACTIVE_H
#define VSC_MODEL_LAW_ACTIVE_H

#include "model/law_answer.h"
#include "model/model.h"

// `activation` is a in T = a tension.
VSC_INLINE void vsc_law_add_tension(const vsc_material *material, vsc_wide activation,
                                    const vsc_wide e[6], bool tangent, vsc_law_answer *answer)
{
  (void)e;
  (void)tangent;
  answer->S[0] += activation * material->tension;
}

#endif
