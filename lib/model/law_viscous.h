// SPDX-License-Identifier: GPL-3.0-or-later
// What resists the rate of strain: S = D_v de/dt.
//
// Kelvin-Voigt viscosity eta of the frame: S = eta dE/dt (Arostica et al. 2025), that is D_v = eta
// along the axes and eta/2 between them, whose strains are twice E_ab. An axial damper eta along d
// resists dn/dt with n^2 = d . (1 + 2 E) d = q: D_v = eta q' q'^T/(4 q), q' = dq/de.
#ifndef VSC_MODEL_LAW_VISCOUS_H
#define VSC_MODEL_LAW_VISCOUS_H

#include "model/law_springs_strain.h"

// de/dt of axes g with rates dg/dt.
VSC_INLINE void vsc_strain_rate(const vsc_wide3 g[3], const vsc_wide3 rate[3], vsc_wide speed[6])
{
  for (int a = 0; a < 3; a++) {
    const int b = (a + 1) % 3;
    speed[a] = vsc_wide_dot(g[a], rate[a]);
    speed[3 + a] = vsc_wide_dot(g[a], rate[b]) + vsc_wide_dot(g[b], rate[a]);
  }
}

// q' of a damper along d, and eta/(4 q).
VSC_INLINE vsc_wide vsc_damper_of(const double d[3], vsc_wide eta, const vsc_wide e[6],
                                  vsc_strain_form *q)
{
  *q = vsc_strain_form_of(d, d, e);
  const vsc_wide shortest = vsc_splat(VSC_SHORTEST_AXIS * VSC_SHORTEST_AXIS);
  return 0.25 * eta / vsc_select(q->value > shortest, q->value, shortest);
}

VSC_INLINE void vsc_add_damper(const double d[3], vsc_wide eta, const vsc_wide e[6], vsc_wide D[6][6])
{
  vsc_strain_form q;
  const vsc_wide part = vsc_damper_of(d, eta, e, &q);
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) D[k][l] += part * (q.slope[k] * q.slope[l]);
}

VSC_INLINE void vsc_add_damper_stress(const double d[3], vsc_wide eta, const vsc_wide e[6],
                                      const vsc_wide speed[6], vsc_wide S[6])
{
  vsc_strain_form q;
  vsc_wide change = vsc_splat(0);
  const vsc_wide part = vsc_damper_of(d, eta, e, &q);
  for (int k = 0; k < 6; k++) change += q.slope[k] * speed[k];
  for (int k = 0; k < 6; k++) S[k] += part * change * q.slope[k];
}

// D_v of four frames, kPa ms.
VSC_INLINE void vsc_law_viscous(const vsc_material *material, const vsc_mixture *moduli,
                                const vsc_axis *axes, const vsc_wide e[6], vsc_wide D[6][6])
{
  static const double own[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 6; k++) {
    for (int l = 0; l < 6; l++) D[k][l] = vsc_splat(0);
    D[k][k] = (k < 3 ? 1.0 : 0.5) * moduli->viscosity;
  }
  for (int a = 0; a < 3; a++) vsc_add_damper(own[a], moduli->damping[a], e, D);
  for (size_t d = 0; d < material->axis_count; d++)
    vsc_add_damper(axes[d].direction, moduli->share * axes[d].damping, e, D);
}

// Adds D_v de/dt to S, for `speed` = de/dt (1/ms).
VSC_INLINE void vsc_law_add_viscous_stress(const vsc_material *material, const vsc_mixture *moduli,
                                           const vsc_axis *axes, const vsc_wide e[6],
                                           const vsc_wide speed[6], vsc_wide S[6])
{
  static const double own[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 6; k++) S[k] += (k < 3 ? 1.0 : 0.5) * moduli->viscosity * speed[k];
  for (int a = 0; a < 3; a++) vsc_add_damper_stress(own[a], moduli->damping[a], e, speed, S);
  for (size_t d = 0; d < material->axis_count; d++)
    vsc_add_damper_stress(axes[d].direction, moduli->share * axes[d].damping, e, speed, S);
}

#endif
