// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/definition.h"

#include "base/mem.h"

vsc_curve_def vsc_default_curve(vsc_curve_kind kind)
{
  vsc_curve_def curve = {.kind = kind, .duration = 300, .rise_power = 2, .fall_power = 20};
  curve.rise = kind == VSC_CURVE_TANH_PAIR ? 20 : 100;
  curve.fall = kind == VSC_CURVE_TANH_PAIR ? 20 : 300;
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
  vsc_material_def material = {.density = 1.06};
  material.active = vsc_default_active();
  return material;
}

vsc_definition vsc_default_definition(void)
{
  return (vsc_definition){.volume = VSC_VOLUME_NODAL, .safety = 0.8};
}

void vsc_definition_free(vsc_definition *definition)
{
  for (size_t i = 0; i < definition->material_count; i++) {
    vsc_free(definition->materials[i].active.curve.times);
    vsc_free(definition->materials[i].active.curve.values);
  }
  for (size_t i = 0; i < definition->pressure_count; i++) {
    vsc_free(definition->pressures[i].curve.times);
    vsc_free(definition->pressures[i].curve.values);
  }
  vsc_free(definition->materials);
  vsc_free(definition->surfaces);
  vsc_free(definition->sets);
  vsc_free(definition->supports);
  vsc_free(definition->pressures);
  *definition = vsc_default_definition();
}
