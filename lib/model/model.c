// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/model.h"

#include <string.h>

#include "base/mem.h"
#include "model/robin.h"

static void free_order_and_elements(vsc_model *model)
{
  vsc_free(model->mesh_node);
  vsc_free(model->mesh_element);
  vsc_free(model->node_source);
  vsc_free(model->element_source);
  vsc_free(model->store);
  vsc_free(model->patches);
  vsc_free(model->shared);
  vsc_free(model->sum_start);
  vsc_free(model->sum_place);
  vsc_free(model->known);
  vsc_free(model->amplitude);
  vsc_free(model->delay);
  vsc_smoothing_free(&model->smoothing);
}

void vsc_coupled_mass_free(vsc_coupled_mass *mass)
{
  vsc_free(mass->start);
  vsc_free(mass->columns);
  vsc_free(mass->entries);
  vsc_free(mass->passes);
  *mass = (vsc_coupled_mass){0};
}

static void free_nodes(vsc_model *model)
{
  vsc_free(model->rest);
  vsc_free(model->mass);
  vsc_free(model->inverse_mass);
  vsc_free(model->weight);
  vsc_free(model->velocity);
  vsc_free(model->group_volume);
  vsc_free(model->group_modulus);
  vsc_coupled_mass_free(&model->coupled);
}

static void free_lists(vsc_model *model)
{
  for (size_t m = 0; model->materials && m < model->material_count; m++)
    vsc_curve_free(&model->materials[m].curve);
  vsc_free(model->materials);
  vsc_free(model->membranes);
  vsc_free(model->axes);
  vsc_free(model->pairs);
  for (size_t p = 0; model->pressures && p < model->pressure_count; p++) {
    vsc_facets_free(&model->pressures[p].facets);
    vsc_curve_free(&model->pressures[p].curve);
  }
  vsc_free(model->pressures);
  for (size_t r = 0; model->robins && r < model->robin_count; r++)
    vsc_robin_free(&model->robins[r]);
  vsc_free(model->robins);
  for (size_t s = 0; model->moved && s < model->moved_count; s++) {
    vsc_free(model->moved[s].nodes);
    vsc_curve_free(&model->moved[s].curve);
  }
  vsc_free(model->moved);
  for (size_t o = 0; model->obstacles && o < model->obstacle_count; o++) {
    vsc_free(model->obstacles[o].nodes);
    vsc_curve_free(&model->obstacles[o].curve);
  }
  vsc_free(model->obstacles);
  vsc_free(model->kept.start);
  vsc_free(model->kept.triangles);
  vsc_free(model->kept.weights);
  vsc_free(model->kept.rest);
  vsc_free(model->kept.source);
  for (size_t s = 0; model->surfaces && s < model->surface_count; s++)
    vsc_surface_free(&model->surfaces[s]);
  vsc_free(model->surfaces);
  for (size_t s = 0; model->sets && s < model->set_count; s++) vsc_node_set_free(&model->sets[s]);
  vsc_free(model->sets);
}

void vsc_model_free(vsc_model *model)
{
  if (model == NULL) return;
  free_order_and_elements(model);
  free_nodes(model);
  free_lists(model);
  vsc_free(model);
}

uint32_t *vsc_model_node_numbers(const vsc_model *model)
{
  uint32_t *number;
  if (!VSC_NEW(number, model->node_count)) return NULL;
  for (size_t n = 0; n < model->node_count; n++) number[model->mesh_node[n]] = (uint32_t)n;
  return number;
}

int vsc_model_find_surface(const vsc_model *model, const char *name)
{
  for (size_t s = 0; s < model->surface_count; s++)
    if (strcmp(model->surfaces[s].name, name) == 0) return (int)s;
  return -1;
}

double vsc_model_pressure(const vsc_model *model, size_t p, double time)
{
  return model->pressures[p].peak * vsc_curve_value(&model->pressures[p].curve, time);
}

bool vsc_supports_move(const vsc_model *model)
{
  return model->moved_count > 0;
}

void vsc_supports_place(const vsc_model *model, double time, double load, double *x)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_moved *moved = &model->moved[s];
    const double part = load * vsc_curve_value(&moved->curve, time);
    for (size_t k = 0; k < moved->node_count; k++)
      for (size_t i = 0; i < 3; i++) {
        const size_t place = 4 * (size_t)moved->nodes[k] + i;
        if (moved->motion[i] != 0) x[place] = model->rest[place] + part * moved->motion[i];
      }
  }
}

// Item `k` of lists of amplitudes and delays; NULL: 1 and 0.
static double activation(const vsc_material *material, const double *amplitude, const double *delay,
                         size_t k, double time)
{
  const double late = material->delay + (delay ? delay[k] : 0);
  return (amplitude ? amplitude[k] : 1) * vsc_curve_value(&material->curve, time - late);
}

double vsc_model_activation(const vsc_model *model, const vsc_material *material, size_t slot,
                            double time)
{
  return activation(material, model->amplitude, model->delay, slot, time);
}

double vsc_model_edge_activation(const vsc_model *model, const vsc_material *material, size_t edge,
                                 double time)
{
  return activation(material, model->smoothing.amplitude, model->smoothing.delay, edge, time);
}
