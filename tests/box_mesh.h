// SPDX-License-Identifier: GPL-3.0-or-later
// A box of cubes, six tets each (Kuhn's subdivision), for tests.
#ifndef VSC_TESTS_BOX_MESH_H
#define VSC_TESTS_BOX_MESH_H

#include <stdlib.h>

#include "base/mem.h"
#include "mesh/mesh.h"

static inline uint32_t box_node(const int n[3], int i, int j, int k)
{
  return (uint32_t)(i + (n[0] + 1) * (j + (n[1] + 1) * k));
}

// Raw (not cleaned) mesh of n[0] x n[1] x n[2] cubes with edge `h`; `solid(i, j, k)` says which
// cubes are there (NULL: all). Half of the tets come left-handed: vsc_mesh_clean has to turn them.
static inline vsc_mesh *box_mesh_raw(const int n[3], double h, int (*solid)(int, int, int))
{
  static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const size_t nodes = (size_t)(n[0] + 1) * (size_t)(n[1] + 1) * (size_t)(n[2] + 1);
  vsc_mesh *mesh = vsc_mesh_create(nodes, 6 * (size_t)n[0] * (size_t)n[1] * (size_t)n[2], 0);
  if (mesh == NULL) abort();
  size_t tets = 0;
  for (int k = 0; k <= n[2]; k++)
    for (int j = 0; j <= n[1]; j++)
      for (int i = 0; i <= n[0]; i++) {
        double *x = mesh->nodes + 3 * (size_t)box_node(n, i, j, k);
        x[0] = i * h;
        x[1] = j * h;
        x[2] = k * h;
        if (i == n[0] || j == n[1] || k == n[2] || (solid != NULL && !solid(i, j, k))) continue;
        for (int o = 0; o < 6; o++, tets++) {
          int at[3] = {i, j, k};
          for (int c = 0; c < 4; c++) {
            mesh->corners[4 * tets + c] = box_node(n, at[0], at[1], at[2]);
            if (c < 3) at[orders[o][c]]++;
          }
        }
      }
  mesh->element_count = tets;
  return mesh;
}

static inline vsc_mesh *box_mesh(const int n[3], double h, int (*solid)(int, int, int))
{
  vsc_mesh *mesh = box_mesh_raw(n, h, solid);
  vsc_error error;
  if (vsc_mesh_clean(mesh, "box", &error) != VSC_OK) abort();
  return mesh;
}

#endif
