// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/order.h"

#include <stdlib.h>

#include "base/mem.h"

enum { BITS = 20 };

uint64_t vsc_hilbert_index(const uint32_t cell[3], int bits)
{
  uint32_t axis[3] = {cell[0], cell[1], cell[2]};
  // undo the curve's rotations, from the coarsest cube to the finest
  for (uint32_t bit = 1u << (bits - 1); bit > 1; bit >>= 1) {
    const uint32_t below = bit - 1;
    for (int i = 0; i < 3; i++) {
      const uint32_t exchanged = (axis[0] ^ axis[i]) & below;
      if (axis[i] & bit) {
        axis[0] ^= below;
      } else {
        axis[0] ^= exchanged;
        axis[i] ^= exchanged;
      }
    }
  }
  // Gray code
  for (int i = 1; i < 3; i++) axis[i] ^= axis[i - 1];
  uint32_t flip = 0;
  for (uint32_t bit = 1u << (bits - 1); bit > 1; bit >>= 1)
    if (axis[2] & bit) flip ^= bit - 1;
  uint64_t index = 0;
  for (int b = bits - 1; b >= 0; b--)
    for (int i = 0; i < 3; i++) index = index << 1 | ((axis[i] ^ flip) >> b & 1);
  return index;
}

typedef struct sort_key {
  uint64_t index;
  uint32_t group, number;
} sort_key;

static int compare_keys(const void *left, const void *right)
{
  const sort_key *a = left, *b = right;
  if (a->group != b->group) return a->group < b->group ? -1 : 1;
  if (a->index != b->index) return a->index < b->index ? -1 : 1;
  return a->number < b->number ? -1 : a->number > b->number;
}

static void bounding_box(size_t count, const double *points, double low[3], double *side)
{
  double high[3];
  for (int i = 0; i < 3; i++) low[i] = high[i] = count > 0 ? points[i] : 0;
  for (size_t p = 1; p < count; p++)
    for (int i = 0; i < 3; i++) {
      const double x = points[3 * p + i];
      if (x < low[i]) low[i] = x;
      if (x > high[i]) high[i] = x;
    }
  *side = 0;
  for (int i = 0; i < 3; i++)
    if (high[i] - low[i] > *side) *side = high[i] - low[i];
}

vsc_status vsc_order_hilbert(size_t count, const double *points, const uint32_t *group,
                             uint32_t *order, vsc_error *error)
{
  sort_key *keys;
  if (!VSC_NEW(keys, count)) return vsc_fail_memory(error, "sorting the elements");
  double low[3], side;
  bounding_box(count, points, low, &side);
  const double scale = side > 0 ? ((1u << BITS) - 1) / side : 0;
  for (size_t p = 0; p < count; p++) {
    uint32_t cell[3];
    for (int i = 0; i < 3; i++) cell[i] = (uint32_t)((points[3 * p + i] - low[i]) * scale);
    keys[p] = (sort_key){vsc_hilbert_index(cell, BITS), group ? group[p] : 0, (uint32_t)p};
  }
  qsort(keys, count, sizeof *keys, compare_keys);
  for (size_t p = 0; p < count; p++) order[p] = keys[p].number;
  vsc_free(keys);
  return VSC_OK;
}
