// SPDX-License-Identifier: GPL-3.0-or-later
// Fibre fields by formula, for tests and for the figures of Bourguignon & Cani 2000. Each is
// evaluated at the centre of the element, of quadratic tets at each point of theirs; x0 and x1 are the corners of the box round the mesh.
#ifndef VSC_FIBERS_SYNTHETIC_H
#define VSC_FIBERS_SYNTHETIC_H

#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "model/fiber_def.h"

// Fills all of `axes` (mesh->element_count) for definition->source:
//   CONSTANT      f along `direction`, sheet hint `sheet_direction` (zero: by rule)
//   HORIZONTAL    f = (1, 0, 0), sheet by rule
//   DIAGONAL      f = (1, 0, 1) / sqrt 2, sheet by rule
//   HEMICIRCULAR  r = (x - xm, 0, z - z0) from the bottom middle of the box,
//                 f = (r_z, 0, -r_x) / |r|, sheet hint r; at r = 0 f = (1, 0, 0)
//   HELICOIDAL    r = (x - xm, y - ym, 0) from the vertical mid-line, sheet hint r,
//                 f = cos p (-r_y, r_x, 0) / |r| + sin p (0, 0, 1) with p = `pitch`; on the
//                 line f = (0, 0, 1)
//   RANDOM        uniform on the sphere, one draw per element in the mesh's order, from the Mersenne
//                 twister of GSL with `seed`; sheet by rule
//   ELLIPSOID     the frame of fibers/ellipsoid.h at that place
// VSC_INPUT for another source, what vsc_ellipsoid_check refuses, a zero or non-finite direction or a non-finite pitch.
vsc_status vsc_fibers_synthetic(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                                vsc_axes *axes, vsc_error *error);

#endif
