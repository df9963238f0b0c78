// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/curves.h"

#include <gsl/gsl_sort.h>
#include <gsl/gsl_statistics_double.h>
#include <math.h>

double vsc_curve_at(size_t count, const double *times, const double *values, double time)
{
  if (time <= times[0]) return values[0];
  size_t k = 1;
  while (k < count && times[k] < time) k++;
  if (k == count) return values[count - 1];
  const double part = (time - times[k - 1]) / (times[k] - times[k - 1]);
  return values[k - 1] + part * (values[k] - values[k - 1]);
}

double vsc_relative_distance(size_t count, const double *a, const double *b)
{
  double apart = 0, whole = 0;
  for (size_t k = 0; k < count; k++) {
    apart += (a[k] - b[k]) * (a[k] - b[k]);
    whole += b[k] * b[k];
  }
  return whole > 0 ? sqrt(apart / whole) : NAN;
}

double vsc_band_share(size_t count, const double *values, const double *low, const double *high,
                      double slack)
{
  size_t within = 0;
  for (size_t k = 0; k < count; k++)
    within += values[k] >= low[k] - slack && values[k] <= high[k] + slack;
  return count > 0 ? (double)within / (double)count : NAN;
}

// The part of one curve's numbers that lie in the band of the others.
static double share_among_others(size_t count, size_t rows, const double *const *curves, size_t one, double slack)
{
  double within = 0;
  for (size_t r = 0; r < rows; r++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t k = 0; k < count; k++) {
      if (k == one) continue;
      low = fmin(low, curves[k][r]);
      high = fmax(high, curves[k][r]);
    }
    within += vsc_band_share(1, &curves[one][r], &low, &high, slack);
  }
  return within / (double)rows;
}

double vsc_left_out_share(size_t count, size_t rows, const double *const *curves, double slack)
{
  double shares[VSC_MOST_CURVES];
  if (count < 2 || count > VSC_MOST_CURVES) return NAN;
  for (size_t k = 0; k < count; k++) shares[k] = share_among_others(count, rows, curves, k, slack);
  gsl_sort(shares, 1, count);
  return gsl_stats_median_from_sorted_data(shares, 1, count);
}

double vsc_observed_order(size_t count, const double *h, const double *errors)
{
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (size_t k = 0; k < count; k++) {
    if (isnan(errors[k]) || errors[k] <= 0) continue;
    const double a = log(h[k]), b = log(errors[k]);
    n++;
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const double spread = n * xx - x * x;
  return n >= 2 && spread > 0 ? (n * xy - x * y) / spread : NAN;
}

double vsc_own_order(const double h[3], const double values[3])
{
  const double ratio = h[0] / h[1];
  if (!(ratio > 1) || fabs(h[1] / h[2] - ratio) > 1e-9 * ratio) return NAN;
  return log(fabs(values[0] - values[1]) / fabs(values[1] - values[2])) / log(ratio);
}

double vsc_curve_frequency(size_t count, const double *times, const double *values)
{
  double first = NAN, last = NAN, passages = 0;
  for (size_t k = 1; k < count; k++) {
    if ((values[k - 1] < 0) == (values[k] < 0)) continue;
    last = times[k - 1] - values[k - 1] * (times[k] - times[k - 1]) / (values[k] - values[k - 1]);
    if (passages++ == 0) first = last;
  }
  return passages >= 2 ? 0.5 * (passages - 1) / (last - first) : NAN;
}

// Square of the windowed Fourier amplitude at a frequency.
static double amplitude_at(size_t count, const double *times, const double *values, double mean, double frequency)
{
  const double span = times[count - 1] - times[0];
  double real = 0, imaginary = 0;
  for (size_t k = 0; k < count; k++) {
    const double window = sin(M_PI * (times[k] - times[0]) / span), turn = 2 * M_PI * frequency * times[k];
    real += window * window * (values[k] - mean) * cos(turn);
    imaginary += window * window * (values[k] - mean) * sin(turn);
  }
  return real * real + imaginary * imaginary;
}

double vsc_curve_tone(size_t count, const double *times, const double *values, double low, double high)
{
  enum { STEPS = 200 };
  double amplitude[STEPS + 1];
  int most = 0;
  if (count < 4) return NAN;
  const double mean = gsl_stats_mean(values, 1, count), step = (high - low) / STEPS;
  for (int k = 0; k <= STEPS; k++) {
    amplitude[k] = amplitude_at(count, times, values, mean, low + k * step);
    if (amplitude[k] > amplitude[most]) most = k;
  }
  if (most == 0 || most == STEPS) return NAN;
  const double before = amplitude[most - 1], after = amplitude[most + 1],
               bend = before - 2 * amplitude[most] + after;
  return low + step * (most + (bend < 0 ? 0.5 * (before - after) / bend : 0));
}
