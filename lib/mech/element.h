// SPDX-License-Identifier: GPL-3.0-or-later
// One pack of elements seen from outside the force loop. Internal to mech.
#ifndef VSC_MECH_ELEMENT_H
#define VSC_MECH_ELEMENT_H

#include "mech/state.h"
#include "model/law_active.h"
#include "model/law_springs.h"

// Whether elements of a patch resist velocity: where only surfaces do, no element pays for it.
static inline bool vsc_patch_is_damped(const vsc_model *model, const vsc_patch *patch)
{
  return patch->mixed ? model->terms.damping : model->materials[patch->material].damped;
}

// Corner positions (or velocities) of four parts, from node x 4 numbers in the model's order (aligned as vsc_alloc does).
VSC_INLINE void vsc_pack_corners(const vsc_model *model, const vsc_patch *patch,
                                 const uint16_t (*node)[VSC_WIDTH], int corners,
                                 const double *nodes, vsc_wide3 *x)
{
  for (int c = 0; c < corners; c++) {
    vsc_wide row[VSC_WIDTH];
    for (int l = 0; l < VSC_WIDTH; l++)
      row[l] = *(const vsc_wide *)(nodes + 4 * (size_t)vsc_node_of(model, patch, node[c][l]));
    vsc_transpose(&row[0], &row[1], &row[2], &row[3]);
    x[c] = (vsc_wide3){row[0], row[1], row[2]};
  }
}

// G = sum_i B_ai x_i of frame `q` of four cells, from node x 4 numbers in the model's order.
VSC_INLINE void vsc_pack_axes(const vsc_model *model, const vsc_patch *patch, size_t k, int q,
                              const double *nodes, vsc_wide3 g[3])
{
  const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
  const vsc_frame *frame = vsc_pack_frames(model, patch, k) + q;
  const int corners = vsc_family_corners(patch->family);
  vsc_wide3 h[3] = {0};
  vsc_wide3 first, x;
  vsc_pack_corners(model, patch, node, 1, nodes, &first);
  for (int c = 1; c < corners; c++) {
    // sum_c D_c = 0: seen from the first corner, so that distant bodies lose no digits
    vsc_pack_corners(model, patch, node + c, 1, nodes, &x);
    const vsc_wide3 way = vsc_wide_minus(x, first);
    for (int i = 0; i < 3; i++)
      h[i] = vsc_wide_add(h[i], vsc_wide_scale(vsc_splat(model->rules[patch->family].D[q][i][c]), way));
  }
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(frame->T[a][0], h[0], frame->T[a][1], h[1], frame->T[a][2], h[2]);
}

// det G
VSC_INLINE vsc_wide vsc_pack_ratio(const vsc_wide3 g[3])
{
  return vsc_wide_dot(g[0], vsc_wide_cross(g[1], g[2]));
}

// The passive springs of a pack as moduli, and the fibre's at full activation. Law PAPER's constants
// become what they weigh in this element: E_a = k r_a^2 / V, G_ab = k (r_a + r_b) / 2V.
typedef struct vsc_pack_law {
  vsc_springs springs;
  vsc_wide damping[3];     // kPa ms
  vsc_wide coupling[3];    // kPa
  vsc_wide viscosity;      // kPa ms
  vsc_wide active_axial;   // kPa
  vsc_wide others;         // what inclusions add to the fibre's modulus, kPa
  vsc_wide volume_modulus, stabilization, element_modulus;
  vsc_wide share;  // of the own material: 1 without inclusions
} vsc_pack_law;

// Of a material without inclusions.
vsc_pack_law vsc_material_law(const vsc_material *material);

// Not inlined: called once for a pack.
vsc_pack_law vsc_pack_law_of(const vsc_model *model, const vsc_patch *patch, size_t k);

// Activation of pack `k` of a patch at this time.
VSC_INLINE vsc_wide vsc_pack_activation(const vsc_model *model, const vsc_material *material, size_t k, double time)
{
  vsc_wide a = vsc_splat(vsc_model_activation(model, material, VSC_WIDTH * k, time));
  for (size_t l = 1; (model->amplitude != NULL || model->delay != NULL) && l < VSC_WIDTH; l++)
    a[l] = vsc_model_activation(model, material, VSC_WIDTH * k + l, time);
  return a;
}

// Active tension of four frames of the given law with axes g at activation `a`, kPa: T, or what the active spring
// adds to the passive one, E_f(t) (|g_f| - r(t)) - E_f (|g_f| - 1). Along `way` it works:
// T d(E_ff + k_s E_ss + k_n E_nn), or that force d|g_f|; per volume at rest.
VSC_INLINE vsc_wide vsc_active_tension(const vsc_material *material, const vsc_pack_law *law, vsc_wide a,
                                       const vsc_wide3 g[3], vsc_wide *way)
{
  const vsc_wide square = vsc_wide_dot(g[0], g[0]), stretch = vsc_wide_sqrt(square);
  if (material->active == VSC_ACTIVE_TENSION) {
    const double *part = material->tension_parts;
    *way = 0.5 * (square - 1 + part[0] * (vsc_wide_dot(g[1], g[1]) - 1) + part[1] * (vsc_wide_dot(g[2], g[2]) - 1));
    return law->share * vsc_tension_of(material, a, stretch);
  }
  const vsc_wide passive = law->springs.axial[0], E = passive + a * (law->active_axial - passive);
  *way = stretch;
  const vsc_wide rest = vsc_shared_rest(a * (1 - material->rest_stretch), E, law->others);
  return E * (stretch - rest) - passive * (stretch - 1);
}

#endif
