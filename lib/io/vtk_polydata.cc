// SPDX-License-Identifier: GPL-3.0-or-later
// Reading surfaces and lines; vtk_write.cc writes them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <vector>

#include <vtkCellArray.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataReader.h>
#include <vtkSmartPointer.h>
#include <vtkXMLPolyDataReader.h>

extern "C" {
#include "io/vtk_polydata.h"
}
#include "io/vtk_read.hh"

namespace {

using vsc::guarded;
using vsc::silence;

using owned_polydata = std::unique_ptr<vsc_polydata, decltype(&vsc_polydata_free)>;

// What the cells of a file become.
struct pieces {
  std::vector<uint32_t> triangles, segments;

  void add_triangle(uint32_t a, uint32_t b, uint32_t c)
  {
    if (a != b && b != c && c != a) triangles.insert(triangles.end(), {a, b, c});
  }
  void add_segment(uint32_t a, uint32_t b)
  {
    if (a != b) segments.insert(segments.end(), {a, b});
  }
  void add_polygon(const std::vector<uint32_t> &corner)
  {
    for (size_t i = 2; i < corner.size(); i++) add_triangle(corner[0], corner[i - 1], corner[i]);
  }
  // Every second triangle of a strip is turned.
  void add_strip(const std::vector<uint32_t> &corner)
  {
    for (size_t i = 2; i < corner.size(); i++)
      add_triangle(corner[i - 2], corner[i - (i % 2 == 0 ? 1 : 0)], corner[i - (i % 2)]);
  }
  void add_line(const std::vector<uint32_t> &point)
  {
    for (size_t i = 1; i < point.size(); i++) add_segment(point[i - 1], point[i]);
  }
};

// Calls use(points of the cell) for each cell of `list`, its numbers checked.
template <typename Array, typename Use>
vsc_status walk(const char *file, Array *offsets, Array *numbers, size_t point_count, Use use,
                vsc_error *error)
{
  const auto *start = offsets->GetPointer(0);
  const auto *number = numbers->GetPointer(0);
  const size_t cells = (size_t)offsets->GetNumberOfValues() - 1;
  bool sound = start[0] >= 0 && start[cells] <= numbers->GetNumberOfValues();
  for (size_t i = 0; sound && i < cells; i++) sound = start[i] <= start[i + 1];
  if (!sound)
    return vsc_fail(error, VSC_INPUT,
                    "%s: the list of its cells contradicts itself: write it again", file);
  std::vector<uint32_t> points;
  for (size_t i = 0; i < cells; i++) {
    points.clear();
    for (auto at = start[i]; at < start[i + 1]; at++) {
      if (number[at] < 0 || (size_t)number[at] >= point_count)
        return vsc_fail(error, VSC_INPUT,
                        "%s: a cell names point %lld, the file has points 0 to %lld: write it again",
                        file, (long long)number[at], (long long)point_count - 1);
      points.push_back((uint32_t)number[at]);
    }
    use(points);
  }
  return VSC_OK;
}

template <typename Use>
vsc_status walk_cells(const char *file, vtkCellArray *list, size_t point_count, Use use,
                      vsc_error *error)
{
  if (list == nullptr || list->GetNumberOfCells() == 0) return VSC_OK;
  return list->IsStorage64Bit() ? walk(file, list->GetOffsetsArray64(),
                                       list->GetConnectivityArray64(), point_count, use, error)
                                : walk(file, list->GetOffsetsArray32(),
                                       list->GetConnectivityArray32(), point_count, use, error);
}

vsc_status cut_cells(const char *file, vtkPolyData *data, pieces &cut, vsc_error *error)
{
  using corners = const std::vector<uint32_t> &;
  const size_t points = (size_t)data->GetNumberOfPoints();
  if (points > UINT32_MAX)
    return vsc_fail(error, VSC_INPUT, "%s: %zu points are too many", file, points);
  vsc_status status = walk_cells(
    file, data->GetPolys(), points, [&](corners c) { cut.add_polygon(c); }, error);
  if (status == VSC_OK)
    status = walk_cells(
      file, data->GetStrips(), points, [&](corners c) { cut.add_strip(c); }, error);
  if (status == VSC_OK)
    status = walk_cells(
      file, data->GetLines(), points, [&](corners c) { cut.add_line(c); }, error);
  if (status == VSC_OK && cut.triangles.empty() && cut.segments.empty())
    return vsc_fail(error, VSC_INPUT,
                    "%s: holds neither triangles nor lines (%zu points): give a surface or "
                    "centre lines",
                    file, points);
  return status;
}

vsc_status fill_polydata(const char *file, vtkPolyData *data, const pieces &cut, double unit,
                         vsc_polydata *made, vsc_error *error)
{
  vsc::copy_array(data->GetPoints()->GetData(), made->point_count, nullptr, made->points);
  for (size_t i = 0; i < 3 * made->point_count; i++) {
    made->points[i] *= unit;
    if (!std::isfinite(made->points[i]))
      return vsc_fail(error, VSC_INPUT, "%s: point %zu is not finite: write it again", file, i / 3);
  }
  std::copy(cut.triangles.begin(), cut.triangles.end(), made->triangles);
  std::copy(cut.segments.begin(), cut.segments.end(), made->segments);
  return vsc::add_arrays(file, data->GetPointData(), made->point_count, nullptr, &made->point_data,
                         error);
}

vsc_status read_polydata(const char *file, double unit, vsc_polydata **polydata, vsc_error *error)
{
  vsc_status status = vsc::check_file(file, ".vtp", error);
  if (status != VSC_OK) return status;
  silence quiet;
  static const char wanted[] = "PolyData is needed: a surface or centre lines";
  vtkSmartPointer<vtkDataObject> object;
  status = vsc::ends_with(file, ".vtk")
             ? vsc::read_legacy<vtkPolyDataReader>(file, VTK_POLY_DATA, wanted, quiet, object, error)
             : vsc::read_xml<vtkXMLPolyDataReader>(file, "PolyData", wanted, quiet, object, error);
  if (status != VSC_OK) return status;
  vtkPolyData *data = vtkPolyData::SafeDownCast(object);
  if (data == nullptr) return vsc::fail_read(file, quiet, error);
  pieces cut;
  status = cut_cells(file, data, cut, error);
  if (status != VSC_OK) return status;
  owned_polydata made(vsc_polydata_create((size_t)data->GetNumberOfPoints(),
                                          cut.triangles.size() / 3, cut.segments.size() / 2),
                      vsc_polydata_free);
  if (made == nullptr) return vsc_fail_memory(error, "the surface");
  status = fill_polydata(file, data, cut, unit, made.get(), error);
  if (status == VSC_OK) *polydata = made.release();
  return status;
}

}  // namespace

vsc_status vsc_vtk_read_polydata(const char *file, double unit, vsc_polydata **polydata,
                                 vsc_error *error)
{
  return guarded(file, error, [&] { return read_polydata(file, unit, polydata, error); });
}
