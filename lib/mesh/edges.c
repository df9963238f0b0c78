// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/edges.h"

#include "base/mem.h"
#include "base/sort.h"

static int compare_ends(const vsc_edge *x, const vsc_edge *y)
{
  if (x->low != y->low) return x->low < y->low ? -1 : 1;
  if (x->high != y->high) return x->high < y->high ? -1 : 1;
  return 0;
}

static vsc_edge edge_between(uint32_t a, uint32_t b, uint32_t middle)
{
  return (vsc_edge){.low = a < b ? a : b, .high = a < b ? b : a, .middle = middle};
}

vsc_status vsc_edges_list(const vsc_mesh *mesh, vsc_edges *edges, vsc_error *error)
{
  size_t count = 0, kept = 0;
  *edges = (vsc_edges){0};
  for (size_t e = 0; e < mesh->element_count; e++)
    count += (size_t)vsc_mesh_kind(mesh, e)->edge_count;
  if (!VSC_NEW(edges->items, count)) return vsc_fail_memory(error, "the mesh's edges");
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    for (int k = 0; k < kind->edge_count; k++) {
      const int *ends = kind->edges[k], middle = vsc_cell_middle(kind, ends[0], ends[1]);
      edges->items[edges->count++] = edge_between(corner[ends[0]], corner[ends[1]],
                                                  middle < 0 ? VSC_NO_MIDDLE : corner[middle]);
    }
  }
  if (!vsc_sort(edges->items, count, sizeof *edges->items / sizeof(uint32_t), 2)) {
    vsc_edges_free(edges);
    return vsc_fail_memory(error, "the mesh's edges");
  }
  for (size_t k = 0; k < count; k++) {
    const vsc_edge edge = edges->items[k];
    vsc_edge *last = kept == 0 ? NULL : &edges->items[kept - 1];
    if (last == NULL || compare_ends(last, &edge) != 0) {
      edges->items[kept++] = edge;
      continue;
    }
    edges->apart = edges->apart || last->middle != edge.middle;
    if (edge.middle < last->middle) last->middle = edge.middle;
  }
  edges->count = kept;
  return VSC_OK;
}

void vsc_edges_free(vsc_edges *edges)
{
  vsc_free(edges->items);
  *edges = (vsc_edges){0};
}

const vsc_edge *vsc_edges_find(const vsc_edges *edges, uint32_t a, uint32_t b)
{
  const vsc_edge wanted = edge_between(a, b, 0);
  size_t first = 0, end = edges->count;
  while (first < end) {
    const size_t middle = first + (end - first) / 2;
    const int order = compare_ends(&edges->items[middle], &wanted);
    if (order == 0) return &edges->items[middle];
    if (order < 0)
      first = middle + 1;
    else
      end = middle;
  }
  return NULL;
}

vsc_status vsc_sides_list(const uint32_t *corners, size_t stride, size_t count, vsc_side **sides, vsc_error *error)
{
  vsc_side *made;
  *sides = NULL;
  if (!VSC_NEW(made, 3 * count)) return vsc_fail_memory(error, "the sides of triangles");
  for (size_t t = 0; t < count; t++)
    for (size_t i = 0; i < 3; i++) {
      const uint32_t a = corners[stride * t + i], b = corners[stride * t + (i + 1) % 3];
      made[3 * t + i] = (vsc_side){a < b ? a : b, a < b ? b : a, (uint32_t)t, (uint32_t)i, a < b};
    }
  if (!vsc_sort(made, 3 * count, sizeof *made / sizeof(uint32_t), 2)) {
    vsc_free(made);
    return vsc_fail_memory(error, "the sides of triangles");
  }
  *sides = made;
  return VSC_OK;
}

size_t vsc_sides_end(const vsc_side *sides, size_t side_count, size_t first)
{
  size_t end = first + 1;
  while (end < side_count && sides[end].low == sides[first].low && sides[end].high == sides[first].high) end++;
  return end;
}
