// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/check_method.h"

#include <math.h>

#include "base/parallel.h"
#include "mech/kernel.h"
#include "mech/prony.h"
#include "mech/step_limit.h"
#include "mech/tangent.h"
#include "run/events.h"
#include "solve/explicit.h"

// Seconds of one step, by doing some.
static vsc_status measure_step(const vsc_model *model, vsc_state *state, double *seconds,
                               vsc_error *error)
{
  const double dt = model->step > 0 ? model->step : state->limit.step;
  const double start = vsc_wall_seconds();
  double steps = 0, passed = 0;
  while (passed < 0.2 && steps < 1000) {
    const vsc_status status = vsc_steps(model, state, dt, 1, error);
    if (status != VSC_OK) return status;
    steps++;
    passed = vsc_wall_seconds() - start;
  }
  *seconds = passed / steps;
  return VSC_OK;
}

// What sits in a slot, and its centre: an element, or a triangle of a membrane.
static void say_part(const vsc_problem *problem, size_t slot, char *what, size_t size,
                     double centre[3])
{
  const vsc_model *model = problem->model;
  if (model->mesh_element[slot] != VSC_NO_ELEMENT) {
    vsc_mesh_element_centre(problem->mesh, model->mesh_element[slot], centre);
    snprintf(what, size, "element %u",
             problem->mesh->element_source[model->mesh_element[slot]]);
    return;
  }
  const vsc_patch *patch = model->patches;
  while (slot / VSC_WIDTH >= patch->first_pack + patch->pack_count) patch++;
  const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, slot / VSC_WIDTH);
  for (int d = 0; d < 3; d++) centre[d] = 0;
  for (int i = 0; i < 3; i++) {
    const uint16_t local = node[i][slot % VSC_WIDTH];
    for (int d = 0; d < 3; d++)
      centre[d] += model->rest[4 * (size_t)vsc_node_of(model, patch, local) + (size_t)d] / 3;
  }
  snprintf(what, size, "a triangle of %s%s", model->membranes[patch->material].name,
           patch->family == VSC_BENDS ? " (bending)" : "");
}

// Whether masses may be coupled, and are not (solve/mass_scaling.h).
static bool may_couple(const vsc_model *model)
{
  return model->coupled.degree == 0 && model->step == 0 && model->obstacle_count == 0 && model->kept.count == 0 &&
         !model->terms.paper;
}

// Where the stable step hangs: the bound knows no damping, the stiffest mode does.
static void say_limit(const vsc_problem *problem, vsc_state *state, FILE *out)
{
  const vsc_model *model = problem->model;
  const vsc_limit *limit = &state->limit;
  size_t slot = 0;
  double centre[3];
  char what[VSC_NAME + 32], node[VSC_NODE_TEXT];
  const double own = 2 / sqrt(vsc_limit_bound(model, &state->scratch, &slot));
  // stiffness alone leaves at least this
  const bool rules = model->terms.damping && limit->step < model->safety * own / sqrt(1.1);
  say_part(problem, slot, what, sizeof what, centre);
  fprintf(out, "limited most ");
  if (model->terms.damping) {
    fprintf(out, "%sat %s; by stiffness alone ", rules ? "by damping, " : "",
            vsc_name_node(model, vsc_largest_node(model, limit->mode), node, sizeof node));
  }
  fprintf(out, "by %s at (%.4g, %.4g, %.4g), whose own bound is %.4g ms%s\n", what, centre[0], centre[1], centre[2], own,
          rules && may_couple(model) ? "; time.selective_mass_scaling makes steps of viscous tissue longer" : "");
}

static void say_step(const vsc_problem *problem, vsc_state *state, FILE *out)
{
  const vsc_model *model = problem->model;
  const double dt = model->step > 0 ? model->step : state->limit.step;
  fprintf(out, "step       %.4g ms (%s%s); stable at rest %.4g ms with safety %g; ", dt,
          model->step > 0 ? "given" : "automatic",
          model->step * model->safety > state->limit.step ? ", forced though it is not stable" : "", state->limit.step,
          model->safety);
  say_limit(problem, state, out);
  const vsc_scaled_mass *scaled = &model->scaled;
  if (scaled->step > 0)
    fprintf(out, "mass       %.3g %% added at %zu nodes, the most %.3g times what one weighs, for steps of %.4g ms\n",
            100 * scaled->added / model->total_mass, scaled->nodes, scaled->most, scaled->step);
  if (model->coupled.degree > 0)
    fprintf(out, "inertia    of neighbours against one another: %d pass%s over the nodes in each step, for steps of %.4g ms\n",
            model->coupled.degree, model->coupled.degree > 1 ? "es" : "", model->coupled.step);
}

static double memory_bytes(const vsc_model *model)
{
  const double per_element =
      4 + 1 + (model->amplitude ? 8 : 0) + (model->delay ? 8 : 0) + 16 + 72 + 1;
  const double loads = model->pressure_count + model->robin_count > 0 ? 32 : 0;
  const double contact = model->obstacle_count > 0 ? 3 * 32 + 1 : 0;
  const double coupled = model->coupled.degree > 0 ? 12.0 * model->coupled.start[model->node_count] : 0;
  const double per_node = (32 + 8 + 32 + 16 + 4) + 32 * (5 + 3 + 3 + 1) + 8 + loads + contact + (coupled > 0 ? 8 * 32 : 0);
  return (double)model->store_size + per_element * (double)model->element_count +
         per_node * (double)model->node_count + coupled + (double)(vsc_prony_size(model) * sizeof(double));
}

static vsc_status say_cost(const vsc_problem *problem, vsc_state *state, FILE *out,
                           vsc_error *error)
{
  const vsc_model *model = problem->model;
  const vsc_output_def *output = &problem->scene->output;
  const double dt = model->step > 0 ? model->step : state->limit.step;
  const double start = problem->scene->prestress.time;
  const double look = vsc_events_look(model, state, output->signal_interval);
  const double steps = vsc_events_steps(problem, look, start, dt);
  double seconds;
  const vsc_status status = measure_step(model, state, &seconds, error);
  if (status != VSC_OK) return status;
  seconds *= steps;
  const double frames = fmin(vsc_events_frames(problem, start), steps + 1);
  const double number = output->double_precision ? 8 : 4;
  const double frame =
      0.6 * number * (9.0 * (double)model->node_count + 6.0 * (double)model->element_count) +
      6.0 * (double)model->element_count;
  fprintf(out,
          "cost       %.4g ms = about %.0f steps: %.3g s of work on %d thread%s (%s); %.3g MB of "
          "memory; %.0f "
          "frames, about %.3g MB on disk\n",
          model->end_time - start, steps, seconds, vsc_parallel_threads(),
          vsc_parallel_threads() > 1 ? "s" : "", vsc_kernel_set(), 1e-6 * memory_bytes(model),
          frames, 1e-6 * frames * frame);
  return VSC_OK;
}

// The step and the cost of explicit stepping, found by doing some.
static vsc_status say_stepping(const vsc_problem *problem, FILE *out, vsc_error *error)
{
  const vsc_model *model = problem->model;
  vsc_state *state;
  vsc_status status = vsc_state_create(model, &state, error);
  if (status != VSC_OK) return status;
  status = vsc_in_scene(problem->scene->file, vsc_start(model, state, error), error);
  if (status == VSC_OK) {
    say_step(problem, state, out);
    status = vsc_in_scene(problem->scene->file, say_cost(problem, state, out, error), error);
  }
  vsc_state_free(state);
  return status;
}

// Relaxation has no matrix, and steps of its own.
static void say_relaxation(const vsc_model *model, FILE *out)
{
  fprintf(out, "solve      equilibrium at each frame and signal; relaxation to %g; %zu unknowns\n", model->solve.tolerance,
          3 * model->node_count);
}

// What Newton's method will work on.
static vsc_status say_newton(const vsc_problem *problem, FILE *out, vsc_error *error)
{
  static const char *const schemes[] = {"generalised alpha", "trapezoid", "BDF2"};
  static const char *const linears[] = {"auto", "direct", "iterative"};
  const vsc_model *model = problem->model;
  const vsc_solve_def *solve = &model->solve;
  vsc_tangent *tangent;
  const vsc_status status =
      vsc_in_scene(problem->scene->file, vsc_tangent_create(model, &tangent, error), error);
  if (status != VSC_OK) return status;
  if (solve->kind == VSC_SOLVE_IMPLICIT && model->step > 0)
    fprintf(out, "solve      implicit, %s, steps of %g ms", schemes[solve->scheme], model->step);
  else if (solve->kind == VSC_SOLVE_IMPLICIT)
    fprintf(out, "solve      implicit, %s, steps from their error: %g of the size of the body",
            schemes[solve->scheme], solve->accuracy);
  else
    fprintf(out, "solve      equilibrium at each frame and signal");
  if (solve->incompressible > 0) fprintf(out, ", volumes kept to %g by multipliers", solve->incompressible);
  const size_t blocks = tangent->matrix.start[model->node_count];
  fprintf(out, "; Newton to %g; %zu unknowns, a matrix of %.3g MB, systems %s\n", solve->tolerance,
          3 * model->node_count, 1e-6 * 72 * (double)blocks, linears[solve->linear]);
  vsc_tangent_free(tangent);
  return VSC_OK;
}

vsc_status vsc_check_method(const vsc_problem *problem, FILE *stream, vsc_error *error)
{
  const vsc_solve_def *solve = &problem->model->solve;
  if (solve->kind == VSC_SOLVE_EXPLICIT) return say_stepping(problem, stream, error);
  if (solve->kind == VSC_SOLVE_EQUILIBRIUM && solve->method == VSC_STATICS_RELAXATION) {
    say_relaxation(problem->model, stream);
    return VSC_OK;
  }
  return say_newton(problem, stream, error);
}
