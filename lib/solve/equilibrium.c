// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/equilibrium.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "mech/force.h"
#include "mech/prony.h"
#include "solve/incompressible.h"
#include "solve/moving.h"

#define LONGER 1.6    // after an increment of at most QUICK iterations
#define SHORTER 0.4   // after one that failed
#define SHORTEST 2.5e-4
enum { QUICK = 5 };

typedef struct statics {
  const vsc_model *model;
  vsc_state *state;
  double time;
} statics;

static void residual(void *context, const double *x, double *r)
{
  statics *s = context;
  vsc_newton *newton = s->state->solver;
  vsc_force(s->model, x, NULL, s->time, &s->state->scratch, r);
  vsc_kept_add_force(newton->kept, x, r);
}

static void assemble(void *context, const double *x, const double *before, vsc_tangent *tangent)
{
  statics *s = context;
  const vsc_newton *newton = s->state->solver;
  vsc_tangent_assemble(s->model, tangent, x, NULL, before, s->time, 1, 0, &s->state->scratch);
  vsc_kept_add_tangent(newton->kept, x, 1, &tangent->matrix);
}

static vsc_culprit blame(void *context, const double *x, size_t node)
{
  const statics *s = context;
  return vsc_find_culprit(s->model, x, NULL, s->time, &s->state->scratch, node);
}

static void release(void *solver)
{
  vsc_newton_free(solver);
}

vsc_status vsc_equilibrium_start(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  vsc_newton *newton;
  const vsc_status status = vsc_newton_create(model, &newton, error);
  if (status != VSC_OK) return status;
  state->solver = newton;
  state->release_solver = release;
  if (state->loaded) vsc_moving_begin_loaded(model, state);
  return VSC_OK;
}

// Balances again and again until no volume is off; with no multipliers once.
static vsc_status go_rounds(vsc_newton *newton, statics *s, double *x, int *iterations, vsc_error *error)
{
  const double tolerance = s->model->solve.incompressible;
  const vsc_balance balance = {s, residual, assemble, NULL, blame};
  double off = 0;
  for (int round = 0; round < VSC_MOST_ROUNDS; round++) {
    int more;
    const vsc_status status =
        vsc_newton_solve(newton, &balance, s->time, s->state->scratch.load, x, &more, error);
    *iterations = round == 0 ? more : *iterations;
    if (status != VSC_OK || newton->multipliers == NULL) return status;
    off = vsc_multipliers_update(newton->multipliers, x, &s->state->scratch);
    if (off <= tolerance) return VSC_OK;
  }
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms a volume is still off by %.3g of itself after %d rounds of multipliers, not "
                  "below %.3g; take a larger volume_modulus or solver.incompressible",
                  s->time, off, VSC_MOST_ROUNDS, tolerance);
}

// The equilibrium from x. Where there is none multipliers are what they were.
static vsc_status settle(vsc_newton *newton, statics *s, double *x, int *iterations, vsc_error *error)
{
  vsc_multipliers_begin(newton->multipliers, &s->state->scratch);
  const vsc_status status = go_rounds(newton, s, x, iterations, error);
  if (status != VSC_OK) vsc_multipliers_restore(newton->multipliers, &s->state->scratch);
  return status;
}

// Where the last increment leads when it goes on for dt, unless that turns an element inside out; supports that
// move are where they have to be. False when they turn one inside out.
static bool guess(const vsc_model *model, vsc_state *state, double dt, double time, double *x)
{
  uint32_t element;
  const double way = state->former_step > 0 ? dt / state->former_step : 0;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    x[i] = state->x[i] +
           (model->inverse_mass[i] != 0 ? way * (state->x[i] - state->former_x[i]) : 0);
  vsc_supports_place(model, time, state->scratch.load, x);
  if (vsc_smallest_ratio(model, x, &element) > 0) return true;
  memcpy(x, state->x, 4 * model->node_count * sizeof *x);
  vsc_supports_place(model, time, state->scratch.load, x);
  return !vsc_supports_move(model) || vsc_smallest_ratio(model, x, &element) > 0;
}

// A node of the mesh's element.
static size_t node_of(const vsc_model *model, uint32_t element)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; vsc_patch_is_solid(patch) && k < patch->first_pack + patch->pack_count; k++)
      for (size_t l = 0; l < VSC_WIDTH; l++)
        if (model->mesh_element[VSC_WIDTH * k + l] == element)
          return vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[0][l]);
  }
  return 0;
}

static vsc_status fail_motion(const vsc_model *model, double time, const double *x, vsc_error *error)
{
  uint32_t element = 0;
  char node[VSC_NODE_TEXT];
  vsc_smallest_ratio(model, x, &element);
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms no equilibrium was found: supports move so far that elements turn inside out, element %u most, "
                  "beside %s; take a smaller motion",
                  time, vsc_source_number(model->element_source, element),
                  vsc_name_node(model, node_of(model, element), node, sizeof node));
}

// Takes x, in balance at `time` after an increment of `step`, into the state.
static void accept(const vsc_model *model, vsc_state *state, const double *x, double time, double step)
{
  vsc_newton *newton = state->solver;
  memcpy(state->former_x, state->x, 4 * model->node_count * sizeof *x);
  memcpy(state->x, x, 4 * model->node_count * sizeof *x);
  if (model->branch_count > 0) vsc_prony_step(model, state, INFINITY);
  vsc_kept_give(newton->kept, state);
  state->former_step = step;
  state->time = time;
  vsc_touch_reckon(newton->touch, state, step);
  vsc_moving_reckon(model, state, newton->r, state->scratch.load, step);
}

vsc_status vsc_equilibrium_to(const vsc_model *model, vsc_state *state, double until,
                              vsc_error *error)
{
  vsc_newton *newton = state->solver;
  const double start = state->time, way = until - start, load0 = state->steps > 0 || state->loaded ? 1 : 0;
  double *x = state->scratch.trial;
  double done = 0, increment = 1;
  state->scratch.load = 1;
  vsc_force(model, state->x, NULL, until, &state->scratch, state->force);
  vsc_linear_forget(newton->linear);
  vsc_newton_begin(newton, state->force);
  vsc_newton_scale_by_loads(newton, state->x, until);
  while (done < 1) {
    const double next = done + increment > 1 - SHORTEST ? 1 : done + increment;
    statics s = {model, state, start + next * way};
    vsc_touch_begin(newton->touch, state, s.time, false, 1, 0);
    state->scratch.load = load0 + next * (1 - load0);
    int iterations = 0;
    vsc_kept_take(newton->kept, state);
    vsc_status status =
        guess(model, state, (next - done) * way, s.time, x)
            ? settle(newton, &s, x, &iterations, error)
            : fail_motion(model, s.time, x, error);
    if (status == VSC_OK) {
      accept(model, state, x, next == 1 ? until : s.time, (next - done) * way);
      done = next;
      increment *= iterations <= QUICK ? LONGER : 1;
      continue;
    }
    increment = (next - done) * SHORTER;
    const bool same = way == 0 && load0 == 1;  // shorter is no other problem
    if (status != VSC_NUMERICAL || increment < SHORTEST || same) return status;
  }
  state->steps++;
  return VSC_OK;
}
