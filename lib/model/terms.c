// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/terms.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "model/calm.h"

vsc_status vsc_terms_element_values(const vsc_mesh *mesh, const char *name, const char *key,
                                const double **values, vsc_error *error)
{
  *values = NULL;
  if (name[0] == '\0') return VSC_OK;
  const vsc_array *array = vsc_arrays_find(&mesh->element_data, name);
  if (array != NULL && array->components == 1) {
    *values = array->values;
    return VSC_OK;
  }
  char hint[256];
  vsc_arrays_hint(&mesh->element_data, name, hint, sizeof hint);
  return vsc_fail(error, VSC_INPUT,
                  "%s: the mesh has no cell array '%s' with one number per element%s", key, name,
                  hint);
}

// The material whose list of regions holds `region`; else the one without a list (inclusions have
// none either, but no elements of their own); else -1.
static int material_of_region(const vsc_definition *definition, double region)
{
  int rest = -1;
  for (size_t m = 0; m < definition->material_count; m++) {
    const vsc_material_def *material = &definition->materials[m];
    if (material->region_count == 0 && vsc_takes_elements(definition, m)) rest = (int)m;
    for (size_t r = 0; r < material->region_count; r++)
      if (region == material->regions[r]) return (int)m;
  }
  return rest;
}

static bool is_region(double number)
{
  return isfinite(number) && number >= INT_MIN && number <= INT_MAX && number == floor(number);
}

vsc_status vsc_terms_materials(const vsc_mesh *mesh, const vsc_definition *definition, uint32_t *material_of,
                               vsc_error *error)
{
  const double *regions;
  const vsc_status status =
      vsc_terms_element_values(mesh, definition->region_array, "mesh.region_array", &regions, error);
  if (status != VSC_OK) return status;
  for (size_t t = 0; t < mesh->element_count; t++) {
    const double region = regions ? regions[t] : 0;
    if (!is_region(region))
      return vsc_fail(error, VSC_INPUT,
                      "mesh.region_array: element %u has %.10g in array '%s', and regions are whole numbers from %d to "
                      "%d: correct the array, or name another",
                      mesh->element_source[t], region, definition->region_array, INT_MIN, INT_MAX);
    const int material = material_of_region(definition, region);
    if (material < 0)
      return vsc_fail(
          error, VSC_INPUT,
          "materials: element %u has region %g, which no material names: add the region to a "
          "material's `regions` or give one material without `regions`",
          mesh->element_source[t], region);
    material_of[t] = (uint32_t)material;
  }
  return VSC_OK;
}

static vsc_status fill_activation(const vsc_mesh *mesh, const vsc_definition *definition, size_t m,
                                  vsc_model *model, vsc_error *error)
{
  const vsc_active_def *active = &definition->materials[m].active;
  const double *amplitudes, *delays;
  char key[VSC_NAME];
  snprintf(key, sizeof key, "materials[%zu].active.amplitude_array", m);
  vsc_status status = vsc_terms_element_values(mesh, active->amplitude_array, key, &amplitudes, error);
  snprintf(key, sizeof key, "materials[%zu].active.delay_array", m);
  if (status == VSC_OK)
    status = vsc_terms_element_values(mesh, active->delay_array, key, &delays, error);
  if (status != VSC_OK) return status;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch) || patch->material != m) continue;
    const size_t first = VSC_WIDTH * (size_t)patch->first_pack;
    for (size_t slot = first; slot < first + VSC_WIDTH * (size_t)patch->pack_count; slot++) {
      const uint32_t element = model->mesh_element[slot];
      if (element == VSC_NO_ELEMENT) continue;
      const double amplitude = amplitudes ? amplitudes[element] : 1;
      const double delay = delays ? delays[element] * active->delay_unit : 0;
      if (!isfinite(amplitude) || !isfinite(delay))
        return vsc_fail(error, VSC_INPUT,
                        "materials[%zu].active: element %u has amplitude %g and delay %g ms; both "
                        "must be finite",
                        m, mesh->element_source[element], amplitude, delay);
      if (model->amplitude) model->amplitude[slot] = model->known[slot] ? amplitude : 0;
      if (model->delay) model->delay[slot] = delay;
    }
  }
  return VSC_OK;
}

static vsc_status fill_activations(const vsc_mesh *mesh, const vsc_definition *definition,
                                   vsc_model *model, vsc_error *error)
{
  const size_t slots = VSC_WIDTH * model->pack_count;
  bool amplitudes = false, delays = false;
  for (size_t slot = 0; slot < slots; slot++)
    if (model->mesh_element[slot] != VSC_NO_ELEMENT && !model->known[slot]) amplitudes = true;
  for (size_t m = 0; m < definition->material_count; m++) {
    amplitudes |= definition->materials[m].active.amplitude_array[0] != '\0';
    delays |= definition->materials[m].active.delay_array[0] != '\0';
  }
  if ((amplitudes && !VSC_NEW(model->amplitude, slots)) ||
      (delays && !VSC_NEW(model->delay, slots)))
    return vsc_fail_memory(error, "the activation of the elements");
  if (!amplitudes && !delays) return VSC_OK;
  for (size_t m = 0; m < definition->material_count; m++) {
    const vsc_status status = fill_activation(mesh, definition, m, model, error);
    if (status != VSC_OK) return status;
  }
  return VSC_OK;
}

// A delay below 0 lets elements be ahead of the run.
static vsc_status build_curves(const vsc_definition *definition, vsc_model *model, vsc_error *error)
{
  for (size_t m = 0; m < definition->material_count; m++) {
    const vsc_active_def *active = &definition->materials[m].active;
    double delays[2];
    if (active->kind == VSC_ACTIVE_NONE) continue;
    vsc_model_delays(model, m, delays);
    const double end = definition->end_time - fmin(active->delay + delays[0], 0);
    const vsc_status status = vsc_curve_of(
        "materials", m, "active.", vsc_curve_build(&active->curve, end, &model->materials[m].curve, error), error);
    if (status != VSC_OK) return status;
  }
  return VSC_OK;
}

vsc_status vsc_terms_activation(const vsc_mesh *mesh, const vsc_definition *definition,
                                vsc_model *model, vsc_error *error)
{
  if (model->terms.active == VSC_ACTIVE_NONE) return VSC_OK;
  const vsc_status status = fill_activations(mesh, definition, model, error);
  return status == VSC_OK ? build_curves(definition, model, error) : status;
}

// What solver.incompressible would pass over.
static vsc_status check_multipliers(const vsc_model *model, vsc_error *error)
{
  for (size_t p = 0; p < model->patch_count && model->solve.incompressible > 0; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (patch->family == VSC_TETS && !vsc_patch_shares_volume(model, patch))
      return vsc_fail(error, VSC_INPUT,
                      "solver.incompressible: linear tetrahedra that each keep a volume of their own (%s) would lock "
                      "and are not kept: use volume: nodal, or mesh.order: 2",
                      model->materials[patch->material].name);
  }
  return VSC_OK;
}

vsc_status vsc_terms_volume_groups(vsc_model *model, vsc_error *error)
{
  const vsc_status status = check_multipliers(model, error);
  if (status != VSC_OK) return status;
  if (!model->terms.nodal_volume) return VSC_OK;
  if (!VSC_NEW(model->group_volume, model->node_count) ||
      !VSC_NEW(model->group_modulus, model->node_count))
    return vsc_fail_memory(error, "volume groups");
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_shares_volume(model, patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int c = 0; c < 4; c++)
        for (int l = 0; l < VSC_WIDTH; l++) {
          const uint32_t node = vsc_node_of(model, patch, vsc_pack_nodes(model, patch, k)[c][l]);
          const double share = vsc_pack_frames(model, patch, k)->V[l] / 4;
          const double modulus = patch->mixed
                                     ? vsc_pack_mixture(model, patch, k)->volume_modulus[l]
                                     : model->materials[patch->material].volume_modulus;
          if (share == 0) continue;  // a lane without an element
          model->group_volume[node] += share;
          model->group_modulus[node] += modulus > 0 ? share / modulus : INFINITY;
        }
  }
  // Tissues that meet have one pressure and give way each by its own modulus: 1/K = sum(V_t/K_t)/sum V_t
  for (size_t n = 0; n < model->node_count; n++)
    if (model->group_volume[n] > 0)
      model->group_modulus[n] = model->group_volume[n] / model->group_modulus[n];
    else
      model->group_volume[n] = 1;
  return VSC_OK;
}
