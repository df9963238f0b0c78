// SPDX-License-Identifier: GPL-3.0-or-later
// Reading; vtk_write.cc writes.
#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkGenericCell.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkStructuredPoints.h>
#include <vtkStructuredPointsReader.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkUnstructuredGridReader.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

extern "C" {
#include "io/vtk.h"
}
#include "io/vtk_read.hh"

namespace {

using vsc::add_arrays;
using vsc::check_file;
using vsc::copy_array;
using vsc::ends_with;
using vsc::fail_read;
using vsc::guarded;
using vsc::read_legacy;
using vsc::read_xml;
using vsc::silence;

using owned_mesh = std::unique_ptr<vsc_mesh, decltype(&vsc_mesh_free)>;
using owned_image = std::unique_ptr<vsc_image, decltype(&vsc_image_free)>;

// The cells of a grid, sorted by what they are good for.
struct sorted_cells {
  std::vector<uint32_t> elements, surface;  // numbers of the cells: volumes; triangles and quads
  std::vector<uint8_t> kinds;               // of the elements: vsc_cell
  std::map<int, size_t> others;             // VTK cell type: count
};

std::string cell_kind(int type)
{
  static const std::map<int, const char *> names = {
    {VTK_EMPTY_CELL, "empty cells"}, {VTK_VERTEX, "vertices"}, {VTK_POLY_VERTEX, "point clouds"},
    {VTK_LINE, "lines"}, {VTK_POLY_LINE, "polylines"}, {VTK_TRIANGLE_STRIP, "triangle strips"},
    {VTK_POLYGON, "polygons"}, {VTK_PIXEL, "pixels"}, {VTK_QUADRATIC_TRIANGLE, "quadratic triangles"},
    {VTK_POLYHEDRON, "polyhedra"}, {VTK_QUADRATIC_HEXAHEDRON, "quadratic hexahedra"},
    {VTK_QUADRATIC_WEDGE, "quadratic wedges"}, {VTK_QUADRATIC_PYRAMID, "quadratic pyramids"}};
  const auto name = names.find(type);
  return name != names.end() ? name->second : "cells of VTK type " + std::to_string(type);
}

std::string describe(const std::map<int, size_t> &cells)
{
  std::string text;
  for (const auto &[type, count] : cells)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + cell_kind(type);
  return text;
}

// How VTK numbers the corners of what becomes an element here. Its wedges have their first triangle
// on top (seen along the way in which its corners turn), ours below.
struct corner_order {
  int type;
  vsc_cell kind;
  unsigned count;
  unsigned corners[VSC_MOST_CORNERS];
};

const corner_order ELEMENT_TYPES[] = {
  {VTK_TETRA, VSC_TET, 4, {0, 1, 2, 3}},
  {VTK_HEXAHEDRON, VSC_HEX, 8, {0, 1, 2, 3, 4, 5, 6, 7}},
  {VTK_VOXEL, VSC_HEX, 8, {0, 1, 3, 2, 4, 5, 7, 6}},
  {VTK_WEDGE, VSC_WEDGE, 6, {3, 4, 5, 0, 1, 2}},
  {VTK_PYRAMID, VSC_PYRAMID, 5, {0, 1, 2, 3, 4}},
  {VTK_QUADRATIC_TETRA, VSC_TET10, 10, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9}},
};

// Triangles of a surface cell. Of a quadratic one the corners: its middles are the elements'.
const corner_order SURFACE_TYPES[] = {{VTK_TRIANGLE, VSC_TET, 3, {0, 1, 2}},
                                      {VTK_QUAD, VSC_TET, 4, {0, 1, 2, 3}},
                                      {VTK_QUADRATIC_TRIANGLE, VSC_TET10, 6, {0, 1, 2, 3, 4, 5}}};

template <size_t N> const corner_order *find_type(const corner_order (&types)[N], int type)
{
  for (const corner_order &order : types)
    if (order.type == type) return &order;
  return nullptr;
}

// The point numbers of a cell as its type orders them, checked.
template <typename Id>
vsc_status read_cell(const char *file, const Id *offsets, const Id *points, size_t point_count,
                     uint32_t cell, const corner_order *order, uint32_t to[VSC_MOST_CORNERS],
                     vsc_error *error)
{
  if (offsets[cell + 1] - offsets[cell] != (Id)order->count)
    return vsc_fail(error, VSC_INPUT,
                    "%s: cell %u has %lld points, its type says %u: write it again", file, cell,
                    (long long)(offsets[cell + 1] - offsets[cell]), order->count);
  for (unsigned i = 0; i < order->count; i++) {
    const Id point = points[offsets[cell] + order->corners[i]];
    if (point < 0 || (size_t)point >= point_count)
      return vsc_fail(error, VSC_INPUT,
                      "%s: cell %u names point %lld, the file has points 0 to %zu: mesh again",
                      file, cell, (long long)point, point_count - 1);
    to[i] = (uint32_t)point;
  }
  return VSC_OK;
}

template <typename Array>
vsc_status copy_connectivity(const char *file, Array *offsets, Array *points,
                             const unsigned char *types, const sorted_cells &cells,
                             size_t cell_count, vsc_mesh *mesh, vsc_error *error)
{
  const auto *start = offsets->GetPointer(0);
  bool sound = (size_t)offsets->GetNumberOfValues() == cell_count + 1 && start[0] >= 0 &&
               start[cell_count] <= points->GetNumberOfValues();
  for (size_t i = 0; sound && i < cell_count; i++) sound = start[i] <= start[i + 1];
  if (!sound)
    return vsc_fail(error, VSC_INPUT,
                    "%s: the list of its cells contradicts itself: write it again", file);
  const auto *numbers = points->GetPointer(0);
  uint32_t corner[VSC_MOST_CORNERS], *to = mesh->corners;
  for (const uint32_t cell : cells.elements) {
    const corner_order *order = find_type(ELEMENT_TYPES, types[cell]);
    const vsc_status status =
      read_cell(file, start, numbers, mesh->node_count, cell, order, corner, error);
    if (status != VSC_OK) return status;
    to = std::copy(corner, corner + order->count, to);
  }
  to = mesh->triangles;
  for (const uint32_t cell : cells.surface) {
    const corner_order *order = find_type(SURFACE_TYPES, types[cell]);
    const vsc_status status =
      read_cell(file, start, numbers, mesh->node_count, cell, order, corner, error);
    if (status != VSC_OK) return status;
    // a quad is cut as vsc_boundary cuts it
    if (order->count == 4) std::rotate(corner, std::min_element(corner, corner + 4), corner + 4);
    const unsigned corners = order->kind == VSC_TET10 ? 3 : order->count;
    for (unsigned cut = 0; cut + 2 < corners; cut++)
      for (const unsigned i : {0u, cut + 1, cut + 2}) *to++ = corner[i];
  }
  return VSC_OK;
}

// Quadratic triangles are faces of quadratic elements; alone they are nothing that could be computed on.
void ignore_lone_triangles(const unsigned char *types, sorted_cells &cells)
{
  if (std::find(cells.kinds.begin(), cells.kinds.end(), VSC_TET10) != cells.kinds.end()) return;
  const auto end = std::remove_if(cells.surface.begin(), cells.surface.end(), [&](uint32_t cell) {
    return types[cell] == VTK_QUADRATIC_TRIANGLE;
  });
  if (end == cells.surface.end()) return;
  cells.others[VTK_QUADRATIC_TRIANGLE] += (size_t)(cells.surface.end() - end);
  cells.surface.erase(end, cells.surface.end());
}

// Volumes that would be holes.
vsc_status refuse_volumes(const char *file, const sorted_cells &cells, vsc_error *error)
{
  std::map<int, size_t> volumes;
  for (const auto &[type, count] : cells.others) {
    const vtkSmartPointer<vtkCell> cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
    if (cell != nullptr && cell->GetCellDimension() == 3) volumes[type] = count;
  }
  if (volumes.empty()) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: %.200s would be left out: volumes are linear tetrahedra, hexahedra, wedges and pyramids, or "
                  "quadratic tetrahedra; cut the others into these (ParaView: Tetrahedralize)",
                  file, describe(volumes).c_str());
}

vsc_status sort_cells(const char *file, vtkUnstructuredGrid *grid, sorted_cells &cells,
                      vsc_error *error)
{
  const size_t points = (size_t)grid->GetNumberOfPoints();
  const size_t count = (size_t)grid->GetNumberOfCells();
  vtkUnsignedCharArray *types = grid->GetCellTypesArray();
  if (points == 0 || count == 0 || types == nullptr)
    return vsc_fail(error, VSC_INPUT,
                    "%s: holds %zu points and %zu cells: an organ's mesh is needed", file, points,
                    count);
  if (points > UINT32_MAX || count > INT32_MAX || (size_t)types->GetNumberOfValues() != count)
    return vsc_fail(error, VSC_INPUT,
                    "%s: %zu points and %zu cells of %lld types are too many or contradict: use a "
                    "smaller mesh",
                    file, points, count, (long long)types->GetNumberOfValues());
  for (size_t i = 0; i < count; i++) {
    const int type = types->GetValue((vtkIdType)i);
    if (const corner_order *order = find_type(ELEMENT_TYPES, type)) {
      cells.elements.push_back((uint32_t)i);
      cells.kinds.push_back((uint8_t)order->kind);
    } else if (find_type(SURFACE_TYPES, type) != nullptr) {
      cells.surface.push_back((uint32_t)i);
    } else {
      cells.others[type]++;
    }
  }
  ignore_lone_triangles(types->GetPointer(0), cells);
  if (!cells.elements.empty() || !cells.surface.empty()) return refuse_volumes(file, cells, error);
  return vsc_fail(error, VSC_INPUT,
                  "%s: holds no tetrahedra, hexahedra, wedges, pyramids or triangles (%.200s): mesh "
                  "the organ's volume",
                  file, describe(cells.others).c_str());
}

// For each triangle the cell it comes from; a quad gives two.
std::vector<uint32_t> cells_of_triangles(const unsigned char *types, const sorted_cells &cells)
{
  std::vector<uint32_t> from;
  for (const uint32_t cell : cells.surface)
    from.insert(from.end(), types[cell] == VTK_QUAD ? 2 : 1, cell);
  return from;
}

vsc_status fill_mesh(const char *file, vtkUnstructuredGrid *grid, const sorted_cells &cells,
                     double unit, vsc_mesh *mesh, vsc_error *error)
{
  const size_t count = (size_t)grid->GetNumberOfCells();
  const unsigned char *types = grid->GetCellTypesArray()->GetPointer(0);
  copy_array(grid->GetPoints()->GetData(), mesh->node_count, nullptr, mesh->nodes);
  for (size_t i = 0; i < 3 * mesh->node_count; i++) mesh->nodes[i] *= unit;
  vtkCellArray *list = grid->GetCells();
  vsc_status status =
    list->IsStorage64Bit()
      ? copy_connectivity(file, list->GetOffsetsArray64(), list->GetConnectivityArray64(), types,
                          cells, count, mesh, error)
      : copy_connectivity(file, list->GetOffsetsArray32(), list->GetConnectivityArray32(), types,
                          cells, count, mesh, error);
  if (status == VSC_OK)
    status = add_arrays(file, grid->GetPointData(), mesh->node_count, nullptr, &mesh->node_data,
                        error);
  if (status == VSC_OK)
    status = add_arrays(file, grid->GetCellData(), count, &cells.elements, &mesh->element_data, error);
  const std::vector<uint32_t> surface = cells_of_triangles(types, cells);
  if (status == VSC_OK && !surface.empty())
    status = add_arrays(file, grid->GetCellData(), count, &surface, &mesh->triangle_data, error);
  if (status != VSC_OK) return status;
  std::copy(cells.elements.begin(), cells.elements.end(), mesh->element_source);
  mesh->report.file_nodes = mesh->node_count;
  mesh->report.file_cells = count;
  mesh->report.ignored_cells = count - cells.elements.size() - cells.surface.size();
  std::snprintf(mesh->report.ignored_kinds, sizeof mesh->report.ignored_kinds, "%s",
                describe(cells.others).c_str());
  return vsc_mesh_clean(mesh, file, error);
}

vsc_status read_mesh(const char *file, double unit, vsc_mesh **mesh, vsc_error *error)
{
  vsc_status status = check_file(file, ".vtu", error);
  if (status != VSC_OK) return status;
  silence quiet;
  static const char wanted[] =
    "an UnstructuredGrid is needed: mesh the organ's volume";
  vtkSmartPointer<vtkDataObject> object;
  status = ends_with(file, ".vtk")
             ? read_legacy<vtkUnstructuredGridReader>(file, VTK_UNSTRUCTURED_GRID, wanted, quiet,
                                                      object, error)
             : read_xml<vtkXMLUnstructuredGridReader>(file, "UnstructuredGrid", wanted, quiet,
                                                      object, error);
  if (status != VSC_OK) return status;
  vtkUnstructuredGrid *grid = vtkUnstructuredGrid::SafeDownCast(object);
  if (grid == nullptr) return fail_read(file, quiet, error);
  sorted_cells cells;
  status = sort_cells(file, grid, cells, error);
  if (status != VSC_OK) return status;
  const unsigned char *types = grid->GetCellTypesArray()->GetPointer(0);
  owned_mesh made(vsc_mesh_create_cells((size_t)grid->GetNumberOfPoints(), cells.elements.size(),
                                        cells.kinds.data(), cells_of_triangles(types, cells).size()),
                  vsc_mesh_free);
  if (made == nullptr) return vsc_fail_memory(error, "the mesh");
  status = fill_mesh(file, grid, cells, unit, made.get(), error);
  if (status == VSC_OK) *mesh = made.release();
  return status;
}

double determinant(const double d[9])
{
  return d[0] * (d[4] * d[8] - d[5] * d[7]) - d[1] * (d[3] * d[8] - d[5] * d[6]) +
         d[2] * (d[3] * d[7] - d[4] * d[6]);
}

// Gives `image` the places of the points of `grid`, or of its cell centres. VTK's extent may begin
// anywhere, its spacing may be negative and the columns of its direction of any length.
vsc_status place_image(const char *file, vtkImageData *grid, bool on_cells, double unit,
                       vsc_image *image, vsc_error *error)
{
  double first[3], position[3];
  for (int axis = 0; axis < 3; axis++) {
    const int *ends = grid->GetExtent() + 2 * axis;
    const bool flat = ends[0] == ends[1];
    double column[3];
    for (int row = 0; row < 3; row++)
      column[row] = grid->GetDirectionMatrix()->GetElement(row, axis);
    const double length = std::hypot(column[0], column[1], column[2]);
    double step = grid->GetSpacing()[axis] * length * unit;
    if (flat && step == 0) step = unit;
    for (int row = 0; row < 3; row++)
      image->direction[3 * row + axis] = length > 0 ? std::copysign(1, step) * column[row] / length : 0;
    image->spacing[axis] = std::fabs(step);
    image->origin[axis] = grid->GetOrigin()[axis] * unit;
    first[axis] = ends[0] + (on_cells && !flat ? 0.5 : 0);
    if (!(image->spacing[axis] > 0) || !std::isfinite(image->spacing[axis] + image->origin[axis]))
      return vsc_fail(error, VSC_INPUT,
                      "%s: spacing %g and origin %g along axis %d mean nothing: correct them", file,
                      grid->GetSpacing()[axis], grid->GetOrigin()[axis], axis);
  }
  if (!(std::fabs(determinant(image->direction)) > 1e-3))
    return vsc_fail(error, VSC_INPUT,
                    "%s: the axes of its direction matrix lie in one plane: correct it", file);
  vsc_image_position(image, first, position);
  std::memcpy(image->origin, position, sizeof position);
  return VSC_OK;
}

vsc_status read_image(const char *file, double unit, vsc_image **image, vsc_error *error)
{
  vsc_status status = check_file(file, ".vti", error);
  if (status != VSC_OK) return status;
  silence quiet;
  static const char wanted[] = "an ImageData is needed: resample the data onto an image";
  vtkSmartPointer<vtkDataObject> object;
  status = ends_with(file, ".vtk")
             ? read_legacy<vtkStructuredPointsReader>(file, VTK_STRUCTURED_POINTS, wanted, quiet,
                                                      object, error)
             : read_xml<vtkXMLImageDataReader>(file, "ImageData", wanted, quiet, object, error);
  if (status != VSC_OK) return status;
  vtkImageData *grid = vtkImageData::SafeDownCast(object);
  if (grid == nullptr) return fail_read(file, quiet, error);

  const bool on_cells = grid->GetPointData()->GetNumberOfArrays() == 0;
  size_t size[3], places = 1, cells = 1;
  for (int axis = 0; axis < 3; axis++) {
    const int points = grid->GetDimensions()[axis];
    const size_t between = (size_t)(points > 1 ? points - 1 : points);
    size[axis] = on_cells ? between : (size_t)points;
    places *= size[axis];
    cells *= between;
  }
  if (places == 0) return vsc_fail(error, VSC_INPUT, "%s: holds no voxels: write it again", file);
  owned_image made(vsc_image_create(size), vsc_image_free);
  if (made == nullptr) return vsc_fail_memory(error, "the image");
  status = place_image(file, grid, on_cells, unit, made.get(), error);
  vtkDataSetAttributes *data = grid->GetPointData();
  if (on_cells) data = grid->GetCellData();
  if (status == VSC_OK) status = add_arrays(file, data, places, nullptr, &made->data, error);
  if (status == VSC_OK && !on_cells)
    status = add_arrays(file, grid->GetCellData(), cells, nullptr, &made->cell_data, error);
  if (status == VSC_OK && made->data.count == 0)
    status = vsc_fail(error, VSC_INPUT, "%s: holds no numeric arrays: write it with data", file);
  if (status == VSC_OK) *image = made.release();
  return status;
}

}  // namespace

// Lengths that mean something.
static vsc_status check_unit(const char *file, double unit, vsc_error *error)
{
  if (std::isfinite(unit) && unit > 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT, "%s: a unit of %g mm means nothing; give a length above zero", file, unit);
}

vsc_status vsc_vtk_read_mesh(const char *file, double unit, vsc_mesh **mesh, vsc_error *error)
{
  const vsc_status status = check_unit(file, unit, error);
  return status == VSC_OK ? guarded(file, error, [&] { return read_mesh(file, unit, mesh, error); }) : status;
}

vsc_status vsc_vtk_read_image(const char *file, double unit, vsc_image **image, vsc_error *error)
{
  const vsc_status status = check_unit(file, unit, error);
  return status == VSC_OK ? guarded(file, error, [&] { return read_image(file, unit, image, error); }) : status;
}
