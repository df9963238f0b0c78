// SPDX-License-Identifier: GPL-3.0-or-later
// The tangents of four triangles of a membrane and of four bends, as kernel_tangent.h has those of cells: exact for
// positions; of damping what velocities do, and its stress in the geometric part. Internal to mech; included by
// kernel_body.h.
#ifndef VSC_MECH_KERNEL_SURFACE_TANGENT_H
#define VSC_MECH_KERNEL_SURFACE_TANGENT_H

#include "mech/kernel_surface.h"
#include "mech/kernel_tangent.h"

// Where block (i, j), i >= j, stands.
VSC_INLINE vsc_wide *block_at(vsc_wide *K, int i, int j)
{
  return K + 9 * (i * (i + 1) / 2 + j);
}

// d(e_aa, e_bb, 2 e_ab) of a change of the axes.
VSC_INLINE void sheet_strain_rate(const vsc_wide3 g[2], const vsc_wide3 rate[2], vsc_wide strain[3])
{
  for (int a = 0; a < 2; a++) strain[a] = vsc_wide_dot(g[a], rate[a]);
  strain[2] = vsc_wide_dot(g[0], rate[1]) + vsc_wide_dot(g[1], rate[0]);
}

// S that the iterate before foretold: S + D de with de the linear strain of the step from it to g.
VSC_INLINE void foretell_sheet(const vsc_sheet_moduli *moduli, const vsc_wide3 former[2], const vsc_wide3 g[2],
                               vsc_wide S[3])
{
  vsc_sheet_answer before;
  vsc_wide step[3];
  const vsc_sheet_axes axes = vsc_sheet_axes_of(former);
  const vsc_wide3 moved[2] = {vsc_wide_minus(g[0], former[0]), vsc_wide_minus(g[1], former[1])};
  vsc_sheet_tangent(moduli, &axes, &before);
  sheet_strain_rate(former, moved, step);
  for (int k = 0; k < 3; k++)
    S[k] = before.S[k] + before.D[k][0] * step[0] + before.D[k][1] * step[1] + before.D[k][2] * step[2];
}

// S and D as the system weighs them: stiffness_factor for positions, damping_factor for velocities, with damping's
// S_aa += eta_a (dg_a/dt . g_a)/n_a^2.
VSC_INLINE void weigh_sheet(const vsc_patch_work *work, const vsc_triangle_pack *pack, const vsc_wide3 g[2],
                            vsc_sheet_answer *answer)
{
  const vsc_membrane *membrane = work->membrane;
  const vsc_sheet_axes axes = vsc_sheet_axes_of(g);
  vsc_wide3 former[2], rate[2];
  vsc_wide speed[3];
  vsc_sheet_tangent(&membrane->moduli, &axes, answer);
  if (work->before != NULL) {
    triangle_axes(pack, work->before, former);
    foretell_sheet(&membrane->moduli, former, g, answer->S);
  }
  for (int k = 0; k < 3; k++)
    for (int l = 0; l < 3; l++) answer->D[k][l] *= work->stiffness_factor;
  if (work->w != NULL) {
    triangle_axes(pack, work->w, rate);
    sheet_strain_rate(g, rate, speed);
    for (int a = 0; a < 2; a++) {
      const vsc_wide viscous = membrane->damping[a] * axes.inverse[a] * axes.inverse[a];
      answer->S[a] += viscous * speed[a];
      answer->D[a][a] += work->damping_factor * viscous;
    }
  }
  for (int k = 0; k < 3; k++) answer->S[k] *= work->stiffness_factor;
}

// K_ij = V [ sum_ab B_ai S_ab B_bj 1 + (de/dx_i)^T D (de/dx_j) ],  g_a = sum_i B_ai x_i
static void tangent_triangles(const vsc_patch_work *work, size_t k, vsc_wide *K)
{
  const vsc_triangle_pack *pack = (const vsc_triangle_pack *)work->packs + k;
  vsc_sheet_answer answer;
  vsc_wide3 g[2], strain[3][3];
  triangle_axes(pack, work->x, g);
  weigh_sheet(work, pack, g, &answer);
  vsc_wide B[2][3];
  for (int a = 0; a < 2; a++) {
    B[a][0] = -(pack->T[a][0] + pack->T[a][1]);
    for (int i = 0; i < 2; i++) B[a][i + 1] = pack->T[a][i];
  }
  for (int i = 0; i < 3; i++) {
    for (int a = 0; a < 2; a++) strain[i][a] = vsc_wide_scale(B[a][i], g[a]);
    strain[i][2] = vsc_wide_add(vsc_wide_scale(B[0][i], g[1]), vsc_wide_scale(B[1][i], g[0]));
  }
  for (int j = 0; j < 3; j++) {
    const vsc_wide *S = answer.S;
    const vsc_wide pull[2] = {pack->V * (S[0] * B[0][j] + S[2] * B[1][j]),
                              pack->V * (S[2] * B[0][j] + S[1] * B[1][j])};
    vsc_wide3 stress[3];
    for (int l = 0; l < 3; l++)
      stress[l] = vsc_wide_scale(pack->V, vsc_wide_combine(answer.D[l][0], strain[j][0], answer.D[l][1], strain[j][1],
                                                           answer.D[l][2], strain[j][2]));
    for (int i = j; i < 3; i++) {
      vsc_wide *block = block_at(K, i, j);
      const vsc_wide level = B[0][i] * pull[0] + B[1][i] * pull[1];
      for (int r = 0; r < 9; r++) block[r] = r % 4 == 0 ? level : vsc_splat(0);
      for (int l = 0; l < 3; l++) add_outer(strain[i][l], stress[l], block);
    }
  }
}

// K += torque d2theta of a fold with the nodes p, q, s, r.
VSC_INLINE void add_fold_curvature(const vsc_fold *fold, const vsc_wide3 x[VSC_BEND_NODES], vsc_wide torque,
                                   const int node[4], vsc_wide *K)
{
  for (int across = 0; across < 2; across++) {
    const vsc_fold_side side = vsc_fold_side_of(fold, x[node[0]], x[node[1]], across);
    const int own[3] = {node[0], node[1], node[2 + across]};
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        if (own[i] < own[j]) continue;
        vsc_wide *block = block_at(K, own[i], own[j]);
        const vsc_wide both = torque * (side.leaning * side.y[i] * side.y[j] + side.along * side.z[i] * side.z[j]);
        add_outer(vsc_wide_scale(both, side.u), side.t, block);
        add_outer(vsc_wide_scale(both, side.t), side.u, block);
        add_outer(vsc_wide_scale(-torque * side.y[i] * side.z[j], side.e), side.u, block);
        add_outer(vsc_wide_scale(-torque * side.z[i] * side.y[j], side.u), side.e, block);
      }
  }
}

// phi_j - phi_j0 with what damping leads by; where there is an iterate before, phi_j as it foretold.
VSC_INLINE void fold_changes(const vsc_patch_work *work, const vsc_bend_pack *pack,
                             const vsc_wide3 x[VSC_BEND_NODES], const vsc_fold folds[VSC_BEND_FOLDS],
                             vsc_wide change[VSC_BEND_FOLDS])
{
  vsc_wide3 moved[VSC_BEND_NODES];
  vsc_wide rates[VSC_BEND_FOLDS];
  for (int j = 0; j < VSC_BEND_FOLDS; j++) change[j] = folds[j].phi - pack->bends.rest[j];
  if (work->before != NULL) {
    vsc_wide3 former[VSC_BEND_NODES];
    vsc_fold before[VSC_BEND_FOLDS];
    for (int i = 0; i < VSC_BEND_NODES; i++) {
      former[i] = gather_corner(corner_of(pack->node[i], 0), work->before);
      moved[i] = vsc_wide_minus(x[i], former[i]);
    }
    vsc_bend_folds(former, before);
    vsc_bend_rates(before, moved, rates);
    for (int j = 0; j < VSC_BEND_FOLDS; j++) change[j] = before[j].phi + rates[j] - pack->bends.rest[j];
  }
  if (work->w == NULL) return;
  for (int i = 0; i < VSC_BEND_NODES; i++) moved[i] = gather_corner(corner_of(pack->node[i], 0), work->w);
  vsc_bend_rates(folds, moved, rates);
  for (int j = 0; j < VSC_BEND_FOLDS; j++) change[j] += work->membrane->lag * rates[j];
}

// K_ij = sum_k dm_k/dx_i (x) dm_k/dx_j + sum_j M_j d2phi_j,  M_j = sum_k G_kj m_k,
// d2phi = cos(theta/2) d2theta - phi/4 dtheta (x) dtheta
static void tangent_bends(const vsc_patch_work *work, size_t k, vsc_wide *K)
{
  const vsc_bend_pack *pack = (const vsc_bend_pack *)work->packs + k;
  const double factor = work->stiffness_factor + (work->w != NULL ? work->damping_factor * work->membrane->lag : 0);
  vsc_wide3 x[VSC_BEND_NODES], slope[3][VSC_BEND_NODES], gradient[4];
  vsc_fold folds[VSC_BEND_FOLDS];
  vsc_wide change[VSC_BEND_FOLDS], moment[3];
  for (int i = 0; i < VSC_BEND_NODES; i++) {
    x[i] = gather_corner(corner_of(pack->node[i], 0), work->x);
    for (int m = 0; m < 3; m++) slope[m][i] = wide_zero();
  }
  vsc_bend_folds(x, folds);
  fold_changes(work, pack, x, folds, change);
  vsc_bend_moments(&pack->bends, change, moment);
  for (int i = 0; i < 9 * VSC_BEND_NODES * (VSC_BEND_NODES + 1) / 2; i++) K[i] = vsc_splat(0);
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    const int *node = vsc_bend_fold_nodes[j];
    const vsc_wide G[3] = {pack->bends.G[0][j], pack->bends.G[1][j], pack->bends.G[2][j]};
    const vsc_wide torque =
        work->stiffness_factor * (G[0] * moment[0] + G[1] * moment[1] + G[2] * moment[2]);
    vsc_fold_gradient(&folds[j], gradient);
    add_fold_curvature(&folds[j], x, torque * folds[j].slope, node, K);
    for (int i = 0; i < 4; i++) {
      for (int m = 0; m < 3; m++)
        slope[m][node[i]] =
            vsc_wide_add(slope[m][node[i]], vsc_wide_scale(G[m] * folds[j].slope, gradient[i]));
      for (int l = 0; l < 4; l++)
        if (node[i] >= node[l])
          add_outer(vsc_wide_scale(-0.25 * torque * folds[j].phi, gradient[i]), gradient[l],
                    block_at(K, node[i], node[l]));
    }
  }
  for (int m = 0; m < 3; m++)
    for (int i = 0; i < VSC_BEND_NODES; i++)
      for (int j = 0; j <= i; j++)
        add_outer(vsc_wide_scale(vsc_splat(factor), slope[m][i]), slope[m][j], block_at(K, i, j));
}

#endif
