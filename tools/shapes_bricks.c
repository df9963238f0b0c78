// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_bricks.h"

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
