// SPDX-License-Identifier: GPL-3.0-or-later
// The Jacobian of a cell at a point, for loops over all cells: inlined, and the three coordinates at once.
#ifndef VSC_MESH_JACOBIAN_H
#define VSC_MESH_JACOBIAN_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/wide.h"
#include "mesh/cell.h"

// The places of a cell's corners among `nodes` (x, y, z each), the last of four numbers 0.
VSC_INLINE void vsc_cell_places(const double *nodes, const uint32_t *corner, int corners, vsc_four *x)
{
  for (int i = 0; i < corners; i++) {
    const double *at = nodes + 3 * (size_t)corner[i];
    x[i] = (vsc_four){at[0], at[1], at[2], 0};
  }
}

// J[k] = sum_i d N_i / d xi_k x[i], mm, at point `q` of a rule; x: the places of the cell's `corners` corners, mm. Of
// four numbers the last counts for nothing.
VSC_INLINE void vsc_cell_jacobian(const vsc_cell_rule *rule, int q, int corners, const vsc_four *x, double J[3][4])
{
  vsc_four rows[3] = {{0}};
  for (int i = 0; i < corners; i++)
    for (int k = 0; k < 3; k++) rows[k] += rule->D[q][k][i] * x[i];
  memcpy(J, rows, sizeof rows);
}

#endif
