// SPDX-License-Identifier: GPL-3.0-or-later
// Hexahedra, wedges and pyramids under law SPRINGS: several frames that share one volume ratio and
// one pressure (mean dilatation). Internal to mech; included by kernel_body.h.
#ifndef VSC_MECH_KERNEL_SOLID_H
#define VSC_MECH_KERNEL_SOLID_H

#include "mech/kernel_common.h"

// g_a = sum_k T_ak h_k,  h_k = sum_i D_ki x_i
VSC_INLINE void solid_axes(const vsc_frame *frame, const double D[3][VSC_MOST_CORNERS], int corners,
                           const vsc_wide3 *x, vsc_wide3 g[3])
{
  vsc_wide3 h[3];
  for (int k = 0; k < 3; k++) {
    h[k] = vsc_wide_scale(vsc_splat(D[k][0]), x[0]);
    for (int c = 1; c < corners; c++)
      h[k] = vsc_wide_add(h[k], vsc_wide_scale(vsc_splat(D[k][c]), x[c]));
  }
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(frame->T[a][0], h[0], frame->T[a][1], h[1], frame->T[a][2], h[2]);
}

// f_i -= sum_k D_ki V sum_a P_a T_ak
VSC_INLINE void add_solid_forces(const vsc_frame *frame, const double D[3][VSC_MOST_CORNERS],
                                 int corners, const vsc_wide3 P[3], vsc_wide3 *f)
{
  for (int k = 0; k < 3; k++) {
    const vsc_wide3 q = vsc_wide_scale(
        -frame->V, vsc_wide_combine(frame->T[0][k], P[0], frame->T[1][k], P[1], frame->T[2][k], P[2]));
    for (int c = 0; c < corners; c++)
      f[c] = vsc_wide_add(f[c], vsc_wide_scale(vsc_splat(D[k][c]), q));
  }
}

// U'(J) of the element: J = sum_q V_q det G_q / sum_q V_q. The axes of all frames come back in g.
VSC_INLINE vsc_wide shared_pressure(const vsc_patch_work *work, const vsc_frame *frames, int corners,
                                    int points, vsc_wide modulus, const vsc_wide3 *x,
                                    vsc_wide3 (*g)[3])
{
  vsc_wide volume = vsc_splat(0), rest = vsc_splat(0);
  for (int q = 0; q < points; q++) {
    vsc_wide3 cofactor[3];
    solid_axes(&frames[q], work->rule->D[q], corners, x, g[q]);
    volume += frames[q].V * cofactor_of(g[q], cofactor);
    rest += frames[q].V;
  }
  // an empty place has no volume
  const vsc_wide_mask full = rest > 0;
  const vsc_wide J = vsc_select(full, volume, vsc_splat(1)) / vsc_select(full, rest, vsc_splat(1));
  return vsc_volume_stress(modulus, J);
}

// P_a of one frame: springs, damping, activity, further axes, and the volume's pressure.
VSC_INLINE void solid_stress(const vsc_patch_work *work, size_t k, const pack_moduli *moduli,
                             const vsc_wide3 g[3], const vsc_wide3 rate[3], bool damping,
                             vsc_wide pressure, vsc_wide3 P[3])
{
  const vsc_material *material = work->material;
  const vsc_frame_axes axes = vsc_frame_of(g);
  vsc_wide along[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  for (int a = 0; damping && a < 3; a++)
    along[a] = moduli->damping[a] * vsc_wide_dot(rate[a], axes.u[a]);
  const vsc_wide activation = work->activation[k * work->activation_stride];
  const vsc_springs law = springs_of(material, moduli, material->active, activation);
  if (material->active == VSC_ACTIVE_TENSION)
    along[0] += moduli->share * activation * material->tension * axes.length[0];
  vsc_springs_stress(&law, &axes, along, P);
  add_more_axes(work, moduli->share, g, rate, damping, P);
  vsc_wide3 cofactor[3];
  const vsc_wide J = cofactor_of(g, cofactor);
  const vsc_wide p = pressure + vsc_volume_stress(moduli->stabilization, J);
  for (int a = 0; a < 3; a++) P[a] = vsc_wide_add(P[a], vsc_wide_scale(p, cofactor[a]));
}

VSC_INLINE void solid_kernel(const vsc_patch_work *work, int corners, int points, bool damping)
{
  const size_t bytes = vsc_pack_bytes(corners, points);
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_frame *frames = (const vsc_frame *)((const char *)work->packs + k * bytes);
    const uint16_t(*node)[VSC_WIDTH] = (const uint16_t(*)[VSC_WIDTH])(frames + points);
    const pack_moduli moduli = moduli_of(work, k, true);
    vsc_wide3 x[VSC_MOST_CORNERS], w[VSC_MOST_CORNERS], f[VSC_MOST_CORNERS];
    vsc_wide3 g[VSC_MOST_POINTS][3];
    for (int c = 0; c < corners; c++) {
      x[c] = gather_corner(node[c], work->x);
      if (damping) w[c] = gather_corner(node[c], work->w);
      f[c] = wide_zero();
    }
    const vsc_wide pressure =
        shared_pressure(work, frames, corners, points, moduli.volume, x, g);
    for (int q = 0; q < points; q++) {
      vsc_wide3 rate[3] = {wide_zero(), wide_zero(), wide_zero()}, P[3];
      if (damping) solid_axes(&frames[q], work->rule->D[q], corners, w, rate);
      solid_stress(work, k, &moduli, g[q], rate, damping, pressure, P);
      add_solid_forces(&frames[q], work->rule->D[q], corners, P, f);
    }
    for (int c = 0; c < corners; c++) scatter_corner(node[c], f[c], work->f);
  }
}

#define SOLID_KERNELS(name, corners, points)                                                       \
  static void force_##name(const vsc_patch_work *work) { solid_kernel(work, corners, points, 0); } \
  static void force_damped_##name(const vsc_patch_work *work)                                      \
  {                                                                                                \
    solid_kernel(work, corners, points, 1);                                                        \
  }
SOLID_KERNELS(hexes, 8, 8)
SOLID_KERNELS(wedges, 6, 6)
SOLID_KERNELS(pyramids, 5, 8)

#endif
