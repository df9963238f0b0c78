// SPDX-License-Identifier: GPL-3.0-or-later
// The systems of Bourguignon & Cani 2000 as printed: tets and hexahedra under law PAPER, and
// classical springs on edges. Internal to mech; included by kernel_body.h.
//
//   axial    on l_a: -[k_s (|l_a| - r_a) + k_d (dl_a/dt . l_a)/|l_a|] l_a/|l_a|
//   angular  on l_a: -k_s c_ab u_b, on l_b: -k_s c_ab u_a      (c_ab = u_a . u_b, at rest 0)
//   radial   on corner j of a tet: -k_s [sum_i |x_i - x_B| - the same at rest] (x_j - x_B)/|x_j - x_B|
//   radial   on corner j of a hexahedron: a damped spring to the barycentre x_B
//
// "On l_a" means on its far end, with the opposite on its near end; the ends' forces go to the
// corners with the weights by which the corners move them: f_i = w_ai F_a.
#ifndef VSC_MECH_KERNEL_PAPER_H
#define VSC_MECH_KERNEL_PAPER_H

#include "mech/kernel_common.h"
#include "mech/kernel_tets.h"

// k_f(t) and the rest length's factor of the fibre at this pack's activation.
VSC_INLINE vsc_wide paper_fibre(const vsc_patch_work *work, size_t k, vsc_wide *rest)
{
  const vsc_material *material = work->material;
  *rest = vsc_splat(1);
  if (material->active != VSC_ACTIVE_SPRING) return vsc_splat(material->paper.axial[0]);
  const vsc_wide a = work->activation[k * work->activation_stride];
  *rest -= a * (1 - material->rest_stretch);
  return material->paper.axial[0] + a * (material->paper.active - material->paper.axial[0]);
}

// Forces F_a on the axes l_a = length_a u_a with rates dl_a/dt . u_a.
VSC_INLINE void paper_axis_forces(const vsc_patch_work *work, size_t k, const vsc_wide3 u[3],
                                  const vsc_wide length[3], const vsc_wide r[3],
                                  const vsc_wide rate[3], vsc_wide3 F[3])
{
  const vsc_paper_def *paper = &work->material->paper;
  vsc_wide rest, w[3];
  const vsc_wide fibre = paper_fibre(work, k, &rest);
  for (int a = 0; a < 3; a++) w[a] = paper->angular[a] * vsc_wide_dot(u[a], u[(a + 1) % 3]);
  for (int a = 0; a < 3; a++) {
    const vsc_wide stiffness = a == 0 ? fibre : vsc_splat(paper->axial[a]);
    const vsc_wide own = stiffness * (length[a] - (a == 0 ? rest * r[a] : r[a])) +
                         paper->damping[a] * rate[a];
    F[a] = vsc_wide_combine(-own, u[a], -w[a], u[(a + 1) % 3], -w[(a + 2) % 3], u[(a + 2) % 3]);
  }
}

// ---- tets

// Adds the radial forces to the corners' forces f; edges are x_i - x_0.
VSC_INLINE void add_radial_forces(double stiffness, vsc_wide radius, const vsc_wide3 edge[3],
                                  vsc_wide3 f[4])
{
  vsc_wide3 d[4];
  vsc_wide inverse[4], sum = vsc_splat(0);
  const vsc_wide quarter = vsc_splat(-0.25);
  d[0] = vsc_wide_combine(quarter, edge[0], quarter, edge[1], quarter, edge[2]);
  for (int i = 0; i < 3; i++) d[i + 1] = vsc_wide_add(edge[i], d[0]);
  for (int i = 0; i < 4; i++) sum += length_of(d[i], &inverse[i]);
  const vsc_wide force = -stiffness * (sum - radius);
  for (int i = 0; i < 4; i++) f[i] = vsc_wide_add(f[i], vsc_wide_scale(force * inverse[i], d[i]));
}

VSC_INLINE void paper_tet_kernel(const vsc_patch_work *work, bool damping)
{
  const vsc_pack *packs = work->packs;
  const vsc_chords *chords = work->law_data;
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_pack *pack = &packs[k];
    vsc_wide3 edge[3], speed[3], g[3], change[3], F[3], f[4];
    vsc_wide length[3], rate[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
    gather_edges(pack, 0, work->x, edge);
    frame_axes(pack, 0, edge, g);
    const vsc_frame_axes frame = vsc_frame_of(g);
    if (damping) {
      gather_edges(pack, 0, work->w, speed);
      frame_axes(pack, 0, speed, change);
    }
    // l_a = r_a g_a
    for (int a = 0; a < 3; a++) {
      length[a] = chords[k].r[a] * frame.length[a];
      if (damping) rate[a] = chords[k].r[a] * vsc_wide_dot(change[a], frame.u[a]);
    }
    paper_axis_forces(work, k, frame.u, length, chords[k].r, rate, F);
    // w_ai = r_a B_ai
    for (int a = 0; a < 3; a++) F[a] = vsc_wide_scale(chords[k].r[a], F[a]);
    f[0] = wide_zero();
    for (int i = 0; i < 3; i++) {
      f[i + 1] = vsc_wide_combine(pack->B[0][i], F[0], pack->B[1][i], F[1], pack->B[2][i], F[2]);
      f[0] = vsc_wide_minus(f[0], f[i + 1]);
    }
    if (work->material->paper.volume > 0)
      add_radial_forces(work->material->paper.volume, chords[k].radius, edge, f);
    for (int c = 0; c < 4; c++) scatter_corner(pack->node[c], f[c], work->f);
  }
}

static void force_paper_tets(const vsc_patch_work *work)
{
  paper_tet_kernel(work, false);
}

static void force_damped_paper_tets(const vsc_patch_work *work)
{
  paper_tet_kernel(work, true);
}

// ---- hexahedra

// Springs from the corners to their mean, added to f.
VSC_INLINE void add_corner_springs(const vsc_paper_def *paper, const vsc_wide radius[8],
                                   const vsc_wide3 x[8], const vsc_wide3 v[8], bool damping,
                                   vsc_wide3 f[8])
{
  vsc_wide3 centre = wide_zero(), drift = wide_zero();
  for (int i = 0; i < 8; i++) {
    centre = vsc_wide_add(centre, x[i]);
    if (damping) drift = vsc_wide_add(drift, v[i]);
  }
  centre = vsc_wide_scale(vsc_splat(0.125), centre);
  drift = vsc_wide_scale(vsc_splat(0.125), drift);
  for (int i = 0; i < 8; i++) {
    vsc_wide inverse;
    const vsc_wide3 d = vsc_wide_minus(x[i], centre);
    const vsc_wide length = length_of(d, &inverse);
    vsc_wide force = paper->volume * (length - radius[i]);
    if (damping)
      force += paper->volume_damping * vsc_wide_dot(vsc_wide_minus(v[i], drift), d) * inverse;
    f[i] = vsc_wide_minus(f[i], vsc_wide_scale(force * inverse, d));
  }
}

VSC_INLINE vsc_wide3 weighted_sum(const vsc_wide w[8], const vsc_wide3 x[8])
{
  vsc_wide3 sum = vsc_wide_scale(w[0], x[0]);
  for (int i = 1; i < 8; i++) sum = vsc_wide_add(sum, vsc_wide_scale(w[i], x[i]));
  return sum;
}

VSC_INLINE void paper_hex_kernel(const vsc_patch_work *work, bool damping)
{
  enum { POINTS = 8 };
  const vsc_hex_axes *axes = work->law_data;
  const size_t bytes = vsc_pack_bytes(8, POINTS);
  const char *nodes = (const char *)work->packs + POINTS * sizeof(vsc_frame);
  for (size_t k = 0; k < work->pack_count; k++) {
    const uint16_t(*node)[VSC_WIDTH] = (const uint16_t(*)[VSC_WIDTH])(nodes + k * bytes);
    vsc_wide3 x[8], v[8], l[3], u[3], F[3], f[8];
    vsc_wide length[3], inverse, rate[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
    for (int i = 0; i < 8; i++) {
      x[i] = gather_corner(corner_of(node[i], 0), work->x);
      if (damping) v[i] = gather_corner(corner_of(node[i], 0), work->w);
    }
    for (int a = 0; a < 3; a++) {
      l[a] = weighted_sum(axes[k].w[a], x);
      length[a] = length_of(l[a], &inverse);
      u[a] = vsc_wide_scale(inverse, l[a]);
      if (damping) rate[a] = vsc_wide_dot(weighted_sum(axes[k].w[a], v), u[a]);
    }
    paper_axis_forces(work, k, u, length, axes[k].r, rate, F);
    for (int i = 0; i < 8; i++)
      f[i] = vsc_wide_combine(axes[k].w[0][i], F[0], axes[k].w[1][i], F[1], axes[k].w[2][i], F[2]);
    if (work->material->paper.volume > 0 || work->material->paper.volume_damping > 0)
      add_corner_springs(&work->material->paper, axes[k].radius, x, v, damping, f);
    for (int i = 0; i < 8; i++) scatter_corner(node[i], f[i], work->f);
  }
}

static void force_paper_hexes(const vsc_patch_work *work)
{
  paper_hex_kernel(work, false);
}

static void force_damped_paper_hexes(const vsc_patch_work *work)
{
  paper_hex_kernel(work, true);
}

// ---- classical springs

VSC_INLINE void spring_kernel(const vsc_patch_work *work, bool damping)
{
  const vsc_edge_pack *packs = work->packs;
  const double stiffness = work->material->classical.stiffness;
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_edge_pack *pack = &packs[k];
    vsc_wide d[VSC_WIDTH], inverse;
    for (int l = 0; l < VSC_WIDTH; l++)
      d[l] = *(const vsc_wide *)(work->x + place_of(pack->node[0][l])) -
             *(const vsc_wide *)(work->x + place_of(pack->node[1][l]));
    vsc_transpose(&d[0], &d[1], &d[2], &d[3]);
    const vsc_wide3 way = {d[0], d[1], d[2]};
    const vsc_wide length = length_of(way, &inverse);
    vsc_wide force = -stiffness * (length - pack->length);
    if (damping) {
      for (int l = 0; l < VSC_WIDTH; l++)
        d[l] = *(const vsc_wide *)(work->w + place_of(pack->node[0][l])) -
               *(const vsc_wide *)(work->w + place_of(pack->node[1][l]));
      vsc_transpose(&d[0], &d[1], &d[2], &d[3]);
      force -= work->material->classical.damping *
               vsc_wide_dot((vsc_wide3){d[0], d[1], d[2]}, way) * inverse;
    }
    const vsc_wide3 on_first = vsc_wide_scale(force * inverse, way);
    vsc_wide f[VSC_WIDTH];
    vsc_wide_rows(on_first, f);
    for (int l = 0; l < VSC_WIDTH; l++) {
      *(vsc_wide *)(work->f + place_of(pack->node[0][l])) += f[l];
      *(vsc_wide *)(work->f + place_of(pack->node[1][l])) -= f[l];
    }
  }
}

static void force_springs(const vsc_patch_work *work)
{
  spring_kernel(work, false);
}

static void force_damped_springs(const vsc_patch_work *work)
{
  spring_kernel(work, true);
}

#endif
