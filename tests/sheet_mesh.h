// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes of triangles for tests: flat sheets cut in several ways.
#ifndef VSC_TESTS_SHEET_MESH_H
#define VSC_TESTS_SHEET_MESH_H

#include <stdbool.h>

#include "mesh/mesh.h"
#include "mesh/select.h"
#include "random.h"

typedef enum sheet_cut {
  CUT_ONE_WAY,   // all diagonals alike
  CUT_BY_TURNS,  // diagonals alternate
  CUT_LEANING,   // all alike, rows shifted by half an edge: equilateral with the right proportions
} sheet_cut;

// nx x ny rectangles of hx x hy mm in the xy plane, each cut into two triangles that turn
// anti-clockwise; inner nodes are moved by up to `jitter` edges.
static inline vsc_mesh *sheet_mesh(size_t nx, size_t ny, double hx, double hy, sheet_cut cut,
                                   double jitter, uint64_t seed)
{
  vsc_mesh *mesh = vsc_mesh_create((nx + 1) * (ny + 1), 0, 2 * nx * ny);
  assert_non_null(mesh);
  for (size_t j = 0; j <= ny; j++)
    for (size_t i = 0; i <= nx; i++) {
      double *x = mesh->nodes + 3 * (j * (nx + 1) + i);
      const double dx = random_between(&seed, -jitter, jitter);
      const double dy = random_between(&seed, -jitter, jitter);
      const bool inner = i > 0 && j > 0 && i < nx && j < ny;
      x[0] = hx * ((double)i + (cut == CUT_LEANING ? 0.5 * (double)j : 0) + (inner ? dx : 0));
      x[1] = hy * ((double)j + (inner ? dy : 0));
    }
  for (size_t j = 0; j < ny; j++)
    for (size_t i = 0; i < nx; i++) {
      const uint32_t a = (uint32_t)(j * (nx + 1) + i), b = a + 1, c = b + (uint32_t)nx + 1,
                     d = c - 1;
      const bool other = cut == CUT_LEANING || (cut == CUT_BY_TURNS && (i + j) % 2 == 1);
      const uint32_t corners[2][6] = {{a, b, c, a, c, d}, {a, b, d, b, c, d}};
      for (int k = 0; k < 6; k++) mesh->triangles[6 * (j * nx + i) + (size_t)k] = corners[other][k];
    }
  return mesh;
}

// All triangles of a mesh, borrowed.
static inline vsc_surface all_triangles(const vsc_mesh *mesh)
{
  return (vsc_surface){
      .name = "boundary", .count = mesh->triangle_count, .triangles = mesh->triangles};
}

#endif
