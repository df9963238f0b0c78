// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes: the force of four triangles in their planes, and of four bends. Internal to mech;
// included by the source file of each instruction set.
#ifndef VSC_MECH_KERNEL_SURFACE_H
#define VSC_MECH_KERNEL_SURFACE_H

#include "mech/kernel_common.h"

// g_a = sum_k T_ak (x_k - x_0)
VSC_INLINE void triangle_axes(const vsc_triangle_pack *pack, const double *nodes, vsc_wide3 g[2])
{
  const vsc_wide3 first = gather_corner(corner_of(pack->node[0], 0), nodes);
  const vsc_wide3 h[2] = {vsc_wide_minus(gather_corner(corner_of(pack->node[1], 0), nodes), first),
                          vsc_wide_minus(gather_corner(corner_of(pack->node[2], 0), nodes), first)};
  for (int a = 0; a < 2; a++)
    g[a] = vsc_wide_add(vsc_wide_scale(pack->T[a][0], h[0]), vsc_wide_scale(pack->T[a][1], h[1]));
}

// f_k = -V sum_a P_a T_ak, f_0 = -(f_1 + f_2)
VSC_INLINE void triangle_kernel(const vsc_patch_work *work, bool damping)
{
  const vsc_triangle_pack *packs = work->packs;
  const vsc_membrane *membrane = work->membrane;
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_triangle_pack *pack = &packs[k];
    vsc_wide3 g[2], P[2], f[3] = {wide_zero()};
    vsc_wide along[2] = {vsc_splat(0), vsc_splat(0)};
    triangle_axes(pack, work->x, g);
    const vsc_sheet_axes axes = vsc_sheet_axes_of(g);
    if (damping) {
      vsc_wide3 rate[2];
      triangle_axes(pack, work->w, rate);
      for (int a = 0; a < 2; a++)
        along[a] = membrane->damping[a] * vsc_wide_dot(rate[a], axes.u[a]);
    }
    vsc_sheet_stress(&membrane->moduli, &axes, along, P);
    for (int i = 0; i < 2; i++) {
      f[i + 1] = vsc_wide_add(vsc_wide_scale(-pack->V * pack->T[0][i], P[0]),
                              vsc_wide_scale(-pack->V * pack->T[1][i], P[1]));
      f[0] = vsc_wide_minus(f[0], f[i + 1]);
    }
    for (int i = 0; i < 3; i++) scatter_corner(pack->node[i], f[i], work->f);
  }
}

static void force_triangles(const vsc_patch_work *work)
{
  triangle_kernel(work, false);
}

static void force_damped_triangles(const vsc_patch_work *work)
{
  triangle_kernel(work, true);
}

VSC_INLINE void bend_kernel(const vsc_patch_work *work, bool damping)
{
  const vsc_bend_pack *packs = work->packs;
  for (size_t k = 0; k < work->pack_count; k++) {
    vsc_wide3 x[VSC_BEND_NODES], f[VSC_BEND_NODES];
    vsc_fold folds[VSC_BEND_FOLDS];
    for (int i = 0; i < VSC_BEND_NODES; i++) x[i] = gather_corner(corner_of(packs[k].node[i], 0), work->x);
    vsc_bend_folds(x, folds);
    vsc_wide lead[VSC_BEND_FOLDS] = {vsc_splat(0)};
    if (damping) {
      for (int i = 0; i < VSC_BEND_NODES; i++) x[i] = gather_corner(corner_of(packs[k].node[i], 0), work->w);
      vsc_bend_rates(folds, x, lead);
      for (int j = 0; j < VSC_BEND_FOLDS; j++) lead[j] *= work->membrane->lag;
    }
    vsc_bend_forces(&packs[k].bends, folds, lead, f);
    for (int i = 0; i < VSC_BEND_NODES; i++) scatter_corner(packs[k].node[i], f[i], work->f);
  }
}

static void force_bends(const vsc_patch_work *work)
{
  bend_kernel(work, false);
}

static void force_damped_bends(const vsc_patch_work *work)
{
  bend_kernel(work, true);
}

#endif
