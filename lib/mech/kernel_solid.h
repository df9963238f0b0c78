// SPDX-License-Identifier: GPL-3.0-or-later
// Cells with several frames, which share one volume ratio and one pressure (mean dilatation):
// hexahedra, wedges, pyramids, quadratic tets. What their kernels are made of, and their stress under
// law SPRINGS. Internal to mech; included by kernel_body.h.
#ifndef VSC_MECH_KERNEL_SOLID_H
#define VSC_MECH_KERNEL_SOLID_H

#include "mech/kernel_common.h"

// ---- h_k = sum_i D_ki x_i at all points, and back: f_i = sum_q sum_k D_ki q_k

VSC_INLINE void plain_derivatives(const vsc_cell_rule *rule, int corners, int points,
                                  const vsc_wide3 *x, vsc_wide3 (*h)[3])
{
  for (int q = 0; q < points; q++)
    for (int k = 0; k < 3; k++) {
      h[q][k] = vsc_wide_scale(vsc_splat(rule->D[q][k][0]), x[0]);
      for (int c = 1; c < corners; c++)
        h[q][k] = vsc_wide_add(h[q][k], vsc_wide_scale(vsc_splat(rule->D[q][k][c]), x[c]));
    }
}

VSC_INLINE void plain_back(const vsc_cell_rule *rule, int corners, int points,
                           vsc_wide3 (*flux)[3], vsc_wide3 *f)
{
  for (int c = 0; c < corners; c++) f[c] = wide_zero();
  for (int q = 0; q < points; q++)
    for (int k = 0; k < 3; k++)
      for (int c = 0; c < corners; c++)
        f[c] = vsc_wide_add(f[c], vsc_wide_scale(vsc_splat(rule->D[q][k][c]), flux[q][k]));
}

// A hexahedron's trilinear map in modes: x = sum over sets S of {1, 2, 3} of m_S prod_{k in S} xi_k,
// m_S = 1/8 sum_i prod_{k in S} sign_ik x_i. The set is a number of three bits, and so is a corner
// (bit k: sign_ik = +1) and a point: three rounds of sums and differences lead from one to the other.
VSC_INLINE void butterflies(vsc_wide3 m[8])
{
  for (int bit = 1; bit < 8; bit *= 2)
    for (int i = 0; i < 8; i++) {
      if (i & bit) continue;
      const vsc_wide3 low = m[i], high = m[i | bit];
      m[i] = vsc_wide_add(low, high);
      m[i | bit] = vsc_wide_minus(high, low);
    }
}

static const int hex_corner_bits[8] = {0, 1, 3, 2, 4, 5, 7, 6};  // of VTK's corner i
#define GAUSS_POINT 0.57735026918962576451  // 1/sqrt 3

// h_1 = m_1 + m_12 xi_2 + m_13 xi_3 + m_123 xi_2 xi_3, and cyclically, at xi = +- 1/sqrt 3.
VSC_INLINE void hex_derivatives(const vsc_wide3 x[8], vsc_wide3 (*h)[3])
{
  vsc_wide3 m[8];
  for (int i = 0; i < 8; i++) m[hex_corner_bits[i]] = x[i];
  butterflies(m);
  for (int k = 0; k < 3; k++) {
    const int own = 1 << k, one = 1 << (k + 1) % 3, two = 1 << (k + 2) % 3;
    const vsc_wide scale = vsc_splat(0.125), slope = vsc_splat(0.125 * GAUSS_POINT);
    const vsc_wide3 level = vsc_wide_scale(scale, m[own]);
    const vsc_wide3 first = vsc_wide_scale(slope, m[own | one]);
    const vsc_wide3 second = vsc_wide_scale(slope, m[own | two]);
    const vsc_wide3 twist = vsc_wide_scale(vsc_splat(0.125 / 3), m[own | one | two]);
    const vsc_wide3 below = vsc_wide_minus(level, second), above = vsc_wide_add(level, second);
    const vsc_wide3 low = vsc_wide_minus(first, twist), high = vsc_wide_add(first, twist);
    for (int q = 0; q < 8; q += 1) {
      if (q & own) continue;
      const vsc_wide3 base = q & two ? above : below, tilt = q & two ? high : low;
      h[q][k] = q & one ? vsc_wide_add(base, tilt) : vsc_wide_minus(base, tilt);
      h[q | own][k] = h[q][k];
    }
  }
}

// The transpose of hex_derivatives.
VSC_INLINE void hex_back(vsc_wide3 (*flux)[3], vsc_wide3 f[8])
{
  vsc_wide3 m[8];
  for (int i = 0; i < 8; i++) m[i] = wide_zero();
  for (int k = 0; k < 3; k++) {
    const int own = 1 << k, one = 1 << (k + 1) % 3, two = 1 << (k + 2) % 3;
    vsc_wide3 part[4];
    for (int p = 0; p < 4; p++) {
      const int q = (p & 1 ? one : 0) | (p & 2 ? two : 0);
      part[p] = vsc_wide_add(flux[q][k], flux[q | own][k]);
    }
    const vsc_wide3 below = vsc_wide_add(part[0], part[1]), above = vsc_wide_add(part[2], part[3]);
    const vsc_wide3 low = vsc_wide_minus(part[1], part[0]), high = vsc_wide_minus(part[3], part[2]);
    const vsc_wide slope = vsc_splat(0.125 * GAUSS_POINT), scale = vsc_splat(0.125);
    m[own] = vsc_wide_add(m[own], vsc_wide_scale(scale, vsc_wide_add(below, above)));
    m[own | one] = vsc_wide_add(m[own | one], vsc_wide_scale(slope, vsc_wide_add(low, high)));
    m[own | two] = vsc_wide_add(m[own | two], vsc_wide_scale(slope, vsc_wide_minus(above, below)));
    m[7] = vsc_wide_add(m[7], vsc_wide_scale(vsc_splat(0.125 / 3), vsc_wide_minus(high, low)));
  }
  // from modes to corners: the sum of +- m_S, the sign being minus for each k of S whose bit is 0
  for (int bit = 1; bit < 8; bit *= 2)
    for (int i = 0; i < 8; i++) {
      if (i & bit) continue;
      const vsc_wide3 without = m[i], with = m[i | bit];
      m[i] = vsc_wide_minus(without, with);
      m[i | bit] = vsc_wide_add(without, with);
    }
  for (int i = 0; i < 8; i++) f[i] = m[hex_corner_bits[i]];
}

VSC_INLINE void derivatives(const vsc_cell_rule *rule, int corners, int points, const vsc_wide3 *x,
                            vsc_wide3 (*h)[3])
{
  if (corners == 8)
    hex_derivatives(x, h);
  else
    plain_derivatives(rule, corners, points, x, h);
}

VSC_INLINE void solid_back(const vsc_cell_rule *rule, int corners, int points,
                           vsc_wide3 (*flux)[3], vsc_wide3 *f)
{
  if (corners == 8)
    hex_back(flux, f);
  else
    plain_back(rule, corners, points, flux, f);
}

// A frame of the elements that are computed together: a vsc_frame, or two side by side.
typedef struct frame_numbers {
  vsc_wide T[3][3], V;
} frame_numbers;

VSC_INLINE frame_numbers frame_of(const vsc_frame *frame, size_t bytes)
{
  frame_numbers f = {.V = joined(&frame->V, bytes)};
  for (int a = 0; a < 3; a++)
    for (int k = 0; k < 3; k++) f.T[a][k] = joined(&frame->T[a][k], bytes);
  return f;
}

// What goes back to the corners from a frame under stress P: f_i = -sum_k D_ki V sum_a P_a T_ak.
VSC_INLINE void solid_flux(const frame_numbers *frame, const vsc_wide3 P[3], vsc_wide3 flux[3])
{
  for (int i = 0; i < 3; i++)
    flux[i] = vsc_wide_scale(-frame->V, vsc_wide_combine(frame->T[0][i], P[0], frame->T[1][i], P[1],
                                                         frame->T[2][i], P[2]));
}

// g_a = sum_k T_ak h_k
VSC_INLINE void solid_axes(const frame_numbers *frame, const vsc_wide3 h[3], vsc_wide3 g[3])
{
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(frame->T[a][0], h[0], frame->T[a][1], h[1], frame->T[a][2], h[2]);
}

// A pack of cells, with the one behind it, opened for its forces or its tangent.
typedef struct opened_pack {
  size_t other;  // how many bytes behind it the other pack is
  const vsc_frame *frames;
  const uint16_t (*node)[VSC_WIDTH];
  vsc_wide3 h[VSC_MOST_POINTS][3];      // derivatives of positions at all points
  vsc_wide3 speed[VSC_MOST_POINTS][3];  // of velocities, when they count
} opened_pack;

VSC_INLINE void open_derivatives(const vsc_patch_work *work, const opened_pack *pack, int corners,
                                 int points, const double *nodes, vsc_wide3 (*h)[3])
{
  vsc_wide3 x[VSC_MOST_CORNERS];
  for (int c = 0; c < corners; c++) x[c] = gather_corner(corner_of(pack->node[c], pack->other), nodes);
  derivatives(work->rule, corners, points, x, h);
}

VSC_INLINE void open_pack(const vsc_patch_work *work, size_t k, int corners, int points,
                          bool damping, opened_pack *pack)
{
  const size_t bytes = vsc_pack_bytes(corners, points);
  pack->other = other_pack(work, k) * bytes;
  pack->frames = (const vsc_frame *)((const char *)work->packs + k * bytes);
  pack->node = (const uint16_t(*)[VSC_WIDTH])(pack->frames + points);
  open_derivatives(work, pack, corners, points, work->x, pack->h);
  if (damping) open_derivatives(work, pack, corners, points, work->w, pack->speed);
}

// J = sum_q V_q det G_q / sum_q V_q, 1 in an empty place. The axes of all frames come back in g (and their
// lengths where they are asked for: while the next frame is opened, nobody waits for their roots), the
// volume (1 in an empty place) in *whole.
VSC_INLINE vsc_wide mean_ratio(const opened_pack *pack, int points, const vsc_wide3 (*h)[3],
                               vsc_wide3 (*g)[3], vsc_axis_lengths *lengths, vsc_wide *whole)
{
  vsc_wide volume = vsc_splat(0), rest = vsc_splat(0);
  for (int q = 0; q < points; q++) {
    const frame_numbers frame = frame_of(&pack->frames[q], pack->other);
    solid_axes(&frame, h[q], g[q]);
    if (lengths != NULL) lengths[q] = vsc_lengths_of(g[q]);
    volume += frame.V * vsc_wide_dot(g[q][0], vsc_wide_cross(g[q][1], g[q][2]));
    rest += frame.V;
  }
  const vsc_wide_mask full = rest > 0;
  *whole = vsc_select(full, rest, vsc_splat(1));
  return vsc_select(full, volume, vsc_splat(1)) / *whole;
}

// The mean of the four nodes' pressures, of tets that share their volume.
VSC_INLINE vsc_wide nodes_pressure(const vsc_patch_work *work, const opened_pack *pack)
{
  vsc_wide pressure = vsc_splat(0);
  for (int c = 0; c < 4 && work->shares_volume; c++)
    pressure += 0.25 * node_numbers(work->pressure, corner_of(pack->node[c], pack->other));
  return pressure;
}

// P_a of one frame: springs, damping, activity, further axes.
VSC_INLINE void solid_stress(const vsc_patch_work *work, size_t k, const vsc_mixture *moduli,
                             const vsc_wide3 g[3], const vsc_axis_lengths *lengths, const vsc_wide3 rate[3],
                             bool damping, vsc_wide3 P[3])
{
  const vsc_material *material = work->material;
  const vsc_frame_axes axes = vsc_frame_of_lengths(g, lengths);
  vsc_wide along[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  for (int a = 0; damping && a < 3; a++)
    along[a] = moduli->damping[a] * vsc_wide_dot(rate[a], axes.u[a]);
  const vsc_wide activation = activation_of(work, k);
  const vsc_springs law = springs_of(material, moduli, true, material->active, activation);
  if (material->active == VSC_ACTIVE_TENSION)
    along[0] += moduli->share * activation * material->tension * axes.length[0];
  vsc_springs_stress(&law, &axes, along, work->angular, P);
  add_more_axes(work, moduli->share, g, rate, damping, P);
}

#endif
