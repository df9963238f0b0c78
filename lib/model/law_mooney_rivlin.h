// SPDX-License-Identifier: GPL-3.0-or-later
// psi = c1 (I_1 - 3) + c2 (I_2 - 3) (Mooney 1940, Rivlin 1948), shear modulus 2 (c1 + c2). With
// C = 1 + 2 E, pairs fs, sn, nf:
//
//   I_2 = sum_a C_aa C_bb - sum_ab C_ab^2,  b = a + 1
//   I_2,aa = 2 (C_bb + C_cc),  I_2,ab = -2 C_ab,  I_2,aabb = 4,  I_2,abab = -2
#ifndef VSC_MODEL_LAW_MOONEY_RIVLIN_H
#define VSC_MODEL_LAW_MOONEY_RIVLIN_H

#include "model/definition.h"
#include "model/law_neo_hookean.h"

// Adds weight (I_2 - 3).
VSC_INLINE void vsc_add_second_invariant(double weight, const vsc_wide e[6], vsc_law_depth depth,
                                         vsc_law_answer *answer)
{
  // I_2 - 3 = 4 tr E + sum_a (4 E_aa E_bb - C_ab^2)
  const vsc_wide trace = e[0] + e[1] + e[2];
  vsc_wide change = 4 * trace;
  for (int a = 0; a < 3; a++) change += 4 * e[a] * e[(a + 1) % 3] - e[3 + a] * e[3 + a];
  answer->energy += weight * change;
  if (depth == VSC_LAW_ENERGY) return;
  for (int a = 0; a < 3; a++) {
    answer->S[a] += weight * (4 + 4 * (trace - e[a]));
    answer->S[3 + a] -= 2 * weight * e[3 + a];
  }
  if (depth == VSC_LAW_STRESS) return;
  for (int a = 0; a < 3; a++) {
    answer->D[a][(a + 1) % 3] += 4 * weight;
    answer->D[(a + 1) % 3][a] += 4 * weight;
    answer->D[3 + a][3 + a] -= 2 * weight;
  }
}

VSC_INLINE void vsc_law_mooney_rivlin(const vsc_invariants_def *constants, const vsc_wide e[6],
                                      vsc_law_depth depth, vsc_law_answer *answer)
{
  vsc_law_neo_hookean(2 * constants->c1, e, depth, answer);
  vsc_add_second_invariant(constants->c2, e, depth, answer);
}

#endif
