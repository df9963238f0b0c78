// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes are sorted by the cells of a grid, and compared within each.
#include "mesh/coincident.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "base/vec3.h"

static const double NEAR = 1e-4, STEP = 1e-2;  // what counts as one place, cells of the grid: parts of a mean edge
static const double MOST = 1 << 30;            // cells along a side of the box

// A node in a cell of the grid. One that is near the cell's side stands in the next cell too.
typedef struct entry {
  uint32_t cell[3];
  uint32_t node;
} entry;

typedef struct grid {
  const vsc_mesh *mesh;
  double low[3], step, near;
} grid;

// The mean distance of the first two corners of elements or, on a surface, of triangles.
static double mean_edge(const vsc_mesh *mesh)
{
  const size_t count = mesh->element_count > 0 ? mesh->element_count : mesh->triangle_count;
  double sum = 0, way[3];
  for (size_t k = 0; k < count; k++) {
    const uint32_t *corner = mesh->element_count > 0 ? vsc_mesh_corners(mesh, k) : mesh->triangles + 3 * k;
    vsc_subtract(mesh->nodes + 3 * (size_t)corner[1], mesh->nodes + 3 * (size_t)corner[0], way);
    sum += vsc_norm(way);
  }
  return count > 0 ? sum / (double)count : 0;
}

static grid make_grid(const vsc_mesh *mesh)
{
  grid g = {.mesh = mesh};
  double high[3], side = 0;
  vsc_mesh_box(mesh, g.low, high);
  for (int a = 0; a < 3; a++) side = fmax(side, high[a] - g.low[a]);
  const double edge = mean_edge(mesh);
  g.near = NEAR * edge;
  g.step = edge > 0 ? fmax(STEP * edge, side / MOST) : 1;
  return g;
}

// The entries of a node, 1 to 8: a cell for each corner of the box round what is near to it.
static int entries_of(const grid *g, size_t node, entry entries[8])
{
  uint32_t first[3], last[3];
  int count = 0;
  for (int a = 0; a < 3; a++) {
    const double from = g->mesh->nodes[3 * node + (size_t)a] - g->low[a];
    first[a] = (uint32_t)(fmax(from - g->near, 0) / g->step);
    last[a] = (uint32_t)((from + g->near) / g->step);
  }
  for (uint32_t i = first[0]; i <= last[0]; i++)
    for (uint32_t j = first[1]; j <= last[1]; j++)
      for (uint32_t k = first[2]; k <= last[2]; k++) entries[count++] = (entry){{i, j, k}, (uint32_t)node};
  return count;
}

static bool are_near(const grid *g, uint32_t a, uint32_t b)
{
  double way[3];
  vsc_subtract(g->mesh->nodes + 3 * (size_t)a, g->mesh->nodes + 3 * (size_t)b, way);
  return vsc_norm(way) <= g->near;
}

// Marks the nodes of one cell that are near another.
static void mark_cell(const grid *g, const entry *entries, size_t count, uint8_t *marked)
{
  for (size_t i = 1; i < count; i++)
    for (size_t j = 0; j < i; j++) {
      uint8_t *const a = &marked[entries[i].node], *const b = &marked[entries[j].node];
      if ((!*a || !*b) && are_near(g, entries[i].node, entries[j].node)) *a = *b = 1;
    }
}

static bool mark_nodes(const grid *g, uint8_t *marked)
{
  const size_t nodes = g->mesh->node_count;
  entry *entries, some[8];
  size_t count = 0;
  for (size_t n = 0; n < nodes; n++) count += (size_t)entries_of(g, n, some);
  if (!VSC_NEW(entries, count)) return false;
  for (size_t n = 0, at = 0; n < nodes; n++) at += (size_t)entries_of(g, n, entries + at);
  const bool sorted = vsc_sort(entries, count, sizeof *entries / sizeof(uint32_t), 3);
  for (size_t first = 0, end; first < count && sorted; first = end) {
    end = first + 1;
    while (end < count && memcmp(entries[end].cell, entries[first].cell, sizeof entries->cell) == 0) end++;
    mark_cell(g, entries + first, end - first, marked);
  }
  vsc_free(entries);
  return sorted;
}

vsc_status vsc_mesh_coincident(const vsc_mesh *mesh, size_t *count, vsc_error *error)
{
  const grid g = make_grid(mesh);
  uint8_t *marked = NULL;
  *count = 0;
  const bool room = VSC_NEW(marked, mesh->node_count) && mark_nodes(&g, marked);
  for (size_t n = 0; n < mesh->node_count && room; n++) *count += marked[n];
  vsc_free(marked);
  return room ? VSC_OK : vsc_fail_memory(error, "nodes at one place");
}
