// SPDX-License-Identifier: GPL-3.0-or-later
// Exact fibres of a wall between two half ellipsoids of revolution: the ventricles of the benchmarks of
// Land et al. 2015 and Arostica et al. 2025. They are known at any point, without a mesh.
//
// Between the ellipsoids lie others, with the radius rs(t) = (1-t) endo_radius + t epi_radius and the half
// length rl(t) = (1-t) endo_length + t epi_length. With rho and z, the distances of a point from the long
// axis and along it from the centre, the point lies on the one whose depth t solves
//
//   rho^2/rs(t)^2 + z^2/rl(t)^2 = 1.
//
// e_t is the outward normal of that ellipsoid, and the fibre follows the convention of fibers/helix.h with
// the angle (1-t) endo_angle + t epi_angle, counted from the circumference towards the base.
//
// Land's problem 3 (rs = 7 + 3t, rl = 17 + 3t mm): endo_angle 90, epi_angle -90 degrees. Its printed
// alpha = 90 - 180 t is this angle, for dx/du points to the base there. Arostica's (rs = 25 + 10t,
// rl = 90 + 7t mm): endo_angle 60, epi_angle -60 degrees; its printed alpha = -60 + 120 t is minus this
// angle, for e_u points to the apex. Its t solves Laplace's equation in the wall, 0 inside and 1 outside:
// vsc_fibers_helix does so when the definition names the surfaces `endo` and `epi`, and takes the ellipsoid
// only for its normal. Its sheets lie in the wall (s0 = f0 x n0, n0 = e_u x e_v): sheets_across 0. (The two depths differ by 0.2 at the apex of that ventricle, fibres by 5 degrees on
// average.)
#ifndef VSC_FIBERS_ELLIPSOID_H
#define VSC_FIBERS_ELLIPSOID_H

#include "base/status.h"
#include "mesh/select.h"
#include "model/fiber_def.h"

// Depth t of a point (mm), limited to -1 and 3, by bisection; `long_axis` points from apex to base (any
// length but 0).
double vsc_ellipsoid_depth(const vsc_ellipsoid_def *wall, const double long_axis[3],
                           const double point[3]);

// The gradient of rho^2/rs(t)^2 + z^2/rl(t)^2 (but for a factor 2) at a point: of any length, the normal
// where t is its depth, zero in the centre.
void vsc_ellipsoid_normal(const vsc_ellipsoid_def *wall, const double long_axis[3],
                          const double point[3], double t, double outwards[3]);

// The frame (rows f, s, n; s = e_t, or n = -e_t without sheets_across) of definition->ellipsoid at a point, with vsc_ellipsoid_normal and the
// angle for the depth t. Returns 0, leaving the frame alone, in the centre;
// else 1.
int vsc_ellipsoid_frame_at(const vsc_fiber_def *definition, const double point[3], double t,
                           double frame[9]);

// The same with the point's own depth. The angle of points beside
// the wall is that of its nearer side. Returns 0, leaving the frame alone, in the centre; else 1.
int vsc_ellipsoid_frame(const vsc_fiber_def *definition, const double point[3], double frame[9]);

// Counts the triangles of `surface` that face along the normal of the ellipsoids (within 60 degrees, so that the base's do
// not), and those of them whose three corners lie off both ellipsoids by more than a tenth of the wall; adds to both.
void vsc_ellipsoid_judge(const vsc_fiber_def *definition, const vsc_mesh *mesh, const vsc_surface *surface, size_t *faces,
                         size_t *off);

// VSC_INPUT when radii and lengths are not above 0 and rising from inside to outside, the long axis is
// zero or anything is not finite.
vsc_status vsc_ellipsoid_check(const vsc_fiber_def *definition, vsc_error *error);

#endif
