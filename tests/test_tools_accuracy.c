// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera bench accuracy`: its arithmetic, its closed forms against printed values, its table of cases,
// and one case from mesh to report.
#include "program.h"

#include "tools/bench/closed_forms.h"
#include "tools/bench/curves.h"
#include "tools/bench/problem.h"
#include "tools/bench/report.h"

static void curves_are_linear_between_points(void **state)
{
  (void)state;
  static const double t[] = {0, 1, 3}, y[] = {2, 4, 0};
  // halves and quarters are exact
  assert_close(vsc_curve_at(3, t, y, 0.5), 3, 0, 0);
  assert_close(vsc_curve_at(3, t, y, 1), 4, 0, 0);
  assert_close(vsc_curve_at(3, t, y, 1.5), 3, 0, 0);
  assert_close(vsc_curve_at(3, t, y, -1), 2, 0, 0);
  assert_close(vsc_curve_at(3, t, y, 9), 0, 0, 0);
}

static void distances_and_bands_by_hand(void **state)
{
  (void)state;
  static const double a[] = {3, 4, 2, 1}, b[] = {3, 0, 4, 0}, zero[4] = {0};
  // sqrt(0 + 16 + 4 + 1) / 5, to rounding
  assert_close(vsc_relative_distance(4, a, b), sqrt(21) / 5, 1e-15, 0);
  assert_true(isnan(vsc_relative_distance(4, a, zero)));
  static const double low[] = {3, 0, 2.5, 2}, high[] = {3, 3, 3, 3};
  assert_close(vsc_band_share(4, a, low, high, 0), 0.25, 0, 0);
  assert_close(vsc_band_share(4, a, low, high, 0.5), 0.5, 0, 0);
  assert_close(vsc_band_share(4, a, low, high, 1), 1, 0, 0);
}

// Of four curves the first is in the band of the others all of the time, the second three quarters of it, the third and
// the fourth a quarter: the median is a half.
static void curves_are_left_out_in_turn(void **state)
{
  (void)state;
  static const double a[] = {1, 1, 1, 1}, b[] = {0, 1, 2, 1}, c[] = {2, 2, 0, 1}, d[] = {0.5, 0, 3, 3};
  const double *const curves[] = {a, b, c, d};
  assert_close(vsc_left_out_share(4, 4, curves, 0), 0.5, 0, 0);
  assert_close(vsc_left_out_share(4, 4, curves, 3), 1, 0, 0);
  assert_true(isnan(vsc_left_out_share(1, 4, curves, 0)));
}

static void powers_are_found(void **state)
{
  (void)state;
  double h[4], errors[4], times[200], wave[200];
  for (int k = 0; k < 4; k++) {
    h[k] = 1.0 / (k + 1);
    errors[k] = 0.3 * pow(h[k], 2.5);
  }
  // exact powers, but for the rounding of logarithms
  assert_close(vsc_observed_order(4, h, errors), 2.5, 1e-12, 0);
  errors[1] = NAN;
  errors[2] = 0;
  assert_close(vsc_observed_order(4, h, errors), 2.5, 1e-12, 0);
  assert_true(isnan(vsc_observed_order(1, h, errors)));
  // 5 + h^2 at 4, 2, 1
  assert_close(vsc_own_order((double[3]){4, 2, 1}, (double[3]){21, 9, 6}), 2, 1e-12, 0);
  assert_true(isnan(vsc_own_order((double[3]){4, 3, 1}, (double[3]){21, 9, 6})));
  for (int k = 0; k < 200; k++) {
    times[k] = 0.05 * k;
    wave[k] = sin(2 * M_PI * 0.7 * times[k] + 0.4);
  }
  // straight lines between 28 points a turn pass through 0 where the sine does to second order at least
  assert_close(vsc_curve_frequency(200, times, wave), 0.7, 1e-4, 0);
  assert_true(isnan(vsc_curve_frequency(5, times, wave)));
}

// The values are printed to six digits.
static void closed_forms_have_their_printed_values(void **state)
{
  (void)state;
  assert_close(vsc_sphere_inner(0.551869), 1.25, 2e-5, 0);
  assert_close(vsc_sphere_inner(0.755433), 1.5, 2e-5, 0);
  assert_close(vsc_cylinder_inner(0.275712), 1.25, 1e-5, 0);
  assert_close(vsc_cylinder_inner(0.574054), 2, 1e-5, 0);
  // of p / E = 1e-6; printed for 1e-2
  assert_close(vsc_sphere_move(0.3), 8.00000e-7, 1e-6, 0);
  assert_close(vsc_sphere_move(0.499), 8.56857e-7, 1e-6, 0);
  assert_close(vsc_cylinder_move(0.3), 1.906667e-6, 1e-6, 0);
  assert_close(vsc_cylinder_move(0.499), 1.999666e-6, 1e-6, 0);
  // by hand: 0.014715 + 0.000150092
  assert_close(vsc_beam_sag(0.3), -0.014865092, 1e-7, 0);
}

// Every combination once, each with a name of its own, the coarsest of each kind first.
static void cases_are_counted(void **state)
{
  (void)state;
  size_t expected = 0, count = 0, coarsest = 0, series = 0;
  for (size_t p = 0; p < vsc_bench_problem_count; p++)
    for (size_t k = 0; k < vsc_bench_kind_count; k++) {
      size_t sizes = 0;
      for (size_t s = 0; s < vsc_bench_problems[p]->size_count; s++)
        sizes += (vsc_bench_problems[p]->sizes[s].kinds & vsc_bench_kinds[k].bit) != 0;
      expected += sizes * vsc_bench_problems[p]->variant_count;
      series += sizes > 0 ? vsc_bench_problems[p]->variant_count : 0;
    }
  static char names[1024][VSC_BENCH_TEXT];
  for (vsc_bench_case at = {0}; vsc_bench_next(&at); count++) {
    assert_true(count < 1024);
    snprintf(names[count], VSC_BENCH_TEXT, "%s", at.name);
    for (size_t k = 0; k < count; k++) assert_string_not_equal(names[k], at.name);
    coarsest += at.coarsest;
  }
  assert_int_equal(count, expected);
  assert_int_equal(coarsest, series);
}

static void targets_are_judged(void **state)
{
  (void)state;
  const vsc_bench_quantity q = {.name = "q", .percent = 1, .held = VSC_BENCH_QUADRATIC};
  vsc_bench_row row = {.quantity = &q, .value = 101, .reference = 100};
  row.of.kind = &vsc_bench_kinds[0];
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_UNJUDGED);
  for (size_t k = 0; k < vsc_bench_kind_count; k++)
    if (vsc_bench_kinds[k].bit == VSC_BENCH_QUADRATIC) row.of.kind = &vsc_bench_kinds[k];
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_MET);
  row.value = 98.9;
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_MISSED);
  row.reference = NAN;
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_UNJUDGED);
  snprintf(row.failure, sizeof row.failure, "came apart");
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_MISSED);
}

#define SCENES " --no-pictures --scenes " VSC_SOURCE_DIR "/data/benchmarks "

static void a_case_from_mesh_to_report(void **state)
{
  (void)state;
  static char text[PROGRAM_TEXT];
  must("$V bench accuracy --only beam-0.3-quadratic-1 -o out" SCENES);
  assert_holds(said, "beam-0.3-quadratic-1 ");
  assert_holds(said, " met");
  load_text("out/accuracy.csv", text, sizeof text);
  const char *row = strstr(text, "beam-0.3-quadratic-1,beam,0.3,quadratic,400,945,2760,");
  assert_non_null(row);
  const char *value = strstr(row, "\"end sinks\",mm,");
  assert_non_null(value);
  // two quadratic tets through a clamped beam: within its target of 2 % of the formula
  assert_close(strtod(value + strlen("\"end sinks\",mm,"), NULL), vsc_beam_sag(0.3), 0.02, 0);
  assert_true(load_text("out/index.html", text, sizeof text) > 0);
  assert_holds(text, "<td>beam-0.3-quadratic-1</td><td>400</td>");
  assert_true(load_text("out/meshes/beam-0.3-quadratic-1.vtu", text, sizeof text) > 0);
  assert_true(load_text("out/runs/beam-0.3-quadratic-1/summary.json", text, sizeof text) > 0);
}

static void failures_are_told(void **state)
{
  (void)state;
  // a folder without scenes
  assert_int_equal(shell("$V bench accuracy --only beam-0.3-quadratic-1 -o bad --no-pictures --scenes ."), 3);
  assert_holds(said, "FAILED");
  assert_holds(said, "beam.yaml");
  assert_int_equal(shell("$V bench accuracy --only nothing -o bad" SCENES), 2);
  assert_holds(complained, "no case is called 'nothing'");
  assert_int_equal(shell("$V bench accuracy --limit 0"), 2);
  assert_int_equal(shell("$V bench accuracy more"), 2);
  must("$V bench accuracy --list --only 'land_p1-hexes*'");
  assert_int_equal(line_count(said), 3);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(curves_are_linear_between_points),
      cmocka_unit_test(distances_and_bands_by_hand),
      cmocka_unit_test(curves_are_left_out_in_turn),
      cmocka_unit_test(powers_are_found),
      cmocka_unit_test(closed_forms_have_their_printed_values),
      cmocka_unit_test(cases_are_counted),
      cmocka_unit_test(targets_are_judged),
      cmocka_unit_test(a_case_from_mesh_to_report),
      cmocka_unit_test(failures_are_told),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
