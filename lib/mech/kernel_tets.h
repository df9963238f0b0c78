// SPDX-License-Identifier: GPL-3.0-or-later
// Linear tets under law SPRINGS. Internal to mech; included by kernel_body.h.
#ifndef VSC_MECH_KERNEL_TETS_H
#define VSC_MECH_KERNEL_TETS_H

#include "mech/kernel_common.h"

// Packs that go through each stage together. One pack is a chain of some 170 cycles (gather, roots,
// a division, scatter) of 590 instructions, more than a processor looks ahead: stage by stage,
// packs overlap.
enum { TOGETHER = 8, CACHE_LINE = 64 };

// The processor fetches a pack ahead of its use: its own prediction stops where a stage ends.
VSC_INLINE void fetch_pack(const vsc_pack *pack)
{
  for (size_t byte = 0; byte < sizeof *pack; byte += CACHE_LINE)
    __builtin_prefetch((const char *)pack + byte);
}

// Edges x_i - x_0 of four tets, i = 1, 2, 3, from node x 4 numbers.
VSC_INLINE void gather_edges(const vsc_pack *pack, const double *nodes, vsc_wide3 edge[3])
{
  vsc_wide first[VSC_WIDTH];
  for (int l = 0; l < VSC_WIDTH; l++) first[l] = *(const vsc_wide *)(nodes + 4 * pack->node[0][l]);
  for (int i = 0; i < 3; i++) {
    vsc_wide d[VSC_WIDTH];
    for (int l = 0; l < VSC_WIDTH; l++)
      d[l] = *(const vsc_wide *)(nodes + 4 * pack->node[i + 1][l]) - first[l];
    vsc_transpose(&d[0], &d[1], &d[2], &d[3]);
    edge[i] = (vsc_wide3){d[0], d[1], d[2]};
  }
}

// g_a = sum_i B_ai (x_i - x_0)
VSC_INLINE void frame_axes(const vsc_pack *pack, const vsc_wide3 edge[3], vsc_wide3 g[3])
{
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(pack->B[a][0], edge[0], pack->B[a][1], edge[1], pack->B[a][2], edge[2]);
}

// f_i = -V sum_a P_a B_ai, added to the nodes; f_0 = -(f_1 + f_2 + f_3)
VSC_INLINE void scatter_forces(const vsc_pack *pack, vsc_wide3 P[3], double *forces)
{
  vsc_wide f[3][VSC_WIDTH];
  for (int a = 0; a < 3; a++) P[a] = vsc_wide_scale(-pack->V, P[a]);
  for (int i = 0; i < 3; i++) {
    const vsc_wide3 on_corner =
        vsc_wide_combine(pack->B[0][i], P[0], pack->B[1][i], P[1], pack->B[2][i], P[2]);
    f[i][0] = on_corner.x;
    f[i][1] = on_corner.y;
    f[i][2] = on_corner.z;
    f[i][3] = vsc_splat(0);
    vsc_transpose(&f[i][0], &f[i][1], &f[i][2], &f[i][3]);
  }
  for (int l = 0; l < VSC_WIDTH; l++) {
    *(vsc_wide *)(forces + 4 * pack->node[0][l]) -= f[0][l] + f[1][l] + f[2][l];
    for (int i = 0; i < 3; i++) *(vsc_wide *)(forces + 4 * pack->node[i + 1][l]) += f[i][l];
  }
}

// The mean of the four nodes' pressures.
VSC_INLINE vsc_wide mean_pressure(const vsc_pack *pack, const double *pressure)
{
  vsc_wide sum = vsc_splat(0);
  for (int c = 0; c < 4; c++) {
    const uint16_t *n = pack->node[c];
    sum += (vsc_wide){pressure[n[0]], pressure[n[1]], pressure[n[2]], pressure[n[3]]};
  }
  return 0.25 * sum;
}

// P_a += p cof_a,  cof(G) = [g_s x g_n | g_n x g_f | g_f x g_s],  p = U'(J) of the tet + mean of
// its nodes'
VSC_INLINE void add_volume_stress(const vsc_pack *pack, vsc_wide modulus, const double *pressure,
                                  const vsc_wide3 g[3], bool nodal, vsc_wide3 P[3])
{
  vsc_wide3 cofactor[3];
  const vsc_wide J = cofactor_of(g, cofactor);
  vsc_wide p = vsc_volume_stress(modulus, J);
  if (nodal) p += mean_pressure(pack, pressure);
  for (int a = 0; a < 3; a++) P[a] = vsc_wide_add(P[a], vsc_wide_scale(p, cofactor[a]));
}

// P_a of pack k from its axes and their rates.
VSC_INLINE void pack_stress(const vsc_patch_work *work, size_t k, const vsc_wide3 g[3],
                            const vsc_wide3 rate[3], bool composed, bool damping,
                            vsc_active_kind active, bool nodal, vsc_wide3 P[3])
{
  const vsc_pack *pack = (const vsc_pack *)work->packs + k;
  const vsc_mixture moduli = moduli_of(work, k, composed);
  const vsc_frame_axes frame = vsc_frame_of(g);
  vsc_wide along[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  // eta_a dg_a/dt . u_a
  for (int a = 0; damping && a < 3; a++)
    along[a] = moduli.damping[a] * vsc_wide_dot(rate[a], frame.u[a]);
  vsc_wide activation = vsc_splat(0);
  if (active != VSC_ACTIVE_NONE) activation = work->activation[k * work->activation_stride];
  const vsc_springs law = springs_of(work->material, &moduli, active, activation);
  // S += T f0 f0: P_f += T g_f
  if (active == VSC_ACTIVE_TENSION)
    along[0] += moduli.share * activation * work->material->tension * frame.length[0];
  vsc_springs_stress(&law, &frame, along, P);
  if (composed) add_more_axes(work, moduli.share, g, rate, damping, P);
  add_volume_stress(pack, moduli.element_modulus, work->pressure, g, nodal, P);
}

VSC_INLINE void force_kernel(const vsc_patch_work *work, bool composed, bool damping,
                             vsc_active_kind active, bool nodal)
{
  vsc_wide3 edge[3], g[TOGETHER][3], rate[TOGETHER][3], P[TOGETHER][3];
  for (size_t first = 0; first < work->pack_count; first += TOGETHER) {
    const vsc_pack *packs = (const vsc_pack *)work->packs + first;
    const size_t left = work->pack_count - first, count = left < TOGETHER ? left : TOGETHER;
    for (size_t k = 0; k < count; k++) {
      gather_edges(&packs[k], work->x, edge);
      frame_axes(&packs[k], edge, g[k]);
    }
    for (size_t k = 0; damping && k < count; k++) {
      gather_edges(&packs[k], work->w, edge);
      frame_axes(&packs[k], edge, rate[k]);
    }
    for (size_t k = 0; k < count; k++) {
      fetch_pack(&packs[k + TOGETHER]);
      pack_stress(work, first + k, g[k], rate[k], composed, damping, active, nodal, P[k]);
    }
    for (size_t k = 0; k < count; k++) scatter_forces(&packs[k], P[k], work->f);
  }
}

static void volume_kernel(const vsc_patch_work *work)
{
  const vsc_pack *packs = work->packs;
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_pack *pack = &packs[k];
    vsc_wide3 edge[3];
    gather_edges(pack, work->x, edge);
    // an element's volume is (e_1 x e_2) . e_3 / 6, a quarter of which goes to each node
    const vsc_wide quarter = vsc_wide_dot(vsc_wide_cross(edge[0], edge[1]), edge[2]) * (1.0 / 24);
    for (int c = 0; c < 4; c++)
      for (int l = 0; l < VSC_WIDTH; l++) work->volume[pack->node[c][l]] += quarter[l];
  }
}

#endif
