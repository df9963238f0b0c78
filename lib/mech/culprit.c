// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/culprit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "mech/element.h"
#include "mech/energies.h"
#include "mech/force.h"

// ---- the element

// The energy of element `lane` of pack k.
static double energy_of(const vsc_model *model, const vsc_patch *patch, size_t k, int lane, const double *x,
                        const double *w)
{
  vsc_wide3 axes[VSC_MOST_POINTS][3];
  const vsc_pack_law law = vsc_pack_law_of(model, patch, k);
  for (int q = 0; q < vsc_family_frames(model, patch->family); q++) vsc_pack_axes(model, patch, k, q, x, axes[q]);
  const vsc_pack_energies e = vsc_cell_energies_of(model, patch, k, &law, axes, x, w != NULL ? w : x);
  const double sum = e.axial[lane] + e.angular[lane] + e.volume[lane];
  return isfinite(sum) ? sum : INFINITY;
}

static bool has_node(const vsc_model *model, const vsc_patch *patch, size_t k, int lane, size_t node)
{
  const uint16_t(*nodes)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
  for (int c = 0; c < vsc_family_corners(patch->family); c++)
    if (vsc_node_of(model, patch, nodes[c][lane]) == node) return true;
  return false;
}

// The element round the node with the largest energy, and whose material it has.
static uint32_t worst_element(const vsc_model *model, const double *x, const double *w, size_t node,
                              const vsc_material **material)
{
  uint32_t worst = VSC_NO_ELEMENT;
  double most = 0;
  *material = NULL;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        const uint32_t element = model->mesh_element[VSC_WIDTH * k + (size_t)l];
        if (element == VSC_NO_ELEMENT || !has_node(model, patch, k, l, node)) continue;
        const double energy = energy_of(model, patch, k, l, x, w);
        if (worst != VSC_NO_ELEMENT && !(energy > most)) continue;
        worst = element;
        most = energy;
        *material = &model->materials[patch->material];
      }
  }
  return worst;
}

// ---- the term: the model with ever less in it

typedef struct remains {
  vsc_model model;  // whose arrays below are its own
  vsc_material *materials;
  vsc_pair *pairs;
  vsc_patch *patches;
  double *group_modulus;
  const double *w;
  vsc_scratch *scratch;
} remains;

static void leave_damping(remains *r)
{
  r->w = NULL;
}

static void leave_weight(remains *r)
{
  r->model.terms.gravity = false;
}

static void leave_pressures(remains *r)
{
  r->model.pressure_count = 0;
}

static void leave_robins(remains *r)
{
  r->model.robin_count = 0;
}

static void leave_prony(remains *r)
{
  r->model.branch_count = 0;
}

static void leave_activity(remains *r)
{
  for (size_t m = 0; m < r->model.material_count; m++) r->materials[m].active = VSC_ACTIVE_NONE;
}

static void leave_volume(remains *r)
{
  for (size_t m = 0; m < r->model.material_count; m++) {
    vsc_material *material = &r->materials[m];
    material->volume_modulus = 0;
    material->paper.volume = 0;
    if (!r->model.terms.nodal_volume) material->element_modulus = 0;
  }
  memset(r->group_modulus, 0, r->model.node_count * sizeof *r->group_modulus);
  r->scratch->node_multiplier = r->scratch->pack_multiplier = NULL;
}

static void leave_stabilization(remains *r)
{
  for (size_t m = 0; m < r->model.material_count; m++)
    r->materials[m].stabilization = r->materials[m].element_modulus = 0;
}

static void leave_angular(remains *r)
{
  for (size_t m = 0; m < r->model.material_count; m++) {
    memset(r->materials[m].angular, 0, sizeof r->materials[m].angular);
    memset(r->materials[m].paper.angular, 0, sizeof r->materials[m].paper.angular);
  }
  for (size_t p = 0; p < r->model.pair_count; p++) r->pairs[p].modulus = 0;
}

static void leave_family(remains *r, uint32_t first, uint32_t last)
{
  for (size_t p = 0; p < r->model.patch_count; p++)
    if (r->patches[p].family >= first && r->patches[p].family <= last) r->patches[p].still = 1;
}

static void leave_solids(remains *r)
{
  leave_family(r, 0, VSC_CELLS - 1);
}

static void leave_bending(remains *r)
{
  leave_family(r, VSC_BENDS, VSC_BENDS);
}

static void leave_triangles(remains *r)
{
  leave_family(r, VSC_TRIANGLES, VSC_TRIANGLES);
}

static void leave_edges(remains *r)
{
  leave_family(r, VSC_SPRINGS_ON_EDGES, VSC_SPRINGS_ON_EDGES);
}

typedef struct term {
  const char *name;
  void (*leave)(remains *r);
} term;

// In this order: each needs what is left of the model behind it.
static const term terms[] = {{"damping", leave_damping},
                             {"weight", leave_weight},
                             {"pressure", leave_pressures},
                             {"surface springs", leave_robins},
                             {"Prony series", leave_prony},
                             {"active tension", leave_activity},
                             {"volume", leave_volume},
                             {"stabilization", leave_stabilization},
                             {"angular springs", leave_angular},
                             {"axial springs", leave_solids},
                             {"bending", leave_bending},
                             {"membranes", leave_triangles},
                             {"springs on edges", leave_edges}};

// What the scene calls it.
static const char *name_of(const term *t, const vsc_model *model, const vsc_material *material)
{
  if (t->leave == leave_activity && model->terms.active == VSC_ACTIVE_SPRING) return "active springs";
  const bool springs = material == NULL || material->law == VSC_LAW_SPRINGS || material->law == VSC_LAW_PAPER;
  return t->leave == leave_solids && !springs ? "the material's law" : t->name;
}

static void remains_free(remains *r)
{
  vsc_free(r->materials);
  vsc_free(r->pairs);
  vsc_free(r->patches);
  vsc_free(r->group_modulus);
}

static bool remains_open(const vsc_model *model, const double *w, vsc_scratch *scratch, remains *r)
{
  *r = (remains){.model = *model, .w = w, .scratch = scratch};
  if (!VSC_NEW(r->materials, model->material_count) || !VSC_NEW(r->pairs, model->pair_count) ||
      !VSC_NEW(r->patches, model->patch_count) || !VSC_NEW(r->group_modulus, model->node_count)) {
    remains_free(r);
    return false;
  }
  for (size_t m = 0; m < model->material_count; m++) r->materials[m] = model->materials[m];
  for (size_t p = 0; p < model->pair_count; p++) r->pairs[p] = model->pairs[p];
  for (size_t p = 0; p < model->patch_count; p++) r->patches[p] = model->patches[p];
  if (model->terms.nodal_volume) memcpy(r->group_modulus, model->group_modulus, model->node_count * sizeof(double));
  r->model.materials = r->materials;
  r->model.pairs = r->pairs;
  r->model.patches = r->patches;
  if (model->terms.nodal_volume) r->model.group_modulus = r->group_modulus;
  return true;
}

void vsc_culprit_weigh(vsc_culprit *culprit, const char *name, const double force[3])
{
  const double norm = hypot(hypot(force[0], force[1]), force[2]), size = isfinite(norm) ? norm : INFINITY;
  if (!(size > culprit->force)) return;
  culprit->term = name;
  culprit->force = size;
}

static void find_term(const vsc_model *model, const vsc_material *material, const double *x, double time, remains *r,
                      double *force, size_t node, vsc_culprit *culprit)
{
  double before[3], part[3];
  vsc_force(&r->model, x, r->w, time, r->scratch, force);
  memcpy(before, force + 4 * node, sizeof before);
  for (size_t k = 0; k < sizeof terms / sizeof terms[0]; k++) {
    terms[k].leave(r);
    r->scratch->still_known = false;
    vsc_force(&r->model, x, r->w, time, r->scratch, force);
    const double *left = force + 4 * node;
    const bool was = isfinite(before[0] + before[1] + before[2]), is = isfinite(left[0] + left[1] + left[2]);
    if (was && !is) return;  // none of nothing is no number: what is left tells no more
    for (size_t i = 0; i < 3; i++) part[i] = was ? before[i] - left[i] : INFINITY;
    if (is) vsc_culprit_weigh(culprit, name_of(&terms[k], model, material), part);
    if (is && !was) return;
    memcpy(before, left, sizeof before);
  }
}

vsc_culprit vsc_find_culprit(const vsc_model *model, const double *x, const double *w, double time, vsc_scratch *scratch,
                             size_t node)
{
  const vsc_material *material;
  const uint32_t worst = worst_element(model, x, w, node, &material);
  vsc_culprit culprit = {.element = worst != VSC_NO_ELEMENT ? vsc_source_number(model->element_source, worst) : worst};
  double *const multipliers[2] = {scratch->node_multiplier, scratch->pack_multiplier}, *force;
  remains r;
  if (!remains_open(model, w, scratch, &r)) return culprit;
  if (VSC_NEW(force, 4 * model->node_count)) find_term(model, material, x, time, &r, force, node, &culprit);
  scratch->node_multiplier = multipliers[0];
  scratch->pack_multiplier = multipliers[1];
  scratch->still_known = false;
  vsc_free(force);
  remains_free(&r);
  return culprit;
}

const char *vsc_name_culprit(const vsc_culprit *culprit, const char *when, char *text, size_t size)
{
  char element[48] = "";
  const bool term = culprit->term != NULL;
  if (culprit->element != VSC_NO_ELEMENT)
    snprintf(element, sizeof element, "; it is of element %u%s", culprit->element, term ? ", and" : "");
  else if (term)
    snprintf(element, sizeof element, ";");
  if (term)
    snprintf(text, size, "%s the largest force on it, %.2g mN%s, is that of %s", element, culprit->force, when, culprit->term);
  else
    snprintf(text, size, "%s", element);
  return text;
}
