// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh of tets written from plain arrays, for tests.
#ifndef VSC_TESTS_WRITE_TETS_H
#define VSC_TESTS_WRITE_TETS_H

#include <string.h>

#include "io/vtk.h"

static inline vsc_status write_tets(const char *file, size_t node_count, const double *nodes,
                                    size_t tet_count, const uint32_t *tets, size_t triangle_count,
                                    const uint32_t *triangles, size_t array_count,
                                    const vsc_vtk_array *arrays, bool double_precision,
                                    vsc_error *error)
{
  vsc_mesh *mesh = vsc_mesh_create(node_count, tet_count, triangle_count);
  if (mesh == NULL) return vsc_fail_memory(error, "a mesh");
  memcpy(mesh->nodes, nodes, 3 * node_count * sizeof *nodes);
  memcpy(mesh->corners, tets, 4 * tet_count * sizeof *tets);
  if (triangle_count > 0) memcpy(mesh->triangles, triangles, 3 * triangle_count * sizeof *triangles);
  const vsc_status status =
      vsc_vtk_write_mesh(file, mesh, array_count, arrays, double_precision, error);
  vsc_mesh_free(mesh);
  return status;
}

#endif
