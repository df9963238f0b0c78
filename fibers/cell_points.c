// SPDX-License-Identifier: GPL-3.0-or-later
#include "fibers/cell_points.h"

#include <math.h>
#include <stdbool.h>

#include "base/vec3.h"

enum { N_ = VSC_POINTS_PER_EDGE };

// The tet x >= y >= z of the unit cube is cut by the planes of N_^3 cubes, each cut in six by the
// planes x = y, y = z, z = x through its corner: N_^3 of these parts lie in the tet. They are affine to
// the reference tet by xi = (x - y, y - z, z).
static int fill_tet(double (*xi)[3])
{
  static const int orders[6][3] = {{0, 1, 2}, {0, 2, 1}, {1, 0, 2},
                                   {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  static const double part[3] = {0.75, 0.5, 0.25};  // middle of the part x >= y >= z of a cube
  int count = 0;
  for (int i = 0; i < N_; i++)
    for (int j = 0; j <= i; j++)
      for (int k = 0; k <= j; k++)
        for (int o = 0; o < 6; o++) {
          double x[3] = {i, j, k};
          for (int a = 0; a < 3; a++) x[orders[o][a]] = (x[orders[o][a]] + part[a]) / N_;
          if (x[0] < x[1] || x[1] < x[2]) continue;
          xi[count][0] = x[0] - x[1];
          xi[count][1] = x[1] - x[2];
          xi[count++][2] = x[2];
        }
  return count;
}

// Triangles: N_^2 of them, pointing one way or the other.
static int fill_wedge(double (*xi)[3])
{
  int count = 0;
  for (int k = 0; k < N_; k++)
    for (int i = 0; i < N_; i++)
      for (int j = 0; i + j < N_; j++)
        for (int turned = 0; turned < 2 && i + j + turned < N_; turned++) {
          const double middle = (turned + 1) / 3.0;
          xi[count][0] = (i + middle) / N_;
          xi[count][1] = (j + middle) / N_;
          xi[count++][2] = (2 * k + 1.0) / N_ - 1;
        }
  return count;
}

static int fill_cube(double (*xi)[3], bool pyramid)
{
  int count = 0;
  for (int i = 0; i < N_; i++)
    for (int j = 0; j < N_; j++)
      for (int k = 0; k < N_; k++) {
        xi[count][0] = (2 * i + 1.0) / N_ - 1;
        xi[count][1] = (2 * j + 1.0) / N_ - 1;
        xi[count++][2] = pyramid ? (k + 0.5) / N_ : (2 * k + 1.0) / N_ - 1;
      }
  return count;
}

void vsc_cell_points_fill(vsc_cell kind, vsc_cell_points *points)
{
  double xi[VSC_CELL_POINTS][3];
  int count;
  if (kind == VSC_TET || kind == VSC_TET10)
    count = fill_tet(xi);
  else if (kind == VSC_WEDGE)
    count = fill_wedge(xi);
  else
    count = fill_cube(xi, kind == VSC_PYRAMID);
  for (int p = 0; p < count; p++) vsc_cell_shape(kind, xi[p], points->N[p], points->D[p]);
}

void vsc_cell_points_place(const vsc_mesh *mesh, size_t element, const vsc_cell_points *points,
                           double (*places)[3], double *weights)
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const int corners = vsc_mesh_kind(mesh, element)->corners;
  for (int p = 0; p < VSC_CELL_POINTS; p++) {
    double x[3] = {0}, J[3][3] = {{0}}, across[3];
    for (int i = 0; i < corners; i++) {
      const double *node = &mesh->nodes[3 * (size_t)corner[i]];
      for (int k = 0; k < 3; k++) {
        x[k] += points->N[p][i] * node[k];
        for (int a = 0; a < 3; a++) J[a][k] += points->D[p][a][i] * node[k];
      }
    }
    vsc_cross(J[0], J[1], across);
    for (int k = 0; k < 3; k++) places[p][k] = x[k];
    weights[p] = fabs(vsc_dot(across, J[2]));
  }
}
