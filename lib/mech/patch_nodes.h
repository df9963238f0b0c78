// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers on the nodes of one patch, from the whole body's and back. Internal to mech.
#ifndef VSC_MECH_PATCH_NODES_H
#define VSC_MECH_PATCH_NODES_H

#include <string.h>

#include "model/model.h"

// The patch's part of node x 4 numbers, own nodes first.
static inline void vsc_gather_nodes(const vsc_model *model, const vsc_patch *patch,
                                    const double *from, double *local)
{
  memcpy(local, from + 4 * (size_t)patch->first_node, 4 * patch->own_count * sizeof *local);
  vsc_wide *to = (vsc_wide *)(local + 4 * (size_t)patch->own_count);
  const uint32_t *shared = model->shared + patch->first_shared;
  for (uint32_t n = 0; n < patch->shared_count; n++)
    to[n] = *(const vsc_wide *)(from + 4 * (size_t)shared[n]);
}

// The patch's forces: those on its own nodes are whole, those on shared nodes are parts of sums
// (vsc_sum_shared).
static inline void vsc_put_forces(const vsc_patch *patch, const double *local, double *force,
                                  double *partial)
{
  memcpy(force + 4 * (size_t)patch->first_node, local, 4 * patch->own_count * sizeof *local);
  memcpy(partial + 4 * (size_t)patch->first_shared, local + 4 * (size_t)patch->own_count,
         4 * patch->shared_count * sizeof *local);
}

#endif
