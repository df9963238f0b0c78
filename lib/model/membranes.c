// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/membranes.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mesh/edges.h"

enum { NOBODY = UINT32_MAX };

// The triangle across each edge of each triangle, or NOBODY.
static void pair_sides(const vsc_side *sides, size_t count, uint32_t (*neighbours)[3])
{
  for (size_t first = 0, end; first < count; first = end) {
    end = vsc_sides_end(sides, count, first);
    for (size_t k = first; k < end; k++)
      neighbours[sides[k].triangle][sides[k].corner] =
          end - first == 2 ? sides[2 * first + 1 - k].triangle : NOBODY;
  }
}

// The number of the edge between two nodes of a triangle.
static int edge_between(const uint32_t *node, uint32_t a, uint32_t b)
{
  for (int i = 0; i < 2; i++)
    if ((node[i] == a && node[i + 1] == b) || (node[i] == b && node[i + 1] == a)) return i;
  return 2;
}

// The third node of the triangle across the edge from p to q of `triangle`, or p where there is
// none.
static uint32_t node_across(const vsc_sheet *sheet, const uint32_t (*neighbours)[3],
                            uint32_t triangle, uint32_t p, uint32_t q)
{
  const uint32_t other = neighbours[triangle][edge_between(sheet->nodes[triangle], p, q)];
  if (other == NOBODY) return p;
  const uint32_t *node = sheet->nodes[other];
  return node[(edge_between(node, p, q) + 2) % 3];
}

static void list_nodes(vsc_sheet *sheet, const uint32_t (*neighbours)[3], uint32_t triangle)
{
  uint32_t *node = sheet->nodes[triangle];
  for (int i = 0; i < 3; i++) {
    const uint32_t p = node[i], q = node[(i + 1) % 3], other = neighbours[triangle][i];
    const uint32_t r = node_across(sheet, neighbours, triangle, p, q);
    node[3 + i] = r;
    node[6 + 2 * i] = other == NOBODY ? p : node_across(sheet, neighbours, other, p, r);
    node[7 + 2 * i] = other == NOBODY ? r : node_across(sheet, neighbours, other, r, q);
  }
}

static vsc_status find_neighbours(vsc_sheet *sheet, vsc_error *error)
{
  vsc_side *sides;
  uint32_t(*neighbours)[3];
  if (!VSC_NEW(neighbours, sheet->count)) return vsc_fail_memory(error, "a membrane's edges");
  const vsc_status status = vsc_sides_list(&sheet->nodes[0][0], VSC_BEND_NODES, sheet->count, &sides, error);
  if (status == VSC_OK) {
    pair_sides(sides, 3 * sheet->count, neighbours);
    for (uint32_t t = 0; t < sheet->count; t++)
      list_nodes(sheet, (const uint32_t(*)[3])neighbours, t);
  }
  vsc_free(sides);
  vsc_free(neighbours);
  return status;
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
  const double H[2][2] = {{vsc_dot(h[0], a), vsc_dot(h[0], b)},
                          {vsc_dot(h[1], a), vsc_dot(h[1], b)}};
  const double area = H[0][0] * H[1][1] - H[0][1] * H[1][0];
  T[0][0] = H[1][1] / area;
  T[0][1] = -H[0][1] / area;
  T[1][0] = -H[1][0] / area;
  T[1][1] = H[0][0] / area;
}

// ---- bending

// How a curvature k opens an edge on one side: uu k_uu + ut k_ut + tt k_tt, and the length of the
// edge. `point` is the triangle's third corner; `side` is 1 on the side that u points out of, -1
// on the other.
static void slope_terms(const double p[3], const double q[3], const double point[3], double side,
                        double terms[3])
{
  double along[3], way[3], across[3];
  vsc_subtract(q, p, along);
  const double length = vsc_normalize(along);
  vsc_subtract(point, p, way);
  vsc_cross(along, way, across);
  const double height = vsc_norm(across), foot = vsc_dot(along, way) - length / 2;
  terms[0] = height / 2;
  terms[1] = -side * foot;
  terms[2] = (foot * foot - length * length / 4) / (2 * height);
}

// A triangle's own axes e_1, e_2 and its normal.
static void basis_of(const double *const x[3], double e[3][3])
{
  double second[3];
  vsc_subtract(x[1], x[0], e[0]);
  vsc_normalize(e[0]);
  vsc_subtract(x[2], x[0], second);
  vsc_cross(e[0], second, e[2]);
  vsc_normalize(e[2]);
  vsc_cross(e[2], e[0], e[1]);
}

// t along and u out of the edge from p to q, in the basis of a triangle on its left.
static void edge_axes(const double p[3], const double q[3], const double e[3][3], double u[2],
                      double t[2])
{
  double along[3];
  vsc_subtract(q, p, along);
  vsc_normalize(along);
  for (int i = 0; i < 2; i++) t[i] = vsc_dot(along, e[i]);
  u[0] = t[1];
  u[1] = -t[0];
}

// uu k_uu + ut k_ut + tt k_tt as a row on (k_11, k_22, 2 k_12).
static void row_of(const double terms[3], const double u[2], const double t[2], double row[3])
{
  for (int i = 0; i < 2; i++)
    row[i] = terms[0] * u[i] * u[i] + terms[1] * u[i] * t[i] + terms[2] * t[i] * t[i];
  row[2] =
      terms[0] * u[0] * u[1] + terms[1] * (u[0] * t[1] + u[1] * t[0]) / 2 + terms[2] * t[0] * t[1];
}

// The plate at D = 1: C, and its inverse.
static void plate_matrices(double nu, double C[3][3], double inverse[3][3])
{
  memset(C, 0, 9 * sizeof(double));
  memset(inverse, 0, 9 * sizeof(double));
  for (int i = 0; i < 2; i++) {
    C[i][i] = 1;
    C[i][1 - i] = nu;
    inverse[i][i] = 1 / (1 - nu * nu);
    inverse[i][1 - i] = -nu / (1 - nu * nu);
  }
  C[2][2] = (1 - nu) / 2;
  inverse[2][2] = 2 / (1 - nu);
}

// The inverse of a symmetric matrix within the space where its eigenvalues are above 1e-2 of the
// largest. False when memory is short.
static bool invert_within(double S[3][3], double inverse[3][3])
{
  double values[3], vectors[9];
  gsl_matrix_view matrix = gsl_matrix_view_array(&S[0][0], 3, 3);
  gsl_vector_view value = gsl_vector_view_array(values, 3);
  gsl_matrix_view vector = gsl_matrix_view_array(vectors, 3, 3);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(3);
  gsl_set_error_handler(handler);
  if (work == NULL) return false;
  gsl_eigen_symmv(&matrix.matrix, &value.vector, &vector.matrix, work);
  gsl_eigen_symmv_free(work);
  memset(inverse, 0, 9 * sizeof(double));
  const double most = fmax(values[0], fmax(values[1], values[2]));
  for (int k = 0; k < 3; k++)
    for (int i = 0; i < 3 && values[k] > 1e-2 * most; i++)
      for (int j = 0; j < 3; j++)
        inverse[i][j] += vectors[3 * i + k] * vectors[3 * j + k] / values[k];
  return true;
}

// The curvature k = fit theta of least energy that opens the edges of triangle `x` by theta. The
// nodes across them are r; L k = theta gives k = C^-1 L^T (L C^-1 L^T)^-1 theta.
static bool fit_curvature(const double *const x[3], const double *const r[3], const bool has[3],
                          double nu, double fit[3][3])
{
  double e[3][3], L[3][3] = {{0}}, CL[3][3], S[3][3], inverse[3][3], C[3][3], softness[3][3];
  basis_of(x, e);
  plate_matrices(nu, C, softness);
  for (int i = 0; i < 3; i++) {
    if (!has[i]) continue;
    const double *p = x[i], *q = x[(i + 1) % 3];
    double own[3], other[3], both[3], u[2], t[2];
    slope_terms(p, q, x[(i + 2) % 3], 1, own);
    slope_terms(p, q, r[i], -1, other);
    for (int d = 0; d < 3; d++) both[d] = own[d] + other[d];
    edge_axes(p, q, (const double(*)[3])e, u, t);
    row_of(both, u, t, L[i]);
  }
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) CL[i][j] = vsc_dot(softness[i], L[j]);
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++)
      S[i][j] = L[i][0] * CL[0][j] + L[i][1] * CL[1][j] + L[i][2] * CL[2][j];
  if (!invert_within(S, inverse)) return false;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      fit[i][j] = 0;
      for (int k = 0; k < 3; k++) fit[i][j] += CL[i][k] * inverse[k][j];
    }
  return true;
}

// Adds rho of edge i, as the slope in the triangle's own curvature B, from the mean of the two
// triangles' curvatures.
static bool add_difference(const double x[VSC_BEND_NODES][3], const bool has[VSC_BEND_FOLDS], int i,
                           double nu, const double slope[3], double B[3][VSC_BEND_FOLDS])
{
  const double *p = x[i], *q = x[(i + 1) % 3], *s = x[(i + 2) % 3], *r = x[3 + i];
  const double *corners[2][3] = {{x[0], x[1], x[2]}, {q, p, r}};
  const double *across[2][3] = {{x[3], x[4], x[5]}, {s, x[6 + 2 * i], x[7 + 2 * i]}};
  const int folds[2][3] = {{0, 1, 2}, {i, 3 + 2 * i, 4 + 2 * i}};
  double own[3], other[3], rho[3];
  slope_terms(p, q, s, 1, own);
  slope_terms(p, q, r, -1, other);
  for (int d = 0; d < 3; d++) rho[d] = (own[d] - other[d]) / 2;
  for (int side = 0; side < 2; side++) {
    double fit[3][3], e[3][3], u[2], t[2], row[3];
    bool known[3];
    for (int j = 0; j < 3; j++) known[j] = has[folds[side][j]];
    if (!fit_curvature(corners[side], across[side], known, nu, fit)) return false;
    basis_of(corners[side], e);
    edge_axes(p, q, (const double(*)[3])e, u, t);
    row_of(rho, u, t, row);
    for (int j = 0; j < 3; j++) {
      const double part = (row[0] * fit[0][j] + row[1] * fit[1][j] + row[2] * fit[2][j]) / 2;
      for (int d = 0; d < 3; d++) B[d][folds[side][j]] += slope[d] * part;
    }
  }
  return true;
}

// The slope across an edge without neighbour is the one without moment: B <- B - v (v.C B)/(v.C v).
static void free_edge(const double C[3][3], const double v[3], double B[3][VSC_BEND_FOLDS])
{
  const double moment[3] = {vsc_dot(C[0], v), vsc_dot(C[1], v), vsc_dot(C[2], v)};
  const double stiffness = vsc_dot(v, moment);
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    const double part =
        (moment[0] * B[0][j] + moment[1] * B[1][j] + moment[2] * B[2][j]) / stiffness;
    for (int d = 0; d < 3; d++) B[d][j] -= part * v[d];
  }
}

// w <- w - v (v.C w)/(v.C v): bending by w then does no work on v.
static void without_moment(const double C[3][3], const double v[3], double w[3])
{
  const double moment[3] = {vsc_dot(C[0], v), vsc_dot(C[1], v), vsc_dot(C[2], v)};
  const double part = vsc_dot(moment, w) / vsc_dot(moment, v);
  for (int d = 0; d < 3; d++) w[d] -= part * v[d];
}

bool vsc_bend_stiffness(const double x[VSC_BEND_NODES][3], const bool has[VSC_BEND_FOLDS], double D,
                        double nu, double G[3][VSC_BEND_FOLDS])
{
  // k = B theta
  double e[3][3], B[3][VSC_BEND_FOLDS] = {{0}}, slope[3][3], C[3][3], softness[3][3], way[3],
                  off[3];
  const double *corners[3] = {x[0], x[1], x[2]};
  basis_of(corners, e);
  plate_matrices(nu, C, softness);
  vsc_subtract(x[1], x[0], way);
  vsc_subtract(x[2], x[0], off);
  const double area = vsc_dot(way, e[0]) * vsc_dot(off, e[1]) / 2;
  for (int i = 0; i < 3; i++) {
    double u[2], t[2];
    edge_axes(x[i], x[(i + 1) % 3], (const double(*)[3])e, u, t);
    vsc_subtract(x[(i + 1) % 3], x[i], way);
    const double size = vsc_norm(way) / area;
    slope[i][0] = size * u[0] * u[0];
    slope[i][1] = size * u[1] * u[1];
    slope[i][2] = size * 2 * u[0] * u[1];
    if (!has[i]) continue;
    for (int d = 0; d < 3; d++) B[d][i] += slope[i][d] / 2;
    if (!add_difference(x, has, i, nu, slope[i], B)) return false;
  }
  for (int i = 0; i < 3; i++) {
    if (has[i]) continue;
    free_edge((const double(*)[3])C, slope[i], B);
    // a further free edge must not bring moment back to this one
    for (int j = i + 1; j < 3; j++)
      if (!has[j]) without_moment((const double(*)[3])C, slope[i], slope[j]);
  }
  // C = R^T R
  const double size = sqrt(D * area), R[3] = {1, sqrt(1 - nu * nu), sqrt((1 - nu) / 2)};
  for (int j = 0; j < VSC_BEND_FOLDS; j++) {
    G[0][j] = size * R[0] * (B[0][j] + nu * B[1][j]);
    G[1][j] = size * R[1] * B[1][j];
    G[2][j] = size * R[2] * B[2][j];
  }
  return true;
}

static void positions_of(const vsc_mesh *mesh, const uint32_t *nodes, double (*x)[3])
{
  for (int i = 0; i < VSC_BEND_NODES; i++)
    memcpy(x[i], mesh->nodes + 3 * (size_t)nodes[i], sizeof x[i]);
}

static void fold_angles(const double x[VSC_BEND_NODES][3], double fold[VSC_BEND_FOLDS])
{
  vsc_wide3 wide[VSC_BEND_NODES];
  vsc_fold folds[VSC_BEND_FOLDS];
  for (int i = 0; i < VSC_BEND_NODES; i++)
    wide[i] = (vsc_wide3){vsc_splat(x[i][0]), vsc_splat(x[i][1]), vsc_splat(x[i][2])};
  vsc_bend_folds(wide, folds);
  for (int j = 0; j < VSC_BEND_FOLDS; j++) fold[j] = folds[j].phi[0];
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
    double x[VSC_BEND_NODES][3], normal[3], a[3], b[3];
    const uint32_t *node = sheet->nodes[k];
    positions_of(mesh, node, x);
    sheet->area[k] = normal_of(x, normal) / 2;
    if (!(sheet->area[k] > 0))
      return vsc_fail(
          error, VSC_INPUT,
          "membrane %s: the triangle of points %u, %u and %u has no area; mend the mesh", def->name,
          mesh->node_source[node[0]], mesh->node_source[node[1]], mesh->node_source[node[2]]);
    axes_of(def->direction, normal, a, b);
    invert_edges(x, a, b, sheet->T[k]);
    if (sheet->G == NULL) continue;
    bool has[VSC_BEND_FOLDS];
    for (int j = 0; j < VSC_BEND_FOLDS; j++)
      has[j] = node[vsc_bend_fold_nodes[j][3]] != node[vsc_bend_fold_nodes[j][0]];
    if (!vsc_bend_stiffness(x, has, def->bending, poisson_ratio(def), sheet->G[k]))
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
      (def->bending > 0 && (!VSC_NEW(sheet->G, count) || !VSC_NEW(sheet->fold, count))))
    return vsc_fail_memory(error, "a membrane");
  for (size_t k = 0; k < count; k++)
    memcpy(sheet->nodes[k], surface->triangles + 3 * k, 3 * sizeof(uint32_t));
  const vsc_status status = find_neighbours(sheet, error);
  return status == VSC_OK ? fill_sheet(mesh, def, sheet, error) : status;
}

void vsc_sheet_free(vsc_sheet *sheet)
{
  vsc_free(sheet->nodes);
  vsc_free(sheet->area);
  vsc_free(sheet->T);
  vsc_free(sheet->G);
  vsc_free(sheet->fold);
  *sheet = (vsc_sheet){0};
}
