// SPDX-License-Identifier: GPL-3.0-or-later
// Single axes: their angles, the top eigenvector, the percentiles of many.
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_double.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/sample.h"

void vsc_fiber_angles(const double fiber[3], double *azimuth, double *elevation)
{
  const double degrees = 180 / M_PI;
  double x = fiber[0], y = fiber[1], z = fiber[2];
  if (y < 0 || (y == 0 && (x < 0 || (x == 0 && z < 0)))) x = -x, y = -y, z = -z;
  *azimuth = y == 0 ? 0 : atan2(y, x) * degrees;
  if (*azimuth >= 180) {  // y is so small that the angle was rounded up
    *azimuth = 0;
    z = -z;
  }
  *elevation = atan2(z, hypot(x, y)) * degrees;
}

// The sizes fit, so GSL has nothing to call its error handler for; its workspace lies on the stack.
void vsc_add_square(const double v[3], double factor, double sum[6])
{
  for (int i = 0, k = 0; i < 3; i++)
    for (int j = i; j < 3; j++) sum[k++] += factor * v[i] * v[j];
}

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

static void percentiles(double *values, size_t count, double at[3])
{
  static const double parts[3] = {0.1, 0.5, 0.9};
  gsl_sort(values, 1, count);
  for (int i = 0; i < 3; i++)
    at[i] = count == 0 ? 0 : gsl_stats_quantile_from_sorted_data(values, 1, count, parts[i]);
}

vsc_status vsc_fiber_describe(const vsc_axes *axes, vsc_fiber_report *report, vsc_error *error)
{
  double *azimuth, *elevation = NULL;
  if (!VSC_NEW(azimuth, axes->count) || !VSC_NEW(elevation, axes->count)) {
    vsc_free(azimuth);
    return vsc_fail_memory(error, "the fibre report");
  }
  size_t known = 0;
  for (size_t e = 0; e < axes->count; e++)
    if (axes->known[e]) {
      vsc_fiber_angles(vsc_axes_frame(axes, e, 0), &azimuth[known], &elevation[known]);
      known++;
    }
  percentiles(azimuth, known, report->azimuth);
  percentiles(elevation, known, report->elevation);
  report->elements = axes->count;
  report->passive = axes->count - known;
  report->with_data = known - report->filled;
  vsc_free(azimuth);
  vsc_free(elevation);
  return VSC_OK;
}
