// SPDX-License-Identifier: GPL-3.0-or-later
// Single axes: their angles, the percentiles of many.
#include <gsl/gsl_sort_double.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

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
