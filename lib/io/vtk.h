// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's grids and images behind plain C. One of four doors to VTK (vtk_polydata.h, vtk_delaunay.h,
// vtk_probe.h); no exception and no VTK message gets through.
// Calls from several threads are served one after the other.
#ifndef VSC_IO_VTK_H
#define VSC_IO_VTK_H

#include <stdbool.h>

#include "mesh/image.h"
#include "mesh/mesh.h"

// Reads an unstructured grid from .vtu or legacy .vtk, in every encoding that VTK reads, and cleans
// it (vsc_mesh_clean). Coordinates are multiplied by `unit` (mm per unit). Tetrahedra, hexahedra
// (voxels too), wedges, pyramids and quadratic tetrahedra become elements; triangles, quads (cut in two
// as vsc_boundary cuts them) and, beside quadratic tetrahedra, quadratic triangles become surface
// triangles; other points, lines and faces are counted and ignored, other volumes are VSC_INPUT. Wedges are expected as
// VTK draws them, the first triangle turning counter-clockwise seen from outside; others are turned.
// Every numeric point array comes as node data, every numeric cell array as element data and as
// triangle data, `single` where it is Float32. VSC_INPUT with the file's name for a missing, truncated, empty or foreign file,
// arrays of the wrong length, a unit that is not above zero and all that vsc_mesh_clean refuses. The caller owns *mesh.
vsc_status vsc_vtk_read_mesh(const char *file, double unit, vsc_mesh **mesh, vsc_error *error);

// Reads an image (.vti, or legacy .vtk structured points), origin, spacing and direction honoured,
// lengths multiplied by `unit`. A file with arrays on its cells alone comes as the image of the cells' centres; of one
// with both kinds those on cells come as cell_data (vsc_image_take_cells). Errors as above; an image without numeric
// arrays is one, and one whose pieces do not fill it. The caller owns *image.
vsc_status vsc_vtk_read_image(const char *file, double unit, vsc_image **image, vsc_error *error);

// What an array to write lies on.
typedef enum vsc_vtk_place {
  VSC_ON_NODES,
  VSC_ON_ELEMENTS,
  VSC_ON_TRIANGLES,
} vsc_vtk_place;

// One array to write, borrowed for the call.
typedef struct vsc_vtk_array {
  const char *name;
  int components;        // of a tuple: 1, 3, 6 ...
  const double *values;  // a tuple for each node, element or triangle
  vsc_vtk_place place;
  bool integer;          // written as Int32
} vsc_vtk_array;

// Writes a mesh's nodes, elements, triangles (behind the elements; with their middles where the mesh has
// them) and the given arrays as .vtu:
// inline binary (Debian 12's ParaView cannot read appended data since its expat was updated), zlib, UInt64
// headers, Float32 or (double_precision) Float64; to a temporary name in the same folder, renamed
// when complete. Arrays on elements are 0 on the triangles, and the other way round. The mesh's own
// arrays are not written. VSC_SYSTEM when the file cannot be written; what was there before stays
// then.
vsc_status vsc_vtk_write_mesh(const char *file, const vsc_mesh *mesh, size_t array_count,
                              const vsc_vtk_array *arrays, bool double_precision, vsc_error *error);

// Writes an image with its data, without cell_data, as .vti, in the same way; arrays are Float32.
vsc_status vsc_vtk_write_image(const char *file, const vsc_image *image, vsc_error *error);

#endif
