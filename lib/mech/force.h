// SPDX-License-Identifier: GPL-3.0-or-later
// Forces on the nodes from everything in the model.
#ifndef VSC_MECH_FORCE_H
#define VSC_MECH_FORCE_H

#include "mech/kernel.h"
#include "mech/state.h"

// force = sum of element forces and loads (mech/loads.h) at positions `x`, velocities `w` (both
// node_count x 4; `w` may be NULL when there is no damping) and `time` (ms); mN, node_count x 4.
// Sums run in an order that does not depend on the number of threads. Uses the state's scratch
// only.
void vsc_force(const vsc_model *model, const double *x, const double *w, double time,
               vsc_scratch *scratch, double *force);

// All of that but its last pass, for who goes over the nodes anyway: into `force` come the forces of elements on nodes
// of one patch only, into the scratch the rest, which vsc_node_force adds up.
void vsc_force_parts(const vsc_model *model, const double *x, const double *w, double time,
                     vsc_scratch *scratch, double *force);

// The sum of the patches' parts (partial_count x 4) of the force on node n, which several share, in the order of the
// patches.
VSC_INLINE vsc_wide vsc_shared_force(const vsc_model *model, const double *partial, size_t n)
{
  const size_t s = n - model->own_node_count;
  vsc_wide sum = vsc_splat(0);
  for (uint32_t k = model->sum_start[s]; k < model->sum_start[s + 1]; k++)
    sum += ((const vsc_wide *)partial)[model->sum_place[k]];
  return sum;
}

// The force on node n after vsc_force_parts, mN.
VSC_INLINE vsc_wide vsc_node_force(const vsc_model *model, const vsc_scratch *scratch, const double *force, size_t n)
{
  vsc_wide f = n < model->own_node_count ? ((const vsc_wide *)force)[n] : vsc_shared_force(model, scratch->partial, n);
  if (scratch->pushed) f += ((const vsc_wide *)scratch->outside)[n];
  if (model->terms.gravity) f += scratch->load * ((const vsc_wide *)model->weight)[n];
  return f;
}

// Adds up the patches' parts of the forces on all shared nodes into `force`.
void vsc_sum_shared(const vsc_model *model, const double *partial, double *force);

// J of each node's volume group at `x`, into `ratio` (node_count). With node-averaged volume only.
void vsc_group_ratios(const vsc_model *model, const double *x, vsc_scratch *scratch, double *ratio);

// The deformed volumes of the nodes' groups at `x`, into the scratch, where vsc_patch_prepare finds
// them.
void vsc_group_volumes(const vsc_model *model, const double *x, vsc_scratch *scratch);

// A patch with what its kernels read gathered into the scratch of `thread`; x, w, time as
// for vsc_force; `before` (node_count x 4, or NULL) goes where forces would. Good until the next call
// with that thread.
vsc_patch_work vsc_patch_prepare(const vsc_model *model, const vsc_patch *patch, const double *x,
                                 const double *w, const double *before, double time,
                                 vsc_scratch *scratch, int thread);

#endif
