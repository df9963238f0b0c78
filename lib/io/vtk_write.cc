// SPDX-License-Identifier: GPL-3.0-or-later
// The writing half of vtk.h.
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkCellType.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkInformation.h>
#include <vtkIntArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkTypeInt32Array.h>
#include <vtkTypeInt64Array.h>
#include <vtkUnsignedCharArray.h>
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

extern "C" {
#include "io/replace.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
}
#include "io/vtk_quiet.hh"

namespace {

using vsc::guarded;
using vsc::silence;

// zlib's quickest level: a frame's numbers are hardly smaller at the higher ones, which take
// several times as long.
constexpr int COMPRESSION_LEVEL = 1;

int to_int(double value)
{
  if (std::isnan(value)) return 0;
  return (int)std::lrint(std::fmin(std::fmax(value, INT_MIN), INT_MAX));
}

// A VTK array of type `Array` with `given` tuples of values, followed by zeros up to `tuples`.
template <typename Array>
vtkSmartPointer<vtkDataArray> make_array(const char *name, int components, size_t given,
                                         size_t tuples, const double *values)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples((vtkIdType)tuples);
  auto *to = array->GetPointer(0);
  const size_t numbers = given * (size_t)components, all = tuples * (size_t)components;
  for (size_t i = 0; i < numbers; i++) {
    if constexpr (std::is_same_v<Array, vtkIntArray>) to[i] = to_int(values[i]);
    else to[i] = static_cast<typename Array::ValueType>(values[i]);
  }
  for (size_t i = numbers; i < all; i++) to[i] = 0;
  return vtkSmartPointer<vtkDataArray>(array.GetPointer());
}

vtkSmartPointer<vtkDataArray> make_real(const char *name, int components, size_t given,
                                        size_t tuples, const double *values, bool double_precision)
{
  return double_precision
           ? make_array<vtkDoubleArray>(name, components, given, tuples, values)
           : make_array<vtkFloatArray>(name, components, given, tuples, values);
}

// The tets followed by the triangles, as cells.
template <typename Array>
void set_cells(vtkUnstructuredGrid *grid, size_t element_count, const uint32_t *tets,
               size_t triangle_count, const uint32_t *triangles)
{
  const size_t corners = 4 * element_count + 3 * triangle_count;
  vtkNew<Array> offsets, points;
  vtkNew<vtkUnsignedCharArray> types;
  offsets->SetNumberOfValues((vtkIdType)(element_count + triangle_count + 1));
  points->SetNumberOfValues((vtkIdType)corners);
  types->SetNumberOfValues((vtkIdType)(element_count + triangle_count));
  using number = typename Array::ValueType;
  number *start = offsets->GetPointer(0), *point = points->GetPointer(0);
  start[0] = 0;
  for (size_t i = 0; i < element_count + triangle_count; i++) {
    start[i + 1] = start[i] + (i < element_count ? 4 : 3);
    types->SetValue((vtkIdType)i, i < element_count ? VTK_TETRA : VTK_TRIANGLE);
  }
  for (size_t i = 0; i < 4 * element_count; i++) *point++ = (number)tets[i];
  for (size_t i = 0; i < 3 * triangle_count; i++) *point++ = (number)triangles[i];
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, points);
  grid->SetCells(types, cells);
}

// VTK's writer without the ranges that it stores beside inline arrays: readers, ParaView's too,
// stumble over those that are infinite, and need none.
template <typename Writer> class plain : public Writer {
public:
  static plain *New() { VTK_STANDARD_NEW_BODY(plain); }

protected:
  void WriteInlineData(vtkAbstractArray *array, vtkIndent indent) override
  {
    Writer::WriteInlineData(array, indent);
    if (array->HasInformation()) array->GetInformation()->Clear();
  }
};

// Runs a VTK writer on a temporary file that replaces `file` when all is written.
template <typename Writer>
vsc_status write_file(const char *file, vtkDataObject *object, vsc_error *error)
{
  char temporary[VSC_FILE_NAME];
  const vsc_status status = vsc_replace_begin(file, temporary, error);
  if (status != VSC_OK) return status;
  silence quiet;
  bool written = false;
  try {
    vtkNew<plain<Writer>> writer;
    writer->SetFileName(temporary);
    writer->SetInputDataObject(object);
    // Debian 12's ParaView, with its newest expat, cannot read appended data of any encoding.
    writer->SetDataModeToBinary();
    writer->SetHeaderTypeToUInt64();
    writer->SetCompressorTypeToZLib();
    writer->SetCompressionLevel(COMPRESSION_LEVEL);
    written = writer->Write() == 1 && writer->GetErrorCode() == 0 && !quiet.failed();
  } catch (...) {
    vsc_replace_cancel(temporary);
    throw;
  }
  if (written) return vsc_replace_end(file, temporary, false, error);
  vsc_replace_cancel(temporary);
  return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written (VTK: %s): is the disk full?", file,
                  quiet.said().c_str());
}

vsc_status write_mesh(const char *file, size_t node_count, const double *nodes, size_t element_count,
                      const uint32_t *tets, size_t triangle_count, const uint32_t *triangles,
                      size_t array_count, const vsc_vtk_array *arrays, bool double_precision,
                      vsc_error *error)
{
  const size_t cell_count = element_count + triangle_count;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetData(make_real("Points", 3, node_count, node_count, nodes, double_precision));
  grid->SetPoints(points);
  if (node_count <= INT32_MAX && 4 * cell_count <= INT32_MAX)
    set_cells<vtkTypeInt32Array>(grid, element_count, tets, triangle_count, triangles);
  else
    set_cells<vtkTypeInt64Array>(grid, element_count, tets, triangle_count, triangles);
  for (size_t i = 0; i < array_count; i++) {
    const vsc_vtk_array *from = &arrays[i];
    const size_t given = from->on_nodes ? node_count : element_count;
    const size_t tuples = from->on_nodes ? node_count : cell_count;
    vtkSmartPointer<vtkDataArray> array =
      from->integer
        ? make_array<vtkIntArray>(from->name, from->components, given, tuples, from->values)
        : make_real(from->name, from->components, given, tuples, from->values, double_precision);
    if (from->on_nodes) grid->GetPointData()->AddArray(array);
    else grid->GetCellData()->AddArray(array);
  }
  return write_file<vtkXMLUnstructuredGridWriter>(file, grid, error);
}

vsc_status write_image(const char *file, const vsc_image *image, vsc_error *error)
{
  const size_t points = image->size[0] * image->size[1] * image->size[2];
  for (int axis = 0; axis < 3; axis++)
    if (image->size[axis] == 0 || image->size[axis] > INT_MAX)
      return vsc_fail(error, VSC_INPUT, "%s: an image of %zu x %zu x %zu voxels cannot be written",
                      file, image->size[0], image->size[1], image->size[2]);
  vtkNew<vtkImageData> grid;
  grid->SetDimensions((int)image->size[0], (int)image->size[1], (int)image->size[2]);
  grid->SetOrigin(image->origin);
  grid->SetSpacing(image->spacing);
  grid->SetDirectionMatrix(image->direction);
  for (size_t i = 0; i < image->data.count; i++) {
    const vsc_array *from = &image->data.items[i];
    grid->GetPointData()->AddArray(make_array<vtkFloatArray>(from->name, from->components, points,
                                                             points, from->values));
  }
  return write_file<vtkXMLImageDataWriter>(file, grid, error);
}

vtkSmartPointer<vtkCellArray> make_cells(size_t count, int corners, const uint32_t *numbers)
{
  vtkNew<vtkTypeInt64Array> offsets, points;
  offsets->SetNumberOfValues((vtkIdType)count + 1);
  points->SetNumberOfValues((vtkIdType)count * corners);
  for (size_t i = 0; i <= count; i++) offsets->SetValue((vtkIdType)i, (vtkIdType)i * corners);
  for (size_t i = 0; i < count * (size_t)corners; i++) points->SetValue((vtkIdType)i, numbers[i]);
  vtkNew<vtkCellArray> cells;
  cells->SetData(offsets, points);
  return vtkSmartPointer<vtkCellArray>(cells.GetPointer());
}

vsc_status write_polydata(const char *file, const vsc_polydata *from, vsc_error *error)
{
  vtkNew<vtkPolyData> data;
  vtkNew<vtkPoints> points;
  points->SetData(make_array<vtkFloatArray>("Points", 3, from->point_count, from->point_count,
                                            from->points));
  data->SetPoints(points);
  if (from->triangle_count > 0)
    data->SetPolys(make_cells(from->triangle_count, 3, from->triangles));
  if (from->segment_count > 0) data->SetLines(make_cells(from->segment_count, 2, from->segments));
  for (size_t i = 0; i < from->point_data.count; i++) {
    const vsc_array *array = &from->point_data.items[i];
    data->GetPointData()->AddArray(make_array<vtkFloatArray>(
      array->name, array->components, from->point_count, from->point_count, array->values));
  }
  return write_file<vtkXMLPolyDataWriter>(file, data, error);
}

}  // namespace

vsc_status vsc_vtk_write_polydata(const char *file, const vsc_polydata *polydata, vsc_error *error)
{
  return guarded(file, error, [&] { return write_polydata(file, polydata, error); });
}

vsc_status vsc_vtk_write_mesh(const char *file, size_t node_count, const double *nodes,
                              size_t element_count, const uint32_t *tets, size_t triangle_count,
                              const uint32_t *triangles, size_t array_count,
                              const vsc_vtk_array *arrays, bool double_precision, vsc_error *error)
{
  return guarded(file, error, [&] {
    return write_mesh(file, node_count, nodes, element_count, tets, triangle_count, triangles,
                      array_count, arrays, double_precision, error);
  });
}

vsc_status vsc_vtk_write_image(const char *file, const vsc_image *image, vsc_error *error)
{
  return guarded(file, error, [&] { return write_image(file, image, error); });
}
