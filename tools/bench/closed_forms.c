// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/closed_forms.h"

#include <math.h>
#include <stddef.h>

double vsc_beam_sag(double nu)
{
  const double E = 1e4, L = 10, q = 9.81e-3, G = E / (2 * (1 + nu));
  const double k = 10 * (1 + nu) / (12 + 11 * nu);
  return -q * L * L * L * L / (8 * E / 12) - q * L * L / (2 * k * G);
}

static double sphere_pressure(double a)
{
  const double b = cbrt(8 + a * a * a - 1) / 2;
  return 2 / b + 1 / (2 * pow(b, 4)) - 2 / a - 1 / (2 * pow(a, 4));
}

static double cylinder_pressure(double a)
{
  const double bb = 4 + a * a - 1;
  return log(a / (sqrt(bb) / 2)) + (1 - a * a) / 2 * (1 / bb - 1 / (a * a));
}

// The a in [1, most] at which a rising pressure is p, by bisection to rounding.
static double solve(double (*pressure)(double a), double p, double most)
{
  double low = 1, high = most;
  for (int k = 0; k < 60; k++) {
    const double middle = 0.5 * (low + high);
    *(pressure(middle) < p ? &low : &high) = middle;
  }
  return 0.5 * (low + high);
}

double vsc_sphere_inner(double p)
{
  return solve(sphere_pressure, p, 1.7);
}

double vsc_cylinder_inner(double p)
{
  return solve(cylinder_pressure, p, 100);
}

static const double lame_p = 1e-6, lame_a = 1, lame_b = 2;

double vsc_sphere_move(double nu)
{
  const double K = 1 / (3 * (1 - 2 * nu)), mu = 1 / (2 * (1 + nu));
  const double a3 = pow(lame_a, 3), b3 = pow(lame_b, 3);
  return lame_p * a3 / (b3 - a3) * (lame_a / (3 * K) + b3 / (4 * mu * lame_a * lame_a));
}

double vsc_cylinder_move(double nu)
{
  const double a2 = lame_a * lame_a, b2 = lame_b * lame_b;
  return (1 + nu) * lame_p * a2 / (b2 - a2) * ((1 - 2 * nu) * lame_a + b2 / lame_a);
}

double vsc_cook_rise(double nu)
{
  static const double rises[][2] = {{0.3, 7.952}, {0.4, 7.552}, {0.49, 7.028}, {0.499, 6.965}, {0.4999, 6.9614}};
  for (size_t k = 0; k < sizeof rises / sizeof rises[0]; k++)
    if (nu == rises[k][0]) return rises[k][1];
  return NAN;
}
