// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/boxes.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/mem.h"

// The cell that holds a coordinate; the outermost ones hold what lies outside.
static size_t cell_of(const vsc_boxes *boxes, int axis, double x)
{
  const double place = (x - boxes->low[axis]) / boxes->step;
  if (!(place > 0)) return 0;
  const size_t last = boxes->size[axis] - 1;
  return place < (double)last ? (size_t)place : last;
}

static void cells_of(const vsc_boxes *boxes, const double low[3], const double high[3],
                     size_t first[3], size_t last[3])
{
  for (int k = 0; k < 3; k++) {
    first[k] = cell_of(boxes, k, low[k]);
    last[k] = cell_of(boxes, k, high[k]);
  }
}

// Cells are cubes, not much smaller than the mean box, as many as boxes or fewer.
static void choose_size(vsc_boxes *boxes)
{
  double high[3], longest = 0, mean = 0;
  for (int k = 0; k < 3; k++) boxes->low[k] = INFINITY, high[k] = -INFINITY;
  for (size_t i = 0; i < boxes->count; i++) {
    const double *end = &boxes->ends[6 * i];
    double edge = 0;
    for (int k = 0; k < 3; k++) {
      boxes->low[k] = fmin(boxes->low[k], end[k]);
      high[k] = fmax(high[k], end[3 + k]);
      edge = fmax(edge, end[3 + k] - end[k]);
    }
    mean += edge / (double)boxes->count;
  }
  for (int k = 0; k < 3; k++) longest = fmax(longest, high[k] - boxes->low[k]);
  const double most = fmax(8, (double)boxes->count);
  boxes->step = fmax(mean, longest * 1e-3);
  if (!(boxes->step > 0)) boxes->step = 1;
  for (;; boxes->step *= 1.25) {
    double cells = 1;
    for (int k = 0; k < 3; k++)
      cells *= fmax(1, ceil((high[k] - boxes->low[k]) / boxes->step));
    if (cells <= most) break;
  }
  for (int k = 0; k < 3; k++)
    boxes->size[k] = (size_t)fmax(1, ceil((high[k] - boxes->low[k]) / boxes->step));
}

// Counts the boxes of each cell (items NULL) or lists them.
static void sort_in(const vsc_boxes *boxes, size_t *at, uint32_t *items)
{
  size_t first[3], last[3];
  for (size_t i = 0; i < boxes->count; i++) {
    cells_of(boxes, &boxes->ends[6 * i], &boxes->ends[6 * i + 3], first, last);
    for (size_t z = first[2]; z <= last[2]; z++)
      for (size_t y = first[1]; y <= last[1]; y++)
        for (size_t x = first[0]; x <= last[0]; x++) {
          size_t *place = &at[x + boxes->size[0] * (y + boxes->size[1] * z)];
          if (items != NULL) items[*place] = (uint32_t)i;
          (*place)++;
        }
  }
}

vsc_status vsc_boxes_make(size_t count, const double *ends, vsc_boxes *boxes, vsc_error *error)
{
  *boxes = (vsc_boxes){.count = count, .step = 1, .size = {1, 1, 1}};
  if (!VSC_NEW(boxes->ends, 6 * count)) return vsc_fail_memory(error, "a grid of boxes");
  memcpy(boxes->ends, ends, 6 * count * sizeof *ends);
  if (count > 0) choose_size(boxes);
  const size_t cells = boxes->size[0] * boxes->size[1] * boxes->size[2];
  size_t *at = NULL, total = 0;
  bool room = VSC_NEW(boxes->start, cells + 1) && VSC_NEW(at, cells);
  if (room) {
    sort_in(boxes, at, NULL);
    for (size_t c = 0; c < cells; c++) {
      boxes->start[c] = total;
      total += at[c];
      at[c] = boxes->start[c];
    }
    boxes->start[cells] = total;
    room = VSC_NEW(boxes->items, total);
  }
  if (room) sort_in(boxes, at, boxes->items);
  vsc_free(at);
  if (room) return VSC_OK;
  vsc_boxes_free(boxes);
  return vsc_fail_memory(error, "a grid of boxes");
}

void vsc_boxes_free(vsc_boxes *boxes)
{
  vsc_free(boxes->ends);
  vsc_free(boxes->start);
  vsc_free(boxes->items);
  *boxes = (vsc_boxes){0};
}

// A box in several of the cells asked for is taken in the first of them.
static bool is_first(const vsc_boxes *boxes, const double *end, const size_t first[3],
                     const size_t cell[3])
{
  for (int k = 0; k < 3; k++) {
    const size_t own = cell_of(boxes, k, end[k]);
    if (cell[k] != (own > first[k] ? own : first[k])) return false;
  }
  return true;
}

size_t vsc_boxes_find(const vsc_boxes *boxes, const double low[3], const double high[3],
                      uint32_t *found)
{
  size_t first[3], last[3], cell[3], result = 0;
  cells_of(boxes, low, high, first, last);
  for (cell[2] = first[2]; cell[2] <= last[2]; cell[2]++)
    for (cell[1] = first[1]; cell[1] <= last[1]; cell[1]++)
      for (cell[0] = first[0]; cell[0] <= last[0]; cell[0]++) {
        const size_t c = cell[0] + boxes->size[0] * (cell[1] + boxes->size[1] * cell[2]);
        for (size_t i = boxes->start[c]; i < boxes->start[c + 1]; i++) {
          const double *end = &boxes->ends[6 * (size_t)boxes->items[i]];
          bool touches = is_first(boxes, end, first, cell);
          for (int k = 0; k < 3; k++) touches = touches && end[k] <= high[k] && end[3 + k] >= low[k];
          if (touches) found[result++] = boxes->items[i];
        }
      }
  return result;
}
