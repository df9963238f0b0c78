// SPDX-License-Identifier: GPL-3.0-or-later
// Orthotropic exponential tissue (Fung's form; Usyk, Mazhari & McCulloch 2000), of which the
// transversely isotropic law of Guccione, McCulloch & Waldman 1991 is the case b_ff = bf,
// b_ss = b_nn = b_sn = bt, b_fs = b_nf = bfs:
//
//   psi = C/2 (e^Q - 1)
//   Q = b_ff E_ff^2 + b_ss E_ss^2 + b_nn E_nn^2 + 2 (b_fs E_fs^2 + b_sn E_sn^2 + b_nf E_nf^2)
//   S_ab = C e^Q b_ab E_ab
//
// that is Q = sum_k w_k e_k^2 with w = b along the axes and b/2 between them. At small strain it is
// springs of E_a = C b_aa, G_ab = C b_ab/2.
#ifndef VSC_MODEL_LAW_FUNG_H
#define VSC_MODEL_LAW_FUNG_H

#include "model/definition.h"
#include "model/law_exponential.h"

VSC_INLINE void vsc_law_fung(const vsc_fung_def *constants, const vsc_wide e[6],
                             vsc_law_depth depth, vsc_law_answer *answer)
{
  const double C = constants->C;
  vsc_wide pull[6], Q = vsc_splat(0);  // w_k e_k
  for (int k = 0; k < 6; k++) {
    pull[k] = (k < 3 ? constants->b[k] : 0.5 * constants->b[k]) * e[k];
    Q += pull[k] * e[k];
  }
  const vsc_exponential exponential = vsc_exponential_of(Q, answer);
  answer->energy += 0.5 * C * exponential.value;
  if (depth == VSC_LAW_ENERGY) return;
  for (int k = 0; k < 6; k++) answer->S[k] += C * exponential.slope * pull[k];
  if (depth == VSC_LAW_STRESS) return;
  for (int k = 0; k < 6; k++) {
    answer->D[k][k] += C * exponential.slope * (k < 3 ? constants->b[k] : 0.5 * constants->b[k]);
    for (int l = 0; l < 6; l++)
      answer->D[k][l] += 2 * C * exponential.curve * pull[k] * pull[l];
  }
}

#endif
