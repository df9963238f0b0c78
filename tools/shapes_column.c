// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shapes_column.h"

#include <math.h>

#include "base/mem.h"

vsc_column_shape vsc_column_default(void)
{
  return (vsc_column_shape){
      .block = {.cells = {4, 4, 24}, .size = {1000, 1000, 6000}, .tets_per_cell = 5}};
}

vsc_status vsc_column_mesh(const vsc_column_shape *shape, vsc_mesh **result, vsc_error *error)
{
  const double *size = shape->block.size;
  vsc_mesh *mesh = NULL;
  if (!isfinite(shape->bend) || !isfinite(shape->twist))
    return vsc_fail(error, VSC_INPUT, "column: bends at %g m/s and twists at %g rad/s; give finite numbers",
                    shape->bend, shape->twist);
  vsc_status status = vsc_block_of(&shape->block, shape->element, &mesh, error);
  if (status != VSC_OK) return status;
  const vsc_array *velocity = vsc_arrays_add(&mesh->node_data, "velocity", 3, mesh->node_count);
  if (velocity == NULL) {
    vsc_mesh_free(mesh);
    return vsc_fail_memory(error, "the column's velocity");
  }
  for (size_t n = 0; n < mesh->node_count; n++) {
    double *x = mesh->nodes + 3 * n, *v = velocity->values + 3 * n;
    for (int a = 0; a < 2; a++) x[a] -= 0.5 * size[a];
    const double up = x[2] / size[2];
    const double turn = 1e-3 * shape->twist * sin(0.5 * M_PI * up);  // rad/ms, of places in mm
    v[0] = shape->bend * up - turn * x[1];
    v[1] = turn * x[0];
  }
  *result = mesh;
  return VSC_OK;
}
