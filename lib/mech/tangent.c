// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/tangent.h"

#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "mech/force.h"
#include "mech/kernel.h"
#include "mech/loads.h"
#include "mech/mass_matrix.h"
#include "mech/prony.h"
#include "mech/smoothed.h"
#include "model/law_volume.h"

// Nodes of any part, and their pairs.
enum { MOST_NODES = VSC_BEND_NODES, MOST_PAIRS = MOST_NODES * (MOST_NODES + 1) / 2 };
_Static_assert((int)MOST_NODES >= (int)VSC_MOST_CORNERS, "bends have the most nodes");

// How much of each group's volume stiffness is put on its elements (numerics: 0.3 to 1 will do).
#define GROUP_ON_ELEMENTS 0.3

static bool has_tangent(const vsc_model *model, const vsc_patch *patch)
{
  if (vsc_patch_is_surface(patch)) return true;
  return vsc_patch_is_solid(patch) && model->materials[patch->material].law != VSC_LAW_CLASSICAL &&
         model->materials[patch->material].law != VSC_LAW_PAPER;
}

static vsc_status refuse(vsc_error *error, const char *what, const char *remedy)
{
  return vsc_fail(error, VSC_INPUT, "solve: %s can only be stepped explicitly yet; use solve: explicit, or %s",
                  what, remedy);
}

static vsc_status check(const vsc_model *model, vsc_error *error)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    if (!has_tangent(model, &model->patches[p]))
      return refuse(error, "law: paper or classical", "law: springs");
  }
  return VSC_OK;
}

// Whether a place of a patch may add to the tangent; of empty triangles and bends the blocks are 0.
static bool is_taken(const vsc_model *model, const vsc_patch *patch, size_t slot)
{
  return vsc_patch_is_surface(patch) || model->mesh_element[slot] != VSC_NO_ELEMENT;
}

static int pair_count(const vsc_patch *patch)
{
  const int corners = vsc_family_corners(patch->family);
  return corners * (corners + 1) / 2;
}

// ---- the pattern

// All elements' nodes as one list of groups.
static bool list_elements(const vsc_model *model, size_t **group, uint32_t **nodes, size_t *count)
{
  size_t elements = 0, corners = 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    elements += VSC_WIDTH * (size_t)model->patches[p].pack_count;
    corners += VSC_WIDTH * (size_t)model->patches[p].pack_count *
               (size_t)vsc_family_corners(model->patches[p].family);
  }
  *nodes = NULL;
  if (!VSC_NEW(*group, elements + 1) || !VSC_NEW(*nodes, corners)) return false;
  size_t e = 0, at = 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        if (!is_taken(model, patch, VSC_WIDTH * k + (size_t)l)) continue;
        for (int c = 0; c < vsc_family_corners(patch->family); c++)
          (*nodes)[at++] = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[c][l]);
        (*group)[++e] = at;
      }
  }
  *count = e;
  return true;
}

// The place of each block of each element in the matrix.
static bool find_places(const vsc_model *model, vsc_tangent *tangent)
{
  size_t count = 0;
  if (!VSC_NEW(tangent->first_place, model->patch_count)) return false;
  for (size_t p = 0; p < model->patch_count; p++) {
    tangent->first_place[p] = count;
    count += VSC_WIDTH * (size_t)pair_count(&model->patches[p]) * model->patches[p].pack_count;
  }
  if (!VSC_NEW(tangent->places, count)) return false;
  size_t at = 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int i = 0; i < vsc_family_corners(patch->family); i++)
        for (int j = 0; j <= i; j++)
          for (int l = 0; l < VSC_WIDTH; l++, at++) {
            const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
            const uint32_t a = vsc_node_of(model, patch, node[i][l]);
            const uint32_t b = vsc_node_of(model, patch, node[j][l]);
            if (!is_taken(model, patch, VSC_WIDTH * k + (size_t)l)) continue;
            tangent->places[at] = (uint32_t)vsc_block_matrix_find(&tangent->matrix, a > b ? a : b,
                                                                  a > b ? b : a);
          }
  }
  return true;
}

// Greedy colours of the patches, in their order: a patch takes the first colour that none of its nodes
// has yet. The 64 colours of a node are the bits of a word; patches that find none are done one by one.
static bool color_patches(const vsc_model *model, vsc_tangent *tangent)
{
  enum { MOST_COLORS = 64 };
  uint64_t *taken;
  uint32_t *color, next = MOST_COLORS;
  bool made = VSC_NEW(taken, model->node_count);
  made = VSC_NEW(color, model->patch_count) && made;
  made = VSC_NEW(tangent->colored, model->patch_count) && made;
  for (uint32_t p = 0; made && p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    const uint32_t *shared = model->shared + patch->first_shared;
    uint64_t used = 0;
    for (uint32_t n = 0; n < patch->shared_count; n++) used |= taken[shared[n]];
    color[p] = ~used ? (uint32_t)__builtin_ctzll(~used) : next++;
    for (uint32_t n = 0; n < patch->shared_count && color[p] < MOST_COLORS; n++)
      taken[shared[n]] |= UINT64_C(1) << color[p];
  }
  made = made && VSC_NEW(tangent->color_start, (size_t)next + 1);
  uint32_t at = 0;
  for (uint32_t c = 0; made && c < next; c++) {
    for (uint32_t p = 0; p < model->patch_count; p++)
      if (color[p] == c) tangent->colored[at++] = p;
    if (at > tangent->color_start[tangent->color_count])
      tangent->color_start[++tangent->color_count] = at;
  }
  vsc_free(taken);
  vsc_free(color);
  return made;
}

// The nodes of each node's group: those of the tets round it that share their volume.
static bool list_groups(const vsc_model *model, vsc_tangent *tangent)
{
  const vsc_block_matrix *matrix = &tangent->matrix;
  const size_t nodes = model->node_count;
  size_t *at;
  if (!VSC_NEW(tangent->group_start, nodes + 1) || !VSC_NEW(at, nodes)) return false;
  // a node's neighbours in the pattern are a group; both triangles count
  for (size_t j = 0; j < nodes; j++)
    for (size_t k = matrix->start[j]; k < matrix->start[j + 1]; k++) {
      tangent->group_start[j + 1]++;
      if (matrix->row[k] != j) tangent->group_start[matrix->row[k] + 1]++;
    }
  for (size_t n = 0; n < nodes; n++) {
    tangent->group_start[n + 1] += tangent->group_start[n];
    at[n] = tangent->group_start[n];
  }
  const size_t count = tangent->group_start[nodes];
  const bool made = VSC_NEW(tangent->group_node, count) &&
                    VSC_NEW(tangent->group_gradient, 3 * count) &&
                    VSC_NEW(tangent->group_weight, nodes) && VSC_NEW(tangent->group_change, nodes);
  for (uint32_t j = 0; made && j < nodes; j++)
    for (size_t k = matrix->start[j]; k < matrix->start[j + 1]; k++) {
      const uint32_t i = matrix->row[k];
      tangent->group_node[at[j]++] = i;
      if (i != j) tangent->group_node[at[i]++] = j;
    }
  vsc_free(at);
  return made;
}

vsc_status vsc_tangent_create(const vsc_model *model, vsc_tangent **tangent, vsc_error *error)
{
  vsc_tangent *made;
  *tangent = NULL;
  const vsc_status status = check(model, error);
  if (status != VSC_OK) return status;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "the tangent");
  size_t *group = NULL, count;
  uint32_t *nodes = NULL;
  bool good = list_elements(model, &group, &nodes, &count) &&
              vsc_block_matrix_create(model->node_count, count, group, nodes, &made->matrix) &&
              find_places(model, made) && color_patches(model, made);
  made->model = model;
  made->preconditioner = made->matrix;
  if (good && (model->terms.nodal_volume || model->terms.smoothed))
    good = VSC_NEW(made->preconditioner.values, 9 * made->matrix.start[model->node_count]);
  if (good && model->terms.nodal_volume) good = list_groups(model, made);
  if (good && model->masses == VSC_MASS_CONSISTENT)
    good = vsc_mass_matrix(model, &made->matrix, &made->masses);
  if (good && model->terms.smoothed)
    good = VSC_NEW(made->edges, VSC_EDGE_TANGENT * model->smoothing.pack_count) &&
           (made->space = vsc_smoothed_create(model)) != NULL;
  vsc_free(group);
  vsc_free(nodes);
  if (!good) {
    vsc_tangent_free(made);
    return vsc_fail_memory(error, "the tangent");
  }
  *tangent = made;
  return VSC_OK;
}

void vsc_tangent_free(vsc_tangent *tangent)
{
  if (tangent == NULL) return;
  if (tangent->preconditioner.values != tangent->matrix.values)
    vsc_free(tangent->preconditioner.values);
  vsc_block_matrix_free(&tangent->matrix);
  vsc_free(tangent->places);
  vsc_free(tangent->first_place);
  vsc_free(tangent->color_start);
  vsc_free(tangent->colored);
  vsc_free(tangent->masses);
  vsc_free(tangent->group_start);
  vsc_free(tangent->group_node);
  vsc_free(tangent->group_gradient);
  vsc_free(tangent->group_weight);
  vsc_free(tangent->group_change);
  vsc_free(tangent->edges);
  vsc_smoothed_free(tangent->space);
  vsc_free(tangent);
}

// ---- assembly

typedef struct assembly {
  const vsc_model *model;
  vsc_tangent *tangent;
  const double *x, *w, *before;
  double time, stiffness_factor, damping_factor;
  vsc_scratch *scratch;
  const uint32_t *patches;  // of one colour
} assembly;

// Block (i, j) of corners i >= j of one element, of the nodes a, b, goes to their place; `turned`: its transpose does.
static void add_block(vsc_tangent *tangent, uint32_t a, uint32_t b, uint32_t place,
                      const vsc_wide *K, int l, bool turned)
{
  size_t stride;
  double *to = vsc_block_at(&tangent->matrix, a < b ? a : b, place, &stride);
  for (size_t c = 0; c < 3; c++)
    for (size_t r = 0; r < 3; r++)
      to[stride * c + r] += turned ? K[3 * c + r][l] : K[3 * r + c][l];
}

static void scatter_pack(const assembly *a, size_t p, size_t k, int corners, const vsc_wide *K)
{
  const vsc_model *model = a->model;
  const vsc_patch *patch = &model->patches[p];
  const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
  const uint32_t *place = a->tangent->places + a->tangent->first_place[p] +
                          (k - patch->first_pack) * VSC_WIDTH * (size_t)pair_count(patch);
  for (int l = 0; l < VSC_WIDTH; l++) {
    if (!is_taken(model, patch, VSC_WIDTH * k + (size_t)l)) continue;
    uint32_t number[MOST_NODES];
    for (int c = 0; c < corners; c++) number[c] = vsc_node_of(model, patch, node[c][l]);
    int pair = 0;
    for (int i = 0; i < corners; i++)
      for (int j = 0; j <= i; j++, pair++) {
        const uint32_t at = place[VSC_WIDTH * pair + l];
        add_block(a->tangent, number[i], number[j], at, K + 9 * pair, l, number[i] < number[j]);
        // round a node of few triangles a bend has one node in two places
        if (i != j && number[i] == number[j])
          add_block(a->tangent, number[i], number[j], at, K + 9 * pair, l, true);
      }
  }
}

static void assemble_patch(void *context, size_t piece, int thread)
{
  const assembly *a = context;
  const size_t p = a->patches[piece];
  const vsc_patch *patch = &a->model->patches[p];
  if (patch->still) return;
  vsc_patch_work work =
      vsc_patch_prepare(a->model, patch, a->x, a->w, a->before, a->time, a->scratch, thread);
  work.stiffness_factor = a->stiffness_factor;
  work.damping_factor = a->damping_factor;
  vsc_tangent_kernel *kernel = vsc_family_tangent(patch->family);
  const bool relaxes = vsc_patch_is_solid(patch) && work.material->branch_count > 0;
  vsc_wide K[9 * MOST_PAIRS], past[VSC_MOST_POINTS][6];
  if (relaxes) work.past = (const vsc_wide(*)[6])past;
  for (uint32_t k = 0; k < patch->pack_count; k++) {
    if (relaxes)
      work.loss = vsc_prony_past(a->model, patch, patch->first_pack + k, a->scratch->prony,
                                 a->scratch->prony_step, past);
    kernel(&work, k, K);
    scatter_pack(a, p, patch->first_pack + k, vsc_family_corners(patch->family), K);
  }
}

// ---- volumes shared by the tets round a node

// d v_e/dx_i of the tet with corners x: the opposite face's area vector over 3.
static void volume_gradients(const double *x[4], double gradient[4][3])
{
  static const int opposite[4][3] = {{1, 3, 2}, {0, 2, 3}, {0, 3, 1}, {0, 1, 2}};
  for (int c = 0; c < 4; c++) {
    const double *a = x[opposite[c][0]], *b = x[opposite[c][1]], *d = x[opposite[c][2]];
    double ab[3], ad[3], n[3];
    for (int i = 0; i < 3; i++) {
      ab[i] = b[i] - a[i];
      ad[i] = d[i] - a[i];
    }
    n[0] = ab[1] * ad[2] - ab[2] * ad[1];
    n[1] = ab[2] * ad[0] - ab[0] * ad[2];
    n[2] = ab[0] * ad[1] - ab[1] * ad[0];
    for (int i = 0; i < 3; i++) gradient[c][i] = -n[i] / 6;
  }
}

static double *group_entry(const vsc_tangent *tangent, uint32_t group, uint32_t node)
{
  size_t k = tangent->group_start[group];
  while (tangent->group_node[k] != node) k++;
  return tangent->group_gradient + 3 * k;
}

static void add_tet_to_groups(const vsc_model *model, vsc_tangent *tangent, const uint32_t *node,
                              double volume, const double *x)
{
  (void)model;
  (void)volume;
  const double *corner[4];
  double gradient[4][3];
  for (int c = 0; c < 4; c++) corner[c] = x + 4 * (size_t)node[c];
  volume_gradients(corner, gradient);
  for (int c = 0; c < 4; c++)
    for (int d = 0; d < 4; d++) {
      double *entry = group_entry(tangent, node[c], node[d]);
      for (int i = 0; i < 3; i++) entry[i] += gradient[d][i] / 4;
    }
}

// Calls work for each tet that shares its volume.
static void for_sharing_tets(const vsc_model *model, vsc_tangent *tangent, const double *x,
                             void (*work)(const vsc_model *, vsc_tangent *, const uint32_t *, double,
                                          const double *))
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_shares_volume(model, patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        if (model->mesh_element[VSC_WIDTH * k + (size_t)l] == VSC_NO_ELEMENT) continue;
        uint32_t node[4];
        for (int c = 0; c < 4; c++)
          node[c] = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[c][l]);
        work(model, tangent, node, vsc_pack_frames(model, patch, k)->V[l], x);
      }
  }
}

static void assemble_groups(const assembly *a)
{
  const vsc_model *model = a->model;
  vsc_tangent *tangent = a->tangent;
  double *ratio = tangent->group_change;
  vsc_group_ratios(model, a->x, a->scratch, ratio);
  for (size_t n = 0; n < model->node_count; n++) {
    const vsc_wide curvature =
        vsc_volume_curvature(vsc_splat(model->group_modulus[n]), vsc_splat(ratio[n]));
    tangent->group_weight[n] = a->stiffness_factor * curvature[0] / model->group_volume[n];
  }
  memset(tangent->group_gradient, 0,
         3 * tangent->group_start[model->node_count] * sizeof(double));
  for_sharing_tets(model, tangent, a->x, add_tet_to_groups);
}

// The nodes of a face belong to one element or to triangles of membranes, so the matrix has their blocks; where a
// loaded triangle itself is of no membrane, a free edge of it is left out.
static void add_load(void *matrix, uint32_t i, uint32_t j, const double K[9])
{
  vsc_block_matrix_add(matrix, i, j, 1, K);
}

void vsc_tangent_assemble(const vsc_model *model, vsc_tangent *tangent, const double *x,
                          const double *w, const double *before, double time, double stiffness_factor,
                          double damping_factor, vsc_scratch *scratch)
{
  assembly a = {model, tangent, x, w, before, time, stiffness_factor, damping_factor, scratch, NULL};
  vsc_block_matrix_clear(&tangent->matrix);
  if (model->terms.nodal_volume) vsc_group_volumes(model, x, scratch);
  for (size_t c = 0; c < tangent->color_count; c++) {
    a.patches = tangent->colored + tangent->color_start[c];
    vsc_parallel_for(tangent->color_start[c + 1] - tangent->color_start[c], assemble_patch, &a);
  }
  vsc_loads_tangent(model, x, time, scratch->load, stiffness_factor, damping_factor, add_load,
                    &tangent->matrix);
  if (model->terms.nodal_volume) assemble_groups(&a);
  if (model->terms.smoothed)
    vsc_smoothed_tangent(model, x, w, time, stiffness_factor, damping_factor, scratch, tangent->edges);
}

// A part of the groups' stiffness put on the tet itself: 0.3 mean_n (U''_n) / V_e grad v_e grad v_e^T.
static void add_tet_to_preconditioner(const vsc_model *model, vsc_tangent *tangent,
                                      const uint32_t *node, double volume, const double *x)
{
  const double *corner[4];
  double gradient[4][3], curvature = 0, block[9];
  for (int c = 0; c < 4; c++) {
    corner[c] = x + 4 * (size_t)node[c];
    curvature += 0.25 * tangent->group_weight[node[c]] * model->group_volume[node[c]];
  }
  volume_gradients(corner, gradient);
  for (int c = 0; c < 4; c++)
    for (int d = 0; d < 4; d++) {
      if (node[c] < node[d]) continue;
      for (int r = 0; r < 3; r++)
        for (int s = 0; s < 3; s++) block[3 * r + s] = gradient[c][r] * gradient[d][s];
      vsc_block_matrix_add(&tangent->preconditioner, node[c], node[d],
                           GROUP_ON_ELEMENTS * curvature / volume, block);
    }
}

void vsc_tangent_precondition(const vsc_model *model, vsc_tangent *tangent, const double *x)
{
  if (tangent->preconditioner.values == tangent->matrix.values) return;
  memcpy(tangent->preconditioner.values, tangent->matrix.values,
         9 * tangent->matrix.start[model->node_count] * sizeof(double));
  if (model->terms.nodal_volume) for_sharing_tets(model, tangent, x, add_tet_to_preconditioner);
  if (model->terms.smoothed) vsc_smoothed_precondition(model, tangent->edges, &tangent->preconditioner);
}

// ---- products

// y += G^T W G x
static void add_groups(const vsc_tangent *tangent, const double *x, double *y)
{
  const size_t nodes = tangent->matrix.node_count;
  for (size_t g = 0; g < nodes; g++) {
    double change = 0;
    for (size_t k = tangent->group_start[g]; k < tangent->group_start[g + 1]; k++)
      for (size_t i = 0; i < 3; i++)
        change += tangent->group_gradient[3 * k + i] * x[4 * (size_t)tangent->group_node[k] + i];
    change *= tangent->group_weight[g];
    for (size_t k = tangent->group_start[g]; k < tangent->group_start[g + 1]; k++)
      for (size_t i = 0; i < 3; i++)
        y[4 * (size_t)tangent->group_node[k] + i] += change * tangent->group_gradient[3 * k + i];
  }
}

void vsc_tangent_times(const vsc_tangent *tangent, const double *free, const double *x, double *y)
{
  vsc_block_matrix_times(&tangent->matrix, x, y);
  if (tangent->group_start != NULL) add_groups(tangent, x, y);
  if (tangent->edges != NULL)
    vsc_smoothed_times(tangent->model, tangent->edges, tangent->space, x, y);
  for (size_t i = 0; i < 4 * tangent->matrix.node_count; i++)
    if (free[i] == 0) y[i] = 0;
}

