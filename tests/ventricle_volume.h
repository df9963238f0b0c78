// SPDX-License-Identifier: GPL-3.0-or-later
// What a generated ventricle holds: for tests of its meshes.
#ifndef VSC_TESTS_VENTRICLE_VOLUME_H
#define VSC_TESTS_VENTRICLE_VOLUME_H

#include <math.h>

#include "tools/shapes.h"

static inline double ring_radius(double rs, double rl, double z)
{
  return rs * sqrt(1 - z * z / (rl * rl));
}

// The volume between the ellipsoid of depth `t` (semi-axes rs, rs, rl) and the plane through its ring of the base, mm^3:
// pi rs^2 (b + 2 rl/3 - b^3/(3 rl^2)), b the height at which the line between the rings of both surfaces meets it.
static inline double ventricle_volume(const vsc_lv_shape *lv, double t)
{
  const double rs = (1 - t) * lv->endo_radius + t * lv->epi_radius;
  const double rl = (1 - t) * lv->endo_length + t * lv->epi_length;
  const double top = lv->base + lv->base_rise;
  const double inner = ring_radius(lv->endo_radius, lv->endo_length, lv->base);
  const double outer = ring_radius(lv->epi_radius, lv->epi_length, top);
  double low = 0, high = 1;  // parts of that line
  for (int k = 0; k < 60; k++) {
    const double s = 0.5 * (low + high), r = (inner + s * (outer - inner)) / rs, z = (lv->base + s * lv->base_rise) / rl;
    *(r * r + z * z < 1 ? &low : &high) = s;
  }
  const double b = lv->base + low * lv->base_rise;
  return M_PI * rs * rs * (b + 2 * rl / 3 - b * b * b / (3 * rl * rl));
}

#endif
