// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/membranes.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "model/law_bending.h"

// An edge of a triangle, its lower node first.
typedef struct edge {
  uint32_t low, high;
  uint32_t triangle;
  int corner;  // it runs from this corner to the next
} edge;

static int compare_edges(const void *a, const void *b)
{
  const edge *x = a, *y = b;
  if (x->low != y->low) return x->low < y->low ? -1 : 1;
  if (x->high != y->high) return x->high < y->high ? -1 : 1;
  return (x->triangle > y->triangle) - (x->triangle < y->triangle);
}

static vsc_status find_neighbours(vsc_sheet *sheet, vsc_error *error)
{
  edge *edges;
  const size_t count = 3 * sheet->count;
  if (!VSC_NEW(edges, count)) return vsc_fail_memory(error, "a membrane's edges");
  for (size_t k = 0; k < count; k++) {
    const uint32_t *node = sheet->nodes[k / 3];
    const uint32_t p = node[k % 3], q = node[(k + 1) % 3];
    edges[k] = (edge){p < q ? p : q, p < q ? q : p, (uint32_t)(k / 3), (int)(k % 3)};
  }
  qsort(edges, count, sizeof *edges, compare_edges);
  for (size_t first = 0, last; first < count; first = last) {
    for (last = first + 1; last < count && edges[last].low == edges[first].low &&
                           edges[last].high == edges[first].high;)
      last++;
    if (last - first != 2) continue;
    for (size_t k = first; k < last; k++) {
      const edge *other = &edges[2 * first + 1 - k];
      sheet->nodes[edges[k].triangle][3 + edges[k].corner] =
          sheet->nodes[other->triangle][(other->corner + 2) % 3];
    }
  }
  vsc_free(edges);
  return VSC_OK;
}

// Twice the area; the unit normal.
static double normal_of(const double x[3][3], double normal[3])
{
  double first[3], second[3];
  vsc_subtract(x[1], x[0], first);
  vsc_subtract(x[2], x[0], second);
  vsc_cross(first, second, normal);
  return vsc_normalize(normal);
}

// The part of `direction` in the plane, of length 1. Returns its share of the whole.
static double project(const double direction[3], const double normal[3], double a[3])
{
  const double out = vsc_dot(direction, normal), whole = vsc_norm(direction);
  for (int i = 0; i < 3; i++) a[i] = direction[i] - out * normal[i];
  return vsc_normalize(a) / whole;
}

static void axes_of(const double direction[3], const double normal[3], double a[3], double b[3])
{
  int flattest = 0;
  for (int i = 1; i < 3; i++)
    if (fabs(normal[i]) < fabs(normal[flattest])) flattest = i;
  double other[3] = {0};
  other[flattest] = 1;
  if (!(project(direction, normal, a) > 0.1)) project(other, normal, a);
  vsc_cross(normal, a, b);
}

// T h_k = the axes: T is the inverse of the matrix whose rows are h_k in a and b.
static void invert_edges(const double x[3][3], const double a[3], const double b[3], double T[2][2])
{
  double h[2][3];
  vsc_subtract(x[1], x[0], h[0]);
  vsc_subtract(x[2], x[0], h[1]);
  const double H[2][2] = {{vsc_dot(h[0], a), vsc_dot(h[0], b)}, {vsc_dot(h[1], a), vsc_dot(h[1], b)}};
  const double area = H[0][0] * H[1][1] - H[0][1] * H[1][0];
  T[0][0] = H[1][1] / area;
  T[0][1] = -H[0][1] / area;
  T[1][0] = -H[1][0] / area;
  T[1][1] = H[0][0] / area;
}

// Height over the edge from p to q, and foot from its middle, of a point.
static void height_and_foot(const double p[3], const double q[3], const double point[3],
                            double *height, double *foot)
{
  double along[3], way[3], across[3];
  vsc_subtract(q, p, along);
  const double length = vsc_normalize(along);
  vsc_subtract(point, p, way);
  vsc_cross(along, way, across);
  *height = vsc_norm(across);
  *foot = vsc_dot(along, way) - length / 2;
}

// The row of L of the edge from p to q, in the plane's own axes e_1, e_2.
static void fold_row(const double p[3], const double q[3], const double s[3], const double r[3],
                     const double e[3][3], double row[3])
{
  double own, own_foot, other, other_foot, along[3], out[3];
  height_and_foot(p, q, s, &own, &own_foot);
  height_and_foot(p, q, r, &other, &other_foot);
  vsc_subtract(q, p, along);
  const double length = vsc_normalize(along), quarter = length * length / 4;
  vsc_cross(along, e[2], out);
  const double uu = (own + other) / 2, ut = other_foot - own_foot;
  const double tt = ((own_foot * own_foot - quarter) / own +
                     (other_foot * other_foot - quarter) / other) / 2;
  const double u[2] = {vsc_dot(out, e[0]), vsc_dot(out, e[1])};
  const double t[2] = {vsc_dot(along, e[0]), vsc_dot(along, e[1])};
  for (int i = 0; i < 2; i++) row[i] = uu * u[i] * u[i] + ut * u[i] * t[i] + tt * t[i] * t[i];
  // k_12 counts twice in what is symmetric, and half of 2 k_12 is k_12
  row[2] = uu * u[0] * u[1] + ut * (u[0] * t[1] + u[1] * t[0]) / 2 + tt * t[0] * t[1];
}

// The inverse of a symmetric matrix within the space where its eigenvalues are above 1e-3 of the
// largest. False when memory is short.
static bool invert_within(double S[3][3], double inverse[3][3])
{
  double values[3], vectors[9];
  gsl_matrix_view matrix = gsl_matrix_view_array(&S[0][0], 3, 3);
  gsl_vector_view value = gsl_vector_view_array(values, 3);
  gsl_matrix_view vector = gsl_matrix_view_array(vectors, 3, 3);
  gsl_set_error_handler_off();
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(3);
  if (work == NULL) return false;
  gsl_eigen_symmv(&matrix.matrix, &value.vector, &vector.matrix, work);
  gsl_eigen_symmv_free(work);
  memset(inverse, 0, 9 * sizeof(double));
  const double most = fmax(values[0], fmax(values[1], values[2]));
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3 && values[k] > 1e-3 * most; i++)
      for (int j = 0; j < 3; j++)
        inverse[i][j] += vectors[3 * i + k] * vectors[3 * j + k] / values[k];
  return true;
}

bool vsc_bend_stiffness(const double x[3][3], const double across[3][3], const bool has[3], double D,
                        double nu, double M[3][3])
{
  double e[3][3], L[3][3] = {{0}}, S[3][3];
  const double area = normal_of(x, e[2]) / 2;
  vsc_subtract(x[1], x[0], e[0]);
  vsc_normalize(e[0]);
  vsc_cross(e[2], e[0], e[1]);
  for (int i = 0; i < 3; i++)
    if (has[i]) fold_row(x[i], x[(i + 1) % 3], x[(i + 2) % 3], across[i], e, L[i]);
  // A S = L C^-1 L^T
  const double D1 = D * (1 - nu * nu);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      S[i][j] = (L[i][0] * L[j][0] + L[i][1] * L[j][1] - nu * (L[i][0] * L[j][1] + L[i][1] * L[j][0]) +
                 2 * (1 + nu) * L[i][2] * L[j][2]) / (D1 * area);
  return invert_within(S, M);
}

static void positions_of(const vsc_mesh *mesh, const uint32_t *nodes, int count, double (*x)[3])
{
  for (int i = 0; i < count; i++) memcpy(x[i], mesh->nodes + 3 * (size_t)nodes[i], sizeof x[i]);
}

static void fold_angles(const double x[6][3], double fold[3])
{
  vsc_wide3 wide[VSC_BEND_NODES];
  vsc_fold folds[3];
  for (int i = 0; i < VSC_BEND_NODES; i++)
    wide[i] = (vsc_wide3){vsc_splat(x[i][0]), vsc_splat(x[i][1]), vsc_splat(x[i][2])};
  vsc_bend_folds(wide, folds);
  for (int i = 0; i < 3; i++) fold[i] = folds[i].phi[0];
}

// nu of the sheet in its plane: K/(E + K), E the mean of both axes.
static double poisson_ratio(const vsc_membrane_def *def)
{
  return def->area_modulus / ((def->axial[0] + def->axial[1]) / 2 + def->area_modulus);
}

static vsc_status fill_sheet(const vsc_mesh *mesh, const vsc_membrane_def *def, vsc_sheet *sheet,
                             vsc_error *error)
{
  for (size_t k = 0; k < sheet->count; k++) {
    double x[6][3], normal[3], a[3], b[3];
    const uint32_t *node = sheet->nodes[k];
    positions_of(mesh, node, 6, x);
    sheet->area[k] = normal_of(x, normal) / 2;
    if (!(sheet->area[k] > 0))
      return vsc_fail(error, VSC_INPUT,
                      "membrane %s: the triangle of points %u, %u and %u has no area; mend the mesh",
                      def->name, mesh->node_source[node[0]], mesh->node_source[node[1]],
                      mesh->node_source[node[2]]);
    axes_of(def->direction, normal, a, b);
    invert_edges(x, a, b, sheet->T[k]);
    if (sheet->M == NULL) continue;
    bool has[3];
    for (int i = 0; i < 3; i++) has[i] = node[3 + i] != node[i];
    if (!vsc_bend_stiffness(x, x + 3, has, def->bending, poisson_ratio(def), sheet->M[k]))
      return vsc_fail_memory(error, "the bending of a membrane");
    fold_angles(x, sheet->fold[k]);
  }
  return VSC_OK;
}

vsc_status vsc_sheet_make(const vsc_mesh *mesh, const vsc_surface *surface,
                          const vsc_membrane_def *def, vsc_sheet *sheet, vsc_error *error)
{
  const size_t count = surface->count;
  *sheet = (vsc_sheet){.count = count};
  if (!VSC_NEW(sheet->nodes, count) || !VSC_NEW(sheet->area, count) || !VSC_NEW(sheet->T, count) ||
      (def->bending > 0 && (!VSC_NEW(sheet->M, count) || !VSC_NEW(sheet->fold, count))))
    return vsc_fail_memory(error, "a membrane");
  for (size_t k = 0; k < count; k++)
    for (int i = 0; i < 6; i++) sheet->nodes[k][i] = surface->triangles[3 * k + i % 3];
  const vsc_status status = find_neighbours(sheet, error);
  return status == VSC_OK ? fill_sheet(mesh, def, sheet, error) : status;
}

void vsc_sheet_free(vsc_sheet *sheet)
{
  vsc_free(sheet->nodes);
  vsc_free(sheet->area);
  vsc_free(sheet->T);
  vsc_free(sheet->M);
  vsc_free(sheet->fold);
  *sheet = (vsc_sheet){0};
}
