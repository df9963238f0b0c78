// SPDX-License-Identifier: GPL-3.0-or-later
// The drivers of the benchmark of Arostica et al. 2025: against its published constants and curves, and
// against a Runge-Kutta solution of the equations as they are printed, in seconds.
#include <stdlib.h>
#include <string.h>

#include "close.h"
#include "model/curve.h"
#include "model/curve_driver.h"

// Constants in s and 1/s; sigma_pre and sigma_mid in Pa.
typedef struct printed {
  double t_sys, t_dias, gamma, up, down, pre, mid, sigma_pre, sigma_mid;
} printed;

static const printed tau_1 = {0.16, 0.484, 0.005, 5, -30, 0, 0, 0, 150e3};
static const printed tau_2 = {0.163, 0.5, 0.005, 5, -30, 0, 0, 0, 150e3};
static const printed p_1 = {0.17, 0.484, 0.005, 5, -30, 5, 1, 7e3, 16e3};
static const printed p_left = {0.17, 0.484, 0.005, 5, -30, 5, 15, 12e3, 16e3};
static const printed p_right = {0.17, 0.484, 0.005, 5, -30, 1, 10, 3e3, 4e3};

static double printed_slope(const printed *c, double t, double y)
{
  // S-(x) = 1/(1 + exp(2 x))
  const double minus = 1 / (1 + exp(2 * (t - c->t_dias) / c->gamma));
  const double f = minus / (1 + exp(-2 * (t - c->t_sys) / c->gamma));
  const double b = c->up * f + c->down * (1 - f) + c->pre * minus + c->mid;
  return -fabs(b) * y + c->sigma_mid * fmax(b, 0) + c->sigma_pre * minus;
}

enum { PER_MS = 64, MILLISECONDS = 1000, STEPS = 8 };

// Pa at the multiples of 1/64 ms, by the classical Runge-Kutta method with steps of 1/512 ms.
static double *solve(const printed *c)
{
  const double h = 1e-3 / PER_MS / STEPS;
  double *values = test_calloc(PER_MS * MILLISECONDS + 1, sizeof *values), y = 0;
  for (size_t k = 0; k < STEPS * PER_MS * MILLISECONDS; k++) {
    const double t = h * (double)k;
    const double k1 = printed_slope(c, t, y), k2 = printed_slope(c, t + h / 2, y + h / 2 * k1);
    const double k3 = printed_slope(c, t + h / 2, y + h / 2 * k2);
    y += h / 6 * (k1 + 2 * k2 + 2 * k3 + printed_slope(c, t + h, y + h * k3));
    if ((k + 1) % STEPS == 0) values[(k + 1) / STEPS] = y;
  }
  return values;
}

static vsc_curve_def definition_of(const printed *c)
{
  const bool pressure = c->sigma_pre > 0;
  vsc_curve_def d = vsc_default_curve(pressure ? VSC_CURVE_BESTEL_PRESSURE : VSC_CURVE_BESTEL);
  d.start = 1e3 * c->t_sys;
  d.stop = 1e3 * c->t_dias;
  d.rate_pre = 1e-3 * c->pre;
  d.rate_mid = 1e-3 * c->mid;
  d.filling = 1e-3 * c->sigma_pre / c->sigma_mid;
  return d;
}

static vsc_curve build(const vsc_curve_def *definition)
{
  vsc_curve curve;
  vsc_error error = {.text = ""};
  if (vsc_curve_build(definition, MILLISECONDS, &curve, &error) != VSC_OK) fail_msg("%s", error.text);
  return curve;
}

static void the_defaults_are_the_published_constants(void **state)
{
  (void)state;
  const vsc_curve_def tau = vsc_default_curve(VSC_CURVE_BESTEL), as_tau = definition_of(&tau_1);
  const vsc_curve_def p = vsc_default_curve(VSC_CURVE_BESTEL_PRESSURE), as_p = definition_of(&p_1);
  assert_true(tau.start == as_tau.start && tau.stop == as_tau.stop && tau.width == 5 &&
              tau.rate_up == 0.005 && tau.rate_down == -0.03);
  assert_true(p.start == as_p.start && p.stop == as_p.stop && p.rate_pre == as_p.rate_pre &&
              p.rate_mid == as_p.rate_mid && p.width == 5 && p.rate_up == 0.005 &&
              p.rate_down == -0.03);
  assert_close(p.filling, as_p.filling, 1e-15, 0);
}

// On the table's places the equations' solution, to 1e-9 of sigma: the Runge-Kutta error of 1e-10
// where |a| has its kink; between them (1/64 ms)^2/8 of the curvature, 4e-3/ms^2 where the pressure of
// the left ventricle rises: 1.2e-7. A beat of 1 s has its places elsewhere, nearly as close.
static void curves_solve_the_equations(void **state)
{
  (void)state;
  const printed *const all[] = {&tau_1, &tau_2, &p_1, &p_left, &p_right};
  double places = 0, between = 0, beat = 0;
  for (int i = 0; i < 5; i++) {
    vsc_curve_def d = definition_of(all[i]);
    vsc_curve once = build(&d);
    d.period = MILLISECONDS;
    vsc_curve beats = build(&d);
    double *exact = solve(all[i]);
    for (size_t k = 0; k < PER_MS * MILLISECONDS; k++) {
      const double time = (double)k / PER_MS, value = exact[k] / all[i]->sigma_mid;
      const double next = exact[k + 1] / all[i]->sigma_mid;
      places = fmax(places, fabs(vsc_curve_value(&once, time) - value));
      beat = fmax(beat, fabs(vsc_curve_value(&beats, time) - value));
      if (k == 0) continue;
      // what lines between places leave out, by the second difference
      const double before = exact[k - 1] / all[i]->sigma_mid;
      between = fmax(between, fabs(next - 2 * value + before) / 8);
    }
    test_free(exact);
    vsc_curve_free(&once);
    vsc_curve_free(&beats);
  }
  print_message("off the equations by %.1e on places, %.1e between, %.1e in a beat of 1 s\n", places,
                between, beat);
  assert_true(places < 1e-9);
  assert_true(between < 1.5e-7);
  assert_true(beat < 1.5e-7);
}

// Peaks and their times from a high-order solution, Pa and s, to their last printed digit.
static void peaks_are_the_known_ones(void **state)
{
  (void)state;
  const struct {
    const printed *constants;
    double peak, time;
  } cases[] = {{&tau_1, 118106.4, 0.4795},
               {&tau_2, 120113.5, 0.4955},
               {&p_1, 16074.0, 0.4817},
               {&p_left, 16490.5, 0.4854},
               {&p_right, 4163.2, 0.4836}};
  for (int i = 0; i < 5; i++) {
    const vsc_curve_def d = definition_of(cases[i].constants);
    vsc_curve curve = build(&d);
    const double peak = vsc_curve_peak(&curve);
    assert_close(peak * cases[i].constants->sigma_mid, cases[i].peak, 0, 0.051);
    size_t k = 0;
    while (curve.values[k] < peak) k++;
    // the last digit, and half a place of the table
    assert_close(curve.spacing * (double)k / 1000, cases[i].time, 0, 0.5e-4 + 1e-5);
    vsc_curve_free(&curve);
  }
}

// Figures of the equations of Arostica et al. 2025 (CMAME 435, 117485), solved by Radau's
// method to 1e-10, every fifty milliseconds and on both flanks: s, then Pa to 1e-4, which is 1.3e-8 of the smallest sigma.
static const double published[11][6] = {
    {0.050, 0.0000, 0.0000, 203.8184, 472.1632, 96.8304},
    {0.170, 2337.0439, 640.6571, 303.4291, 1155.2112, 160.5948},
    {0.180, 9319.5335, 7203.1386, 1240.4137, 3843.2589, 558.4430},
    {0.250, 50861.2413, 49362.9508, 9496.9893, 14280.7149, 3001.6314},
    {0.350, 89869.3033, 88960.5442, 14259.8724, 16299.4717, 3948.0773},
    {0.450, 113528.8849, 112977.6986, 15845.2984, 16465.1814, 4139.1614},
    {0.500, 75741.4637, 117175.4323, 10732.6944, 13868.7026, 3220.1256},
    {0.550, 16902.6601, 27780.1743, 2517.9966, 6552.2234, 1184.7998},
    {0.600, 3771.4933, 6198.5947, 590.6472, 3095.0512, 435.8635},
    {0.700, 187.7716, 308.6099, 32.4993, 690.5993, 58.9877},
    {1.000, 0.0232, 0.0381, 0.0054, 7.6719, 0.1462},
};

static void curves_are_the_published_ones(void **state)
{
  (void)state;
  const printed *const columns[] = {&tau_1, &tau_2, &p_1, &p_left, &p_right};
  double worst = 0;
  for (int i = 0; i < 5; i++) {
    const vsc_curve_def d = definition_of(columns[i]);
    vsc_curve curve = build(&d);
    for (size_t row = 0; row < sizeof published / sizeof published[0]; row++) {
      const double expected = published[row][1 + i] / columns[i]->sigma_mid;
      worst = fmax(worst, fabs(vsc_curve_value(&curve, 1000 * published[row][0]) - expected));
    }
    vsc_curve_free(&curve);
  }
  print_message("off by %.1e of sigma at most\n", worst);
  assert_true(worst < 2e-8);
}

static void each_beat_is_like_the_first(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_BESTEL);
  d.period = 800;
  vsc_curve curve = build(&d);
  assert_true(curve.values[0] == 0);
  for (double time = 0; time < 800; time += 12.5)
    assert_true(vsc_curve_value(&curve, time + 1600) == vsc_curve_value(&curve, time));
  vsc_curve_free(&curve);
}

static void checkpoints_tell_drivers_apart(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_BESTEL_PRESSURE);
  vsc_curve first = build(&d);
  d.filling *= 1.5;
  vsc_curve second = build(&d);
  assert_true(first.hash != second.hash);
  vsc_curve_free(&first);
  vsc_curve_free(&second);
}

static void rates_beyond_all_measure_are_refused(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_BESTEL_PRESSURE);
  d.rate_up = 1e12;
  d.filling = 1e12;
  vsc_curve curve;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_curve_build(&d, MILLISECONDS, &curve, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "give slower rates"));
  vsc_curve_free(&curve);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_defaults_are_the_published_constants),
      cmocka_unit_test(curves_solve_the_equations),
      cmocka_unit_test(peaks_are_the_known_ones),
      cmocka_unit_test(curves_are_the_published_ones),
      cmocka_unit_test(each_beat_is_like_the_first),
      cmocka_unit_test(checkpoints_tell_drivers_apart),
      cmocka_unit_test(rates_beyond_all_measure_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
