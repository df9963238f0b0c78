// SPDX-License-Identifier: GPL-3.0-or-later
// Four doubles at once, as a GCC/Clang vector type: the same text compiles to AVX2, SSE2 or NEON
// and, with contraction off, gives the same bits on all of them. Nothing else knows the width.
#ifndef VSC_BASE_WIDE_H
#define VSC_BASE_WIDE_H

#include <stdint.h>

enum { VSC_WIDTH = 4 };

typedef double vsc_wide __attribute__((vector_size(VSC_WIDTH * sizeof(double))));
typedef int64_t vsc_wide_mask __attribute__((vector_size(VSC_WIDTH * sizeof(int64_t))));

// Vectors never cross a real call: every function on them is inlined.
#define VSC_INLINE static inline __attribute__((always_inline))

VSC_INLINE vsc_wide vsc_splat(double a)
{
  return (vsc_wide){a, a, a, a};
}

VSC_INLINE vsc_wide vsc_wide_sqrt(vsc_wide a)
{
#ifdef __AVX__
  return __builtin_ia32_sqrtpd256(a);
#else
  for (int l = 0; l < VSC_WIDTH; l++) a[l] = __builtin_sqrt(a[l]);
  return a;
#endif
}

// Where `mask` is true `a`, else `b`.
VSC_INLINE vsc_wide vsc_select(vsc_wide_mask mask, vsc_wide a, vsc_wide b)
{
  return (vsc_wide)((mask & (vsc_wide_mask)a) | (~mask & (vsc_wide_mask)b));
}

// `a` where `mask` is true, else 0.
VSC_INLINE vsc_wide vsc_where(vsc_wide_mask mask, vsc_wide a)
{
  return (vsc_wide)(mask & (vsc_wide_mask)a);
}

// 1/a where `a` is above `least`, at least 0, and 0 elsewhere, where nothing is divided.
VSC_INLINE vsc_wide vsc_wide_inverse(vsc_wide a, double least)
{
  const vsc_wide_mask some = a > least;
  return vsc_where(some, 1.0 / vsc_select(some, a, vsc_splat(1)));
}

// Rows become columns: four points (x, y, z, w) in, their x, y, z, w out; and back.
VSC_INLINE void vsc_transpose(vsc_wide *a, vsc_wide *b, vsc_wide *c, vsc_wide *d)
{
  const vsc_wide ab_low = __builtin_shufflevector(*a, *b, 0, 4, 2, 6);
  const vsc_wide ab_high = __builtin_shufflevector(*a, *b, 1, 5, 3, 7);
  const vsc_wide cd_low = __builtin_shufflevector(*c, *d, 0, 4, 2, 6);
  const vsc_wide cd_high = __builtin_shufflevector(*c, *d, 1, 5, 3, 7);
  *a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  *b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  *c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  *d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
}

// Four vectors of three components.
typedef struct vsc_wide3 {
  vsc_wide x, y, z;
} vsc_wide3;

VSC_INLINE vsc_wide vsc_wide_dot(vsc_wide3 a, vsc_wide3 b)
{
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

VSC_INLINE vsc_wide3 vsc_wide_cross(vsc_wide3 a, vsc_wide3 b)
{
  return (vsc_wide3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

VSC_INLINE vsc_wide3 vsc_wide_scale(vsc_wide factor, vsc_wide3 a)
{
  return (vsc_wide3){factor * a.x, factor * a.y, factor * a.z};
}

VSC_INLINE vsc_wide3 vsc_wide_add(vsc_wide3 a, vsc_wide3 b)
{
  return (vsc_wide3){a.x + b.x, a.y + b.y, a.z + b.z};
}

VSC_INLINE vsc_wide3 vsc_wide_minus(vsc_wide3 a, vsc_wide3 b)
{
  return (vsc_wide3){a.x - b.x, a.y - b.y, a.z - b.z};
}

// a b + c d + e f, vectors scaled and added in this order.
VSC_INLINE vsc_wide3 vsc_wide_combine(vsc_wide a, vsc_wide3 b, vsc_wide c, vsc_wide3 d, vsc_wide e,
                                      vsc_wide3 f)
{
  return (vsc_wide3){a * b.x + c * d.x + e * f.x, a * b.y + c * d.y + e * f.y,
                     a * b.z + c * d.z + e * f.z};
}

#endif
