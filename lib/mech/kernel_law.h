// SPDX-License-Identifier: GPL-3.0-or-later
// The stress of any law that is a function of strain (model/law.h); the force of cells with several frames,
// under such a law or under law SPRINGS. Internal to mech; included by kernel_cells.h.
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

VSC_INLINE vsc_law_input law_input_of(const vsc_patch_work *work, size_t k)
{
  return (vsc_law_input){.material = work->material,
                         .axes = work->axes,
                         .pairs = work->pairs,
                         .moduli = moduli_of(work, k, true),
                         .activation = activation_of(work, k)};
}

// The same of pack k from that of another pack.
VSC_INLINE void law_input_next(const vsc_patch_work *work, size_t k, vsc_law_input *in)
{
  if (work->mixtures != NULL) in->moduli = moduli_of(work, k, true);
  in->activation = activation_of(work, k);
}

// The pressure that all frames of a cell share: U' of their mean volume ratio and what a multiplier
// adds. The axes of all frames come back in g, their lengths where they are asked for.
VSC_INLINE vsc_wide common_pressure(const vsc_patch_work *work, size_t k, const opened_pack *pack,
                                    int points, const vsc_mixture *moduli, vsc_wide3 (*g)[3],
                                    vsc_axis_lengths *lengths)
{
  vsc_wide whole;
  const vsc_wide J = mean_ratio(pack, points, pack->h, g, lengths, &whole);
  return vsc_volume_stress(moduli->volume_modulus, J) + multiplier_of(work, k);
}

// P_a of one frame: the law and viscosity.
VSC_INLINE void law_frame(const vsc_law_input *in, const vsc_wide3 g[3], const vsc_wide3 *rate, vsc_wide3 P[3])
{
  vsc_wide e[6], S[6], speed[6];
  vsc_strain_of(g, e);
  law_stress(in, e, S);
  if (rate != NULL) {
    vsc_strain_rate(g, rate, speed);
    vsc_law_add_viscous_stress(in->material, &in->moduli, in->axes, e, speed, S);
  }
  vsc_stress_on_axes(S, g, P);
}

// The pressure of a frame's own volume ratio: U' of a modulus, and what keeps the law free of stress at rest.
VSC_INLINE vsc_wide law_pressure(const vsc_material *material, vsc_wide modulus, vsc_wide J)
{
  return vsc_volume_stress(modulus, J) + vsc_rest_stress(vsc_splat(material->rest_shear), J);
}

// `general`: any law of strain; else law SPRINGS with none of its further features.
VSC_INLINE void cell_kernel(const vsc_patch_work *work, int corners, int points, bool damping,
                            bool general)
{
  vsc_law_input in = law_input_of(work, 0);
  for (size_t k = 0; k < work->pack_count; k += PACKS) {
    opened_pack pack;
    vsc_wide3 f[VSC_MOST_CORNERS], g[VSC_MOST_POINTS][3];
    vsc_axis_lengths lengths[VSC_MOST_POINTS];
    open_pack(work, k, corners, points, damping, &pack);
    law_input_next(work, k, &in);
    const vsc_wide pressure = common_pressure(work, k, &pack, points, &in.moduli, g, general ? NULL : lengths);
    for (int q = 0; q < points; q++) {
      const frame_numbers frame = frame_of(&pack.frames[q], pack.other);
      vsc_wide3 rate[3], P[3], cofactor[3];
      if (damping) solid_axes(&frame, pack.speed[q], rate);
      const vsc_wide J = cofactor_of(g[q], cofactor);
      if (general)
        law_frame(&in, g[q], damping ? rate : NULL, P);
      else
        solid_stress(work, k, &in.moduli, g[q], &lengths[q], rate, damping, P);
      const vsc_wide own = general ? law_pressure(in.material, in.moduli.stabilization, J)
                                   : vsc_volume_stress(in.moduli.stabilization, J);
      add_pressure(pressure + own, cofactor, P);
      solid_flux(&frame, P, pack.h[q]);
    }
    solid_back(work->rule, corners, points, pack.h, f);
    scatter_corners(pack.node, pack.other, corners, f, work->f);
  }
}

#define CELL_KERNELS(name, corners, points, general)                    \
  static void name(const vsc_patch_work *work)                          \
  {                                                                     \
    cell_kernel(work, corners, points, false, general);                 \
  }                                                                     \
  static void damped_##name(const vsc_patch_work *work)                 \
  {                                                                     \
    cell_kernel(work, corners, points, true, general);                  \
  }
CELL_KERNELS(springs_hexes, 8, 8, false)
CELL_KERNELS(springs_wedges, 6, 6, false)
CELL_KERNELS(springs_pyramids, 5, 8, false)
CELL_KERNELS(springs_tets10, 10, 4, false)
CELL_KERNELS(law_hexes, 8, 8, true)
CELL_KERNELS(law_wedges, 6, 6, true)
CELL_KERNELS(law_pyramids, 5, 8, true)
CELL_KERNELS(law_tets10, 10, 4, true)

#endif
