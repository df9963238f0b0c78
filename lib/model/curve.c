// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/curve.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_spline.h>
#include <math.h>

#include "base/hash.h"
#include "base/mem.h"
#include "model/curve_driver.h"

enum { INTERVALS_OF_PERIOD = 8192, DRIVEN_INTERVALS_OF_PERIOD = 65536, MOST_INTERVALS = 1 << 20 };
enum { INTERVALS_OF_SCALE = 4096, INTERVALS_OF_BEND = 256 };
#define SPACING 0.015625  // ms; of a curve without period, halved for what changes within less than 64 ms

// base^exponent; infinity, without overflow, where that is e^709.78 or more.
static double power_of(double base, double exponent)
{
  return exponent * log(base) < 709.78 ? pow(base, exponent) : INFINITY;
}

static double analytic_value(const vsc_curve_def *d, double time)
{
  const double t = time - d->start;
  switch (d->kind) {
    case VSC_CURVE_RAMP:
      return fmin(fmax(t / d->duration, 0), 1);
    case VSC_CURVE_HALF_SINE:
      return t > 0 && t < d->duration ? sin(M_PI * t / d->duration) : 0;
    case VSC_CURVE_DOUBLE_HILL: {
      if (t <= 0) return 0;
      // g1/(1 + g1) as 1/(1 + 1/g1): infinite powers then do no harm
      return 1 / (1 + power_of(t / d->rise, -d->rise_power)) / (1 + power_of(t / d->fall, d->fall_power));
    }
    case VSC_CURVE_TANH_PAIR:
      return 0.25 * (1 + tanh(t / d->rise)) * (1 - tanh((t - d->duration) / d->fall));
    case VSC_CURVE_CONSTANT:
    case VSC_CURVE_TABLE:
    case VSC_CURVE_BESTEL:
    case VSC_CURVE_BESTEL_PRESSURE:
      break;
  }
  return 1;
}

// The peak of a double Hill curve wherever the table ends: the slope of its logarithm over log t,
// p1/(1 + g1) - p2 g2/(1 + g2), falls from p1 to -p2; its zero by bisection.
static double hill_peak(const vsc_curve_def *d)
{
  double low = log(fmin(d->rise, d->fall)) - 100, high = log(fmax(d->rise, d->fall)) + 100;
  for (int k = 0; k < 100; k++) {
    const double middle = 0.5 * (low + high), t = exp(middle);
    const double slope = d->rise_power / (1 + power_of(t / d->rise, d->rise_power)) -
                         d->fall_power / (1 + power_of(t / d->fall, -d->fall_power));
    if (slope > 0)
      low = middle;
    else
      high = middle;
  }
  return analytic_value(d, d->start + exp(low));
}

// Fills the table from given points by a monotone spline (Steffen 1990).
static vsc_status tabulate_points(const vsc_curve_def *d, vsc_curve *curve, vsc_error *error)
{
  for (size_t k = 1; k < d->point_count; k++)
    if (!(d->times[k] > d->times[k - 1]))
      return vsc_fail(error, VSC_INPUT,
                      "curve table: time %g ms does not come after %g ms; sort the rows by time",
                      d->times[k], d->times[k - 1]);
  const size_t n = d->point_count;
  const gsl_interp_type *type = n > 2 ? gsl_interp_steffen : gsl_interp_linear;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  gsl_spline *spline = gsl_spline_alloc(type, n);
  const bool good =
      spline != NULL && gsl_spline_init(spline, d->times, d->values, n) == GSL_SUCCESS;
  gsl_set_error_handler(handler);
  if (!good) {
    gsl_spline_free(spline);
    return vsc_fail(error, VSC_INPUT, "curve table: %zu points make no curve; give at least 2", n);
  }
  for (size_t k = 0; k <= curve->intervals; k++) {
    const double time = curve->spacing * (double)k;
    const double inside = fmin(fmax(time, d->times[0]), d->times[n - 1]);
    curve->values[k] = gsl_spline_eval(spline, inside, NULL);
  }
  gsl_spline_free(spline);
  return VSC_OK;
}

static bool is_driven(const vsc_curve_def *d)
{
  return d->kind == VSC_CURVE_BESTEL || d->kind == VSC_CURVE_BESTEL_PRESSURE;
}

// Behind this a driver only falls, ms.
static double driven_until(const vsc_curve_def *d)
{
  return d->stop + 10 * d->width;
}

// Formulas go from 0 to 1, the others as their points and their equation say.
static double find_range(const vsc_curve_def *d, const vsc_curve *curve)
{
  if (d->kind == VSC_CURVE_CONSTANT) return 0;
  if (d->kind != VSC_CURVE_TABLE && !is_driven(d)) return 1;
  const double *values = d->kind == VSC_CURVE_TABLE ? d->values : curve->values;
  double count = d->kind == VSC_CURVE_TABLE ? (double)d->point_count : (double)curve->intervals + 1;
  if (is_driven(d) && !(d->period > 0)) count = fmin(count, ceil(driven_until(d) / curve->spacing));
  double low = values[0], high = values[0];
  for (size_t k = 1; (double)k < count; k++) {
    low = fmin(low, values[k]);
    high = fmax(high, values[k]);
  }
  return high - low;
}

// The time in which a curve without period changes, ms.
static double scale_of(const vsc_curve_def *d)
{
  if (d->kind == VSC_CURVE_RAMP || d->kind == VSC_CURVE_HALF_SINE) return d->duration;
  if (d->kind == VSC_CURVE_DOUBLE_HILL || d->kind == VSC_CURVE_TANH_PAIR) return 2 * fmin(d->rise, d->fall);
  if (d->kind == VSC_CURVE_TABLE && d->point_count > 0) return (d->times[d->point_count - 1] - d->times[0]) / 2;
  return 16 * d->width;
}

// When a curve without period has come to rest, ms; tanh is 1 to the last bit from 20 on.
static double rests_from(const vsc_curve_def *d)
{
  if (d->kind == VSC_CURVE_RAMP || d->kind == VSC_CURVE_HALF_SINE) return d->start + d->duration;
  if (d->kind == VSC_CURVE_TANH_PAIR) return d->start + fmax(20 * d->rise, d->duration + 20 * d->fall);
  if (d->kind == VSC_CURVE_TABLE && d->point_count > 0) return d->times[d->point_count - 1];
  return HUGE_VAL;
}

// A table's places do not depend on when the run ends, so that a run can be resumed to a later end. A table with too many
// would have to: the hash then tells the one from the other.
static void place_endless(const vsc_curve_def *d, double end_time, vsc_curve *curve)
{
  curve->spacing = SPACING;
  while (scale_of(d) / curve->spacing < INTERVALS_OF_SCALE && curve->spacing > 0x1p-40) curve->spacing /= 2;
  const double usual = curve->spacing;
  const double last = is_driven(d) ? fmax(end_time, driven_until(d)) : fmin(end_time, rests_from(d));
  while (last / curve->spacing > MOST_INTERVALS) curve->spacing *= 2;
  if (curve->spacing != usual) curve->hash = vsc_hash(curve->hash, &curve->spacing, sizeof curve->spacing);
  curve->intervals = (size_t)fmax(ceil(last / curve->spacing), 1);
}

// The time in which a curve with a period bends the most, ms: 256 places there leave an error of 2e-5 of its range at
// most, 1e-3 at a corner.
static double bend_of(const vsc_curve_def *d)
{
  double least = HUGE_VAL;
  if (d->kind == VSC_CURVE_RAMP || d->kind == VSC_CURVE_HALF_SINE) return d->duration / 4;
  if (d->kind == VSC_CURVE_DOUBLE_HILL) return 4 * fmin(d->rise / d->rise_power, d->fall / d->fall_power);
  if (d->kind == VSC_CURVE_TANH_PAIR) return 2 * fmin(d->rise, d->fall);
  if (is_driven(d)) return d->width;
  for (size_t k = 1; k < d->point_count; k++) least = fmin(least, d->times[k] - d->times[k - 1]);
  return 4 * least;
}

// What is fine enough with the usual places keeps them.
static void place_periodic(const vsc_curve_def *d, vsc_curve *curve)
{
  const double bend = bend_of(d);
  // a driver bends within its width: of a beat of 1 s, 8192 places would leave an error of 4e-6
  curve->intervals = is_driven(d) ? DRIVEN_INTERVALS_OF_PERIOD : INTERVALS_OF_PERIOD;
  while (bend / d->period * (double)curve->intervals < INTERVALS_OF_BEND && curve->intervals < MOST_INTERVALS)
    curve->intervals *= 2;
  curve->spacing = d->period / (double)curve->intervals;
}

static void place_table(const vsc_curve_def *d, double end_time, vsc_curve *curve)
{
  if (d->kind == VSC_CURVE_CONSTANT) {
    curve->intervals = 1;
    curve->spacing = 1;
  } else if (d->period > 0) {
    place_periodic(d, curve);
  } else {
    place_endless(d, end_time, curve);
  }
}

static uint64_t hash_definition(const vsc_curve_def *d)
{
  const double numbers[] = {d->kind,       d->start,      d->duration, d->rise,       d->fall,
                            d->rise_power, d->fall_power, d->period,   d->point_count};
  uint64_t hash = vsc_hash(VSC_HASH_START, numbers, sizeof numbers);
  const double driver[] = {d->stop,     d->width,    d->rate_up, d->rate_down,
                           d->rate_pre, d->rate_mid, d->filling};
  if (is_driven(d)) hash = vsc_hash(hash, driver, sizeof driver);
  if (d->kind != VSC_CURVE_TABLE) return hash;
  hash = vsc_hash(hash, d->times, d->point_count * sizeof *d->times);
  return vsc_hash(hash, d->values, d->point_count * sizeof *d->values);
}

static vsc_status tabulate(const vsc_curve_def *d, vsc_curve *curve, vsc_error *error)
{
  if (d->kind == VSC_CURVE_TABLE) return tabulate_points(d, curve, error);
  if (is_driven(d))
    return vsc_curve_drive(d, curve->spacing, curve->intervals, curve->values, error);
  const double peak = d->kind == VSC_CURVE_DOUBLE_HILL ? hill_peak(d) : 1;
  for (size_t k = 0; k <= curve->intervals; k++)
    curve->values[k] = analytic_value(d, curve->spacing * (double)k) / peak;
  return VSC_OK;
}

// Of numbers that are too large or too small a formula has no value.
static vsc_status check_values(const vsc_curve *curve, vsc_error *error)
{
  for (size_t k = 0; k <= curve->intervals; k++)
    if (!isfinite(curve->values[k]))
      return vsc_fail(error, VSC_INPUT, "curve: its value at %g ms is not a finite number: give times and powers that are "
                      "less extreme", curve->spacing * (double)k);
  return VSC_OK;
}

vsc_status vsc_curve_build(const vsc_curve_def *d, double end_time, vsc_curve *curve,
                           vsc_error *error)
{
  *curve = (vsc_curve){.period = d->period, .hash = hash_definition(d)};
  place_table(d, end_time, curve);
  if (!VSC_NEW(curve->values, curve->intervals + 1)) return vsc_fail_memory(error, "a curve");
  vsc_status status = tabulate(d, curve, error);
  if (status == VSC_OK) status = check_values(curve, error);
  if (status == VSC_OK) curve->range = find_range(d, curve);
  return status;
}

vsc_status vsc_curve_of(const char *list, size_t item, const char *rest, vsc_status status, vsc_error *error)
{
  if (error == NULL || (status != VSC_INPUT && status != VSC_NUMERICAL)) return status;
  const vsc_error bare = *error;
  return vsc_fail(error, status, "%s[%zu].%s%s", list, item, rest, bare.text);
}

void vsc_curve_free(vsc_curve *curve)
{
  vsc_free(curve->values);
  *curve = (vsc_curve){0};
}

double vsc_curve_value(const vsc_curve *curve, double time)
{
  if (!(time > 0)) return curve->values[0];
  const double local = curve->period > 0 ? fmod(time, curve->period) : time;
  const double place = local / curve->spacing;
  if (!(place < (double)curve->intervals)) return curve->values[curve->intervals];
  const size_t k = (size_t)place;
  const double part = place - (double)k;
  return curve->values[k] + part * (curve->values[k + 1] - curve->values[k]);
}

double vsc_curve_peak(const vsc_curve *curve)
{
  double peak = curve->values[0];
  for (size_t k = 1; k <= curve->intervals; k++) peak = fmax(peak, curve->values[k]);
  return peak;
}
