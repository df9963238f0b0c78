// SPDX-License-Identifier: GPL-3.0-or-later
// Exponential and logarithm of four numbers against those of the C library, and at the ends of their
// ranges.
#include "base/wide_math.h"

#include <math.h>

#include "close.h"
#include "random.h"
#include "trap.h"

// The C library's own error is half a unit in the last place or little more: 1.2e-16.
#define ERROR 2e-15

static void check_exp(vsc_wide x)
{
  const vsc_wide y = vsc_wide_exp(x);
  for (int l = 0; l < VSC_WIDTH; l++) assert_close(y[l], exp(x[l]), ERROR, 0);
}

static void check_log(vsc_wide x)
{
  const vsc_wide y = vsc_wide_log(x);
  for (int l = 0; l < VSC_WIDTH; l++) assert_close(y[l], log(x[l]), ERROR, 0);
}

static void exponentials_are_those_of_the_library(void **state)
{
  (void)state;
  uint64_t seed = 1;
  for (int k = 0; k < 100000; k++) {
    vsc_wide x, small;
    for (int l = 0; l < VSC_WIDTH; l++) {
      x[l] = 708 * random_between(&seed, -1, 1);
      small[l] = ldexp(random_between(&seed, -1, 1), -(k % 60));
    }
    check_exp(x);
    check_exp(small);
  }
}

static void exponentials_end_well(void **state)
{
  (void)state;
  trap_off();
  const vsc_wide y = vsc_wide_exp((vsc_wide){0, 1000, -1000, INFINITY});
  assert_true(y[0] == 1 && y[1] == INFINITY && y[2] == 0 && y[3] == INFINITY);
  const vsc_wide z = vsc_wide_exp((vsc_wide){-INFINITY, NAN, 709.75, 709.8});
  assert_true(z[0] == 0 && isnan(z[1]) && isfinite(z[2]) && z[3] == INFINITY);
  // below 2^-1022 numbers have fewer bits: half of the last is the error
  const vsc_wide tiny = vsc_wide_exp((vsc_wide){-708.5, -720, -744, -745.5});
  for (int l = 0; l < 3; l++) assert_close(tiny[l], exp(l == 0 ? -708.5 : l == 1 ? -720 : -744), 0, 0x1p-1073);
  assert_true(tiny[2] > 0 && tiny[3] == 0);
  trap_on();
}

static void logarithms_are_those_of_the_library(void **state)
{
  (void)state;
  uint64_t seed = 2;
  for (int k = 0; k < 100000; k++) {
    vsc_wide x, near;
    for (int l = 0; l < VSC_WIDTH; l++) {
      x[l] = ldexp(1 + 0.5 * random_between(&seed, -1, 1), (int)(1000 * random_between(&seed, -1, 1)));
      near[l] = 1 + ldexp(random_between(&seed, -1, 1), -(k % 50));
    }
    check_log(x);
    check_log(near);
  }
  check_log((vsc_wide){1, 2, 0.5, 0x1.6a09e667f3bcdp0});
  check_log((vsc_wide){0x1p-1022, 0x1p-1074, 3e-310, 1.7e308});
}

static void logarithms_end_well(void **state)
{
  (void)state;
  trap_off();
  const vsc_wide y = vsc_wide_log((vsc_wide){0, -1, INFINITY, NAN});
  assert_true(y[0] == -INFINITY && isnan(y[1]) && y[2] == INFINITY && isnan(y[3]));
  trap_on();
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(exponentials_are_those_of_the_library),
      cmocka_unit_test(exponentials_end_well),
      cmocka_unit_test(logarithms_are_those_of_the_library),
      cmocka_unit_test(logarithms_end_well),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
