// SPDX-License-Identifier: GPL-3.0-or-later
// viscera as a library. A C program that has a mesh and fibre axes builds a model, steps a state
// and reads fields back; VTK, HDF5 and YAML stay out of its sight. The README shows it in thirty
// lines.
//
//   vsc_mesh_from_arrays, vsc_vtk_read_mesh, vsc_mesh_raise   a mesh
//   vsc_axes_create, vsc_axes_complete, vsc_fibers_make   material axes
//   vsc_default_definition, vsc_default_material     what to simulate
//   vsc_calibrate, vsc_material_of_springs           springs for wanted moduli
//   vsc_model_build                                  the immutable model
//   vsc_state_create, vsc_start, vsc_advance         the moving state, explicitly
//   vsc_solve_start, vsc_solve_to                    the same by the model's method
//   vsc_read_field, vsc_observe                      what to see of it
//   vsc_problem_load, vsc_unload, vsc_run            or everything at once, from a scene file
//
// Units: mm, ms, mg, kPa, mN, uJ. Functions return vsc_status and fill a vsc_error.
#ifndef VISCERA_H
#define VISCERA_H

#include "base/mem.h"
#include "base/parallel.h"
#include "base/status.h"
#include "fibers/fibers.h"
#include "io/scene.h"
#include "io/vtk.h"
#include "mech/observe.h"
#include "mech/state.h"
#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "mesh/surface.h"
#include "mesh/wound.h"
#include "model/calibration.h"
#include "model/definition.h"
#include "model/model.h"
#include "run/check.h"
#include "run/prestress.h"
#include "run/problem.h"
#include "run/run.h"
#include "solve/explicit.h"
#include "solve/mass_scaling.h"
#include "solve/solve.h"

#endif
