// SPDX-License-Identifier: GPL-3.0-or-later
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/hash.h"
#include "base/mem.h"
#include "base/vec3.h"
#include "model/mixture.h"
#include "model/model.h"
#include "model/patches.h"
#include "model/small_strain.h"
#include "model/terms.h"

// Appends the further axes and pairs of a material to the model's.
static void copy_axes(const vsc_material_def *def, vsc_material *material, vsc_model *model)
{
  double direction[3 + VSC_MOST_AXES][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  material->first_axis = model->axis_count;
  material->axis_count = def->axis_count;
  for (size_t k = 0; k < def->axis_count; k++) {
    vsc_axis *axis = &model->axes[model->axis_count++];
    *axis = (vsc_axis){.modulus = def->axes[k].modulus, .damping = def->axes[k].damping};
    memcpy(axis->direction, def->axes[k].direction, sizeof axis->direction);
    vsc_normalize(axis->direction);
    memcpy(direction[3 + k], axis->direction, sizeof axis->direction);
  }
  material->first_pair = model->pair_count;
  material->pair_count = def->pair_count;
  for (size_t k = 0; k < def->pair_count; k++) {
    vsc_pair *pair = &model->pairs[model->pair_count++];
    memcpy(pair->first, direction[def->pairs[k].axes[0]], sizeof pair->first);
    memcpy(pair->second, direction[def->pairs[k].axes[1]], sizeof pair->second);
    pair->cosine = vsc_dot(pair->first, pair->second);
    pair->modulus = def->pairs[k].modulus;
  }
}

// Whether anything in the material resists velocity.
static bool is_damped(const vsc_material_def *def)
{
  double most = 0;
  for (int a = 0; a < 3; a++) {
    if (def->law == VSC_LAW_SPRINGS) most = fmax(most, def->damping[a]);
    if (def->law == VSC_LAW_PAPER) most = fmax(most, def->paper.damping[a]);
  }
  if (def->law == VSC_LAW_PAPER) most = fmax(most, def->paper.volume_damping);
  if (def->law == VSC_LAW_CLASSICAL) most = fmax(most, def->classical.damping);
  if (vsc_law_is_of_strain(def->law)) most = fmax(most, def->viscosity);
  for (size_t k = 0; k < def->axis_count; k++) most = fmax(most, def->axes[k].damping);
  return most > 0;
}

// The constants of a tissue law, and the stress that it would have at rest without the logarithm.
static void copy_law(const vsc_material_def *def, vsc_material *material)
{
  const vsc_guccione_def *guccione = &def->guccione;
  const double bf = guccione->fibre, bt = guccione->cross, bfs = guccione->shear;
  switch (def->law) {
    case VSC_LAW_NEO_HOOKEAN:
      material->shear = material->rest_shear = def->shear;
      break;
    case VSC_LAW_GUCCIONE:
      material->fung = (vsc_fung_def){guccione->C, {bf, bt, bt, bfs, bt, bfs}};
      break;
    case VSC_LAW_FUNG:
      material->fung = def->fung;
      break;
    case VSC_LAW_HOLZAPFEL_OGDEN:
      material->holzapfel_ogden = def->holzapfel_ogden;
      material->compression = def->compression;
      material->rest_shear = def->holzapfel_ogden.a;
      break;
    case VSC_LAW_MOONEY_RIVLIN:
      material->invariants = def->mooney_rivlin;
      material->rest_shear = 2 * def->mooney_rivlin.c1 + 4 * def->mooney_rivlin.c2;
      break;
    case VSC_LAW_VERONDA_WESTMANN:
      material->invariants = def->veronda_westmann;
      break;
    default:
      return;
  }
  material->isochoric = def->isochoric;
  if (def->isochoric) material->rest_shear = 0;
}

// What shares volumes: linear tets by nodes, and cells of other kinds their own frames.
typedef struct volume_sharing {
  bool nodes;   // volume: nodal
  bool frames;  // that, or some cell is no linear tet
} volume_sharing;

static volume_sharing sharing_of(const vsc_mesh *mesh, const vsc_definition *definition)
{
  const bool nodes = definition->volume == VSC_VOLUME_NODAL;
  bool others = false;
  for (size_t e = 0; e < mesh->element_count; e++) others |= mesh->kinds[e] != VSC_TET;
  return (volume_sharing){nodes, nodes || others};
}

// What all laws of strain have. Tets that are alone among cells of other kinds are as stiff as these.
static void copy_moduli(const vsc_material_def *def, volume_sharing sharing, vsc_material *material)
{
  material->volume_modulus = def->volume_modulus;
  material->stabilization = sharing.frames ? def->stabilization : 0;
  material->element_modulus = material->stabilization + (sharing.nodes ? 0 : def->volume_modulus);
  material->viscosity = def->viscosity;
  if (def->law != VSC_LAW_SPRINGS) return;
  memcpy(material->axial, def->axial, sizeof material->axial);
  memcpy(material->angular, def->angular, sizeof material->angular);
  memcpy(material->coupling, def->coupling, sizeof material->coupling);
  memcpy(material->damping, def->damping, sizeof material->damping);
}

// Without a stabilisation of its own a tissue law takes its shear modulus out of the volume modulus, half of that at
// most: frames that share a volume collapse under large loads otherwise.
static void complete_stabilization(volume_sharing sharing, const vsc_model *model, vsc_material *material)
{
  if (!vsc_law_is_of_strain(material->law) || material->law == VSC_LAW_SPRINGS || !sharing.frames ||
      material->stabilization > 0)
    return;
  const double own = fmin(vsc_material_shear(model, material), 0.5 * material->volume_modulus);
  material->stabilization = own;
  if (sharing.nodes) material->element_modulus = own;
  material->volume_modulus -= own;
}

static bool has_coupling(const vsc_material *material)
{
  return material->coupling[0] != 0 || material->coupling[1] != 0 || material->coupling[2] != 0;
}

static bool needs_general(const vsc_material *material)
{
  const bool plain_tension = material->length_factor == 0 && material->tension_parts[0] == 0 &&
                             material->tension_parts[1] == 0;
  return vsc_law_is_of_strain(material->law) &&
         (material->law != VSC_LAW_SPRINGS || has_coupling(material) || material->viscosity > 0 ||
          (material->active == VSC_ACTIVE_TENSION && !plain_tension));
}

static void copy_material(const vsc_material_def *def, volume_sharing sharing, vsc_material *material, vsc_model *model)
{
  vsc_copy_name(material->name, def->name);
  material->density = def->density;
  material->law = def->law;
  material->damped = is_damped(def);
  if (vsc_law_is_of_strain(def->law)) copy_moduli(def, sharing, material);
  material->branch_count = def->prony_count;
  for (size_t k = 0; k < def->prony_count; k++) material->branches[k] = def->prony[k];
  if (def->law == VSC_LAW_SPRINGS) copy_axes(def, material, model);
  copy_law(def, material);
  complete_stabilization(sharing, model, material);
  if (def->law == VSC_LAW_PAPER) material->paper = def->paper;
  if (def->law == VSC_LAW_CLASSICAL) material->classical = def->classical;
  material->active = def->active.kind;
  material->active_stiffness = def->active.stiffness;
  material->rest_stretch = def->active.rest_stretch;
  material->tension = def->active.tension;
  material->length_factor = def->active.length_factor;
  material->tension_parts[0] = def->active.sheet_fraction;
  material->tension_parts[1] = def->active.normal_fraction;
  material->general = needs_general(material);
  material->delay = def->active.delay;
}

static vsc_status build_materials(const vsc_mesh *mesh, const vsc_definition *definition, vsc_model *model,
                                  vsc_error *error)
{
  const volume_sharing sharing = sharing_of(mesh, definition);
  size_t axes = 0, pairs = 0;
  for (size_t m = 0; m < definition->material_count; m++) {
    axes += definition->materials[m].axis_count;
    pairs += definition->materials[m].pair_count;
  }
  model->material_count = definition->material_count;
  if (!VSC_NEW(model->materials, model->material_count) || !VSC_NEW(model->axes, axes) ||
      !VSC_NEW(model->pairs, pairs))
    return vsc_fail_memory(error, "materials");
  for (size_t m = 0; m < model->material_count; m++) {
    copy_material(&definition->materials[m], sharing, &model->materials[m], model);
    const vsc_material *material = &model->materials[m];
    model->terms.damping |= material->damped;
    model->terms.paper |= material->law == VSC_LAW_PAPER;
    model->terms.general |= has_coupling(material) || material->viscosity > 0;
    if (material->branch_count > model->branch_count) model->branch_count = material->branch_count;
    if (material->active == VSC_ACTIVE_NONE) continue;
    if (model->terms.active != VSC_ACTIVE_NONE && model->terms.active != material->active)
      return vsc_fail(
          error, VSC_INPUT,
          "materials[%zu].active.kind: a scene has active springs or active tension, not both; "
          "use one kind in all materials",
          m);
    model->terms.active = material->active;
  }
  model->terms.nodal_volume = definition->volume == VSC_VOLUME_NODAL;
  model->terms.smoothed = definition->tets == VSC_TETS_SMOOTHED;
  return VSC_OK;
}

// Elements and volume of each material.
static void count_materials(vsc_model *model)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch)) continue;
    vsc_material *material = &model->materials[patch->material];
    const int frames = vsc_family_frames(model, patch->family);
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        if (model->mesh_element[VSC_WIDTH * k + l] == VSC_NO_ELEMENT) continue;
        material->element_count++;
        for (int q = 0; q < frames; q++)
          material->volume += vsc_pack_frames(model, patch, k)[q].V[l];
      }
  }
}

static uint64_t hash_loads(const vsc_model *model, uint64_t hash)
{
  for (size_t p = 0; p < model->pressure_count; p++) {
    const vsc_pressure *load = &model->pressures[p];
    const vsc_facets *facets = &load->facets;
    hash = vsc_hash(hash, facets->corners, 3 * facets->count * sizeof(uint32_t));
    if (facets->mid) hash = vsc_hash(hash, facets->mid, 3 * facets->count * sizeof(uint32_t));
    hash = vsc_hash(hash, &load->peak, sizeof load->peak);
    hash = vsc_hash(hash, load->direction, sizeof load->direction);
    hash = vsc_hash(hash, &load->curve.hash, sizeof load->curve.hash);
  }
  for (size_t r = 0; r < model->robin_count; r++) {
    const vsc_robin *robin = &model->robins[r];
    hash = vsc_hash(hash, robin->nodes, robin->node_count * sizeof *robin->nodes);
    hash = vsc_hash(hash, robin->blocks, 12 * robin->start[robin->node_count] * sizeof(double));
    hash = vsc_hash(hash, &robin->stiffness, sizeof robin->stiffness);
    hash = vsc_hash(hash, &robin->damping, sizeof robin->damping);
  }
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_moved *moved = &model->moved[s];
    hash = vsc_hash(hash, moved->nodes, moved->node_count * sizeof *moved->nodes);
    hash = vsc_hash(hash, moved->motion, sizeof moved->motion);
    hash = vsc_hash(hash, &moved->curve.hash, sizeof moved->curve.hash);
  }
  return hash;
}

// What is hashed as a whole has nothing between its numbers, or, in the model's own arrays, zeros.
_Static_assert(sizeof(vsc_solve_def) == 4 * sizeof(vsc_scheme) + 4 * sizeof(double), "solve_def is hashed as it lies");

static void hash_model(vsc_model *model)
{
  const size_t slots = VSC_WIDTH * model->pack_count;
  uint64_t hash = vsc_hash(VSC_HASH_START, model->store, model->store_size);
  hash = vsc_hash(hash, model->patches, model->patch_count * sizeof *model->patches);
  hash = vsc_hash(hash, model->known, slots * sizeof *model->known);
  hash = vsc_hash(hash, &model->terms.nodal_volume, sizeof model->terms.nodal_volume);
  hash = vsc_hash(hash, model->inverse_mass, 4 * model->node_count * sizeof(double));
  hash = vsc_hash(hash, model->rest, 4 * model->node_count * sizeof(double));
  if (model->amplitude) hash = vsc_hash(hash, model->amplitude, slots * sizeof(double));
  if (model->delay) hash = vsc_hash(hash, model->delay, slots * sizeof(double));
  for (size_t m = 0; m < model->material_count; m++) {
    vsc_material plain;
    memcpy(&plain, &model->materials[m], sizeof plain);  // a copy by value need not keep what lies between its numbers
    memset(plain.name, 0, sizeof plain.name);
    hash = vsc_hash(hash, &plain.curve.hash, sizeof plain.curve.hash);
    memset(&plain.curve, 0, sizeof plain.curve);
    hash = vsc_hash(hash, &plain.density, sizeof plain - offsetof(vsc_material, density));
  }
  for (size_t m = 0; m < model->membrane_count; m++)
    hash = vsc_hash(hash, &model->membranes[m].thickness,
                    sizeof model->membranes[m] - offsetof(vsc_membrane, thickness));
  hash = hash_loads(model, hash);
  for (size_t o = 0; o < model->obstacle_count; o++) {
    const vsc_obstacle *obstacle = &model->obstacles[o];
    hash = vsc_hash(hash, &obstacle->kind, offsetof(vsc_obstacle, curve));
    hash = vsc_hash(hash, &obstacle->curve.hash, sizeof obstacle->curve.hash);
    hash = vsc_hash(hash, obstacle->nodes, obstacle->node_count * sizeof *obstacle->nodes);
  }
  hash = vsc_hash(hash, &model->kept.kind, sizeof model->kept.kind);
  hash = vsc_hash(hash, model->axes, model->axis_count * sizeof *model->axes);
  hash = vsc_hash(hash, model->pairs, model->pair_count * sizeof *model->pairs);
  hash = vsc_hash(hash, model->gravity, sizeof model->gravity);
  if (model->velocity) hash = vsc_hash(hash, model->velocity, 4 * model->node_count * sizeof(double));
  hash = vsc_hash(hash, &model->step, sizeof model->step);
  hash = vsc_hash(hash, &model->safety, sizeof model->safety);
  hash = vsc_hash(hash, &model->masses, sizeof model->masses);
  model->hash = vsc_hash(hash, &model->solve, sizeof model->solve);
}

static vsc_status check_fibres(const vsc_model *model, vsc_error *error)
{
  for (size_t slot = 0; slot < VSC_WIDTH * model->pack_count; slot++)
    if (model->known[slot]) return VSC_OK;
  if (model->terms.active == VSC_ACTIVE_NONE) return VSC_OK;
  return vsc_fail(
      error, VSC_INPUT,
      "fibers: a material is active but no element has a fibre, so nothing would contract; choose "
      "fibers.source (map, arrays, helix, constant, ...)");
}

// Node groups exist where tets under a law of strain do.
static bool any_shares_volume(const vsc_model *model)
{
  for (size_t p = 0; p < model->patch_count; p++)
    if (vsc_patch_shares_volume(model, &model->patches[p])) return true;
  return false;
}

static void copy_membrane(const vsc_membrane_def *def, const vsc_sheet *sheet,
                          vsc_membrane *membrane)
{
  vsc_copy_name(membrane->name, def->name);
  membrane->thickness = def->thickness;
  membrane->density = def->density;
  membrane->moduli = (vsc_sheet_moduli){.axial = {def->axial[0], def->axial[1]},
                                        .angular = def->angular,
                                        .area = def->area_modulus};
  memcpy(membrane->damping, def->damping, sizeof membrane->damping);
  membrane->bending = def->bending;
  membrane->lag = (def->damping[0] + def->damping[1]) / (def->axial[0] + def->axial[1]);
  membrane->triangle_count = sheet->count;
  for (size_t k = 0; k < sheet->count; k++) membrane->area += sheet->area[k];
}

// Membranes and their sheets. "triangles" are all triangles of the file, unless a surface has that
// name.
static vsc_status build_membranes(const vsc_mesh *mesh, const vsc_definition *definition,
                                  vsc_sheet *sheets, vsc_model *model, vsc_error *error)
{
  model->membrane_count = definition->membrane_count;
  if (!VSC_NEW(model->membranes, model->membrane_count)) return vsc_fail_memory(error, "membranes");
  for (size_t m = 0; m < model->membrane_count; m++) {
    const vsc_membrane_def *def = &definition->membranes[m];
    const vsc_surface all = {.count = mesh->triangle_count, .triangles = mesh->triangles};
    const int named = vsc_model_find_surface(model, def->surface);
    const vsc_surface *surface = named >= 0 ? &model->surfaces[named] : &all;
    if (surface->count == 0)
      return vsc_fail(error, VSC_INPUT,
                      "membranes[%zu].surface: the mesh has no triangles; name one of the surfaces, "
                      "or boundary",
                      m);
    const vsc_status status = vsc_sheet_make(mesh, surface, def, &sheets[m], error);
    if (status != VSC_OK) return status;
    copy_membrane(def, &sheets[m], &model->membranes[m]);
    model->terms.damping |= def->damping[0] > 0 || def->damping[1] > 0;
  }
  return VSC_OK;
}

static vsc_status build_elements(const vsc_mesh *mesh, const vsc_axes *axes,
                                 const vsc_definition *definition, const uint32_t *material_of,
                                 uint8_t *mixed, vsc_model *model, vsc_error *error)
{
  vsc_parts parts = {0};
  vsc_sheet *sheets;
  uint8_t *still = NULL;
  if (!VSC_NEW(sheets, definition->membrane_count)) return vsc_fail_memory(error, "membranes");
  vsc_status status = vsc_mixture_find(mesh, definition, material_of, mixed, error);
  if (status == VSC_OK) status = build_membranes(mesh, definition, sheets, model, error);
  if (status == VSC_OK) status = vsc_terms_still(mesh, definition, model, &still, error);
  if (status == VSC_OK)
    status = vsc_parts_list(mesh, material_of, mixed, still, sheets, model, &parts, error);
  if (status == VSC_OK) status = vsc_patches_build(mesh, axes, &parts, model, error);
  vsc_parts_free(&parts);
  for (size_t m = 0; m < definition->membrane_count; m++) vsc_sheet_free(&sheets[m]);
  vsc_free(sheets);
  vsc_free(still);
  if (status == VSC_OK) model->terms.nodal_volume = any_shares_volume(model);
  if (status == VSC_OK) status = vsc_mixture_fill(mesh, definition, model, error);
  return status;
}

// What knows corners only.
static vsc_status check_order(const vsc_mesh *mesh, const vsc_definition *definition,
                              vsc_error *error)
{
  const char *key = NULL;
  if (!vsc_mesh_is_quadratic(mesh)) return VSC_OK;
  if (definition->masses == VSC_MASS_VORONOI) key = "masses: voronoi";
  if (definition->kept_volume != VSC_KEEP_NONE) key = "keep_volume";
  if (definition->membrane_count > 0) key = "membranes";
  if (key == NULL) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: not with quadratic tetrahedra: leave it out, or use a mesh of linear tetrahedra "
                  "without mesh.order: 2",
                  key);
}

// With the tolerance that was left to us: what Newton's method leaves undone in a step is to be far below the step's
// error (on beats 1e-4 of the forces at work are 3e-6 of the stroke, where steps of accuracy 1e-4 make 1e-2).
static vsc_solve_def complete_solve(const vsc_definition *definition)
{
  vsc_solve_def solve = definition->solve;
  const bool controlled = solve.kind == VSC_SOLVE_IMPLICIT && !(definition->step > 0);
  if (solve.tolerance != 0) return solve;
  solve.tolerance = VSC_USUAL_TOLERANCE;
  if (controlled) solve.tolerance = fmax(fmin(solve.accuracy, 1e-4), VSC_USUAL_TOLERANCE);
  return solve;
}

// A copy of a mesh's source numbers, where they are not the numbers of the mesh itself.
static bool keep_source(const uint32_t *source, size_t count, uint32_t **kept)
{
  size_t same = 0;
  while (same < count && source[same] == same) same++;
  if (same == count) return true;
  if (!VSC_NEW(*kept, count)) return false;
  memcpy(*kept, source, count * sizeof *source);
  return true;
}

static vsc_status build(const vsc_mesh *mesh, const vsc_mesh *shown, const vsc_axes *axes,
                        const vsc_definition *definition, uint32_t *material_of, uint8_t *mixed,
                        vsc_model *model, vsc_error *error)
{
  model->end_time = definition->end_time;
  model->step = definition->step;
  model->force_step = definition->force_step;
  model->safety = definition->safety;
  model->cycle = definition->cycle;
  model->cycle_tolerance = definition->cycle_tolerance;
  model->solve = complete_solve(definition);
  // nothing but weight hangs on the masses of equilibria
  model->masses = definition->solve.kind == VSC_SOLVE_EQUILIBRIUM ? VSC_MASS_LUMPED : definition->masses;
  if (!keep_source(mesh->node_source, mesh->node_count, &model->node_source) ||
      !keep_source(mesh->element_source, mesh->element_count, &model->element_source))
    return vsc_fail_memory(error, "the numbers of the mesh's nodes and elements");
  vsc_status status = check_order(mesh, definition, error);
  if (status == VSC_OK) status = vsc_terms_materials(mesh, definition, material_of, error);
  if (status == VSC_OK) status = build_materials(mesh, definition, model, error);
  if (status == VSC_OK) status = vsc_terms_selections(shown, definition, model, error);
  if (status == VSC_OK)
    status = build_elements(mesh, axes, definition, material_of, mixed, model, error);
  if (status != VSC_OK) return status;
  count_materials(model);
  status = check_fibres(model, error);
  if (status == VSC_OK) status = vsc_terms_activation(mesh, definition, model, error);
  if (status == VSC_OK) status = vsc_terms_smoothing(model, error);
  if (status == VSC_OK) status = vsc_terms_masses(mesh, definition, material_of, model, error);
  if (status == VSC_OK) status = vsc_terms_volume_groups(model, error);
  if (status == VSC_OK) status = vsc_terms_supports(definition, model, error);
  if (status == VSC_OK) status = vsc_terms_obstacles(mesh, definition, model, error);
  if (status == VSC_OK)
    status = vsc_terms_kept_volumes(mesh, definition, material_of, model, error);
  if (status == VSC_OK) status = vsc_terms_loads(mesh, definition, material_of, model, error);
  if (status == VSC_OK) status = vsc_terms_velocity(mesh, definition, model, error);
  if (status == VSC_OK) hash_model(model);
  return status;
}

vsc_status vsc_model_build(const vsc_mesh *mesh, const vsc_axes *axes,
                           const vsc_definition *definition, vsc_model **model, vsc_error *error)
{
  return vsc_model_build_shown(mesh, mesh, axes, definition, model, error);
}

vsc_status vsc_model_build_shown(const vsc_mesh *mesh, const vsc_mesh *shown, const vsc_axes *axes,
                                 const vsc_definition *definition, vsc_model **model, vsc_error *error)
{
  *model = NULL;
  vsc_status status = vsc_definition_check(definition, error);
  if (status != VSC_OK) return status;
  if (axes != NULL && axes->count != mesh->element_count)
    return vsc_fail(error, VSC_INPUT,
                    "fibers: axes of %zu elements for a mesh of %zu; give one frame per element",
                    axes->count, mesh->element_count);
  if (axes != NULL && axes->points > 1 && !vsc_mesh_is_quadratic(mesh))
    return vsc_fail(error, VSC_INPUT,
                    "fibers: axes of %d frames per element for a mesh of linear ones; make axes with "
                    "vsc_axes_create_for",
                    axes->points);
  if (axes != NULL && !vsc_axes_valid(axes))
    return vsc_fail(error, VSC_INPUT,
                    "fibers: a frame is not orthonormal and right-handed; make frames with "
                    "vsc_axes_complete");
  vsc_model *built;
  uint32_t *material_of;
  uint8_t *mixed = NULL;
  if (!VSC_NEW(built, 1)) return vsc_fail_memory(error, "the model");
  if (VSC_NEW(material_of, mesh->element_count) && VSC_NEW(mixed, mesh->element_count))
    status = build(mesh, shown, axes, definition, material_of, mixed, built, error);
  else
    status = vsc_fail_memory(error, "the model");
  vsc_free(material_of);
  vsc_free(mixed);
  if (status != VSC_OK) {
    vsc_model_free(built);
    return status;
  }
  *model = built;
  return VSC_OK;
}
