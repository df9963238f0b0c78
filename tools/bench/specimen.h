// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of tissue whose explicit steps are timed.
#ifndef VSC_TOOLS_BENCH_SPECIMEN_H
#define VSC_TOOLS_BENCH_SPECIMEN_H

#include "model/definition.h"

typedef enum vsc_specimen_kind {
  VSC_SPECIMEN_TETS,
  VSC_SPECIMEN_SHUFFLED,  // the same, tets and nodes in random order
  VSC_SPECIMEN_QUADRATIC,
  VSC_SPECIMEN_HEXES,
} vsc_specimen_kind;

// What a block is made of and which terms its steps have.
typedef struct vsc_specimen {
  const char *name;
  vsc_specimen_kind kind;
  vsc_law law;
  bool damping;              // along the three axes
  bool nodal;                // node-averaged volume, else each tet's own
  bool smoothed;             // edge-smoothed tets
  vsc_active_kind active;    // TENSION or NONE
  bool resting;              // the active curve is 0 all the while
  bool held;                 // the half at smaller x is held
  double operations, bytes;  // of a step for each element, at least (vsc_specimen_bound); 0: not counted
} vsc_specimen;

typedef struct vsc_specimen_cost {
  size_t elements, nodes;
  double build;  // seconds of one thread from the mesh to the first step: order, frames, masses, stable step
  double one;    // processor seconds of a step on one thread, the least of some timings
  double all;    // seconds by the clock of a step on all threads, likewise
  double bytes;  // of model and state
} vsc_specimen_cost;

// A cube of about `elements` elements of the kind, of 1 mm edges. The caller owns *mesh.
vsc_status vsc_specimen_mesh(vsc_specimen_kind kind, size_t elements, vsc_mesh **mesh, vsc_error *error);

// Builds the specimen on the mesh and times its steps, on one thread and, with `all`, on all threads.
vsc_status vsc_specimen_time(const vsc_specimen *specimen, const vsc_mesh *mesh, bool all,
                             vsc_specimen_cost *cost, vsc_error *error);

#endif
