// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_bricks.h"

#include "base/mem.h"

const vsc_brick_piece vsc_brick_whole[1] = {{VSC_HEX, {0, 1, 2, 3, 4, 5, 6, 7}}};
const vsc_brick_piece vsc_brick_halves[2] = {{VSC_WEDGE, {0, 1, 2, 4, 5, 6}},
                                             {VSC_WEDGE, {0, 2, 3, 4, 6, 7}}};

bool vsc_brick_corners(const size_t cells[3], size_t brick, uint32_t corner[8])
{
  const size_t at[3] = {brick % cells[0], brick / cells[0] % cells[1], brick / cells[0] / cells[1]};
  const uint32_t along_y = (uint32_t)cells[0] + 1, along_z = along_y * ((uint32_t)cells[1] + 1);
  const uint32_t c = (uint32_t)at[0] + along_y * (uint32_t)at[1] + along_z * (uint32_t)at[2];
  const uint32_t bottom[4] = {c, c + 1, c + 1 + along_y, c + along_y};
  for (int i = 0; i < 4; i++) {
    corner[i] = bottom[i];
    corner[i + 4] = bottom[i] + along_z;
  }
  return (at[0] + at[1] + at[2]) % 2 == 1;
}

void vsc_brick_cut(const uint32_t corner[8], int count, bool mirrored, uint32_t *tets)
{
  static const int five[2][5][4] = {
      {{0, 2, 7, 5}, {1, 0, 5, 2}, {3, 0, 2, 7}, {4, 0, 7, 5}, {6, 2, 5, 7}},
      {{1, 3, 4, 6}, {0, 1, 3, 4}, {2, 1, 6, 3}, {5, 1, 4, 6}, {7, 3, 6, 4}}};
  static const int six[6][4] = {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6},
                                {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}};
  const int(*pattern)[4] = count == 6 ? six : five[mirrored];
  for (int t = 0; t < count; t++)
    for (int i = 0; i < 4; i++) tets[4 * t + i] = corner[pattern[t][i]];
}

bool vsc_region_add(vsc_mesh *mesh)
{
  vsc_array *region = vsc_arrays_add(&mesh->element_data, "region", 1, mesh->element_count);
  for (size_t e = 0; region != NULL && e < mesh->element_count; e++) region->values[e] = 1;
  return region != NULL;
}

// The pieces of a wall's brick; of tets, which vsc_brick_cut makes, only their number.
static const vsc_brick_piece *pieces_of(const vsc_wall *wall, size_t *count)
{
  *count = wall->element == VSC_BLOCK_TETS ? 5 : wall->element == VSC_BLOCK_WEDGES ? 2 : 1;
  return wall->element == VSC_BLOCK_WEDGES ? vsc_brick_halves : vsc_brick_whole;
}

vsc_mesh *vsc_wall_create(const vsc_wall *wall, size_t triangles)
{
  size_t pieces;
  const vsc_brick_piece *piece = pieces_of(wall, &pieces);
  const size_t nodes = (wall->layers + 1) * wall->per_layer;
  const size_t elements = pieces * wall->columns * wall->layers;
  if (wall->element == VSC_BLOCK_TETS) return vsc_mesh_create(nodes, elements, triangles);
  uint8_t *kinds;
  if (!VSC_NEW(kinds, elements)) return NULL;
  for (size_t e = 0; e < elements; e++) kinds[e] = (uint8_t)piece->kind;
  vsc_mesh *mesh = vsc_mesh_create_cells(nodes, elements, kinds, triangles);
  vsc_free(kinds);
  return mesh;
}

void vsc_wall_cut(const vsc_wall *wall, vsc_mesh *mesh, size_t column, const uint32_t quad[4],
                  size_t parity)
{
  size_t pieces;
  const vsc_brick_piece *piece = pieces_of(wall, &pieces);
  for (size_t layer = 0; layer < wall->layers; layer++) {
    uint32_t corner[8];
    for (int c = 0; c < 4; c++) {
      corner[c] = (uint32_t)(layer * wall->per_layer) + quad[c];
      corner[c + 4] = corner[c] + (uint32_t)wall->per_layer;
    }
    uint32_t *at = mesh->corners + mesh->start[pieces * (column * wall->layers + layer)];
    if (wall->element == VSC_BLOCK_TETS) {
      vsc_brick_cut(corner, 5, (parity + layer) % 2 == 1, at);
      continue;
    }
    for (size_t p = 0; p < pieces; p++)
      for (int i = 0; i < vsc_cells[piece[p].kind].corners; i++) *at++ = corner[piece[p].corners[i]];
  }
}

bool vsc_shape_finish(vsc_mesh *mesh)
{
  mesh->report.file_nodes = mesh->node_count;
  mesh->report.file_cells = mesh->element_count + mesh->triangle_count;
  for (size_t e = 0; e < mesh->element_count; e++)
    if (!(vsc_mesh_element_volume(mesh, e) > 0)) return false;
  return true;
}
