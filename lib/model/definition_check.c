// SPDX-License-Identifier: GPL-3.0-or-later
// Every rule that a definition must obey, with the key as the scene writes it.
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "model/checker.h"
#include "model/law_constants.h"
#include "model/prony_check.h"

#define SHORTEST_END 1e-9  // ms; steps of far shorter runs are lost among the smallest numbers

// Fails for `key` with a text.
static void need_text(vsc_checker *c, bool fine, const char *key, const char *text, const char *remedy)
{
  if (c->status == VSC_OK && !fine)
    c->status =
        vsc_fail(c->error, VSC_INPUT, "%s.%s: \"%s\": %s", c->where, key, text, remedy);
}

// Names become columns of tables and keys of summaries.
static void need_name(vsc_checker *c, const char *name)
{
  need_text(c, vsc_name_is_plain(name), "name", name, "give a name without commas, brackets, quotes and backslashes");
}

static void check_active(vsc_checker *c, size_t item, const vsc_active_def *active, vsc_law law)
{
  enter(c, "materials", item, ".active");
  if (active->kind == VSC_ACTIVE_NONE) return;
  const char *kind = active->kind == VSC_ACTIVE_SPRING ? "spring" : "tension";
  need_text(c, law != VSC_LAW_CLASSICAL, "kind", kind,
            "law: classical has no fibre that could contract; use springs or paper");
  need_text(c, law != VSC_LAW_PAPER || active->kind == VSC_ACTIVE_SPRING, "kind", kind,
            "law: paper knows active springs only; use kind: spring");
  need_text(c, law == VSC_LAW_PAPER || law == VSC_LAW_SPRINGS || active->kind == VSC_ACTIVE_TENSION, "kind", kind,
            "only springs have a spring that could be active; use kind: tension");
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
  vsc_check_curve(c, &active->curve);
}

static void check_more_axes(vsc_checker *c, const vsc_material_def *material)
{
  char key[64];
  need(c, material->axis_count <= VSC_MOST_AXES, "axes", (double)material->axis_count, "of them",
       "64 are the most");
  for (size_t k = 0; k < material->axis_count; k++) {
    const vsc_axis_def *axis = &material->axes[k];
    const double *d = axis->direction, length = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
    snprintf(key, sizeof key, "axes[%zu].direction", k);
    need(c, isfinite(length) && length > 1e-6, key, length, "long", "give a vector that is not zero");
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

static void check_coupling(vsc_checker *c, const vsc_material_def *m)
{
  static const char *const keys[] = {"coupling.fs", "coupling.sn", "coupling.nf"};
  for (int a = 0; a < 3; a++) need_finite(c, keys[a], m->coupling[a], "kPa");
  need(c, c->status != VSC_OK || vsc_couplings_hold(m), keys[0], m->coupling[0], "kPa",
       "with the other couplings some stretch costs no energy; give smaller couplings, or larger axial "
       "moduli");
}

static void check_springs(vsc_checker *c, const vsc_material_def *material)
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

static void check_tissue(vsc_checker *c, const vsc_material_def *material)
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

static void check_strain_law(vsc_checker *c, const vsc_material_def *material)
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

static void check_paper(vsc_checker *c, const vsc_paper_def *paper)
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

static void check_material(vsc_checker *c, size_t item, const vsc_material_def *material)
{
  enter(c, "materials", item, "");
  need_name(c, material->name);
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
static void check_regions(vsc_checker *c, const vsc_definition *d, size_t item)
{
  const vsc_material_def *materials = d->materials, *material = &materials[item];
  char remedy[VSC_NAME + 80];
  const size_t room = sizeof material->regions / sizeof material->regions[0];
  enter(c, "materials", item, "");
  need(c, material->region_count <= room, "regions", (double)material->region_count, "32 at most", "give some another material");
  for (size_t other = 0; other < item && material->region_count <= room; other++) {
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

static void check_selector(vsc_checker *c, const vsc_selector *selector)
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
      need_finite3(c, "plane.point", selector->point, "mm");
      need_finite3(c, "plane.normal", selector->normal, "");
      need(c, selector->normal[0] != 0 || selector->normal[1] != 0 || selector->normal[2] != 0,
           "plane.normal", 0, "", "give a vector that is not zero");
      need_not_negative(c, "plane.tolerance", selector->tolerance, "mm");
      break;
    default:
      break;
  }
}

static void check_selectors(vsc_checker *c, const char *list, const vsc_selector *selectors,
                            size_t count)
{
  for (size_t i = 0; i < count; i++) {
    enter(c, list, i, "");
    need_name(c, selectors[i].name);
    need_text(c, selectors[i].name[0] != '\0', "name", "", "give it a name");
    for (size_t j = 0; c->status == VSC_OK && j < i; j++)
      if (strcmp(selectors[i].name, selectors[j].name) == 0)
        c->status = vsc_fail(c->error, VSC_INPUT,
                             "%s.name: \"%s\" names %s[%zu] already: choose another name", c->where,
                             selectors[i].name, list, j);
    check_selector(c, &selectors[i]);
  }
}

static void check_membrane(vsc_checker *c, const vsc_definition *d, size_t item)
{
  const vsc_membrane_def *m = &d->membranes[item];
  enter(c, "membranes", item, "");
  need_name(c, m->name);
  if (strcmp(m->surface, "triangles") != 0)
    vsc_check_known(c, "surface", m->surface, d->surfaces, d->surface_count, true);
  need_positive(c, "thickness", m->thickness, "mm", "give a thickness above zero");
  need_positive(c, "density", m->density, "mg/mm3", "give a density above zero");
  need_positive(c, "axial.a", m->axial[0], "kPa", "give a modulus above zero");
  need_positive(c, "axial.b", m->axial[1], "kPa", "give a modulus above zero");
  need_not_negative(c, "angular", m->angular, "kPa");
  need_not_negative(c, "area_modulus", m->area_modulus, "kPa");
  need_not_negative(c, "damping.a", m->damping[0], "kPa ms");
  need_not_negative(c, "damping.b", m->damping[1], "kPa ms");
  need_not_negative(c, "bending", m->bending, "mN mm");
  need_finite3(c, "direction", m->direction, "");
}

static void check_vessel(vsc_checker *c, const vsc_definition *d, size_t item)
{
  const vsc_vessel_def *v = &d->vessels[item];
  const vsc_material_def *own = NULL;
  enter(c, "vessels", item, "");
  for (size_t m = 0; m < d->material_count; m++)
    if (strcmp(d->materials[m].name, v->material) == 0) own = &d->materials[m];
  need_text(c, own != NULL, "material", v->material, "no material has this name; list it");
  need_text(c, own == NULL || own->law == VSC_LAW_SPRINGS, "material", v->material,
            "its moduli are mixed into the tissue's, so its law must be springs");
  need_name(c, v->name);
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
static void check_smoothing(vsc_checker *c, const vsc_definition *d)
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

// Volumes that are too many for Newton's method, and relaxation, which keeps none.
static void check_kept(vsc_checker *c, const vsc_definition *d)
{
  const bool many = d->kept_volume == VSC_KEEP_NODE || d->kept_volume == VSC_KEEP_ELEMENT;
  if (c->status != VSC_OK || d->kept_volume == VSC_KEEP_NONE || d->solve.kind == VSC_SOLVE_EXPLICIT) return;
  if (many)
    c->status = vsc_fail(c->error, VSC_INPUT,
                         "keep_volume: %s: too many volumes for solve: equilibrium or implicit; take region or total, "
                         "solver.incompressible in equilibria, or solve: explicit",
                         d->kept_volume == VSC_KEEP_NODE ? "node" : "element");
  else if (d->solve.kind == VSC_SOLVE_EQUILIBRIUM && d->solve.method == VSC_STATICS_RELAXATION)
    c->status = vsc_fail(c->error, VSC_INPUT, "keep_volume: relaxation keeps no volume; take solver.method: newton");
}

static void check_selector_kinds(vsc_checker *c, const char *list, const vsc_selector *selectors, size_t count)
{
  for (size_t i = 0; i < count; i++) {
    enter(c, list, i, "");
    need_kind(c, "kind", (int)selectors[i].kind, VSC_SELECT_SURFACE);
  }
}

static void check_curve_kind(vsc_checker *c, const vsc_curve_def *curve)
{
  need_kind(c, "curve.kind", (int)curve->kind, VSC_CURVE_BESTEL_PRESSURE);
}

// Every enumeration of a definition, before anything is chosen by one.
static void check_kinds(vsc_checker *c, const vsc_definition *d)
{
  need_kind(c, "volume", (int)d->volume, VSC_VOLUME_ELEMENT);
  need_kind(c, "tets", (int)d->tets, VSC_TETS_SMOOTHED);
  need_kind(c, "keep_volume", (int)d->kept_volume, VSC_KEEP_ELEMENT);
  need_kind(c, "masses", (int)d->masses, VSC_MASS_CONSISTENT);
  need_kind(c, "solve", (int)d->solve.kind, VSC_SOLVE_IMPLICIT);
  need_kind(c, "solver.method", (int)d->solve.method, VSC_STATICS_RELAXATION);
  need_kind(c, "solver.linear", (int)d->solve.linear, VSC_LINEAR_ITERATIVE);
  need_kind(c, "solver.scheme", (int)d->solve.scheme, VSC_SCHEME_BDF2);
  check_selector_kinds(c, "surfaces", d->surfaces, d->surface_count);
  check_selector_kinds(c, "node_sets", d->sets, d->set_count);
  for (size_t i = 0; i < d->material_count; i++) {
    const vsc_material_def *material = &d->materials[i];
    enter(c, "materials", i, "");
    need_kind(c, "law", (int)material->law, VSC_LAW_VERONDA_WESTMANN);
    need_kind(c, "compression", (int)material->compression, VSC_FIBRES_SMOOTH);
    enter(c, "materials", i, ".active");
    need_kind(c, "kind", (int)material->active.kind, VSC_ACTIVE_TENSION);
    check_curve_kind(c, &material->active.curve);
  }
  for (size_t i = 0; i < d->support_count; i++) enter(c, "supports", i, ""), check_curve_kind(c, &d->supports[i].curve);
  for (size_t i = 0; i < d->pressure_count; i++) enter(c, "pressures", i, ""), check_curve_kind(c, &d->pressures[i].curve);
  for (size_t i = 0; i < d->obstacle_count; i++) {
    enter(c, "obstacles", i, "");
    need_kind(c, "kind", (int)d->obstacles[i].kind, VSC_OBSTACLE_SPHERE);
    check_curve_kind(c, &d->obstacles[i].curve);
  }
  c->where[0] = '\0';
}

vsc_status vsc_definition_check(const vsc_definition *d, vsc_error *error)
{
  vsc_checker c = {.error = error, .status = VSC_OK};
  check_kinds(&c, d);
  if (c.status != VSC_OK) return c.status;
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
      vsc_check_known(&c, "surface", d->sets[i].array, d->surfaces, d->surface_count, true);
  }
  vsc_check_loads(&c, d);
  for (size_t i = 0; i < d->vessel_count; i++) check_vessel(&c, d, i);
  for (size_t i = 0; i < d->membrane_count; i++) check_membrane(&c, d, i);
  c.where[0] = '\0';
  need(&c, isfinite(d->end_time) && d->end_time >= SHORTEST_END, "time.end", d->end_time, "ms",
       "give a time above zero, of 1e-9 ms at least");
  need_not_negative(&c, "time.step", d->step, "ms");
  need(&c, d->safety > 0 && d->safety <= 1, "time.safety", d->safety, "",
       "give a fraction above 0 and up to 1");
  if (c.status == VSC_OK && d->masses == VSC_MASS_CONSISTENT && d->solve.kind != VSC_SOLVE_IMPLICIT)
    c.status = vsc_fail(error, VSC_INPUT, "masses: consistent: take masses: lumped, or solve: implicit");
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
  check_kept(&c, d);
  need(&c, d->solve.tolerance >= 0 && d->solve.tolerance < 0.1, "solver.tolerance", d->solve.tolerance, "",
       "give a part of the forces below 0.1, or 0 for the usual one");
  return c.status;
}
