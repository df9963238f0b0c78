// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/axes.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"

static const double SHORTEST = 1e-6;                    // a fibre vector's length
static const double SINE_OF_1_DEGREE = 0.0174524064372835;

static vsc_axes *create(size_t count, int points)
{
  vsc_axes *axes;
  if (!VSC_NEW(axes, 1)) return NULL;
  const size_t frames = (size_t)points * count;
  axes->count = count;
  axes->points = points;
  if (count > SIZE_MAX / 9 / (size_t)points || !VSC_NEW(axes->frames, 9 * frames) ||
      !VSC_NEW(axes->known, count)) {
    vsc_axes_free(axes);
    return NULL;
  }
  for (size_t i = 0; i < frames; i++)
    for (int axis = 0; axis < 3; axis++) axes->frames[9 * i + 4 * axis] = 1;
  return axes;
}

vsc_axes *vsc_axes_create(size_t count)
{
  return create(count, 1);
}

vsc_axes *vsc_axes_create_for(const vsc_mesh *mesh)
{
  return create(mesh->element_count,
                vsc_mesh_is_quadratic(mesh) ? vsc_cell_rule_of(VSC_TET10).points : 1);
}

void vsc_axes_free(vsc_axes *axes)
{
  if (axes == NULL) return;
  vsc_free(axes->frames);
  vsc_free(axes->known);
  vsc_free(axes);
}

// The unit vector along `vector`, whatever its magnitude; returns its length. Where that is 0 or
// NaN (a component is not finite) `unit` means nothing.
static double direction_of(const double vector[3], double unit[3])
{
  const double largest = fmax(fabs(vector[0]), fmax(fabs(vector[1]), fabs(vector[2])));
  if (largest == 0) return 0;
  for (int i = 0; i < 3; i++) unit[i] = vector[i] / largest;
  return largest * vsc_normalize(unit);
}

// The part of `hint` orthogonal to the unit vector f, normalised; 0 when they are within 1 degree.
static int orthogonal_part(const double hint[3], const double f[3], double s[3])
{
  double unit[3], across[3];
  if (!(direction_of(hint, unit) > 0)) return 0;
  vsc_cross(f, unit, across);
  if (vsc_norm(across) < SINE_OF_1_DEGREE) return 0;
  memcpy(s, unit, sizeof unit);
  for (int pass = 0; pass < 2; pass++) {
    const double along = vsc_dot(s, f);
    for (int i = 0; i < 3; i++) s[i] -= along * f[i];
    vsc_normalize(s);
  }
  return 1;
}

int vsc_axes_complete(const double fiber[3], const double *sheet, double frame[9])
{
  double f[3], s[3], n[3];
  if (!(direction_of(fiber, f) >= SHORTEST)) return 0;
  if (sheet == NULL || !orthogonal_part(sheet, f, s)) {
    double global[3] = {0};
    int least = 0;
    for (int axis = 1; axis < 3; axis++)
      if (fabs(f[axis]) < fabs(f[least])) least = axis;
    global[least] = 1;
    orthogonal_part(global, f, s);
  }
  vsc_cross(f, s, n);
  memcpy(frame, f, sizeof f);
  memcpy(frame + 3, s, sizeof s);
  memcpy(frame + 6, n, sizeof n);
  return 1;
}

void vsc_axes_place(const vsc_axes *axes, const vsc_mesh *mesh, const vsc_cell_rule *rule,
                    size_t element, int point, double at[3])
{
  if (axes->points == 1) {
    vsc_mesh_element_centre(mesh, element, at);
    return;
  }
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  for (int a = 0; a < 3; a++) {
    at[a] = 0;
    for (int i = 0; i < vsc_mesh_kind(mesh, element)->corners; i++)
      at[a] += rule->N[point][i] * mesh->nodes[3 * (size_t)corner[i] + (size_t)a];
  }
}

int vsc_axes_set(vsc_axes *axes, size_t element, const double fiber[3], const double *sheet)
{
  double *frame = vsc_axes_frame(axes, element, 0);
  if (!vsc_axes_complete(fiber, sheet, frame)) return 0;
  for (int q = 1; q < axes->points; q++)
    memcpy(vsc_axes_frame(axes, element, q), frame, 9 * sizeof *frame);
  axes->known[element] = 1;
  return 1;
}

void vsc_axes_finish(vsc_axes *axes, size_t element, int known)
{
  static const double global[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  axes->known[element] = known != 0;
  for (int q = 0; q < axes->points && !known; q++)
    memcpy(vsc_axes_frame(axes, element, q), global, sizeof global);
}

// dx/dxi_k of an element with its nodes at `nodes`, sums over points [first, end) of its rule.
static void tangents(const vsc_mesh *mesh, const vsc_cell_rule *rule, const double *nodes, size_t element,
                     int first, int end, double t[3][3])
{
  const uint32_t *corner = vsc_mesh_corners(mesh, element);
  memset(t, 0, 9 * sizeof(double));
  for (int q = first; q < end; q++)
    for (int k = 0; k < 3; k++)
      for (int i = 0; i < vsc_mesh_kind(mesh, element)->corners; i++)
        for (int a = 0; a < 3; a++)
          t[k][a] += rule->weight[q] * rule->D[q][k][i] * nodes[3 * (size_t)corner[i] + (size_t)a];
}

// F^-1 v = sum_k r_k (v . (t_k+1 x t_k+2))/det, with dx/dxi_k = t_k and r_k at rest.
static void carry_back(double now[3][3], double rest[3][3], const double v[3], double back[3])
{
  double across[3];
  vsc_cross(now[1], now[2], across);
  const double det = vsc_dot(now[0], across);
  memset(back, 0, 3 * sizeof *back);
  for (int k = 0; k < 3; k++) {
    vsc_cross(now[(k + 1) % 3], now[(k + 2) % 3], across);
    for (int a = 0; a < 3; a++) back[a] += vsc_dot(v, across) / det * rest[k][a];
  }
}

void vsc_axes_carry_back(const vsc_axes *axes, const vsc_mesh *mesh, const double *rest, vsc_axes *back)
{
  vsc_cell_rule rules[VSC_CELLS];
  for (int kind = 0; kind < VSC_CELLS; kind++) rules[kind] = vsc_cell_rule_of((vsc_cell)kind);
  memcpy(back->known, axes->known, axes->count * sizeof *axes->known);
  memcpy(back->frames, axes->frames, 9 * (size_t)axes->points * axes->count * sizeof *axes->frames);
  for (size_t e = 0; e < axes->count; e++)
    for (int q = 0; axes->known[e] && q < axes->points; q++) {
      const vsc_cell_rule *rule = &rules[mesh->kinds[e]];
      const int first = axes->points > 1 ? q : 0, end = axes->points > 1 ? q + 1 : rule->points;
      const double *frame = vsc_axes_frame(axes, e, q);
      double now[3][3], before[3][3], f[3], s[3];
      tangents(mesh, rule, mesh->nodes, e, first, end, now);
      tangents(mesh, rule, rest, e, first, end, before);
      carry_back(now, before, frame, f);
      carry_back(now, before, frame + 3, s);
      vsc_axes_complete(f, s, vsc_axes_frame(back, e, q));
    }
}

int vsc_axes_valid(const vsc_axes *axes)
{
  for (size_t i = 0; i < (size_t)axes->points * axes->count; i++) {
    const double *f = axes->frames + 9 * i;
    for (int a = 0; a < 3; a++)
      for (int b = a; b < 3; b++)
        if (!(fabs(vsc_dot(f + 3 * a, f + 3 * b) - (a == b)) <= 1e-9)) return 0;
    double across[3];
    vsc_cross(f, f + 3, across);
    if (!(vsc_dot(across, f + 6) > 0)) return 0;
  }
  return 1;
}

void vsc_add_square(const double v[3], double factor, double sum[6])
{
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++) sum[k++] += factor * v[i] * v[j];
}

// The sizes fit, so GSL has nothing to call its error handler for; its workspace lies on the stack.
int vsc_top_axis(const double matrix[6], double axis[3], double values[3])
{
  double a[9] = {matrix[0], matrix[1], matrix[2], matrix[1], matrix[3],
                 matrix[4], matrix[2], matrix[4], matrix[5]};
  double largest = 0;
  for (int i = 0; i < 6; i++) {
    if (!isfinite(matrix[i])) return 0;
    largest = fmax(largest, fabs(matrix[i]));
  }
  if (largest == 0) return 0;
  for (int i = 0; i < 9; i++) a[i] /= largest;
  double value[3], vector[9], work[4][3];
  gsl_matrix_view a_view = gsl_matrix_view_array(a, 3, 3);
  gsl_matrix_view vector_view = gsl_matrix_view_array(vector, 3, 3);
  gsl_vector_view value_view = gsl_vector_view_array(value, 3);
  gsl_eigen_symmv_workspace space = {
      .size = 3, .d = work[0], .sd = work[1], .gc = work[2], .gs = work[3]};
  if (gsl_eigen_symmv(&a_view.matrix, &value_view.vector, &vector_view.matrix, &space) != 0)
    return 0;
  gsl_eigen_symmv_sort(&value_view.vector, &vector_view.matrix, GSL_EIGEN_SORT_VAL_DESC);
  for (int i = 0; i < 3; i++) axis[i] = vector[3 * i];
  vsc_normalize(axis);
  for (int i = 0; values != NULL && i < 3; i++) values[i] = value[i] * largest;
  return 1;
}
