// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/definition.h"

#include <string.h>

#include "base/mem.h"

vsc_curve_def vsc_default_curve(vsc_curve_kind kind)
{
  vsc_curve_def curve = {.kind = kind, .duration = 300, .rise_power = 2, .fall_power = 20};
  curve.rise = kind == VSC_CURVE_TANH_PAIR ? 20 : 100;
  curve.fall = kind == VSC_CURVE_TANH_PAIR ? 20 : 300;
  curve.start = kind == VSC_CURVE_BESTEL ? 160 : kind == VSC_CURVE_BESTEL_PRESSURE ? 170 : 0;
  curve.stop = 484;
  curve.width = 5;
  curve.rate_up = curve.rate_pre = 0.005;
  curve.rate_down = -0.03;
  curve.rate_mid = 0.001;
  curve.filling = 7e-3 / 16;
  return curve;
}

vsc_active_def vsc_default_active(void)
{
  vsc_active_def active = {.kind = VSC_ACTIVE_NONE, .rest_stretch = 1, .delay_unit = 1};
  active.curve = vsc_default_curve(VSC_CURVE_CONSTANT);
  return active;
}

vsc_material_def vsc_default_material(void)
{
  vsc_material_def material = {.density = 1.06, .holzapfel_ogden.steepness = 100};
  material.active = vsc_default_active();
  return material;
}

vsc_membrane_def vsc_default_membrane(void)
{
  return (vsc_membrane_def){.density = 1.06, .direction = {1, 0, 0}};
}

vsc_obstacle_def vsc_default_obstacle(void)
{
  return (vsc_obstacle_def){.curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
}

vsc_support_def vsc_default_support(void)
{
  return (vsc_support_def){.curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
}

vsc_definition vsc_default_definition(void)
{
  return (vsc_definition){.volume = VSC_VOLUME_NODAL, .safety = 0.8, .most_added_mass = 0.05, .cycle_tolerance = 1e-3,
                          .velocity = {.unit = 1},
                          .solve = {.rho = 0.5, .accuracy = 1e-4}};
}

bool vsc_takes_elements(const vsc_definition *definition, size_t material)
{
  const vsc_material_def *asked = &definition->materials[material];
  if (asked->region_count > 0) return true;
  for (size_t v = 0; v < definition->vessel_count; v++)
    if (strcmp(definition->vessels[v].material, asked->name) == 0) return false;
  for (size_t m = 0; m < definition->material_count; m++)
    for (size_t i = 0; i < definition->materials[m].inclusion_count; i++)
      if (strcmp(definition->materials[m].inclusions[i].material, asked->name) == 0) return false;
  return true;
}

static void free_curve(vsc_curve_def *curve)
{
  vsc_free(curve->times);
  vsc_free(curve->values);
}

static void free_material(vsc_material_def *material)
{
  free_curve(&material->active.curve);
  vsc_free(material->axes);
  vsc_free(material->pairs);
  vsc_free(material->inclusions);
  vsc_free(material->prony);
}

void vsc_definition_free(vsc_definition *definition)
{
  for (size_t i = 0; i < definition->material_count; i++) free_material(&definition->materials[i]);
  for (size_t i = 0; i < definition->pressure_count; i++)
    free_curve(&definition->pressures[i].curve);
  for (size_t i = 0; i < definition->obstacle_count; i++)
    free_curve(&definition->obstacles[i].curve);
  for (size_t i = 0; i < definition->support_count; i++)
    free_curve(&definition->supports[i].curve);
  vsc_free(definition->materials);
  vsc_free(definition->surfaces);
  vsc_free(definition->sets);
  vsc_free(definition->supports);
  vsc_free(definition->pressures);
  vsc_free(definition->robins);
  vsc_free(definition->vessels);
  vsc_free(definition->membranes);
  vsc_free(definition->obstacles);
  *definition = vsc_default_definition();
}
