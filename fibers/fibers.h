// SPDX-License-Identifier: GPL-3.0-or-later
// Fibre axes by the scene's wish, from whichever source.
#ifndef VSC_FIBERS_FIBERS_H
#define VSC_FIBERS_FIBERS_H

#include "fibers/sample.h"
#include "mesh/select.h"

// Gives every element of `mesh` its axes. `surfaces` (surface_count) are the named surfaces, of which
// HELIX uses two: triangles of both are the endocardium's, and an epicardium that has no others is VSC_INPUT. Reads
// the voxel map when there is one, from the points of its image or, where all its arrays lie there, from the cells. On
// success *axes is owned by the caller and `report` (not NULL) is filled.
// Sheet and normal: by the rule of vsc_axes_complete, with the sheet hint that the source gives (ARRAYS: the
// sheet array; HELIX, ELLIPSOID: the transmural axis; see fibers/synthetic.h).
//
// ARRAYS: a missing fibre array is VSC_INPUT that names those there are; so is a missing sheet
// array, unless its name is the default "sheet": then sheets follow the rule. Fibres that are zero
// (below 1e-6) or not finite are none: the element is passive, unless `fill` is set. The
// vectors may be on the nodes instead: quadratic tets interpolate them at each of their points, other
// elements take the mean of their corners. Their lengths count for nothing. Their sense is ignored, as measured fibres
// want it (the axis is the top eigenvector of the mean of f f^T), or kept, as rules for coarse walls mean it: from -60
// to +60 degrees through 0, not through 90.
vsc_status vsc_fibers_make(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                           const vsc_surface *surfaces, size_t surface_count, vsc_axes **axes,
                           vsc_fiber_report *report, vsc_error *error);

#endif
