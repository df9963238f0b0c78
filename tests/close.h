// SPDX-License-Identifier: GPL-3.0-or-later
// Comparing doubles in tests (cmocka 1.1.5 compares floats in single precision).
#ifndef VSC_TESTS_CLOSE_H
#define VSC_TESTS_CLOSE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include <cmocka.h>

// |a - b| <= atol + rtol max(|a|, |b|), and neither is NaN.
#define assert_close(a, b, rtol, atol) close_at((a), (b), (rtol), (atol), __FILE__, __LINE__)

static inline void close_at(double a, double b, double rtol, double atol, const char *file, int line)
{
  if (fabs(a - b) <= atol + rtol * fmax(fabs(a), fabs(b))) return;
  print_error("%.17g != %.17g (difference %.3g, allowed %.3g)\n", a, b, a - b,
              atol + rtol * fmax(fabs(a), fabs(b)));
  _fail(file, line);
}

#endif
