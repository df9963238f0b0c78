// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernels share. Internal to mech; included by the source file of each instruction set.
#ifndef VSC_MECH_KERNEL_COMMON_H
#define VSC_MECH_KERNEL_COMMON_H

#include "mech/kernel.h"
#include "model/law_springs.h"
#include "model/law_volume.h"

// Packs that are computed together: one, or with eight lanes two, side by side. They are given by the
// first and by how far behind it the other is, in packs: 0 with four lanes, and at an odd end, where the
// first goes twice and is added once.
enum { PACKS = VSC_LANES / VSC_WIDTH };

VSC_INLINE size_t other_pack(const vsc_patch_work *work, size_t k)
{
  return PACKS > 1 && k + 1 < work->pack_count;
}

// A number of pack k, and the same of the other pack, `bytes` behind it.
VSC_INLINE vsc_wide joined(const vsc_four *number, size_t bytes)
{
  return vsc_join(*number, *(const vsc_four *)((const char *)number + bytes));
}

// The nodes of one corner: of pack k, and of the other.
typedef struct corner_nodes {
  const uint16_t *of[2];
} corner_nodes;

VSC_INLINE corner_nodes corner_of(const uint16_t *node, size_t bytes)
{
  return (corner_nodes){{node, (const uint16_t *)((const char *)node + bytes)}};
}

// Where a node's four numbers begin. A size_t at once: an int would be widened at each access.
VSC_INLINE size_t place_of(uint16_t node)
{
  return 4 * (size_t)node;
}

VSC_INLINE vsc_wide node_rows(const double *nodes, const corner_nodes *corner, int l)
{
  return vsc_join(*(const vsc_four *)(nodes + place_of(corner->of[0][l])),
                  *(const vsc_four *)(nodes + place_of(corner->of[1][l])));
}

// One corner of the elements, from node x 4 numbers.
VSC_INLINE vsc_wide3 gather_corner(corner_nodes corner, const double *nodes)
{
  vsc_wide d[VSC_WIDTH];
  for (int l = 0; l < VSC_WIDTH; l++) d[l] = node_rows(nodes, &corner, l);
  vsc_transpose(&d[0], &d[1], &d[2], &d[3]);
  return (vsc_wide3){d[0], d[1], d[2]};
}

// Rows added to the nodes of one corner of a pack, the p-th of those computed together.
VSC_INLINE void add_rows(const uint16_t node[VSC_WIDTH], const vsc_wide rows[VSC_WIDTH], int p, double *forces)
{
  for (int l = 0; l < VSC_WIDTH; l++) *(vsc_four *)(forces + place_of(node[l])) += vsc_part(rows[l], p);
}

// Adds forces to one corner of the elements of a pack alone.
VSC_INLINE void scatter_corner(const uint16_t node[VSC_WIDTH], vsc_wide3 force, double *forces)
{
  vsc_wide rows[VSC_WIDTH];
  vsc_wide_rows(force, rows);
  add_rows(node, rows, 0, forces);
}

// Adds forces to all corners, pack after pack.
VSC_INLINE void scatter_corners(const uint16_t (*node)[VSC_WIDTH], size_t bytes, int corners,
                                const vsc_wide3 *force, double *forces)
{
  vsc_wide rows[VSC_MOST_CORNERS][VSC_WIDTH];
  for (int c = 0; c < corners; c++) {
    vsc_wide_rows(force[c], rows[c]);
    if (PACKS == 1) add_rows(node[c], rows[c], 0, forces);
  }
  for (int p = 0; PACKS > 1 && p < (bytes > 0 ? 2 : 1); p++)
    for (int c = 0; c < corners; c++) add_rows(corner_of(node[c], bytes).of[p], rows[c], p, forces);
}

// A number of each node.
VSC_INLINE vsc_wide node_numbers(const double *numbers, corner_nodes corner)
{
  vsc_four of[2];
  for (int p = 0; p < 2; p++)
    of[p] = (vsc_four){numbers[corner.of[p][0]], numbers[corner.of[p][1]], numbers[corner.of[p][2]],
                       numbers[corner.of[p][3]]};
  return vsc_join(of[0], of[1]);
}

VSC_INLINE vsc_wide3 wide_zero(void)
{
  return (vsc_wide3){vsc_splat(0), vsc_splat(0), vsc_splat(0)};
}

// Length of a vector, and 1/length (0 where it has none).
VSC_INLINE vsc_wide length_of(vsc_wide3 a, vsc_wide *inverse)
{
  const vsc_wide length = vsc_wide_sqrt(vsc_wide_dot(a, a));
  *inverse = vsc_wide_inverse(length, VSC_NO_LENGTH);
  return length;
}

// cof(G) = [g_s x g_n | g_n x g_f | g_f x g_s]; returns J = det G.
VSC_INLINE vsc_wide cofactor_of(const vsc_wide3 g[3], vsc_wide3 cofactor[3])
{
  for (int a = 0; a < 3; a++) cofactor[a] = vsc_wide_cross(g[(a + 1) % 3], g[(a + 2) % 3]);
  return vsc_wide_dot(g[0], cofactor[0]);
}

// P_a += p cof_a
VSC_INLINE void add_pressure(vsc_wide p, const vsc_wide3 cofactor[3], vsc_wide3 P[3])
{
  for (int a = 0; a < 3; a++) P[a] = vsc_wide_add(P[a], vsc_wide_scale(p, cofactor[a]));
}

// What is added to the pressure that the frames of a pack share.
VSC_INLINE vsc_wide multiplier_of(const vsc_patch_work *work, size_t k)
{
  if (work->multipliers == NULL) return vsc_splat(0);
  return joined(work->multipliers + k, other_pack(work, k) * sizeof(vsc_four));
}

VSC_INLINE vsc_wide activation_of(const vsc_patch_work *work, size_t k)
{
  const size_t stride = work->activation_stride;
  return joined(work->activation + k * stride, other_pack(work, k) * stride * sizeof(vsc_four));
}

VSC_INLINE vsc_mixture moduli_of(const vsc_patch_work *work, size_t k, bool composed)
{
  enum { MODULI = sizeof(vsc_mixture) / sizeof(vsc_wide) };
  if (!composed || work->mixtures == NULL) return vsc_moduli_or(work->material, NULL);
  vsc_mixture moduli;
  vsc_wide *all = (vsc_wide *)&moduli;
  for (size_t i = 0; i < MODULI; i++)
    all[i] = joined(work->mixtures + MODULI * k + i,
                    other_pack(work, k) * MODULI * sizeof(vsc_four));
  return moduli;
}

// The springs of a pack at activation a; `composed`: inclusions may be among them.
VSC_INLINE vsc_springs springs_of(const vsc_material *material, const vsc_mixture *m, bool composed,
                                  vsc_active_kind active, vsc_wide a)
{
  vsc_springs law = {.rest_stretch = vsc_splat(1)};
  for (int i = 0; i < 3; i++) {
    law.axial[i] = m->axial[i];
    law.angular[i] = m->angular[i];
  }
  if (active == VSC_ACTIVE_SPRING) {
    const vsc_wide own = m->share * a, contraction = a * (1 - material->rest_stretch);
    law.axial[0] += own * (material->active_stiffness - material->axial[0]);
    law.rest_stretch = composed ? vsc_shared_rest(contraction, law.axial[0], m->axial[0] - m->share * material->axial[0])
                                : 1 - contraction;
  }
  return law;
}

// P_a += of the further axes g_d = sum_a d_a g_a and pairs of the material:
//   E_d (|g_d| - 1) u_d d_a + eta_d (dg_d/dt . u_d) u_d d_a,
//   G (c - c0) [(u_j - c u_i)/n_i d^i_a + (u_i - c u_j)/n_j d^j_a],  c = u_i . u_j
VSC_INLINE void add_more_axes(const vsc_patch_work *work, vsc_wide share, const vsc_wide3 g[3],
                              const vsc_wide3 rate[3], bool damping, vsc_wide3 P[3])
{
  for (size_t d = 0; d < work->material->axis_count; d++) {
    const vsc_axis *axis = &work->axes[d];
    const vsc_wide part[3] = {vsc_splat(axis->direction[0]), vsc_splat(axis->direction[1]),
                              vsc_splat(axis->direction[2])};
    const vsc_wide3 along = vsc_wide_combine(part[0], g[0], part[1], g[1], part[2], g[2]);
    const vsc_wide length = vsc_wide_sqrt(vsc_wide_dot(along, along));
    const vsc_wide3 u = vsc_wide_scale(1.0 / vsc_no_shorter(length), along);
    vsc_wide force = axis->modulus * (length - 1);
    if (damping) {
      const vsc_wide3 change =
          vsc_wide_combine(part[0], rate[0], part[1], rate[1], part[2], rate[2]);
      force += axis->damping * vsc_wide_dot(change, u);
    }
    for (int a = 0; a < 3; a++)
      P[a] = vsc_wide_add(P[a], vsc_wide_scale(share * force * part[a], u));
  }
  for (size_t d = 0; d < work->material->pair_count; d++) {
    const vsc_pair *pair = &work->pairs[d];
    vsc_wide3 u[2];
    vsc_wide inverse[2];
    for (int i = 0; i < 2; i++) {
      const double *way = i == 0 ? pair->first : pair->second;
      const vsc_wide3 along = vsc_wide_combine(vsc_splat(way[0]), g[0], vsc_splat(way[1]), g[1],
                                               vsc_splat(way[2]), g[2]);
      inverse[i] = 1.0 / vsc_no_shorter(vsc_wide_sqrt(vsc_wide_dot(along, along)));
      u[i] = vsc_wide_scale(inverse[i], along);
    }
    const vsc_wide c = vsc_wide_dot(u[0], u[1]), w = share * pair->modulus * (c - pair->cosine);
    const vsc_wide3 first = vsc_wide_scale(w * inverse[0], vsc_wide_minus(u[1], vsc_wide_scale(c, u[0])));
    const vsc_wide3 second = vsc_wide_scale(w * inverse[1], vsc_wide_minus(u[0], vsc_wide_scale(c, u[1])));
    for (int a = 0; a < 3; a++)
      P[a] = vsc_wide_combine(vsc_splat(1), P[a], vsc_splat(pair->first[a]), first,
                              vsc_splat(pair->second[a]), second);
  }
}

#endif
