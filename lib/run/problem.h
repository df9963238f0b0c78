// SPDX-License-Identifier: GPL-3.0-or-later
// A scene with everything it names, loaded and built.
#ifndef VSC_RUN_PROBLEM_H
#define VSC_RUN_PROBLEM_H

#include "fibers/fibers.h"
#include "fibers/vessels.h"
#include "io/scene.h"
#include "mech/state.h"
#include "mesh/place.h"
#include "model/model.h"

typedef struct vsc_problem {
  vsc_scene *scene;
  vsc_mesh *mesh;
  vsc_axes *axes;
  vsc_fiber_report fibers;  // where the axes came from
  vsc_vessel_report *vessels;  // of each of the scene's vessels
  vsc_place *points;           // where each of the scene's output.points lies in the mesh
  vsc_model *model;
  double input_seconds;        // wall clock of reading the scene, its mesh and its fibres
  double build_seconds;        // wall clock of building the model
  struct vsc_unloaded *unloaded;  // with prestress, once vsc_unload has found it (run/prestress.h); else NULL
} vsc_problem;

// Reads the scene `file` with the `settings` (key=value, setting_count of them), its mesh and
// fibres, and builds the model. Each tissue that lists no inclusions gets the scene's vessels as inclusions,
// in problem->scene too: VSC_INPUT where there are some in a tissue of another law than springs. Observed points are
// looked for in the mesh: VSC_INPUT for one that lies further outside than its reach. Every check that needs no time step
// is done. With prestress the
// model has the mesh for its shape at rest until vsc_unload has found that. The caller owns *problem.
vsc_status vsc_problem_load(const char *file, const char *const *settings, size_t setting_count,
                            vsc_problem **problem, vsc_error *error);

// The state that a run begins with: of the model at rest at time 0, or that which vsc_unload has found. The caller
// owns *state.
vsc_status vsc_problem_start(const vsc_problem *problem, vsc_state **state, vsc_error *error);

void vsc_problem_free(vsc_problem *problem);  // NULL is fine

// Puts the scene's file before the text of an error that does not name it yet; returns `status`.
vsc_status vsc_in_scene(const char *file, vsc_status status, vsc_error *error);

// Seconds of the wall clock and of all threads' processor time, from an arbitrary start.
double vsc_wall_seconds(void);
double vsc_cpu_seconds(void);

#endif
