// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/order.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_fit.h>
#include <gsl/gsl_roots.h>
#include <math.h>

#define HIGHEST 40.0  // order that is looked for

enum { MOST_ROUNDS = 200, MOST_ERRORS = 64 };

// The sizes as ln(h_0/h_1) and ln(h_1/h_2), and the ratio of the differences.
typedef struct sizes {
  double coarse, fine, ratio;
} sizes;

// (h_0^p - h_1^p)/(h_1^p - h_2^p) over the ratio of the differences, less 1.
static double misfit(double p, void *context)
{
  const sizes *s = context;
  return expm1(p * s->coarse) / -expm1(-p * s->fine) / s->ratio - 1;
}

static double find_order(sizes *s)
{
  gsl_function function = {.function = misfit, .params = s};
  gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
  if (solver == NULL) return NAN;
  double order = NAN;
  if (gsl_root_fsolver_set(solver, &function, 1e-9, HIGHEST) == GSL_SUCCESS)
    for (int k = 0; k < MOST_ROUNDS; k++) {
      if (gsl_root_fsolver_iterate(solver) != GSL_SUCCESS) break;
      order = gsl_root_fsolver_root(solver);
      if (gsl_root_test_interval(gsl_root_fsolver_x_lower(solver), gsl_root_fsolver_x_upper(solver),
                                 0, 1e-14) == GSL_SUCCESS)
        break;
    }
  gsl_root_fsolver_free(solver);
  return order;
}

vsc_order vsc_order_of(const double h[3], const double f[3])
{
  vsc_order o = {VSC_TREND_CONVERGES, NAN, NAN, NAN};
  const double coarse = f[0] - f[1], fine = f[1] - f[2];
  sizes s = {log(h[0] / h[1]), log(h[1] / h[2]), fine == 0 ? 0 : coarse / fine};
  if (fine == 0) o.trend = VSC_TREND_STANDS;
  else if (s.ratio < 0) o.trend = VSC_TREND_OSCILLATES;
  else if (s.ratio == 0 || !(misfit(1e-9, &s) < 0)) o.trend = VSC_TREND_DIVERGES;
  else if (misfit(HIGHEST, &s) < 0) o.trend = VSC_TREND_STANDS;
  if (o.trend != VSC_TREND_CONVERGES) return o;
  o.order = find_order(&s);
  o.limit = f[2] - fine / expm1(o.order * s.fine);
  o.uncertainty = 1.25 * fabs(o.limit - f[2]);
  return o;
}

double vsc_order_slope(size_t count, const double *h, const double *e)
{
  double x[MOST_ERRORS], y[MOST_ERRORS];
  size_t used = 0;
  for (size_t k = 0; k < count && used < MOST_ERRORS; k++) {
    if (!isfinite(e[k]) || e[k] <= 0) continue;
    x[used] = log(h[k]);
    y[used++] = log(e[k]);
  }
  if (used < 2) return NAN;
  // GSL divides by the points less 2 for a variance
  if (used == 2) return (y[1] - y[0]) / (x[1] - x[0]);
  double start, slope, c00, c01, c11, sum;
  gsl_fit_linear(x, 1, y, 1, used, &start, &slope, &c00, &c01, &c11, &sum);
  return slope;
}

const char *vsc_trend_text(vsc_trend trend)
{
  static const char *const texts[] = {
      "converges",
      "not monotone: the differences change their sign, an order has no meaning; take finer runs",
      "no convergence: the differences do not shrink with the size; take finer runs",
      "stands: the last two are equal to rounding"};
  return texts[trend];
}
