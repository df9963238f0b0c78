// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of tissue whose explicit steps are timed.
#ifndef VSC_TOOLS_BENCH_SPECIMEN_H
#define VSC_TOOLS_BENCH_SPECIMEN_H

#include "mech/state.h"
#include "model/definition.h"

typedef enum vsc_specimen_kind {
  VSC_SPECIMEN_TETS,   // five to a cube
  VSC_SPECIMEN_CLOUD,  // Delaunay tets of scattered points, tets and nodes in random order, read from a file
  VSC_SPECIMEN_QUADRATIC,
  VSC_SPECIMEN_HEXES,
} vsc_specimen_kind;

// All that a model is made of, one of each; what the definition counts of it is there.
typedef struct vsc_specimen_scene {
  const vsc_mesh *mesh;
  double size[3];  // mm: the block reaches from the origin to there
  vsc_material_def material[2];
  vsc_selector set, surface;
  vsc_support_def support;
  vsc_pressure_def pressure;
  vsc_robin_def robin;
  vsc_obstacle_def obstacle;
  vsc_membrane_def membrane;
  vsc_inclusion_def inclusion;
  vsc_definition definition;
} vsc_specimen_scene;

// Adds something to a scene of springs.
typedef void vsc_specimen_feature(vsc_specimen_scene *scene);

// What a block is made of and which terms its steps have.
typedef struct vsc_specimen {
  const char *name;
  vsc_specimen_kind kind;
  vsc_law law;
  bool damping;                   // along the three axes
  bool nodal;                     // node-averaged volume, else each tet's own
  bool smoothed;                  // edge-smoothed tets
  vsc_active_kind active;         // TENSION or NONE
  vsc_specimen_feature *feature;  // or NULL
  double operations;  // additions, multiplications, divisions and roots of a step for each element; 0: not counted
} vsc_specimen;

typedef struct vsc_specimen_cost {
  size_t elements, nodes;
  double build;    // seconds of one thread from the mesh to the first step: order, frames, masses, stable step
  double one;      // processor seconds of a step on one thread, the least of some timings
  double all;      // seconds by the clock of a step on all threads, likewise
  double bytes;    // of model and state
  double traffic;  // bytes that a step reads and writes at least, were caches to hold nothing from one sweep to the next
} vsc_specimen_cost;

// A cube of about `elements` elements of the kind, of 1 mm edges. CLOUD: of a cloud of at most some ten thousand tets,
// mirrored as often as it takes in each direction. Into *read come the processor seconds that reading its file took
// (vsc_vtk_read_mesh; it lies in TMPDIR, or /tmp, until then), NAN where there is none. The caller owns *mesh.
vsc_status vsc_specimen_mesh(vsc_specimen_kind kind, size_t elements, vsc_mesh **mesh, double *read,
                             vsc_error *error);

// A specimen that is ready to step.
typedef struct vsc_specimen_run {
  vsc_model *model;
  vsc_state *state;
  double steps;  // of the next timing
} vsc_specimen_run;

// Builds the specimen on the mesh and starts it on one thread; elements, nodes, build, bytes and traffic of the cost. On
// success and after an error vsc_specimen_close releases it.
vsc_status vsc_specimen_open(const vsc_specimen *specimen, const vsc_mesh *mesh, vsc_specimen_run *run,
                             vsc_specimen_cost *cost, vsc_error *error);

// Takes one more timing on one thread: *seconds becomes the processor seconds of a step where that is less.
vsc_status vsc_specimen_step(vsc_specimen_run *run, double *seconds, vsc_error *error);

void vsc_specimen_close(vsc_specimen_run *run);

// Builds the specimen on the mesh and times its steps, on one thread and, with `all`, on all threads.
vsc_status vsc_specimen_time(const vsc_specimen *specimen, const vsc_mesh *mesh, bool all,
                             vsc_specimen_cost *cost, vsc_error *error);

#endif
