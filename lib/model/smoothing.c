// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/smoothing.h"

#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/sort.h"
#include "base/vec3.h"
#include "mesh/axes.h"
#include "model/terms.h"

// An edge of a tet. They are listed by material, then by their nodes, then by the tet.
typedef struct incidence {
  uint32_t low, high, slot;
  uint32_t where;  // 8 times the tet's patch, and which of its edges it is
} incidence;

enum { EDGES_PER_PIECE = 1024 };

void vsc_smoothing_free(vsc_smoothing *smoothing)
{
  vsc_free(smoothing->frames);
  vsc_free(smoothing->start);
  vsc_free(smoothing->slot);
  vsc_free(smoothing->weight);
  vsc_free(smoothing->blocks);
  vsc_free(smoothing->amplitude);
  vsc_free(smoothing->delay);
  *smoothing = (vsc_smoothing){0};
}

static const vsc_patch *patch_of(const vsc_model *model, const incidence *tet)
{
  return &model->patches[tet->where / 8];
}

static bool same_edge(const vsc_model *model, const incidence *a, const incidence *b)
{
  return a->low == b->low && a->high == b->high && patch_of(model, a)->material == patch_of(model, b)->material;
}

// The tet behind an incidence: its pack, and its rest volume.
static vsc_smoothed_pack *pack_of(const vsc_model *model, const incidence *tet)
{
  return (vsc_smoothed_pack *)(uintptr_t)vsc_pack_smoothed(model, patch_of(model, tet), tet->slot / VSC_WIDTH);
}

static double volume_of(const vsc_model *model, const incidence *tet)
{
  return vsc_pack_frames(model, patch_of(model, tet), tet->slot / VSC_WIDTH)->V[tet->slot % VSC_WIDTH];
}

// The edges of a material's smoothed tets, by slot; with `list` NULL only their number.
static size_t list_incidences(const vsc_model *model, uint32_t material, incidence *list)
{
  size_t count = 0;
  for (uint32_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!patch->smoothed || patch->material != material) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (uint32_t l = 0; l < VSC_WIDTH; l++) {
        const uint32_t slot = VSC_WIDTH * (uint32_t)k + l;
        if (model->mesh_element[slot] == VSC_NO_ELEMENT) continue;
        for (uint32_t e = 0; e < VSC_TET_EDGES; e++, count++) {
          if (list == NULL) continue;
          const uint16_t(*node)[VSC_WIDTH] = vsc_pack_nodes(model, patch, k);
          const int *ends = vsc_cells[VSC_TET].edges[e];
          const uint32_t a = vsc_node_of(model, patch, node[ends[0]][l]);
          const uint32_t b = vsc_node_of(model, patch, node[ends[1]][l]);
          list[count] = (incidence){a < b ? a : b, a < b ? b : a, slot, 8 * p + e};
        }
      }
  }
  return count;
}

// Where each edge's incidences begin: four to a pack, those of one material in packs of their own, the
// last of which repeat their last edge. Returns the places.
static size_t list_edges(vsc_model *model, const incidence *list, size_t count, uint32_t *first)
{
  size_t places = 0;
  for (size_t i = 0; i < count; i++) {
    if (i > 0 && same_edge(model, &list[i - 1], &list[i])) continue;
    if (i > 0 && patch_of(model, &list[i - 1])->material != patch_of(model, &list[i])->material)
      for (; places % VSC_WIDTH != 0; places++) first[places] = first[places - 1];
    first[places++] = (uint32_t)i;
    model->smoothing.edge_count++;
  }
  for (; places % VSC_WIDTH != 0; places++) first[places] = first[places - 1];
  return places;
}

static void cut_blocks(vsc_model *model, const incidence *list, const uint32_t *first)
{
  vsc_smoothing *smoothing = &model->smoothing;
  vsc_edge_block *block = NULL;
  for (uint32_t k = 0; k < smoothing->pack_count; k++) {
    const uint32_t material = patch_of(model, &list[first[VSC_WIDTH * k]])->material;
    if (block == NULL || block->material != material || block->pack_count == VSC_MOST_EDGE_PACKS) {
      block = &smoothing->blocks[smoothing->block_count++];
      *block = (vsc_edge_block){.material = material, .first_pack = k};
    }
    block->pack_count++;
  }
}

// The axis of the largest part of `sum` (vsc_add_square), turned towards `side`.
static bool mean_axis(const double sum[6], const double side[3], double axis[3])
{
  if (!vsc_top_axis(sum, axis, NULL)) return false;
  const double sign = vsc_dot(axis, side) < 0 ? -1 : 1;
  for (int i = 0; i < 3; i++) axis[i] *= sign;
  return true;
}

// f: the axis of sum V f f^T over the tets; s: likewise within the plane across f; n = f x s. Axes have
// no sign; where the tets' agree, the edge's agree with them. Without known fibres all tets count.
static void average_axes(const vsc_model *model, const incidence *tets, size_t count,
                         double frame[9])
{
  bool known = false, found = false;
  double axis[2][3];
  for (size_t t = 0; t < count; t++) known |= model->known[tets[t].slot];
  for (int which = 0; which < 2; which++) {
    double squares[6] = {0}, side[3] = {0};
    for (size_t t = 0; t < count; t++) {
      if (known && !model->known[tets[t].slot]) continue;
      const vsc_smoothed_pack *pack = pack_of(model, &tets[t]);
      const double V = volume_of(model, &tets[t]);
      double a[3];
      for (int i = 0; i < 3; i++) a[i] = pack->axes[which][i][tets[t].slot % VSC_WIDTH];
      const double along = which == 1 ? vsc_dot(a, axis[0]) : 0;
      for (int i = 0; i < 3 && which == 1; i++) a[i] -= along * axis[0][i];
      vsc_add_square(a, V, squares);
      for (int i = 0; i < 3; i++) side[i] += V * a[i];
    }
    found = mean_axis(squares, side, axis[which]);
  }
  vsc_axes_complete(axis[0], found ? axis[1] : NULL, frame);
}

// One edge: its frame (V = 0 for a copy), and the tets that it averages.
static void fill_edge(vsc_model *model, const incidence *tets, size_t count, size_t edge, bool copy)
{
  vsc_smoothing *smoothing = &model->smoothing;
  vsc_edge_frame *pack = &smoothing->frames[edge / VSC_WIDTH];
  const size_t l = edge % VSC_WIDTH, at = smoothing->start[edge];
  double frame[9], V = 0, amplitude = 0, delay = 0;
  average_axes(model, tets, count, frame);
  for (int i = 0; i < 9; i++) pack->axes[i / 3][i % 3][l] = frame[i];
  for (size_t t = 0; t < count; t++) V += volume_of(model, &tets[t]) / VSC_TET_EDGES;
  for (size_t t = 0; t < count; t++) {
    const double weight = volume_of(model, &tets[t]) / VSC_TET_EDGES / V;
    smoothing->slot[at + t] = tets[t].slot;
    smoothing->weight[at + t] = weight;
    if (model->amplitude) amplitude += weight * model->amplitude[tets[t].slot];
    if (model->delay) delay += weight * model->delay[tets[t].slot];
    if (!copy) pack_of(model, &tets[t])->edge[tets[t].where % 8][tets[t].slot % VSC_WIDTH] = (uint32_t)edge;
  }
  pack->V[l] = copy ? 0 : V;
  if (model->amplitude) smoothing->amplitude[edge] = amplitude;
  if (model->delay) smoothing->delay[edge] = delay;
}

// What edges are filled from: the incidences, and where those of each begin.
typedef struct filling {
  vsc_model *model;
  const incidence *list;
  const uint32_t *first;
  size_t places;
} filling;

static void fill_piece(void *context, size_t piece, int thread)
{
  (void)thread;
  const filling *fill = context;
  const uint32_t *first = fill->first, *start = fill->model->smoothing.start;
  const size_t begin = EDGES_PER_PIECE * piece, last = begin + EDGES_PER_PIECE;
  for (size_t e = begin; e < last && e < fill->places; e++)
    fill_edge(fill->model, fill->list + first[e], start[e + 1] - start[e], e, e > 0 && first[e] == first[e - 1]);
}

static bool fill_smoothing(vsc_model *model, const incidence *list, size_t count,
                           const uint32_t *first, size_t places)
{
  vsc_smoothing *smoothing = &model->smoothing;
  smoothing->pack_count = places / VSC_WIDTH;
  if (!VSC_NEW(smoothing->start, places + 1)) return false;
  // the copies that fill up a material's last pack list their tets again
  for (size_t e = 0; e < places; e++) {
    size_t end = first[e];
    while (end < count && same_edge(model, &list[first[e]], &list[end])) end++;
    smoothing->start[e + 1] = smoothing->start[e] + (uint32_t)(end - first[e]);
  }
  const size_t entries = smoothing->start[places];
  if (!VSC_NEW(smoothing->frames, smoothing->pack_count) ||
      !VSC_NEW(smoothing->blocks, smoothing->pack_count) || !VSC_NEW(smoothing->slot, entries) ||
      !VSC_NEW(smoothing->weight, entries) ||
      (model->amplitude && !VSC_NEW(smoothing->amplitude, places)) ||
      (model->delay && !VSC_NEW(smoothing->delay, places)))
    return false;
  cut_blocks(model, list, first);
  filling fill = {model, list, first, places};
  vsc_parallel_for((places + EDGES_PER_PIECE - 1) / EDGES_PER_PIECE, fill_piece, &fill);
  return true;
}

// The incidences of all materials, sorted; false when memory is short.
static bool sort_incidences(const vsc_model *model, incidence *list)
{
  const size_t words = sizeof *list / sizeof(uint32_t);
  bool good = true;
  for (uint32_t m = 0; m < model->material_count && good; m++) {
    const size_t count = list_incidences(model, m, list);
    good = vsc_sort(list, count, words, 2);
    list += count;
  }
  return good;
}

vsc_status vsc_terms_smoothing(vsc_model *model, vsc_error *error)
{
  size_t count = 0;
  incidence *list;
  uint32_t *first = NULL;
  if (!model->terms.smoothed) return VSC_OK;
  for (uint32_t m = 0; m < model->material_count; m++) count += list_incidences(model, m, NULL);
  if (count == 0)
    return vsc_fail(error, VSC_INPUT,
                    "tets: smoothed smooths linear tetrahedra, and the mesh has none: leave it out, or use a mesh of "
                    "them without mesh.order: 2");
  const bool good = VSC_NEW(list, count) && VSC_NEW(first, count + VSC_WIDTH * model->material_count) &&
                    sort_incidences(model, list) &&
                    fill_smoothing(model, list, count, first, list_edges(model, list, count, first));
  vsc_free(list);
  vsc_free(first);
  return good ? VSC_OK : vsc_fail_memory(error, "the edges of smoothed tets");
}
