// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/mixture.h"

#include <stdio.h>
#include <string.h>

#include "model/terms.h"

// One inclusion of a material: the other material and the elements' fractions.
typedef struct inclusion {
  size_t other;
  const double *fractions;
} inclusion;

enum { MOST = 32 };  // inclusions of a material

static const double ROUNDING = 1e-9;  // by which fractions may leave [0, 1]

static vsc_status find_inclusions(const vsc_mesh *mesh, const vsc_definition *definition, size_t m,
                                  inclusion found[MOST], vsc_error *error)
{
  const vsc_material_def *own = &definition->materials[m];
  if (own->inclusion_count > MOST)
    return vsc_fail(error, VSC_INPUT, "materials[%zu].inclusions: %zu of them; %d are the most", m,
                    own->inclusion_count, MOST);
  for (size_t k = 0; k < own->inclusion_count; k++) {
    char key[VSC_NAME];
    size_t other = 0;
    while (other < definition->material_count &&
           strcmp(definition->materials[other].name, own->inclusions[k].material) != 0)
      other++;
    snprintf(key, sizeof key, "materials[%zu].inclusions[%zu]", m, k);
    if (other == definition->material_count || other == m)
      return vsc_fail(error, VSC_INPUT, "%s.material: no other material is called '%s'", key,
                      own->inclusions[k].material);
    const vsc_material_def *it = &definition->materials[other];
    if (it->law != VSC_LAW_SPRINGS || it->inclusion_count > 0 || it->axis_count > 0 ||
        it->pair_count > 0 || it->active.kind != VSC_ACTIVE_NONE || it->prony_count > 0)
      return vsc_fail(error, VSC_INPUT,
                      "%s.material: '%s' cannot be mixed in: an inclusion is a passive material of "
                      "law springs without further axes, inclusions or a Prony series",
                      key, it->name);
    found[k].other = other;
    const vsc_status status = vsc_terms_element_values(mesh, own->inclusions[k].fraction_array, key,
                                                       &found[k].fractions, error);
    if (status != VSC_OK) return status;
    if (found[k].fractions == NULL)
      return vsc_fail(error, VSC_INPUT, "%s.fraction: missing; name a cell array", key);
  }
  return VSC_OK;
}

// Refuses inclusions in element `e`, `sum` of it, of a material of another law than springs.
static vsc_status need_springs(const vsc_mesh *mesh, const vsc_definition *definition, size_t m, size_t e, double sum,
                               vsc_error *error)
{
  const vsc_material_def *own = &definition->materials[m];
  if (own->law == VSC_LAW_SPRINGS) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "materials[%zu].law: inclusions and vessels (%s) make up %.3g of element %u of material %s, and only "
                  "springs are mixed by volume: use law: springs, leave them out, or give them regions of their own",
                  m, own->inclusions[0].material, sum, mesh->element_source[e], own->name);
}

vsc_status vsc_mixture_find(const vsc_mesh *mesh, const vsc_definition *definition,
                            const uint32_t *material_of, uint8_t *mixed, vsc_error *error)
{
  for (size_t m = 0; m < definition->material_count; m++) {
    inclusion found[MOST];
    const size_t count = definition->materials[m].inclusion_count;
    if (count == 0) continue;
    const vsc_status status = find_inclusions(mesh, definition, m, found, error);
    if (status != VSC_OK) return status;
    for (size_t e = 0; e < mesh->element_count; e++) {
      if (material_of[e] != m) continue;
      double sum = 0;
      bool fine = true;
      for (size_t k = 0; k < count; k++) {
        const double phi = found[k].fractions[e];
        fine = fine && phi >= -ROUNDING && phi <= 1 + ROUNDING;
        sum += phi;
      }
      if (!fine || !(sum <= 1 + ROUNDING))
        return vsc_fail(error, VSC_INPUT,
                        "materials[%zu].inclusions: element %u has fractions of sum %g; each must "
                        "lie in [0, 1], and so must their sum",
                        m, mesh->element_source[e], sum);
      mixed[e] = sum > ROUNDING;
      const vsc_status mixable = mixed[e] ? need_springs(mesh, definition, m, e, sum, error) : VSC_OK;
      if (mixable != VSC_OK) return mixable;
    }
  }
  return VSC_OK;
}

vsc_status vsc_mixture_densities(const vsc_mesh *mesh, const vsc_definition *definition, const uint32_t *material_of,
                                 double *density, vsc_error *error)
{
  for (size_t e = 0; e < mesh->element_count; e++) density[e] = definition->materials[material_of[e]].density;
  for (size_t m = 0; m < definition->material_count; m++) {
    inclusion found[MOST];
    const vsc_material_def *own = &definition->materials[m];
    const vsc_status status = find_inclusions(mesh, definition, m, found, error);
    if (status != VSC_OK) return status;
    for (size_t k = 0; k < own->inclusion_count; k++) {
      const double more = definition->materials[found[k].other].density - own->density;
      if (more != 0 && definition->masses == VSC_MASS_CONSISTENT)
        return vsc_fail(error, VSC_INPUT,
                        "materials[%zu].inclusions[%zu]: '%s' has the density %g mg/mm3, its tissue %g, and masses: "
                        "consistent mixes none: take masses: lumped, or one density",
                        m, k, own->inclusions[k].material, own->density + more, own->density);
      for (size_t e = 0; e < mesh->element_count; e++)
        if (material_of[e] == m) density[e] += found[k].fractions[e] * more;
    }
  }
  return VSC_OK;
}

static void add_moduli(const vsc_material *material, double part, int lane, vsc_mixture *mixture)
{
  for (int a = 0; a < 3; a++) {
    mixture->axial[a][lane] += part * material->axial[a];
    mixture->angular[a][lane] += part * material->angular[a];
    mixture->coupling[a][lane] += part * material->coupling[a];
    mixture->damping[a][lane] += part * material->damping[a];
  }
  mixture->viscosity[lane] += part * material->viscosity;
  mixture->volume_modulus[lane] += part * material->volume_modulus;
  mixture->stabilization[lane] += part * material->stabilization;
  mixture->element_modulus[lane] += part * material->element_modulus;
}

vsc_status vsc_mixture_fill(const vsc_mesh *mesh, const vsc_definition *definition,
                            vsc_model *model, vsc_error *error)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!patch->mixed) continue;
    inclusion found[MOST];
    const size_t count = definition->materials[patch->material].inclusion_count;
    const vsc_status status = find_inclusions(mesh, definition, patch->material, found, error);
    if (status != VSC_OK) return status;
    vsc_mixture *mixtures = (vsc_mixture *)(model->store + patch->mixtures);
    for (size_t i = 0; i < VSC_WIDTH * (size_t)patch->pack_count; i++) {
      const uint32_t element = model->mesh_element[VSC_WIDTH * (size_t)patch->first_pack + i];
      if (element == VSC_NO_ELEMENT) continue;
      vsc_mixture *mixture = &mixtures[i / VSC_WIDTH];
      const int lane = (int)(i % VSC_WIDTH);
      double share = 1;
      for (size_t k = 0; k < count; k++) {
        const double phi = found[k].fractions[element];
        add_moduli(&model->materials[found[k].other], phi, lane, mixture);
        share -= phi;
      }
      add_moduli(&model->materials[patch->material], share, lane, mixture);
      mixture->share[lane] = share;
    }
  }
  return VSC_OK;
}
