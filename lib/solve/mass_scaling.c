// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/mass_scaling.h"

#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "mech/step_limit.h"
#include "solve/explicit.h"

enum { MOST_ROUNDS = 20 };
#define LARGEST_RISE 1.5  // of k in a round
#define FIRST_FACTOR 0.1  // k: bounds of stiffness are some 3 to 50 times above it
#define CLOSE 1e-3        // the wanted step is reached to this part of it

static void set_mass(vsc_model *model, size_t node, double mass)
{
  model->mass[node] = mass;
  for (size_t i = 0; i < 3; i++)
    if (model->inverse_mass[4 * node + i] != 0) model->inverse_mass[4 * node + i] = 1 / mass;
}

static vsc_status stable_step(const vsc_model *model, double *step, vsc_error *error)
{
  vsc_state *state;
  vsc_status status = vsc_state_create(model, &state, error);
  if (status == VSC_OK) status = vsc_start(model, state, error);
  if (status == VSC_OK) *step = state->limit.first;
  vsc_state_free(state);
  return status;
}

// What moving supports weigh counts in their work.
static void weigh_supports(vsc_model *model)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    model->moved[s].mass = 0;
    for (size_t k = 0; k < model->moved[s].node_count; k++)
      model->moved[s].mass += model->mass[model->moved[s].nodes[k]];
  }
}

static void count_added(vsc_model *model, const double *before)
{
  vsc_scaled_mass *scaled = &model->scaled;
  for (size_t n = 0; n < model->node_count; n++) {
    const double added = model->mass[n] - before[n];
    if (added <= 0) continue;
    scaled->nodes++;
    scaled->added += added;
    scaled->most = fmax(scaled->most, added / before[n]);
  }
}

vsc_status vsc_scale_masses(vsc_model *model, const vsc_definition *definition, vsc_error *error)
{
  const double wanted = definition->mass_scaling;
  if (wanted == 0) return VSC_OK;
  if (!(wanted > 0))
    return vsc_fail(error, VSC_INPUT, "time.mass_scaling: %g ms: give a time above zero, or 0 ms for none", wanted);
  if (definition->solve.kind != VSC_SOLVE_EXPLICIT || definition->step > 0)
    return vsc_fail(error, VSC_INPUT,
                    "time.mass_scaling: is for explicit steps of their own length: use solve: explicit and time.step: "
                    "auto, or leave it out");
  double *stiffness, *before = NULL, step = 0, factor = FIRST_FACTOR;
  if (!VSC_NEW(stiffness, model->node_count) || !VSC_NEW(before, model->node_count)) {
    vsc_free(stiffness);
    return vsc_fail_memory(error, "mass scaling");
  }
  vsc_limit_stiffness(model, 2 * model->safety / wanted, stiffness);
  memcpy(before, model->mass, model->node_count * sizeof *before);
  vsc_status status = stable_step(model, &step, error);
  // step = safety 2/sqrt(1.1 lambda)
  const double lambda = pow(2 * model->safety / wanted, 2) / 1.1;
  for (int round = 0; status == VSC_OK && step < wanted * (1 - CLOSE) && round < MOST_ROUNDS; round++) {
    for (size_t n = 0; n < model->node_count; n++)
      set_mass(model, n, fmax(before[n], factor * stiffness[n] / lambda));
    status = stable_step(model, &step, error);
    factor *= fmin(fmax(pow(wanted / step, 2), 1 + CLOSE), LARGEST_RISE);
  }
  count_added(model, before);
  weigh_supports(model);
  model->scaled.step = step;
  model->hash = vsc_hash(model->hash, model->mass, model->node_count * sizeof *model->mass);
  vsc_free(stiffness);
  vsc_free(before);
  if (status != VSC_OK) return status;
  if (model->scaled.added > definition->most_added_mass * model->total_mass)
    return vsc_fail(error, VSC_INPUT,
                    "time.mass_scaling: %g ms wants %.2g %% more mass, above time.most_added_mass of %.2g %%; a "
                    "node would weigh %.3g times what it does; take a shorter step, mend the smallest elements, or "
                    "raise most_added_mass",
                    wanted, 100 * model->scaled.added / model->total_mass, 100 * definition->most_added_mass,
                    1 + model->scaled.most);
  return VSC_OK;
}
