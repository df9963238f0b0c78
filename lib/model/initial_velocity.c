// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>

#include "base/mem.h"
#include "model/terms.h"

static vsc_status find_array(const vsc_mesh *mesh, const char *name, const vsc_array **array,
                             vsc_error *error)
{
  char hint[256];
  *array = vsc_arrays_find(&mesh->node_data, name);
  vsc_arrays_hint(&mesh->node_data, name, hint, sizeof hint);
  if (*array == NULL)
    return vsc_fail(error, VSC_INPUT, "initial_velocity.node_array: the mesh has no node array '%s'%s",
                    name, hint);
  if ((*array)->components != 3)
    return vsc_fail(error, VSC_INPUT,
                    "initial_velocity.node_array: '%s' has %d number%s a node; a velocity has three: x, y, z",
                    name, (*array)->components, (*array)->components == 1 ? "" : "s");
  return VSC_OK;
}

// The velocity of one node where it is free; false when it is not finite.
static bool give_velocity(const double given[3], double unit, size_t node, vsc_model *model)
{
  bool stopped = false;
  for (size_t i = 0; i < 3; i++) {
    const double v = unit * given[i];
    if (!isfinite(v)) return false;
    const bool held = model->inverse_mass[4 * node + i] == 0;
    stopped |= held && v != 0;
    model->velocity[4 * node + i] = held ? 0 : v;
  }
  model->stopped_count += stopped;
  return true;
}

vsc_status vsc_terms_velocity(const vsc_mesh *mesh, const vsc_definition *definition,
                              vsc_model *model, vsc_error *error)
{
  const vsc_velocity_def *def = &definition->velocity;
  const vsc_array *array;
  if (def->array[0] == '\0') return VSC_OK;
  vsc_status status = find_array(mesh, def->array, &array, error);
  if (status != VSC_OK) return status;
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL || !VSC_NEW(model->velocity, 4 * model->node_count))
    status = vsc_fail_memory(error, "the initial velocity");
  for (size_t n = 0; n < mesh->node_count && status == VSC_OK; n++)
    if (!give_velocity(array->values + 3 * n, def->unit, number[n], model))
      status = vsc_fail(error, VSC_INPUT,
                        "initial_velocity.node_array: '%s' is (%g, %g, %g) at node %u of the mesh's file; "
                        "give finite numbers",
                        def->array, array->values[3 * n], array->values[3 * n + 1],
                        array->values[3 * n + 2], mesh->node_source[n]);
  vsc_free(number);
  return status;
}
