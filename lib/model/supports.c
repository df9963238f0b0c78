// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "model/terms.h"

vsc_status vsc_terms_selections(const vsc_mesh *mesh, const vsc_definition *definition,
                                vsc_model *model, vsc_error *error)
{
  // the whole boundary goes first, under its own name, unless the user gave that name to something
  // else
  bool taken = false;
  for (size_t s = 0; s < definition->surface_count; s++)
    taken |= strcmp(definition->surfaces[s].name, "boundary") == 0;
  if (!VSC_NEW(model->surfaces, definition->surface_count + 1) ||
      !VSC_NEW(model->sets, definition->set_count))
    return vsc_fail_memory(error, "surfaces and node sets");
  vsc_surface boundary = {0};
  vsc_status status = vsc_boundary(mesh, &boundary, error);
  for (size_t s = 0; status == VSC_OK && s < definition->surface_count; s++)
    status = vsc_select_surface(mesh, &boundary, &definition->surfaces[s],
                                &model->surfaces[model->surface_count++], error);
  if (status != VSC_OK || taken) {
    vsc_surface_free(&boundary);
  } else {
    vsc_copy_name(boundary.name, "boundary");
    model->surfaces[model->surface_count++] = boundary;
  }
  for (size_t s = 0; status == VSC_OK && s < definition->set_count; s++)
    status = vsc_select_nodes(mesh, &definition->sets[s], model->surfaces, model->surface_count,
                              &model->sets[model->set_count++], error);
  return status;
}

static const vsc_node_set *find_set(const vsc_model *model, const char *name)
{
  for (size_t s = 0; s < model->set_count; s++)
    if (strcmp(model->sets[s].name, name) == 0) return &model->sets[s];
  return NULL;
}

static void hold(vsc_model *model, const vsc_node_set *set, const int held[3],
                 const uint32_t *number)
{
  for (size_t k = 0; k < set->count; k++)
    for (int i = 0; i < 3; i++)
      if (held[i]) model->inverse_mass[4 * (size_t)number[set->nodes[k]] + i] = 0;
}

static void count_held(vsc_model *model)
{
  for (size_t n = 0; n < model->node_count; n++) {
    const double *inverse = model->inverse_mass + 4 * n;
    if (inverse[0] == 0 || inverse[1] == 0 || inverse[2] == 0) model->held_count++;
  }
}

vsc_status vsc_terms_supports(const vsc_definition *definition, vsc_model *model, vsc_error *error)
{
  if (definition->support_count == 0) return VSC_OK;
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL) return vsc_fail_memory(error, "node numbers");
  vsc_status status = VSC_OK;
  for (size_t s = 0; s < definition->support_count && status == VSC_OK; s++) {
    const vsc_support_def *support = &definition->supports[s];
    const vsc_node_set *set = find_set(model, support->set);
    if (set == NULL)
      status = vsc_fail(error, VSC_INPUT,
                        "supports[%zu].set: no node set is called '%s'; define it under node_sets",
                        s, support->set);
    else
      hold(model, set, support->held, number);
  }
  count_held(model);
  vsc_free(number);
  return status;
}

static vsc_status add_pressure(const vsc_definition *definition, size_t p, const uint32_t *number,
                               vsc_model *model, vsc_error *error)
{
  const vsc_pressure_def *def = &definition->pressures[p];
  const int surface = vsc_model_find_surface(model, def->surface);
  if (surface < 0)
    return vsc_fail(error, VSC_INPUT,
                    "pressures[%zu].surface: no surface is called '%s'; define it under surfaces",
                    p, def->surface);
  const vsc_surface *triangles = &model->surfaces[surface];
  vsc_pressure *load = &model->pressures[p];
  vsc_copy_name(load->surface, def->surface);
  load->peak = def->peak;
  load->triangle_count = triangles->count;
  if (!VSC_NEW(load->triangles, 3 * triangles->count))
    return vsc_fail_memory(error, "a pressure load");
  for (size_t k = 0; k < 3 * triangles->count; k++)
    load->triangles[k] = number[triangles->triangles[k]];
  return vsc_curve_build(&def->curve, definition->end_time, &load->curve, error);
}

static vsc_status add_weight(const vsc_definition *definition, vsc_model *model, vsc_error *error)
{
  const double *gravity = definition->gravity;
  memcpy(model->gravity, gravity, sizeof model->gravity);
  model->terms.gravity = gravity[0] != 0 || gravity[1] != 0 || gravity[2] != 0;
  if (!model->terms.gravity) return VSC_OK;
  if (!VSC_NEW(model->weight, 4 * model->node_count)) return vsc_fail_memory(error, "the weight");
  for (size_t n = 0; n < model->node_count; n++)
    for (int i = 0; i < 3; i++) model->weight[4 * n + i] = model->mass[n] * gravity[i];
  return VSC_OK;
}

vsc_status vsc_terms_loads(const vsc_definition *definition, vsc_model *model, vsc_error *error)
{
  vsc_status status = add_weight(definition, model, error);
  if (status != VSC_OK || definition->pressure_count == 0) return status;
  model->pressure_count = definition->pressure_count;
  if (!VSC_NEW(model->pressures, model->pressure_count))
    return vsc_fail_memory(error, "pressure loads");
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL) return vsc_fail_memory(error, "node numbers");
  for (size_t p = 0; p < definition->pressure_count && status == VSC_OK; p++)
    status = add_pressure(definition, p, number, model, error);
  vsc_free(number);
  return status;
}
