// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>
#include <stdarg.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/layers.h"
#include "mesh/topology.h"
#include "model/free_motions.h"
#include "model/law_constants.h"
#include "model/small_strain.h"
#include "run/check.h"
#include "run/idle_keys.h"

#define SLENDER 8.0  // vsc_mesh_slenderness from which a body is taken to bend: a cube has 5, a bar of two cubes 7, of four 10

// Where warnings go, and how many there were.
typedef struct writer {
  FILE *stream;
  const char *prefix;
  int count;
} writer;

__attribute__((format(printf, 2, 3))) static void warn(writer *w, const char *format, ...)
{
  va_list arguments;
  va_start(arguments, format);
  fputs(w->prefix, w->stream);
  vfprintf(w->stream, format, arguments);
  fputc('\n', w->stream);
  va_end(arguments);
  w->count++;
}

static double largest(const double three[3])
{
  return fmax(three[0], fmax(three[1], three[2]));
}

// Law PAPER is there to be compared with: its angular and radial forces derive from no energy.
static void warn_paper(writer *w, const vsc_material *material)
{
  warn(w,
       "material %s: law: paper keeps neither energy nor momenta, and its stiffness depends on the "
       "size of the elements; for results use law: springs",
       material->name);
}

static bool has_family(const vsc_model *model, vsc_family family)
{
  for (size_t p = 0; p < model->patch_count; p++)
    if (model->patches[p].family == family) return true;
  return false;
}

static void warn_volume(writer *w, const vsc_model *model, const vsc_material *material)
{
  const double stiff = largest(material->axial);
  const double shear = material->law == VSC_LAW_SPRINGS
                           ? fmax(largest(material->angular), stiff / 2)
                           : vsc_material_shear(model, material);
  const double K = material->volume_modulus, alone = material->element_modulus;
  if (K > 0 && K < stiff)
    warn(w,
         "material %s: volume_modulus %g kPa is below the stiffest axial modulus %g kPa: inverted "
         "elements "
         "could rest there; 100 times the shear modulus is usual",
         material->name, K, stiff);
  if (!model->terms.nodal_volume && has_family(model, VSC_TETS) && alone > 20 * shear)
    warn(w,
         "material %s: volume_modulus is %.0f times the shear modulus and each tet keeps its own "
         "volume: "
         "linear tets lock; use `volume: nodal`",
         material->name, alone / shear);
  if (has_family(model, VSC_WEDGES) && K > 20 * shear)
    warn(w,
         "material %s: volume_modulus is %.0f times the shear modulus, and wedges, which each keep their own volume, lock "
         "where they bend or shear in the plane of their triangles; use hexahedra or quadratic tets",
         material->name, K / shear);
  if (model->terms.nodal_volume && material->element_modulus == 0)
    warn(w,
         "material %s: node-averaged volume without stabilization lets single elements collapse; "
         "set "
         "stabilization to about the shear modulus (%g kPa)",
         material->name, shear);
}

// Frames that keep volumes of their own lock where they bend, whatever volume they share. What is a hundred times the shear
// modulus makes a beam of hexahedra 15 % too stiff; of laws that stiffen by exponentials more is right than at rest.
static void warn_stabilization(writer *w, const vsc_model *model, const vsc_material *material)
{
  const double shear = vsc_material_shear(model, material), times = material->stabilization / shear;
  if (!(shear > 0) || times < (vsc_law_has_exponent(material->law) ? 20 : 10)) return;
  warn(w,
       "material %s: stabilization is %.0f times the shear modulus at rest (%.3g kPa), so elements of every kind lock where they "
       "bend; leave it out, or take about the shear modulus of the stretched tissue",
       material->name, times, shear);
}

static void warn_material(writer *w, const vsc_problem *problem, size_t m)
{
  const vsc_material *material = &problem->model->materials[m];
  const vsc_definition *definition = &problem->scene->definition;
  const bool takes_elements = vsc_takes_elements(definition, m);
  if (material->element_count == 0 && takes_elements)
    warn(w, "material %s: no element has its regions", material->name);
  if (!takes_elements) return;
  if (vsc_law_is_of_strain(material->law)) {
    warn_volume(w, problem->model, material);
    warn_stabilization(w, problem->model, material);
  }
  if (vsc_law_is_of_strain(material->law) && definition->materials[m].stabilization > 0 &&
      material->stabilization == 0)
    warn(w, "material %s: stabilization does nothing with volume: element", material->name);
  if (material->law == VSC_LAW_PAPER) warn_paper(w, material);
}

static void warn_vessels(writer *w, const vsc_problem *problem)
{
  for (size_t v = 0; v < problem->scene->definition.vessel_count; v++) {
    const char *name = problem->scene->definition.vessels[v].name;
    const vsc_vessel_report *r = &problem->vessels[v];
    const double part = (r->volume + r->shared) / r->own_volume;
    if (r->open_edges + r->turned_edges > 0)
      warn(w,
           "vessel %s: %zu edges of its surface are open and %zu lie between triangles of opposite "
           "senses: what is inside was guessed from six sides",
           name, r->open_edges, r->turned_edges);
    if (part < 0.5)
      warn(w,
           "vessel %s: only %.0f %% of its volume lies in the mesh: are its unit and coordinates "
           "those of the mesh?",
           name, 100 * part);
    if (part > 1.05 && r->surface)
      warn(w, "vessel %s: it fills %.0f %% of its own volume: is its surface closed?", name,
           100 * part);
    if (r->shared > 0.05 * r->own_volume)
      warn(w, "vessel %s: %.3g ml of it lie in vessels listed before it and count for those", name,
           1e-3 * r->shared);
  }
}

static void warn_membranes(writer *w, const vsc_problem *problem)
{
  const vsc_model *model = problem->model;
  for (size_t k = 0; k < model->membrane_count; k++) {
    const vsc_membrane *m = &model->membranes[k];
    if (m->moduli.angular == 0)
      warn(w, "membrane %s: without an angular modulus it shears freely in its plane", m->name);
    if (m->bending == 0 && model->element_count == 0)
      warn(w, "membrane %s: without bending it folds freely; E t^3/12 is a plate's", m->name);
  }
}

// Elements without a fibre: those that cannot contract, and those whose global axes matter.
static void warn_no_fibre(writer *w, const vsc_problem *problem)
{
  const vsc_fiber_report *f = &problem->fibers;
  const vsc_fiber_def *def = &problem->scene->fibers;
  const bool active = problem->model->terms.active != VSC_ACTIVE_NONE && f->passive > 0;
  const size_t undirected = vsc_undirected_elements(problem->model);
  const char *remedy = def->fill ? "" : "; `fill: true` takes them from their neighbours";
  char global[128] = "";
  if (!active && undirected == 0) return;
  if (def->source != VSC_FIBER_MAP && def->source != VSC_FIBER_ARRAYS) remedy = "";
  if (def->source == VSC_FIBER_NONE) remedy = "; where that is meant, fibers.source: constant says so";
  if (undirected > 0)
    snprintf(global, sizeof global, "; in %zu of them the material depends on direction, and its f, s, n are global x, y, z",
             undirected);
  warn(w, "fibers: %zu of %zu elements have no fibre%s%s%s", f->passive, f->elements, active ? " and stay passive" : "",
       remedy, global);
}

static void warn_fibers(writer *w, const vsc_problem *problem)
{
  const vsc_fiber_report *f = &problem->fibers;
  const vsc_fiber_def *def = &problem->scene->fibers;
  warn_no_fibre(w, problem);
  if (f->invalid_sheets > 0)
    warn(w,
         "fibers: the sheet vectors of %zu of %zu elements are zero, not finite or along the fibre: their sheet is made of "
         "the global axis that is most across the fibre",
         f->invalid_sheets, f->elements);
  if (def->source == VSC_FIBER_MAP && f->filled > f->elements / 10)
    warn(w,
         "fibers: %.0f %% of the elements took their fibre from neighbours: does the map cover the "
         "mesh, in the "
         "same coordinates and unit?",
         100.0 * (double)f->filled / (double)f->elements);
  if (def->source == VSC_FIBER_MAP && f->coherence[1] < 0.3)
    warn(w,
         "fibers: the voxels within an element hardly agree (median %.2f of 1): a noisy map, or a "
         "wrong scale or "
         "angle convention",
         f->coherence[1]);
  if (f->meeting > 0)
    warn(w,
         "fibers: endo and epi meet at %zu nodes, where the depth jumps from 0 to 1 and fibres turn at once: where the "
         "base lies between them, let epi name the outside alone",
         f->meeting);
  if (f->off_faces > f->wall_faces / 4)
    warn(w, "fibers: %.0f %% of the wall's surface lies off both ellipsoids by more than a tenth of the wall: are their centre, "
         "axis, radii and lengths those of the mesh?", 100.0 * (double)f->off_faces / (double)f->wall_faces);
  if (f->constant)
    warn(w, "fibers: the array holds one and the same direction everywhere: perhaps a dummy");
  if (!def->sense_kept && f->opposed > f->elements / 50)
    warn(w, "fibers: within %.0f %% of the elements the vectors on the nodes differ by 90 to 170 degrees; taken as axes "
         "they turn the short way round, by 10 to 90, as is right where their signs mean nothing. Where a rule has made "
         "them, and their sense is meant, say fibers.arrays.sense: kept",
         100.0 * (double)f->opposed / (double)f->elements);
  if (f->worst_sheet_angle > 5)
    warn(w, "fibers: sheet and fibre are up to %.0f degrees off a right angle: perhaps dummies",
         f->worst_sheet_angle);
}

// Elements by the layers through the wall where they are.
typedef struct layer_counts {
  size_t on_surface, single, tets, shallow_tets;
  size_t place;  // an element amid the single ones
} layer_counts;

static bool count_layers(const vsc_mesh *mesh, layer_counts *counts)
{
  uint8_t *flags;
  size_t seen = 0;
  *counts = (layer_counts){0};
  if (!VSC_NEW(flags, mesh->element_count)) return false;
  const bool found = vsc_mesh_layers(mesh, flags, NULL) == VSC_OK;
  for (size_t e = 0; e < mesh->element_count && found; e++) {
    counts->on_surface += (flags[e] & VSC_ON_SURFACE) != 0;
    counts->single += (flags[e] & VSC_ONE_LAYER) != 0;
    counts->tets += mesh->kinds[e] == VSC_TET;
    counts->shallow_tets += mesh->kinds[e] == VSC_TET && (flags[e] & VSC_FEW_LAYERS) != 0;
  }
  for (size_t e = 0; e < mesh->element_count && found && 2 * seen < counts->single; e++)
    if (flags[e] & VSC_ONE_LAYER) seen++, counts->place = e;
  vsc_free(flags);
  return found;
}

static bool warn_one_layer(writer *w, const vsc_problem *problem, const layer_counts *counts)
{
  const vsc_mesh *mesh = problem->mesh;
  const double part = (double)counts->single / (double)mesh->element_count;
  char where[160] = "more than half of the elements have all corners on the surface";
  double at[3];
  if (part <= 0.1 && 2 * counts->on_surface <= mesh->element_count) return false;
  vsc_mesh_element_centre(mesh, counts->place, at);
  if (part > 0.1)
    snprintf(where, sizeof where, "%.0f %% of the elements, as %u at (%.4g, %.4g, %.4g) mm, have no node inside beside them",
             100 * part, mesh->element_source[counts->place], at[0], at[1], at[2]);
  warn(w,
       "mesh: %s, so the wall has fewer than two layers there while fibres turn through it: the apex and the twist will be "
       "off; take two layers or more%s",
       where, problem->scene->definition.tets == VSC_TETS_SMOOTHED ? ", or tets: plain" : "");
  return true;
}

// Linear tets in thin walls, with what they are off by in problem 1 of Land et al. 2015 with two and with four layers.
static void warn_bending(writer *w, const vsc_problem *problem, const layer_counts *counts)
{
  static const struct {
    const char *name;
    int two, four;
  } kinds[] = {{"linear tets", 26, 12}, {"linear tets with node-averaged volume", 24, 9}, {"smoothed tets", 11, 4}};
  const int kind = problem->scene->definition.tets == VSC_TETS_SMOOTHED ? 2 : problem->model->terms.nodal_volume;
  if (2 * counts->shallow_tets <= problem->mesh->element_count || vsc_mesh_slenderness(problem->mesh) < SLENDER) return;
  warn(w,
       "mesh: the body is slender, and %.0f %% of its elements are %s where at most two layers lie through it: they bend too "
       "little (a beam of two layers by %d %%, of four by %d %%); where it bends take mesh.order: 2, hexahedra or more layers",
       100.0 * (double)counts->shallow_tets / (double)problem->mesh->element_count, kinds[kind].name, kinds[kind].two,
       kinds[kind].four);
}

static void warn_layers(writer *w, const vsc_problem *problem, bool thorough)
{
  const vsc_fiber_source source = problem->scene->fibers.source;
  const vsc_model *model = problem->model;
  const bool turning = source != VSC_FIBER_NONE && source != VSC_FIBER_CONSTANT;
  bool bends = false;
  layer_counts counts;
  for (size_t m = 0; m < model->material_count; m++)
    bends |= model->materials[m].element_count > 0 && vsc_law_is_of_strain(model->materials[m].law);
  bends = bends && thorough && has_family(model, VSC_TETS);
  if (problem->mesh->element_count == 0 || !(turning || bends) || !count_layers(problem->mesh, &counts)) return;
  if (turning && warn_one_layer(w, problem, &counts)) return;
  if (bends) warn_bending(w, problem, &counts);
}

// Whether anything pulls at the body at the time where it is loaded.
static bool is_loaded(const vsc_model *model, double time)
{
  bool loaded = model->terms.gravity || model->delay != NULL;
  for (size_t p = 0; p < model->pressure_count; p++) loaded |= vsc_model_pressure(model, p, time) != 0;
  for (size_t s = 0; s < model->moved_count; s++) loaded |= vsc_curve_value(&model->moved[s].curve, time) != 0;
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_material *material = &model->materials[m];
    loaded |= material->active != VSC_ACTIVE_NONE && vsc_curve_value(&material->curve, time - material->delay) != 0;
  }
  return loaded;
}

static void warn_prestress(writer *w, const vsc_problem *problem)
{
  const vsc_prestress_def *def = &problem->scene->prestress;
  if (def->loaded && !is_loaded(problem->model, def->time))
    warn(w, "prestress: nothing loads the body at %g ms, so its shape at rest is the mesh: is prestress.time right?",
         def->time);
}

// Parts of a moving body that nothing holds beside others: of one that is whole that may be meant.
static void warn_parts(writer *w, const vsc_model *model)
{
  char where[VSC_FREE_TEXT];
  size_t parts;
  const size_t loose = vsc_loose_parts(model, &parts, where, sizeof where);
  if (parts > 1 && loose > 0)
    warn(w, "mesh: the body is in %zu parts that are not joined, and nothing holds %zu of them, as %s: are nodes at one "
         "place not joined?",
         parts, loose, where);
}

// Faces that only overlapping elements can share.
static void warn_overlaps(writer *w, const vsc_mesh *mesh)
{
  vsc_topology topology = {0};
  const bool known = vsc_topology_make(mesh, &topology, NULL) == VSC_OK;
  if (known && topology.crowded_faces > 0)
    warn(w, "mesh: three elements or more share a face, %zu times, as with element %u: they overlap, or are "
         "listed twice; remove what is double",
         topology.crowded_faces, mesh->element_source[topology.crowded_element]);
  if (known && topology.one_sided_faces > 0)
    warn(w, "mesh: two elements lie on the same side of a face that they share, %zu times, as with element %u: the mesh is "
         "folded there%s; mend it where it was made",
         topology.one_sided_faces, mesh->element_source[topology.one_sided_element],
         mesh->report.turned_elements > 0 ? " (elements that were inside out in it have been turned)" : "");
  vsc_topology_free(&topology);
}

// Whether some elements came left-handed and others not: the one or the other may have been inside out.
static bool is_of_both_hands(const vsc_mesh *mesh)
{
  return mesh->report.turned_elements > 0 && mesh->report.turned_elements < mesh->element_count;
}

static void warn_setting(writer *w, const vsc_problem *problem)
{
  const vsc_model *model = problem->model;
  double low[3], high[3], size[3];
  vsc_mesh_box(problem->mesh, low, high);
  vsc_subtract(high, low, size);
  if (vsc_norm(size) < 5 || vsc_norm(size) > 1000)
    warn(w, "mesh: its box is %.3g x %.3g x %.3g mm: is mesh.unit right?", size[0], size[1],
         size[2]);
  const bool driven = model->pressure_count > 0 || model->terms.gravity;
  if (model->held_count == 0 && model->obstacle_count == 0 && model->robin_count == 0 && driven &&
      model->solve.kind != VSC_SOLVE_EQUILIBRIUM)
    warn(w, "supports: nothing is held, so the load will carry the body away");
  char ways[VSC_FREE_TEXT];
  const bool rests = model->solve.kind == VSC_SOLVE_EQUILIBRIUM, balances = rests || problem->scene->prestress.loaded;
  if (!balances) warn_parts(w, model);
  if (balances && vsc_free_motions(model, ways, sizeof ways) > 0)
    warn(w, "%s: the body is free to %s, so forces that push it there never balance%s: hold it by supports or robin",
         rests ? "solve: equilibrium" : "prestress", ways,
         model->obstacle_count > 0 ? ", unless it touches obstacles from the start" : "");
  bool pushed = vsc_supports_move(model);
  for (size_t o = 0; o < model->obstacle_count; o++)
    pushed |= vsc_norm(model->obstacles[o].motion) > 0;
  if (model->stopped_count > 0)
    warn(w, "initial_velocity: supports hold %zu of the nodes that it moves, which start at rest in these directions",
         model->stopped_count);
  if (model->terms.active == VSC_ACTIVE_NONE && !driven && !pushed && model->velocity == NULL)
    warn(w, "nothing will move: no active material, no pressure, no gravity, no initial velocity");
  if (!model->terms.damping && model->branch_count == 0 && model->solve.kind != VSC_SOLVE_EQUILIBRIUM)
    warn(w, "materials: no damping, so vibrations never die away");
}

// Takes a curve that the model goes by, the key that has it, and the delay of what it drives, ms.
typedef void curve_judge(writer *w, const vsc_model *model, const vsc_curve *curve, double delay, const char *key);

static void judge_curves(writer *w, const vsc_model *model, curve_judge *judge)
{
  char key[VSC_NAME + 64];
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_material *material = &model->materials[m];
    snprintf(key, sizeof key, "material %s", material->name);
    if (material->active != VSC_ACTIVE_NONE) judge(w, model, &material->curve, material->delay, key);
  }
  for (size_t p = 0; p < model->pressure_count; p++) {
    snprintf(key, sizeof key, "pressures[%zu]", p);
    judge(w, model, &model->pressures[p].curve, 0, key);
  }
  for (size_t s = 0; s < model->moved_count; s++) {
    snprintf(key, sizeof key, "the support of %s", model->moved[s].set);
    judge(w, model, &model->moved[s].curve, 0, key);
  }
  for (size_t o = 0; o < model->obstacle_count; o++) {
    snprintf(key, sizeof key, "obstacles[%zu]", o);
    if (vsc_norm(model->obstacles[o].motion) > 0) judge(w, model, &model->obstacles[o].curve, 0, key);
  }
}

static void judge_cycle(writer *w, const vsc_model *model, const vsc_curve *curve, double delay, const char *key)
{
  const double cycles = curve->period > 0 ? model->cycle / curve->period : 1;
  (void)delay;
  if (cycles > 0.5 && fabs(cycles - round(cycles)) <= 1e-6) return;
  warn(w, "time.cycle: %g ms is no multiple of the period of %s, %g ms, so that a cycle does not have the loads of the last: "
       "give a multiple", model->cycle, key, curve->period);
}

// Where a period ends at another value than the next begins with, a load comes or goes at once.
static void judge_jump(writer *w, const vsc_model *model, const vsc_curve *curve, double delay, const char *key)
{
  if (!(curve->period > 0) || delay + curve->period > model->end_time) return;
  const double first = curve->values[0], last = curve->values[curve->intervals];
  if (fabs(last - first) > 0.01 * curve->range)
    warn(w, "%s: at the end of each period of its curve, %g ms, the value jumps from %.3g to %.3g: take a longer period, or "
         "values that meet there", key, curve->period, last, first);
}

static void warn_idle_keys(writer *w, const vsc_scene *scene)
{
  static const char *const kinds[] = {
      [VSC_SOLVE_EXPLICIT] = "explicit", [VSC_SOLVE_IMPLICIT] = "implicit", [VSC_SOLVE_EQUILIBRIUM] = "equilibrium"};
  char keys[VSC_IDLE_KEYS];
  const int count = vsc_idle_keys(scene, keys);
  if (count > 0)
    warn(w, "solve: %s: %s %s no effect", kinds[scene->definition.solve.kind], keys, count > 1 ? "have" : "has");
}

int vsc_check_warnings(const vsc_problem *problem, bool thorough, FILE *stream, const char *prefix)
{
  writer w = {stream, prefix, 0};
  if (thorough || is_of_both_hands(problem->mesh)) warn_overlaps(&w, problem->mesh);
  for (size_t m = 0; m < problem->model->material_count; m++)
    warn_material(&w, problem, m);
  warn_membranes(&w, problem);
  warn_layers(&w, problem, thorough);
  warn_fibers(&w, problem);
  warn_vessels(&w, problem);
  warn_prestress(&w, problem);
  warn_setting(&w, problem);
  if (problem->model->cycle > 0) judge_curves(&w, problem->model, judge_cycle);
  judge_curves(&w, problem->model, judge_jump);
  warn_idle_keys(&w, problem->scene);
  return w.count;
}
