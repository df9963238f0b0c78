// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/curve_driver.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_odeiv2.h>
#include <math.h>

enum { MOST_STEPS = 100000 };  // between two values
static const double ACCURACY = 1e-10;

// S-(x) = (1 - tanh x)/2; S+(x) = S-(-x).
static double off(double x)
{
  return (1 - tanh(x)) / 2;
}

static int slope(double time, const double y[], double dydt[], void *parameters)
{
  const vsc_curve_def *d = parameters;
  const bool pressure = d->kind == VSC_CURVE_BESTEL_PRESSURE;
  const double g = off((time - d->stop) / d->width);
  const double f = off((d->start - time) / d->width) * g;
  // a = alpha_max f + alpha_min (1 - f); b has alpha_pre g + alpha_mid besides
  double rate = d->rate_up * f + d->rate_down * (1 - f);
  if (pressure) rate += d->rate_pre * g + d->rate_mid;
  // y' = -|a| y + max(a, 0), and filling g
  dydt[0] = -fabs(rate) * y[0] + fmax(rate, 0) + (pressure ? d->filling * g : 0);
  return GSL_SUCCESS;
}

static vsc_status follow(gsl_odeiv2_driver *driver, double spacing, size_t intervals,
                         double *values, vsc_error *error)
{
  double time = 0, y[1] = {0};
  values[0] = 0;
  for (size_t k = 1; k <= intervals; k++) {
    const int outcome = gsl_odeiv2_driver_apply(driver, &time, spacing * (double)k, y);
    if (outcome != GSL_SUCCESS || !isfinite(y[0]))
      return vsc_fail(error, VSC_NUMERICAL,
                      "curve: its equation cannot be followed at %g ms (%s); give slower rates or a "
                      "wider width",
                      time, outcome != GSL_SUCCESS ? gsl_strerror(outcome) : "no finite value");
    values[k] = y[0];
  }
  return VSC_OK;
}

vsc_status vsc_curve_drive(const vsc_curve_def *definition, double spacing, size_t intervals,
                           double *values, vsc_error *error)
{
  const gsl_odeiv2_system system = {.function = slope, .dimension = 1, .params = (void *)definition};
  const double most = definition->width / 4, first = fmin(spacing, most);
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  gsl_odeiv2_driver *driver =
      gsl_odeiv2_driver_alloc_y_new(&system, gsl_odeiv2_step_rk8pd, first, ACCURACY, ACCURACY);
  vsc_status status = VSC_SYSTEM;
  if (driver == NULL) {
    vsc_fail_memory(error, "a curve's equation");
  } else {
    gsl_odeiv2_driver_set_hmax(driver, most);
    gsl_odeiv2_driver_set_nmax(driver, MOST_STEPS);
    status = follow(driver, spacing, intervals, values, error);
    gsl_odeiv2_driver_free(driver);
  }
  gsl_set_error_handler(handler);
  return status;
}
