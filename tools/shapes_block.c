// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_block.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "tools/shapes_bricks.h"

// ---- Tets

vsc_block_shape vsc_block_default(void)
{
  return (vsc_block_shape){.cells = {4, 4, 4}, .size = {10, 10, 10}, .tets_per_cell = 5, .seed = 1};
}

// The inner nodes that may become slivers, every third along each axis so that none has two; the number of them.
static size_t sliver_places(const vsc_block_shape *block, size_t count[3])
{
  for (int a = 0; a < 3; a++) count[a] = (block->cells[a] + (a > 0)) / 3;
  return count[0] * count[1] * count[2];
}

static vsc_status check_block(const vsc_block_shape *block, vsc_error *error)
{
  for (int a = 0; a < 3; a++) {
    if (block->cells[a] < 1 || block->cells[a] > 1000)
      return vsc_fail(error, VSC_INPUT, "block: %zu bricks along %c, must be 1 to 1000",
                      block->cells[a], 'x' + a);
    if (!(block->size[a] > 0 && isfinite(block->size[a])))
      return vsc_fail(error, VSC_INPUT, "block: size %g mm along %c, must be above 0",
                      block->size[a], 'x' + a);
  }
  if (block->tets_per_cell != 5 && block->tets_per_cell != 6)
    return vsc_fail(error, VSC_INPUT, "block: %d tets per brick, must be 5 or 6",
                    block->tets_per_cell);
  if (!(block->jitter >= 0 && block->jitter <= 0.3))
    return vsc_fail(error, VSC_INPUT, "block: jitter %g, must be 0 to 0.3 of a brick",
                    block->jitter);
  size_t count[3];
  if (block->slivers > sliver_places(block, count))
    return vsc_fail(error, VSC_INPUT, "block: %zu slivers, there are places for %zu", block->slivers,
                    sliver_places(block, count));
  return VSC_OK;
}

double vsc_scatter(unsigned long seed, size_t number)
{
  uint64_t z = (seed * UINT64_C(0x100000001B3) + number + 1) * UINT64_C(0x9E3779B97F4A7C15);
  z = (z ^ (z >> 30)) * UINT64_C(0xBF58476D1CE4E5B9);
  z = (z ^ (z >> 27)) * UINT64_C(0x94D049BB133111EB);
  z ^= z >> 31;
  return ldexp((double)(z >> 11), -52) - 1;
}

static void place_block_node(const vsc_block_shape *block, vsc_mesh *mesh, size_t node)
{
  const size_t across = block->cells[0] + 1, deep = block->cells[1] + 1;
  const size_t index[3] = {node % across, node / across % deep, node / across / deep};
  bool inner = true;
  for (int a = 0; a < 3; a++) {
    const bool low = index[a] == 0, high = index[a] == block->cells[a];
    mesh->node_data.items[2 * a].values[node] = low;
    mesh->node_data.items[2 * a + 1].values[node] = high;
    if (low || high) inner = false;
  }
  for (int a = 0; a < 3; a++) {
    const double cells = (double)block->cells[a];
    double part = (double)index[a] / cells;
    if (inner)
      part += block->jitter * vsc_scatter(block->seed, 3 * node + (size_t)a) / cells;
    mesh->nodes[3 * node + (size_t)a] = block->size[a] * part;
  }
}

static void place_slivers(const vsc_block_shape *block, vsc_mesh *mesh)
{
  size_t count[3];
  const size_t places = sliver_places(block, count), across = block->cells[0] + 1, deep = block->cells[1] + 1;
  for (size_t s = 0; s < block->slivers; s++) {
    const size_t place = s * places / block->slivers;
    const size_t i = 1 + 3 * (place % count[0]), j = 1 + 3 * (place / count[0] % count[1]),
                 k = 1 + 3 * (place / count[0] / count[1]);
    double *node = mesh->nodes + 3 * (i + across * (j + deep * k));
    for (int a = 0; a < 3; a++) node[a] += 0.99 * (node[3 + a] - node[a]);
  }
}

static void cut_block(const vsc_block_shape *block, vsc_mesh *mesh)
{
  const size_t *cells = block->cells, tets = (size_t)block->tets_per_cell;
  for (size_t b = 0; b < cells[0] * cells[1] * cells[2]; b++) {
    uint32_t corner[8];
    const bool mirrored = vsc_brick_corners(cells, b, corner);
    vsc_brick_cut(corner, block->tets_per_cell, mirrored, &mesh->corners[4 * tets * b]);
  }
}

vsc_status vsc_block_mesh(const vsc_block_shape *block, vsc_mesh **result, vsc_error *error)
{
  const vsc_status status = check_block(block, error);
  if (status != VSC_OK) return status;
  const size_t *cells = block->cells;
  const size_t nodes = (cells[0] + 1) * (cells[1] + 1) * (cells[2] + 1);
  vsc_mesh *mesh =
      vsc_mesh_create(nodes, cells[0] * cells[1] * cells[2] * (size_t)block->tets_per_cell, 0);
  if (mesh == NULL) return vsc_fail_memory(error, "the block's mesh");
  static const char *const names[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
  bool complete = true;
  for (int a = 0; a < 6 && complete; a++)
    complete = vsc_arrays_add(&mesh->node_data, names[a], 1, nodes) != NULL;
  cut_block(block, mesh);
  if (!complete || !vsc_region_add(mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail_memory(error, "the block's arrays");
  }
  for (size_t n = 0; n < nodes; n++) place_block_node(block, mesh, n);
  place_slivers(block, mesh);
  if (!vsc_shape_finish(mesh)) {
    vsc_mesh_free(mesh);
    return vsc_fail(error, VSC_INPUT, "block: a jitter of %g turns tets inside out, use less",
                    block->jitter);
  }
  *result = mesh;
  return VSC_OK;
}

// ---- Other kinds: pieces of a brick with the corners 0 to 3 round the bottom, 4 to 7 above them and 8
// in the middle

static const vsc_brick_piece sixths[6] = {{VSC_TET, {0, 1, 2, 6}}, {VSC_TET, {0, 2, 3, 6}},
                                          {VSC_TET, {0, 3, 7, 6}}, {VSC_TET, {0, 7, 4, 6}},
                                          {VSC_TET, {0, 4, 5, 6}}, {VSC_TET, {0, 5, 1, 6}}};
// Towards larger x the face is cut as `sixths` cut it on their other side, from corner 0 to 7.
static const vsc_brick_piece star[7] = {
    {VSC_PYRAMID, {0, 3, 7, 4, 8}}, {VSC_PYRAMID, {0, 4, 5, 1, 8}},
    {VSC_PYRAMID, {3, 2, 6, 7, 8}}, {VSC_PYRAMID, {0, 1, 2, 3, 8}},
    {VSC_PYRAMID, {4, 7, 6, 5, 8}}, {VSC_TET, {1, 6, 2, 8}},
    {VSC_TET, {1, 5, 6, 8}}};

typedef struct cut {
  const vsc_brick_piece *pieces;
  size_t count;
} cut;

static const cut cuts[4] = {{vsc_brick_whole, 1}, {vsc_brick_halves, 2}, {star, 7}, {sixths, 6}};
enum { WHOLE, HALVES, STAR, SIXTHS };

// How the bricks in place `i` of `cells` along x are cut.
static int cut_of(vsc_block_kind kind, size_t i, size_t cells)
{
  if (kind == VSC_BLOCK_HEXES) return WHOLE;
  if (kind == VSC_BLOCK_WEDGES) return HALVES;
  if (i == cells / 2) return STAR;
  return i > cells / 2 ? SIXTHS : i < cells / 4 ? WHOLE : HALVES;
}

static void place_centre(vsc_mesh *mesh, const uint32_t corner[8], size_t centre)
{
  for (int i = 0; i < 8; i++)
    for (size_t a = 0; a < 3; a++)
      mesh->nodes[3 * centre + a] += mesh->nodes[3 * (size_t)corner[i] + a] / 8;
}

static vsc_mesh *empty_mesh(const vsc_block_shape *block, vsc_block_kind kind, size_t grid)
{
  const size_t bricks = block->cells[0] * block->cells[1] * block->cells[2];
  uint8_t *kinds;
  size_t count = 0, centres = 0;
  if (!VSC_NEW(kinds, 7 * bricks)) return NULL;
  for (size_t b = 0; b < bricks; b++) {
    const int way = cut_of(kind, b % block->cells[0], block->cells[0]);
    for (size_t p = 0; p < cuts[way].count; p++) kinds[count++] = (uint8_t)cuts[way].pieces[p].kind;
    centres += way == STAR;
  }
  vsc_mesh *mesh = vsc_mesh_create_cells(grid + centres, count, kinds, 0);
  vsc_free(kinds);
  return mesh;
}

static void cut_bricks(const vsc_block_shape *block, vsc_block_kind kind, size_t grid,
                       vsc_mesh *mesh)
{
  const size_t bricks = block->cells[0] * block->cells[1] * block->cells[2];
  size_t centre = grid;
  uint32_t *at = mesh->corners;
  for (size_t b = 0; b < bricks; b++) {
    uint32_t corner[9];
    const int way = cut_of(kind, b % block->cells[0], block->cells[0]);
    vsc_brick_corners(block->cells, b, corner);
    corner[8] = (uint32_t)centre;
    if (way == STAR) place_centre(mesh, corner, centre++);
    for (size_t p = 0; p < cuts[way].count; p++) {
      const vsc_brick_piece *piece = &cuts[way].pieces[p];
      for (int i = 0; i < vsc_cells[piece->kind].corners; i++) *at++ = corner[piece->corners[i]];
    }
  }
}

// Copies the arrays of the tets' mesh: nodes behind the grid get 0, elements the region 1.
static bool copy_arrays(const vsc_mesh *from, vsc_mesh *to)
{
  for (size_t a = 0; a < from->node_data.count; a++) {
    const vsc_array *array = &from->node_data.items[a];
    vsc_array *copy = vsc_arrays_add(&to->node_data, array->name, 1, to->node_count);
    if (copy == NULL) return false;
    memcpy(copy->values, array->values, from->node_count * sizeof *array->values);
  }
  return vsc_region_add(to);
}

vsc_status vsc_block_of(const vsc_block_shape *shape, vsc_block_kind kind, vsc_mesh **result,
                        vsc_error *error)
{
  if (kind == VSC_BLOCK_TETS) return vsc_block_mesh(shape, result, error);
  if (kind == VSC_BLOCK_MIXED && shape->cells[0] < 4)
    return vsc_fail(error, VSC_INPUT, "mixed block: %zu bricks along x, must be at least 4",
                    shape->cells[0]);
  vsc_mesh *grid = NULL;
  const vsc_status status = vsc_block_mesh(shape, &grid, error);
  if (status != VSC_OK) return status;
  vsc_mesh *mesh = empty_mesh(shape, kind, grid->node_count);
  bool complete = mesh != NULL;
  if (complete) {
    memcpy(mesh->nodes, grid->nodes, 3 * grid->node_count * sizeof *grid->nodes);
    cut_bricks(shape, kind, grid->node_count, mesh);
    vsc_shape_finish(mesh);
    complete = copy_arrays(grid, mesh);
  }
  vsc_mesh_free(grid);
  if (!complete) {
    vsc_mesh_free(mesh);
    return vsc_fail_memory(error, "the block's mesh");
  }
  *result = mesh;
  return VSC_OK;
}
