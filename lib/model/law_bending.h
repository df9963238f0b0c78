// SPDX-License-Identifier: GPL-3.0-or-later
// Bending of a sheet of triangles. A bend is a triangle with its three neighbours: six nodes, three
// dihedral angles theta_i over its edges (0 where the sheet is flat, positive where it curves
// towards the triangle's normal). Its energy is a quadratic form of the three together,
//
//   psi = sum_ij M_ij (phi_i - phi_i0) (phi_j - phi_j0) / 2   (uJ),   phi = 2 sin(theta / 2)
//
// since one angle for itself cannot tell in which direction the sheet is curved: a sum over edges of
// (1/2) k_e theta_e^2 resists a given curvature by up to three times more in one direction than in
// another, whatever k_e is. M comes from the plate's energy (vsc_bend_stiffness): any constant
// curvature of a flat sheet of any triangles costs exactly what the plate's does.
//
// phi is theta to third order, needs no trigonometry, and stays smooth and bounded up to
// theta = pi, where the two triangles lie on one another and the moment dpsi/dtheta vanishes.
// With n = (x_1 - x_0) x (x_2 - x_0) of the triangle, m = (p - q) x (r - q) of the neighbour across
// the edge from p to q, l = |q - p|, s the triangle's third node and r the neighbour's:
//
//   cos theta = n.m/(|n||m|),  sin theta = n.(r - p) l/(|n||m|)
//   dtheta/dr = m l/|m|^2,  dtheta/ds = n l/|n|^2,
//   dtheta/dp = -(1 - s_l) dtheta/ds - (1 - r_l) dtheta/dr,  dtheta/dq = -s_l dtheta/ds - r_l dtheta/dr
//
// Damping of the same material adds tau sum_j M_ij dphi_j/dt to dpsi/dphi_i, tau (ms) its viscosity
// over its modulus. Here s_l, r_l = (s - p).(q - p)/l^2, (r - p).(q - p)/l^2.
#ifndef VSC_MODEL_LAW_BENDING_H
#define VSC_MODEL_LAW_BENDING_H

#include "base/wide.h"

enum { VSC_BEND_NODES = 6 };  // 0 1 2 the triangle; 3 + i: across the edge from node i to i + 1

// Four bends at rest. Where there is no neighbour the edge bends freely: its row of M is 0 and its
// node may be any.
typedef struct vsc_bends {
  vsc_wide M[3][3];  // symmetric, uJ
  vsc_wide rest[3];  // phi_i0
} vsc_bends;

// One edge of four bends.
typedef struct vsc_fold {
  vsc_wide phi;     // 2 sin(theta/2)
  vsc_wide slope;   // dphi/dtheta = cos(theta/2)
  vsc_wide3 on_s;   // dtheta/ds, 1/mm
  vsc_wide3 on_r;   // dtheta/dr, 1/mm
  vsc_wide s_l, r_l;
} vsc_fold;

// 1/a, or 0 where a is 0 (or its inverse overflows).
VSC_INLINE vsc_wide vsc_wide_inverse(vsc_wide a)
{
  return vsc_where(a > 1e-300, 1.0 / a);
}

// The fold over the edge from p to q.
VSC_INLINE vsc_fold vsc_fold_of(vsc_wide3 p, vsc_wide3 q, vsc_wide3 s, vsc_wide3 r)
{
  vsc_fold fold;
  const vsc_wide3 edge = vsc_wide_minus(q, p);
  const vsc_wide3 to_s = vsc_wide_minus(s, p), to_r = vsc_wide_minus(r, p);
  const vsc_wide3 n = vsc_wide_cross(edge, to_s), m = vsc_wide_cross(to_r, edge);
  const vsc_wide square = vsc_wide_dot(edge, edge), length = vsc_wide_sqrt(square);
  const vsc_wide nn = vsc_wide_dot(n, n), mm = vsc_wide_dot(m, m);
  const vsc_wide both = vsc_wide_inverse(vsc_wide_sqrt(nn) * vsc_wide_sqrt(mm));
  const vsc_wide cosine = vsc_wide_dot(n, m) * both;
  const vsc_wide sine = vsc_wide_dot(n, to_r) * length * both;
  // the larger of 2 cos(theta/2) and 2 |sin(theta/2)|, from which the other follows without
  // cancellation
  const vsc_wide size = vsc_select(cosine > 0.0, cosine, -cosine);
  const vsc_wide larger = vsc_wide_sqrt(2.0 * size + 2.0);
  const vsc_wide smaller = 2.0 * sine / larger;
  const vsc_wide_mask left = sine < 0.0;
  fold.phi = vsc_select(cosine > 0.0, smaller, vsc_select(left, -larger, larger));
  fold.slope = 0.5 * vsc_select(cosine > 0.0, larger, vsc_select(left, -smaller, smaller));
  fold.on_s = vsc_wide_scale(length * vsc_wide_inverse(nn), n);
  fold.on_r = vsc_wide_scale(length * vsc_wide_inverse(mm), m);
  const vsc_wide inverse = vsc_wide_inverse(square);
  fold.s_l = vsc_wide_dot(to_s, edge) * inverse;
  fold.r_l = vsc_wide_dot(to_r, edge) * inverse;
  return fold;
}

// The three folds of bends with nodes x.
VSC_INLINE void vsc_bend_folds(const vsc_wide3 x[VSC_BEND_NODES], vsc_fold folds[3])
{
  for (int i = 0; i < 3; i++)
    folds[i] = vsc_fold_of(x[i], x[(i + 1) % 3], x[(i + 2) % 3], x[3 + i]);
}

// dphi_i/dt of bends whose nodes have velocities v, 1/ms.
VSC_INLINE void vsc_bend_rates(const vsc_fold folds[3], const vsc_wide3 v[VSC_BEND_NODES],
                               vsc_wide rates[3])
{
  for (int i = 0; i < 3; i++) {
    const vsc_fold *fold = &folds[i];
    const vsc_wide3 p = v[i], edge = vsc_wide_minus(v[(i + 1) % 3], p);
    const vsc_wide3 s = vsc_wide_minus(v[(i + 2) % 3], p), r = vsc_wide_minus(v[3 + i], p);
    rates[i] = fold->slope * (vsc_wide_dot(fold->on_s, s) + vsc_wide_dot(fold->on_r, r) -
                              fold->s_l * vsc_wide_dot(fold->on_s, edge) -
                              fold->r_l * vsc_wide_dot(fold->on_r, edge));
  }
}

// sum_j M_ij change_j
VSC_INLINE void vsc_bend_moments(const vsc_bends *bends, const vsc_wide change[3], vsc_wide moment[3])
{
  for (int i = 0; i < 3; i++)
    moment[i] = bends->M[i][0] * change[0] + bends->M[i][1] * change[1] + bends->M[i][2] * change[2];
}

// sum_ij M_ij change_i change_j: twice the energy of phi - phi_0, or over the time of damping the
// power of dphi/dt.
VSC_INLINE vsc_wide vsc_bend_square(const vsc_bends *bends, const vsc_wide change[3])
{
  vsc_wide moment[3];
  vsc_bend_moments(bends, change, moment);
  return moment[0] * change[0] + moment[1] * change[1] + moment[2] * change[2];
}

VSC_INLINE vsc_wide vsc_bend_energy(const vsc_bends *bends, const vsc_fold folds[3])
{
  vsc_wide change[3];
  for (int i = 0; i < 3; i++) change[i] = folds[i].phi - bends->rest[i];
  return 0.5 * vsc_bend_square(bends, change);
}

// f = -dpsi/dx on the six nodes, mN. `lead[i]` is added to phi_i: damping.
VSC_INLINE void vsc_bend_forces(const vsc_bends *bends, const vsc_fold folds[3],
                                const vsc_wide lead[3], vsc_wide3 f[VSC_BEND_NODES])
{
  vsc_wide change[3], moment[3];
  for (int i = 0; i < 3; i++) change[i] = folds[i].phi - bends->rest[i] + lead[i];
  vsc_bend_moments(bends, change, moment);
  for (int i = 0; i < 3; i++) f[i] = (vsc_wide3){vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  for (int i = 0; i < 3; i++) {
    const vsc_fold *fold = &folds[i];
    const int q = (i + 1) % 3, s = (i + 2) % 3;
    const vsc_wide torque = moment[i] * fold->slope;
    const vsc_wide3 on_s = vsc_wide_scale(-torque, fold->on_s);
    const vsc_wide3 on_r = vsc_wide_scale(-torque, fold->on_r);
    const vsc_wide one = vsc_splat(1);
    f[s] = vsc_wide_add(f[s], on_s);
    f[3 + i] = on_r;
    f[i] = vsc_wide_combine(one, f[i], fold->s_l - 1.0, on_s, fold->r_l - 1.0, on_r);
    f[q] = vsc_wide_combine(one, f[q], -fold->s_l, on_s, -fold->r_l, on_r);
  }
}

#endif
