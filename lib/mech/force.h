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

// Adds up the patches' parts (partial_count x 4) of the forces on shared nodes, in the order of the
// patches, into `force`.
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
