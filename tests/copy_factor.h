// SPDX-License-Identifier: GPL-3.0-or-later
// What the linear solver of implicit steps goes on from, copied from one body to another: for tests of stops.
#ifndef VSC_TESTS_COPY_FACTOR_H
#define VSC_TESTS_COPY_FACTOR_H

#include "small_body.h"
#include "solve/implicit.h"

static inline void copy_factor(const small_body *from, small_body *to)
{
  vsc_linear *source = vsc_implicit_newton(from->state)->linear, *target = vsc_implicit_newton(to->state)->linear;
  size_t count, same;
  const double *values = vsc_linear_factorized(source, &count);
  double *copy = vsc_linear_factorized(target, &same);
  assert_int_equal(count, same);
  *vsc_linear_past_of(target) = *vsc_linear_past_of(source);
  memcpy(copy, values, count * sizeof *values);
  vsc_linear_resume(target);
}

#endif
