// SPDX-License-Identifier: GPL-3.0-or-later
// Fibre axes by the scene's wish, from whichever source.
#ifndef VSC_FIBERS_FIBERS_H
#define VSC_FIBERS_FIBERS_H

#include "fibers/sample.h"
#include "mesh/select.h"

// Gives every tet of `mesh` its axes. `surfaces` (surface_count) are the named surfaces, of which HELIX
// uses two. Reads the voxel map when there is one. On success *axes is owned by the caller and
// `report` (not NULL) is filled.
vsc_status vsc_fibers_make(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                           const vsc_surface *surfaces, size_t surface_count, vsc_axes **axes,
                           vsc_fiber_report *report, vsc_error *error);

#endif
