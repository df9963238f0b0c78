// SPDX-License-Identifier: GPL-3.0-or-later
// Exponential and logarithm of several doubles at once, from additions, multiplications and divisions
// alone, so that their bits are the same wherever they are compiled. Errors are below 2e-15 of the
// value.
#ifndef VSC_BASE_WIDE_MATH_H
#define VSC_BASE_WIDE_MATH_H

#include "base/wide.h"

// ln 2 in two parts; the first has 32 bits, so that its product with a power's number is exact.
#define VSC_LN2_HIGH 0x1.62e42fee00000p-1
#define VSC_LN2_LOW 0x1.a39ef35793c76p-33
// Added to a number below 2^51, it leaves the nearest whole number in the last bits.
#define VSC_WHOLE 0x1.8p52

typedef uint64_t vsc_wide_bits __attribute__((vector_size(VSC_LANES * sizeof(uint64_t))));

// 2^n of whole numbers n from -1022 to 1023.
VSC_INLINE vsc_wide vsc_wide_power_of_two(vsc_wide n)
{
  const vsc_wide shifted = n + (VSC_WHOLE + 1023);
  return (vsc_wide)((vsc_wide_bits)shifted << 52);
}

// e^x: inf above 709.78, 0 below -745.13, NaN of NaN.
VSC_INLINE vsc_wide vsc_wide_exp(vsc_wide x)
{
  const vsc_wide high = vsc_splat(710), low = vsc_splat(-746);
  x = vsc_select(x > high, high, x);
  x = vsc_select(x < low, low, x);
  // x = n ln 2 + r, |r| <= (ln 2)/2
  const vsc_wide n = (x * 0x1.71547652b82fep0 + VSC_WHOLE) - VSC_WHOLE;
  const vsc_wide r = (x - n * VSC_LN2_HIGH) - n * VSC_LN2_LOW;
  // e^r = sum_k r^k/k!; what is left out is below 5e-18
  vsc_wide sum = vsc_splat(1.0 / 6227020800);
  static const double factorial[] = {479001600, 39916800, 3628800, 362880, 40320, 5040,
                                     720,       120,      24,      6,      2};
  for (int k = 0; k < 11; k++) sum = sum * r + 1.0 / factorial[k];
  sum = (sum * r + 1) * r + 1;
  // in two steps, so that neither overflows before the product does
  const vsc_wide half = (n * 0.5 + VSC_WHOLE) - VSC_WHOLE;
  return sum * vsc_wide_power_of_two(half) * vsc_wide_power_of_two(n - half);
}

// ln x: -inf of 0, NaN below it and of NaN, inf of inf.
VSC_INLINE vsc_wide vsc_wide_log(vsc_wide x)
{
  // numbers too small for a full mantissa are raised by 2^54
  const vsc_wide_mask tiny = x < 0x1p-1022;
  const vsc_wide raised = x * vsc_select(tiny, vsc_splat(0x1p54), vsc_splat(1));
  const vsc_wide_bits bits = (vsc_wide_bits)raised;
  // x = 2^n m, m from sqrt(1/2) to sqrt 2
  const vsc_wide_bits power = ((bits >> 52) & 0x7ff) | (vsc_wide_bits)vsc_splat(0x1p52);
  vsc_wide n = (vsc_wide)power - (0x1p52 + 1023) - vsc_where(tiny, vsc_splat(54));
  vsc_wide m = (vsc_wide)((bits & 0xfffffffffffff) | (vsc_wide_bits)vsc_splat(1));
  const vsc_wide_mask large = m > 0x1.6a09e667f3bcdp0;
  m = vsc_select(large, 0.5 * m, m);
  n += vsc_where(large, vsc_splat(1));
  // ln m = 2 artanh s = 2 sum_k s^(2k+1)/(2k+1), s = (m - 1)/(m + 1); |s| < 0.172
  const vsc_wide s = (m - 1) / (m + 1), square = s * s;
  vsc_wide sum = vsc_splat(2.0 / 23);
  for (int k = 21; k > 1; k -= 2) sum = sum * square + 2.0 / k;
  const vsc_wide mantissa = sum * square * s + 2 * s;
  vsc_wide result = n * VSC_LN2_HIGH + (n * VSC_LN2_LOW + mantissa);
  const vsc_wide infinity = vsc_splat(__builtin_inf());
  result = vsc_select(x < infinity, result, x);
  result = vsc_select(x == 0.0, -infinity, result);
  return vsc_select(x < 0.0, vsc_splat(__builtin_nan("")), result);
}

#endif
