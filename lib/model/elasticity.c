// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/elasticity.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "base/vec3.h"

void vsc_axis_row(const double d[3], double row[6])
{
  for (int i = 0; i < 3; i++) {
    row[i] = d[i] * d[i];
    row[3 + i] = d[(i + 1) % 3] * d[(i + 2) % 3];
  }
}

void vsc_pair_row(const double d[3], const double e[3], double row[6])
{
  const double rest = vsc_dot(d, e);
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    row[i] = 2 * d[i] * e[i] - rest * (d[i] * d[i] + e[i] * e[i]);
    row[3 + i] = d[j] * e[k] + d[k] * e[j] - rest * (d[j] * d[k] + e[j] * e[k]);
  }
}

void vsc_stiffness_add(double C[36], double modulus, const double row[6])
{
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) C[6 * i + j] += modulus * row[i] * row[j];
}

// The unit vector of axis `a`: 0 f, 1 s, 2 n, 3 the first of the further axes.
static void axis_direction(const vsc_material_def *material, int a, double d[3])
{
  for (int i = 0; i < 3; i++) d[i] = a < 3 ? a == i : material->axes[a - 3].direction[i];
  vsc_normalize(d);
}

static void add_pair(const vsc_material_def *material, double C[36], int a, int b, double modulus)
{
  double d[3], e[3], row[6];
  axis_direction(material, a, d);
  axis_direction(material, b, e);
  vsc_pair_row(d, e, row);
  vsc_stiffness_add(C, modulus, row);
}

vsc_status vsc_stiffness_of(const vsc_material_def *material, vsc_volume_kind volume, double C[36],
                            vsc_error *error)
{
  static const double dilatation[6] = {1, 1, 1, 0, 0, 0};
  if (material->law != VSC_LAW_SPRINGS)
    return vsc_fail(error, VSC_INPUT,
                    "material %s: only law: springs has a stiffness of its own; constants per "
                    "element or edge mean another one on each mesh",
                    material->name);
  memset(C, 0, 36 * sizeof *C);
  for (int a = 0; a < 3 + (int)material->axis_count; a++) {
    double d[3], row[6];
    axis_direction(material, a, d);
    vsc_axis_row(d, row);
    vsc_stiffness_add(C, a < 3 ? material->axial[a] : material->axes[a - 3].modulus, row);
  }
  for (int a = 0; a < 3; a++) add_pair(material, C, a, (a + 1) % 3, material->angular[a]);
  for (int a = 0; a < 3; a++) {
    C[6 * a + (a + 1) % 3] += material->coupling[a];
    C[6 * ((a + 1) % 3) + a] += material->coupling[a];
  }
  for (size_t p = 0; p < material->pair_count; p++)
    add_pair(material, C, material->pairs[p].axes[0], material->pairs[p].axes[1],
             material->pairs[p].modulus);
  const double stabilization = volume == VSC_VOLUME_NODAL ? material->stabilization : 0;
  vsc_stiffness_add(C, material->volume_modulus + stabilization, dilatation);
  return VSC_OK;
}

vsc_status vsc_invert_six(const double matrix[36], double inverse[36], vsc_error *error)
{
  double copy[36];
  memcpy(copy, matrix, sizeof copy);
  gsl_matrix_view view = gsl_matrix_view_array(copy, 6, 6);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  int failed = gsl_linalg_cholesky_decomp1(&view.matrix);
  if (!failed) failed = gsl_linalg_cholesky_invert(&view.matrix);
  gsl_set_error_handler(handler);
  if (failed)
    return vsc_fail(error, VSC_NUMERICAL,
                    "the stiffness is not positive definite: some deformation costs no energy");
  memcpy(inverse, copy, sizeof copy);
  return VSC_OK;
}

double vsc_product_six(const double a[6], const double M[36], const double b[6])
{
  double sum = 0;
  for (int i = 0; i < 6; i++)
    for (int j = 0; j < 6; j++) sum += a[i] * M[6 * i + j] * b[j];
  return sum;
}

double vsc_young(const double S[36], const double d[3])
{
  double row[6];
  vsc_axis_row(d, row);
  return 1 / vsc_product_six(row, S, row);
}

double vsc_shear(const double S[36], const double d[3], const double e[3])
{
  double row[6];
  vsc_pair_row(d, e, row);
  return 1 / vsc_product_six(row, S, row);
}

double vsc_poisson(const double S[36], const double d[3], const double e[3])
{
  double along[6], across[6];
  vsc_axis_row(d, along);
  vsc_axis_row(e, across);
  return -vsc_product_six(across, S, along) / vsc_product_six(along, S, along);
}

vsc_named_direction vsc_direction(int number)
{
  static const vsc_named_direction all[VSC_DIRECTIONS] = {
      {"f", {1, 0, 0}},      {"s", {0, 1, 0}},       {"n", {0, 0, 1}},       {"f+s", {1, 1, 0}},
      {"f-s", {1, -1, 0}},   {"s+n", {0, 1, 1}},     {"s-n", {0, 1, -1}},    {"n+f", {1, 0, 1}},
      {"n-f", {-1, 0, 1}},   {"f+s+n", {1, 1, 1}},   {"f+s-n", {1, 1, -1}},  {"f-s+n", {1, -1, 1}},
      {"f-s-n", {1, -1, -1}}};
  vsc_named_direction direction = all[number];
  vsc_normalize(direction.d);
  return direction;
}

static void note(vsc_young_range *range, double young, const double d[3])
{
  if (young < range->low) memcpy(range->low_direction, d, 3 * sizeof *d);
  if (young > range->high) memcpy(range->high_direction, d, 3 * sizeof *d);
  range->low = fmin(range->low, young);
  range->high = fmax(range->high, young);
}

vsc_young_range vsc_young_over_sphere(const double S[36])
{
  enum { POINTS = 20000 };
  const double turn = M_PI * (3 - sqrt(5));
  vsc_young_range range = {.low = INFINITY, .high = -INFINITY};
  for (int p = 0; p < VSC_DIRECTIONS; p++) {
    const vsc_named_direction direction = vsc_direction(p);
    note(&range, vsc_young(S, direction.d), direction.d);
  }
  for (int p = 0; p < POINTS; p++) {
    const double height = 1 - (2 * p + 1.0) / POINTS, radius = sqrt(1 - height * height);
    const double d[3] = {radius * cos(turn * p), radius * sin(turn * p), height};
    const double young = vsc_young(S, d);
    note(&range, young, d);
    range.mean += young / POINTS;
  }
  return range;
}
