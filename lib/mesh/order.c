// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/order.h"

#include <string.h>

#include "base/mem.h"
#include "base/sort.h"
#include "base/wide.h"

enum { BITS = 20 };

// The lowest 21 bits of `x`, each followed by two zeros.
static uint64_t spread(uint64_t x)
{
  x = (x | x << 32) & UINT64_C(0x1f00000000ffff);
  x = (x | x << 16) & UINT64_C(0x1f0000ff0000ff);
  x = (x | x << 8) & UINT64_C(0x100f00f00f00f00f);
  x = (x | x << 4) & UINT64_C(0x10c30c30c30c30c3);
  return (x | x << 2) & UINT64_C(0x1249249249249249);
}

// Several cells at once, as processors compute.
enum { TOGETHER = 8 };
typedef uint32_t numbers __attribute__((vector_size(TOGETHER * sizeof(uint32_t))));

// Transposes the cells' coordinates: interleaved, the highest bits first, they are the position along the curve.
VSC_CLONED static void transpose(uint32_t cells[3][TOGETHER], int bits)
{
  numbers axis[3];
  memcpy(axis, cells, sizeof axis);
  // undo the curve's rotations, from the coarsest cube to the finest; without branches, which nobody could foresee
  for (int b = bits - 1; b > 0; b--) {
    const uint32_t below = (1u << b) - 1;
    for (int i = 0; i < 3; i++) {
      const numbers turned = 0 - (axis[i] >> b & 1);
      const numbers exchanged = (axis[0] ^ axis[i]) & below & ~turned;
      axis[0] ^= (below & turned) | exchanged;
      axis[i] ^= exchanged;
    }
  }
  // Gray code
  for (int i = 1; i < 3; i++) axis[i] ^= axis[i - 1];
  numbers flip = axis[2] >> 1;
  for (int shift = 1; shift < 32; shift *= 2) flip ^= flip >> shift;  // each bit the parity of those above it
  for (int i = 0; i < 3; i++) axis[i] ^= flip;
  memcpy(cells, axis, sizeof axis);
}

static uint64_t interleave(uint32_t cells[3][TOGETHER], int lane)
{
  return spread(cells[0][lane]) << 2 | spread(cells[1][lane]) << 1 | spread(cells[2][lane]);
}

uint64_t vsc_hilbert_index(const uint32_t cell[3], int bits)
{
  uint32_t cells[3][TOGETHER] = {{cell[0]}, {cell[1]}, {cell[2]}};
  transpose(cells, bits);
  return interleave(cells, 0);
}

// What points are sorted by.
typedef struct sort_key {
  uint32_t group, high, low;  // high, low: of the index
  uint32_t number;
} sort_key;

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
  for (size_t first = 0; first < count; first += TOGETHER) {
    const size_t here = count - first < TOGETHER ? count - first : TOGETHER;
    uint32_t cells[3][TOGETHER] = {{0}};
    for (size_t k = 0; k < here; k++)
      for (int i = 0; i < 3; i++) cells[i][k] = (uint32_t)((points[3 * (first + k) + (size_t)i] - low[i]) * scale);
    transpose(cells, BITS);
    for (size_t k = 0; k < here; k++) {
      const uint64_t index = interleave(cells, (int)k);
      const size_t p = first + k;
      keys[p] = (sort_key){group ? group[p] : 0, (uint32_t)(index >> 32), (uint32_t)index, (uint32_t)p};
    }
  }
  const bool sorted = vsc_sort(keys, count, 4, 3);
  for (size_t p = 0; p < count; p++) order[p] = keys[p].number;
  vsc_free(keys);
  return sorted ? VSC_OK : vsc_fail_memory(error, "sorting the elements");
}
