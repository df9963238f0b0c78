// SPDX-License-Identifier: GPL-3.0-or-later
// What resists the rate of strain: S = D_v de/dt. An axial damper eta along d resists dn/dt with
// n^2 = d . (1 + 2 E) d = q: D_v = eta q' q'^T/(4 q), q' = dq/de.
#ifndef VSC_MODEL_LAW_VISCOUS_H
#define VSC_MODEL_LAW_VISCOUS_H

#include "model/law_springs_strain.h"

VSC_INLINE void vsc_add_damper(const double d[3], vsc_wide eta, const vsc_wide e[6], vsc_wide D[6][6])
{
  const vsc_strain_form q = vsc_strain_form_of(d, d, e);
  const vsc_wide shortest = vsc_splat(VSC_SHORTEST_AXIS * VSC_SHORTEST_AXIS);
  const vsc_wide part = 0.25 * eta / vsc_select(q.value > shortest, q.value, shortest);
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) D[k][l] += part * (q.slope[k] * q.slope[l]);
}

// D_v of four frames, kPa ms.
VSC_INLINE void vsc_law_viscous(const vsc_material *material, const vsc_mixture *moduli,
                                const vsc_axis *axes, const vsc_wide e[6], vsc_wide D[6][6])
{
  static const double own[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (int k = 0; k < 6; k++)
    for (int l = 0; l < 6; l++) D[k][l] = vsc_splat(0);
  for (int a = 0; a < 3; a++) vsc_add_damper(own[a], moduli->damping[a], e, D);
  for (size_t d = 0; d < material->axis_count; d++)
    vsc_add_damper(axes[d].direction, moduli->share * axes[d].damping, e, D);
}

#endif
