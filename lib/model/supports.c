// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "model/terms.h"

vsc_status vsc_terms_selections(const vsc_mesh *mesh, const vsc_definition *definition,
                                vsc_model *model, vsc_error *error)
{
  // the whole boundary goes first, under its own name, unless the user gave that name to something
  // else
  bool taken = false;
  for (size_t s = 0; s < definition->surface_count; s++)
    taken |= strcmp(definition->surfaces[s].name, "boundary") == 0;
  if (!VSC_NEW(model->surfaces, definition->surface_count + 1) ||
      !VSC_NEW(model->sets, definition->set_count))
    return vsc_fail_memory(error, "surfaces and node sets");
  vsc_surface boundary = {0};
  vsc_status status = vsc_boundary(mesh, &boundary, error);
  for (size_t s = 0; status == VSC_OK && s < definition->surface_count; s++)
    status = vsc_in_list("surfaces", s,
                         vsc_select_surface(mesh, &boundary, &definition->surfaces[s],
                                            &model->surfaces[model->surface_count++], error),
                         error);
  if (status != VSC_OK || taken) {
    vsc_surface_free(&boundary);
  } else {
    vsc_copy_name(boundary.name, "boundary");
    model->surfaces[model->surface_count++] = boundary;
  }
  for (size_t s = 0; status == VSC_OK && s < definition->set_count; s++)
    status = vsc_in_list("node_sets", s,
                         vsc_select_nodes(mesh, &definition->sets[s], model->surfaces, model->surface_count,
                                          &model->sets[model->set_count++], error),
                         error);
  return status;
}

static const vsc_node_set *find_set(const vsc_model *model, const char *name)
{
  for (size_t s = 0; s < model->set_count; s++)
    if (strcmp(model->sets[s].name, name) == 0) return &model->sets[s];
  return NULL;
}

static bool is_moved(const vsc_support_def *support)
{
  return support->motion[0] != 0 || support->motion[1] != 0 || support->motion[2] != 0;
}

vsc_status vsc_terms_still(const vsc_mesh *mesh, const vsc_definition *definition, const vsc_model *model,
                           uint8_t **still, vsc_error *error)
{
  enum { ALL = 7, MOVED = 8 };
  if (!VSC_NEW(*still, mesh->node_count)) return vsc_fail_memory(error, "held nodes");
  for (size_t s = 0; s < definition->support_count; s++) {
    const vsc_support_def *support = &definition->supports[s];
    const vsc_node_set *set = find_set(model, support->set);
    int held = is_moved(support) ? MOVED : 0;
    for (int i = 0; i < 3; i++) held |= (support->held[i] != 0) << i;
    for (size_t k = 0; set != NULL && k < set->count; k++) (*still)[set->nodes[k]] |= (uint8_t)held;
  }
  for (size_t n = 0; n < mesh->node_count; n++) (*still)[n] = (*still)[n] == ALL;
  return VSC_OK;
}

// What is known of the supports while they are read one after the other.
typedef struct supporting {
  const vsc_definition *definition;
  const uint32_t *number;  // the model's number of the mesh's nodes
  uint32_t *holder;        // node_count x 3: 1 + the support that holds the direction, 0: none
} supporting;

// A direction may be held by several supports, but not be moved by one of them.
static vsc_status check_holder(const supporting *all, size_t s, uint32_t node, int i,
                               const vsc_model *model, vsc_error *error)
{
  const size_t other = all->holder[3 * (size_t)node + (size_t)i];
  const vsc_support_def *supports = all->definition->supports;
  if (other == 0 || (supports[s].motion[i] == 0 && supports[other - 1].motion[i] == 0))
    return VSC_OK;
  const double *at = model->rest + 4 * (size_t)node;
  return vsc_fail(error, VSC_INPUT,
                  "supports[%zu].motion: the node at (%.4g, %.4g, %.4g) mm is held in %c by "
                  "supports[%zu] too, so where it goes is said twice; leave it out of one of the sets",
                  supports[s].motion[i] != 0 ? s : other - 1, at[0], at[1], at[2], "xyz"[i],
                  supports[s].motion[i] != 0 ? other - 1 : s);
}

static vsc_status hold(const supporting *all, size_t s, const vsc_node_set *set, vsc_model *model,
                       vsc_error *error)
{
  for (size_t k = 0; k < set->count; k++)
    for (int i = 0; i < 3; i++) {
      const uint32_t node = all->number[set->nodes[k]];
      if (!all->definition->supports[s].held[i]) continue;
      const vsc_status status = check_holder(all, s, node, i, model, error);
      if (status != VSC_OK) return status;
      all->holder[3 * (size_t)node + (size_t)i] = (uint32_t)(1 + s);
      model->inverse_mass[4 * (size_t)node + (size_t)i] = 0;
    }
  return VSC_OK;
}

static vsc_status add_moved(const supporting *all, size_t s, const vsc_node_set *set,
                            vsc_model *model, vsc_error *error)
{
  const vsc_support_def *def = &all->definition->supports[s];
  if (model->moved_count == VSC_MOST_MOVED)
    return vsc_fail(error, VSC_INPUT, "supports[%zu].motion: %d supports with a motion are the most",
                    s, VSC_MOST_MOVED);
  vsc_moved *moved = &model->moved[model->moved_count++];
  vsc_copy_name(moved->set, def->set);
  memcpy(moved->held, def->held, sizeof moved->held);
  memcpy(moved->motion, def->motion, sizeof moved->motion);
  moved->node_count = set->count;
  if (!VSC_NEW(moved->nodes, set->count)) return vsc_fail_memory(error, "a support");
  for (size_t k = 0; k < set->count; k++) {
    moved->nodes[k] = all->number[set->nodes[k]];
    moved->mass += model->mass[moved->nodes[k]];
  }
  return vsc_curve_of("supports", s, "", vsc_curve_build(&def->curve, all->definition->end_time, &moved->curve, error),
                      error);
}

static void count_held(vsc_model *model)
{
  for (size_t n = 0; n < model->node_count; n++) {
    const double *inverse = model->inverse_mass + 4 * n;
    if (inverse[0] == 0 || inverse[1] == 0 || inverse[2] == 0) model->held_count++;
  }
}

static vsc_status add_support(const supporting *all, size_t s, vsc_model *model, vsc_error *error)
{
  const vsc_support_def *support = &all->definition->supports[s];
  const vsc_node_set *set = find_set(model, support->set);
  if (set == NULL)
    return vsc_fail(error, VSC_INPUT,
                    "supports[%zu].set: no node set is called '%s'; define it under node_sets", s,
                    support->set);
  const vsc_status status = hold(all, s, set, model, error);
  if (status != VSC_OK || !is_moved(support)) return status;
  return add_moved(all, s, set, model, error);
}

vsc_status vsc_terms_supports(const vsc_definition *definition, vsc_model *model, vsc_error *error)
{
  if (definition->support_count == 0) return VSC_OK;
  uint32_t *number = vsc_model_node_numbers(model);
  supporting all = {.definition = definition, .number = number};
  vsc_status status = VSC_OK;
  if (number == NULL || !VSC_NEW(all.holder, 3 * model->node_count) ||
      !VSC_NEW(model->moved, VSC_MOST_MOVED))
    status = vsc_fail_memory(error, "supports");
  for (size_t s = 0; s < definition->support_count && status == VSC_OK; s++)
    status = add_support(&all, s, model, error);
  count_held(model);
  vsc_free(number);
  vsc_free(all.holder);
  return status;
}
