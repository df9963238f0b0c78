// SPDX-License-Identifier: GPL-3.0-or-later
// Curves that are solutions of an equation: the tension of a fibre and the pressure in a ventricle
// over a beat (Bestel, Clement & Sorine 2001, as written in the benchmark of Arostica et al. 2025).
#ifndef VSC_MODEL_CURVE_DRIVER_H
#define VSC_MODEL_CURVE_DRIVER_H

#include <stddef.h>

#include "base/status.h"
#include "model/definition.h"

// values[k], k = 0 .. intervals, of a curve of kind BESTEL or BESTEL_PRESSURE at k . spacing (ms).
// With S+-(x) = (1 +- tanh(x/width))/2 and the systole f(t) = S+(t - start) S-(t - stop):
//
//   BESTEL           a = rate_up f + rate_down (1 - f)
//                    y' = -|a| y + max(a, 0),  y(0) = 0
//   BESTEL_PRESSURE  g = S-(t - stop),  b = rate_up f + rate_down (1 - f) + rate_pre g + rate_mid
//                    y' = -|b| y + max(b, 0) + filling g,  y(0) = 0
//
// y is tau/sigma_0 and p/sigma_mid: a tension of sigma_0 with the curve BESTEL is tau(t), a pressure
// of sigma_mid with BESTEL_PRESSURE is p(t). Both stay below 1 or little above it (tau reaches 0.787
// sigma_0 with the defaults, which are the published constants). The published equations count time
// in seconds, so that sigma_pre is a pressure per second: filling = sigma_pre/sigma_mid . 1/s.
// A curve with a period begins each one at 0.
//
// Integrated by GSL's Runge-Kutta-Prince-Dormand pair (8, 9), error of a step at most 1e-10, steps
// at most a quarter of `width`. VSC_NUMERICAL when steps become too many or too small (rates that are
// huge for the spacing), VSC_SYSTEM for lack of memory.
vsc_status vsc_curve_drive(const vsc_curve_def *definition, double spacing, size_t intervals,
                           double *values, vsc_error *error);

#endif
