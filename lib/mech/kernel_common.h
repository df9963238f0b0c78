// SPDX-License-Identifier: GPL-3.0-or-later
// What the kernels share. Internal to mech; included by the source file of each instruction set.
#ifndef VSC_MECH_KERNEL_COMMON_H
#define VSC_MECH_KERNEL_COMMON_H

#include "mech/kernel.h"
#include "model/law_springs.h"
#include "model/law_volume.h"

// One corner of four elements, from node x 4 numbers.
VSC_INLINE vsc_wide3 gather_corner(const uint16_t node[VSC_WIDTH], const double *nodes)
{
  vsc_wide d[VSC_WIDTH];
  for (int l = 0; l < VSC_WIDTH; l++) d[l] = *(const vsc_wide *)(nodes + 4 * node[l]);
  vsc_transpose(&d[0], &d[1], &d[2], &d[3]);
  return (vsc_wide3){d[0], d[1], d[2]};
}

// Adds a force to one corner of four elements.
VSC_INLINE void scatter_corner(const uint16_t node[VSC_WIDTH], vsc_wide3 force, double *forces)
{
  vsc_wide f[VSC_WIDTH] = {force.x, force.y, force.z, vsc_splat(0)};
  vsc_transpose(&f[0], &f[1], &f[2], &f[3]);
  for (int l = 0; l < VSC_WIDTH; l++) *(vsc_wide *)(forces + 4 * node[l]) += f[l];
}

VSC_INLINE vsc_wide3 wide_zero(void)
{
  return (vsc_wide3){vsc_splat(0), vsc_splat(0), vsc_splat(0)};
}

// Length of a vector, and 1/length (0 where it has none).
VSC_INLINE vsc_wide length_of(vsc_wide3 a, vsc_wide *inverse)
{
  const vsc_wide length = vsc_wide_sqrt(vsc_wide_dot(a, a));
  *inverse = vsc_wide_inverse(length, VSC_SHORTEST_AXIS);
  return length;
}

// cof(G) = [g_s x g_n | g_n x g_f | g_f x g_s]; returns J = det G.
VSC_INLINE vsc_wide cofactor_of(const vsc_wide3 g[3], vsc_wide3 cofactor[3])
{
  for (int a = 0; a < 3; a++) cofactor[a] = vsc_wide_cross(g[(a + 1) % 3], g[(a + 2) % 3]);
  return vsc_wide_dot(g[0], cofactor[0]);
}

// What is added to the pressure that the frames of a pack share.
VSC_INLINE vsc_wide multiplier_of(const vsc_patch_work *work, size_t k)
{
  return work->multipliers != NULL ? work->multipliers[k] : vsc_splat(0);
}

VSC_INLINE vsc_mixture moduli_of(const vsc_patch_work *work, size_t k, bool composed)
{
  return vsc_moduli_or(work->material,
                       composed && work->mixtures != NULL ? &work->mixtures[k] : NULL);
}

// The springs of a pack at activation a.
VSC_INLINE vsc_springs springs_of(const vsc_material *material, const vsc_mixture *m,
                                  vsc_active_kind active, vsc_wide a)
{
  vsc_springs law = {.rest_stretch = vsc_splat(1)};
  for (int i = 0; i < 3; i++) {
    law.axial[i] = m->axial[i];
    law.angular[i] = m->angular[i];
  }
  if (active == VSC_ACTIVE_SPRING) {
    const vsc_wide own = m->share * a;
    law.axial[0] += own * (material->active_stiffness - material->axial[0]);
    law.rest_stretch -= a * (1 - material->rest_stretch);
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
    vsc_wide inverse;
    const vsc_wide length = length_of(along, &inverse);
    const vsc_wide3 u = vsc_wide_scale(inverse, along);
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
      length_of(along, &inverse[i]);
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
