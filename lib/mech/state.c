// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/state.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "base/parallel.h"
#include "mech/prony.h"
#include "mech/smoothed.h"

bool vsc_state_has_former(const vsc_model *model, bool velocities)
{
  const vsc_solve_def *solve = &model->solve;
  if (solve->kind == VSC_SOLVE_IMPLICIT) return solve->scheme == VSC_SCHEME_BDF2;
  return solve->kind == VSC_SOLVE_EQUILIBRIUM && !velocities;
}

size_t vsc_state_contacts(const vsc_model *model)
{
  size_t count = 0;
  for (size_t o = 0; model->solve.kind != VSC_SOLVE_EXPLICIT && o < model->obstacle_count; o++)
    count += model->obstacles[o].node_count;
  return count;
}

static bool allocate(const vsc_model *model, vsc_state *state)
{
  const size_t n = model->node_count;
  vsc_scratch *scratch = &state->scratch;
  scratch->load = 1;
  state->limit.caution = 1;
  // positions, velocities and forces of a patch's nodes, their pressures, the activation of its
  // packs
  scratch->local_size = (4 * 3 + 1) * model->most_nodes + VSC_WIDTH * (model->most_packs + 2);
  scratch->local_size = (scratch->local_size + 7) / 8 * 8;
  const bool nodal = model->terms.nodal_volume;
  const size_t lone = model->coupled.degree > 0 ? 4 * n : 0;
  const size_t tets =
      model->terms.smoothed ? VSC_MATRIX * VSC_WIDTH * model->pack_count : 0;
  return VSC_NEW(state->x, 4 * n) && VSC_NEW(state->v, 4 * n) && VSC_NEW(state->a, 4 * n) &&
         VSC_NEW(state->past_a, vsc_state_has_past(model) ? 4 * n : 0) &&
         VSC_NEW(state->force, 4 * n) && VSC_NEW(state->limit.mode, 4 * n) &&
         VSC_NEW(scratch->local, (size_t)vsc_parallel_threads() * scratch->local_size) &&
         VSC_NEW(scratch->partial, 4 * model->partial_count) &&
         VSC_NEW(scratch->volume, nodal ? n : 0) && VSC_NEW(scratch->pressure, nodal ? n : 0) &&
         VSC_NEW(scratch->partial_volume, nodal ? model->partial_count : 0) &&
         VSC_NEW(scratch->gradient, tets) && VSC_NEW(scratch->rate, model->terms.damping ? tets : 0) &&
         VSC_NEW(scratch->edge_stress, VSC_MATRIX * VSC_WIDTH * model->smoothing.pack_count) &&
         VSC_NEW(scratch->predicted, model->terms.damping ? 4 * n : 0) &&
         VSC_NEW(scratch->trial, 3 * 4 * n) && VSC_NEW(state->contact, model->obstacle_count) &&
         VSC_NEW(state->contact_count, model->obstacle_count > 0 ? n : 0) &&
         VSC_NEW(state->contact_normal, model->obstacle_count > 0 ? 4 * n : 0) &&
         VSC_NEW(state->former, model->obstacle_count > 0 ? 4 * n : 0) &&
         VSC_NEW(state->pending, model->obstacle_count > 0 ? 4 * n : 0) &&
         VSC_NEW(state->touch, vsc_state_contacts(model)) &&
         VSC_NEW(state->moved, model->moved_count) &&
         VSC_NEW(state->kept_pressure, model->kept.count) &&
         VSC_NEW(state->lone_v, lone) && VSC_NEW(state->lone_a, lone) && VSC_NEW(scratch->spread, 2 * lone) &&
         VSC_NEW(scratch->lone, 4 * lone) && VSC_NEW(state->former_x, vsc_state_has_former(model, false) ? 4 * n : 0) &&
         VSC_NEW(state->former_v, vsc_state_has_former(model, true) ? 4 * n : 0) &&
         VSC_NEW(state->prony, vsc_prony_size(model));
}

static size_t most_rows(const vsc_model *model)
{
  size_t most = 0;
  for (size_t r = 0; r < model->robin_count; r++)
    if (model->robins[r].node_count > most) most = model->robins[r].node_count;
  return most;
}

static bool allocate_outside(const vsc_model *model, vsc_scratch *scratch)
{
  return (model->pressure_count + model->robin_count == 0 || VSC_NEW(scratch->outside, 4 * model->node_count)) &&
         (model->robin_count == 0 || VSC_NEW(scratch->pull, 4 * most_rows(model)));
}

static bool allocate_multipliers(const vsc_model *model, vsc_scratch *scratch)
{
  if (!(model->solve.incompressible > 0)) return true;
  return VSC_NEW(scratch->node_multiplier, model->node_count) &&
         VSC_NEW(scratch->pack_multiplier, VSC_WIDTH * model->pack_count);
}

vsc_status vsc_state_create(const vsc_model *model, vsc_state **state, vsc_error *error)
{
  *state = NULL;
  vsc_state *made;
  if (!VSC_NEW(made, 1) || !allocate(model, made) || !allocate_outside(model, &made->scratch) ||
      !allocate_multipliers(model, &made->scratch)) {
    vsc_state_free(made);
    return vsc_fail_memory(error, "the state of the simulation");
  }
  made->scratch.prony = made->prony;
  made->scratch.prony_step = model->solve.kind == VSC_SOLVE_EQUILIBRIUM ? INFINITY : 0;
  memcpy(made->x, model->rest, 4 * model->node_count * sizeof *made->x);
  if (model->velocity != NULL)
    memcpy(made->v, model->velocity, 4 * model->node_count * sizeof *made->v);
  *state = made;
  return VSC_OK;
}

void vsc_state_free(vsc_state *state)
{
  if (state == NULL) return;
  vsc_free(state->x);
  vsc_free(state->v);
  vsc_free(state->a);
  vsc_free(state->past_a);
  vsc_free(state->lone_v);
  vsc_free(state->lone_a);
  vsc_free(state->force);
  vsc_free(state->contact);
  vsc_free(state->contact_count);
  vsc_free(state->contact_normal);
  vsc_free(state->former);
  vsc_free(state->pending);
  vsc_free(state->touch);
  vsc_free(state->moved);
  vsc_free(state->kept_pressure);
  vsc_free(state->former_x);
  vsc_free(state->former_v);
  vsc_free(state->prony);
  if (state->keeper != NULL) state->release_keeper(state->keeper);
  if (state->solver != NULL) state->release_solver(state->solver);
  vsc_free(state->limit.mode);
  vsc_free(state->scratch.local);
  vsc_free(state->scratch.partial);
  vsc_free(state->scratch.spread);
  vsc_free(state->scratch.lone);
  vsc_free(state->scratch.outside);
  vsc_free(state->scratch.pull);
  vsc_free(state->scratch.volume);
  vsc_free(state->scratch.partial_volume);
  vsc_free(state->scratch.pressure);
  vsc_free(state->scratch.gradient);
  vsc_free(state->scratch.rate);
  vsc_free(state->scratch.edge_stress);
  vsc_free(state->scratch.predicted);
  vsc_free(state->scratch.trial);
  vsc_free(state->scratch.node_multiplier);
  vsc_free(state->scratch.pack_multiplier);
  vsc_free(state);
}

static bool is_held(const vsc_model *model, size_t node)
{
  const double *inverse = model->inverse_mass + 4 * node;
  return inverse[0] == 0 && inverse[1] == 0 && inverse[2] == 0;
}

size_t vsc_state_find_bad(const vsc_model *model, const vsc_state *state)
{
  size_t bad = model->node_count;
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 0; i < 3; i++) {
      if (isfinite(state->x[4 * n + i]) && isfinite(state->v[4 * n + i])) continue;
      if (!is_held(model, n)) return n;
      if (bad == model->node_count) bad = n;
    }
  return bad;
}

const char *vsc_name_node(const vsc_model *model, size_t node, char *text, size_t size)
{
  const double *rest = model->rest + 4 * node;
  snprintf(text, size, "node %u, at rest at (%.4g, %.4g, %.4g) mm", vsc_source_number(model->node_source, model->mesh_node[node]),
           rest[0], rest[1], rest[2]);
  return text;
}

size_t vsc_largest_node(const vsc_model *model, const double *numbers)
{
  size_t largest = 0;
  double most = -1;
  for (size_t n = 0; n < model->node_count; n++) {
    const double *at = numbers + 4 * n, square = at[0] * at[0] + at[1] * at[1] + at[2] * at[2];
    if (isnan(square)) return n;
    if (square > most) largest = n;
    most = fmax(most, square);
  }
  return largest;
}

uint64_t vsc_state_hash(const vsc_model *model, const vsc_state *state)
{
  const size_t bytes = 4 * model->node_count * sizeof(double);
  uint64_t hash = vsc_hash(VSC_HASH_START, &state->time, sizeof state->time);
  hash = vsc_hash(hash, state->x, bytes);
  hash = vsc_hash(hash, state->v, bytes);
  return vsc_hash(hash, state->a, bytes);
}
