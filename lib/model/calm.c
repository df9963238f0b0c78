// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/calm.h"

#include <math.h>

#include "base/vec3.h"

#define MOST_CHANGE (1.0 / 6)  // of the curve's range
#define BEND 0.01              // likewise,
#define BEND_OF_ELEMENT 0.01   // and for obstacles of an element's size
#define PARTS_OF_PERIOD 16
#define DELAYS 64  // that stand for those of all elements

// The time from `time` on in which the curve changes by `change` at most and stays within `bend` of its chord.
static double curve_calm(const vsc_curve *curve, double time, double most, double change, double bend)
{
  if (curve->range == 0) return most;
  if (curve->period > 0) most = fmin(most, curve->period / PARTS_OF_PERIOD);
  const double value = vsc_curve_value(curve, time);
  // nothing changes behind a table without period
  const double known = curve->period > 0 ? most : curve->spacing * (double)(curve->intervals + 1) - time;
  double low = -HUGE_VAL, high = HUGE_VAL, now = 0;  // slopes of chords that pass all places near enough
  for (double k = 1; k * curve->spacing < fmin(most, known); k++) {
    now = vsc_curve_value(curve, time + k * curve->spacing) - value;
    if (fabs(now) > change || now < low * k || now > high * k) return fmin(fmax(k - 1, 2) * curve->spacing, most);
    low = fmax(low, (now - bend) / k);
    high = fmin(high, (now + bend) / k);
  }
  if (now > 0 && low > 0) most = fmin(most, now / low * curve->spacing);
  if (now < 0 && high < 0) most = fmin(most, now / high * curve->spacing);
  return most;
}

static double load_calm(const vsc_curve *curve, double time, double most)
{
  return curve_calm(curve, time, most, MOST_CHANGE * curve->range, BEND * curve->range);
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
  if (!(between > 0)) return load_calm(&material->curve, time - material->delay - delays[0], most);
  for (int k = 0; k < DELAYS; k++)
    most = load_calm(&material->curve, time - material->delay - delays[0] - k * between, most);
  return most;
}

// How near the obstacle is to the nearest of its nodes, mm.
static double least_gap(const vsc_obstacle *obstacle, const double *x, double time)
{
  double point[3], normal[3], least = HUGE_VAL;
  vsc_obstacle_place(obstacle, time, point);
  for (size_t k = 0; k < obstacle->node_count; k++)
    least = fmin(least, vsc_obstacle_gap(obstacle, point, x + 4 * (size_t)obstacle->nodes[k], normal));
  return fmax(least, 0);
}

// As a load, but more closely; and free to go where it reaches nothing.
static double obstacle_calm(const vsc_model *model, const vsc_obstacle *obstacle, const double *x, double time,
                            double most)
{
  const vsc_curve *curve = &obstacle->curve;
  const double way = vsc_norm(obstacle->motion);
  double change = MOST_CHANGE * curve->range;
  if (way == 0) return most;
  if (obstacle->kind == VSC_OBSTACLE_SPHERE) change = fmin(change, 0.5 * obstacle->radius / way);
  const double bend = fmin(BEND * curve->range, BEND_OF_ELEMENT * model->element_size / way);
  const double near = curve_calm(curve, time, most, change, bend);
  return fmax(near, curve_calm(curve, time, most, least_gap(obstacle, x, time) / way, HUGE_VAL));
}

double vsc_model_calm(const vsc_model *model, const double *x, double time, double most)
{
  for (size_t m = 0; m < model->material_count; m++) most = material_calm(model, m, time, most);
  for (size_t p = 0; p < model->pressure_count; p++) most = load_calm(&model->pressures[p].curve, time, most);
  for (size_t s = 0; s < model->moved_count; s++) most = load_calm(&model->moved[s].curve, time, most);
  for (size_t o = 0; o < model->obstacle_count; o++)
    most = obstacle_calm(model, &model->obstacles[o], x, time, most);
  return most;
}
