// SPDX-License-Identifier: GPL-3.0-or-later
// The passes of edge-smoothed tets (model/smoothing.h): F of each tet, from it the stress of each edge,
// which the tets' force kernels put on their nodes. Internal to mech.
#ifndef VSC_MECH_SMOOTHED_H
#define VSC_MECH_SMOOTHED_H

#include "mech/block_matrix.h"
#include "mech/kernel.h"
#include "mech/state.h"

enum { VSC_MATRIX = 12 };  // numbers of a matrix: three columns of four, the fourth 0

// The mean of the tets' matrices `of_tets` over the tets of each of four edges, by columns.
VSC_INLINE void vsc_edge_gradient(const vsc_edge_work *work, size_t k, const double *of_tets,
                                  vsc_wide3 F[3])
{
  vsc_wide column[3][VSC_WIDTH];
  for (size_t l = 0; l < VSC_WIDTH; l++) {
    vsc_wide sum[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
    for (size_t t = work->start[VSC_WIDTH * k + l]; t < work->start[VSC_WIDTH * k + l + 1]; t++) {
      const vsc_wide *of_tet = (const vsc_wide *)(of_tets + VSC_MATRIX * (size_t)work->slot[t]);
      for (int c = 0; c < 3; c++) sum[c] += work->weight[t] * of_tet[c];
    }
    for (int c = 0; c < 3; c++) column[c][l] = sum[c];
  }
  for (int c = 0; c < 3; c++) {
    vsc_transpose(&column[c][0], &column[c][1], &column[c][2], &column[c][3]);
    F[c] = (vsc_wide3){column[c][0], column[c][1], column[c][2]};
  }
}

// g_a = F_e a of four edges; with `of_tets` the rates dF/dt: dg_a/dt.
VSC_INLINE void vsc_edge_axes(const vsc_edge_work *work, size_t k, const double *of_tets,
                              vsc_wide3 g[3])
{
  const vsc_wide(*axes)[3] = work->frames[k].axes;
  vsc_wide3 F[3];
  vsc_edge_gradient(work, k, of_tets, F);
  for (int a = 0; a < 3; a++)
    g[a] = vsc_wide_combine(axes[a][0], F[0], axes[a][1], F[1], axes[a][2], F[2]);
}

// F of all smoothed tets at x, and their dF/dt where w is not NULL (both node_count x 4), into the scratch.
void vsc_smoothed_gradients(const vsc_model *model, const double *x, const double *w,
                            vsc_scratch *scratch);

// P_e of all edges at x, w (NULL: without damping) and `time`, into the scratch's edge_stress.
void vsc_smoothed_stress(const vsc_model *model, const double *x, const double *w, double time,
                         vsc_scratch *scratch);

// What block `b` of edges works on, but for its activation; gradients are the scratch's.
vsc_edge_work vsc_edge_work_of(const vsc_model *model, size_t b, const vsc_scratch *scratch);

// Memory for products, with what they use only; NULL when there is not enough.
vsc_scratch *vsc_smoothed_create(const vsc_model *model);
void vsc_smoothed_free(vsc_scratch *scratch);  // NULL is fine

// `tangent` (VSC_EDGE_TANGENT wide numbers for each pack of edges): a dP_e/dF_e + b dP_e/d(dF_e/dt),
// kPa, at x, w and `time`, with a the stiffness_factor and b the damping_factor.
void vsc_smoothed_tangent(const vsc_model *model, const double *x, const double *w, double time,
                          double stiffness_factor, double damping_factor, vsc_scratch *scratch,
                          vsc_wide *tangent);

// y += A x, A the edges' part of the tangent; x, y node_count x 4. `scratch` is one of
// vsc_smoothed_create.
void vsc_smoothed_times(const vsc_model *model, const vsc_wide *tangent, vsc_scratch *scratch,
                        const double *x, double *y);

// Adds to `matrix` what A would be if each tet had the mean tangent of its edges: the pattern of the tets.
void vsc_smoothed_precondition(const vsc_model *model, const vsc_wide *tangent,
                               vsc_block_matrix *matrix);

#endif
