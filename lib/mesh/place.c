// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/place.h"

#include <float.h>
#include <math.h>
#include <string.h>

#include "base/vec3.h"

enum { MOST_SIDES = 6, MOST_STEPS = 100 };
#define ROUNDING 1e-14  // of xi, which is of order 1

// A reference element: all xi with side[k] . xi <= bound[k].
typedef struct domain {
  int sides;
  double side[MOST_SIDES][3], bound[MOST_SIDES];
  double start[3];  // a point within
} domain;

static const domain simplex = {
    4, {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {1, 1, 1}}, {0, 0, 0, 1}, {0.25, 0.25, 0.25}};

static const domain domains[VSC_CELLS] = {
    [VSC_HEX] = {6,
                 {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                 {1, 1, 1, 1, 1, 1},
                 {0, 0, 0}},
    [VSC_WEDGE] = {5,
                   {{-1, 0, 0}, {0, -1, 0}, {1, 1, 0}, {0, 0, -1}, {0, 0, 1}},
                   {0, 0, 1, 1, 1},
                   {1.0 / 3, 1.0 / 3, 0}},
    [VSC_PYRAMID] = {6,
                     {{-1, 0, 0}, {0, -1, 0}, {0, 0, -1}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                     {1, 1, 0, 1, 1, 1},
                     {0, 0, 0.25}},
};

static const domain *domain_of(vsc_cell kind)
{
  return kind == VSC_TET || kind == VSC_TET10 ? &simplex : &domains[kind];
}

// Solves the `n` equations M (n x n, then the right side) by elimination; false when singular.
static bool solve(int n, double M[6][7])
{
  for (int k = 0; k < n; k++) {
    int pivot = k;
    for (int i = k + 1; i < n; i++)
      if (fabs(M[i][k]) > fabs(M[pivot][k])) pivot = i;
    if (!(fabs(M[pivot][k]) > ROUNDING)) return false;
    for (int j = k; j <= n; j++) {
      const double kept = M[k][j];
      M[k][j] = M[pivot][j];
      M[pivot][j] = kept;
    }
    for (int i = 0; i < n; i++) {
      if (i == k) continue;
      const double factor = M[i][k] / M[k][k];
      for (int j = k; j <= n; j++) M[i][j] -= factor * M[k][j];
    }
  }
  for (int k = 0; k < n; k++) M[k][n] /= M[k][k];
  return true;
}

// The least squares problem of one step: minimise d . H d / 2 - g . d, scaled so that H is of order 1.
typedef struct step {
  double H[3][3], g[3];
  double slack[MOST_SIDES];  // of each side at xi: bound - side . xi
} step;

// The minimum on the planes of the sides whose bits are set in `active`, by Lagrange's multipliers:
// H d + A^T l = g, A d = slack. False when there is none or it lies outside another side.
static bool minimum_on(const domain *in, const step *s, unsigned active, double d[3])
{
  double M[6][7] = {{0}};
  int n = 3;
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) M[i][j] = s->H[i][j];
  for (int k = 0; k < in->sides; k++) {
    if ((active >> k & 1) == 0) continue;
    for (int i = 0; i < 3; i++) M[i][n] = M[n][i] = in->side[k][i];
    n++;
  }
  int row = 3;
  for (int i = 0; i < 3; i++) M[i][n] = s->g[i];
  for (int k = 0; k < in->sides; k++)
    if ((active >> k & 1) != 0) M[row++][n] = s->slack[k];
  if (!solve(n, M)) return false;
  for (int i = 0; i < 3; i++) d[i] = M[i][n];
  for (int k = 0; k < in->sides; k++)
    if (vsc_dot(in->side[k], d) > s->slack[k] + ROUNDING) return false;
  return true;
}

// The best step that stays within: the free minimum if it does, else the least of those on the sides,
// edges and corners.
static bool best_step(const domain *in, const step *s, double best[3])
{
  double least = INFINITY;
  if (minimum_on(in, s, 0, best)) return true;
  for (unsigned active = 1; active < 1u << in->sides; active++) {
    double d[3];
    if (__builtin_popcount(active) > 3 || !minimum_on(in, s, active, d)) continue;
    double value = -vsc_dot(s->g, d);
    for (int i = 0; i < 3; i++) value += 0.5 * d[i] * vsc_dot(s->H[i], d);
    if (value < least) memcpy(best, d, sizeof d);
    least = fmin(least, value);
  }
  return least < INFINITY;
}

// The nodes of one element and the point to come near to.
typedef struct target {
  vsc_cell kind;
  int nodes;
  double x[VSC_MOST_CORNERS][3], at[3];
} target;

// r = at - sum_i N_i x_i and J_k = sum_i dN_i/dxi_k x_i at xi; returns |r|^2.
static double look(const target *to, const double xi[3], double N[VSC_MOST_CORNERS], double r[3],
                   double J[3][3])
{
  double D[3][VSC_MOST_CORNERS];
  vsc_cell_shape(to->kind, xi, N, D);
  memcpy(r, to->at, 3 * sizeof *r);
  memset(J, 0, 9 * sizeof(double));
  for (int i = 0; i < to->nodes; i++)
    for (int a = 0; a < 3; a++) {
      r[a] -= N[i] * to->x[i][a];
      for (int k = 0; k < 3; k++) J[k][a] += D[k][i] * to->x[i][a];
    }
  return vsc_dot(r, r);
}

static step step_at(const domain *in, const double xi[3], const double r[3], double J[3][3])
{
  step s;
  const double scale = fmax(vsc_dot(J[0], J[0]), fmax(vsc_dot(J[1], J[1]), vsc_dot(J[2], J[2])));
  for (int k = 0; k < 3; k++) {
    // H = J^T J, g = J^T r
    for (int l = 0; l < 3; l++) s.H[k][l] = vsc_dot(J[k], J[l]) / scale;
    s.H[k][k] += ROUNDING;  // at the top of a pyramid two directions are one
    s.g[k] = vsc_dot(J[k], r) / scale;
  }
  for (int k = 0; k < in->sides; k++) s.slack[k] = in->bound[k] - vsc_dot(in->side[k], xi);
  return s;
}

void vsc_place_within(const vsc_mesh *mesh, size_t element, const double at[3], vsc_place *place)
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const domain *in = domain_of(mesh->kinds[element]);
  target to = {.kind = mesh->kinds[element], .nodes = vsc_mesh_kind(mesh, element)->corners};
  for (int i = 0; i < to.nodes; i++)
    memcpy(to.x[i], mesh->nodes + 3 * (size_t)corner[i], sizeof to.x[i]);
  memcpy(to.at, at, sizeof to.at);
  double xi[3], r[3], J[3][3];
  memcpy(xi, in->start, sizeof xi);
  double square = look(&to, xi, place->N, r, J);
  for (int k = 0; k < MOST_STEPS; k++) {
    double d[3], next[3];
    const step s = step_at(in, xi, r, J);
    if (!best_step(in, &s, d) || vsc_norm(d) < ROUNDING) break;
    double found = INFINITY;
    // half as far where curvature makes it worse
    for (double part = 1; found >= square && part > 1e-6; part /= 2) {
      for (int i = 0; i < 3; i++) next[i] = xi[i] + part * d[i];
      found = look(&to, next, place->N, r, J);
    }
    if (found >= square) break;
    memcpy(xi, next, sizeof xi);
    square = found;
  }
  square = look(&to, xi, place->N, r, J);
  place->element = element;
  memcpy(place->xi, xi, sizeof xi);
  place->distance = sqrt(square);
}

// The distance of `at` from the box round an element's nodes, grown by half where its faces may be
// curved; *size is the box's diagonal.
static double box_distance(const vsc_mesh *mesh, size_t element, const double at[3], double *size)
{
  const vsc_cell_kind *kind = vsc_mesh_kind(mesh, element);
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  const double grown = kind->corners > kind->vertices ? 0.25 : 0;
  double apart[3], extent[3];
  for (int a = 0; a < 3; a++) {
    double low = INFINITY, high = -INFINITY;
    for (int i = 0; i < kind->corners; i++) {
      low = fmin(low, mesh->nodes[3 * (size_t)corner[i] + (size_t)a]);
      high = fmax(high, mesh->nodes[3 * (size_t)corner[i] + (size_t)a]);
    }
    extent[a] = high - low;
    apart[a] = fmax(0, fmax(low - at[a], at[a] - high));
  }
  *size = vsc_norm(extent);
  return fmax(0, vsc_norm(apart) - grown * *size);
}

void vsc_place_find(const vsc_mesh *mesh, const double at[3], vsc_place *place)
{
  place->distance = INFINITY;
  for (size_t e = 0; e < mesh->element_count; e++) {
    double size;
    vsc_place found;
    if (box_distance(mesh, e, at, &size) >= place->distance) continue;
    vsc_place_within(mesh, e, at, &found);
    if (found.distance < place->distance) *place = found;
    if (place->distance <= 1e-12 * size) return;
  }
}

void vsc_place_value(const vsc_mesh *mesh, const vsc_place *place, int components,
                     const double *values, double *value)
{
  const uint32_t *corner = vsc_mesh_corners(mesh, place->element);
  const size_t width = (size_t)components;
  for (size_t c = 0; c < width; c++) value[c] = 0;
  for (int i = 0; i < vsc_mesh_kind(mesh, place->element)->corners; i++)
    for (size_t c = 0; c < width; c++) value[c] += place->N[i] * values[width * corner[i] + c];
}
