// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calm.h"

#include <math.h>

#define MOST_CHANGE (1.0 / 6)  // of the curve's range
#define PARTS_OF_PERIOD 16
#define DELAYS 64  // that stand for those of all elements

static double curve_calm(const vsc_curve *curve, double time, double most)
{
  if (curve->range == 0) return most;
  if (curve->period > 0) most = fmin(most, curve->period / PARTS_OF_PERIOD);
  const double value = vsc_curve_value(curve, time);
  // nothing changes behind a table without period
  const double known = curve->period > 0 ? most : curve->spacing * (double)(curve->intervals + 1) - time;
  for (double k = 1; k * curve->spacing < fmin(most, known); k++)
    if (fabs(vsc_curve_value(curve, time + k * curve->spacing) - value) > MOST_CHANGE * curve->range)
      return fmin(fmax(k - 1, 2) * curve->spacing, most);
  return most;
}

void vsc_model_delays(const vsc_model *model, size_t m, double delays[2])
{
  delays[0] = delays[1] = 0;
  if (model->delay == NULL) return;
  delays[0] = HUGE_VAL;
  delays[1] = -HUGE_VAL;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch) || patch->material != m) continue;
    const size_t first = VSC_WIDTH * (size_t)patch->first_pack;
    for (size_t slot = first; slot < first + VSC_WIDTH * (size_t)patch->pack_count; slot++) {
      if (model->mesh_element[slot] == VSC_NO_ELEMENT) continue;
      delays[0] = fmin(delays[0], model->delay[slot]);
      delays[1] = fmax(delays[1], model->delay[slot]);
    }
  }
}

static double material_calm(const vsc_model *model, size_t m, double time, double most)
{
  const vsc_material *material = &model->materials[m];
  double delays[2];
  if (material->active == VSC_ACTIVE_NONE) return most;
  vsc_model_delays(model, m, delays);
  const double between = (delays[1] - delays[0]) / (DELAYS - 1);
  if (!(between > 0)) return curve_calm(&material->curve, time - material->delay - delays[0], most);
  for (int k = 0; k < DELAYS; k++)
    most = curve_calm(&material->curve, time - material->delay - delays[0] - k * between, most);
  return most;
}

double vsc_model_calm(const vsc_model *model, double time, double most)
{
  for (size_t m = 0; m < model->material_count; m++) most = material_calm(model, m, time, most);
  for (size_t p = 0; p < model->pressure_count; p++) most = curve_calm(&model->pressures[p].curve, time, most);
  for (size_t s = 0; s < model->moved_count; s++) most = curve_calm(&model->moved[s].curve, time, most);
  for (size_t o = 0; o < model->obstacle_count; o++) most = curve_calm(&model->obstacles[o].curve, time, most);
  return most;
}
