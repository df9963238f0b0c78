// SPDX-License-Identifier: GPL-3.0-or-later
// Vectors of three doubles, as plain arrays.
#ifndef VSC_BASE_VEC3_H
#define VSC_BASE_VEC3_H

#include <math.h>

static inline double vsc_dot(const double a[3], const double b[3])
{
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static inline void vsc_cross(const double a[3], const double b[3], double product[3])
{
  const double x = a[1] * b[2] - a[2] * b[1];
  const double y = a[2] * b[0] - a[0] * b[2];
  const double z = a[0] * b[1] - a[1] * b[0];
  product[0] = x;
  product[1] = y;
  product[2] = z;
}

static inline void vsc_subtract(const double a[3], const double b[3], double difference[3])
{
  for (int i = 0; i < 3; i++) difference[i] = a[i] - b[i];
}

static inline double vsc_norm(const double a[3])
{
  return sqrt(vsc_dot(a, a));
}

// Scales `a` to length 1 and returns its former length; a zero vector stays and gives 0.
static inline double vsc_normalize(double a[3])
{
  const double length = vsc_norm(a);
  if (length > 0)
    for (int i = 0; i < 3; i++) a[i] /= length;
  return length;
}

// (b - a) x (c - a) . (d - a) / 6: the volume of a tetrahedron, positive when b, c, d turn
// counter-clockwise seen from outside (VTK's order).
static inline double vsc_tet_volume(const double a[3], const double b[3], const double c[3],
                                    const double d[3])
{
  double ab[3], ac[3], ad[3], n[3];
  vsc_subtract(b, a, ab);
  vsc_subtract(c, a, ac);
  vsc_subtract(d, a, ad);
  vsc_cross(ab, ac, n);
  return vsc_dot(n, ad) / 6;
}

#endif
