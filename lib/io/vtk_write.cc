// SPDX-License-Identifier: GPL-3.0-or-later
// The writing half of vtk.h.
#include <algorithm>
#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>

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
#include <vtkUnstructuredGrid.h>
#include <vtkXMLImageDataWriter.h>
#include <vtkXMLPolyDataWriter.h>
#include <vtkXMLUnstructuredGridWriter.h>

extern "C" {
#include "io/replace.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
}
#include "io/vtk_cells.hh"
#include "io/vtk_deflate.hh"
#include "io/vtk_quiet.hh"

namespace {

using vsc::guarded;
using vsc::set_cells;
using vsc::silence;

int to_int(double value)
{
  if (std::isnan(value)) return 0;
  return (int)std::lrint(std::fmin(std::fmax(value, INT_MIN), INT_MAX));
}

// A VTK array of type `Array`: `tuples` tuples of zeros, into which `given` of values go behind the
// first `before`.
template <typename Array>
vtkSmartPointer<vtkDataArray> make_array(const char *name, int components, size_t before,
                                         size_t given, size_t tuples, const double *values)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples((vtkIdType)tuples);
  using number = typename Array::ValueType;
  number *to = array->GetPointer(0);
  const size_t width = (size_t)components;
  std::fill(to, to + tuples * width, number(0));
  to += before * width;
  for (size_t i = 0; i < given * width; i++) {
    if constexpr (std::is_same_v<Array, vtkIntArray>) to[i] = to_int(values[i]);
    else to[i] = static_cast<number>(values[i]);
  }
  return vtkSmartPointer<vtkDataArray>(array.GetPointer());
}

vtkSmartPointer<vtkDataArray> make_real(const char *name, int components, size_t before,
                                        size_t given, size_t tuples, const double *values,
                                        bool double_precision)
{
  return double_precision
           ? make_array<vtkDoubleArray>(name, components, before, given, tuples, values)
           : make_array<vtkFloatArray>(name, components, before, given, tuples, values);
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

// Runs a VTK writer, to memory: on a file that cannot be written in full it goes astray.
template <typename Writer>
vsc_status write_file(const char *file, vtkDataObject *object, vsc_error *error)
{
  silence quiet;
  vtkNew<plain<Writer>> writer;
  writer->WriteToOutputStringOn();
  writer->SetInputDataObject(object);
  // Debian 12's ParaView, with its newest expat, cannot read appended data of any encoding.
  writer->SetDataModeToBinary();
  writer->SetHeaderTypeToUInt64();
  writer->SetCompressor(vtkNew<vsc::deflate>());
  if (writer->Write() != 1 || writer->GetErrorCode() != 0 || quiet.failed())
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written (VTK: %s)", file, quiet.said().c_str());
  const std::string text = writer->GetOutputString();
  return vsc_replace_whole(file, text.data(), text.size(), false, error);
}

vtkSmartPointer<vtkDataArray> place_array(const vsc_mesh *mesh, const vsc_vtk_array *from,
                                          bool double_precision)
{
  const size_t elements = mesh->element_count, cells = elements + mesh->triangle_count;
  const bool on_nodes = from->place == VSC_ON_NODES, on_elements = from->place == VSC_ON_ELEMENTS;
  const size_t tuples = on_nodes ? mesh->node_count : cells;
  const size_t before = on_nodes || on_elements ? 0 : elements;
  const size_t given = on_nodes ? mesh->node_count : on_elements ? elements : mesh->triangle_count;
  return from->integer ? make_array<vtkIntArray>(from->name, from->components, before, given, tuples,
                                                 from->values)
                       : make_real(from->name, from->components, before, given, tuples,
                                   from->values, double_precision);
}

vsc_status write_mesh(const char *file, const vsc_mesh *mesh, size_t array_count,
                      const vsc_vtk_array *arrays, bool double_precision, vsc_error *error)
{
  const size_t nodes = mesh->node_count;
  vtkNew<vtkUnstructuredGrid> grid;
  vtkNew<vtkPoints> points;
  points->SetData(make_real("Points", 3, 0, nodes, nodes, mesh->nodes, double_precision));
  grid->SetPoints(points);
  if (nodes <= INT32_MAX && mesh->start[mesh->element_count] + 6 * mesh->triangle_count <= INT32_MAX)
    set_cells<vtkTypeInt32Array>(grid, mesh);
  else
    set_cells<vtkTypeInt64Array>(grid, mesh);
  for (size_t i = 0; i < array_count; i++) {
    vtkSmartPointer<vtkDataArray> array = place_array(mesh, &arrays[i], double_precision);
    if (arrays[i].place == VSC_ON_NODES) grid->GetPointData()->AddArray(array);
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
    grid->GetPointData()->AddArray(make_array<vtkFloatArray>(from->name, from->components, 0,
                                                             points, points, from->values));
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
  points->SetData(make_array<vtkFloatArray>("Points", 3, 0, from->point_count,
                                            from->point_count, from->points));
  data->SetPoints(points);
  if (from->triangle_count > 0)
    data->SetPolys(make_cells(from->triangle_count, 3, from->triangles));
  if (from->segment_count > 0) data->SetLines(make_cells(from->segment_count, 2, from->segments));
  for (size_t i = 0; i < from->point_data.count; i++) {
    const vsc_array *array = &from->point_data.items[i];
    data->GetPointData()->AddArray(make_array<vtkFloatArray>(
      array->name, array->components, 0, from->point_count, from->point_count, array->values));
  }
  return write_file<vtkXMLPolyDataWriter>(file, data, error);
}

}  // namespace

vsc_status vsc_vtk_write_polydata(const char *file, const vsc_polydata *polydata, vsc_error *error)
{
  return guarded(file, error, [&] { return write_polydata(file, polydata, error); });
}

vsc_status vsc_vtk_write_mesh(const char *file, const vsc_mesh *mesh, size_t array_count,
                              const vsc_vtk_array *arrays, bool double_precision, vsc_error *error)
{
  return guarded(file, error, [&] {
    return write_mesh(file, mesh, array_count, arrays, double_precision, error);
  });
}

vsc_status vsc_vtk_write_image(const char *file, const vsc_image *image, vsc_error *error)
{
  return guarded(file, error, [&] { return write_image(file, image, error); });
}
