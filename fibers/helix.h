// SPDX-License-Identifier: GPL-3.0-or-later
// Rule-based fibres of a ventricle: a helix whose angle changes linearly through the wall.
//
// Convention. At a point of the wall, e_t points from endocardium to epicardium, e_l from apex to
// base along the wall, e_c = e_l x e_t along the circumference, anti-clockwise when the base is
// looked down upon (for the long axis z and a point on +x: e_t = x, e_l = z, e_c = y). The fibre is
// f = cos(a) e_c + sin(a) e_l, so that a positive helix angle a is a right-handed helix: the normal
// heart has about +60 degrees at the endocardium and -60 at the epicardium (Streeter 1969). This is
// the field of the benchmark of Arostica et al. 2025, which writes alpha = -60 at the endocardium
// because its longitudinal unit vector points to the apex.
#ifndef VSC_FIBERS_HELIX_H
#define VSC_FIBERS_HELIX_H

#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "mesh/select.h"
#include "model/fiber_def.h"

// The frame (rows f, s, n) at a point of the wall. `transmural` points outwards (any length),
// `long_axis` from apex to base (any length), `angle` is the helix angle in radians. e_l is the
// part of the long axis orthogonal to e_t; where the two are parallel (within 0.06 degrees, at the
// apex) the global axis with the smallest |component| of e_t takes the long axis's place. s = e_t,
// which is orthogonal to f by construction; n = f x s. Returns 0, leaving the frame alone, when
// `transmural` or `long_axis` is zero or not finite; else 1.
int vsc_helix_frame(const double transmural[3], const double long_axis[3], double angle,
                    double frame[9]);

// Depth t of every node (depth: node_count, owned by the caller): the solution of div grad t = 0 on
// linear tets (elements of other kinds are cut into some, vsc_mesh_split) or on quadratic ones, t = 0 on the nodes of
// `endo`, 1 on those of `epi`, 0.5 on nodes of both, no flux elsewhere; solved by CHOLMOD.
// VSC_INPUT when a part of the mesh touches neither surface.
vsc_status vsc_helix_depth(const vsc_mesh *mesh, const vsc_surface *endo, const vsc_surface *epi,
                           double *depth, vsc_error *error);

// Axes of every element from the depth: e_t = the mean of grad t over it (where that vanishes,
// because all its nodes lie on one surface, the volume-weighted mean gradient of the elements round
// its nodes), helix angle linear in the mean depth of its nodes from definition->endo_angle to
// definition->epi_angle; of quadratic tets with depth and gradient at each point. Elements without any gradient stay unknown. VSC_INPUT for a zero long
// axis.
// Of the source ELLIPSOID e_t is the ellipsoid's normal instead (vsc_ellipsoid_frame_at).
vsc_status vsc_fibers_helix(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                            const vsc_surface *endo, const vsc_surface *epi, vsc_axes *axes,
                            vsc_error *error);

#endif
