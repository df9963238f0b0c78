// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/prestress.h"

#include <math.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "base/vec3.h"
#include "model/small_strain.h"
#include "solve/equilibrium.h"
#include "solve/mass_scaling.h"
#include "solve/newton.h"

// Elements of the mesh are not of the volumes that they have at rest, from which Newton's method finds no way where
// they are nearly incompressible. So it goes over bodies whose volume moduli are smaller: the first has none above SOFT
// times the shear modulus, or a part 1/SOFTEST of the scene's, each next is SOFTER times as stiff.
enum { SOFT = 200, SOFTEST = 729, SOFTER = 3 };
// Forces that are off by a part of those at work move nodes by that part of the body's size at most, about. Equilibria are
// found better than the distance that is asked for: else the mesh itself would pass for the loaded shape.
#define FINER 0.1

// The shape that is tried.
typedef struct trial {
  vsc_problem *problem;
  vsc_definition definition;  // the scene's with materials of its own, owned
  const double *target;  // node_count x 4: the mesh
  vsc_mesh mesh;         // the mesh at rest: its nodes are owned, the rest is the problem's
  vsc_axes *axes;        // owned
  double softest;        // a power of SOFTER
} trial;

static void free_trial(trial *t)
{
  vsc_free(t->mesh.nodes);
  vsc_axes_free(t->axes);
  vsc_free(t->definition.materials);
}

// VSC_NUMERICAL where an element of the mesh is inside out at a point of its rule.
static vsc_status check_shape(const vsc_mesh *mesh, vsc_error *error)
{
  vsc_cell_rule rules[VSC_CELLS];
  for (int kind = 0; kind < VSC_CELLS; kind++) rules[kind] = vsc_cell_rule_of((vsc_cell)kind);
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_rule *rule = &rules[mesh->kinds[e]];
    double det[VSC_MOST_POINTS];
    vsc_mesh_jacobians(mesh, e, rule, det);
    for (int q = 0; q < rule->points; q++)
      if (!(det[q] > 0))
        return vsc_fail(error, VSC_NUMERICAL, "element %u is inside out at rest", mesh->element_source[e]);
  }
  return VSC_OK;
}

// Takes a shape for the one at rest. VSC_NUMERICAL where it is none.
static vsc_status take_shape(trial *t, const double *rest, vsc_error *error)
{
  for (size_t n = 0; n < t->mesh.node_count; n++)
    for (size_t i = 0; i < 3; i++) t->mesh.nodes[3 * n + i] = rest[4 * n + i];
  const vsc_status status = check_shape(&t->mesh, error);
  if (status == VSC_OK) vsc_axes_carry_back(t->problem->axes, t->problem->mesh, t->mesh.nodes, t->axes);
  return status;
}

// The model of that shape, with a part of the volume moduli.
static vsc_status make_model(trial *t, double part, vsc_model **model, vsc_error *error)
{
  const vsc_definition *whole = &t->problem->scene->definition;
  for (size_t m = 0; m < whole->material_count; m++)
    t->definition.materials[m].volume_modulus = part * whole->materials[m].volume_modulus;
  return vsc_model_build_shown(&t->mesh, t->problem->mesh, t->axes, &t->definition, model, error);
}

// The equilibrium of the model, from `start` (node_count x 4, the mesh's order), where the loads are borne already, or,
// of NULL, from rest. x, likewise, may be `start`.
static vsc_status balance(const trial *t, vsc_model *model, const double *start, double *x, vsc_error *error)
{
  vsc_state *state;
  // the run's own forces, but balanced
  model->solve.kind = VSC_SOLVE_EQUILIBRIUM;
  model->solve.method = VSC_STATICS_NEWTON;
  const double finest = FINER * t->problem->scene->prestress.tolerance / vsc_body_size(model);
  const double given = t->definition.solve.tolerance;
  model->solve.tolerance = fmin(given > 0 ? given : VSC_USUAL_TOLERANCE, finest);
  vsc_status status = vsc_state_create(model, &state, error);
  if (status != VSC_OK) return status;
  state->time = t->problem->scene->prestress.time;
  state->loaded = start != NULL;
  for (size_t n = 0; n < model->node_count && start != NULL; n++)
    memcpy(state->x + 4 * n, start + 4 * (size_t)model->mesh_node[n], 4 * sizeof *x);
  status = vsc_equilibrium_start(model, state, error);
  if (status == VSC_OK) status = vsc_equilibrium_to(model, state, state->time, error);
  for (size_t n = 0; n < model->node_count && status == VSC_OK; n++)
    memcpy(x + 4 * (size_t)model->mesh_node[n], state->x + 4 * n, 4 * sizeof *x);
  vsc_state_free(state);
  return status;
}

static vsc_status load_part(trial *t, double part, const double *start, double *x, vsc_error *error)
{
  vsc_model *model = NULL;
  vsc_status status = make_model(t, part, &model, error);
  if (status == VSC_OK) status = balance(t, model, start, x, error);
  vsc_model_free(model);
  return status;
}

// From the mesh, which the loaded shape comes near to, or from rest; first of the softest body. From rest, too, where a
// stiffer one is not found from a softer one.
static vsc_status load(void *context, const double *rest, double *x, vsc_error *error)
{
  trial *t = context;
  vsc_status status = take_shape(t, rest, error);
  if (status != VSC_OK) return status;
  status = load_part(t, 1 / t->softest, t->target, x, error);
  if (status == VSC_NUMERICAL) status = load_part(t, 1 / t->softest, NULL, x, error);
  for (double softer = t->softest / SOFTER; softer >= 1 && status == VSC_OK; softer /= SOFTER)
    status = load_part(t, 1 / softer, x, x, error);
  return status == VSC_NUMERICAL && t->softest > 1 ? load_part(t, 1, NULL, x, error) : status;
}

static void keep_row(void *context, const vsc_prestress_row *row)
{
  vsc_unloaded *unloaded = ((trial *)context)->problem->unloaded;
  unloaded->rows[unloaded->row_count++] = *row;
}

// The model on the shape that was found, in the place of the one on the mesh.
static vsc_status take_model(trial *t, vsc_error *error)
{
  vsc_problem *problem = t->problem;
  vsc_model *model = NULL;
  vsc_status status = take_shape(t, problem->unloaded->rest, error);
  if (status == VSC_OK) status = make_model(t, 1, &model, error);
  if (status == VSC_OK) status = vsc_scale_masses(model, &problem->scene->definition, error);
  if (status != VSC_OK) {
    vsc_model_free(model);
    return status;
  }
  vsc_model_free(problem->model);
  problem->model = model;
  problem->unloaded->found = true;
  return VSC_OK;
}

static void measure(const double *target, size_t node_count, vsc_unloaded *unloaded)
{
  for (size_t n = 0; n < node_count; n++) {
    double way[3];
    vsc_subtract(target + 4 * n, unloaded->rest + 4 * n, way);
    unloaded->furthest = fmax(unloaded->furthest, vsc_norm(way));
  }
}

static double softest_of(const vsc_model *model)
{
  double softest = 1;
  for (size_t m = 0; m < model->material_count; m++)
    while (softest < SOFTEST &&
           model->materials[m].volume_modulus / softest > SOFT * vsc_material_shear(model, &model->materials[m]))
      softest *= SOFTER;
  return softest;
}

static vsc_status find(trial *t, vsc_error *error)
{
  const vsc_prestress_def *def = &t->problem->scene->prestress;
  vsc_unloaded *unloaded = t->problem->unloaded;
  const vsc_prestress search = {.node_count = t->mesh.node_count, .target = t->target, .tolerance = def->tolerance,
                                .most = def->iterations, .context = t, .load = load, .watch = keep_row};
  return vsc_prestress_find(&search, unloaded->rest, unloaded->start, error);
}

// The model on the mesh tells of all that the shape depends on but for this.
static uint64_t hash_problem(const vsc_problem *problem)
{
  const vsc_prestress_def *def = &problem->scene->prestress;
  const double asked[] = {def->time, def->tolerance};
  return vsc_hash(problem->model->hash, asked, sizeof asked);
}

vsc_status vsc_unloaded_create(vsc_problem *problem, vsc_error *error)
{
  const size_t count = problem->mesh->node_count;
  vsc_unloaded *made;
  vsc_unloaded_free(problem->unloaded);
  problem->unloaded = NULL;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "the shape at rest");
  problem->unloaded = made;
  made->hash = hash_problem(problem);
  if (VSC_NEW(made->rest, 4 * count) && VSC_NEW(made->start, 4 * count) &&
      VSC_NEW(made->rows, (size_t)problem->scene->prestress.iterations + 1))
    return VSC_OK;
  return vsc_fail_memory(error, "the shape at rest");
}

// The shape in problem->unloaded, looked for or known, and its model.
static vsc_status unload(vsc_problem *problem, bool known, vsc_error *error)
{
  const vsc_mesh *mesh = problem->mesh;
  const size_t count = mesh->node_count;
  const vsc_definition *definition = &problem->scene->definition;
  trial t = {.problem = problem, .definition = *definition, .mesh = *mesh,
             .softest = softest_of(problem->model)};
  double *target = NULL;
  vsc_status status = VSC_OK;
  t.mesh.nodes = NULL;
  t.definition.materials = NULL;
  if (!VSC_NEW(target, 4 * count) || !VSC_NEW(t.mesh.nodes, 3 * count) ||
      !VSC_NEW(t.definition.materials, definition->material_count) ||
      (t.axes = vsc_axes_create_for(mesh)) == NULL)
    status = vsc_fail_memory(error, "the shape at rest");
  for (size_t i = 0; i < 3 * count && status == VSC_OK; i++) target[4 * (i / 3) + i % 3] = mesh->nodes[i];
  if (status == VSC_OK)
    memcpy(t.definition.materials, definition->materials, definition->material_count * sizeof *definition->materials);
  t.target = target;
  if (status == VSC_OK && !known) status = find(&t, error);
  if (status == VSC_OK) status = take_model(&t, error);
  if (status == VSC_OK) measure(target, count, problem->unloaded);
  vsc_free(target);
  free_trial(&t);
  return status;
}

vsc_status vsc_unload(vsc_problem *problem, vsc_error *error)
{
  const vsc_status status = vsc_unloaded_create(problem, error);
  return status == VSC_OK ? unload(problem, false, error) : status;
}

vsc_status vsc_unload_again(vsc_problem *problem, vsc_error *error)
{
  problem->unloaded->row_count = 1;
  return unload(problem, true, error);
}

void vsc_unloaded_free(vsc_unloaded *unloaded)
{
  if (unloaded == NULL) return;
  vsc_free(unloaded->rest);
  vsc_free(unloaded->start);
  vsc_free(unloaded->rows);
  vsc_free(unloaded);
}
