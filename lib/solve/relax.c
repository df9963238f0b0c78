// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/relax.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "mech/culprit.h"
#include "mech/force.h"
#include "mech/prony.h"
#include "mech/step_limit.h"
#include "solve/moving.h"
#include "solve/newton.h"

// Forces that the rounding of positions makes, as a part of a node's stiffness times the body's size.
#define ROUNDING 4e-16
enum { MOST_STEPS = 200000, RAMP_STEPS = 200, REFRESH = 200, REFRESH_IN_RAMP = 20, ITERATIONS = 8 };

// The model with masses for relaxation; everything else is the model's own.
typedef struct relaxer {
  vsc_model model;
  double *mass, *inverse_mass;
  double *before;  // forces of the step before
  double *good;    // positions of the last equilibrium, or of the start
  double floor;    // rounding alone in |r|, mN
} relaxer;

static void release(void *solver)
{
  relaxer *r = solver;
  vsc_free(r->mass);
  vsc_free(r->inverse_mass);
  vsc_free(r->before);
  vsc_free(r->good);
  vsc_free(r);
}

vsc_status vsc_relax_start(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  relaxer *r;
  if (!VSC_NEW(r, 1)) return vsc_fail_memory(error, "relaxation");
  if (!VSC_NEW(r->mass, model->node_count) || !VSC_NEW(r->inverse_mass, 4 * model->node_count) ||
      !VSC_NEW(r->before, 4 * model->node_count) || !VSC_NEW(r->good, 4 * model->node_count)) {
    release(r);
    return vsc_fail_memory(error, "relaxation");
  }
  vsc_limit_stiffness(model, 0, r->mass);
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 4 * n; i < 4 * n + 4; i++)
      if (model->inverse_mass[i] != 0) r->inverse_mass[i] = 1 / r->mass[n];
  double sum = 0;
  for (size_t n = 0; n < model->node_count; n++) sum += r->mass[n] * r->mass[n];
  r->floor = ROUNDING * vsc_body_size(model) * sqrt(sum);
  r->model = *model;
  r->model.mass = r->mass;
  r->model.inverse_mass = r->inverse_mass;
  state->solver = r;
  state->release_solver = release;
  if (state->loaded) vsc_moving_begin_loaded(model, state);
  return VSC_OK;
}

// Loads between the two times, part 1 being the end.
typedef struct ramp {
  double start, way, load;
} ramp;

static double time_at(const ramp *p, double step, vsc_state *state)
{
  const double part = fmin(step / RAMP_STEPS, 1);
  state->scratch.load = p->load + part * (1 - p->load);
  return p->start + part * p->way;
}

static double square(const vsc_model *model, const double *a, bool all)
{
  double sum = 0;
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 4 * n; i < 4 * n + 3; i++)
      if (all || model->inverse_mass[i] != 0) sum += a[i] * a[i];
  return sum;
}

// One step; the forces at the new positions are in state->force.
static void step(const relaxer *r, vsc_state *state, double time, double h, double *damping)
{
  const vsc_model *model = &r->model;
  double *x = state->x, *v = state->v, *force = state->force, stiff = 0, moving = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++) {
    v[i] = ((2 - *damping * h) * v[i] + 2 * h * model->inverse_mass[i] * force[i]) / (2 + *damping * h);
    x[i] += h * v[i];
  }
  vsc_supports_place(model, time, state->scratch.load, x);
  memcpy(r->before, force, 4 * model->node_count * sizeof *force);
  vsc_force(model, x, NULL, time, &state->scratch, force);
  for (size_t i = 0; i < 4 * model->node_count; i++) {
    stiff += v[i] * (r->before[i] - force[i]);
    moving += v[i] * v[i] * model->mass[i / 4];
  }
  *damping = moving > 0 ? 2 * sqrt(fmax(stiff, 0) / (h * moving)) : 0;
}

// What pulls most at the node, for the message.
static const char *blame(const vsc_model *model, vsc_state *state, double time, size_t node, char text[VSC_CULPRIT_TEXT])
{
  const vsc_culprit culprit = vsc_find_culprit(model, state->x, NULL, time, &state->scratch, node);
  return vsc_name_culprit(&culprit, "", text, VSC_CULPRIT_TEXT);
}

// Something is no longer finite: a position, or else a force.
static vsc_status fail_infinite(const vsc_model *model, vsc_state *state, double time, double steps, vsc_error *error)
{
  const size_t bad = vsc_state_find_bad(model, state);
  const bool lost = bad < model->node_count;
  const size_t worst = lost ? bad : vsc_largest_node(model, state->force);
  char node[VSC_NODE_TEXT], culprit[VSC_CULPRIT_TEXT];
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms no equilibrium was found: in step %.0f of relaxation the %s %s, is no longer a finite "
                  "number%s; take a smaller load or a better mesh there, or solver.method: newton",
                  time, steps, lost ? "position of" : "force on", vsc_name_node(model, worst, node, sizeof node),
                  blame(model, state, time, worst, culprit));
}

// From the last equilibrium to the one at `until`; what moves stays so after a failure.
static vsc_status relax(const vsc_model *model, vsc_state *state, double until, vsc_error *error)
{
  relaxer *r = state->solver;
  const ramp loads = {state->time, until - state->time, state->steps > 0 || state->loaded ? 1 : 0};
  const double tolerance = model->solve.tolerance;
  double scale = 0, damping = 0;
  for (double k = 0; k < MOST_STEPS; k++) {
    if (vsc_is_set(state->interrupted)) return vsc_fail(error, VSC_SYSTEM, "interrupted");
    const double time = time_at(&loads, k, state);
    const double interval = k <= RAMP_STEPS ? REFRESH_IN_RAMP : REFRESH;
    if (fmod(k, interval) == 0) {
      vsc_limit_refresh(&r->model, state, time, ITERATIONS);
      vsc_force(model, state->x, NULL, time, &state->scratch, state->force);
    }
    step(r, state, time, state->limit.step, &damping);
    scale = fmax(scale, square(model, state->force, true));
    const double rest = square(model, state->force, false);
    if (!isfinite(rest)) return fail_infinite(model, state, until, k + 1, error);
    if (k >= RAMP_STEPS && rest <= fmax(tolerance * tolerance * scale, r->floor * r->floor)) return VSC_OK;
  }
  const size_t fastest = vsc_largest_node(model, state->v);
  char node[VSC_NODE_TEXT], culprit[VSC_CULPRIT_TEXT];
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms no equilibrium was found: relaxation has not come to rest in %d steps, least of all "
                  "%s%s; use solver.method: newton, or a larger solver.tolerance",
                  until, MOST_STEPS, vsc_name_node(model, fastest, node, sizeof node),
                  blame(model, state, until, fastest, culprit));
}

vsc_status vsc_relax_to(const vsc_model *model, vsc_state *state, double until, vsc_error *error)
{
  const relaxer *r = state->solver;
  const size_t bytes = 4 * model->node_count * sizeof *state->x;
  const double load = state->scratch.load, way = until - state->time;
  memcpy(r->good, state->x, bytes);
  memset(state->v, 0, bytes);
  state->limit.step = 0;
  const vsc_status status = relax(model, state, until, error);
  memset(state->v, 0, bytes);
  if (status != VSC_OK) {
    memcpy(state->x, r->good, bytes);
    memset(state->limit.mode, 0, bytes);  // it may be no numbers any more
    state->scratch.load = load;
    return status;
  }
  state->time = until;
  state->steps++;
  if (model->branch_count > 0) vsc_prony_step(model, state, INFINITY);
  vsc_moving_reckon(model, state, state->force, 1, way);
  return VSC_OK;
}
