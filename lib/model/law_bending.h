// SPDX-License-Identifier: GPL-3.0-or-later
// Bending of a sheet of triangles. Over each edge between two triangles there is a dihedral angle
// theta (0 where the sheet is flat, positive where it curves towards the normal). A bend is a
// triangle with its three neighbours and theirs: twelve nodes, nine folds. It stores
//
//   psi = |m|^2 / 2,   m_k = sum_j G_kj (phi_j - phi_j0), k = 1, 2, 3   (uJ),   phi = 2
//   sin(theta/2)
//
// that is, the plate's energy of the curvature that its folds tell of (vsc_bend_stiffness makes G).
// One fold for itself cannot tell in which direction a sheet is curved: a sum over edges of
// (1/2) k_e theta_e^2 resists a given curvature by up to three times more in one direction than in
// another, whatever k_e is.
//
// phi is theta to third order, needs no trigonometry, and stays smooth and bounded up to
// theta = pi, where the two triangles lie on one another and the moment dpsi/dtheta vanishes.
// With n = (q - p) x (s - p) of the triangle with corners p, q, s, and m = (r - p) x (q - p) of its
// neighbour p, r, q across the edge from p to q, l = |q - p|:
//
//   cos theta = n.m/(|n||m|),  sin theta = n.(r - p) l/(|n||m|)
//   dtheta/dr = m l/|m|^2,  dtheta/ds = n l/|n|^2,
//   dtheta/dp = -(1 - s_l) dtheta/ds - (1 - r_l) dtheta/dr,  dtheta/dq = -s_l dtheta/ds - r_l
//   dtheta/dr
//
// with s_l, r_l = (s - p).(q - p)/l^2, (r - p).(q - p)/l^2. Damping of the same material makes
// phi lead by tau dphi/dt, tau (ms) its viscosity over its modulus.
#ifndef VSC_MODEL_LAW_BENDING_H
#define VSC_MODEL_LAW_BENDING_H

#include <stdbool.h>

#include "base/wide.h"

// Nodes 0 1 2 are the triangle; 3 + i lies across its edge from i to i + 1, and beyond that
// neighbour's other edges lie 6 + 2 i (across i, 3 + i) and 7 + 2 i (across 3 + i, i + 1).
enum { VSC_BEND_NODES = 12, VSC_BEND_FOLDS = 9 };

// Products of lengths below it count as 0: their inverse would overflow.
#define VSC_LEAST_FOLD 1e-300

// p, q, s, r of each fold.
static const int vsc_bend_fold_nodes[VSC_BEND_FOLDS][4] = {
    {0, 1, 2, 3}, {1, 2, 0, 4}, {2, 0, 1, 5},  {0, 3, 1, 6}, {3, 1, 0, 7},
    {1, 4, 2, 8}, {4, 2, 1, 9}, {2, 5, 0, 10}, {5, 0, 2, 11}};

// Four bends at rest. Where there is no neighbour the column of G is 0, and the node any.
typedef struct vsc_bends {
  vsc_wide G[3][VSC_BEND_FOLDS];  // uJ^(1/2)
  vsc_wide rest[VSC_BEND_FOLDS];  // phi_j0
} vsc_bends;

// One fold of four bends.
typedef struct vsc_fold {
  vsc_wide phi;    // 2 sin(theta/2)
  vsc_wide slope;  // dphi/dtheta = cos(theta/2)
  vsc_wide3 on_s;  // dtheta/ds, 1/mm
  vsc_wide3 on_r;  // dtheta/dr, 1/mm
  vsc_wide s_l, r_l;
} vsc_fold;

// The fold over the edge from p to q.
VSC_INLINE vsc_fold vsc_fold_of(vsc_wide3 p, vsc_wide3 q, vsc_wide3 s, vsc_wide3 r)
{
  vsc_fold fold;
  const vsc_wide3 edge = vsc_wide_minus(q, p);
  const vsc_wide3 to_s = vsc_wide_minus(s, p), to_r = vsc_wide_minus(r, p);
  const vsc_wide3 n = vsc_wide_cross(edge, to_s), m = vsc_wide_cross(to_r, edge);
  const vsc_wide square = vsc_wide_dot(edge, edge), length = vsc_wide_sqrt(square);
  const vsc_wide nn = vsc_wide_dot(n, n), mm = vsc_wide_dot(m, m);
  const vsc_wide both = vsc_wide_inverse(vsc_wide_sqrt(nn) * vsc_wide_sqrt(mm), VSC_LEAST_FOLD);
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
  fold.on_s = vsc_wide_scale(length * vsc_wide_inverse(nn, VSC_LEAST_FOLD), n);
  fold.on_r = vsc_wide_scale(length * vsc_wide_inverse(mm, VSC_LEAST_FOLD), m);
  const vsc_wide inverse = vsc_wide_inverse(square, VSC_LEAST_FOLD);
  fold.s_l = vsc_wide_dot(to_s, edge) * inverse;
  fold.r_l = vsc_wide_dot(to_r, edge) * inverse;
  return fold;
}

VSC_INLINE void vsc_bend_folds(const vsc_wide3 x[VSC_BEND_NODES], vsc_fold folds[VSC_BEND_FOLDS])
{
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    const int *node = vsc_bend_fold_nodes[j];
    folds[j] = vsc_fold_of(x[node[0]], x[node[1]], x[node[2]], x[node[3]]);
  }
}

// dphi_j/dt of bends whose nodes have velocities v, 1/ms.
VSC_INLINE void vsc_bend_rates(const vsc_fold folds[VSC_BEND_FOLDS],
                               const vsc_wide3 v[VSC_BEND_NODES], vsc_wide rates[VSC_BEND_FOLDS])
{
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    const int *node = vsc_bend_fold_nodes[j];
    const vsc_fold *fold = &folds[j];
    const vsc_wide3 p = v[node[0]], edge = vsc_wide_minus(v[node[1]], p);
    const vsc_wide3 s = vsc_wide_minus(v[node[2]], p), r = vsc_wide_minus(v[node[3]], p);
    rates[j] = fold->slope * (vsc_wide_dot(fold->on_s, s) + vsc_wide_dot(fold->on_r, r) -
                              fold->s_l * vsc_wide_dot(fold->on_s, edge) -
                              fold->r_l * vsc_wide_dot(fold->on_r, edge));
  }
}

// dtheta/d(p, q, s, r) of a fold, 1/mm.
VSC_INLINE void vsc_fold_gradient(const vsc_fold *fold, vsc_wide3 gradient[4])
{
  gradient[0] = vsc_wide_add(vsc_wide_scale(fold->s_l - 1.0, fold->on_s), vsc_wide_scale(fold->r_l - 1.0, fold->on_r));
  gradient[1] = vsc_wide_add(vsc_wide_scale(-fold->s_l, fold->on_s), vsc_wide_scale(-fold->r_l, fold->on_r));
  gradient[2] = fold->on_s;
  gradient[3] = fold->on_r;
}

// What the triangle on one side of a fold gives to the second derivative of theta. With u = dtheta/ds, f = s_l,
// sigma = -1, or u = dtheta/dr, f = r_l, sigma = 1, and t = u x (q - p)/l, e = (q - p)/l^2, motions change theta by
//   d2theta = sum_sides sigma [2 (u.y)(t.y) + (u.z)(t.z)/(l^2 u^2)] - 2 (e.y)(u.z),
//   y = ds - (1 - f) dp - f dq (or dr for ds),  z = dq - dp.
typedef struct vsc_fold_side {
  vsc_wide3 u, t, e;             // 1/mm
  vsc_wide y[3], z[3];           // of p, q, s (or r) in y and z
  vsc_wide leaning, along;       // sigma, sigma/(2 l^2 u^2)
} vsc_fold_side;

VSC_INLINE vsc_fold_side vsc_fold_side_of(const vsc_fold *fold, vsc_wide3 p, vsc_wide3 q, bool across)
{
  const vsc_wide3 edge = vsc_wide_minus(q, p), u = across ? fold->on_r : fold->on_s;
  const vsc_wide square = vsc_wide_dot(edge, edge), inverse = vsc_wide_inverse(square, VSC_LEAST_FOLD);
  const vsc_wide foot = across ? fold->r_l : fold->s_l, sigma = vsc_splat(across ? 1 : -1);
  return (vsc_fold_side){
      .u = u,
      .t = vsc_wide_cross(u, vsc_wide_scale(vsc_wide_sqrt(inverse), edge)),
      .e = vsc_wide_scale(inverse, edge),
      .y = {foot - 1.0, -foot, vsc_splat(1)},
      .z = {vsc_splat(-1), vsc_splat(1), vsc_splat(0)},
      .leaning = sigma,
      .along = 0.5 * sigma * inverse * vsc_wide_inverse(vsc_wide_dot(u, u), VSC_LEAST_FOLD)};
}

// m_k = sum_j G_kj change_j
VSC_INLINE void vsc_bend_moments(const vsc_bends *bends, const vsc_wide change[VSC_BEND_FOLDS],
                                 vsc_wide moment[3])
{
  for (int k = 0; k < 3; k++) {
    moment[k] = vsc_splat(0);
    for (int j = 0; j < VSC_BEND_FOLDS; j++) moment[k] += bends->G[k][j] * change[j];
  }
}

// |m|^2 of a change: twice the energy of phi - phi_0, or over tau the power of dphi/dt.
VSC_INLINE vsc_wide vsc_bend_square(const vsc_bends *bends, const vsc_wide change[VSC_BEND_FOLDS])
{
  vsc_wide m[3];
  vsc_bend_moments(bends, change, m);
  return m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
}

VSC_INLINE vsc_wide vsc_bend_energy(const vsc_bends *bends, const vsc_fold folds[VSC_BEND_FOLDS])
{
  vsc_wide change[VSC_BEND_FOLDS];
  for (int j = 0; j < VSC_BEND_FOLDS; j++) change[j] = folds[j].phi - bends->rest[j];
  return 0.5 * vsc_bend_square(bends, change);
}

// f = -dpsi/dx on the nodes, mN. `lead[j]` is added to phi_j: damping.
VSC_INLINE void vsc_bend_forces(const vsc_bends *bends, const vsc_fold folds[VSC_BEND_FOLDS],
                                const vsc_wide lead[VSC_BEND_FOLDS], vsc_wide3 f[VSC_BEND_NODES])
{
  vsc_wide change[VSC_BEND_FOLDS], m[3];
  for (int j = 0; j < VSC_BEND_FOLDS; j++) change[j] = folds[j].phi - bends->rest[j] + lead[j];
  vsc_bend_moments(bends, change, m);
  for (int i = 0; i < VSC_BEND_NODES; i++)
    f[i] = (vsc_wide3){vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    const vsc_fold *fold = &folds[j];
    const int *node = vsc_bend_fold_nodes[j];
    const vsc_wide torque =
        fold->slope * (bends->G[0][j] * m[0] + bends->G[1][j] * m[1] + bends->G[2][j] * m[2]);
    const vsc_wide3 on_s = vsc_wide_scale(-torque, fold->on_s);
    const vsc_wide3 on_r = vsc_wide_scale(-torque, fold->on_r);
    const vsc_wide one = vsc_splat(1);
    vsc_wide3 *p = &f[node[0]], *q = &f[node[1]], *s = &f[node[2]], *r = &f[node[3]];
    *s = vsc_wide_add(*s, on_s);
    *r = vsc_wide_add(*r, on_r);
    *p = vsc_wide_combine(one, *p, fold->s_l - 1.0, on_s, fold->r_l - 1.0, on_r);
    *q = vsc_wide_combine(one, *q, -fold->s_l, on_s, -fold->r_l, on_r);
  }
}

#endif
