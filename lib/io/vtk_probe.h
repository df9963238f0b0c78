// SPDX-License-Identifier: GPL-3.0-or-later
// Many points found in a mesh, by VTK's search structure.
#ifndef VSC_IO_VTK_PROBE_H
#define VSC_IO_VTK_PROBE_H

#include "mesh/place.h"

// places[i] = the place of the mesh nearest to points[3 i .. 3 i + 2] (mm), by vsc_place_within in the
// element in which VTK finds the point or which it says is nearest (VTK's cells reach a thousandth of their
// size beyond their faces), and in all that are as near. What vsc_place_find is for few points. The mesh
// has elements; `places` has room for `count`. VSC_SYSTEM when VTK fails.
vsc_status vsc_vtk_probe(const vsc_mesh *mesh, size_t count, const double *points, vsc_place *places,
                         vsc_error *error);

#endif
