// SPDX-License-Identifier: GPL-3.0-or-later
// Arithmetic of errors and curves: values given at rising times (or other abscissae).
#ifndef VSC_TOOLS_BENCH_CURVES_H
#define VSC_TOOLS_BENCH_CURVES_H

#include <stddef.h>

enum { VSC_MOST_CURVES = 32 };

// The value at `time` between the two nearest of `count` points, linearly; the first or last value
// outside.
double vsc_curve_at(size_t count, const double *times, const double *values, double time);

// || a - b || / || b || over `count` numbers (Euclidean norms); NAN where b is 0.
double vsc_relative_distance(size_t count, const double *a, const double *b);

// The part, 0 to 1, of `count` numbers with low - slack <= value <= high + slack.
double vsc_band_share(size_t count, const double *values, const double *low, const double *high,
                      double slack);

// Of `count` curves of `rows` numbers each: the median over the curves of the part of their numbers that lie between
// the least and the most of all other curves, as above; NAN for fewer than two or more than VSC_MOST_CURVES.
double vsc_left_out_share(size_t count, size_t rows, const double *const *curves, double slack);

// The exponent p of error ~ h^p by least squares of the logarithms, over the points with a positive
// error; NAN for fewer than two.
double vsc_observed_order(size_t count, const double *h, const double *errors);

// The exponent p from values[0..2] with steps h[0] > h[1] > h[2], each the same part of the one before, by
// their differences: p = log (|v0 - v1| / |v1 - v2|) / log (h0 / h1); NAN where the steps are not so.
double vsc_own_order(const double h[3], const double values[3]);

// Oscillations per unit of time: half the number of passages through 0 (linear between points) behind
// the first, over the time from the first to the last; NAN for fewer than two passages.
double vsc_curve_frequency(size_t count, const double *times, const double *values);

// The frequency, per unit of time, from `low` to `high` at which `count` values about their mean have the largest Fourier
// amplitude, windowed by sin^2 over their times (Hann), which lie evenly: a parabola through the three largest of 200
// steps. NAN where it is largest at `low` or `high`, or for fewer than four values.
double vsc_curve_tone(size_t count, const double *times, const double *values, double low, double high);

#endif
