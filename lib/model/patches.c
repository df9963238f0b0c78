// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/patches.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "mesh/order.h"

// Elements of a patch: few enough that its nodes stay in the innermost caches, enough that few are
// shared, and on small meshes enough patches for several threads. Depends on nothing but the mesh.
enum { LARGEST_PATCH = 2048, SMALLEST_PATCH = 128, WANTED_PATCHES = 16 };

// What is known while the patches are cut.
typedef struct cutter {
  const vsc_mesh *mesh;
  const uint32_t *material_of;
  uint32_t *order;       // tets in their new order
  uint32_t *first_tet;   // patch_count + 1: patch p has order[first_tet[p] ...]
  uint32_t *seen;        // mesh node -> the patch that touched it last
  uint32_t *patches_of;  // mesh node -> number of patches that touch it
  uint32_t *number;      // mesh node -> node
  uint32_t *local;       // mesh node -> number in the current patch
} cutter;

static size_t patch_size(size_t tets)
{
  size_t size = tets / WANTED_PATCHES / VSC_WIDTH * VSC_WIDTH;
  if (size > LARGEST_PATCH) size = LARGEST_PATCH;
  return size < SMALLEST_PATCH ? SMALLEST_PATCH : size;
}

static vsc_status order_tets(cutter *cut, vsc_error *error)
{
  const size_t tets = cut->mesh->element_count;
  double *centres;
  if (!VSC_NEW(centres, 3 * tets)) return vsc_fail_memory(error, "element centres");
  for (size_t t = 0; t < tets; t++) vsc_mesh_element_centre(cut->mesh, t, centres + 3 * t);
  const vsc_status status = vsc_order_hilbert(tets, centres, cut->material_of, cut->order, error);
  vsc_free(centres);
  return status;
}

// Cuts the ordered tets at changes of material and after patch_size elements. With first_tet NULL
// only counts the patches.
static size_t cut_patches(const cutter *cut, uint32_t *first_tet)
{
  const size_t tets = cut->mesh->element_count, size = patch_size(tets);
  size_t patches = 0, start = 0;
  for (size_t k = 1; k <= tets; k++) {
    const bool ends = k == tets || k - start == size ||
                      cut->material_of[cut->order[k]] != cut->material_of[cut->order[start]];
    if (!ends) continue;
    if (first_tet) first_tet[patches] = (uint32_t)start;
    patches++;
    start = k;
  }
  if (first_tet) first_tet[patches] = (uint32_t)tets;
  return patches;
}

// The node at place i of the list of all tets' corners in the new order; patch p has the places
// 4 first_tet[p] ... 4 first_tet[p + 1] - 1.
static uint32_t corner(const cutter *cut, size_t i)
{
  return cut->mesh->corners[4 * (size_t)cut->order[i / 4] + i % 4];
}

static void count_patches_of_nodes(cutter *cut, size_t patches)
{
  memset(cut->seen, 0xff, cut->mesh->node_count * sizeof *cut->seen);
  for (size_t p = 0; p < patches; p++)
    for (size_t i = 4 * (size_t)cut->first_tet[p]; i < 4 * (size_t)cut->first_tet[p + 1]; i++) {
      const uint32_t node = corner(cut, i);
      if (cut->seen[node] != p) cut->patches_of[node]++;
      cut->seen[node] = (uint32_t)p;
    }
}

// Numbers the nodes that belong to one patch, patch by patch, then the shared ones, each kind in
// the order of first use.
static void number_nodes(cutter *cut, vsc_model *model)
{
  uint32_t next = 0;
  memset(cut->number, 0xff, cut->mesh->node_count * sizeof *cut->number);
  for (int shared = 0; shared < 2; shared++) {
    for (size_t p = 0; p < model->patch_count; p++) {
      if (!shared) model->patches[p].first_node = next;
      for (size_t i = 4 * (size_t)cut->first_tet[p]; i < 4 * (size_t)cut->first_tet[p + 1]; i++) {
        const uint32_t node = corner(cut, i);
        if (cut->number[node] != UINT32_MAX || (cut->patches_of[node] > 1) != shared) continue;
        model->mesh_node[next] = node;
        cut->number[node] = next++;
      }
      if (!shared) model->patches[p].own_count = next - model->patches[p].first_node;
    }
    if (!shared) model->own_node_count = next;
  }
}

// Lists the shared nodes of each patch; with shared NULL only counts them.
static void list_shared(cutter *cut, vsc_model *model)
{
  size_t place = 0;
  memset(cut->seen, 0xff, cut->mesh->node_count * sizeof *cut->seen);
  for (size_t p = 0; p < model->patch_count; p++) {
    vsc_patch *patch = &model->patches[p];
    patch->first_shared = (uint32_t)place;
    for (size_t i = 4 * (size_t)cut->first_tet[p]; i < 4 * (size_t)cut->first_tet[p + 1]; i++) {
      const uint32_t node = corner(cut, i);
      if (cut->patches_of[node] == 1 || cut->seen[node] == p) continue;
      cut->seen[node] = (uint32_t)p;
      if (model->shared) model->shared[place] = cut->number[node];
      place++;
    }
    patch->shared_count = (uint32_t)place - patch->first_shared;
    const size_t nodes = patch->own_count + patch->shared_count;
    if (nodes > model->most_nodes) model->most_nodes = nodes;
  }
  model->partial_count = place;
}

// For each shared node the places of its parts, in the order of the patches.
static vsc_status list_sums(vsc_model *model, vsc_error *error)
{
  const size_t shared_nodes = model->node_count - model->own_node_count;
  uint32_t *next;
  if (!VSC_NEW(model->sum_start, shared_nodes + 1) ||
      !VSC_NEW(model->sum_place, model->partial_count) || !VSC_NEW(next, shared_nodes))
    return vsc_fail_memory(error, "shared nodes");
  for (size_t k = 0; k < model->partial_count; k++)
    model->sum_start[model->shared[k] - model->own_node_count + 1]++;
  for (size_t s = 0; s < shared_nodes; s++) model->sum_start[s + 1] += model->sum_start[s];
  for (size_t k = 0; k < model->partial_count; k++) {
    const size_t s = model->shared[k] - model->own_node_count;
    model->sum_place[model->sum_start[s] + next[s]++] = (uint32_t)k;
  }
  vsc_free(next);
  return VSC_OK;
}

static void fill_slot(const cutter *cut, const vsc_axes *axes, uint32_t tet, size_t slot,
                      vsc_model *model)
{
  static const double global_axes[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  vsc_pack *pack = &model->packs[slot / VSC_WIDTH];
  const int lane = (int)(slot % VSC_WIDTH);
  double x[4][3], B[3][4];
  for (int c = 0; c < 4; c++) {
    const uint32_t node = cut->mesh->corners[4 * tet + c];
    memcpy(x[c], cut->mesh->nodes + 3 * node, sizeof x[c]);
    pack->node[c][lane] = (uint16_t)cut->local[node];
  }
  const double volume = vsc_stencil_tet(x, axes ? axes->frames + 9 * tet : global_axes, B);
  for (int a = 0; a < 3; a++)
    for (int c = 1; c < 4; c++) pack->B[a][c - 1][lane] = B[a][c];
  pack->V[lane] = volume;
  model->mesh_element[slot] = tet;
  model->known[slot] = axes ? axes->known[tet] : 0;
  model->total_volume += volume;
}

static void fill_patches(cutter *cut, const vsc_axes *axes, vsc_model *model)
{
  memset(model->mesh_element, 0xff, VSC_WIDTH * model->pack_count * sizeof *model->mesh_element);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (uint32_t n = 0; n < patch->own_count; n++)
      cut->local[model->mesh_node[patch->first_node + n]] = n;
    for (uint32_t n = 0; n < patch->shared_count; n++)
      cut->local[model->mesh_node[model->shared[patch->first_shared + n]]] = patch->own_count + n;
    for (size_t k = cut->first_tet[p]; k < cut->first_tet[p + 1]; k++) {
      const size_t slot = VSC_WIDTH * (size_t)patch->first_pack + (k - cut->first_tet[p]);
      fill_slot(cut, axes, cut->order[k], slot, model);
    }
  }
}

static void start_patches(const cutter *cut, vsc_model *model)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const uint32_t tets = cut->first_tet[p + 1] - cut->first_tet[p];
    vsc_patch *patch = &model->patches[p];
    patch->material = cut->material_of[cut->order[cut->first_tet[p]]];
    patch->first_pack = (uint32_t)model->pack_count;
    patch->pack_count = (tets + VSC_WIDTH - 1) / VSC_WIDTH;
    model->pack_count += patch->pack_count;
    if (patch->pack_count > model->most_packs) model->most_packs = patch->pack_count;
  }
}

static vsc_status cut_and_fill(cutter *cut, const vsc_axes *axes, vsc_model *model,
                               vsc_error *error)
{
  const size_t nodes = cut->mesh->node_count;
  vsc_status status = order_tets(cut, error);
  if (status != VSC_OK) return status;
  model->patch_count = cut_patches(cut, NULL);
  if (!VSC_NEW(cut->first_tet, model->patch_count + 1) ||
      !VSC_NEW(model->patches, model->patch_count) || !VSC_NEW(model->mesh_node, nodes))
    return vsc_fail_memory(error, "patches");
  cut_patches(cut, cut->first_tet);
  start_patches(cut, model);
  count_patches_of_nodes(cut, model->patch_count);
  number_nodes(cut, model);
  list_shared(cut, model);
  const size_t slots = VSC_WIDTH * model->pack_count;
  if (!VSC_NEW(model->shared, model->partial_count) || !VSC_NEW(model->packs, model->pack_count) ||
      !VSC_NEW(model->mesh_element, slots) || !VSC_NEW(model->known, slots))
    return vsc_fail_memory(error, "elements");
  list_shared(cut, model);
  status = list_sums(model, error);
  if (status == VSC_OK) fill_patches(cut, axes, model);
  return status;
}

vsc_status vsc_patches_build(const vsc_mesh *mesh, const vsc_axes *axes,
                             const uint32_t *material_of, vsc_model *model, vsc_error *error)
{
  cutter cut = {.mesh = mesh, .material_of = material_of};
  model->node_count = mesh->node_count;
  model->element_count = mesh->element_count;
  vsc_status status = vsc_fail_memory(NULL, "");
  if (VSC_NEW(cut.order, mesh->element_count) && VSC_NEW(cut.seen, mesh->node_count) &&
      VSC_NEW(cut.patches_of, mesh->node_count) && VSC_NEW(cut.number, mesh->node_count) &&
      VSC_NEW(cut.local, mesh->node_count))
    status = cut_and_fill(&cut, axes, model, error);
  else
    vsc_fail_memory(error, "the order of the elements");
  vsc_free(cut.order);
  vsc_free(cut.first_tet);
  vsc_free(cut.seen);
  vsc_free(cut.patches_of);
  vsc_free(cut.number);
  vsc_free(cut.local);
  return status;
}
