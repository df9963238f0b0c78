// SPDX-License-Identifier: GPL-3.0-or-later
// A uniform grid that finds the boxes near a place.
#ifndef VSC_FIBERS_BOXES_H
#define VSC_FIBERS_BOXES_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

typedef struct vsc_boxes {
  size_t count;
  double *ends;          // count x 6: low x, y, z, high x, y, z; owned
  double low[3], step;   // of the grid: its corner, the edge of a cell
  size_t size[3];        // cells along x, y, z
  size_t *start;         // cells + 1: cell c holds items[start[c] .. start[c + 1] - 1]
  uint32_t *items;       // numbers of boxes, ascending in each cell
} vsc_boxes;

// A grid of about as many cells as boxes, or 8 of them. `ends` (count x 6) is copied. The content of
// *boxes is the caller's.
vsc_status vsc_boxes_make(size_t count, const double *ends, vsc_boxes *boxes, vsc_error *error);

void vsc_boxes_free(vsc_boxes *boxes);  // frees the content

// The numbers of the boxes that touch the box from `low` to `high`, each once, to found[0 .. result -
// 1] (with room for all), in an order that only the boxes and the question decide.
size_t vsc_boxes_find(const vsc_boxes *boxes, const double low[3], const double high[3],
                      uint32_t *found);

#endif
