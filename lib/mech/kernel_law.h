// SPDX-License-Identifier: GPL-3.0-or-later
// Cells of any kind under any law that is a function of strain (model/law.h): what the springs' own
// kernels do not know. Internal to mech; included by kernel_body.h.
#ifndef VSC_MECH_KERNEL_LAW_H
#define VSC_MECH_KERNEL_LAW_H

#include "mech/kernel_common.h"
#include "mech/kernel_solid.h"
#include "model/law.h"
#include "model/law_viscous.h"

// S of four frames at strain e. Not inlined: there is one copy of the laws for all kinds of cells.
static __attribute__((noinline)) void law_stress(const vsc_law_input *in, const vsc_wide e[6],
                                                 vsc_wide S[6])
{
  vsc_law_answer answer;
  vsc_law_evaluate(in, e, VSC_LAW_STRESS, &answer);
  for (int k = 0; k < 6; k++) S[k] = answer.S[k];
}

// The pressure that all frames of four cells share: U' of their mean volume ratio; of tets that share
// their volume with others the mean of their nodes'. The axes of all frames come back in g.
VSC_INLINE vsc_wide common_pressure(const vsc_patch_work *work, const vsc_frame *frames,
                                    const uint16_t (*node)[VSC_WIDTH], int corners, int points,
                                    const vsc_mixture *moduli, vsc_wide3 (*h)[3],
                                    vsc_wide3 (*g)[3])
{
  if (corners != 4) return shared_pressure(frames, points, moduli->volume_modulus, h, g);
  vsc_wide pressure = vsc_splat(0);
  solid_axes(&frames[0], h[0], g[0]);
  for (int c = 0; c < 4 && work->shares_volume; c++)
    for (int l = 0; l < VSC_WIDTH; l++) pressure[l] += 0.25 * work->pressure[node[c][l]];
  return pressure;
}

// P_a of one frame: the law, viscosity, and the volume's pressure p cof_a.
VSC_INLINE void law_frame(const vsc_law_input *in, const vsc_wide3 g[3], const vsc_wide3 *rate,
                          vsc_wide pressure, vsc_wide own_modulus, vsc_wide3 P[3])
{
  vsc_wide e[6], S[6], speed[6];
  vsc_strain_of(g, e);
  law_stress(in, e, S);
  if (rate != NULL) {
    vsc_strain_rate(g, rate, speed);
    vsc_law_add_viscous_stress(in->material, &in->moduli, in->axes, e, speed, S);
  }
  vsc_stress_on_axes(S, g, P);
  vsc_wide3 cofactor[3];
  const vsc_wide J = cofactor_of(g, cofactor);
  const vsc_wide p = pressure + vsc_volume_stress(own_modulus, J) +
                     vsc_rest_stress(vsc_splat(in->material->rest_shear), J);
  for (int a = 0; a < 3; a++) P[a] = vsc_wide_add(P[a], vsc_wide_scale(p, cofactor[a]));
}

VSC_INLINE void law_kernel(const vsc_patch_work *work, int corners, int points, bool damping)
{
  const size_t bytes = vsc_pack_bytes(corners, points);
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_frame *frames = (const vsc_frame *)((const char *)work->packs + k * bytes);
    const uint16_t(*node)[VSC_WIDTH] = (const uint16_t(*)[VSC_WIDTH])(frames + points);
    const vsc_law_input in = {.material = work->material,
                              .axes = work->axes,
                              .pairs = work->pairs,
                              .moduli = moduli_of(work, k, true),
                              .activation = work->activation[k * work->activation_stride]};
    vsc_wide3 x[VSC_MOST_CORNERS], f[VSC_MOST_CORNERS];
    vsc_wide3 h[VSC_MOST_POINTS][3], speed[VSC_MOST_POINTS][3], g[VSC_MOST_POINTS][3];
    for (int c = 0; c < corners; c++) x[c] = gather_corner(node[c], work->x);
    derivatives(work->rule, corners, points, x, h);
    if (damping) {
      for (int c = 0; c < corners; c++) x[c] = gather_corner(node[c], work->w);
      derivatives(work->rule, corners, points, x, speed);
    }
    const vsc_wide pressure =
        common_pressure(work, frames, node, corners, points, &in.moduli, h, g) +
        multiplier_of(work, k);
    const vsc_wide own = corners == 4 ? in.moduli.element_modulus : in.moduli.stabilization;
    for (int q = 0; q < points; q++) {
      vsc_wide3 rate[3], P[3];
      if (damping) solid_axes(&frames[q], speed[q], rate);
      law_frame(&in, g[q], damping ? rate : NULL, pressure, own, P);
      solid_flux(&frames[q], P, h[q]);
    }
    solid_back(work->rule, corners, points, h, f);
    for (int c = 0; c < corners; c++) scatter_corner(node[c], f[c], work->f);
  }
}

#define LAW_KERNELS(name, corners, points)                                                      \
  static void law_##name(const vsc_patch_work *work) { law_kernel(work, corners, points, 0); }  \
  static void law_damped_##name(const vsc_patch_work *work)                                     \
  {                                                                                             \
    law_kernel(work, corners, points, 1);                                                       \
  }
LAW_KERNELS(tets, 4, 1)
LAW_KERNELS(hexes, 8, 8)
LAW_KERNELS(wedges, 6, 6)
LAW_KERNELS(pyramids, 5, 8)
LAW_KERNELS(tets10, 10, 4)

#endif
