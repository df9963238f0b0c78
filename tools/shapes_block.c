// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_block.h"

#include <string.h>

#include "base/mem.h"
#include "tools/shapes_bricks.h"

// Pieces of a brick with the corners 0 to 3 round the bottom, 4 to 7 above them and 8 in the
// middle.
typedef struct piece {
  vsc_cell kind;
  int corners[VSC_MOST_CORNERS];
} piece;

static const piece whole[1] = {{VSC_HEX, {0, 1, 2, 3, 4, 5, 6, 7}}};
static const piece halves[2] = {{VSC_WEDGE, {0, 1, 2, 4, 5, 6}}, {VSC_WEDGE, {0, 2, 3, 4, 6, 7}}};
static const piece sixths[6] = {{VSC_TET, {0, 1, 2, 6}}, {VSC_TET, {0, 2, 3, 6}},
                                {VSC_TET, {0, 3, 7, 6}}, {VSC_TET, {0, 7, 4, 6}},
                                {VSC_TET, {0, 4, 5, 6}}, {VSC_TET, {0, 5, 1, 6}}};
// Towards larger x the face is cut as `sixths` cut it on their other side, from corner 0 to 7.
static const piece star[7] = {{VSC_PYRAMID, {0, 3, 7, 4, 8}}, {VSC_PYRAMID, {0, 4, 5, 1, 8}},
                              {VSC_PYRAMID, {3, 2, 6, 7, 8}}, {VSC_PYRAMID, {0, 1, 2, 3, 8}},
                              {VSC_PYRAMID, {4, 7, 6, 5, 8}}, {VSC_TET, {1, 6, 2, 8}},
                              {VSC_TET, {1, 5, 6, 8}}};

typedef struct cut {
  const piece *pieces;
  size_t count;
} cut;

static const cut cuts[4] = {{whole, 1}, {halves, 2}, {star, 7}, {sixths, 6}};
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
      const piece *piece = &cuts[way].pieces[p];
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
    mesh->report.file_nodes = mesh->node_count;
    mesh->report.file_cells = mesh->element_count;
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
