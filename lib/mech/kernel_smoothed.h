// SPDX-License-Identifier: GPL-3.0-or-later
// Edge-smoothed tets (model/smoothing.h): F of the tets, stresses of the edges, forces of the tets.
// Matrices F and P are kept by columns of four numbers, so that one element's fill three vectors.
// Internal to mech; included by kernel_body.h.
#ifndef VSC_MECH_KERNEL_SMOOTHED_H
#define VSC_MECH_KERNEL_SMOOTHED_H

#include "mech/kernel_tangent.h"
#include "mech/kernel_tets.h"
#include "mech/smoothed.h"

// Writes column `column` of four matrices.
VSC_INLINE void store_column(vsc_wide3 of_four, int column, double *matrices)
{
  vsc_wide lane[VSC_WIDTH];
  vsc_wide_rows(of_four, lane);
  for (int l = 0; l < VSC_WIDTH; l++)
    *(vsc_wide *)(matrices + VSC_MATRIX * l + 4 * column) = lane[l];
}

// F = sum_a g_a (x) a
static void gradient_kernel(const vsc_patch_work *work)
{
  const vsc_pack *packs = work->packs;
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_wide(*axes)[3] = work->smoothed[k].axes;
    vsc_wide3 edge[3], g[3];
    gather_edges(&packs[k], 0, work->x, edge);
    frame_axes(&packs[k], 0, edge, g);
    for (int c = 0; c < 3; c++)
      store_column(vsc_wide_combine(axes[0][c], g[0], axes[1][c], g[1], axes[2][c], g[2]), c,
                   work->gradient + VSC_MATRIX * VSC_WIDTH * k);
  }
}

// P_a = P a of four tets, P = sum over their edges of P_e/6.
VSC_INLINE void gather_edge_stress(const vsc_smoothed_pack *pack, const double *edge_stress,
                                   vsc_wide3 P[3])
{
  vsc_wide3 column[3];
  for (int c = 0; c < 3; c++) {
    vsc_wide lane[VSC_WIDTH];
    for (int l = 0; l < VSC_WIDTH; l++) {
      lane[l] = vsc_splat(0);
      for (int e = 0; e < VSC_TET_EDGES; e++)
        lane[l] += *(const vsc_wide *)(edge_stress + VSC_MATRIX * (size_t)pack->edge[e][l] + 4 * c);
      lane[l] *= 1.0 / VSC_TET_EDGES;
    }
    vsc_transpose(&lane[0], &lane[1], &lane[2], &lane[3]);
    column[c] = (vsc_wide3){lane[0], lane[1], lane[2]};
  }
  for (int a = 0; a < 3; a++)
    P[a] = vsc_wide_combine(pack->axes[a][0], column[0], pack->axes[a][1], column[1],
                            pack->axes[a][2], column[2]);
}

// Forces of the edges' stresses, with `volume` the volume's too.
VSC_INLINE void smoothed_kernel(const vsc_patch_work *work, bool volume, bool nodal)
{
  const vsc_pack *packs = work->packs;
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_pack *pack = &packs[k];
    vsc_wide3 P[3];
    gather_edge_stress(&work->smoothed[k], work->edge_stress, P);
    if (volume) {
      vsc_wide3 g[3], cofactor[3];
      gather_axes(work, k, work->x, g);
      const vsc_wide J = cofactor_of(g, cofactor);
      vsc_wide p = vsc_volume_stress(moduli_of(work, k, false).element_modulus, J);
      if (nodal) p += mean_pressure(pack, 0, work->pressure);
      add_pressure(p, cofactor, P);
    }
    scatter_forces(pack, 0, P, work->f);
  }
}

static void force_smoothed_0(const vsc_patch_work *work)
{
  smoothed_kernel(work, true, false);
}

static void force_smoothed_1(const vsc_patch_work *work)
{
  smoothed_kernel(work, true, true);
}

static void edge_force_kernel(const vsc_patch_work *work)
{
  smoothed_kernel(work, false, false);
}

// ---- edges

VSC_INLINE vsc_law_input edge_law(const vsc_edge_work *work, size_t k)
{
  return (vsc_law_input){.material = work->material,
                         .axes = work->axes,
                         .pairs = work->pairs,
                         .moduli = vsc_moduli_or(work->material, NULL),
                         .activation = work->activation[k * work->activation_stride]};
}

static void edge_stress_kernel(const vsc_edge_work *work)
{
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_wide(*axes)[3] = work->frames[k].axes;
    const vsc_law_input in = edge_law(work, k);
    vsc_wide3 g[3], rate[3], P[3], cofactor[3];
    vsc_edge_axes(work, k, work->gradient, g);
    if (work->rate != NULL) vsc_edge_axes(work, k, work->rate, rate);
    law_frame(&in, g, work->rate != NULL ? rate : NULL, P);
    const vsc_wide J = cofactor_of(g, cofactor);
    add_pressure(law_pressure(in.material, vsc_splat(0), J), cofactor, P);
    // P_e = sum_a P_a (x) a
    for (int c = 0; c < 3; c++)
      store_column(vsc_wide_combine(axes[0][c], P[0], axes[1][c], P[1], axes[2][c], P[2]), c,
                   work->stress + VSC_MATRIX * VSC_WIDTH * k);
  }
}

// dP_e/dF_e: F's columns are to an edge what corners are to a cell, with B_ac the axis a's
// coordinate c.
static void edge_tangent_kernel(const vsc_edge_work *work)
{
  static const double unit[3][VSC_MOST_CORNERS] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_law_input in = edge_law(work, k);
    vsc_wide *K = work->tangent + VSC_EDGE_TANGENT * k;
    vsc_frame frame;
    tangent_frame open;
    vsc_wide3 g[3], rate[3];
    vsc_law_answer answer;
    memcpy(frame.T, work->frames[k].axes, sizeof frame.T);
    vsc_edge_axes(work, k, work->gradient, g);
    if (work->rate != NULL) vsc_edge_axes(work, k, work->rate, rate);
    open_frame(&frame, unit, 3, g, &open);
    weigh_answer(work->stiffness_factor, work->damping_factor, &in, g, NULL,
                 work->rate != NULL ? rate : NULL, &answer);
    for (int i = 0; i < VSC_EDGE_TANGENT; i++) K[i] = vsc_splat(0);
    const vsc_wide rest = vsc_splat(work->material->rest_shear);
    add_frame_tangent(&open, &answer, vsc_splat(1),
                      work->stiffness_factor * vsc_rest_stress(rest, open.J),
                      work->stiffness_factor * vsc_rest_curvature(rest, open.J), 3, K);
  }
}

// a += K b, or a += K^T b
VSC_INLINE void add_block_product(const vsc_wide K[9], bool turned, vsc_wide3 b, vsc_wide3 *a)
{
  const int row = turned ? 1 : 3, column = turned ? 3 : 1;
  a->x += K[0] * b.x + K[column] * b.y + K[2 * column] * b.z;
  a->y += K[row] * b.x + K[row + column] * b.y + K[row + 2 * column] * b.z;
  a->z += K[2 * row] * b.x + K[2 * row + column] * b.y + K[2 * row + 2 * column] * b.z;
}

static void edge_product_kernel(const vsc_edge_work *work)
{
  for (size_t k = 0; k < work->pack_count; k++) {
    const vsc_wide *K = work->tangent + VSC_EDGE_TANGENT * k;
    vsc_wide3 F[3];
    vsc_edge_gradient(work, k, work->gradient, F);
    for (int i = 0; i < 3; i++) {
      vsc_wide3 P = wide_zero();
      for (int j = 0; j < 3; j++) {
        const int low = i < j ? i : j, high = i < j ? j : i;
        add_block_product(K + 9 * (high * (high + 1) / 2 + low), i < j, F[j], &P);
      }
      store_column(P, i, work->stress + VSC_MATRIX * VSC_WIDTH * k);
    }
  }
}

#endif
