// SPDX-License-Identifier: GPL-3.0-or-later
// The shape at rest of a body whose mesh is its shape under load, as medical images are (the scene's prestress):
// of the shapes X at rest the one that the loads of prestress.time take to the mesh (solve/prestress.h, with x(X) by
// Newton's method from the mesh, over softer bodies where tissue is nearly incompressible, or from X; to solver.tolerance,
// or better where prestress.tolerance needs it).
// Surfaces, node sets, observed points and fibres belong to the mesh and so to the loaded shape: selections are made on
// it, and fibres are carried back to rest by the motion (vsc_axes_carry_back) for each X that is tried. Densities,
// thicknesses, springs on surfaces and dead tractions refer to X. Directions that supports hold stay where the mesh
// has them, supports that move are at rest where their motion has not begun.
#ifndef VSC_RUN_PRESTRESS_H
#define VSC_RUN_PRESTRESS_H

#include "run/problem.h"
#include "solve/prestress.h"

// What was found. Arrays have four numbers a node (x, y, z, 0) in the mesh's order, mm; owned.
typedef struct vsc_unloaded {
  bool found;               // else there are rows only
  double *rest;             // node_count x 4: the body without loads
  double *start;            // node_count x 4: its equilibrium under them, the mesh to within prestress.tolerance
  double furthest;          // largest distance from the mesh to `rest`, mm
  size_t row_count;
  vsc_prestress_row *rows;  // of each iteration, or the last one alone; that is of `start`
  uint64_t hash;            // of the model on the mesh and of what is asked for
} vsc_unloaded;

// Finds the shape at rest, keeps it in problem->unloaded and puts a model of it in the place of problem->model. The
// same bits for any number of threads. VSC_NUMERICAL, with how far it is off, where it is not found: the model is the
// one before then, and problem->unloaded has the rows of the iterations. VSC_INPUT where the model has no tangent.
vsc_status vsc_unload(vsc_problem *problem, vsc_error *error);

// Memory in problem->unloaded for a shape that was found in another run, and the hash that this must have had. Once
// `rest`, `start` and the last row are there vsc_unload_again puts its model in the place of problem->model, as vsc_unload
// did then.
vsc_status vsc_unloaded_create(vsc_problem *problem, vsc_error *error);
vsc_status vsc_unload_again(vsc_problem *problem, vsc_error *error);

void vsc_unloaded_free(vsc_unloaded *unloaded);  // NULL is fine

#endif
