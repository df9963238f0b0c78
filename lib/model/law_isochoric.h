// SPDX-License-Identifier: GPL-3.0-or-later
// A law on the deformation without its change of volume: psi(E') with E' = (J^(-2/3) C - 1)/2. With
// F(I_3) = I_3^(-1/3), I_3 = det C = J^2, and c = (C_ff/2, C_ss/2, C_nn/2, C_fs, C_sn, C_nf):
//
//   e'_m = F c_m + rest,  de'_m/de_k = F delta_mk + c_m F' I_3,k
//   S_k = F S'_k + F' (S' . c) I_3,k
//   D_kl = sum_mn de'_m/de_k D'_mn de'_n/de_l + F' (S'_k I_3,l + S'_l I_3,k)
//          + (S' . c) (F'' I_3,k I_3,l + F' I_3,kl)
//
// Below I_3 = J0^2 = 0.04 F is continued by its second-order Taylor polynomial, as U is below J0.
#ifndef VSC_MODEL_LAW_ISOCHORIC_H
#define VSC_MODEL_LAW_ISOCHORIC_H

#include "base/wide_math.h"
#include "model/law_answer.h"
#include "model/law_volume.h"

typedef struct vsc_isochoric {
  vsc_wide e[6];            // of E', engineering shears
  vsc_wide c[6];            // of C, as above
  vsc_wide F, first, second;  // F, F', F''
  vsc_wide slope[6];        // I_3,k
} vsc_isochoric;

// det C of C_aa = c[a], C_a,a+1 = c[3 + a], and its derivatives by e.
VSC_INLINE vsc_wide vsc_third_invariant(const vsc_wide C[6], vsc_wide slope[6])
{
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    // the row and column that are left when a is struck out: C_bc is the pair b
    slope[a] = 2 * (C[b] * C[c] - C[3 + b] * C[3 + b]);
    slope[3 + a] = 2 * (C[3 + b] * C[3 + c] - C[c] * C[3 + a]);
  }
  return 0.5 * (C[0] * slope[0] + C[3] * slope[3] + C[5] * slope[5]);
}

VSC_INLINE void vsc_isochoric_of(const vsc_wide e[6], vsc_isochoric *iso)
{
  const double lowest = VSC_VOLUME_J0 * VSC_VOLUME_J0;
  vsc_wide C[6];
  for (int a = 0; a < 3; a++) {
    C[a] = 1 + 2 * e[a];
    C[3 + a] = e[3 + a];
    iso->c[a] = 0.5 * C[a];
    iso->c[3 + a] = C[3 + a];
  }
  const vsc_wide I3 = vsc_third_invariant(C, iso->slope);
  const vsc_wide kept = vsc_select(I3 > lowest, I3, vsc_splat(lowest));
  const vsc_wide F = vsc_wide_exp(vsc_wide_log(kept) * (-1.0 / 3));
  const vsc_wide below = (I3 - kept) / kept;
  iso->second = (4.0 / 9) * F / (kept * kept);
  iso->first = F / kept * ((4.0 / 9) * below - 1.0 / 3);
  iso->F = F * (1 - below * (1.0 / 3) + (2.0 / 9) * below * below);
  for (int a = 0; a < 3; a++) {
    iso->e[a] = iso->F * iso->c[a] - 0.5;
    iso->e[3 + a] = iso->F * iso->c[3 + a];
  }
}

// I_3,kl: 2 C_cc between ff and ss (n being c), and so on.
VSC_INLINE void vsc_third_invariant_curve(const vsc_isochoric *iso, vsc_wide curve[6][6])
{
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) curve[k][l] = vsc_splat(0);
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3, c = (a + 2) % 3;
    curve[a][b] = curve[b][a] = 8 * iso->c[c];
    curve[a][3 + b] = curve[3 + b][a] = -4 * iso->c[3 + b];
    curve[3 + a][3 + b] = curve[3 + b][3 + a] = 2 * iso->c[3 + c];
    curve[3 + a][3 + a] = -4 * iso->c[c];
  }
}

// From the answer at E' to that at E.
VSC_INLINE void vsc_isochoric_answer(const vsc_isochoric *iso, vsc_law_depth depth,
                                     vsc_law_answer *answer)
{
  if (depth == VSC_LAW_ENERGY) return;
  const vsc_wide *slope = iso->slope;
  vsc_wide S[6], along = vsc_splat(0);
  for (int k = 0; k < 6; k++) {
    S[k] = answer->S[k];
    along += S[k] * iso->c[k];
  }
  for (int k = 0; k < 6; k++) answer->S[k] = iso->F * S[k] + iso->first * along * slope[k];
  if (depth == VSC_LAW_STRESS) return;
  vsc_wide Dc[6], cDc = vsc_splat(0), curve[6][6];
  for (int k = 0; k < 6; k++) {
    Dc[k] = vsc_splat(0);
    for (int l = 0; l < 6; l++) Dc[k] += answer->D[k][l] * iso->c[l];
  }
  for (int k = 0; k < 6; k++) cDc += iso->c[k] * Dc[k];
  vsc_third_invariant_curve(iso, curve);
  const vsc_wide both = iso->first * iso->first * cDc + iso->second * along;
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++)
      answer->D[k][l] = iso->F * iso->F * answer->D[k][l] +
                        iso->first * (slope[l] * (S[k] + iso->F * Dc[k]) +
                                      slope[k] * (S[l] + iso->F * Dc[l]) + along * curve[k][l]) +
                        both * slope[k] * slope[l];
}

#endif
