// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/smoothed.h"

#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "mech/force.h"
#include "mech/patch_nodes.h"

// What the pieces of a pass share.
typedef struct pass {
  const vsc_model *model;
  vsc_scratch *scratch;
  const double *x, *w;
  double time;
  double stiffness_factor, damping_factor;
  vsc_wide *tangent;
  vsc_edge_kernel *kernel;
  double *to;  // forces, node_count x 4
} pass;

// ---- tets

static void patch_gradients(void *context, size_t p, int thread)
{
  const pass *it = context;
  const vsc_patch *patch = &it->model->patches[p];
  if (!patch->smoothed) return;
  double *local = it->scratch->local + (size_t)thread * it->scratch->local_size;
  const size_t first = VSC_MATRIX * VSC_WIDTH * (size_t)patch->first_pack;
  vsc_patch_work work = {.packs = it->model->store + patch->packs,
                         .pack_count = patch->pack_count,
                         .smoothed = vsc_pack_smoothed(it->model, patch, patch->first_pack),
                         .x = local};
  vsc_gather_nodes(it->model, patch, it->x, local);
  work.gradient = it->scratch->gradient + first;
  vsc_gradient_kernel()(&work);
  if (it->w == NULL) return;
  vsc_gather_nodes(it->model, patch, it->w, local);
  work.gradient = it->scratch->rate + first;
  vsc_gradient_kernel()(&work);
}

void vsc_smoothed_gradients(const vsc_model *model, const double *x, const double *w,
                            vsc_scratch *scratch)
{
  pass it = {.model = model, .scratch = scratch, .x = x, .w = model->terms.damping ? w : NULL};
  vsc_parallel_for(model->patch_count, patch_gradients, &it);
}

static void patch_forces(void *context, size_t p, int thread)
{
  const pass *it = context;
  const vsc_patch *patch = &it->model->patches[p];
  double *local = it->scratch->local + (size_t)thread * it->scratch->local_size;
  memset(local, 0, 4 * (patch->own_count + patch->shared_count) * sizeof *local);
  if (patch->smoothed) {
    const vsc_patch_work work = {
        .packs = it->model->store + patch->packs,
        .pack_count = patch->pack_count,
        .smoothed = vsc_pack_smoothed(it->model, patch, patch->first_pack),
        .edge_stress = it->scratch->edge_stress,
        .f = local};
    vsc_edge_force_kernel()(&work);
  }
  vsc_put_forces(patch, local, it->to, it->scratch->partial);
}

// ---- edges

vsc_edge_work vsc_edge_work_of(const vsc_model *model, size_t b, const vsc_scratch *scratch)
{
  const vsc_smoothing *smoothing = &model->smoothing;
  const vsc_edge_block *block = &smoothing->blocks[b];
  const vsc_material *material = &model->materials[block->material];
  const size_t first = VSC_WIDTH * (size_t)block->first_pack;
  return (vsc_edge_work){.frames = smoothing->frames + block->first_pack,
                         .pack_count = block->pack_count,
                         .start = smoothing->start + first,
                         .slot = smoothing->slot,
                         .weight = smoothing->weight,
                         .gradient = scratch->gradient,
                         .material = material,
                         .axes = model->axes + material->first_axis,
                         .pairs = model->pairs + material->first_pair,
                         .stress = scratch->edge_stress + VSC_MATRIX * first};
}

// Activations of the block's edges at this time: one number when all agree. Returns the stride.
static size_t fill_activation(const pass *it, const vsc_edge_work *work, size_t first,
                              vsc_wide *activation)
{
  const vsc_smoothing *smoothing = &it->model->smoothing;
  const bool alike = smoothing->amplitude == NULL && smoothing->delay == NULL;
  if (work->material->active == VSC_ACTIVE_NONE || alike) {
    double value = 0;
    if (work->material->active != VSC_ACTIVE_NONE)
      value = vsc_model_edge_activation(it->model, work->material, 0, it->time);
    activation[0] = vsc_splat(it->scratch->load * value);
    return 0;
  }
  for (size_t e = 0; e < VSC_WIDTH * work->pack_count; e++)
    activation[e / VSC_WIDTH][e % VSC_WIDTH] =
        it->scratch->load *
        vsc_model_edge_activation(it->model, work->material, first + e, it->time);
  return 1;
}

static void block_work(void *context, size_t b, int thread)
{
  (void)thread;
  const pass *it = context;
  const vsc_edge_block *block = &it->model->smoothing.blocks[b];
  vsc_wide activation[VSC_MOST_EDGE_PACKS];
  vsc_edge_work work = vsc_edge_work_of(it->model, b, it->scratch);
  work.activation = activation;
  work.activation_stride =
      fill_activation(it, &work, VSC_WIDTH * (size_t)block->first_pack, activation);
  if (it->w != NULL && work.material->damped) work.rate = it->scratch->rate;
  work.stiffness_factor = it->stiffness_factor;
  work.damping_factor = it->damping_factor;
  if (it->tangent != NULL) work.tangent = it->tangent + VSC_EDGE_TANGENT * (size_t)block->first_pack;
  it->kernel(&work);
}

void vsc_smoothed_stress(const vsc_model *model, const double *x, const double *w, double time,
                         vsc_scratch *scratch)
{
  pass it = {.model = model, .scratch = scratch, .w = w, .time = time,
             .kernel = vsc_edge_stress_kernel()};
  vsc_smoothed_gradients(model, x, w, scratch);
  vsc_parallel_for(model->smoothing.block_count, block_work, &it);
}

// ---- the tangent

vsc_scratch *vsc_smoothed_create(const vsc_model *model)
{
  vsc_scratch *made;
  if (!VSC_NEW(made, 1)) return NULL;
  made->local_size = (4 * model->most_nodes + 7) / 8 * 8;
  if (VSC_NEW(made->local, (size_t)vsc_parallel_threads() * made->local_size) &&
      VSC_NEW(made->partial, 4 * model->partial_count) &&
      VSC_NEW(made->predicted, 4 * model->node_count) &&
      VSC_NEW(made->gradient, VSC_MATRIX * VSC_WIDTH * model->pack_count) &&
      VSC_NEW(made->edge_stress, VSC_MATRIX * VSC_WIDTH * model->smoothing.pack_count))
    return made;
  vsc_smoothed_free(made);
  return NULL;
}

void vsc_smoothed_free(vsc_scratch *scratch)
{
  if (scratch == NULL) return;
  vsc_free(scratch->local);
  vsc_free(scratch->partial);
  vsc_free(scratch->predicted);
  vsc_free(scratch->gradient);
  vsc_free(scratch->edge_stress);
  vsc_free(scratch);
}

void vsc_smoothed_tangent(const vsc_model *model, const double *x, const double *w, double time,
                          double stiffness_factor, double damping_factor, vsc_scratch *scratch,
                          vsc_wide *tangent)
{
  pass it = {.model = model,
             .scratch = scratch,
             .w = w,
             .time = time,
             .stiffness_factor = stiffness_factor,
             .damping_factor = damping_factor,
             .tangent = tangent,
             .kernel = vsc_edge_tangent_kernel()};
  vsc_smoothed_gradients(model, x, w, scratch);
  vsc_parallel_for(model->smoothing.block_count, block_work, &it);
}

void vsc_smoothed_times(const vsc_model *model, const vsc_wide *tangent, vsc_scratch *scratch,
                        const double *x, double *y)
{
  pass it = {.model = model,
             .scratch = scratch,
             .tangent = (vsc_wide *)(uintptr_t)tangent,
             .kernel = vsc_edge_product_kernel(),
             .to = scratch->predicted};
  vsc_smoothed_gradients(model, x, NULL, scratch);
  vsc_parallel_for(model->smoothing.block_count, block_work, &it);
  vsc_parallel_for(model->patch_count, patch_forces, &it);
  vsc_sum_shared(model, scratch->partial, it.to);
  // the force is minus the product
  for (size_t i = 0; i < 4 * model->node_count; i++) y[i] -= it.to[i];
}

// The mean of the edges' tangents of one tet, whole: A[3 i + r][3 j + s] = dP_ri/dF_sj.
static void mean_tangent(const vsc_smoothed_pack *pack, int lane, const vsc_wide *tangent,
                         double A[9][9])
{
  memset(A, 0, 81 * sizeof A[0][0]);
  for (int e = 0; e < VSC_TET_EDGES; e++) {
    const uint32_t edge = pack->edge[e][lane];
    const vsc_wide *K = tangent + VSC_EDGE_TANGENT * (size_t)(edge / VSC_WIDTH);
    for (int i = 0; i < 3; i++)
      for (int j = 0; j <= i; j++)
        for (int r = 0; r < 3; r++)
          for (int s = 0; s < 3; s++)
            A[3 * i + r][3 * j + s] +=
                K[9 * (i * (i + 1) / 2 + j) + 3 * r + s][edge % VSC_WIDTH] / VSC_TET_EDGES;
  }
  for (int i = 0; i < 9; i++)
    for (int j = i + 1; j < 9; j++)
      if (j / 3 > i / 3) A[i][j] = A[j][i];
}

// K_ij += V sum_cd (grad N_i)_c A_cd (grad N_j)_d of one tet with the nodes `node`.
static void add_tet(const double gradient[4][3], double V, const double A[9][9],
                    const uint32_t node[4], vsc_block_matrix *matrix)
{
  for (int j = 0; j < 4; j++) {
    double half[9][3] = {{0}};  // A_cd (grad N_j)_d
    for (int c = 0; c < 9; c++)
      for (int d = 0; d < 9; d++) half[c][d % 3] += A[c][d] * gradient[j][d / 3];
    for (int i = 0; i < 4; i++) {
      if (node[i] < node[j]) continue;
      double K[9] = {0};
      for (int c = 0; c < 9; c++)
        for (int s = 0; s < 3; s++) K[3 * (c % 3) + s] += gradient[i][c / 3] * half[c][s];
      vsc_block_matrix_add(matrix, node[i], node[j], V, K);
    }
  }
}

void vsc_smoothed_precondition(const vsc_model *model, const vsc_wide *tangent,
                               vsc_block_matrix *matrix)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!patch->smoothed) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        if (model->mesh_element[VSC_WIDTH * k + (size_t)l] == VSC_NO_ELEMENT) continue;
        const vsc_smoothed_pack *pack = vsc_pack_smoothed(model, patch, k);
        const vsc_frame *frame = vsc_pack_frames(model, patch, k);
        double A[9][9], gradient[4][3] = {{0}};
        uint32_t node[4];
        for (int i = 0; i < 4; i++)
          node[i] = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[i][l]);
        // grad N_i = sum_a B_ai a
        for (int c = 0; c < 3; c++)
          for (int i = 1; i < 4; i++) {
            for (int a = 0; a < 3; a++)
              gradient[i][c] += frame->T[a][i - 1][l] * pack->axes[a][c][l];
            gradient[0][c] -= gradient[i][c];
          }
        mean_tangent(pack, l, tangent, A);
        add_tet(gradient, frame->V[l], A, node, matrix);
      }
  }
}
