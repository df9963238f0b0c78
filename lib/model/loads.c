// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "model/masses.h"
#include "model/mixture.h"
#include "model/robin.h"
#include "model/terms.h"

static vsc_status add_pressure(const vsc_definition *definition, size_t p, const uint32_t *number,
                               vsc_model *model, vsc_error *error)
{
  const vsc_pressure_def *def = &definition->pressures[p];
  const int surface = vsc_model_find_surface(model, def->surface);
  if (surface < 0)
    return vsc_fail(error, VSC_INPUT,
                    "pressures[%zu].surface: no surface is called '%s'; define it under surfaces",
                    p, def->surface);
  vsc_pressure *load = &model->pressures[p];
  vsc_copy_name(load->surface, def->surface);
  load->peak = def->peak;
  memcpy(load->direction, def->direction, sizeof load->direction);
  if (vsc_norm(load->direction) > 0) vsc_normalize(load->direction);
  const vsc_status status = vsc_facets_make(&model->surfaces[surface], &load->facets, error);
  if (status != VSC_OK) return status;
  vsc_facets_renumber(&load->facets, number);
  load->rule = vsc_face_rule_of(load->facets.mid ? 6 : 3, VSC_FACE_FLUX);
  return vsc_curve_of("pressures", p, "", vsc_curve_build(&def->curve, definition->end_time, &load->curve, error), error);
}

static vsc_status add_robin(const vsc_robin_def *def, size_t r, const uint32_t *number,
                            vsc_model *model, vsc_error *error)
{
  const int surface = vsc_model_find_surface(model, def->surface);
  if (surface < 0)
    return vsc_fail(error, VSC_INPUT,
                    "robin[%zu].surface: no surface is called '%s'; define it under surfaces", r,
                    def->surface);
  vsc_robin *robin = &model->robins[r];
  vsc_copy_name(robin->surface, def->surface);
  robin->stiffness = def->stiffness;
  robin->damping = def->damping;
  robin->normal = def->normal;
  model->terms.damping |= def->damping > 0;
  vsc_facets facets;
  vsc_status status = vsc_facets_make(&model->surfaces[surface], &facets, error);
  if (status != VSC_OK) return status;
  vsc_facets_renumber(&facets, number);
  status = vsc_robin_fill(model->rest, &facets, robin, error);
  vsc_facets_free(&facets);
  return status;
}

// int rho N_i g dV of quadratic tets by the points of their frames, where their edges are. It is below 0 at corners:
// what their lumped masses, which are not, would weigh is another load.
static void weigh_quadratic(const vsc_model *model, const double *density, double *weight)
{
  const vsc_cell_rule *rule = &model->rules[VSC_TETS10];
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (patch->family != VSC_TETS10) continue;
    for (size_t slot = 0; slot < VSC_WIDTH * (size_t)patch->pack_count; slot++) {
      const size_t k = patch->first_pack + slot / VSC_WIDTH, l = slot % VSC_WIDTH;
      const uint32_t element = model->mesh_element[VSC_WIDTH * k + l];
      if (element == VSC_NO_ELEMENT) continue;
      for (int i = 0; i < vsc_family_corners(patch->family); i++) {
        const size_t node = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[i][l]);
        double volume = 0;
        for (int q = 0; q < rule->points; q++)
          volume += vsc_pack_frames(model, patch, k)[q].V[l] * rule->N[q][i];
        for (size_t a = 0; a < 3; a++) weight[4 * node + a] += density[element] * volume * model->gravity[a];
      }
    }
  }
}

static bool is_quadratic(const vsc_model *model)
{
  return model->patch_count > 0 && model->patches[0].family == VSC_TETS10;
}

static vsc_status add_quadratic(const vsc_mesh *mesh, const vsc_definition *definition, const uint32_t *material_of,
                                vsc_model *model, vsc_error *error)
{
  double *density;
  if (!VSC_NEW(density, mesh->element_count)) return vsc_fail_memory(error, "the weight");
  const vsc_status status = vsc_mixture_densities(mesh, definition, material_of, density, error);
  if (status == VSC_OK) weigh_quadratic(model, density, model->weight);
  vsc_free(density);
  return status;
}

static vsc_status add_weight(const vsc_mesh *mesh, const vsc_definition *definition, const uint32_t *material_of,
                             vsc_model *model, vsc_error *error)
{
  const double *gravity = definition->gravity;
  memcpy(model->gravity, gravity, sizeof model->gravity);
  model->terms.gravity = gravity[0] != 0 || gravity[1] != 0 || gravity[2] != 0;
  if (!model->terms.gravity) return VSC_OK;
  if (!VSC_NEW(model->weight, 4 * model->node_count)) return vsc_fail_memory(error, "the weight");
  const bool lumped = definition->solve.kind != VSC_SOLVE_EQUILIBRIUM &&
                      definition->masses != VSC_MASS_CONSISTENT;
  if (is_quadratic(model) && !lumped) return add_quadratic(mesh, definition, material_of, model, error);
  for (size_t n = 0; n < model->node_count; n++)
    for (int i = 0; i < 3; i++) model->weight[4 * n + i] = model->mass[n] * gravity[i];
  return VSC_OK;
}

vsc_status vsc_terms_loads(const vsc_mesh *mesh, const vsc_definition *definition, const uint32_t *material_of,
                           vsc_model *model, vsc_error *error)
{
  vsc_status status = add_weight(mesh, definition, material_of, model, error);
  model->pressure_count = definition->pressure_count;
  model->robin_count = definition->robin_count;
  if (!VSC_NEW(model->pressures, model->pressure_count) ||
      !VSC_NEW(model->robins, model->robin_count))
    return vsc_fail_memory(error, "loads");
  uint32_t *number = vsc_model_node_numbers(model);
  if (number == NULL) return vsc_fail_memory(error, "node numbers");
  for (size_t p = 0; p < definition->pressure_count && status == VSC_OK; p++)
    status = add_pressure(definition, p, number, model, error);
  for (size_t r = 0; r < definition->robin_count && status == VSC_OK; r++)
    status = add_robin(&definition->robins[r], r, number, model, error);
  vsc_free(number);
  return status;
}
