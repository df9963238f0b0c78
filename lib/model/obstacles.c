// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid planes and spheres that nodes may not enter.
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "model/terms.h"

static const double ROUNDING = 1e-9;  // of an element's size, by which nodes may begin inside

static vsc_status list_nodes(const vsc_definition *definition, size_t o, const uint32_t *number,
                             const vsc_model *model, vsc_obstacle *obstacle, vsc_error *error)
{
  const char *name = definition->obstacles[o].set;
  const vsc_node_set *set = NULL;
  for (size_t s = 0; s < model->set_count; s++)
    if (strcmp(model->sets[s].name, name) == 0) set = &model->sets[s];
  obstacle->node_count = set != NULL ? set->count : model->node_count;
  if (!VSC_NEW(obstacle->nodes, obstacle->node_count))
    return vsc_fail_memory(error, "an obstacle's nodes");
  for (size_t k = 0; k < obstacle->node_count; k++)
    obstacle->nodes[k] = set != NULL ? number[set->nodes[k]] : (uint32_t)k;
  return VSC_OK;
}

void vsc_obstacle_place(const vsc_obstacle *obstacle, double time, double point[3])
{
  const double part = vsc_curve_value(&obstacle->curve, time);
  for (int i = 0; i < 3; i++) point[i] = obstacle->point[i] + part * obstacle->motion[i];
}

double vsc_obstacle_gap(const vsc_obstacle *obstacle, const double point[3], const double x[3],
                        double normal[3])
{
  double way[3];
  vsc_subtract(x, point, way);
  if (obstacle->kind == VSC_OBSTACLE_PLANE) {
    memcpy(normal, obstacle->normal, 3 * sizeof *normal);
    return vsc_dot(way, normal);
  }
  memcpy(normal, way, 3 * sizeof *normal);
  const double distance = vsc_normalize(normal);
  if (distance == 0) normal[2] = 1;  // any way out of the centre will do
  return distance - obstacle->radius;
}

static vsc_status check_start(const vsc_mesh *mesh, const vsc_model *model, size_t o,
                              vsc_error *error)
{
  const vsc_obstacle *obstacle = &model->obstacles[o];
  double point[3], normal[3], deepest = 0;
  uint32_t worst = 0;
  vsc_obstacle_place(obstacle, 0, point);
  for (size_t k = 0; k < obstacle->node_count; k++) {
    const double gap =
        vsc_obstacle_gap(obstacle, point, model->rest + 4 * (size_t)obstacle->nodes[k], normal);
    if (gap < deepest) worst = obstacle->nodes[k];
    deepest = fmin(deepest, gap);
  }
  if (deepest >= -ROUNDING * model->element_size) return VSC_OK;
  const double *at = model->rest + 4 * (size_t)worst;
  return vsc_fail(error, VSC_INPUT,
                  "obstacles[%zu]: node %u at (%.4g, %.4g, %.4g) mm begins %.3g mm inside it; move "
                  "the obstacle, turn its normal, or give the `set` of nodes that it stops",
                  o, mesh->node_source[model->mesh_node[worst]], at[0], at[1], at[2], -deepest);
}

vsc_status vsc_terms_obstacles(const vsc_mesh *mesh, const vsc_definition *definition,
                               vsc_model *model, vsc_error *error)
{
  model->obstacle_count = definition->obstacle_count;
  if (!VSC_NEW(model->obstacles, model->obstacle_count)) return vsc_fail_memory(error, "obstacles");
  if (model->obstacle_count == 0) return VSC_OK;
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL) return vsc_fail_memory(error, "node numbers");
  vsc_status status = VSC_OK;
  for (size_t o = 0; o < model->obstacle_count && status == VSC_OK; o++) {
    const vsc_obstacle_def *def = &definition->obstacles[o];
    vsc_obstacle *obstacle = &model->obstacles[o];
    obstacle->kind = def->kind;
    memcpy(obstacle->point, def->point, sizeof obstacle->point);
    memcpy(obstacle->normal, def->normal, sizeof obstacle->normal);
    memcpy(obstacle->motion, def->motion, sizeof obstacle->motion);
    vsc_normalize(obstacle->normal);
    obstacle->radius = def->radius;
    obstacle->friction = def->friction;
    status = vsc_curve_of("obstacles", o, "",
                          vsc_curve_build(&def->curve, definition->end_time, &obstacle->curve, error), error);
    if (status == VSC_OK) status = list_nodes(definition, o, number, model, obstacle, error);
    if (status == VSC_OK) status = check_start(mesh, model, o, error);
  }
  vsc_free(number);
  return status;
}
