// SPDX-License-Identifier: GPL-3.0-or-later
// Reading; vtk_write.cc writes.
#include <strings.h>
#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <vtkBitArray.h>
#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkCharArray.h>
#include <vtkDataArray.h>
#include <vtkDataObjectTypes.h>
#include <vtkGenericDataObjectReader.h>
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
#include <vtkXMLFileReadTester.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLUnstructuredGridReader.h>

extern "C" {
#include "io/vtk.h"
#include "io/vtk_legacy.h"
}
#include "io/vtk_quiet.hh"

namespace {

using vsc::guarded;
using vsc::silence;

using owned_mesh = std::unique_ptr<vsc_mesh, decltype(&vsc_mesh_free)>;
using owned_image = std::unique_ptr<vsc_image, decltype(&vsc_image_free)>;

bool ends_with(const char *text, const char *ending)
{
  const size_t length = std::strlen(text), tail = std::strlen(ending);
  if (length < tail) return false;
  for (size_t i = 0; i < tail; i++)
    if (std::tolower((unsigned char)text[length - tail + i]) != ending[i]) return false;
  return true;
}

// What can be said of a file before VTK sees it. `ending` is the XML format's.
vsc_status check_file(const char *file, const char *ending, vsc_error *error)
{
  struct stat facts;
  FILE *stream = stat(file, &facts) == 0 ? std::fopen(file, "rb") : nullptr;
  if (stream == nullptr)
    return vsc_fail(error, VSC_INPUT, "%s: cannot be opened: %s: check the name", file,
                    std::strerror(errno));
  std::fclose(stream);
  if (!S_ISREG(facts.st_mode))
    return vsc_fail(error, VSC_INPUT, "%s: is not a regular file: name a %s or .vtk file", file,
                    ending);
  if (facts.st_size == 0)
    return vsc_fail(error, VSC_INPUT, "%s: is empty: write it again", file);
  if (ends_with(file, ending) || ends_with(file, ".vtk")) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: only %s and .vtk files are read here: convert it, for example in ParaView",
                  file, ending);
}

vsc_status fail_kind(const char *file, const std::string &found, const char *wanted,
                     vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT, "%s: holds a VTK %s, but %s", file, found.c_str(), wanted);
}

vsc_status fail_read(const char *file, const silence &quiet, vsc_error *error)
{
  return vsc_fail(error, VSC_INPUT,
                  "%s: is damaged or cut short (VTK: %s): write it again", file,
                  quiet.said().c_str());
}

// VTK doesn't notice when the numbers of a legacy file's last array end too soon: the missing ones
// come as whatever was in memory. So the file is read once more with a number behind its end: VTK
// must complain of just that number, or the array has swallowed some of it.
const char STRAY[] = "271828182845";

std::string load_with_stray(const char *file)
{
  std::ifstream stream(file, std::ios::binary);
  std::string text((std::istreambuf_iterator<char>(stream)), std::istreambuf_iterator<char>());
  size_t third_line = text.find('\n');
  if (third_line != std::string::npos) third_line = text.find('\n', third_line + 1);
  const bool binary = third_line != std::string::npos &&
                      strncasecmp(text.c_str() + third_line + 1, "binary", 6) == 0;
  return text + (binary ? "" : "\n") + STRAY + "\n";
}

template <typename Reader> bool breaks_off(const char *file, const silence &quiet)
{
  const std::string text = load_with_stray(file);
  vtkNew<vtkCharArray> array;
  array->SetNumberOfValues((vtkIdType)text.size());
  std::memcpy(array->GetPointer(0), text.data(), text.size());
  vtkNew<Reader> reader;
  reader->SetInputArray(array);
  reader->ReadFromInputStringOn();
  reader->Update();
  return quiet.said().find(STRAY) == std::string::npos;
}

// Reads a .vtk file of the VTK type that `Reader` reads.
template <typename Reader>
vsc_status read_legacy(const char *file, int type, const char *wanted, const silence &quiet,
                       vtkSmartPointer<vtkDataObject> &object, vsc_error *error)
{
  vtkNew<vtkGenericDataObjectReader> tester;
  tester->SetFileName(file);
  const int found = tester->ReadOutputType();
  if (found < 0)
    return vsc_fail(error, VSC_INPUT,
                    "%s: is not a legacy VTK file (VTK: %s): check its first lines", file,
                    quiet.said().c_str());
  if (found != type)
    return fail_kind(file, vtkDataObjectTypes::GetClassNameFromTypeId(found) + 3, wanted, error);
  const vsc_status status = vsc_legacy_check_cells(file, error);
  if (status != VSC_OK) return status;
  vtkNew<Reader> reader;
  reader->SetFileName(file);
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  reader->Update();
  if (quiet.failed() || reader->GetErrorCode() != 0 || breaks_off<Reader>(file, quiet))
    return fail_read(file, quiet, error);
  object = reader->GetOutput();
  return VSC_OK;
}

// Reads an XML file whose VTKFile element has the type `type`.
template <typename Reader>
vsc_status read_xml(const char *file, const char *type, const char *wanted, const silence &quiet,
                    vtkSmartPointer<vtkDataObject> &object, vsc_error *error)
{
  vtkNew<vtkXMLFileReadTester> tester;
  tester->SetFileName(file);
  if (!tester->TestReadFile() || tester->GetFileDataType() == nullptr)
    return vsc_fail(error, VSC_INPUT,
                    "%s: is not a VTK XML file: check its first lines (a legacy file's name ends "
                    "in .vtk)",
                    file);
  if (std::strcmp(tester->GetFileDataType(), type) != 0)
    return fail_kind(file, tester->GetFileDataType(), wanted, error);
  vtkNew<Reader> reader;
  reader->SetFileName(file);
  reader->Update();
  if (quiet.failed() || reader->GetErrorCode() != 0) return fail_read(file, quiet, error);
  object = reader->GetOutputDataObject(0);
  return VSC_OK;
}

// Copies tuples to doubles: those numbered in `picks`, or all when there is no list.
template <typename Number>
void copy_numbers(const Number *from, int width, size_t tuples,
                  const std::vector<uint32_t> *picks, double *to)
{
  for (size_t i = 0; i < tuples; i++) {
    const Number *tuple = from + (size_t)width * (picks != nullptr ? (*picks)[i] : i);
    for (int k = 0; k < width; k++) *to++ = (double)tuple[k];
  }
}

void copy_array(vtkDataArray *from, size_t tuples, const std::vector<uint32_t> *picks, double *to)
{
  const int width = from->GetNumberOfComponents();
  if (vtkBitArray *bits = vtkBitArray::SafeDownCast(from)) {
    for (size_t i = 0; i < tuples; i++)
      for (int k = 0; k < width; k++)
        *to++ = bits->GetComponent((vtkIdType)(picks != nullptr ? (*picks)[i] : i), k);
    return;
  }
  switch (from->GetDataType()) {
    vtkTemplateMacro(
      copy_numbers(static_cast<VTK_TT *>(from->GetVoidPointer(0)), width, tuples, picks, to));
  }
}

// Adds the numeric arrays of `attributes` (which lie on `expected` points or cells).
vsc_status add_arrays(const char *file, vtkDataSetAttributes *attributes, size_t expected,
                      const std::vector<uint32_t> *picks, vsc_arrays *arrays, vsc_error *error)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); i++) {
    vtkDataArray *array = attributes->GetArray(i);
    if (array == nullptr || array->GetName() == nullptr || array->GetNumberOfComponents() < 1)
      continue;
    if (array->GetNumberOfTuples() != (vtkIdType)expected)
      return vsc_fail(error, VSC_INPUT,
                      "%s: array %s has %lld values for %zu places: write it again", file,
                      array->GetName(), (long long)array->GetNumberOfTuples(), expected);
    const size_t tuples = picks != nullptr ? picks->size() : expected;
    vsc_array *copy =
      vsc_arrays_add(arrays, array->GetName(), array->GetNumberOfComponents(), tuples);
    if (copy == nullptr) return vsc_fail_memory(error, "the mesh's arrays");
    copy_array(array, tuples, picks, copy->values);
  }
  return VSC_OK;
}

// The cells of a grid, sorted by what they are good for.
struct sorted_cells {
  std::vector<uint32_t> elements, surface;  // numbers of the cells: volumes; triangles and quads
  std::vector<uint8_t> kinds;               // of the elements: vsc_cell
  std::map<int, size_t> others;           // VTK cell type: count
};

std::string cell_kind(int type)
{
  static const std::map<int, const char *> names = {
    {VTK_EMPTY_CELL, "empty cells"}, {VTK_VERTEX, "vertices"}, {VTK_POLY_VERTEX, "point clouds"},
    {VTK_LINE, "lines"}, {VTK_POLY_LINE, "polylines"}, {VTK_TRIANGLE, "triangles"},
    {VTK_TRIANGLE_STRIP, "triangle strips"},
    {VTK_POLYGON, "polygons"}, {VTK_PIXEL, "pixels"}, {VTK_QUAD, "quads"}, {VTK_VOXEL, "voxels"},
    {VTK_HEXAHEDRON, "hexahedra"}, {VTK_WEDGE, "wedges"}, {VTK_PYRAMID, "pyramids"},
    {VTK_QUADRATIC_TETRA, "quadratic tetrahedra"}, {VTK_QUADRATIC_TRIANGLE, "quadratic triangles"}};
  const auto name = names.find(type);
  return name != names.end() ? name->second : "cells of VTK type " + std::to_string(type);
}

std::string describe_others(const sorted_cells &cells)
{
  std::string text;
  for (const auto &[type, count] : cells.others)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + cell_kind(type);
  return text;
}

// How VTK numbers the corners of what becomes an element here.
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
  {VTK_WEDGE, VSC_WEDGE, 6, {0, 1, 2, 3, 4, 5}},
  {VTK_PYRAMID, VSC_PYRAMID, 5, {0, 1, 2, 3, 4}},
};

// Triangles of a surface cell.
const corner_order SURFACE_TYPES[] = {{VTK_TRIANGLE, VSC_TET, 3, {0, 1, 2}},
                                      {VTK_QUAD, VSC_TET, 4, {0, 1, 2, 3}}};

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
    to = std::copy(corner, corner + 3, to);
    if (order->count == 4)
      for (const int i : {0, 2, 3}) *to++ = corner[i];
  }
  return VSC_OK;
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
  if (!cells.elements.empty() || !cells.surface.empty()) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: holds no tetrahedra, hexahedra, wedges, pyramids or triangles (%.200s): mesh "
                  "the organ's volume",
                  file, describe_others(cells).c_str());
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
  mesh->report.ignored_cells = count - mesh->element_count - mesh->triangle_count;
  std::snprintf(mesh->report.ignored_kinds, sizeof mesh->report.ignored_kinds, "%s",
                describe_others(cells).c_str());
  return vsc_mesh_clean(mesh, file, error);
}

vsc_status read_mesh(const char *file, double unit, vsc_mesh **mesh, vsc_error *error)
{
  vsc_status status = check_file(file, ".vtu", error);
  if (status != VSC_OK) return status;
  silence quiet;
  static const char wanted[] = 
    "an UnstructuredGrid is needed: mesh the organ's volume with tetrahedra";
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
      image->direction[3 * row + axis] = std::copysign(1, step) * column[row] / length;
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
  size_t size[3], places = 1;
  for (int axis = 0; axis < 3; axis++) {
    const int points = grid->GetDimensions()[axis];
    size[axis] = (size_t)(on_cells && points > 1 ? points - 1 : points);
    places *= size[axis];
  }
  if (places == 0) return vsc_fail(error, VSC_INPUT, "%s: holds no voxels: write it again", file);
  owned_image made(vsc_image_create(size), vsc_image_free);
  if (made == nullptr) return vsc_fail_memory(error, "the image");
  status = place_image(file, grid, on_cells, unit, made.get(), error);
  vtkDataSetAttributes *data = grid->GetPointData();
  if (on_cells) data = grid->GetCellData();
  if (status == VSC_OK) status = add_arrays(file, data, places, nullptr, &made->data, error);
  if (status == VSC_OK && made->data.count == 0)
    status = vsc_fail(error, VSC_INPUT, "%s: holds no numeric arrays: write it with data", file);
  if (status == VSC_OK) *image = made.release();
  return status;
}

}  // namespace

vsc_status vsc_vtk_read_mesh(const char *file, double unit, vsc_mesh **mesh, vsc_error *error)
{
  return guarded(file, error, [&] { return read_mesh(file, unit, mesh, error); });
}

vsc_status vsc_vtk_read_image(const char *file, double unit, vsc_image **image, vsc_error *error)
{
  return guarded(file, error, [&] { return read_image(file, unit, image, error); });
}
