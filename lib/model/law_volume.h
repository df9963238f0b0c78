// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of a volume ratio J:
//
//   U(J) = K/4 (J^2 - 1 - 2 ln J)   for J >= J0 = 0.2,  its second-order Taylor polynomial below:
//
// convex, finite everywhere, twice continuously differentiable, and pushing an inverted element
// out. U'(J) = K/2 (J - 1/J); U''(J) = K/2 (1 + 1/J^2); K is the bulk modulus at rest (U''(1) = K).
#ifndef VSC_MODEL_LAW_VOLUME_H
#define VSC_MODEL_LAW_VOLUME_H

#include <math.h>

#include "base/wide_math.h"

#define VSC_VOLUME_J0 0.2
#define VSC_VOLUME_SLOPE0 (0.5 * (1 + 1 / (VSC_VOLUME_J0 * VSC_VOLUME_J0)))  // U''(J0)/K

// U'(J): minus the pressure, kPa.
VSC_INLINE vsc_wide vsc_volume_stress(vsc_wide K, vsc_wide J)
{
  const vsc_wide J0 = vsc_splat(VSC_VOLUME_J0);
  const vsc_wide kept = vsc_select(J > J0, J, J0);
  return K * (0.5 * (kept - 1.0 / kept) + VSC_VOLUME_SLOPE0 * (J - kept));
}

// U''(J), kPa.
VSC_INLINE vsc_wide vsc_volume_curvature(vsc_wide K, vsc_wide J)
{
  const vsc_wide J0 = vsc_splat(VSC_VOLUME_J0);
  const vsc_wide kept = vsc_select(J > J0, J, J0);
  return 0.5 * K * (1 + 1.0 / (kept * kept));
}

// -m ln J and its derivatives by J, m the rest shear of a material (kPa): what keeps a law that is a
// function of the full deformation free of stress at rest. Below J0 the second-order Taylor polynomial
// of -ln J, as in U.

// -m/J, kPa.
VSC_INLINE vsc_wide vsc_rest_stress(vsc_wide m, vsc_wide J)
{
  const vsc_wide J0 = vsc_splat(VSC_VOLUME_J0);
  const vsc_wide kept = vsc_select(J > J0, J, J0);
  return -m * (1.0 / kept - (J - kept) / (VSC_VOLUME_J0 * VSC_VOLUME_J0));
}

// m/J^2, kPa.
VSC_INLINE vsc_wide vsc_rest_curvature(vsc_wide m, vsc_wide J)
{
  const vsc_wide J0 = vsc_splat(VSC_VOLUME_J0);
  const vsc_wide kept = vsc_select(J > J0, J, J0);
  return m / (kept * kept);
}

// -m ln J, kPa = uJ/mm^3.
static inline double vsc_rest_energy(double m, double J)
{
  const double kept = J > VSC_VOLUME_J0 ? J : VSC_VOLUME_J0;
  const double below = (J - kept) / VSC_VOLUME_J0;
  return m * (0.5 * below * below - below - log(kept));
}

// U(J), kPa = uJ/mm^3.
VSC_INLINE vsc_wide vsc_volume_energies(vsc_wide K, vsc_wide J)
{
  const vsc_wide J0 = vsc_splat(VSC_VOLUME_J0);
  const vsc_wide kept = vsc_select(J > J0, J, J0), below = J - kept;
  const vsc_wide slope = 0.5 * (kept - 1.0 / kept);
  return K * (0.25 * (kept * kept - 1 - 2 * vsc_wide_log(kept)) + slope * below +
              0.5 * VSC_VOLUME_SLOPE0 * below * below);
}

// Of one.
static inline double vsc_volume_energy(double K, double J)
{
  return vsc_volume_energies(vsc_splat(K), vsc_splat(J))[0];
}

#endif
