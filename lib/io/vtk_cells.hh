// SPDX-License-Identifier: GPL-3.0-or-later
// For the C++ files of this folder: a mesh's cells as VTK has them.
#ifndef VSC_IO_VTK_CELLS_HH
#define VSC_IO_VTK_CELLS_HH

#include <cstdint>

#include <vtkCellArray.h>
#include <vtkCellType.h>
#include <vtkNew.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>

extern "C" {
#include "mesh/mesh.h"
}

namespace vsc {

constexpr VTKCellType CELL_TYPES[VSC_CELLS] = {VTK_TETRA, VTK_HEXAHEDRON, VTK_WEDGE, VTK_PYRAMID,
                                               VTK_QUADRATIC_TETRA};

// VTK's corner `i` of an element: a wedge's triangles are exchanged.
inline uint32_t vtk_corner(const vsc_mesh *mesh, size_t element, size_t i)
{
  return vsc_mesh_corners(mesh, element)[mesh->kinds[element] == VSC_WEDGE ? (i + 3) % 6 : i];
}

// The elements followed by the triangles, as cells.
template <typename Array> void set_cells(vtkUnstructuredGrid *grid, const vsc_mesh *mesh)
{
  const size_t elements = mesh->element_count, triangles = mesh->triangle_count;
  const size_t corners = mesh->start[elements];
  const bool curved = mesh->triangle_mid != nullptr;
  const size_t width = curved ? 6 : 3;  // points of a triangle
  vtkNew<Array> offsets, points;
  vtkNew<vtkUnsignedCharArray> types;
  offsets->SetNumberOfValues((vtkIdType)(elements + triangles + 1));
  points->SetNumberOfValues((vtkIdType)(corners + width * triangles));
  types->SetNumberOfValues((vtkIdType)(elements + triangles));
  using number = typename Array::ValueType;
  number *start = offsets->GetPointer(0), *point = points->GetPointer(0);
  for (size_t i = 0; i <= elements; i++) start[i] = (number)mesh->start[i];
  for (size_t i = 0; i < triangles; i++)
    start[elements + i + 1] = (number)(corners + width * (i + 1));
  for (size_t i = 0; i < elements + triangles; i++)
    types->SetValue((vtkIdType)i, (unsigned char)(i < elements ? CELL_TYPES[mesh->kinds[i]]
                                                  : curved     ? VTK_QUADRATIC_TRIANGLE
                                                               : VTK_TRIANGLE));
  for (size_t e = 0; e < elements; e++)
    for (size_t i = 0; i < mesh->start[e + 1] - mesh->start[e]; i++)
      *point++ = (number)vtk_corner(mesh, e, i);
  for (size_t t = 0; t < triangles; t++) {
    for (size_t i = 0; i < 3; i++) *point++ = (number)mesh->triangles[3 * t + i];
    for (size_t i = 0; i < 3 && curved; i++) *point++ = (number)mesh->triangle_mid[3 * t + i];
  }
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, points);
  grid->SetCells(types, cells);
}

}  // namespace vsc

#endif
