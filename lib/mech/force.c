// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/force.h"

#include <string.h>

#include "base/parallel.h"
#include "mech/element.h"
#include "mech/kernel.h"
#include "mech/loads.h"
#include "mech/patch_nodes.h"
#include "mech/prony.h"
#include "mech/smoothed.h"
#include "model/law_volume.h"

// What the pieces of one evaluation share.
typedef struct evaluation {
  const vsc_model *model;
  const double *x, *w;
  double time;
  vsc_scratch *scratch;
  double *force;
} evaluation;

enum { NODES_PER_PIECE = 256 };

// The memory of one thread, cut into the arrays of a patch.
typedef struct local_arrays {
  double *x, *w, *f, *pressure;
  vsc_wide *activation;
} local_arrays;

static local_arrays local_of(const evaluation *e, int thread)
{
  const size_t nodes = e->model->most_nodes;
  double *memory = e->scratch->local + (size_t)thread * e->scratch->local_size;
  local_arrays local = {.activation = (vsc_wide *)memory};
  local.x = memory + VSC_WIDTH * e->model->most_packs;
  local.w = local.x + 4 * nodes;
  local.f = local.w + 4 * nodes;
  local.pressure = local.f + 4 * nodes;
  return local;
}

// The pressures of the patch's nodes, own nodes first.
static void gather_pressures(const evaluation *e, const vsc_patch *patch, double *local)
{
  const double *pressure = e->scratch->pressure;
  const uint32_t *shared = e->model->shared + patch->first_shared;
  memcpy(local, pressure + patch->first_node, patch->own_count * sizeof *local);
  for (uint32_t n = 0; n < patch->shared_count; n++) local[patch->own_count + n] = pressure[shared[n]];
}

// Activation of the patch's packs at this time: one number when all its elements agree. Returns the
// stride.
static size_t fill_activation(const evaluation *e, const vsc_patch *patch, vsc_wide *activation)
{
  const vsc_model *model = e->model;
  const vsc_material *material = &model->materials[patch->material];
  const double load = e->scratch->load;
  if (material->active == VSC_ACTIVE_NONE || !vsc_patch_is_solid(patch)) {
    activation[0] = vsc_splat(0);
    return 0;
  }
  if (model->amplitude == NULL && model->delay == NULL) {
    activation[0] = vsc_splat(load * vsc_model_activation(model, material, 0, e->time));
    return 0;
  }
  if (model->delay == NULL) {
    const double value = load * vsc_curve_value(&material->curve, e->time - material->delay);
    const vsc_wide *amplitude = (const vsc_wide *)model->amplitude + patch->first_pack;
    for (uint32_t k = 0; k < patch->pack_count; k++) activation[k] = value * amplitude[k];
    return 1;
  }
  for (uint32_t k = 0; k < patch->pack_count; k++)
    for (int l = 0; l < VSC_WIDTH; l++)
      activation[k][l] = load * vsc_model_activation(
          model, material, VSC_WIDTH * (size_t)(patch->first_pack + k) + l, e->time);
  return 1;
}

static void patch_volume(void *context, size_t p, int thread)
{
  const evaluation *e = context;
  const vsc_patch *patch = &e->model->patches[p];
  const local_arrays local = local_of(e, thread);
  const size_t count = patch->own_count + patch->shared_count;
  if (patch->still && e->scratch->still_known) return;
  memset(local.f, 0, count * sizeof *local.f);
  if (vsc_patch_shares_volume(e->model, patch)) {
    vsc_gather_nodes(e->model, patch, e->x, local.x);
    const vsc_patch_work work = {.packs = e->model->store + patch->packs,
                                 .pack_count = patch->pack_count,
                                 .x = local.x,
                                 .volume = local.f};
    vsc_volume_kernel()(&work);
  }
  memcpy(e->scratch->volume + patch->first_node, local.f, patch->own_count * sizeof *local.f);
  memcpy(e->scratch->partial_volume + patch->first_shared, local.f + patch->own_count,
         patch->shared_count * sizeof *local.f);
}

// The work of a patch of a membrane.
static vsc_patch_work prepare_surface(const evaluation *e, const vsc_patch *patch,
                                      const local_arrays *local, vsc_kernel_choice *choice)
{
  const vsc_model *model = e->model;
  *choice = (vsc_kernel_choice){.family = patch->family,
                                .damping = e->w != NULL && model->membranes[patch->material].lag > 0};
  vsc_gather_nodes(model, patch, e->x, local->x);
  if (choice->damping) vsc_gather_nodes(model, patch, e->w, local->w);
  return (vsc_patch_work){.packs = model->store + patch->packs,
                          .pack_count = patch->pack_count,
                          .membrane = &model->membranes[patch->material],
                          .x = local->x,
                          .w = local->w,
                          .f = local->f};
}

static vsc_frame_springs springs_of(const vsc_patch *patch, const vsc_material *material)
{
  if (patch->mixed || material->axis_count + material->pair_count > 0) return VSC_COMPOSED;
  return material->angular[0] + material->angular[1] + material->angular[2] > 0 ? VSC_ANGULAR : VSC_AXIAL;
}

// The patch's work, with only what its kernel reads gathered.
static vsc_patch_work prepare(const evaluation *e, const vsc_patch *patch, const local_arrays *local,
                              vsc_kernel_choice *choice)
{
  const vsc_model *model = e->model;
  const vsc_material *material = &model->materials[patch->material];
  const size_t stride = fill_activation(e, patch, local->activation);
  const bool passive = stride == 0 && local->activation[0][0] == 0;
  *choice = (vsc_kernel_choice){
      .family = patch->family,
      .law = material->law,
      .damping = e->w != NULL && vsc_patch_is_damped(model, patch),
      .active = passive ? VSC_ACTIVE_NONE : material->active,
      .nodal_volume = vsc_patch_shares_volume(model, patch),
      .smoothed = patch->smoothed != 0,
      .springs = springs_of(patch, material),
      .general = material->general || (patch->mixed && model->terms.general)};
  vsc_gather_nodes(model, patch, e->x, local->x);
  if (choice->damping) vsc_gather_nodes(model, patch, e->w, local->w);
  if (choice->nodal_volume) gather_pressures(e, patch, local->pressure);
  return (vsc_patch_work){
      .packs = model->store + patch->packs,
      .pack_count = patch->pack_count,
      .material = material,
      .rule = vsc_patch_is_solid(patch) ? &model->rules[patch->family] : NULL,
      .axes = model->axes + material->first_axis,
      .pairs = model->pairs + material->first_pair,
      .mixtures = patch->mixed ? (const vsc_four *)vsc_pack_mixture(model, patch, patch->first_pack) : NULL,
      .law_data = patch->law_data ? model->store + patch->law_data : NULL,
      .smoothed = patch->smoothed ? vsc_pack_smoothed(model, patch, patch->first_pack) : NULL,
      .edge_stress = e->scratch->edge_stress,
      .x = local->x,
      .w = local->w,
      .f = local->f,
      .pressure = local->pressure,
      .activation = local->activation,
      .activation_stride = stride,
      .multipliers = e->scratch->pack_multiplier != NULL
                         ? (const vsc_wide *)e->scratch->pack_multiplier + patch->first_pack
                         : NULL,
      .shares_volume = choice->nodal_volume,
      .angular = choice->springs != VSC_AXIAL};
}

static void patch_force(void *context, size_t p, int thread)
{
  const evaluation *e = context;
  const vsc_patch *patch = &e->model->patches[p];
  const local_arrays local = local_of(e, thread);
  const size_t count = patch->own_count + patch->shared_count;
  vsc_kernel_choice choice;
  memset(local.f, 0, 4 * count * sizeof *local.f);
  if (patch->still) {
    vsc_put_forces(patch, local.f, e->force, e->scratch->partial);
    return;
  }
  const vsc_patch_work work = vsc_patch_is_surface(patch)
                                  ? prepare_surface(e, patch, &local, &choice)
                                  : prepare(e, patch, &local, &choice);
  vsc_patch_kernel *kernel = vsc_force_kernel(&choice);
  if (kernel != NULL) kernel(&work);
  if (e->model->branch_count > 0)
    vsc_prony_force(e->model, patch, e->scratch->prony, e->scratch->prony_step, e->x, local.f);
  vsc_put_forces(patch, local.f, e->force, e->scratch->partial);
}

// Loads on surfaces, which add to the same nodes as patches do, have a memory of their own, and are the first piece.
static void load_or_patch(void *context, size_t piece, int thread)
{
  const evaluation *e = context;
  double *outside = e->scratch->outside;
  const bool pushed = e->scratch->pushed;
  if (!pushed || piece > 0) {
    patch_force(context, piece - pushed, thread);
    return;
  }
  memset(outside, 0, 4 * e->model->node_count * sizeof *outside);
  vsc_loads_push(e->model, e->x, e->time, e->scratch->load, outside);
}

// A pass over the nodes from `first` on.
typedef struct node_pass {
  const vsc_model *model;
  const vsc_scratch *scratch;
  const double *partial;
  double *force;
  size_t first;
} node_pass;

static void for_nodes(node_pass *pass, vsc_piece *work)
{
  const size_t count = pass->model->node_count - pass->first;
  vsc_parallel_for((count + NODES_PER_PIECE - 1) / NODES_PER_PIECE, work, pass);
}

static size_t piece_end(const node_pass *pass, size_t piece)
{
  const size_t end = pass->first + (piece + 1) * NODES_PER_PIECE;
  return end < pass->model->node_count ? end : pass->model->node_count;
}

VSC_CLONED static void sum_shared(void *context, size_t piece, int thread)
{
  (void)thread;
  const node_pass *s = context;
  for (size_t n = s->first + piece * NODES_PER_PIECE, end = piece_end(s, piece); n < end; n++)
    ((vsc_wide *)s->force)[n] = vsc_shared_force(s->model, s->partial, n);
}

void vsc_sum_shared(const vsc_model *model, const double *partial, double *force)
{
  node_pass pass = {.model = model, .partial = partial, .force = force, .first = model->own_node_count};
  for_nodes(&pass, sum_shared);
}

VSC_CLONED static void sum_all(void *context, size_t piece, int thread)
{
  (void)thread;
  const node_pass *s = context;
  for (size_t n = s->first + piece * NODES_PER_PIECE, end = piece_end(s, piece); n < end; n++)
    ((vsc_wide *)s->force)[n] = vsc_node_force(s->model, s->scratch, s->force, n);
}

// The deformed volume of a shared node's group: the sum of its parts, in the order of the patches.
static double shared_volume(const vsc_model *model, const double *partial_volume, size_t node)
{
  const size_t s = node - model->own_node_count;
  double volume = 0;
  for (uint32_t k = model->sum_start[s]; k < model->sum_start[s + 1]; k++)
    volume += partial_volume[model->sum_place[k]];
  return volume;
}

// p = U'(J) with K, and what multipliers add, of as many nodes from n on as `width` says: one, or VSC_WIDTH.
VSC_INLINE void press(const vsc_model *model, const vsc_scratch *scratch, size_t n, size_t width)
{
  vsc_wide volume = vsc_splat(1), rest = vsc_splat(1), modulus = vsc_splat(0), multiplier = vsc_splat(0);
  const size_t bytes = width * sizeof(double);
  memcpy(&volume, scratch->volume + n, bytes);
  memcpy(&rest, model->group_volume + n, bytes);
  memcpy(&modulus, model->group_modulus + n, bytes);
  if (scratch->node_multiplier != NULL) memcpy(&multiplier, scratch->node_multiplier + n, bytes);
  const vsc_wide p = vsc_volume_stress(modulus, volume / rest) + multiplier;
  memcpy(scratch->pressure + n, &p, bytes);
}

VSC_CLONED static void press_nodes(void *context, size_t piece, int thread)
{
  (void)thread;
  const node_pass *s = context;
  const vsc_model *model = s->model;
  const vsc_scratch *scratch = s->scratch;
  const size_t begin = piece * NODES_PER_PIECE, end = piece_end(s, piece);
  for (size_t n = begin > model->own_node_count ? begin : model->own_node_count; n < end; n++)
    scratch->volume[n] = shared_volume(model, scratch->partial_volume, n);
  size_t n = begin;
  for (; n + VSC_WIDTH <= end; n += VSC_WIDTH) press(model, scratch, n, VSC_WIDTH);
  for (; n < end; n++) press(model, scratch, n, 1);
}

// The volumes of all groups (of patches that are still only once) and their pressures.
static void sum_volumes(evaluation *e)
{
  node_pass pass = {.model = e->model, .scratch = e->scratch};
  vsc_parallel_for(e->model->patch_count, patch_volume, e);
  e->scratch->still_known = true;
  for_nodes(&pass, press_nodes);
}

void vsc_force_parts(const vsc_model *model, const double *x, const double *w, double time,
                     vsc_scratch *scratch, double *force)
{
  const vsc_terms *terms = &model->terms;
  evaluation e = {model, x, w, time, scratch, force};
  if (terms->nodal_volume) sum_volumes(&e);
  if (terms->smoothed) vsc_smoothed_stress(model, x, w, time, scratch);
  scratch->pushed = vsc_loads_work(model, time, scratch->load);
  vsc_parallel_for(model->patch_count + scratch->pushed, load_or_patch, &e);
  vsc_loads_hold(model, x, w, scratch->pull, scratch->outside);
}

void vsc_force(const vsc_model *model, const double *x, const double *w, double time,
               vsc_scratch *scratch, double *force)
{
  vsc_force_parts(model, x, w, time, scratch, force);
  const bool all = scratch->pushed || model->terms.gravity;
  node_pass pass = {model, scratch, scratch->partial, force, all ? 0 : model->own_node_count};
  for_nodes(&pass, sum_all);
}

vsc_patch_work vsc_patch_prepare(const vsc_model *model, const vsc_patch *patch, const double *x,
                                 const double *w, const double *before, double time,
                                 vsc_scratch *scratch, int thread)
{
  const evaluation e = {model, x, w, time, scratch, NULL};
  const local_arrays local = local_of(&e, thread);
  vsc_kernel_choice choice;
  vsc_patch_work work = vsc_patch_is_surface(patch) ? prepare_surface(&e, patch, &local, &choice)
                                                    : prepare(&e, patch, &local, &choice);
  if (!choice.damping) work.w = NULL;
  if (before != NULL) vsc_gather_nodes(model, patch, before, local.f);
  work.before = before != NULL ? local.f : NULL;
  return work;
}

void vsc_group_volumes(const vsc_model *model, const double *x, vsc_scratch *scratch)
{
  evaluation e = {model, x, NULL, 0, scratch, NULL};
  sum_volumes(&e);
}

void vsc_group_ratios(const vsc_model *model, const double *x, vsc_scratch *scratch, double *ratio)
{
  vsc_group_volumes(model, x, scratch);
  for (size_t n = 0; n < model->node_count; n++)
    ratio[n] = scratch->volume[n] / model->group_volume[n];
}
