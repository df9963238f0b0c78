// SPDX-License-Identifier: GPL-3.0-or-later
// An order of points in which neighbours in space are neighbours in memory.
#ifndef VSC_MESH_ORDER_H
#define VSC_MESH_ORDER_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

// Sorts `count` points (x, y, z each) first by group, then along a Hilbert curve of 2^20 cells a
// side through their common bounding box, then by number. order[k] is the number of the k-th point.
// `group` may be NULL: one group.
vsc_status vsc_order_hilbert(size_t count, const double *points, const uint32_t *group,
                             uint32_t *order, vsc_error *error);

// The position along the three-dimensional Hilbert curve of the cell (i, j, k), each in [0,
// 2^bits), bits <= 21 (Skilling, Programming the Hilbert curve, AIP Conf. Proc. 707, 2004).
uint64_t vsc_hilbert_index(const uint32_t cell[3], int bits);

#endif
