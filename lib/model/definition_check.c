// SPDX-License-Identifier: GPL-3.0-or-later
// Every rule that a definition must obey, with the key as the scene writes it.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/definition.h"
#include "model/law_constants.h"
#include "model/prony_check.h"

static const char boundary_name[] = "boundary";

// Where the check is, and the first failure, after which further demands are not looked at.
typedef struct checker {
  char where[160];  // prefix of the keys: "materials[0]"
  vsc_error *error;
  vsc_status status;
} checker;

static void enter(checker *c, const char *list, size_t item, const char *rest)
{
  snprintf(c->where, sizeof c->where, "%s[%zu]%s", list, item, rest);
}

// Demands that `fine` holds for the number `value` (in `unit`) of `key`.
static void need(checker *c, bool fine, const char *key, double value, const char *unit,
                 const char *remedy)
{
  if (c->status != VSC_OK || fine) return;
  c->status =
      vsc_fail(c->error, VSC_INPUT, "%s%s%s: %g%s%s: %s", c->where, c->where[0] != '\0' ? "." : "",
               key, value, unit[0] != '\0' ? " " : "", unit, remedy);
}

static void need_positive(checker *c, const char *key, double value, const char *unit,
                          const char *remedy)
{
  need(c, value > 0 && isfinite(value), key, value, unit, remedy);
}

static void need_not_negative(checker *c, const char *key, double value, const char *unit)
{
  need(c, value >= 0 && isfinite(value), key, value, unit, "give a value of zero or more");
}

static void need_finite(checker *c, const char *key, double value, const char *unit)
{
  need(c, isfinite(value), key, value, unit, "give a finite value");
}

static void check_table(checker *c, const vsc_curve_def *curve)
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

static void check_driver(checker *c, const vsc_curve_def *curve)
{
  need(c, curve->stop > curve->start && isfinite(curve->stop), "curve.stop", curve->stop, "ms",
       "give a time after the start");
  need_positive(c, "curve.width", curve->width, "ms", "give a time above zero");
  need_positive(c, "curve.rate_up", curve->rate_up, "1/ms", "give a rate above zero");
  need(c, curve->rate_down < 0 && isfinite(curve->rate_down), "curve.rate_down", curve->rate_down,
       "1/ms", "give a rate below zero");
  need_not_negative(c, "curve.rate_pre", curve->rate_pre, "1/ms");
  need_not_negative(c, "curve.rate_mid", curve->rate_mid, "1/ms");
  need_not_negative(c, "curve.filling", curve->filling, "1/ms");
  need(c, curve->period == 0 || curve->stop <= curve->period, "curve.period", curve->period, "ms",
       "shorter than the curve: give a period after its stop, or 0 ms for none");
}

static void check_curve(checker *c, const vsc_curve_def *curve)
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
  need(c, curve->period == 0 || !lasting || curve->start + curve->duration <= curve->period,
       "curve.period", curve->period, "ms",
       "shorter than the duration after the start: give a longer period, or 0 ms for none");
  need(c, curve->period == 0 || curve->start >= 0, "curve.start", curve->start, "ms",
       "a curve with a period starts at 0 ms or later");
  if (curve->kind == VSC_CURVE_BESTEL || curve->kind == VSC_CURVE_BESTEL_PRESSURE)
    check_driver(c, curve);
  if (curve->kind == VSC_CURVE_TABLE) check_table(c, curve);
  if (curve->kind == VSC_CURVE_TABLE && curve->point_count > 0)
    need(c, curve->period == 0 || curve->times[curve->point_count - 1] <= curve->period,
         "curve.period", curve->period, "ms", "shorter than the table; give a longer period");
}

static void check_active(checker *c, size_t item, const vsc_active_def *active, vsc_law law)
{
  enter(c, "materials", item, ".active");
  if (active->kind == VSC_ACTIVE_NONE) return;
  need(c, law != VSC_LAW_CLASSICAL, "kind", active->kind, "",
       "law: classical has no fibre that could contract; use springs or paper");
  need(c, law != VSC_LAW_PAPER || active->kind == VSC_ACTIVE_SPRING, "kind", active->kind, "",
       "law: paper knows active springs only; use kind: spring");
  need(c, law == VSC_LAW_PAPER || law == VSC_LAW_SPRINGS || active->kind == VSC_ACTIVE_TENSION,
       "kind", active->kind, "", "only springs have a spring that could be active; use kind: tension");
  if (active->kind == VSC_ACTIVE_SPRING) {
    need_not_negative(c, "stiffness", active->stiffness, "kPa");
    need(c, active->rest_stretch > 0 && active->rest_stretch <= 1, "rest_stretch",
         active->rest_stretch, "", "give a stretch above 0 and up to 1");
  } else {
    need_not_negative(c, "tension", active->tension, "kPa");
    need_finite(c, "length_factor", active->length_factor, "");
    need_not_negative(c, "sheet_fraction", active->sheet_fraction, "");
    need_not_negative(c, "normal_fraction", active->normal_fraction, "");
  }
  need_finite(c, "delay", active->delay, "ms");
  need_positive(c, "delay_unit", active->delay_unit, "ms", "give a time above zero");
  check_curve(c, &active->curve);
}

static void check_more_axes(checker *c, const vsc_material_def *material)
{
  char key[64];
  need(c, material->axis_count <= VSC_MOST_AXES, "axes", (double)material->axis_count, "of them",
       "64 are the most");
  for (size_t k = 0; k < material->axis_count; k++) {
    const vsc_axis_def *axis = &material->axes[k];
    const double *d = axis->direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    snprintf(key, sizeof key, "axes[%zu].direction", k);
    need(c, length > 1e-6 && isfinite(length), key, length, "long", "give a vector that is not zero");
    snprintf(key, sizeof key, "axes[%zu].modulus", k);
    need_not_negative(c, key, axis->modulus, "kPa");
    snprintf(key, sizeof key, "axes[%zu].damping", k);
    need_not_negative(c, key, axis->damping, "kPa ms");
  }
  for (size_t k = 0; k < material->pair_count; k++) {
    const vsc_pair_def *pair = &material->pairs[k];
    const int axes = 3 + (int)material->axis_count;
    for (int i = 0; i < 2; i++) {
      snprintf(key, sizeof key, "pairs[%zu].%s", k, i == 0 ? "first" : "second");
      need(c, pair->axes[i] >= 0 && pair->axes[i] < axes && pair->axes[0] != pair->axes[1], key,
           pair->axes[i], "", "name two different axes: 0 f, 1 s, 2 n, 3 the first of axes, ...");
    }
    snprintf(key, sizeof key, "pairs[%zu].modulus", k);
    need_not_negative(c, key, pair->modulus, "kPa");
  }
}

static void check_coupling(checker *c, const vsc_material_def *m)
{
  static const char *const keys[] = {"coupling.fs", "coupling.sn", "coupling.nf"};
  for (int a = 0; a < 3; a++) need_finite(c, keys[a], m->coupling[a], "kPa");
  need(c, vsc_couplings_hold(m), keys[0], m->coupling[0], "kPa",
       "with the other couplings some stretch costs no energy; give smaller couplings, or larger axial "
       "moduli");
}

static void check_springs(checker *c, const vsc_material_def *material)
{
  static const char *const axial[] = {"axial.f", "axial.s", "axial.n"};
  static const char *const angular[] = {"angular.fs", "angular.sn", "angular.nf"};
  static const char *const damping[] = {"damping.f", "damping.s", "damping.n"};
  for (int a = 0; a < 3; a++) {
    need_not_negative(c, axial[a], material->axial[a], "kPa");
    need_not_negative(c, angular[a], material->angular[a], "kPa");
    need_not_negative(c, damping[a], material->damping[a], "kPa ms");
  }
  check_coupling(c, material);
  check_more_axes(c, material);
}

static void check_tissue(checker *c, const vsc_material_def *material)
{
  vsc_law_constant constants[VSC_MOST_CONSTANTS];
  const size_t count = vsc_law_constants(material, constants);
  for (size_t k = 0; k < count; k++) {
    const vsc_law_constant *it = &constants[k];
    if (it->positive)
      need_positive(c, it->key, it->value, it->unit, "give a value above zero");
    else
      need_not_negative(c, it->key, it->value, it->unit);
    need(c, it->value <= it->most, it->key, it->value, it->unit, "give a value up to 1/3");
  }
}

static void check_strain_law(checker *c, const vsc_material_def *material)
{
  if (material->law == VSC_LAW_SPRINGS)
    check_springs(c, material);
  else
    check_tissue(c, material);
  need_not_negative(c, "viscosity", material->viscosity, "kPa ms");
  need_positive(c, "volume_modulus", material->volume_modulus, "kPa",
                "give a modulus above zero, say 10 to 100 times the axial moduli");
  need_not_negative(c, "stabilization", material->stabilization, "kPa");
}

static void check_paper(checker *c, const vsc_paper_def *paper)
{
  static const char *const axial[] = {"paper.axial.f", "paper.axial.s", "paper.axial.n"};
  static const char *const angular[] = {"paper.angular.fs", "paper.angular.sn", "paper.angular.nf"};
  static const char *const damping[] = {"paper.damping.f", "paper.damping.s", "paper.damping.n"};
  for (int a = 0; a < 3; a++) {
    need_not_negative(c, axial[a], paper->axial[a], "mN/mm");
    need_not_negative(c, angular[a], paper->angular[a], "mN");
    need_not_negative(c, damping[a], paper->damping[a], "mN ms/mm");
  }
  need_not_negative(c, "paper.volume", paper->volume, "mN/mm");
  need_not_negative(c, "paper.volume_damping", paper->volume_damping, "mN ms/mm");
  need_not_negative(c, "paper.active", paper->active, "mN/mm");
}

static void check_material(checker *c, size_t item, const vsc_material_def *material)
{
  enter(c, "materials", item, "");
  need_positive(c, "density", material->density, "mg/mm3", "give a density above zero");
  if (vsc_law_is_of_strain(material->law)) check_strain_law(c, material);
  if (material->law == VSC_LAW_PAPER) check_paper(c, &material->paper);
  if (material->law == VSC_LAW_CLASSICAL) {
    need_positive(c, "classical.stiffness", material->classical.stiffness, "mN/mm",
                  "give a stiffness above zero");
    need_not_negative(c, "classical.damping", material->classical.damping, "mN ms/mm");
  }
  check_active(c, item, &material->active, material->law);
}

static bool has_region(const vsc_material_def *material, int region)
{
  for (size_t r = 0; r < material->region_count; r++)
    if (material->regions[r] == region) return true;
  return false;
}

// Each region belongs to one material, and one material at most takes the rest.
static void check_regions(checker *c, const vsc_definition *d, size_t item)
{
  const vsc_material_def *materials = d->materials, *material = &materials[item];
  char remedy[VSC_NAME + 80];
  enter(c, "materials", item, "");
  for (size_t other = 0; other < item; other++) {
    snprintf(remedy, sizeof remedy, "belongs to material %s already; leave it in one of the two",
             materials[other].name);
    for (size_t r = 0; r < material->region_count; r++)
      need(c, !has_region(&materials[other], material->regions[r]), "regions", material->regions[r],
           "", remedy);
    snprintf(remedy, sizeof remedy, "material %s takes the unnamed regions already; list regions",
             materials[other].name);
    need(c, material->region_count > 0 || materials[other].region_count > 0 ||
             !vsc_takes_elements(d, item) || !vsc_takes_elements(d, other),
         "regions", 0, "regions listed", remedy);
  }
}

static void check_finite3(checker *c, const char *key, const double value[3], const char *unit)
{
  for (int i = 0; i < 3; i++) need_finite(c, key, value[i], unit);
}

static void check_selector(checker *c, const vsc_selector *selector)
{
  switch (selector->kind) {
    case VSC_SELECT_NODE_ARRAY:
    case VSC_SELECT_TRIANGLE_ARRAY:
      need(c, selector->low <= selector->high, "range", selector->low, "",
           "the first value must not be above the second");
      break;
    case VSC_SELECT_BOX:
      for (int i = 0; i < 3; i++)
        need(c, selector->box_low[i] <= selector->box_high[i], "box.low", selector->box_low[i],
             "mm", "must not be above the same coordinate of box.high");
      break;
    case VSC_SELECT_PLANE:
      check_finite3(c, "plane.point", selector->point, "mm");
      check_finite3(c, "plane.normal", selector->normal, "");
      need(c, selector->normal[0] != 0 || selector->normal[1] != 0 || selector->normal[2] != 0,
           "plane.normal", 0, "", "give a vector that is not zero");
      need_not_negative(c, "plane.tolerance", selector->tolerance, "mm");
      break;
    default:
      break;
  }
}

// A name that `key` uses must be one of the selectors' (or the whole boundary's, for surfaces).
static void need_known(checker *c, const char *key, const char *name, const vsc_selector *selectors,
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

static void check_selectors(checker *c, const char *list, const vsc_selector *selectors,
                            size_t count)
{
  for (size_t i = 0; i < count; i++) {
    enter(c, list, i, "");
    if (c->status == VSC_OK && selectors[i].name[0] == '\0')
      c->status = vsc_fail(c->error, VSC_INPUT, "%s.name: empty: give it a name", c->where);
    for (size_t j = 0; c->status == VSC_OK && j < i; j++)
      if (strcmp(selectors[i].name, selectors[j].name) == 0)
        c->status = vsc_fail(c->error, VSC_INPUT,
                             "%s.name: \"%s\" names %s[%zu] already: choose another name", c->where,
                             selectors[i].name, list, j);
    check_selector(c, &selectors[i]);
  }
}

static void check_motion(checker *c, const vsc_definition *d, const vsc_support_def *support)
{
  for (int i = 0; i < 3; i++) {
    need_finite(c, "motion", support->motion[i], "mm");
    need(c, support->held[i] || support->motion[i] == 0, "motion", support->motion[i], "mm",
         "along a direction that is not held: name it in `held`");
    need(c, support->motion[i] == 0 || d->kept_volume == VSC_KEEP_NONE, "motion",
         support->motion[i], "mm",
         "a support cannot move while keep_volume is on: leave one of the two out");
  }
  check_curve(c, &support->curve);
}

static void check_loads(checker *c, const vsc_definition *d)
{
  for (size_t i = 0; i < d->support_count; i++) {
    const int *held = d->supports[i].held;
    enter(c, "supports", i, "");
    need_known(c, "set", d->supports[i].set, d->sets, d->set_count, false);
    need(c, held[0] || held[1] || held[2], "held", 0, "directions",
         "name at least one of x, y, z, or leave the support out");
    check_motion(c, d, &d->supports[i]);
  }
  for (size_t i = 0; i < d->pressure_count; i++) {
    enter(c, "pressures", i, "");
    need_known(c, "surface", d->pressures[i].surface, d->surfaces, d->surface_count, true);
    need_finite(c, "peak", d->pressures[i].peak, "kPa");
    check_finite3(c, "direction", d->pressures[i].direction, "");
    check_curve(c, &d->pressures[i].curve);
  }
  for (size_t i = 0; i < d->robin_count; i++) {
    const vsc_robin_def *robin = &d->robins[i];
    enter(c, "robin", i, "");
    need_known(c, "surface", robin->surface, d->surfaces, d->surface_count, true);
    need_not_negative(c, "stiffness", robin->stiffness, "kPa/mm");
    need_not_negative(c, "damping", robin->damping, "kPa ms/mm");
    need(c, robin->stiffness > 0 || robin->damping > 0, "stiffness", 0, "kPa/mm",
         "give a stiffness or a damping above zero, or leave it out");
  }
}

static void check_membrane(checker *c, const vsc_definition *d, size_t item)
{
  const vsc_membrane_def *m = &d->membranes[item];
  enter(c, "membranes", item, "");
  if (strcmp(m->surface, "triangles") != 0)
    need_known(c, "surface", m->surface, d->surfaces, d->surface_count, true);
  need_positive(c, "thickness", m->thickness, "mm", "give a thickness above zero");
  need_positive(c, "density", m->density, "mg/mm3", "give a density above zero");
  need_positive(c, "axial.a", m->axial[0], "kPa", "give a modulus above zero");
  need_positive(c, "axial.b", m->axial[1], "kPa", "give a modulus above zero");
  need_not_negative(c, "angular", m->angular, "kPa");
  need_not_negative(c, "area_modulus", m->area_modulus, "kPa");
  need_not_negative(c, "damping.a", m->damping[0], "kPa ms");
  need_not_negative(c, "damping.b", m->damping[1], "kPa ms");
  need_not_negative(c, "bending", m->bending, "mN mm");
  check_finite3(c, "direction", m->direction, "");
}

static void check_obstacle(checker *c, const vsc_definition *d, size_t item)
{
  const vsc_obstacle_def *o = &d->obstacles[item];
  enter(c, "obstacles", item, "");
  check_finite3(c, "point", o->point, "mm");
  check_finite3(c, "motion", o->motion, "mm");
  if (o->kind == VSC_OBSTACLE_SPHERE)
    need_positive(c, "radius", o->radius, "mm", "give a radius above zero");
  else
    need(c, o->normal[0] != 0 || o->normal[1] != 0 || o->normal[2] != 0, "normal", 0, "",
         "give a vector that is not zero");
  if (o->kind == VSC_OBSTACLE_PLANE) check_finite3(c, "normal", o->normal, "");
  need_not_negative(c, "friction", o->friction, "");
  if (o->set[0] != '\0') need_known(c, "set", o->set, d->sets, d->set_count, false);
  check_curve(c, &o->curve);
}

// Fails for `key` with a text.
static void need_text(checker *c, bool fine, const char *key, const char *text, const char *remedy)
{
  if (c->status == VSC_OK && !fine)
    c->status =
        vsc_fail(c->error, VSC_INPUT, "%s.%s: \"%s\": %s", c->where, key, text, remedy);
}

static void check_vessel(checker *c, const vsc_definition *d, size_t item)
{
  const vsc_vessel_def *v = &d->vessels[item];
  const vsc_material_def *own = NULL;
  enter(c, "vessels", item, "");
  for (size_t m = 0; m < d->material_count; m++)
    if (strcmp(d->materials[m].name, v->material) == 0) own = &d->materials[m];
  need_text(c, own != NULL, "material", v->material, "no material has this name; list it");
  need_text(c, own == NULL || own->law == VSC_LAW_SPRINGS, "material", v->material,
            "its moduli are mixed into the tissue's, so its law must be springs");
  need_text(c, v->name[0] != '\0', "name", v->name, "give it a name");
  for (size_t other = 0; other < item; other++)
    need_text(c, strcmp(d->vessels[other].name, v->name) != 0, "name", v->name,
              "another vessel has this name already; choose another");
  need_positive(c, "unit", v->unit, "mm", "give a length above zero");
  need_not_negative(c, "radius", v->radius, "mm");
  need_text(c, v->radius == 0 || v->radius_array[0] == '\0', "radius_array", v->radius_array,
            "radius is given too; leave one of the two out");
  need(c, v->threshold >= 0 && v->threshold <= 1, "threshold", v->threshold, "",
       "give a volume fraction from 0 to 1");
}

// Smoothed tets need one law of strain in each of them.
static void check_smoothing(checker *c, const vsc_definition *d)
{
  for (size_t m = 0; d->tets == VSC_TETS_SMOOTHED && m < d->material_count; m++) {
    const vsc_material_def *material = &d->materials[m];
    enter(c, "materials", m, "");
    if (c->status == VSC_OK && !vsc_law_is_of_strain(material->law))
      c->status = vsc_fail(c->error, VSC_INPUT,
                           "%s.law: %s cannot be smoothed: take another law, or tets: plain", c->where,
                           material->law == VSC_LAW_PAPER ? "paper" : "classical");
    need(c, material->inclusion_count == 0, "inclusions", (double)material->inclusion_count, "of them",
         "tets: smoothed takes no inclusions or vessels; leave them out, or take tets: plain");
  }
}

vsc_status vsc_definition_check(const vsc_definition *d, vsc_error *error)
{
  checker c = {.error = error, .status = VSC_OK};
  need(&c, d->material_count > 0 || d->membrane_count > 0, "materials", 0, "given",
       "describe at least one material, or a membrane");
  for (size_t i = 0; i < d->material_count; i++) check_material(&c, i, &d->materials[i]);
  for (size_t i = 0; i < d->material_count; i++) check_regions(&c, d, i);
  if (c.status == VSC_OK) c.status = vsc_prony_check(d, error);
  check_smoothing(&c, d);
  check_selectors(&c, "surfaces", d->surfaces, d->surface_count);
  check_selectors(&c, "node_sets", d->sets, d->set_count);
  for (size_t i = 0; i < d->set_count; i++) {
    enter(&c, "node_sets", i, "");
    if (d->sets[i].kind == VSC_SELECT_SURFACE)
      need_known(&c, "surface", d->sets[i].array, d->surfaces, d->surface_count, true);
  }
  check_loads(&c, d);
  for (size_t i = 0; i < d->vessel_count; i++) check_vessel(&c, d, i);
  for (size_t i = 0; i < d->membrane_count; i++) check_membrane(&c, d, i);
  for (size_t i = 0; i < d->obstacle_count; i++) check_obstacle(&c, d, i);
  c.where[0] = '\0';
  need(&c, d->obstacle_count <= VSC_MOST_OBSTACLES, "obstacles", (double)d->obstacle_count, "of them",
       "eight are the most");
  check_finite3(&c, "gravity", d->gravity, "mm/ms2");
  need_positive(&c, "time.end", d->end_time, "ms", "give a time above zero");
  need_not_negative(&c, "time.step", d->step, "ms");
  need(&c, d->safety > 0 && d->safety <= 1, "time.safety", d->safety, "",
       "give a fraction above 0 and up to 1");
  need(&c, d->masses != VSC_MASS_CONSISTENT || d->solve.kind == VSC_SOLVE_IMPLICIT, "masses",
       (double)d->masses, "(consistent)", "take masses: lumped, or solve: implicit");
  need(&c, d->solve.rho >= 0 && d->solve.rho <= 1, "solver.rho", d->solve.rho, "",
       "give a number from 0 to 1");
  need(&c, d->solve.accuracy > 0 && d->solve.accuracy < 0.1, "solver.accuracy", d->solve.accuracy, "",
       "give a part of the body's size above 0 and below 0.1; 1e-4 is usual");
  need(&c, d->solve.incompressible >= 0 && d->solve.incompressible < 0.1, "solver.incompressible",
       d->solve.incompressible, "", "give a part of the volume below 0.1, or 0");
  need(&c,
       d->solve.incompressible == 0 ||
           (d->solve.kind == VSC_SOLVE_EQUILIBRIUM && d->solve.method == VSC_STATICS_NEWTON),
       "solver.incompressible", d->solve.incompressible, "",
       "it needs solve: equilibrium and solver.method: newton");
  need(&c, d->solve.tolerance > 0 && d->solve.tolerance < 0.1, "solver.tolerance", d->solve.tolerance, "",
       "give a part of the forces above 0 and below 0.1; 1e-6 is usual");
  return c.status;
}
