// SPDX-License-Identifier: GPL-3.0-or-later
// Linear tets, under law SPRINGS or any law of strain. Internal to mech; included by kernel_cells.h.
#ifndef VSC_MECH_KERNEL_TETS_H
#define VSC_MECH_KERNEL_TETS_H

#include "mech/kernel_law.h"

// Turns of packs that go through each stage together. One pack is a chain of some 250 cycles (gather, roots,
// divisions, stress, scatter) of 600 instructions, more than a processor looks ahead: stage by stage,
// packs overlap. Roots and divisions are at the end of the first stage, where gathering the next pack fills
// the wait for them.
enum { TOGETHER = 8 / PACKS, CACHE_LINE = 64 };

// The processor fetches packs ahead of its use: its own prediction stops where a stage ends.
VSC_INLINE void fetch_packs(const vsc_pack *pack)
{
  for (size_t byte = 0; byte < PACKS * sizeof *pack; byte += CACHE_LINE)
    __builtin_prefetch((const char *)pack + byte);
}

// Edges x_i - x_0 of the tets of a pack and of the one `other` behind it, i = 1, 2, 3, from node x 4 numbers.
VSC_INLINE void gather_edges(const vsc_pack *pack, size_t other, const double *nodes, vsc_wide3 edge[3])
{
  vsc_wide first[VSC_WIDTH];
  const corner_nodes base = corner_of(pack->node[0], other * sizeof *pack);
  for (int l = 0; l < VSC_WIDTH; l++) first[l] = node_rows(nodes, &base, l);
  for (int i = 0; i < 3; i++) {
    vsc_wide d[VSC_WIDTH];
    const corner_nodes corner = corner_of(pack->node[i + 1], other * sizeof *pack);
    for (int l = 0; l < VSC_WIDTH; l++) d[l] = node_rows(nodes, &corner, l) - first[l];
    vsc_transpose(&d[0], &d[1], &d[2], &d[3]);
    edge[i] = (vsc_wide3){d[0], d[1], d[2]};
  }
}

// g_a = sum_i B_ai (x_i - x_0)
VSC_INLINE void frame_axes(const vsc_pack *pack, size_t other, const vsc_wide3 edge[3], vsc_wide3 g[3])
{
  const size_t bytes = other * sizeof *pack;
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(joined(&pack->B[a][0], bytes), edge[0], joined(&pack->B[a][1], bytes),
                            edge[1], joined(&pack->B[a][2], bytes), edge[2]);
}

// f_i = -V sum_a P_a B_ai, added to the nodes; f_0 = -(f_1 + f_2 + f_3)
VSC_INLINE void scatter_forces(const vsc_pack *pack, size_t other, vsc_wide3 P[3], double *forces)
{
  const size_t bytes = other * sizeof *pack;
  vsc_wide f[3][VSC_WIDTH], on_first[VSC_WIDTH];
  for (int a = 0; a < 3; a++) P[a] = vsc_wide_scale(-joined(&pack->V, bytes), P[a]);
  for (int i = 0; i < 3; i++) {
    const vsc_wide3 on_corner =
        vsc_wide_combine(joined(&pack->B[0][i], bytes), P[0], joined(&pack->B[1][i], bytes), P[1],
                         joined(&pack->B[2][i], bytes), P[2]);
    vsc_wide_rows(on_corner, f[i]);
  }
  for (int l = 0; l < VSC_WIDTH; l++) on_first[l] = f[0][l] + f[1][l] + f[2][l];
  for (size_t p = 0; p <= other; p++)
    for (int l = 0; l < VSC_WIDTH; l++) {
      const uint16_t(*node)[VSC_WIDTH] = pack[p].node;
      *(vsc_four *)(forces + place_of(node[0][l])) -= vsc_part(on_first[l], (int)p);
      for (int i = 0; i < 3; i++)
        *(vsc_four *)(forces + place_of(node[i + 1][l])) += vsc_part(f[i][l], (int)p);
    }
}

// The mean of the four nodes' pressures.
VSC_INLINE vsc_wide mean_pressure(const vsc_pack *pack, size_t other, const double *pressure)
{
  vsc_wide sum = vsc_splat(0);
  for (int c = 0; c < 4; c++) sum += node_numbers(pressure, corner_of(pack->node[c], other * sizeof *pack));
  return 0.25 * sum;
}

// A pack (and the one behind it) deformed: what roots and divisions are taken of.
typedef struct pack_shape {
  vsc_wide3 g[3], cofactor[3];
  vsc_axis_lengths lengths;
  vsc_wide pressure;  // of the tet itself, by its J
} pack_shape;

VSC_INLINE void measure_shape(const vsc_patch_work *work, size_t k, bool general, bool composed, pack_shape *shape)
{
  const vsc_wide modulus = moduli_of(work, k, composed).element_modulus;
  if (!general) shape->lengths = vsc_lengths_of(shape->g);
  const vsc_wide J = cofactor_of(shape->g, shape->cofactor);
  shape->pressure = general ? law_pressure(work->material, modulus, J) : vsc_volume_stress(modulus, J);
}

// The pressure of pack k (and the one behind it) and, where they share their volume, of its nodes.
VSC_INLINE void add_volume(const vsc_patch_work *work, size_t k, bool nodal, const pack_shape *shape, vsc_wide3 P[3])
{
  vsc_wide p = shape->pressure;
  if (nodal) p += mean_pressure((const vsc_pack *)work->packs + k, other_pack(work, k), work->pressure);
  add_pressure(p, shape->cofactor, P);
}

// P_a of pack k (and the one behind it) from its shape and the rates of its axes.
VSC_INLINE void pack_stress(const vsc_patch_work *work, size_t k, const pack_shape *shape,
                            const vsc_wide3 rate[3], vsc_frame_springs springs, bool damping,
                            vsc_active_kind active, bool nodal, vsc_wide3 P[3])
{
  const bool composed = springs == VSC_COMPOSED;
  const vsc_mixture moduli = moduli_of(work, k, composed);
  const vsc_frame_axes frame = vsc_frame_of_lengths(shape->g, &shape->lengths);
  vsc_wide along[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  // eta_a dg_a/dt . u_a
  for (int a = 0; damping && a < 3; a++)
    along[a] = moduli.damping[a] * vsc_wide_dot(rate[a], frame.u[a]);
  vsc_wide activation = vsc_splat(0);
  if (active != VSC_ACTIVE_NONE) activation = activation_of(work, k);
  const vsc_springs law = springs_of(work->material, &moduli, composed, active, activation);
  // S += T f0 f0: P_f += T g_f
  if (active == VSC_ACTIVE_TENSION)
    along[0] += moduli.share * activation * work->material->tension * frame.length[0];
  vsc_springs_stress(&law, &frame, along, springs != VSC_AXIAL, P);
  if (composed) add_more_axes(work, moduli.share, shape->g, rate, damping, P);
  add_volume(work, k, nodal, shape, P);
}

VSC_INLINE void gather_axes(const vsc_patch_work *work, size_t k, const double *nodes, vsc_wide3 g[3])
{
  const vsc_pack *pack = (const vsc_pack *)work->packs + k;
  vsc_wide3 edge[3];
  gather_edges(pack, other_pack(work, k), nodes, edge);
  frame_axes(pack, other_pack(work, k), edge, g);
}

// The same under any law of strain, of which `in` is what the pack before had.
VSC_INLINE void pack_law_stress(const vsc_patch_work *work, size_t k, const pack_shape *shape,
                                const vsc_wide3 rate[3], bool damping, vsc_law_input *in, vsc_wide3 P[3])
{
  law_input_next(work, k, in);
  law_frame(in, shape->g, damping ? rate : NULL, P);
  add_volume(work, k, work->shares_volume, shape, P);
}

// `general`: any law of strain; else law SPRINGS with what follows.
VSC_INLINE void force_kernel(const vsc_patch_work *work, bool general, vsc_frame_springs springs, bool damping,
                             vsc_active_kind active, bool nodal)
{
  pack_shape shape[TOGETHER];
  vsc_wide3 rate[TOGETHER][3], P[TOGETHER][3];
  vsc_law_input in;
  if (general) in = law_input_of(work, 0);
  const vsc_pack *packs = work->packs;
  for (size_t first = 0; first < work->pack_count; first += TOGETHER * PACKS) {
    const size_t left = (work->pack_count - first + PACKS - 1) / PACKS;
    const size_t count = left < TOGETHER ? left : TOGETHER;
    for (size_t t = 0; t < count; t++) {
      gather_axes(work, first + PACKS * t, work->x, shape[t].g);
      measure_shape(work, first + PACKS * t, general, springs == VSC_COMPOSED, &shape[t]);
    }
    for (size_t t = 0; damping && t < count; t++) gather_axes(work, first + PACKS * t, work->w, rate[t]);
    for (size_t t = 0; t < count; t++) {
      fetch_packs(&packs[first + PACKS * (t + TOGETHER)]);
      if (general)
        pack_law_stress(work, first + PACKS * t, &shape[t], rate[t], damping, &in, P[t]);
      else
        pack_stress(work, first + PACKS * t, &shape[t], rate[t], springs, damping, active, nodal, P[t]);
    }
    for (size_t t = 0; t < count; t++)
      scatter_forces(&packs[first + PACKS * t], other_pack(work, first + PACKS * t), P[t], work->f);
  }
}

static void law_tets(const vsc_patch_work *work)
{
  force_kernel(work, true, VSC_COMPOSED, false, VSC_ACTIVE_NONE, false);
}

static void damped_law_tets(const vsc_patch_work *work)
{
  force_kernel(work, true, VSC_COMPOSED, true, VSC_ACTIVE_NONE, false);
}

static void volume_kernel(const vsc_patch_work *work)
{
  for (size_t k = 0; k < work->pack_count; k += PACKS) {
    const vsc_pack *pack = (const vsc_pack *)work->packs + k;
    const size_t other = other_pack(work, k);
    vsc_wide3 edge[3];
    gather_edges(pack, other, work->x, edge);
    // an element's volume is (e_1 x e_2) . e_3 / 6, a quarter of which goes to each node
    const vsc_wide quarter = vsc_wide_dot(vsc_wide_cross(edge[0], edge[1]), edge[2]) * (1.0 / 24);
    for (size_t p = 0; p <= other; p++)
      for (int c = 0; c < 4; c++)
        for (int l = 0; l < VSC_WIDTH; l++)
          work->volume[pack[p].node[c][l]] += vsc_part(quarter, (int)p)[l];
  }
}

#endif
