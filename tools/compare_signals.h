// SPDX-License-Identifier: GPL-3.0-or-later
// Curves over time: columns of signals.csv beside curves of a reference.
#ifndef VSC_TOOLS_COMPARE_SIGNALS_H
#define VSC_TOOLS_COMPARE_SIGNALS_H

#include "tools/plot/signals.h"

// Which columns belong together.
typedef struct vsc_curve_pair {
  char column[VSC_NAME];     // of the run
  char reference[VSC_NAME];  // of the reference
  char low[VSC_NAME], high[VSC_NAME];  // of the reference: the band; empty: none
} vsc_curve_pair;

// The distance of a from b over the reference's times that the run has: its first and last row and all
// between. Integrals by the trapezoidal rule on these times. Sums of several columns add up.
typedef struct vsc_curve_distance {
  size_t points;     // times
  size_t missing;    // times of the reference before or after the run
  double squares;    // int (a - b)^2 dt
  double reference;  // int b^2 dt
  double largest;    // max |a - b|
  double when;       // the time of that
  size_t banded;     // points that have a band
  size_t within;     // of them those inside it
} vsc_curve_distance;

// "a=b" or "a=b,low,high" taken apart; VSC_INPUT for anything else.
vsc_status vsc_curve_pair_read(const char *text, vsc_curve_pair *pair, vsc_error *error);

// Compares two columns; the first column of each table is the time, in the same unit. The run is
// interpolated linearly. VSC_INPUT for columns that are not there, with what is, and when fewer than two
// times are in common.
vsc_status vsc_curve_compare(const vsc_signals *run, const vsc_signals *reference,
                             const vsc_curve_pair *pair, vsc_curve_distance *distance,
                             vsc_error *error);

// sqrt(squares/reference): 0 for equal curves, infinite where only the reference is zero.
double vsc_curve_relative(const vsc_curve_distance *distance);

// What `viscera compare --signals` does: `run` is a table or a folder that has signals.csv. Prints a row
// for each pair and one for all together. Returns the exit code: 1 when the relative L2 of all together
// is above `tolerance`, or their share within the bands is below `share`, or when either is asked for (a
// finite tolerance, a share above 0) and the run does not reach all times of the reference.
int vsc_compare_signals(const char *run, const char *reference, size_t count,
                        const vsc_curve_pair *pairs, double tolerance, double share);

#endif
