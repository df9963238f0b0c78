// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/mass_scaling.h"

#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "mech/coupled_mass.h"
#include "mech/step_limit.h"
#include "solve/explicit.h"

enum { MOST_ROUNDS = 20 };
#define FIRST_FACTOR 0.1   // k: bounds of stiffness are some 3 to 50 times above it
#define LARGEST_RISE 4.0   // of k in a round
#define FLATTEST 0.2       // d log step / d log k, at least: 1/2 where mass is added at all nodes
#define CLOSE 1e-3         // the wanted step is reached to this part of it,
#define CLOSE_ABOVE 5e-3   // and exceeded by no more than this, as far as rounds go
#define MOST_PASSES 63.0
#define MOST_RISE 3.0      // of their number in a round
#define FAR_ABOVE 1.2      // the wanted step: fewer passes may do

// A factor k that was tried, and the stable step that it gives, ms.
typedef struct trial {
  double k, step;
} trial;

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

// k between that of too short a step and that of too long a one (0: none is known yet), or above the former, by the slope
// that the last two had.
static double next_factor(const trial *low, const trial *high, const trial *lower, double wanted)
{
  const trial *other = high->k > 0 ? high : lower;
  double slope = 0.5;
  if (other->k > 0) slope = log(other->step / low->step) / log(other->k / low->k);
  const double rise = pow(wanted / low->step, 1 / fmax(fmin(slope, 0.5), FLATTEST));
  if (high->k > 0) return fmin(low->k * fmax(rise, 1 + CLOSE), sqrt(low->k * high->k) * sqrt(sqrt(high->k / low->k)));
  return low->k * fmin(fmax(rise, 1 + CLOSE), LARGEST_RISE);
}

// Finds k, by secants of log step over log k.
static vsc_status find_factor(vsc_model *model, double wanted, const double *before, const double *stiffness, double *step,
                              vsc_error *error)
{
  // step = safety 2/sqrt(1.1 lambda)
  const double lambda = pow(2 * model->safety / wanted, 2) / 1.1;
  trial low = {0}, lower = {0}, high = {0};
  double k = FIRST_FACTOR;
  for (int round = 0;; round++) {
    for (size_t n = 0; n < model->node_count; n++) set_mass(model, n, fmax(before[n], k * stiffness[n] / lambda));
    const vsc_status status = stable_step(model, step, error);
    const bool reached = *step >= wanted * (1 - CLOSE);
    if (status != VSC_OK || (reached && *step <= wanted * (1 + CLOSE_ABOVE))) return status;
    if (reached) {
      if (round >= MOST_ROUNDS) return VSC_OK;
      high = (trial){k, *step};
    } else {
      lower = low, low = (trial){k, *step};
    }
    // the last rounds take what is known to be enough, or go on until it is
    if (round == 2 * MOST_ROUNDS)
      return vsc_fail(error, VSC_NUMERICAL, "time.mass_scaling: %g ms was not reached, but %.4g ms; leave it out", wanted, *step);
    k = round >= MOST_ROUNDS && high.k > 0 ? high.k
        : low.k > 0                       ? next_factor(&low, &high, &lower, wanted)
                                          : k / LARGEST_RISE;
  }
}

static vsc_status scale_nodes(vsc_model *model, const vsc_definition *definition, vsc_error *error)
{
  const double wanted = definition->mass_scaling;
  if (wanted == 0) return VSC_OK;
  if (!(wanted > 0))
    return vsc_fail(error, VSC_INPUT, "time.mass_scaling: %g ms: give a time above zero, or 0 ms for none", wanted);
  if (definition->solve.kind != VSC_SOLVE_EXPLICIT || definition->step > 0)
    return vsc_fail(error, VSC_INPUT,
                    "time.mass_scaling: is for explicit steps of their own length: use solve: explicit and time.step: "
                    "auto, or leave it out");
  double *stiffness, *before = NULL, step = 0;
  if (!VSC_NEW(stiffness, model->node_count) || !VSC_NEW(before, model->node_count)) {
    vsc_free(stiffness);
    return vsc_fail_memory(error, "mass scaling");
  }
  vsc_limit_stiffness(model, 2 * model->safety / wanted, stiffness);
  memcpy(before, model->mass, model->node_count * sizeof *before);
  vsc_status status = stable_step(model, &step, error);
  if (status == VSC_OK && step < wanted * (1 - CLOSE))
    status = find_factor(model, wanted, before, stiffness, &step, error);
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

static vsc_status check_coupling(const vsc_model *model, const vsc_definition *definition, vsc_error *error)
{
  const double wanted = definition->selective_mass_scaling;
  if (!(wanted > 0))
    return vsc_fail(error, VSC_INPUT,
                    "time.selective_mass_scaling: %g ms: give a time above zero, or 0 ms for none", wanted);
  if (definition->solve.kind != VSC_SOLVE_EXPLICIT || definition->step > 0)
    return vsc_fail(error, VSC_INPUT,
                    "time.selective_mass_scaling: is for explicit steps of their own length: use solve: explicit and "
                    "time.step: auto, or leave it out");
  const char *what = model->obstacle_count > 0 ? "obstacles" : model->kept.count > 0 ? "keep_volume"
                     : model->terms.paper      ? "law: paper" : NULL;
  if (what == NULL) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "time.selective_mass_scaling: does not go with %s yet: use time.mass_scaling, or leave it out", what);
}

// The number m to try next, passes + 1: steps grow as m, where damping rules them as its square; the first few passes say
// little about many.
static double next_number(const trial *low, const trial *high, const trial *lower, double wanted)
{
  const trial *other = high->k > 0 ? high : lower;
  const double power = other->k > 0 ? log(other->step / low->step) / log(other->k / low->k) : 2;
  const double m = floor(low->k * pow(wanted / low->step, 1 / fmin(fmax(power, 0.5), 2)));
  return fmin(fmax(m, low->k + 1), high->k > 0 ? high->k - 1 : fmin(MOST_RISE * low->k, MOST_PASSES + 1));
}

// The fewest passes, or not many more, with which the wanted step is stable; *step is that of none.
static vsc_status find_degree(vsc_model *model, double wanted, double *step, vsc_error *error)
{
  trial lower = {0}, low = {1, *step}, high = {0};
  const double first = *step;
  while (*step < wanted * (1 - CLOSE) || (high.k > low.k + 1 && *step > wanted * FAR_ABOVE)) {
    if (low.k == MOST_PASSES + 1)
      return vsc_fail(error, VSC_INPUT,
                      "time.selective_mass_scaling: %g ms is too far above the stable step of %.4g ms: %.0f passes over "
                      "the nodes make it %.4g ms; take a shorter one",
                      wanted, first, MOST_PASSES, *step);
    const double m = high.k == low.k + 1 ? high.k : next_number(&low, &high, &lower, wanted);
    vsc_status status = vsc_coupled_mass_set_degree(model, (int)m - 1, error);
    if (status == VSC_OK) status = stable_step(model, step, error);
    if (status != VSC_OK) return status;
    if (*step >= wanted * (1 - CLOSE)) {
      high = (trial){m, *step};
    } else {
      lower = low;
      low = (trial){m, *step};
    }
  }
  return VSC_OK;
}

static vsc_status couple_nodes(vsc_model *model, const vsc_definition *definition, vsc_error *error)
{
  const double wanted = definition->selective_mass_scaling;
  double step = 0;
  if (wanted == 0) return VSC_OK;
  vsc_status status = check_coupling(model, definition, error);
  if (status == VSC_OK) status = vsc_coupled_mass_create(model, 2 * model->safety / wanted, error);
  if (status == VSC_OK) status = stable_step(model, &step, error);
  if (status == VSC_OK) status = find_degree(model, wanted, &step, error);
  if (status != VSC_OK) return status;
  vsc_coupled_mass *mass = &model->coupled;
  mass->step = step;
  model->hash = vsc_hash(model->hash, &mass->largest, sizeof mass->largest);
  model->hash = vsc_hash(model->hash, &mass->degree, sizeof mass->degree);
  return VSC_OK;
}

vsc_status vsc_scale_masses(vsc_model *model, const vsc_definition *definition, vsc_error *error)
{
  const vsc_status status = scale_nodes(model, definition, error);
  return status == VSC_OK ? couple_nodes(model, definition, error) : status;
}
