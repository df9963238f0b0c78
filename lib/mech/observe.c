// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/observe.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/vec3.h"
#include "mech/element.h"
#include "mech/force.h"
#include "model/law_volume.h"

vsc_status vsc_ledger_create(const vsc_model *model, vsc_ledger **ledger, vsc_error *error)
{
  size_t triangles = 0;
  for (size_t p = 0; p < model->pressure_count; p++)
    triangles += model->pressures[p].triangle_count;
  const size_t slots = model->terms.active != VSC_ACTIVE_NONE ? VSC_WIDTH * model->pack_count : 0;
  vsc_ledger *made;
  *ledger = NULL;
  if (!VSC_NEW(made, 1) || !VSC_NEW(made->stretch, slots) || !VSC_NEW(made->tension, slots) ||
      !VSC_NEW(made->push, 6 * triangles) || !VSC_NEW(made->parts, model->patch_count)) {
    vsc_ledger_free(made);
    return vsc_fail_memory(error, "the energy ledger");
  }
  *ledger = made;
  return VSC_OK;
}

void vsc_ledger_free(vsc_ledger *ledger)
{
  if (ledger == NULL) return;
  vsc_free(ledger->stretch);
  vsc_free(ledger->tension);
  vsc_free(ledger->push);
  vsc_free(ledger->parts);
  vsc_free(ledger);
}

typedef struct observation {
  const vsc_model *model;
  const vsc_state *state;
  vsc_ledger *ledger;
} observation;

static vsc_springs passive_springs(const vsc_material *material)
{
  vsc_springs law = {.rest_stretch = vsc_splat(1)};
  for (int a = 0; a < 3; a++) {
    law.axial[a] = vsc_splat(material->axial[a]);
    law.angular[a] = vsc_splat(material->angular[a]);
  }
  return law;
}

// Active tension of one element: its range, and its work since the last call.
static void add_active(const observation *o, const vsc_material *material, size_t slot, double V,
                       double stretch, vsc_totals *part)
{
  vsc_ledger *ledger = o->ledger;
  double nominal;
  const double tension =
      vsc_active_tension(o->model, material, slot, o->state->time, stretch, &nominal);
  part->tension_high = fmax(part->tension_high, tension);
  part->tension_mean += V * tension;
  // a tension that shortens the fibre does work: - T d lambda
  part->active_work -=
      V * 0.5 * (nominal + ledger->tension[slot]) * (stretch - ledger->stretch[slot]);
  ledger->stretch[slot] = stretch;
  ledger->tension[slot] = nominal;
}

static void observe_pack(const observation *o, const vsc_patch *patch, size_t k, vsc_totals *part)
{
  const vsc_model *model = o->model;
  const vsc_material *material = &model->materials[patch->material];
  const vsc_pack *pack = &model->packs[k];
  const vsc_springs law = passive_springs(material);
  vsc_wide3 g[3], rate[3];
  vsc_pack_axes(model, patch, pack, o->state->x, g);
  const vsc_frame_axes frame = vsc_frame_of(g);
  const vsc_wide J = vsc_pack_ratio(g);
  const vsc_wide axial = pack->V * vsc_springs_axial_energy(&law, &frame);
  const vsc_wide angular = pack->V * vsc_springs_angular_energy(&law, &frame);
  vsc_wide dissipation = vsc_splat(0);
  if (model->terms.damping) {
    vsc_pack_axes(model, patch, pack, o->state->v, rate);
    for (int a = 0; a < 3; a++) {
      const vsc_wide along = vsc_wide_dot(rate[a], frame.u[a]);
      dissipation += material->damping[a] * along * along;
    }
    dissipation *= pack->V;
  }
  for (int l = 0; l < VSC_WIDTH; l++) {
    const size_t slot = VSC_WIDTH * k + l;
    if (model->mesh_element[slot] == VSC_NO_ELEMENT) continue;
    const double V = pack->V[l], stretch = frame.length[0][l];
    part->axial += axial[l];
    part->angular += angular[l];
    part->dissipation += dissipation[l];
    part->volume += V * J[l];
    part->volume_energy += V * vsc_volume_energy(material->element_modulus, J[l]);
    part->J_low = fmin(part->J_low, J[l]);
    part->J_high = fmax(part->J_high, J[l]);
    part->inverted += J[l] <= 0;
    if (model->known[slot]) {
      part->stretch_low = fmin(part->stretch_low, stretch);
      part->stretch_high = fmax(part->stretch_high, stretch);
      part->stretch_mean += V * stretch;
    }
    if (material->active != VSC_ACTIVE_NONE) add_active(o, material, slot, V, stretch, part);
  }
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

static void observe_patch(void *context, size_t p, int thread)
{
  (void)thread;
  const observation *o = context;
  const vsc_patch *patch = &o->model->patches[p];
  vsc_totals *part = &o->ledger->parts[p];
  *part = empty_totals();
  for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
    observe_pack(o, patch, k, part);
}

static void add_part(const vsc_totals *part, vsc_totals *totals)
{
  totals->axial += part->axial;
  totals->angular += part->angular;
  totals->dissipation += part->dissipation;
  totals->volume += part->volume;
  totals->volume_energy += part->volume_energy;
  totals->J_low = fmin(totals->J_low, part->J_low);
  totals->J_high = fmax(totals->J_high, part->J_high);
  totals->inverted += part->inverted;
  totals->stretch_low = fmin(totals->stretch_low, part->stretch_low);
  totals->stretch_high = fmax(totals->stretch_high, part->stretch_high);
  totals->stretch_mean += part->stretch_mean;
  totals->tension_high = fmax(totals->tension_high, part->tension_high);
  totals->tension_mean += part->tension_mean;
  totals->active_work += part->active_work;
}

static void observe_nodes(const vsc_model *model, const vsc_state *state, vsc_totals *totals)
{
  for (size_t n = 0; n < model->node_count; n++) {
    const double *x = state->x + 4 * n, *v = state->v + 4 * n, m = model->mass[n];
    double moment[3];
    vsc_cross(x, v, moment);
    totals->kinetic += 0.5 * m * vsc_dot(v, v);
    for (int i = 0; i < 3; i++) {
      totals->momentum[i] += m * v[i];
      totals->angular_momentum[i] += m * moment[i];
      totals->gravity_energy -= m * model->gravity[i] * (x[i] - model->rest[4 * n + i]);
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
    totals->volume_energy +=
        model->group_volume[n] * vsc_volume_energy(model->group_modulus[n], ratio[n]);
    totals->group_low = fmin(totals->group_low, ratio[n]);
    totals->group_high = fmax(totals->group_high, ratio[n]);
  }
}

// Work of the pressures since the last call: mean force on the corners times their way.
static double pressure_work(const vsc_model *model, const vsc_state *state, double *push)
{
  double work = 0;
  for (size_t p = 0; p < model->pressure_count; p++) {
    const vsc_pressure *load = &model->pressures[p];
    const double pressure = vsc_model_pressure(model, p, state->time);
    for (size_t t = 0; t < load->triangle_count; t++, push += 6) {
      const double *x[3];
      double first[3], second[3], n[3];
      for (int c = 0; c < 3; c++) x[c] = state->x + 4 * (size_t)load->triangles[3 * t + c];
      vsc_subtract(x[1], x[0], first);
      vsc_subtract(x[2], x[0], second);
      vsc_cross(first, second, n);
      for (int i = 0; i < 3; i++) {
        const double force = -pressure * n[i] / 6, place = x[0][i] + x[1][i] + x[2][i];
        work += 0.5 * (force + push[i]) * (place - push[3 + i]);
        push[i] = force;
        push[3 + i] = place;
      }
    }
  }
  return work;
}

static double stored_and_kinetic(const vsc_totals *totals)
{
  return totals->kinetic + totals->axial + totals->angular + totals->volume_energy +
         totals->gravity_energy;
}

void vsc_observe(const vsc_model *model, vsc_state *state, vsc_ledger *ledger, bool resume,
                 vsc_totals *totals)
{
  observation o = {model, state, ledger};
  *totals = empty_totals();
  vsc_parallel_for(model->patch_count, observe_patch, &o);
  double known_volume = 0, active_volume = 0;
  for (size_t p = 0; p < model->patch_count; p++) add_part(&ledger->parts[p], totals);
  for (size_t slot = 0; slot < VSC_WIDTH * model->pack_count; slot++)
    if (model->known[slot]) known_volume += model->packs[slot / VSC_WIDTH].V[slot % VSC_WIDTH];
  for (size_t m = 0; m < model->material_count; m++)
    if (model->materials[m].active != VSC_ACTIVE_NONE) active_volume += model->materials[m].volume;
  if (known_volume > 0)
    totals->stretch_mean /= known_volume;
  else
    totals->stretch_low = totals->stretch_high = totals->stretch_mean = 1;
  if (active_volume > 0) totals->tension_mean /= active_volume;
  observe_nodes(model, state, totals);
  if (model->terms.nodal_volume) observe_groups(model, state, totals);
  const double pushed = pressure_work(model, state, ledger->push);
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
         ledger->dissipated;
}
