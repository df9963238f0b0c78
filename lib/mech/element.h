// SPDX-License-Identifier: GPL-3.0-or-later
// One pack of elements seen from outside the force loop. Internal to mech.
#ifndef VSC_MECH_ELEMENT_H
#define VSC_MECH_ELEMENT_H

#include "mech/state.h"
#include "model/law_springs.h"

// G = sum_i B_ai x_i of four tets, from node x 4 numbers in the model's order.
VSC_INLINE void vsc_pack_axes(const vsc_model *model, const vsc_patch *patch, const vsc_pack *pack,
                              const double *nodes, vsc_wide3 g[3])
{
  vsc_wide3 edge[3];
  for (int l = 0; l < VSC_WIDTH; l++) {
    const double *first = nodes + 4 * (size_t)vsc_node_of(model, patch, pack->node[0][l]);
    for (int i = 0; i < 3; i++) {
      const double *other = nodes + 4 * (size_t)vsc_node_of(model, patch, pack->node[i + 1][l]);
      edge[i].x[l] = other[0] - first[0];
      edge[i].y[l] = other[1] - first[1];
      edge[i].z[l] = other[2] - first[2];
    }
  }
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(pack->B[a][0], edge[0], pack->B[a][1], edge[1], pack->B[a][2], edge[2]);
}

// det G
VSC_INLINE vsc_wide vsc_pack_ratio(const vsc_wide3 g[3])
{
  return vsc_wide_dot(g[0], vsc_wide_cross(g[1], g[2]));
}

// Active tension of a slot at fibre stretch `stretch`, kPa: T, or what the active spring adds to
// the passive one, E_f(t) (stretch - r(t)) - E_f (stretch - 1). `nominal` is the same as force per
// area at rest.
static inline double vsc_active_tension(const vsc_model *model, const vsc_material *material,
                                        size_t slot, double time, double stretch, double *nominal)
{
  *nominal = 0;
  if (material->active == VSC_ACTIVE_NONE || model->mesh_element[slot] == VSC_NO_ELEMENT) return 0;
  const double a = vsc_model_activation(model, material, slot, time);
  if (material->active == VSC_ACTIVE_TENSION) {
    *nominal = a * material->tension * stretch;
    return a * material->tension;
  }
  const double E = material->axial[0] + a * (material->active_stiffness - material->axial[0]);
  const double rest = 1 - a * (1 - material->rest_stretch);
  *nominal = E * (stretch - rest) - material->axial[0] * (stretch - 1);
  return *nominal;
}

#endif
