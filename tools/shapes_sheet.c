// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_sheet.h"

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "tools/shapes.h"

vsc_sheet_shape vsc_sheet_default(void)
{
  return (vsc_sheet_shape){.cells = {20, 20}, .size = {10, 10}, .seed = 1};
}

vsc_tube_shape vsc_tube_default(void)
{
  return (vsc_tube_shape){.radius = 10, .length = 40, .around = 32, .along = 20};
}

// Two triangles of the cell with corners a b c d (anti-clockwise), cut from a to c or from b to d.
static void cut_cell(uint32_t *triangles, uint32_t a, uint32_t b, uint32_t c, uint32_t d,
                     bool other)
{
  const uint32_t corners[2][6] = {{a, b, c, a, c, d}, {a, b, d, b, c, d}};
  memcpy(triangles, corners[other], sizeof corners[other]);
}

// A mesh with room, and node arrays of these names.
static vsc_mesh *start_mesh(size_t nodes, size_t cells, const char *const *names, int count)
{
  vsc_mesh *mesh = vsc_mesh_create(nodes, 0, 2 * cells);
  for (int a = 0; mesh != NULL && a < count; a++)
    if (vsc_arrays_add(&mesh->node_data, names[a], 1, nodes) == NULL) {
      vsc_mesh_free(mesh);
      return NULL;
    }
  if (mesh != NULL) {
    mesh->report.file_nodes = nodes;
    mesh->report.file_cells = 2 * cells;
  }
  return mesh;
}

static vsc_status check_sheet(const vsc_sheet_shape *sheet, vsc_error *error)
{
  for (int a = 0; a < 2; a++) {
    if (sheet->cells[a] < 1 || sheet->cells[a] > 10000)
      return vsc_fail(error, VSC_INPUT, "sheet: %zu cells along %c, must be 1 to 10000",
                      sheet->cells[a], 'x' + a);
    if (!(sheet->size[a] > 0 && isfinite(sheet->size[a])))
      return vsc_fail(error, VSC_INPUT, "sheet: size %g mm along %c, must be above 0",
                      sheet->size[a], 'x' + a);
  }
  if (!(sheet->jitter >= 0 && sheet->jitter <= 0.3))
    return vsc_fail(error, VSC_INPUT, "sheet: jitter %g, must be 0 to 0.3 of a cell",
                    sheet->jitter);
  return VSC_OK;
}

static void place_sheet_node(const vsc_sheet_shape *sheet, vsc_mesh *mesh, size_t node)
{
  const size_t across = sheet->cells[0] + 1, index[2] = {node % across, node / across};
  bool inner = true;
  for (int a = 0; a < 2; a++) {
    const bool low = index[a] == 0, high = index[a] == sheet->cells[a];
    mesh->node_data.items[2 * a].values[node] = low;
    mesh->node_data.items[2 * a + 1].values[node] = high;
    inner &= !low && !high;
  }
  for (int a = 0; a < 2; a++) {
    double place = (double)index[a];
    if (inner) place += sheet->jitter * vsc_scatter(sheet->seed, 3 * node + (size_t)a);
    mesh->nodes[3 * node + (size_t)a] = sheet->size[a] * place / (double)sheet->cells[a];
  }
}

vsc_status vsc_sheet_mesh(const vsc_sheet_shape *sheet, vsc_mesh **result, vsc_error *error)
{
  static const char *const names[] = {"x0", "x1", "y0", "y1"};
  const vsc_status status = check_sheet(sheet, error);
  if (status != VSC_OK) return status;
  const size_t nx = sheet->cells[0], ny = sheet->cells[1], nodes = (nx + 1) * (ny + 1);
  vsc_mesh *mesh = start_mesh(nodes, nx * ny, names, 4);
  if (mesh == NULL) return vsc_fail_memory(error, "the sheet's mesh");
  for (size_t n = 0; n < nodes; n++) place_sheet_node(sheet, mesh, n);
  for (size_t j = 0; j < ny; j++)
    for (size_t i = 0; i < nx; i++) {
      const uint32_t a = (uint32_t)(j * (nx + 1) + i), d = a + (uint32_t)nx + 1;
      cut_cell(mesh->triangles + 6 * (j * nx + i), a, a + 1, d + 1, d, (i + j) % 2 == 1);
    }
  *result = mesh;
  return VSC_OK;
}

vsc_status vsc_tube_mesh(const vsc_tube_shape *tube, vsc_mesh **result, vsc_error *error)
{
  static const char *const names[] = {"z0", "z1"};
  if (!(tube->radius > 0 && isfinite(tube->radius) && tube->length > 0 && isfinite(tube->length)))
    return vsc_fail(error, VSC_INPUT, "tube: radius %g mm and length %g mm must be above 0",
                    tube->radius, tube->length);
  const size_t around = tube->around, along = tube->along;
  if (around < 3 || around > 10000 || along < 1 || along > 10000)
    return vsc_fail(error, VSC_INPUT,
                    "tube: %zu cells around and %zu along, must be 3 to 10000 and 1 to 10000",
                    around, along);
  vsc_mesh *mesh = start_mesh(around * (along + 1), around * along, names, 2);
  if (mesh == NULL) return vsc_fail_memory(error, "the tube's mesh");
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double angle = 2 * M_PI * (double)(n % around) / (double)around;
    double *x = mesh->nodes + 3 * n;
    x[0] = tube->radius * cos(angle);
    x[1] = tube->radius * sin(angle);
    x[2] = tube->length * (double)(n / around) / (double)along;
    mesh->node_data.items[0].values[n] = n < around;
    mesh->node_data.items[1].values[n] = n >= around * along;
  }
  for (size_t j = 0; j < along; j++)
    for (size_t i = 0; i < around; i++) {
      const uint32_t row = (uint32_t)(j * around), next = row + (uint32_t)around;
      const uint32_t here = (uint32_t)i, there = (uint32_t)((i + 1) % around);
      cut_cell(mesh->triangles + 6 * (j * around + i), row + here, row + there, next + there,
               next + here, (i + j) % 2 == 1);
    }
  *result = mesh;
  return VSC_OK;
}
