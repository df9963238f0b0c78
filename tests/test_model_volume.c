// SPDX-License-Identifier: GPL-3.0-or-later
// The energy of a volume ratio: derivative, smoothness at J0, convexity, inverted elements.
#include "close.h"
#include "model/law_volume.h"

static const double K = 30;

static double stress(double J)
{
  return vsc_volume_stress(vsc_splat(K), vsc_splat(J))[3];
}

static double energy(double J)
{
  return vsc_volume_energy(K, J);
}

static void the_values_by_hand(void **state)
{
  (void)state;
  assert_true(energy(1) == 0);
  assert_true(stress(1) == 0);
  // J = 2: K/4 (4 - 1 - 2 ln 2), K/2 (2 - 1/2)
  assert_close(energy(2), K / 4 * (3 - 2 * log(2)), 1e-15, 0);
  assert_close(stress(2), K * 0.75, 1e-15, 0);
  // J0 = 0.2: K/4 (0.04 - 1 + 2 ln 5), K/2 (0.2 - 5) = -2.4 K, U'' = K/2 (1 + 25) = 13 K
  assert_close(energy(0.2), K / 4 * (2 * log(5) - 0.96), 1e-14, 0);
  assert_close(stress(0.2), -2.4 * K, 1e-14, 0);
  // J = 0: 0.2 below J0: U(J0) + 2.4 . 0.2 K + 13 . 0.04/2 K; -2.4 K - 13 . 0.2 K = -5 K
  assert_close(energy(0), energy(0.2) + 0.74 * K, 1e-15, 0);
  assert_close(stress(0), -5 * K, 1e-14, 0);
  // J = -1: 1.2 below: 2.4 . 1.2 + 13 . 1.44/2 = 12.24; -2.4 - 15.6 = -18
  assert_close(energy(-1), energy(0.2) + 12.24 * K, 1e-15, 0);
  assert_close(stress(-1), -18 * K, 1e-15, 0);
}

// Four lanes, each with its own K and J.
static void lanes_are_independent(void **state)
{
  (void)state;
  const vsc_wide moduli = {1, 2, 3, 4}, ratios = {2, 0.2, 0, -1};
  const double expected[4] = {0.75, -4.8, -15, -72};
  const vsc_wide stresses = vsc_volume_stress(moduli, ratios);
  for (int l = 0; l < 4; l++) assert_close(stresses[l], expected[l], 1e-14, 0);
}

// The bulk modulus at rest is K: a fourth-order difference of U', error h^4 U^(5) = 1e-12.
static void k_is_the_bulk_modulus(void **state)
{
  (void)state;
  const double h = 1e-3;
  const double slope =
      (8 * (stress(1 + h) - stress(1 - h)) - stress(1 + 2 * h) + stress(1 - 2 * h)) / (12 * h);
  assert_close(slope, K, 2e-11, 0);
}

static double difference_error(double J, double h)
{
  return fabs((energy(J + h) - energy(J - h)) / (2 * h) - stress(J));
}

// Above J0: error h^2/6 U''' = -h^2/6 K/J^3, order 2. Below, U is a parabola: no error but
// rounding.
static void stress_is_the_derivative_of_energy(void **state)
{
  (void)state;
  const double above[] = {0.25, 0.5, 0.9, 1, 1.3, 3};
  for (int i = 0; i < 6; i++)
    for (int k = 7; k < 10; k++) {
      const double h = ldexp(above[i], -k);
      assert_close(log2(difference_error(above[i], h) / difference_error(above[i], h / 2)), 2, 0,
                   0.01);
      // next term: h^4/120 U^(5), 24/20 (h/J)^2 of the first
      assert_close(difference_error(above[i], h), h * h / 6 * K / pow(above[i], 3), 2e-4, 1e-12);
    }
  const double below[] = {0.1, 0, -0.5, -3};
  for (int i = 0; i < 4; i++)
    // U is up to 4000, its rounding over 2h = 2^-6 some 1e-11
    assert_close(difference_error(below[i], ldexp(1, -7)), 0, 0, 1e-10);
}

// U, U' and U'' from both sides of J0 differ by what the distance 2 delta explains, and no more.
static void the_branches_meet_twice_differentiable(void **state)
{
  (void)state;
  const double J0 = VSC_VOLUME_J0, delta = 1e-7;
  assert_close(energy(J0 + delta) - energy(J0 - delta), 2 * delta * -2.4 * K, 1e-6, 1e-14);
  assert_close(stress(J0 + delta) - stress(J0 - delta), 2 * delta * 13 * K, 1e-5, 1e-13);
  // one-sided slopes of U': U''' = -K/J^3 = -125 K above: 125/13 h/2 of the whole
  const double h = 1e-6;
  const double above = (stress(J0 + h) - stress(J0)) / h, below = (stress(J0) - stress(J0 - h)) / h;
  assert_close(above, 13 * K, 1e-5, 0);
  assert_close(below, 13 * K, 1e-10, 0);
}

static void the_energy_is_convex_and_finite(void **state)
{
  (void)state;
  double before = stress(-5);
  for (int k = 1; k <= 20000; k++) {
    const double J = -5 + k * 1e-3, now = stress(J);
    assert_true(isfinite(energy(J)) && energy(J) >= 0);
    // U'' >= K/2
    assert_true(now - before >= 0.5 * K * 1e-3 * (1 - 1e-9));
    assert_true(J < 1 - 1e-9 ? now < 0 : J < 1 + 1e-9 || now > 0);
    before = now;
  }
  assert_true(isfinite(stress(-1e6)) && isfinite(stress(1e6)));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_values_by_hand),
      cmocka_unit_test(lanes_are_independent),
      cmocka_unit_test(k_is_the_bulk_modulus),
      cmocka_unit_test(stress_is_the_derivative_of_energy),
      cmocka_unit_test(the_branches_meet_twice_differentiable),
      cmocka_unit_test(the_energy_is_convex_and_finite),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
