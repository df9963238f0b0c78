// SPDX-License-Identifier: GPL-3.0-or-later
// Several doubles at once, as GCC/Clang vector types: the same text compiles to AVX-512, AVX2, SSE2 or
// NEON and, with contraction off, gives the same bits on all of them. What is stored is stored by four;
// a source file that defines VSC_EIGHT_LANES computes eight at once, two fours side by side.
#ifndef VSC_BASE_WIDE_H
#define VSC_BASE_WIDE_H

#include <stdint.h>

// GCC notes that vectors are passed in other ways than before its version 4.6; none is passed (VSC_INLINE).
#if defined __GNUC__ && !defined __clang__
#pragma GCC diagnostic ignored "-Wpsabi"
#endif

#ifdef VSC_EIGHT_LANES
#include <immintrin.h>
enum { VSC_WIDTH = 4, VSC_LANES = 8 };
#else
enum { VSC_WIDTH = 4, VSC_LANES = 4 };
#endif

typedef double vsc_four __attribute__((vector_size(VSC_WIDTH * sizeof(double))));  // as models store them
typedef double vsc_wide __attribute__((vector_size(VSC_LANES * sizeof(double))));  // as they are computed
typedef int64_t vsc_wide_mask __attribute__((vector_size(VSC_LANES * sizeof(int64_t))));

// A function of loops over vectors, compiled for AVX2 too and picked when the program starts. All that it calls
// with vectors must be inlined. (Not for sanitizers: nothing is, below, and that of threads is not there yet when it is
// picked.)
#if defined __x86_64__ && defined __GNUC__ && !defined __clang__ && !defined __SANITIZE_THREAD__ && \
    !defined __SANITIZE_ADDRESS__
#define VSC_CLONED __attribute__((target_clones("avx2", "default")))
#else
#define VSC_CLONED
#endif

// Vectors never cross a real call: every function on them is inlined, but for sanitizers, whose checks would take
// minutes to compile then (and calls stay within one source file and its instruction set).
#if defined __SANITIZE_ADDRESS__ || defined __SANITIZE_THREAD__
#define VSC_INLINE static inline
#else
#define VSC_INLINE static inline __attribute__((always_inline))
#endif

VSC_INLINE vsc_wide vsc_splat(double a)
{
#ifdef VSC_EIGHT_LANES
  return (vsc_wide){a, a, a, a, a, a, a, a};
#else
  return (vsc_wide){a, a, a, a};
#endif
}

// Two fours side by side; with four lanes the first alone.
VSC_INLINE vsc_wide vsc_join(vsc_four first, vsc_four second)
{
#ifdef VSC_EIGHT_LANES
  // not a shuffle: this one instruction loads what it inserts
  return (vsc_wide)_mm512_insertf64x4(_mm512_castpd256_pd512((__m256d)first), (__m256d)second, 1);
#else
  (void)second;
  return first;
#endif
}

// The four lanes from lane 4 k on.
VSC_INLINE vsc_four vsc_part(vsc_wide a, int k)
{
#ifdef VSC_EIGHT_LANES
  return k == 0 ? __builtin_shufflevector(a, a, 0, 1, 2, 3) : __builtin_shufflevector(a, a, 4, 5, 6, 7);
#else
  (void)k;
  return a;
#endif
}

VSC_INLINE vsc_wide vsc_wide_sqrt(vsc_wide a)
{
#if defined VSC_EIGHT_LANES
  return (vsc_wide)_mm512_sqrt_pd((__m512d)a);
#elif defined __AVX__
  return __builtin_ia32_sqrtpd256(a);
#else
  for (int l = 0; l < VSC_LANES; l++) a[l] = __builtin_sqrt(a[l]);
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

// A vector that is no longer than this has no direction.
#define VSC_NO_LENGTH 1e-6

// 1/a where `a` is above `least`, at least 0, and 0 elsewhere, where nothing is divided.
VSC_INLINE vsc_wide vsc_wide_inverse(vsc_wide a, double least)
{
  const vsc_wide_mask some = a > least;
  return vsc_where(some, 1.0 / vsc_select(some, a, vsc_splat(1)));
}

// Rows become columns: four points (x, y, z, w) in, their x, y, z, w out; and back. Of eight lanes each
// four are a point.
VSC_INLINE void vsc_transpose(vsc_wide *a, vsc_wide *b, vsc_wide *c, vsc_wide *d)
{
#ifdef VSC_EIGHT_LANES
  const vsc_wide ab_low = __builtin_shufflevector(*a, *b, 0, 8, 2, 10, 4, 12, 6, 14);
  const vsc_wide ab_high = __builtin_shufflevector(*a, *b, 1, 9, 3, 11, 5, 13, 7, 15);
  const vsc_wide cd_low = __builtin_shufflevector(*c, *d, 0, 8, 2, 10, 4, 12, 6, 14);
  const vsc_wide cd_high = __builtin_shufflevector(*c, *d, 1, 9, 3, 11, 5, 13, 7, 15);
  *a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 8, 9, 4, 5, 12, 13);
  *b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 8, 9, 4, 5, 12, 13);
  *c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 10, 11, 6, 7, 14, 15);
  *d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 10, 11, 6, 7, 14, 15);
#else
  const vsc_wide ab_low = __builtin_shufflevector(*a, *b, 0, 4, 2, 6);
  const vsc_wide ab_high = __builtin_shufflevector(*a, *b, 1, 5, 3, 7);
  const vsc_wide cd_low = __builtin_shufflevector(*c, *d, 0, 4, 2, 6);
  const vsc_wide cd_high = __builtin_shufflevector(*c, *d, 1, 5, 3, 7);
  *a = __builtin_shufflevector(ab_low, cd_low, 0, 1, 4, 5);
  *b = __builtin_shufflevector(ab_high, cd_high, 0, 1, 4, 5);
  *c = __builtin_shufflevector(ab_low, cd_low, 2, 3, 6, 7);
  *d = __builtin_shufflevector(ab_high, cd_high, 2, 3, 6, 7);
#endif
}

// As many vectors of three components.
typedef struct vsc_wide3 {
  vsc_wide x, y, z;
} vsc_wide3;

// Columns become rows (x, y, z, 0).
VSC_INLINE void vsc_wide_rows(vsc_wide3 a, vsc_wide rows[4])
{
#ifdef VSC_EIGHT_LANES
  // not vsc_transpose: GCC 12 forgets the zero of unpcklpd(z, 0)
  const vsc_wide low = __builtin_shufflevector(a.x, a.y, 0, 8, 2, 10, 4, 12, 6, 14);
  const vsc_wide high = __builtin_shufflevector(a.x, a.y, 1, 9, 3, 11, 5, 13, 7, 15);
  const vsc_wide z_low = (vsc_wide)_mm512_maskz_mov_pd(0x55, (__m512d)a.z);
  const vsc_wide z_high = (vsc_wide)_mm512_maskz_permute_pd(0x55, (__m512d)a.z, 0x55);
  rows[0] = __builtin_shufflevector(low, z_low, 0, 1, 8, 9, 4, 5, 12, 13);
  rows[1] = __builtin_shufflevector(high, z_high, 0, 1, 8, 9, 4, 5, 12, 13);
  rows[2] = __builtin_shufflevector(low, z_low, 2, 3, 10, 11, 6, 7, 14, 15);
  rows[3] = __builtin_shufflevector(high, z_high, 2, 3, 10, 11, 6, 7, 14, 15);
#else
  rows[0] = a.x, rows[1] = a.y, rows[2] = a.z, rows[3] = vsc_splat(0);
  vsc_transpose(&rows[0], &rows[1], &rows[2], &rows[3]);
#endif
}

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
