// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of time against their formulas. A period of 1024 ms makes the table's places the multiples
// of 1/8 ms, where the value must be the formula's to rounding; between them it is linear.
#include <string.h>

#include "close.h"
#include "model/curve.h"
#include "random.h"
#include "trap.h"

static const double PERIOD = 1024, SPACING = 0.125;

static vsc_curve build(const vsc_curve_def *definition, double end_time)
{
  vsc_curve curve;
  vsc_error error;
  assert_int_equal(vsc_curve_build(definition, end_time, &curve, &error), VSC_OK);
  return curve;
}

typedef double formula(const vsc_curve_def *d, double time);

// The table's places exactly, in all periods; between them the error of linear interpolation,
// spacing^2/8 max|f''|, given as `between`, but for `kinks` of the formula: so many places may be
// off.
static void compare(const vsc_curve_def *d, formula *expected, double rtol, double between,
                    int kinks)
{
  vsc_curve curve = build(d, 3000);
  uint64_t seed = 31;
  for (int k = 0; k < 3 * 8192; k += 7) {
    const double time = k * SPACING;
    assert_close(vsc_curve_value(&curve, time), expected(d, fmod(time, PERIOD)), rtol, 1e-14);
  }
  int off = 0;
  for (int k = 0; k < 8192; k++) {
    const double time = k * SPACING + random_between(&seed, 0, SPACING);
    const double difference = vsc_curve_value(&curve, time) - expected(d, time);
    off += !(fabs(difference) <= between);
  }
  assert_true(off <= kinks);
  vsc_curve_free(&curve);
  assert_null(curve.values);
}

static double ramp(const vsc_curve_def *d, double time)
{
  if (time <= d->start) return 0;
  return time < d->start + d->duration ? (time - d->start) / d->duration : 1;
}

static double half_sine(const vsc_curve_def *d, double time)
{
  if (time < d->start || time > d->start + d->duration) return 0;
  return sin(acos(-1) * (time - d->start) / d->duration);
}

static double tanh_pair(const vsc_curve_def *d, double time)
{
  // (1 + tanh x)/2 = 1/(1 + exp(-2x))
  const double up = 1 / (1 + exp(-2 * (time - d->start) / d->rise));
  const double down = 1 / (1 + exp(2 * (time - d->start - d->duration) / d->fall));
  return up * down;
}

static double raw_hill(const vsc_curve_def *d, double time)
{
  if (time <= d->start) return 0;
  const double g1 = exp(d->rise_power * log((time - d->start) / d->rise));
  const double g2 = exp(d->fall_power * log((time - d->start) / d->fall));
  return g1 / (1 + g1) / (1 + g2);
}

// Scaled by the highest value on a grid of 1/64 ms: 1 to (1/64)^2/8 f'' = 1e-8 and better.
static double hill(const vsc_curve_def *d, double time)
{
  static double peak, rise;
  if (rise != d->rise) {
    peak = 0;
    for (int k = 0; k < 64 * 1024; k++) peak = fmax(peak, raw_hill(d, k / 64.));
    rise = d->rise;
  }
  return raw_hill(d, time) / peak;
}

static void a_ramp(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_RAMP);
  d.start = 100;
  d.duration = 333;
  d.period = PERIOD;
  compare(&d, ramp, 1e-14, 1e-14, 1);
}

static void a_half_sine(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_HALF_SINE);
  d.start = 50.25;
  d.duration = 300;
  d.period = PERIOD;
  // (pi/300)^2 . spacing^2/8 = 2.1e-7; the start is a place of the table, and so is the end
  compare(&d, half_sine, 1e-12, 2.2e-7, 0);
  vsc_curve curve = build(&d, 0);
  assert_close(vsc_curve_value(&curve, 200.25), 1, 1e-15, 0);
  assert_close(vsc_curve_peak(&curve), 1, 1e-15, 0);
  vsc_curve_free(&curve);
}

static void a_pair_of_tanh(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_TANH_PAIR);
  assert_true(d.rise == 20 && d.fall == 20);
  d.start = 120;
  d.duration = 280;
  d.fall = 35;
  d.period = PERIOD;
  // |tanh''| <= 0.77: 0.77/2/20^2 . spacing^2/8 = 1.9e-6
  compare(&d, tanh_pair, 1e-11, 2e-6, 0);
}

static void a_double_hill(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
  assert_true(d.rise == 100 && d.fall == 300 && d.rise_power == 2 && d.fall_power == 20);
  d.start = 25;
  d.period = PERIOD;
  // the fall: f'' up to 1.6/(300/20)^2/... = 1e-3 /ms^2, . spacing^2/8 = 2e-6
  compare(&d, hill, 1e-8, 3e-6, 0);
}

// "Scaled to peak 1" is a matter of the formula: a run that ends before the peak sees the same
// rise.
static void the_peak_of_a_hill_does_not_depend_on_the_end(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
  vsc_curve whole = build(&d, 512), beginning = build(&d, 64);
  for (double time = 0; time <= 64; time += 1)
    assert_close(vsc_curve_value(&beginning, time), vsc_curve_value(&whole, time), 1e-15, 0);
  // the table's places are 1/16 ms apart: the peak is met to (1/32)^2/2 f''
  assert_close(vsc_curve_peak(&whole), 1, 1e-8, 0);
  assert_true(vsc_curve_peak(&whole) <= 1);
  vsc_curve_free(&whole);
  vsc_curve_free(&beginning);
}

// The same bits whether a run ends early or late, so that it can be resumed to a later end; where a table would be too long
// for that, its hash says so.
static void values_do_not_depend_on_the_end(void **state)
{
  (void)state;
  double times[] = {0, 3, 7.7, 30, 150}, values[] = {0, 1, 0.4, 2, 0};
  for (int kind = VSC_CURVE_CONSTANT; kind <= VSC_CURVE_BESTEL_PRESSURE; kind++) {
    vsc_curve_def d = vsc_default_curve((vsc_curve_kind)kind);
    if (kind == VSC_CURVE_RAMP || kind == VSC_CURVE_HALF_SINE) d.duration = 15.7;
    if (kind == VSC_CURVE_TABLE) {
      d.point_count = 5;
      d.times = times;
      d.values = values;
    }
    vsc_curve early = build(&d, 11), late = build(&d, 40), long_after = build(&d, 4000);
    for (double time = 0; time <= 11; time += 0.01) {
      assert_true(vsc_curve_value(&early, time) == vsc_curve_value(&late, time));
      assert_true(vsc_curve_value(&early, time) == vsc_curve_value(&long_after, time));
    }
    assert_true(early.hash == late.hash && early.hash == long_after.hash);
    assert_true(early.range == late.range && early.range == long_after.range);
    vsc_curve_free(&early);
    vsc_curve_free(&late);
    vsc_curve_free(&long_after);
  }
  const vsc_curve_def hill = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
  vsc_curve usual = build(&hill, 16000), coarse = build(&hill, 17000);
  assert_true(usual.spacing != coarse.spacing && usual.hash != coarse.hash);
  vsc_curve_free(&usual);
  vsc_curve_free(&coarse);
}

// A pulse of 0.1 ms in a run of a second, to (pi/4096)^2/8 = 7.4e-8 but for the last place before its end; it rests behind.
static void short_pulses_are_seen(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_HALF_SINE);
  d.start = 1;
  d.duration = 0.1;
  vsc_curve curve = build(&d, 1000);
  for (double time = 1; time < 1.0999; time += 0.00071)
    assert_close(vsc_curve_value(&curve, time), half_sine(&d, time), 0, 8e-8);
  for (double time = 1.1 + 1e-3; time < 1000; time += 9.7) assert_true(vsc_curve_value(&curve, time) == 0);
  vsc_curve_free(&curve);
}

// Large powers make a box; nothing overflows to NaN.
static void a_hill_of_large_powers_is_a_box(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
  d.rise = 1;
  d.rise_power = 200;
  d.fall_power = 400;
  vsc_curve curve = build(&d, 2048);
  for (size_t k = 0; k <= curve.intervals; k++) assert_true(isfinite(curve.values[k]));
  assert_close(vsc_curve_value(&curve, 100), 1, 1e-12, 0);
  assert_close(vsc_curve_value(&curve, 2000), 0, 0, 1e-100);
  vsc_curve_free(&curve);
}

static void a_constant_is_one(void **state)
{
  (void)state;
  const vsc_curve_def d = vsc_default_curve(VSC_CURVE_CONSTANT);
  vsc_curve curve = build(&d, 700);
  const double times[] = {-1e9, -1, 0, 0.3, 699.9, 700, 1e9};
  for (int i = 0; i < 7; i++) assert_true(vsc_curve_value(&curve, times[i]) == 1);
  assert_true(vsc_curve_peak(&curve) == 1);
  vsc_curve_free(&curve);
}

static void curves_repeat(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_HALF_SINE);
  d.period = 800;
  vsc_curve curve = build(&d, 100);
  for (int beat = 1; beat < 10; beat++)
    for (double time = 0; time < 800; time += 12.5)
      assert_true(vsc_curve_value(&curve, time + 800 * beat) == vsc_curve_value(&curve, time));
  // before time 0 nothing has begun
  assert_true(vsc_curve_value(&curve, -650) == 0);
  vsc_curve_free(&curve);
}

static void without_a_period_the_last_value_stays(void **state)
{
  (void)state;
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_RAMP);
  d.duration = 40;
  vsc_curve curve = build(&d, 20);
  assert_close(vsc_curve_value(&curve, 10), 0.25, 1e-15, 0);
  assert_close(vsc_curve_value(&curve, 20), 0.5, 1e-15, 0);
  assert_close(vsc_curve_value(&curve, 1e6), 0.5, 1e-15, 0);
  assert_close(vsc_curve_value(&curve, -5), 0, 0, 0);
  vsc_curve_free(&curve);
}

static void not_a_number_is_no_index(void **state)
{
  (void)state;
  const vsc_curve_def d = vsc_default_curve(VSC_CURVE_HALF_SINE);
  vsc_curve curve = build(&d, 300);
  trap_off();
  assert_true(isfinite(vsc_curve_value(&curve, NAN)));
  assert_true(isfinite(vsc_curve_value(&curve, INFINITY)));
  trap_on();
  vsc_curve_free(&curve);
}

static double table_times[] = {64, 128, 160, 256, 512, 640},
              table_values[] = {0, 1, 1, 0.25, 0.5, -1};

static vsc_curve_def table_of(size_t count, double *times, double *values)
{
  vsc_curve_def d = vsc_default_curve(VSC_CURVE_TABLE);
  d.point_count = count;
  d.times = times;
  d.values = values;
  return d;
}

// Through its points, flat outside, and between two points between their values, rising or falling.
static void a_table_goes_through_its_points_and_not_beyond(void **state)
{
  (void)state;
  vsc_curve_def d = table_of(6, table_times, table_values);
  d.period = PERIOD;
  vsc_curve curve = build(&d, 0);
  for (int i = 0; i < 6; i++)
    assert_close(vsc_curve_value(&curve, table_times[i]), table_values[i], 1e-13, 1e-15);
  for (double time = 0; time < 64; time += 3) assert_true(vsc_curve_value(&curve, time) == 0);
  for (double time = 640; time < 1024; time += 3)
    assert_close(vsc_curve_value(&curve, time), -1, 1e-13, 0);
  for (int i = 0; i < 5; i++) {
    const double direction = table_values[i + 1] - table_values[i];
    double before = table_values[i];
    for (double time = table_times[i]; time <= table_times[i + 1]; time += SPACING) {
      const double now = vsc_curve_value(&curve, time);
      // 1e-15: a flat piece is flat to rounding
      assert_true((now - before) * direction >= -1e-15);
      assert_true(direction != 0 || fabs(now - before) < 1e-15);
      before = now;
    }
  }
  vsc_curve_free(&curve);
}

// Points of a line give the line; two points too, by linear interpolation.
static void a_table_of_a_line_is_a_line(void **state)
{
  (void)state;
  double times[] = {0, 100, 110, 500, 1024}, values[5];
  for (int i = 0; i < 5; i++) values[i] = 2 - times[i] / 256;
  for (int count = 2; count <= 5; count += 3) {
    vsc_curve_def d = table_of((size_t)count, times + 5 - count, values + 5 - count);
    d.period = PERIOD;
    vsc_curve curve = build(&d, 0);
    for (double time = times[5 - count]; time < 1024; time += 1.7)
      assert_close(vsc_curve_value(&curve, time), 2 - time / 256, 1e-15, 1e-15);
    vsc_curve_free(&curve);
  }
}

// However short a pulse is in its period, up to 2^20 places; what is fine enough with 8192 keeps them.
static void short_pulses_of_a_period_are_seen(void **state)
{
  (void)state;
  double times[] = {0, 1, 2, 60000}, values[] = {0, 1, 0, 0};
  vsc_curve_def spike = table_of(4, times, values), pulse = vsc_default_curve(VSC_CURVE_HALF_SINE);
  spike.period = 60000;
  vsc_curve curve = build(&spike, 5);
  // places 0.057 ms apart: f''/2 (0.029 ms)^2 = 2.5e-3, f'' = 6 at the peak
  assert_true(curve.intervals == 1 << 20);
  assert_close(vsc_curve_value(&curve, 1), 1, 0, 3e-3);
  assert_close(vsc_curve_value(&curve, 60001), 1, 0, 3e-3);
  assert_true(vsc_curve_value(&curve, 3) == 0);
  vsc_curve_free(&curve);
  pulse.duration = 20;
  pulse.start = 100;
  pulse.period = 10000;
  curve = build(&pulse, 5);
  // 1024 places and more in a pulse: (pi/1024)^2/8, but for pi/1024 at its ends
  for (double time = 100.02; time < 119.98; time += 0.013)
    assert_close(vsc_curve_value(&curve, time), half_sine(&pulse, time), 0, 1.2e-6);
  assert_close(vsc_curve_peak(&curve), 1, 0, 1.2e-6);
  vsc_curve_free(&curve);
}

static void usual_curves_keep_their_places(void **state)
{
  (void)state;
  for (int kind = VSC_CURVE_CONSTANT; kind <= VSC_CURVE_BESTEL_PRESSURE; kind++) {
    vsc_curve_def d = vsc_default_curve((vsc_curve_kind)kind);
    const bool driven = kind == VSC_CURVE_BESTEL || kind == VSC_CURVE_BESTEL_PRESSURE;
    double times[] = {0, 250, 300, 700}, values[] = {0, 1, 0.8, 0};
    if (kind == VSC_CURVE_TABLE) d = table_of(4, times, values);
    d.period = 800;
    vsc_curve curve = build(&d, 5);
    assert_true(curve.intervals == (kind == VSC_CURVE_CONSTANT ? 1 : driven ? 65536 : 8192));
    vsc_curve_free(&curve);
    if (!driven) continue;
    d.period = 4000;
    curve = build(&d, 5);
    assert_true(curve.intervals == 4 * 65536);
    vsc_curve_free(&curve);
  }
}

static void refuse(size_t count, double *times, double *values, const char *words)
{
  const vsc_curve_def d = table_of(count, times, values);
  vsc_curve curve;
  vsc_error error = {0};
  assert_int_equal(vsc_curve_build(&d, 100, &curve, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, words));
  vsc_curve_free(&curve);
}

static void bad_tables_are_refused(void **state)
{
  (void)state;
  double falling[] = {0, 20, 10}, repeated[] = {0, 10, 10}, unknown[] = {0, NAN, 10};
  double values[] = {0, 1, 0};
  refuse(3, falling, values, "10 ms does not come after 20 ms");
  refuse(3, repeated, values, "10 ms does not come after 10 ms");
  trap_off();
  refuse(3, unknown, values, "does not come after");
  trap_on();
  refuse(1, falling, values, "at least 2");
  refuse(0, NULL, NULL, "at least 2");
}

// Numbers of which formulas make none are refused; whose curve it is comes before the message.
static void extreme_curves_are_refused(void **state)
{
  (void)state;
  const double extremes[][4] = {{0, 1e308, 1e-308, 1e30}, {0, 1e-308, 1e308, 1e30}, {1e30, 1e308, 1e-308, 1e30}};
  int refused = 0;
  trap_off();
  for (size_t k = 0; k < sizeof extremes / sizeof extremes[0]; k++) {
    vsc_curve_def d = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
    vsc_curve curve;
    vsc_error error = {.text = ""};
    d.start = extremes[k][0], d.rise = extremes[k][1], d.fall = extremes[k][2], d.rise_power = extremes[k][3];
    if (vsc_curve_build(&d, 100, &curve, &error) == VSC_OK) {
      for (size_t i = 0; i <= curve.intervals; i++) assert_true(isfinite(curve.values[i]));
    } else {
      refused++;
      assert_int_equal(vsc_curve_of("materials", 2, "active.", error.status, &error), VSC_INPUT);
      assert_non_null(strstr(error.text, "materials[2].active.curve: its value at "));
      assert_non_null(strstr(error.text, " ms is not a finite number"));
    }
    vsc_curve_free(&curve);
  }
  trap_on();
  assert_true(refused > 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_ramp),
      cmocka_unit_test(a_half_sine),
      cmocka_unit_test(a_pair_of_tanh),
      cmocka_unit_test(a_double_hill),
      cmocka_unit_test(the_peak_of_a_hill_does_not_depend_on_the_end),
      cmocka_unit_test(values_do_not_depend_on_the_end),
      cmocka_unit_test(short_pulses_are_seen),
      cmocka_unit_test(a_hill_of_large_powers_is_a_box),
      cmocka_unit_test(a_constant_is_one),
      cmocka_unit_test(curves_repeat),
      cmocka_unit_test(without_a_period_the_last_value_stays),
      cmocka_unit_test(not_a_number_is_no_index),
      cmocka_unit_test(a_table_goes_through_its_points_and_not_beyond),
      cmocka_unit_test(a_table_of_a_line_is_a_line),
      cmocka_unit_test(short_pulses_of_a_period_are_seen),
      cmocka_unit_test(usual_curves_keep_their_places),
      cmocka_unit_test(bad_tables_are_refused),
      cmocka_unit_test(extreme_curves_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
