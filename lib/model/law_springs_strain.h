// SPDX-License-Identifier: GPL-3.0-or-later
// The springs of model/law_springs.h as a function of strain, for what needs their tangent. Along an
// axis n_a^2 = 1 + 2 E_aa, between two c = 2 E_ab/(n_a n_b); an axis d = (d_f, d_s, d_n) beside them
// has n_d^2 = d . (1 + 2 E) d: the squares q = n^2 and products are linear in e,
//
//   psi = E (sqrt q - r)^2 / 2,                S = E (1 - r/n) q',        D = E r/n^3 q' q'^T
//   psi = G (c - c0)^2 / 2, c = y/(n_i n_j),   c_k = y_k/(n_i n_j) - c (q_i,k/q_i + q_j,k/q_j)/2
//   psi = H (n_a - 1) (n_b - 1)                between two of the frame's axes, n_a,k = q_a,k/(2 n_a)
//
// with q' = dq/de/2, y = u_i . u_j of the unnormalised axes.
#ifndef VSC_MODEL_LAW_SPRINGS_STRAIN_H
#define VSC_MODEL_LAW_SPRINGS_STRAIN_H

#include "model/law_answer.h"
#include "model/law_springs.h"
#include "model/model.h"

// The bilinear form of two directions in fibre axes: value of i . C j and its derivatives by e, where
// C = 1 + 2 E.
typedef struct vsc_strain_form {
  vsc_wide value;
  double slope[6];
} vsc_strain_form;

VSC_INLINE vsc_strain_form vsc_strain_form_of(const double i[3], const double j[3], const vsc_wide e[6])
{
  vsc_strain_form form = {.value = vsc_splat(i[0] * j[0] + i[1] * j[1] + i[2] * j[2])};
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    form.slope[a] = 2 * i[a] * j[a];
    form.slope[3 + a] = i[a] * j[b] + i[b] * j[a];
    form.value += form.slope[a] * e[a] + form.slope[3 + a] * e[3 + a];
  }
  return form;
}

// Adds a spring of modulus E and rest stretch r along a direction.
VSC_INLINE void vsc_add_axial(const double d[3], vsc_wide modulus, vsc_wide rest, const vsc_wide e[6],
                              bool only_energy, bool tangent, vsc_law_answer *answer)
{
  const vsc_strain_form q = vsc_strain_form_of(d, d, e);
  const vsc_wide shortest = vsc_splat(VSC_SHORTEST_AXIS * VSC_SHORTEST_AXIS);
  const vsc_wide n = vsc_wide_sqrt(vsc_select(q.value > shortest, q.value, shortest));
  answer->energy += 0.5 * modulus * (n - rest) * (n - rest);
  if (only_energy) return;
  const vsc_wide pull = 0.5 * modulus * (1 - rest / n);
  for (int k = 0; k < 6; k++) answer->S[k] += pull * q.slope[k];
  if (!tangent) return;
  const vsc_wide curve = 0.25 * modulus * rest / (n * n * n);
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) answer->D[k][l] += curve * (q.slope[k] * q.slope[l]);
}

// Adds an angular spring of modulus G and rest cosine c0 between two directions.
VSC_INLINE void vsc_add_angular(const double i[3], const double j[3], vsc_wide modulus, double rest,
                                const vsc_wide e[6], bool only_energy, bool tangent,
                                vsc_law_answer *answer)
{
  const vsc_strain_form q = vsc_strain_form_of(i, i, e), p = vsc_strain_form_of(j, j, e);
  const vsc_strain_form y = vsc_strain_form_of(i, j, e);
  const vsc_wide shortest = vsc_splat(VSC_SHORTEST_AXIS * VSC_SHORTEST_AXIS);
  const vsc_wide inverse_q = 1.0 / vsc_select(q.value > shortest, q.value, shortest);
  const vsc_wide inverse_p = 1.0 / vsc_select(p.value > shortest, p.value, shortest);
  const vsc_wide both = vsc_wide_sqrt(inverse_q * inverse_p), c = y.value * both;
  const vsc_wide away = c - rest;
  answer->energy += 0.5 * modulus * away * away;
  if (only_energy) return;
  vsc_wide slope[6], half[6];
  for (int k = 0; k < 6; k++) {
    half[k] = 0.5 * (q.slope[k] * inverse_q + p.slope[k] * inverse_p);
    slope[k] = y.slope[k] * both - c * half[k];
    answer->S[k] += modulus * away * slope[k];
  }
  if (!tangent) return;
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) {
      // c_kl = -y_k both h_l - c_l h_k + c (q_k q_l/q^2 + p_k p_l/p^2)/2
      const vsc_wide bend = 0.5 * c * (q.slope[k] * q.slope[l] * inverse_q * inverse_q +
                                       p.slope[k] * p.slope[l] * inverse_p * inverse_p) -
                            y.slope[k] * both * half[l] - slope[l] * half[k];
      answer->D[k][l] += modulus * (slope[k] * slope[l] + away * bend);
    }
}

// Adds the coupling H of the frame's axes a and b = a + 1.
VSC_INLINE void vsc_add_coupling(int a, vsc_wide modulus, const vsc_wide e[6], bool only_energy,
                                 bool tangent, vsc_law_answer *answer)
{
  const int axis[2] = {a, (a + 1) % 3};
  const vsc_wide shortest = vsc_splat(VSC_SHORTEST_AXIS * VSC_SHORTEST_AXIS);
  vsc_wide n[2];
  for (int i = 0; i < 2; i++) {
    const vsc_wide q = 1 + 2 * e[axis[i]];
    n[i] = vsc_wide_sqrt(vsc_select(q > shortest, q, shortest));
  }
  answer->energy += modulus * (n[0] - 1) * (n[1] - 1);
  if (only_energy) return;
  for (int i = 0; i < 2; i++) answer->S[axis[i]] += modulus * (n[1 - i] - 1) / n[i];
  if (!tangent) return;
  for (int i = 0; i < 2; i++) {
    answer->D[axis[i]][axis[i]] -= modulus * (n[1 - i] - 1) / (n[i] * n[i] * n[i]);
    answer->D[axis[i]][axis[1 - i]] += modulus / (n[0] * n[1]);
  }
}

VSC_INLINE void vsc_law_springs_strain(const vsc_material *material, const vsc_mixture *moduli,
                                       const vsc_axis *axes, const vsc_pair *pairs,
                                       vsc_wide activation, const vsc_wide e[6], bool only_energy,
                                       bool tangent, vsc_law_answer *answer)
{
  static const double own[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  vsc_wide fibre = moduli->axial[0], rest = vsc_splat(1);
  if (material->active == VSC_ACTIVE_SPRING && !only_energy) {
    const vsc_wide part = moduli->share * activation;
    fibre += part * (material->active_stiffness - material->axial[0]);
    rest = vsc_shared_rest(activation * (1 - material->rest_stretch), fibre,
                           moduli->axial[0] - moduli->share * material->axial[0]);
  }
  for (int a = 0; a < 3; a++) {
    vsc_add_axial(own[a], a == 0 ? fibre : moduli->axial[a], a == 0 ? rest : vsc_splat(1), e,
                  only_energy, tangent, answer);
    vsc_add_angular(own[a], own[(a + 1) % 3], moduli->angular[a], 0, e, only_energy, tangent, answer);
    vsc_add_coupling(a, moduli->coupling[a], e, only_energy, tangent, answer);
  }
  for (size_t d = 0; d < material->axis_count; d++)
    vsc_add_axial(axes[d].direction, moduli->share * axes[d].modulus, vsc_splat(1), e, only_energy,
                  tangent, answer);
  for (size_t d = 0; d < material->pair_count; d++)
    vsc_add_angular(pairs[d].first, pairs[d].second, moduli->share * pairs[d].modulus,
                    pairs[d].cosine, e, only_energy, tangent, answer);
}

#endif
