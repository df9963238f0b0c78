// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/observe.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/vec3.h"
#include "mech/element.h"
#include "mech/energies.h"
#include "mech/force.h"
#include "mech/loads.h"
#include "mech/mass_matrix.h"
#include "mech/prony.h"
#include "model/law_volume.h"

vsc_status vsc_ledger_create(const vsc_model *model, vsc_ledger **ledger, vsc_error *error)
{
  const size_t frames = model->frame_count + model->smoothing.pack_count;
  const size_t slots = model->terms.active != VSC_ACTIVE_NONE ? VSC_WIDTH * frames : 0;
  vsc_ledger *made;
  *ledger = NULL;
  if (!VSC_NEW(made, 1) || !VSC_NEW(made->way, slots) || !VSC_NEW(made->tension, slots) ||
      !VSC_NEW(made->push, vsc_loads_push_count(model)) ||
      !VSC_NEW(made->parts, model->patch_count + model->smoothing.block_count)) {
    vsc_ledger_free(made);
    return vsc_fail_memory(error, "the energy ledger");
  }
  *ledger = made;
  return VSC_OK;
}

void vsc_ledger_free(vsc_ledger *ledger)
{
  if (ledger == NULL) return;
  vsc_free(ledger->way);
  vsc_free(ledger->tension);
  vsc_free(ledger->push);
  vsc_free(ledger->parts);
  vsc_free(ledger);
}

typedef struct observation {
  const vsc_model *model;
  vsc_state *state;
  vsc_ledger *ledger;
} observation;

// What the frames of one patch, or the edges of one block, come to, each lane for itself.
typedef struct lanes {
  vsc_pack_energies energies;
  vsc_wide volume, J_low, J_high, inverted;
  vsc_wide known_volume, stretch_low, stretch_high, stretch_mean;
  vsc_wide tension_high, tension_mean, active_work;
} lanes;

static lanes empty_lanes(void)
{
  return (lanes){.J_low = vsc_splat(DBL_MAX),
                 .J_high = vsc_splat(-DBL_MAX),
                 .stretch_low = vsc_splat(DBL_MAX),
                 .stretch_high = vsc_splat(-DBL_MAX)};
}

VSC_INLINE vsc_wide smaller(vsc_wide_mask some, vsc_wide a, vsc_wide least)
{
  return vsc_select(some & (a < least), a, least);
}

VSC_INLINE vsc_wide larger(vsc_wide_mask some, vsc_wide a, vsc_wide most)
{
  return vsc_select(some & (a > most), a, most);
}

// Active tension of four frames: its range, and its work since the last call. `place` is where the
// ledger keeps the first, `taken` says which are there.
VSC_INLINE void add_active(const observation *o, vsc_wide tension, vsc_wide way, vsc_wide V, size_t place,
                           vsc_wide_mask taken, lanes *sum)
{
  vsc_wide *last_way = (vsc_wide *)(o->ledger->way + place), *last = (vsc_wide *)(o->ledger->tension + place);
  sum->tension_high = larger(taken, tension, sum->tension_high);
  sum->tension_mean += vsc_where(taken, V * tension);
  // a tension that shortens the fibre does work
  sum->active_work -= vsc_where(taken, V * 0.5 * (tension + *last) * (way - *last_way));
  *last_way = way;
  *last = tension;
}

// What one pack of frames shows: volume ratios, which it returns, and stretches.
VSC_INLINE vsc_wide add_frames(vsc_wide V, const vsc_wide3 g[3], vsc_wide_mask taken, vsc_wide_mask known, lanes *sum)
{
  const vsc_wide J = vsc_pack_ratio(g), stretch = vsc_wide_sqrt(vsc_wide_dot(g[0], g[0]));
  sum->volume += vsc_where(taken, V * J);
  sum->J_low = smaller(taken, J, sum->J_low);
  sum->J_high = larger(taken, J, sum->J_high);
  sum->stretch_low = smaller(known, stretch, sum->stretch_low);
  sum->stretch_high = larger(known, stretch, sum->stretch_high);
  sum->stretch_mean += vsc_where(known, V * stretch);
  sum->known_volume += vsc_where(known, V);
  return J;
}

// dx/dxi of quadratic tets at a point with the derivatives D of the shape functions.
VSC_INLINE vsc_wide quadratic_ratio(double D[3][VSC_MOST_CORNERS], const vsc_wide3 at[10])
{
  vsc_wide3 tangent[3] = {0};
  for (int i = 1; i < 10; i++) {
    // seen from the first node, so that distant bodies lose no digits
    const vsc_wide3 way = vsc_wide_minus(at[i], at[0]);
    for (int t = 0; t < 3; t++) tangent[t] = vsc_wide_add(tangent[t], vsc_wide_scale(vsc_splat(D[t][i]), way));
  }
  return vsc_pack_ratio(tangent);
}

// Whether quadratic tets are inside out at a node: crushed ones may be so although their frames are not. Where one is
// so at rest, as curved ones may be, it does not count.
VSC_INLINE vsc_wide_mask inverted_at_nodes(const vsc_model *model, const vsc_patch *patch, size_t k, const double *x)
{
  const vsc_cell_kind *kind = &vsc_cells[VSC_TET10];
  vsc_wide3 rest[10], now[10];
  vsc_pack_corners(model, patch, vsc_pack_nodes(model, patch, k), 10, model->rest, rest);
  vsc_pack_corners(model, patch, vsc_pack_nodes(model, patch, k), 10, x, now);
  vsc_wide_mask inverted = {0};
  for (int n = 0; n < 10; n++) {
    const int ends[2] = {n < 4 ? n : kind->edges[n - 4][0], n < 4 ? n : kind->edges[n - 4][1]};
    double xi[3], N[VSC_MOST_CORNERS], D[3][VSC_MOST_CORNERS];
    for (int t = 0; t < 3; t++) xi[t] = 0.5 * ((ends[0] == t + 1) + (ends[1] == t + 1));
    vsc_cell_shape(VSC_TET10, xi, N, D);
    inverted |= (quadratic_ratio(D, rest) > 0) & (quadratic_ratio(D, now) <= 0);
  }
  return inverted;
}

// What the frames of one pack of cells show: volume ratios, stretches, active tension.
VSC_INLINE void observe_frames(const observation *o, const vsc_patch *patch, size_t k, const vsc_pack_law *law,
                               vsc_wide3 (*axes)[3], lanes *sum)
{
  const vsc_model *model = o->model;
  const vsc_material *material = &model->materials[patch->material];
  const size_t points = (size_t)vsc_family_frames(model, patch->family);
  const bool active = material->active != VSC_ACTIVE_NONE && !patch->smoothed;
  vsc_wide activation = vsc_splat(0);
  vsc_wide_mask taken = {0}, known = {0}, inverted = {0};
  if (active) activation = vsc_pack_activation(model, material, k, o->state->time);
  for (size_t l = 0; l < VSC_WIDTH; l++) {
    taken[l] = -(model->mesh_element[VSC_WIDTH * k + l] != VSC_NO_ELEMENT);
    known[l] = -(taken[l] && model->known[VSC_WIDTH * k + l]);
  }
  for (size_t q = 0; q < points; q++) {
    const vsc_wide V = vsc_pack_frames(model, patch, k)[q].V;
    inverted |= taken & (add_frames(V, axes[q], taken, known, sum) <= 0);
    if (!active) continue;
    vsc_wide way;
    const vsc_wide tension = vsc_active_tension(material, law, activation, axes[q], &way);
    const size_t frame = patch->first_frame + (k - patch->first_pack) * points + q;
    add_active(o, tension, way, V, VSC_WIDTH * frame, taken, sum);
  }
  if (patch->family == VSC_TETS10) inverted |= taken & inverted_at_nodes(model, patch, k, o->state->x);
  sum->inverted += vsc_where(inverted, vsc_splat(1));
}

VSC_INLINE void add_energies(const vsc_pack_energies *energies, vsc_pack_energies *sum)
{
  sum->axial += energies->axial;
  sum->angular += energies->angular;
  sum->volume += energies->volume;
  sum->membrane += energies->membrane;
  sum->bending += energies->bending;
  sum->dissipation += energies->dissipation;
  sum->continued += energies->continued;
}

static vsc_totals empty_totals(void)
{
  return (vsc_totals){.J_low = DBL_MAX,
                      .J_high = -DBL_MAX,
                      .stretch_low = DBL_MAX,
                      .stretch_high = -DBL_MAX,
                      .group_low = 1,
                      .group_high = 1};
}

static vsc_totals totals_of(const lanes *sum)
{
  vsc_totals part = empty_totals();
  for (int l = 0; l < VSC_WIDTH; l++) {
    part.axial += sum->energies.axial[l];
    part.angular += sum->energies.angular[l];
    part.volume_energy += sum->energies.volume[l];
    part.membrane += sum->energies.membrane[l];
    part.bending += sum->energies.bending[l];
    part.dissipation += sum->energies.dissipation[l];
    part.continued += sum->energies.continued[l];
    part.volume += sum->volume[l];
    part.J_low = fmin(part.J_low, sum->J_low[l]);
    part.J_high = fmax(part.J_high, sum->J_high[l]);
    part.inverted += sum->inverted[l];
    part.known_volume += sum->known_volume[l];
    part.stretch_low = fmin(part.stretch_low, sum->stretch_low[l]);
    part.stretch_high = fmax(part.stretch_high, sum->stretch_high[l]);
    part.stretch_mean += sum->stretch_mean[l];
    part.tension_high = fmax(part.tension_high, sum->tension_high[l]);
    part.tension_mean += sum->tension_mean[l];
    part.active_work += sum->active_work[l];
  }
  return part;
}

static void observe_surfaces(const observation *o, const vsc_patch *patch, lanes *sum)
{
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
    const vsc_pack_energies energies = vsc_surface_energies_of(o->model, patch, k, o->state->x, o->state->v);
    add_energies(&energies, &sum->energies);
  }
}

VSC_CLONED static void observe_cells(const observation *o, const vsc_patch *patch, lanes *sum)
{
  const vsc_model *model = o->model;
  const double *x = o->state->x, *v = o->state->v;
  const int points = vsc_family_frames(model, patch->family);
  vsc_wide3 axes[VSC_MOST_POINTS][3];
  vsc_pack_law law;
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
    const bool own = patch->mixed || patch->law_data != 0;
    if (own || k == patch->first_pack) law = vsc_pack_law_of(model, patch, k);
    for (int q = 0; q < points; q++) vsc_pack_axes(model, patch, k, q, x, axes[q]);
    const vsc_pack_energies energies = vsc_cell_energies_of(model, patch, k, &law, axes, x, v);
    add_energies(&energies, &sum->energies);
    observe_frames(o, patch, k, &law, axes, sum);
  }
}

static void observe_patch(void *context, size_t p, int thread)
{
  (void)thread;
  const observation *o = context;
  const vsc_patch *patch = &o->model->patches[p];
  lanes sum = empty_lanes();
  if (vsc_patch_is_solid(patch))
    observe_cells(o, patch, &sum);
  else
    observe_surfaces(o, patch, &sum);
  o->ledger->parts[p] = totals_of(&sum);
}

// Active tension of the four edges from `edge` on.
static void observe_edge_tension(const observation *o, const vsc_edge_work *work, const vsc_pack_law *law, size_t edge,
                                 vsc_wide V, const vsc_wide3 g[3], lanes *sum)
{
  vsc_wide activation = vsc_splat(0), way;
  for (size_t l = 0; l < VSC_WIDTH; l++)
    activation[l] = vsc_model_edge_activation(o->model, work->material, edge + l, o->state->time);
  const vsc_wide tension = vsc_active_tension(work->material, law, activation, g, &way);
  add_active(o, tension, way, V, VSC_WIDTH * o->model->frame_count + edge, V > 0, sum);
}

// The laws of smoothed tets, and their active tension, on a block of edges.
static void observe_edges(void *context, size_t b, int thread)
{
  (void)thread;
  const observation *o = context;
  const vsc_model *model = o->model;
  const vsc_edge_block *block = &model->smoothing.blocks[b];
  vsc_edge_work work = vsc_edge_work_of(model, b, &o->state->scratch);
  if (work.material->damped) work.rate = o->state->scratch.rate;
  const bool active = work.material->active != VSC_ACTIVE_NONE;
  const vsc_pack_law law = vsc_material_law(work.material);
  lanes sum = empty_lanes();
  for (size_t k = 0; k < work.pack_count; k++) {
    const vsc_pack_energies energies = vsc_edge_energies_of(model, &work, k);
    add_energies(&energies, &sum.energies);
    vsc_wide3 g[3];
    if (active) vsc_edge_axes(&work, k, work.gradient, g);
    if (active) observe_edge_tension(o, &work, &law, VSC_WIDTH * (block->first_pack + k), work.frames[k].V, g, &sum);
  }
  o->ledger->parts[model->patch_count + b] = totals_of(&sum);
}

static void add_part(const vsc_totals *part, vsc_totals *totals)
{
  totals->axial += part->axial;
  totals->angular += part->angular;
  totals->membrane += part->membrane;
  totals->bending += part->bending;
  totals->dissipation += part->dissipation;
  totals->volume += part->volume;
  totals->volume_energy += part->volume_energy;
  totals->J_low = fmin(totals->J_low, part->J_low);
  totals->J_high = fmax(totals->J_high, part->J_high);
  totals->inverted += part->inverted;
  totals->continued += part->continued;
  totals->stretch_low = fmin(totals->stretch_low, part->stretch_low);
  totals->stretch_high = fmax(totals->stretch_high, part->stretch_high);
  totals->stretch_mean += part->stretch_mean;
  totals->tension_high = fmax(totals->tension_high, part->tension_high);
  totals->tension_mean += part->tension_mean;
  totals->active_work += part->active_work;
}

static void observe_nodes(const vsc_model *model, const vsc_state *state, vsc_totals *totals)
{
  // p = M v
  const bool consistent = model->masses == VSC_MASS_CONSISTENT;
  double *momenta = state->scratch.trial;
  if (consistent) vsc_consistent_masses_times(model, state->v, momenta);
  for (size_t n = 0; n < model->node_count; n++) {
    const double *x = state->x + 4 * n, *v = state->v + 4 * n, m = model->mass[n];
    double p[3] = {m * v[0], m * v[1], m * v[2]}, moment[3];
    for (size_t i = 0; i < 3 && model->coupled.degree > 0; i++)
      if (model->inverse_mass[4 * n + i] > 0) p[i] = m * state->lone_v[4 * n + i];
    if (consistent) memcpy(p, momenta + 4 * n, sizeof p);
    vsc_cross(x, p, moment);
    totals->kinetic += 0.5 * vsc_dot(p, v);
    for (int i = 0; i < 3; i++) {
      totals->momentum[i] += p[i];
      totals->angular_momentum[i] += moment[i];
      if (model->terms.gravity)
        totals->gravity_energy -= model->weight[4 * n + (size_t)i] * (x[i] - model->rest[4 * n + i]);
    }
  }
}

static void observe_groups(const vsc_model *model, vsc_state *state, vsc_totals *totals)
{
  double *ratio = state->scratch.trial;
  vsc_group_ratios(model, state->x, &state->scratch, ratio);
  totals->group_low = DBL_MAX;
  totals->group_high = -DBL_MAX;
  for (size_t n = 0; n < model->node_count; n++) {
    if (model->group_modulus[n] == 0) continue;  // no tets there
    totals->volume_energy +=
        model->group_volume[n] * vsc_volume_energy(model->group_modulus[n], ratio[n]);
    totals->group_low = fmin(totals->group_low, ratio[n]);
    totals->group_high = fmax(totals->group_high, ratio[n]);
  }
}

static double stored_and_kinetic(const vsc_totals *totals)
{
  return totals->kinetic + totals->axial + totals->angular + totals->volume_energy +
         totals->membrane + totals->bending + totals->springs + totals->gravity_energy;
}

void vsc_observe(const vsc_model *model, vsc_state *state, vsc_ledger *ledger, bool resume,
                 vsc_totals *totals)
{
  observation o = {model, state, ledger};
  *totals = empty_totals();
  vsc_parallel_for(model->patch_count, observe_patch, &o);
  double known_volume = 0, active_volume = 0;
  if (model->terms.smoothed) {
    vsc_smoothed_gradients(model, state->x, model->terms.damping ? state->v : NULL, &state->scratch);
    vsc_parallel_for(model->smoothing.block_count, observe_edges, &o);
  }
  const size_t parts = model->patch_count + model->smoothing.block_count;
  for (size_t p = 0; p < parts; p++) add_part(&ledger->parts[p], totals);
  for (size_t p = 0; p < model->patch_count; p++) known_volume += ledger->parts[p].known_volume;
  for (size_t m = 0; m < model->material_count; m++)
    if (model->materials[m].active != VSC_ACTIVE_NONE) active_volume += model->materials[m].volume;
  if (known_volume > 0)
    totals->stretch_mean /= known_volume;
  else
    totals->stretch_low = totals->stretch_high = totals->stretch_mean = 1;
  if (active_volume > 0) totals->tension_mean /= active_volume;
  if (model->element_count == 0) totals->J_low = totals->J_high = 1;
  observe_nodes(model, state, totals);
  for (size_t o = 0; o < model->obstacle_count; o++) {
    totals->contact_work += state->contact[o].work;
    totals->contact_lost += state->contact[o].lost;
  }
  for (size_t s = 0; s < model->moved_count; s++) totals->support_work += state->moved[s].work;
  totals->springs = vsc_loads_energy(model, state->x);
  totals->dissipation += vsc_loads_dissipation(model, state->v);
  totals->prony_work = vsc_prony_work(model, state);
  if (model->terms.nodal_volume) observe_groups(model, state, totals);
  const double pushed = vsc_loads_pressure_work(model, state->x, state->time, ledger->push);
  if (ledger->calls > 0 && !resume) {
    ledger->active += totals->active_work;
    ledger->pressure += pushed;
    ledger->dissipated +=
        0.5 * (ledger->dissipation + totals->dissipation) * (state->time - ledger->time);
  }
  if (ledger->calls == 0 && !resume) ledger->start = stored_and_kinetic(totals);
  ledger->time = state->time;
  ledger->dissipation = totals->dissipation;
  if (!resume) ledger->calls++;
}

double vsc_balance_error(const vsc_ledger *ledger, const vsc_totals *totals)
{
  return stored_and_kinetic(totals) - ledger->start - ledger->active - ledger->pressure +
         ledger->dissipated - totals->contact_work + totals->contact_lost + totals->prony_work -
         totals->support_work;
}
