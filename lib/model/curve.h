// SPDX-License-Identifier: GPL-3.0-or-later
// A curve of time, tabulated once so that the step only interpolates.
#ifndef VSC_MODEL_CURVE_H
#define VSC_MODEL_CURVE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "model/definition.h"

// Values at equal distances over one period (or over the whole run), linear between them.
typedef struct vsc_curve {
  double period;   // ms; 0: not periodic, flat behind the table, which ends with the run or where the curve rests
  double spacing;  // ms between two values
  size_t intervals;
  double range;    // between its smallest value and its largest, wherever the table ends; 0: a constant
  double *values;  // intervals + 1, owned
  uint64_t hash;   // of the definition, which does not know when the run ends, unless the spacing depends on it
} vsc_curve;

// Tabulates `definition` over its period, in 8192 steps (65536 of a driver) or in 2, 4, 8... times as many where it bends
// within less than 256 of them, up to 2^20; or over [0, end_time] when it has none, in steps of 1/64 ms, or of 1/4096 of
// the time in which it changes if that is less: only for more than 2^20 of them in longer ones.
// Fails with VSC_INPUT for a table that is not rising in time and for values that are not finite, VSC_NUMERICAL for a
// driver's equation that cannot be followed (model/curve_driver.h), and for lack of memory.
vsc_status vsc_curve_build(const vsc_curve_def *definition, double end_time, vsc_curve *curve,
                           vsc_error *error);

// Puts whose curve it is, "LIST[ITEM].REST", before the message of vsc_curve_build; returns its `status`.
vsc_status vsc_curve_of(const char *list, size_t item, const char *rest, vsc_status status, vsc_error *error);

void vsc_curve_free(vsc_curve *curve);  // the content

// The value at `time` (ms); times before 0 have the value of time 0.
double vsc_curve_value(const vsc_curve *curve, double time);

// The largest value of the table.
double vsc_curve_peak(const vsc_curve *curve);

#endif
