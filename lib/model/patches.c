// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/patches.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/order.h"

// Parts of a patch: few enough that its nodes stay in the innermost caches, enough that few are
// shared, and on small meshes enough patches for several threads. Depends on nothing but the scene.
enum { LARGEST_PATCH = 2048, SMALLEST_PATCH = 128, WANTED_PATCHES = 16 };

// What is known while the patches are cut.
typedef struct cutter {
  const vsc_mesh *mesh;
  const vsc_parts *parts;
  uint32_t *order;       // parts in their new order
  size_t *place;         // parts + 1: the nodes of the k-th part in that order are nodes[place[k] ...]
  uint32_t *nodes;       // of the mesh
  uint32_t *source;      // parts: vsc_parts.source in that order
  uint32_t *first_part;  // patch_count + 1: patch p has order[first_part[p] ...]
  uint32_t *distinct;    // nodes of the mesh: those of each patch, in the order of first use
  size_t room;           // for so many
  size_t *first_distinct;  // patch_count + 1: patch p has distinct[first_distinct[p] ...]
  uint32_t *seen;        // mesh node -> the patch that touched it last
  uint32_t *patches_of;  // mesh node -> number of patches that touch it
  uint32_t *number;      // mesh node -> node
  uint32_t *local;       // mesh node -> number in the current patch
} cutter;

static size_t patch_size(size_t parts)
{
  size_t size = parts / WANTED_PATCHES / VSC_WIDTH * VSC_WIDTH;
  if (size > LARGEST_PATCH) size = LARGEST_PATCH;
  return size < SMALLEST_PATCH ? SMALLEST_PATCH : size;
}

// Nodes of a mesh in random order lie anywhere: they are asked for so many parts or nodes ahead.
enum { PARTS_AHEAD = 16, NODES_AHEAD = 64 };

static void list_centres(const cutter *cut, double *centres)
{
  const vsc_parts *parts = cut->parts;
  const double *nodes = cut->mesh->nodes;
  const size_t end = parts->start[parts->count];
  for (size_t k = 0; k < parts->count; k++) {
    const size_t first = parts->start[k], count = parts->start[k + 1] - first;
    double centre[3] = {0};
    for (size_t c = first; c < first + count; c++) {
      if (c + NODES_AHEAD < end) __builtin_prefetch(nodes + 3 * (size_t)parts->nodes[c + NODES_AHEAD]);
      for (int i = 0; i < 3; i++) centre[i] += nodes[3 * (size_t)parts->nodes[c] + (size_t)i];
    }
    for (size_t i = 0; i < 3; i++) centres[3 * k + i] = centre[i] / (double)count;
  }
}

// The parts' nodes and sources in their new order.
static void sort_parts(cutter *cut)
{
  const vsc_parts *parts = cut->parts;
  for (size_t k = 0; k < parts->count; k++) {
    if (k + 2 * PARTS_AHEAD < parts->count) {
      __builtin_prefetch(parts->start + cut->order[k + 2 * PARTS_AHEAD]);
      __builtin_prefetch(parts->source + cut->order[k + 2 * PARTS_AHEAD]);
      __builtin_prefetch(parts->nodes + parts->start[cut->order[k + PARTS_AHEAD]]);
    }
    const size_t part = cut->order[k], first = parts->start[part];
    const size_t count = parts->start[part + 1] - first;
    uint32_t *to = cut->nodes + cut->place[k];
    if (count == 4)
      memcpy(to, parts->nodes + first, 4 * sizeof *to);  // of known size: no call
    else
      memcpy(to, parts->nodes + first, count * sizeof *to);
    cut->source[k] = parts->source[part];
    cut->place[k + 1] = cut->place[k] + count;
  }
}

static vsc_status order_parts(cutter *cut, vsc_error *error)
{
  const vsc_parts *parts = cut->parts;
  double *centres;
  if (!VSC_NEW(centres, 3 * parts->count)) return vsc_fail_memory(error, "element centres");
  list_centres(cut, centres);
  const vsc_status status =
      vsc_order_hilbert(parts->count, centres, parts->group, cut->order, error);
  vsc_free(centres);
  if (status == VSC_OK) sort_parts(cut);
  return status;
}

static uint32_t group_at(const cutter *cut, size_t k)
{
  return cut->parts->group[cut->order[k]];
}

// The first of the ordered parts behind `start` that is of another group.
static size_t end_of_group(const cutter *cut, size_t start)
{
  const uint32_t group = group_at(cut, start);
  size_t low = start + 1, high = cut->parts->count;
  while (low < high) {
    const size_t middle = low + (high - low) / 2;
    if (group_at(cut, middle) == group)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

// Cuts the ordered parts at changes of group and after patch_size parts. With first_part NULL only
// counts the patches.
static size_t cut_patches(const cutter *cut, uint32_t *first_part)
{
  const size_t parts = cut->parts->count, size = patch_size(parts);
  size_t patches = 0, group_end = 0;
  for (size_t start = 0, end; start < parts; start = end) {
    if (start == group_end) group_end = end_of_group(cut, start);
    end = group_end - start > size ? start + size : group_end;
    if (first_part) first_part[patches] = (uint32_t)start;
    patches++;
  }
  if (first_part) first_part[patches] = (uint32_t)parts;
  return patches;
}

// The places of the nodes of patch p: first_place ... end_place - 1.
static size_t first_place(const cutter *cut, size_t p)
{
  return cut->place[cut->first_part[p]];
}

// Room for `more` distinct nodes behind `count`.
static bool make_room(cutter *cut, size_t count, size_t more)
{
  void *distinct = cut->distinct;
  if (count + more <= cut->room) return true;
  const size_t longer = 2 * cut->room + more;
  if (!vsc_grow(&distinct, count, longer, sizeof *cut->distinct)) return false;
  cut->distinct = distinct;
  cut->room = longer;
  return true;
}

// Lists the nodes of each patch, and counts the patches of each node.
static vsc_status list_distinct(cutter *cut, size_t patches, vsc_error *error)
{
  size_t count = 0;
  memset(cut->seen, 0xff, cut->mesh->node_count * sizeof *cut->seen);
  if (!VSC_NEW(cut->first_distinct, patches + 1)) return vsc_fail_memory(error, "the nodes of patches");
  for (size_t p = 0; p < patches; p++) {
    const size_t first = first_place(cut, p), end = first_place(cut, p + 1);
    if (!make_room(cut, count, end - first)) return vsc_fail_memory(error, "the nodes of patches");
    for (size_t i = first; i < end; i++) {
      const uint32_t node = cut->nodes[i];
      if (cut->seen[node] == p) continue;
      cut->seen[node] = (uint32_t)p;
      cut->patches_of[node]++;
      cut->distinct[count++] = node;
    }
    cut->first_distinct[p + 1] = count;
  }
  return VSC_OK;
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
      for (size_t i = cut->first_distinct[p]; i < cut->first_distinct[p + 1]; i++) {
        const uint32_t node = cut->distinct[i];
        if (cut->number[node] != UINT32_MAX || (cut->patches_of[node] > 1) != shared) continue;
        model->mesh_node[next] = node;
        cut->number[node] = next++;
      }
      if (shared) continue;
      vsc_patch *patch = &model->patches[p];
      patch->own_count = next - patch->first_node;
      if (!patch->still) continue;
      if (model->still_count == 0) model->still_first = patch->first_node;
      model->still_count += patch->own_count;
    }
    if (!shared) model->own_node_count = next;
  }
}

// Lists the shared nodes of each patch; with shared NULL only counts them.
static void list_shared(const cutter *cut, vsc_model *model)
{
  size_t place = 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    vsc_patch *patch = &model->patches[p];
    patch->first_shared = (uint32_t)place;
    for (size_t i = cut->first_distinct[p]; i < cut->first_distinct[p + 1]; i++) {
      const uint32_t node = cut->distinct[i];
      if (cut->patches_of[node] == 1) continue;
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

static size_t take(vsc_model *model, size_t bytes)
{
  const size_t place = model->store_size;
  model->store_size += (bytes + VSC_ALIGNMENT - 1) / VSC_ALIGNMENT * VSC_ALIGNMENT;
  return place;
}

static void start_patches(const cutter *cut, vsc_model *model)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const uint32_t count = cut->first_part[p + 1] - cut->first_part[p];
    const uint32_t group = group_at(cut, cut->first_part[p]);
    vsc_patch *patch = &model->patches[p];
    patch->family = vsc_parts_family(cut->parts, group);
    patch->material = vsc_parts_material(cut->parts, group);
    patch->mixed = vsc_parts_mixed(cut->parts, group);
    patch->still = vsc_parts_still(cut->parts, group);
    patch->first_pack = (uint32_t)model->pack_count;
    patch->first_frame = (uint32_t)model->frame_count;
    patch->pack_count = (count + VSC_WIDTH - 1) / VSC_WIDTH;
    patch->packs = take(model, patch->pack_count * vsc_pack_size(model, patch->family));
    const bool paper =
        vsc_patch_is_solid(patch) && model->materials[patch->material].law == VSC_LAW_PAPER;
    const size_t bytes = patch->family == VSC_TETS ? sizeof(vsc_chords) : sizeof(vsc_hex_axes);
    if (paper) patch->law_data = take(model, patch->pack_count * bytes);
    if (patch->mixed) patch->mixtures = take(model, patch->pack_count * sizeof(vsc_mixture));
    if (model->terms.smoothed && patch->family == VSC_TETS)
      patch->smoothed = take(model, patch->pack_count * sizeof(vsc_smoothed_pack));
    model->pack_count += patch->pack_count;
    model->frame_count += (size_t)vsc_family_frames(model, patch->family) * patch->pack_count;
    if (patch->pack_count > model->most_packs) model->most_packs = patch->pack_count;
  }
}

static vsc_status fill_patches(cutter *cut, const vsc_axes *axes, vsc_model *model,
                               vsc_error *error)
{
  memset(model->mesh_element, 0xff, VSC_WIDTH * model->pack_count * sizeof *model->mesh_element);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (uint32_t n = 0; n < patch->own_count; n++)
      cut->local[model->mesh_node[patch->first_node + n]] = n;
    for (uint32_t n = 0; n < patch->shared_count; n++)
      cut->local[model->mesh_node[model->shared[patch->first_shared + n]]] = patch->own_count + n;
    const size_t first = cut->first_part[p];
    const vsc_patch_parts parts = {.count = cut->first_part[p + 1] - first,
                                   .source = cut->source + first,
                                   .nodes = cut->nodes + cut->place[first],
                                   .sheets = cut->parts->sheets};
    const vsc_status status = vsc_patch_fill(cut->mesh, axes, &parts, cut->local, patch, model, error);
    if (status != VSC_OK) return status;
  }
  return VSC_OK;
}

// The mean distance between the first two nodes of the parts.
static double element_size(const cutter *cut)
{
  double sum = 0;
  for (size_t k = 0; k < cut->parts->count; k++) {
    double way[3];
    const uint32_t *node = cut->nodes + cut->place[k];
    vsc_subtract(cut->mesh->nodes + 3 * (size_t)node[1], cut->mesh->nodes + 3 * (size_t)node[0], way);
    sum += vsc_norm(way);
  }
  return sum / (double)cut->parts->count;
}

static vsc_status cut_and_fill(cutter *cut, const vsc_axes *axes, vsc_model *model,
                               vsc_error *error)
{
  const size_t nodes = cut->mesh->node_count;
  vsc_status status = order_parts(cut, error);
  if (status != VSC_OK) return status;
  model->patch_count = cut_patches(cut, NULL);
  if (!VSC_NEW(cut->first_part, model->patch_count + 1) ||
      !VSC_NEW(model->patches, model->patch_count) || !VSC_NEW(model->mesh_node, nodes))
    return vsc_fail_memory(error, "patches");
  cut_patches(cut, cut->first_part);
  start_patches(cut, model);
  status = list_distinct(cut, model->patch_count, error);
  if (status != VSC_OK) return status;
  for (size_t n = 0; n < nodes; n++)
    if (cut->patches_of[n] == 0)
      return vsc_fail(error, VSC_INPUT,
                      "membranes: point %u belongs to no membrane and to no element, so nothing "
                      "holds it; give its triangles a membrane or take it out of the mesh",
                      cut->mesh->node_source[n]);
  number_nodes(cut, model);
  list_shared(cut, model);
  const size_t slots = VSC_WIDTH * model->pack_count;
  if (!VSC_NEW(model->shared, model->partial_count) || !VSC_NEW(model->store, model->store_size) ||
      !VSC_NEW(model->mesh_element, slots) || !VSC_NEW(model->known, slots))
    return vsc_fail_memory(error, "elements");
  list_shared(cut, model);
  model->element_size = element_size(cut);
  status = list_sums(model, error);
  if (status == VSC_OK) status = fill_patches(cut, axes, model, error);
  return status;
}

vsc_status vsc_patches_build(const vsc_mesh *mesh, const vsc_axes *axes, const vsc_parts *parts,
                             vsc_model *model, vsc_error *error)
{
  cutter cut = {.mesh = mesh, .parts = parts};
  model->node_count = mesh->node_count;
  model->element_count = mesh->element_count;
  for (int kind = 0; kind < VSC_CELLS; kind++)
    model->rules[kind] = vsc_cell_rule_of((vsc_cell)kind);
  vsc_status status = VSC_OK;
  if (VSC_NEW(cut.order, parts->count) && VSC_NEW(cut.place, parts->count + 1) &&
      VSC_NEW(cut.nodes, parts->start[parts->count]) && VSC_NEW(cut.source, parts->count) &&
      VSC_NEW(cut.seen, mesh->node_count) && VSC_NEW(cut.patches_of, mesh->node_count) &&
      VSC_NEW(cut.number, mesh->node_count) && VSC_NEW(cut.local, mesh->node_count))
    status = cut_and_fill(&cut, axes, model, error);
  else
    status = vsc_fail_memory(error, "the order of the elements");
  vsc_free(cut.order);
  vsc_free(cut.place);
  vsc_free(cut.nodes);
  vsc_free(cut.source);
  vsc_free(cut.first_part);
  vsc_free(cut.distinct);
  vsc_free(cut.first_distinct);
  vsc_free(cut.seen);
  vsc_free(cut.patches_of);
  vsc_free(cut.number);
  vsc_free(cut.local);
  return status;
}
