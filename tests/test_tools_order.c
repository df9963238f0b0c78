// SPDX-License-Identifier: GPL-3.0-or-later
// Observed orders of sequences whose order is known.
#include "close.h"
#include "tools/order.h"

// f = F + C h^p with ratios of sizes that differ: everything comes back. The differences lose up to
// 1e-16 F/(C h^p), 1e-11 here at the highest orders.
static void known_sequences_are_recovered(void **state)
{
  (void)state;
  static const double orders[] = {0.5, 1, 1.87, 2, 3, 4};
  static const double sizes[][3] = {{4, 2, 1}, {1, 0.7, 0.3}, {0.3, 0.2, 0.19}};
  for (size_t o = 0; o < 6; o++)
    for (size_t s = 0; s < 3; s++)
      for (int sign = -1; sign <= 1; sign += 2) {
        double f[3];
        for (int k = 0; k < 3; k++) f[k] = 4.5 + sign * 0.8 * pow(sizes[s][k], orders[o]);
        const vsc_order found = vsc_order_of(sizes[s], f);
        const double error = 0.8 * pow(sizes[s][2], orders[o]);
        assert_int_equal(found.trend, VSC_TREND_CONVERGES);
        assert_close(found.order, orders[o], 1e-9, 0);
        assert_close(found.limit, 4.5, 1e-10, 0);
        assert_close(found.uncertainty, 1.25 * error, 1e-8, 0);
      }
}

// By hand: differences 4 and 1 at halved sizes are order 2, the limit a third of the last beyond it.
static void halves(void **state)
{
  (void)state;
  const vsc_order found =
      vsc_order_of((const double[3]){4, 2, 1}, (const double[3]){15, 11, 10});
  assert_close(found.order, 2, 1e-13, 0);
  assert_close(found.limit, 10 - 1.0 / 3, 1e-13, 0);
  assert_close(found.uncertainty, 1.25 / 3, 1e-12, 0);
}

static void what_has_no_order(void **state)
{
  (void)state;
  static const struct {
    double f[3];
    vsc_trend trend;
  } cases[] = {{{1, 2, 1.5}, VSC_TREND_OSCILLATES},
               {{1, 2, 4}, VSC_TREND_DIVERGES},
               {{1, 2, 3}, VSC_TREND_DIVERGES},  // as far each time: order 0
               {{1, 2, 2}, VSC_TREND_STANDS},
               {{2, 2, 3}, VSC_TREND_DIVERGES}};
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    const vsc_order found = vsc_order_of((const double[3]){4, 2, 1}, cases[c].f);
    assert_int_equal(found.trend, cases[c].trend);
    assert_true(isnan(found.order) && isnan(found.limit) && isnan(found.uncertainty));
    assert_true(vsc_trend_text(found.trend)[0] != '\0');
  }
}

static void slopes(void **state)
{
  (void)state;
  double h[4] = {2, 1, 0.7, 0.1}, e[4];
  for (int k = 0; k < 4; k++) e[k] = 3 * pow(h[k], 2.5);
  assert_close(vsc_order_slope(4, h, e), 2.5, 1e-13, 0);
  e[1] = 0;
  e[2] = NAN;
  assert_close(vsc_order_slope(4, h, e), 2.5, 1e-13, 0);
  e[3] = INFINITY;
  assert_true(isnan(vsc_order_slope(4, h, e)));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(known_sequences_are_recovered),
      cmocka_unit_test(halves),
      cmocka_unit_test(what_has_no_order),
      cmocka_unit_test(slopes),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
