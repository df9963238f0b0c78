// SPDX-License-Identifier: GPL-3.0-or-later
// The exponentials of tissue laws, e^Q - 1, continued by their tangent where Q is so large that no
// tissue is left to be described, so that a step too far ends in a large force and not in infinity:
//
//   value  e^Q - 1  for Q <= 20,  e^20 (1 + Q - 20) - 1  beyond;  slope and curve its derivatives
#ifndef VSC_MODEL_LAW_EXPONENTIAL_H
#define VSC_MODEL_LAW_EXPONENTIAL_H

#include "base/wide_math.h"
#include "model/law_answer.h"

#define VSC_LARGEST_EXPONENT 20.0

typedef struct vsc_exponential {
  vsc_wide value, slope, curve;
} vsc_exponential;

// Notes the exponent in `answer`.
VSC_INLINE vsc_exponential vsc_exponential_of(vsc_wide Q, vsc_law_answer *answer)
{
  const vsc_wide most = vsc_splat(VSC_LARGEST_EXPONENT);
  const vsc_wide kept = vsc_select(Q < most, Q, most);
  const vsc_wide slope = vsc_wide_exp(kept);
  answer->exponent = vsc_select(Q > answer->exponent, Q, answer->exponent);
  return (vsc_exponential){.value = slope * (1 + (Q - kept)) - 1,
                           .slope = slope,
                           .curve = vsc_where(Q < most, slope)};
}

// Adds f(I) of a quantity I that is linear in strain, I = rest + sum_k slope_k e_k: f', f'' given.
VSC_INLINE void vsc_add_linear(const double slope[6], vsc_wide first, vsc_wide second,
                               vsc_law_depth depth, vsc_law_answer *answer)
{
  if (depth == VSC_LAW_ENERGY) return;
  for (int k = 0; k < 6; k++) answer->S[k] += first * slope[k];
  if (depth == VSC_LAW_STRESS) return;
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) answer->D[k][l] += second * (slope[k] * slope[l]);
}

// I_1 = tr C as such a quantity.
static const double vsc_first_invariant_slope[6] = {2, 2, 2, 0, 0, 0};

// I_1 - 3
VSC_INLINE vsc_wide vsc_first_invariant(const vsc_wide e[6])
{
  return 2 * (e[0] + e[1] + e[2]);
}

// Adds a/(2b) (e^(b (I_1 - 3)) - 1).
VSC_INLINE void vsc_add_exponential_ground(double a, double b, const vsc_wide e[6],
                                           vsc_law_depth depth, vsc_law_answer *answer)
{
  const vsc_exponential exponential = vsc_exponential_of(b * vsc_first_invariant(e), answer);
  answer->energy += (0.5 * a / b) * exponential.value;
  vsc_add_linear(vsc_first_invariant_slope, 0.5 * a * exponential.slope,
                 0.5 * a * b * exponential.curve, depth, answer);
}

#endif
