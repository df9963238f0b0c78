// SPDX-License-Identifier: GPL-3.0-or-later
// VTK polydata behind plain C: the part of vtk.h that is surfaces and lines.
#ifndef VSC_IO_VTK_POLYDATA_H
#define VSC_IO_VTK_POLYDATA_H

#include "mesh/polydata.h"

// Reads polydata from .vtp or legacy .vtk, in every encoding that VTK reads. Coordinates are
// multiplied by `unit` (mm per unit), arrays are not. Triangles are kept, larger polygons are fanned
// from their first corner, strips split, polylines cut into segments; single points, and triangles and
// segments that name a point twice, are left out. Point arrays come along, cell arrays do not. VSC_INPUT with the file's name
// for a missing, truncated, empty or foreign file, one without triangles and lines, point numbers out
// of range, coordinates that are not finite, and arrays of the wrong length. The caller owns
// *polydata.
vsc_status vsc_vtk_read_polydata(const char *file, double unit, vsc_polydata **polydata,
                                 vsc_error *error);

// Writes triangles, segments (each a line of two points) and point arrays (as Float32, like the
// points) as .vtp, in the way of vsc_vtk_write_mesh.
vsc_status vsc_vtk_write_polydata(const char *file, const vsc_polydata *polydata, vsc_error *error);

#endif
