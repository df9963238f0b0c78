// SPDX-License-Identifier: GPL-3.0-or-later
// Every rule that curves, supports, loads and obstacles must obey.
#include <string.h>

#include "model/checker.h"

static const char boundary_name[] = "boundary";

void vsc_check_known(vsc_checker *c, const char *key, const char *name, const vsc_selector *selectors,
                     size_t count, bool surface)
{
  const char *words[65];
  size_t known = 0;
  if (surface) words[known++] = boundary_name;
  for (size_t i = 0; i < count; i++)
    if (known < 65) words[known++] = selectors[i].name;
  for (size_t i = 0; i < count; i++)
    if (strcmp(name, selectors[i].name) == 0) return;
  if (c->status != VSC_OK || (surface && strcmp(name, boundary_name) == 0)) return;
  const char *nearest = vsc_nearest(name, words, known);
  c->status = vsc_fail(c->error, VSC_INPUT, "%s.%s: no %s is named \"%s\"%s%s; define it under %s",
                       c->where, key, surface ? "surface" : "node set", name,
                       nearest != NULL ? ", the nearest is " : "", nearest != NULL ? nearest : "",
                       surface ? "surfaces" : "node_sets");
}

// A period must hold all that happens until `last` (ms), which is called `what`.
static void need_period(vsc_checker *c, const vsc_curve_def *curve, double last, const char *what)
{
  char remedy[128];
  snprintf(remedy, sizeof remedy, "shorter than %s (%g ms): give a longer period, or 0 ms for none", what, last);
  need(c, curve->period == 0 || last <= curve->period, "curve.period", curve->period, "ms", remedy);
}

// What begins with the end of its period or later never acts.
static void need_begin(vsc_checker *c, const vsc_curve_def *curve)
{
  char remedy[128];
  snprintf(remedy, sizeof remedy, "begins when its period (%g ms) is over: start earlier, or give a longer period",
           curve->period);
  need(c, curve->period == 0 || curve->start < curve->period, "curve.start", curve->start, "ms", remedy);
}

static void check_table(vsc_checker *c, const vsc_curve_def *curve)
{
  char key[64];
  need(c, curve->point_count >= 2, "curve.times", (double)curve->point_count, "points",
       "a table needs at least two");
  for (size_t i = 0; c->status == VSC_OK && i < curve->point_count; i++) {
    snprintf(key, sizeof key, "curve.times[%zu]", i);
    need_finite(c, key, curve->times[i], "ms");
    need(c, i == 0 || curve->times[i] > curve->times[i - 1], key, curve->times[i], "ms",
         "times must rise from point to point");
    snprintf(key, sizeof key, "curve.values[%zu]", i);
    need_finite(c, key, curve->values[i], "");
  }
}

static void check_driver(vsc_checker *c, const vsc_curve_def *curve)
{
  need(c, isfinite(curve->stop) && curve->stop > curve->start, "curve.stop", curve->stop, "ms",
       "give a time after the start");
  need_positive(c, "curve.width", curve->width, "ms", "give a time above zero");
  need_positive(c, "curve.rate_up", curve->rate_up, "1/ms", "give a rate above zero");
  need(c, isfinite(curve->rate_down) && curve->rate_down < 0, "curve.rate_down", curve->rate_down,
       "1/ms", "give a rate below zero");
  need_not_negative(c, "curve.rate_pre", curve->rate_pre, "1/ms");
  need_not_negative(c, "curve.rate_mid", curve->rate_mid, "1/ms");
  need_not_negative(c, "curve.filling", curve->filling, "1/ms");
  need_period(c, curve, curve->stop, "stop");
}

void vsc_check_curve(vsc_checker *c, const vsc_curve_def *curve)
{
  const bool smooth = curve->kind == VSC_CURVE_DOUBLE_HILL || curve->kind == VSC_CURVE_TANH_PAIR;
  const bool lasting = curve->kind == VSC_CURVE_RAMP || curve->kind == VSC_CURVE_HALF_SINE ||
                       curve->kind == VSC_CURVE_TANH_PAIR;
  need_finite(c, "curve.start", curve->start, "ms");
  if (lasting) {
    need_positive(c, "curve.duration", curve->duration, "ms", "give a time above zero");
  }
  if (smooth) {
    need_positive(c, "curve.rise", curve->rise, "ms", "give a time above zero");
    need_positive(c, "curve.fall", curve->fall, "ms", "give a time above zero");
  }
  if (curve->kind == VSC_CURVE_DOUBLE_HILL) {
    need_positive(c, "curve.rise_power", curve->rise_power, "", "give a power above zero");
    need_positive(c, "curve.fall_power", curve->fall_power, "", "give a power above zero");
  }
  need_not_negative(c, "curve.period", curve->period, "ms");
  if (lasting) need_period(c, curve, curve->start + curve->duration, "start + duration");
  if (curve->kind == VSC_CURVE_DOUBLE_HILL) need_begin(c, curve);
  need(c, curve->period == 0 || curve->start >= 0, "curve.start", curve->start, "ms",
       "a curve with a period starts at 0 ms or later");
  if (curve->kind == VSC_CURVE_BESTEL || curve->kind == VSC_CURVE_BESTEL_PRESSURE)
    check_driver(c, curve);
  if (curve->kind == VSC_CURVE_TABLE) check_table(c, curve);
  if (curve->kind == VSC_CURVE_TABLE && curve->point_count > 0)
    need_period(c, curve, curve->times[curve->point_count - 1], "the table's last time");
}

static void check_motion(vsc_checker *c, const vsc_definition *d, const vsc_support_def *support)
{
  for (int i = 0; i < 3; i++) {
    need_finite(c, "motion", support->motion[i], "mm");
    need(c, support->held[i] || support->motion[i] == 0, "motion", support->motion[i], "mm",
         "along a direction that is not held: name it in `held`");
    need(c, support->motion[i] == 0 || d->kept_volume == VSC_KEEP_NONE, "motion",
         support->motion[i], "mm",
         "a support cannot move while keep_volume is on: leave one of the two out");
  }
  vsc_check_curve(c, &support->curve);
}

static void check_surface_loads(vsc_checker *c, const vsc_definition *d)
{
  for (size_t i = 0; i < d->pressure_count; i++) {
    enter(c, "pressures", i, "");
    vsc_check_known(c, "surface", d->pressures[i].surface, d->surfaces, d->surface_count, true);
    need_finite(c, "peak", d->pressures[i].peak, "kPa");
    need_finite3(c, "direction", d->pressures[i].direction, "");
    vsc_check_curve(c, &d->pressures[i].curve);
  }
  for (size_t i = 0; i < d->robin_count; i++) {
    const vsc_robin_def *robin = &d->robins[i];
    enter(c, "robin", i, "");
    vsc_check_known(c, "surface", robin->surface, d->surfaces, d->surface_count, true);
    need_not_negative(c, "stiffness", robin->stiffness, "kPa/mm");
    need_not_negative(c, "damping", robin->damping, "kPa ms/mm");
    need(c, robin->stiffness > 0 || robin->damping > 0, "stiffness", 0, "kPa/mm",
         "give a stiffness or a damping above zero, or leave it out");
  }
}

static void check_obstacle(vsc_checker *c, const vsc_definition *d, size_t item)
{
  const vsc_obstacle_def *o = &d->obstacles[item];
  enter(c, "obstacles", item, "");
  need_finite3(c, "point", o->point, "mm");
  need_finite3(c, "motion", o->motion, "mm");
  if (o->kind == VSC_OBSTACLE_SPHERE)
    need_positive(c, "radius", o->radius, "mm", "give a radius above zero");
  else
    need(c, o->normal[0] != 0 || o->normal[1] != 0 || o->normal[2] != 0, "normal", 0, "",
         "give a vector that is not zero");
  if (o->kind == VSC_OBSTACLE_PLANE) need_finite3(c, "normal", o->normal, "");
  need_not_negative(c, "friction", o->friction, "");
  need(c, o->friction == 0 || d->solve.kind == VSC_SOLVE_EXPLICIT, "friction", o->friction, "",
       "only explicit steps have friction yet; give 0, or take solve: explicit");
  if (o->set[0] != '\0') vsc_check_known(c, "set", o->set, d->sets, d->set_count, false);
  vsc_check_curve(c, &o->curve);
}

// What obstacles cannot be with.
static void check_obstacles(vsc_checker *c, const vsc_definition *d)
{
  const vsc_solve_def *solve = &d->solve;
  const bool implicit = solve->kind == VSC_SOLVE_IMPLICIT;
  const char *what = NULL;
  for (size_t i = 0; i < d->obstacle_count; i++) check_obstacle(c, d, i);
  c->where[0] = '\0';
  need(c, d->obstacle_count <= VSC_MOST_OBSTACLES, "obstacles", (double)d->obstacle_count, "of them",
       "eight are the most");
  if (solve->kind == VSC_SOLVE_EQUILIBRIUM && solve->method == VSC_STATICS_RELAXATION)
    what = "solver.method: relaxation; take newton";
  if (implicit && solve->scheme == VSC_SCHEME_BDF2)
    what = "solver.scheme: bdf2; take generalized_alpha, with solver.rho: 0 for as much damping";
  if (implicit && d->masses == VSC_MASS_CONSISTENT) what = "masses: consistent; take masses: lumped";
  if (c->status == VSC_OK && d->obstacle_count > 0 && what != NULL)
    c->status = vsc_fail(c->error, VSC_INPUT, "obstacles: not with %s, or leave obstacles out", what);
}

static void check_velocity(vsc_checker *c, const vsc_definition *d)
{
  const vsc_velocity_def *velocity = &d->velocity;
  if (velocity->array[0] == '\0') return;
  snprintf(c->where, sizeof c->where, "initial_velocity");
  need(c, isfinite(velocity->unit) && velocity->unit != 0, "unit", velocity->unit, "m/s",
       "give a velocity that is not zero");
  if (c->status == VSC_OK && d->solve.kind == VSC_SOLVE_EQUILIBRIUM)
    c->status = vsc_fail(c->error, VSC_INPUT,
                         "initial_velocity.node_array: \"%s\": an equilibrium has no velocity; leave it out, or "
                         "take solve: explicit or implicit",
                         velocity->array);
}

void vsc_check_loads(vsc_checker *c, const vsc_definition *d)
{
  for (size_t i = 0; i < d->support_count; i++) {
    const int *held = d->supports[i].held;
    enter(c, "supports", i, "");
    vsc_check_known(c, "set", d->supports[i].set, d->sets, d->set_count, false);
    need(c, held[0] || held[1] || held[2], "held", 0, "directions",
         "name at least one of x, y, z, or leave the support out");
    check_motion(c, d, &d->supports[i]);
  }
  check_surface_loads(c, d);
  check_obstacles(c, d);
  check_velocity(c, d);
  c->where[0] = '\0';
  need_finite3(c, "gravity", d->gravity, "mm/ms2");
}
