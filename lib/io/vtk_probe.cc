// SPDX-License-Identifier: GPL-3.0-or-later
#include <vtkDoubleArray.h>
#include <vtkGenericCell.h>
#include <vtkIdList.h>
#include <vtkPoints.h>
#include <vtkStaticCellLocator.h>
#include <vtkTypeInt64Array.h>

extern "C" {
#include "io/vtk_probe.h"
}
#include "io/vtk_cells.hh"
#include "io/vtk_quiet.hh"

namespace {

constexpr double ROUNDING = 1e-12;  // mm

// The mesh's elements without its triangles, on its own nodes.
vtkSmartPointer<vtkUnstructuredGrid> make_grid(const vsc_mesh *mesh)
{
  vtkNew<vtkDoubleArray> places;
  places->SetNumberOfComponents(3);
  places->SetArray(mesh->nodes, (vtkIdType)(3 * mesh->node_count), 1);  // borrowed
  vtkNew<vtkPoints> points;
  points->SetData(places);
  vsc_mesh elements = *mesh;
  elements.triangle_count = 0;
  vtkNew<vtkUnstructuredGrid> grid;
  grid->SetPoints(points);
  vsc::set_cells<vtkTypeInt64Array>(grid, &elements);
  return vtkSmartPointer<vtkUnstructuredGrid>(grid.GetPointer());
}

// Looks at all elements that reach as near to `at` as `place` is: a better one takes its place.
void improve(const vsc_mesh *mesh, vtkStaticCellLocator *locator, const double at[3], vtkIdList *near,
             vsc_place *place)
{
  const double reach = place->distance;
  double box[6];
  for (int a = 0; a < 3; a++) {
    box[2 * a] = at[a] - reach;
    box[2 * a + 1] = at[a] + reach;
  }
  locator->FindCellsWithinBounds(box, near);
  for (vtkIdType i = 0; i < near->GetNumberOfIds() && place->distance > ROUNDING; i++) {
    vsc_place other;
    vsc_place_within(mesh, (size_t)near->GetId(i), at, &other);
    if (other.distance < place->distance) *place = other;
  }
}

vsc_status probe(const vsc_mesh *mesh, size_t count, const double *points, vsc_place *places,
                 vsc_error *error)
{
  vsc::silence quiet;
  vtkSmartPointer<vtkUnstructuredGrid> grid = make_grid(mesh);
  vtkNew<vtkStaticCellLocator> locator;
  locator->SetDataSet(grid);
  locator->BuildLocator();
  vtkNew<vtkGenericCell> cell;
  vtkNew<vtkIdList> near;
  for (size_t i = 0; i < count; i++) {
    double at[3] = {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
    double local[3], weights[VSC_MOST_CORNERS], nearest[3], square;
    int part;
    vtkIdType element = locator->FindCell(at, 0, cell, local, weights);
    if (element < 0) locator->FindClosestPoint(at, nearest, cell, element, part, square);
    if (element < 0 || (size_t)element >= mesh->element_count)
      return vsc_fail(error, VSC_SYSTEM, "VTK finds no element near (%g, %g, %g) mm: %s", at[0], at[1],
                      at[2], quiet.said().c_str());
    vsc_place_within(mesh, (size_t)element, at, &places[i]);
    if (places[i].distance > ROUNDING) improve(mesh, locator, at, near, &places[i]);
  }
  return VSC_OK;
}

}  // namespace

vsc_status vsc_vtk_probe(const vsc_mesh *mesh, size_t count, const double *points, vsc_place *places,
                         vsc_error *error)
{
  return vsc::guarded("a mesh", error, [&] { return probe(mesh, count, points, places, error); });
}
