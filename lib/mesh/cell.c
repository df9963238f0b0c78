// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/cell.h"

#include <math.h>

const vsc_cell_kind vsc_cells[VSC_CELLS] = {
    [VSC_TET] = {"tetrahedron", "tetrahedra", 4, 4, 6, 4,
                 {{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}},
                 {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}},
    [VSC_HEX] = {"hexahedron", "hexahedra", 8, 6, 12, 8,
                 {{0, 4, 7, 3}, {1, 2, 6, 5}, {0, 1, 5, 4}, {3, 7, 6, 2}, {0, 3, 2, 1}, {4, 5, 6, 7}},
                 {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6}, {6, 7}, {7, 4}, {0, 4}, {1, 5},
                  {2, 6}, {3, 7}}},
    [VSC_WEDGE] = {"wedge", "wedges", 6, 5, 9, 6,
                   {{0, 2, 1, -1}, {3, 4, 5, -1}, {0, 1, 4, 3}, {1, 2, 5, 4}, {2, 0, 3, 5}},
                   {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}}},
    [VSC_PYRAMID] = {"pyramid", "pyramids", 5, 5, 8, 5,
                     {{0, 3, 2, 1}, {0, 1, 4, -1}, {1, 2, 4, -1}, {2, 3, 4, -1}, {3, 0, 4, -1}},
                     {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {0, 4}, {1, 4}, {2, 4}, {3, 4}}},
    [VSC_TET10] = {"quadratic tetrahedron", "quadratic tetrahedra", 10, 4, 6, 4,
                   {{1, 2, 3, -1}, {0, 3, 2, -1}, {0, 1, 3, -1}, {0, 2, 1, -1}},
                   {{0, 1}, {1, 2}, {0, 2}, {0, 3}, {1, 3}, {2, 3}}},
};

int vsc_cell_middle(const vsc_cell_kind *kind, int a, int b)
{
  if (kind->corners == kind->vertices) return -1;
  for (int k = 0; k < kind->edge_count; k++) {
    const int *edge = kind->edges[k];
    if ((edge[0] == a && edge[1] == b) || (edge[0] == b && edge[1] == a)) return kind->vertices + k;
  }
  return -1;
}

// Signs of the reference coordinates of a hexahedron's corners; the first four are a pyramid's.
static const double sign[8][3] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                                  {-1, -1, 1},  {1, -1, 1},  {1, 1, 1},  {-1, 1, 1}};

static void shape_tet(const double xi[3], double N[], double D[3][VSC_MOST_CORNERS])
{
  N[0] = 1 - xi[0] - xi[1] - xi[2];
  for (int k = 0; k < 3; k++) {
    N[k + 1] = xi[k];
    D[k][0] = -1;
    D[k][k + 1] = 1;
  }
}

static void shape_hex(const double xi[3], double N[], double D[3][VSC_MOST_CORNERS])
{
  for (int i = 0; i < 8; i++) {
    double factor[3];
    for (int k = 0; k < 3; k++) factor[k] = 0.5 * (1 + sign[i][k] * xi[k]);
    N[i] = factor[0] * factor[1] * factor[2];
    for (int k = 0; k < 3; k++)
      D[k][i] = 0.5 * sign[i][k] * factor[(k + 1) % 3] * factor[(k + 2) % 3];
  }
}

static void shape_wedge(const double xi[3], double N[], double D[3][VSC_MOST_CORNERS])
{
  const double L[3] = {1 - xi[0] - xi[1], xi[0], xi[1]};
  static const double dL[2][3] = {{-1, 1, 0}, {-1, 0, 1}};
  for (int i = 0; i < 6; i++) {
    const double up = i < 3 ? -1 : 1, half = 0.5 * (1 + up * xi[2]);
    N[i] = L[i % 3] * half;
    D[0][i] = dL[0][i % 3] * half;
    D[1][i] = dL[1][i % 3] * half;
    D[2][i] = 0.5 * up * L[i % 3];
  }
}

static void shape_pyramid(const double xi[3], double N[], double D[3][VSC_MOST_CORNERS])
{
  const double down = 1 - xi[2];
  for (int i = 0; i < 4; i++) {
    const double a = 0.5 * (1 + sign[i][0] * xi[0]), b = 0.5 * (1 + sign[i][1] * xi[1]);
    N[i] = a * b * down;
    D[0][i] = 0.5 * sign[i][0] * b * down;
    D[1][i] = 0.5 * sign[i][1] * a * down;
    D[2][i] = -a * b;
  }
  N[4] = xi[2];
  D[2][4] = 1;
}

static void shape_tet10(const double xi[3], double N[], double D[3][VSC_MOST_CORNERS])
{
  double L[VSC_MOST_CORNERS] = {0}, dL[3][VSC_MOST_CORNERS] = {{0}};
  shape_tet(xi, L, dL);
  for (int i = 0; i < 4; i++) {
    N[i] = L[i] * (2 * L[i] - 1);
    for (int k = 0; k < 3; k++) D[k][i] = (4 * L[i] - 1) * dL[k][i];
  }
  for (int e = 0; e < 6; e++) {
    const int *edge = vsc_cells[VSC_TET10].edges[e], i = edge[0], j = edge[1];
    N[4 + e] = 4 * L[i] * L[j];
    for (int k = 0; k < 3; k++) D[k][4 + e] = 4 * (L[i] * dL[k][j] + L[j] * dL[k][i]);
  }
}

void vsc_cell_shape(vsc_cell kind, const double xi[3], double N[VSC_MOST_CORNERS],
                    double D[3][VSC_MOST_CORNERS])
{
  static void (*const shapes[VSC_CELLS])(const double[3], double[], double[3][VSC_MOST_CORNERS]) = {
      shape_tet, shape_hex, shape_wedge, shape_pyramid, shape_tet10};
  for (int i = 0; i < VSC_MOST_CORNERS; i++) N[i] = D[0][i] = D[1][i] = D[2][i] = 0;
  shapes[kind](xi, N, D);
}

static void add_point(vsc_cell kind, vsc_cell_rule *rule, double x, double y, double z,
                      double weight)
{
  const int q = rule->points++;
  rule->weight[q] = weight;
  vsc_cell_shape(kind, (const double[3]){x, y, z}, rule->N[q], rule->D[q]);
}

vsc_cell_rule vsc_cell_rule_of(vsc_cell kind)
{
  vsc_cell_rule rule = {0};
  const double gauss = 1 / sqrt(3);
  if (kind == VSC_TET) add_point(kind, &rule, 0.25, 0.25, 0.25, 1.0 / 6);
  // (5 - sqrt 5)/20 from three faces, the rest from the fourth
  const double near = (5 - sqrt(5)) / 20, far = 1 - 3 * near;
  for (int i = 0; i < 4 && kind == VSC_TET10; i++)
    add_point(kind, &rule, i == 1 ? far : near, i == 2 ? far : near, i == 3 ? far : near, 1.0 / 24);
  for (int c = 0; c < 2 && kind != VSC_TET && kind != VSC_TET10; c++) {
    const double z = c == 0 ? -gauss : gauss;
    if (kind == VSC_WEDGE) {
      for (int i = 0; i < 3; i++)
        add_point(kind, &rule, i == 1 ? 2.0 / 3 : 1.0 / 6, i == 2 ? 2.0 / 3 : 1.0 / 6, z, 1.0 / 6);
      continue;
    }
    for (int b = 0; b < 2; b++)
      for (int a = 0; a < 2; a++) {
        const double x = a == 0 ? -gauss : gauss, y = b == 0 ? -gauss : gauss;
        if (kind == VSC_HEX) add_point(kind, &rule, x, y, z, 1);
        // xi_3 runs from 0 to 1
        if (kind == VSC_PYRAMID) add_point(kind, &rule, x, y, 0.5 * (1 + z), 0.5);
      }
  }
  return rule;
}
