// SPDX-License-Identifier: GPL-3.0-or-later
#include <utility>

#include <vtkCellType.h>
#include <vtkDelaunay3D.h>
#include <vtkIdList.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkUnstructuredGrid.h>

extern "C" {
#include "base/mem.h"
#include "base/vec3.h"
#include "io/vtk_delaunay.h"
}
#include "io/vtk_quiet.hh"

namespace {

void turn_right(const double *points, uint32_t tet[4])
{
  const double *x[4];
  for (int i = 0; i < 4; i++) x[i] = points + 3 * (size_t)tet[i];
  if (vsc_tet_volume(x[0], x[1], x[2], x[3]) < 0) std::swap(tet[2], tet[3]);
}

vsc_status delaunay(size_t count, const double *points, size_t *tet_count, uint32_t **tets,
                    vsc_error *error)
{
  vsc::silence quiet;
  vtkNew<vtkPoints> places;
  places->SetDataTypeToDouble();
  for (size_t i = 0; i < count; i++) places->InsertNextPoint(points + 3 * i);
  vtkNew<vtkPolyData> cloud;
  cloud->SetPoints(places);
  vtkNew<vtkDelaunay3D> filter;
  filter->SetInputData(cloud);
  filter->SetTolerance(0);
  filter->SetOffset(20);  // the hull of plane faces is complete
  filter->Update();
  vtkUnstructuredGrid *grid = filter->GetOutput();
  const vtkIdType cells = grid->GetNumberOfCells();
  if (quiet.failed() || cells == 0)
    return vsc_fail(error, VSC_NUMERICAL, "%zu points give no tetrahedra: %s", count,
                    quiet.said().c_str());
  *tets = static_cast<uint32_t *>(vsc_alloc(4 * (size_t)cells, sizeof **tets));
  if (*tets == nullptr) return vsc_fail_memory(error, "a tetrahedralisation");
  *tet_count = 0;
  vtkNew<vtkIdList> corners;
  for (vtkIdType c = 0; c < cells; c++) {
    if (grid->GetCellType(c) != VTK_TETRA) continue;
    grid->GetCellPoints(c, corners);
    uint32_t *tet = *tets + 4 * (*tet_count)++;
    for (int i = 0; i < 4; i++) tet[i] = (uint32_t)corners->GetId(i);
    turn_right(points, tet);
  }
  return VSC_OK;
}

}  // namespace

vsc_status vsc_vtk_delaunay(size_t count, const double *points, size_t *tet_count, uint32_t **tets,
                            vsc_error *error)
{
  return vsc::guarded("points", error,
                      [&] { return delaunay(count, points, tet_count, tets, error); });
}
