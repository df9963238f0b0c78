// SPDX-License-Identifier: GPL-3.0-or-later
// Myocardium as a ground with two families of fibres (Holzapfel & Ogden 2009):
//
//   psi = a/(2b) (e^(b (I_1 - 3)) - 1) + sum_{i = f, s} chi_i a_i/(2 b_i) (e^(b_i x_i^2) - 1)
//         + a_fs/(2 b_fs) (e^(b_fs I_8^2) - 1)
//   x_i = kappa_i (I_1 - 3) + (1 - 3 kappa_i) (I_4i - 1),  I_4f = C_ff, I_4s = C_ss, I_8 = C_fs
//
// kappa_i is the dispersion of fibres (Gasser, Ogden & Holzapfel 2006; Eriksson et al. 2013): 0 when
// all are parallel, 1/3 when they go everywhere alike. Fibres in compression: chi = 1 keeps them, and
// sharp is 1 for x > 0, else 0; smooth is 1/(1 + e^(-k x)), which multiplies the energy, so that its
// derivative is in the stress (Arostica et al. 2025). Only the ground may be put on the isochoric
// deformation.
#ifndef VSC_MODEL_LAW_HOLZAPFEL_OGDEN_H
#define VSC_MODEL_LAW_HOLZAPFEL_OGDEN_H

#include "model/definition.h"
#include "model/law_exponential.h"

// w(x) and its derivatives.
typedef struct vsc_fibre_energy {
  vsc_wide value, first, second;
} vsc_fibre_energy;

// w -> chi w
VSC_INLINE vsc_fibre_energy vsc_switch_fibres(vsc_fibre_energy w, vsc_wide x, vsc_fibre_switch kind,
                                              double steepness)
{
  if (kind == VSC_FIBRES_ALWAYS) return w;
  if (kind == VSC_FIBRES_SHARP)
    return (vsc_fibre_energy){vsc_where(x > 0.0, w.value), vsc_where(x > 0.0, w.first),
                              vsc_where(x > 0.0, w.second)};
  // chi' = k chi (1 - chi), chi'' = k chi' (1 - 2 chi)
  const vsc_wide chi = 1 / (1 + vsc_wide_exp(-steepness * x));
  const vsc_wide first = steepness * chi * (1 - chi), second = steepness * first * (1 - 2 * chi);
  return (vsc_fibre_energy){chi * w.value, chi * w.first + first * w.value,
                            chi * w.second + 2 * first * w.first + second * w.value};
}

// Adds the family along axis 0 (f) or 1 (s).
VSC_INLINE void vsc_add_fibres(const vsc_holzapfel_ogden_def *constants,
                               vsc_fibre_switch compression, int axis, const vsc_wide e[6],
                               vsc_law_depth depth, vsc_law_answer *answer)
{
  const double a = axis == 0 ? constants->a_f : constants->a_s;
  const double b = axis == 0 ? constants->b_f : constants->b_s;
  const double kappa = axis == 0 ? constants->kappa_f : constants->kappa_s;
  if (a == 0) return;
  double slope[6] = {2 * kappa, 2 * kappa, 2 * kappa, 0, 0, 0};
  slope[axis] += 2 * (1 - 3 * kappa);
  const vsc_wide x = slope[0] * e[0] + slope[1] * e[1] + slope[2] * e[2];
  // fibres that are switched off have no exponent
  vsc_wide Q = b * x * x;
  if (compression == VSC_FIBRES_SHARP) Q = vsc_where(x > 0.0, Q);
  const vsc_exponential exponential = vsc_exponential_of(Q, answer);
  // w = a/(2b) (e^Q - 1), w' = a x e^Q, w'' = a e^Q + 2 a b x^2 e^Q
  const vsc_fibre_energy w = vsc_switch_fibres(
      (vsc_fibre_energy){0.5 * a / b * exponential.value, a * x * exponential.slope,
                         a * exponential.slope + 2 * a * b * x * x * exponential.curve},
      x, compression, constants->steepness);
  answer->energy += w.value;
  vsc_add_linear(slope, w.first, w.second, depth, answer);
}

// Adds the term between fibres and sheets.
VSC_INLINE void vsc_add_fibre_shear(double a, double b, const vsc_wide e[6], vsc_law_depth depth,
                                    vsc_law_answer *answer)
{
  static const double slope[6] = {0, 0, 0, 1, 0, 0};
  if (a == 0) return;
  const vsc_wide I8 = e[3];
  const vsc_exponential exponential = vsc_exponential_of(b * I8 * I8, answer);
  answer->energy += 0.5 * a / b * exponential.value;
  vsc_add_linear(slope, a * I8 * exponential.slope,
                 a * exponential.slope + 2 * a * b * I8 * I8 * exponential.curve, depth, answer);
}

// Adds all terms but the ground, which is vsc_add_exponential_ground.
VSC_INLINE void vsc_law_holzapfel_ogden_fibres(const vsc_holzapfel_ogden_def *constants,
                                               vsc_fibre_switch compression, const vsc_wide e[6],
                                               vsc_law_depth depth, vsc_law_answer *answer)
{
  vsc_add_fibres(constants, compression, 0, e, depth, answer);
  vsc_add_fibres(constants, compression, 1, e, depth, answer);
  vsc_add_fibre_shear(constants->a_fs, constants->b_fs, e, depth, answer);
}

#endif
