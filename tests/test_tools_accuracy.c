// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera bench accuracy`: its arithmetic, its closed forms against printed values, its table of cases,
// and one case from mesh to report.
#include "program.h"

#include "tools/bench/closed_forms.h"
#include "tools/bench/curves.h"
#include "tools/bench/measures.h"
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

// Tones of 0.7 and 3.1, the second a twentieth as strong, each among frequencies about it; none where there is only a slope.
static void tones_are_found(void **state)
{
  (void)state;
  static double times[1001], wave[1001];
  for (int k = 0; k <= 1000; k++) {
    times[k] = 0.01 * k;
    wave[k] = 5 + sin(2 * M_PI * 0.7 * times[k] + 0.4) + 0.05 * sin(2 * M_PI * 3.1 * times[k]);
  }
  // 7 and 31 turns: what the window lets through of the other moves them by less than a thousandth of a turn in all
  assert_close(vsc_curve_tone(1001, times, wave, 0.4, 1), 0.7, 1e-3, 0);
  assert_close(vsc_curve_tone(1001, times, wave, 2, 4.5), 3.1, 1e-3, 0);
  assert_true(isnan(vsc_curve_tone(1001, times, wave, 0.75, 0.85)));
  assert_true(isnan(vsc_curve_tone(3, times, wave, 1, 2)));
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

static void coarse_meshes_are_not_judged(void **state)
{
  (void)state;
  const vsc_bench_quantity q = {.name = "q", .percent = 1, .from = 400, .upto = 900};
  vsc_bench_row row = {.quantity = &q, .value = 90, .reference = 100, .elements = 399};
  row.of.kind = &vsc_bench_kinds[0];
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_UNJUDGED);
  row.elements = 400;
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_MISSED);
  row.elements = 900;
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_MISSED);
  row.elements = 901;
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_UNJUDGED);
  // one that fails is a miss on any mesh
  snprintf(row.failure, sizeof row.failure, "came apart");
  assert_int_equal(vsc_bench_judge(&row), VSC_BENCH_MISSED);
}

// Steps of 4, 2 and 1 with values 5 + h^2, then 5 + h: the third has an order, which is judged.
static void orders_are_judged(void **state)
{
  (void)state;
  static const vsc_bench_variant steps[] = {{.name = "4", .parameter = 4}, {.name = "2", .parameter = 2}, {.name = "1", .parameter = 1}};
  static const vsc_bench_problem problem = {.name = "p", .variants = steps, .variant_count = 3};
  const vsc_bench_quantity q = {.name = "q", .reference = NAN, .order = {1.8, 2.2}};
  for (int power = 1; power <= 2; power++) {
    vsc_bench_report report = {0};
    for (int k = 0; k < 3; k++) {
      vsc_bench_row row = {.quantity = &q, .value = 5 + pow(steps[k].parameter, power), .reference = NAN};
      row.of = (vsc_bench_case){.problem = &problem, .variant = &steps[k], .kind = &vsc_bench_kinds[0]};
      assert_true(vsc_bench_keep(&report, &row));
    }
    assert_true(isnan(report.rows[1].order));
    assert_int_equal(vsc_bench_judge(&report.rows[1]), VSC_BENCH_UNJUDGED);
    assert_close(report.rows[2].order, power, 1e-12, 0);
    assert_int_equal(vsc_bench_judge(&report.rows[2]), power == 2 ? VSC_BENCH_MET : VSC_BENCH_MISSED);
    vsc_bench_report_free(&report);
  }
}

// Steps whose order is to be seen come in threes, each half of the one before, and none is cut by the rows, 2 ms apart.
static void steps_of_the_beat_halve(void **state)
{
  (void)state;
  for (size_t p = 0; p < vsc_bench_problem_count; p++) {
    const vsc_bench_problem *problem = vsc_bench_problems[p];
    if (strcmp(problem->name, "beat") != 0) continue;
    size_t triples = 0;
    for (size_t v = 0; v + 2 < problem->variant_count; v++) {
      const vsc_bench_variant *steps = problem->variants + v;
      assert_true(steps[2].parameter <= 2);
      triples += steps[0].parameter > 0 && steps[0].parameter == 2 * steps[1].parameter &&
                 steps[1].parameter == 2 * steps[2].parameter;
    }
    assert_int_equal(triples, 2);
    for (size_t k = 0; k < problem->quantity_count; k++) assert_true(problem->quantities[k].order[1] > 0);
    return;
  }
  fail();
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

// The end of a beam of 80 and 640 bricks, not judged: the order is told with the second, in text, table and page.
static void orders_are_told(void **state)
{
  (void)state;
  static char text[PROGRAM_TEXT];
  must("$V bench accuracy --only 'beam-0.3-hexes-?' -o orders" SCENES);
  load_text("orders/accuracy.csv", text, sizeof text);
  double e[2], order = NAN;
  for (int k = 0; k < 2; k++) {
    const char *row = strstr(text, k == 0 ? "beam-0.3-hexes-1," : "beam-0.3-hexes-2,"), *value;
    assert_non_null(row);
    value = strstr(row, "\"end sinks\",mm,");
    assert_non_null(value);
    double here, there;
    assert_int_equal(sscanf(value, "\"end sinks\",mm,%lf,%lf,%lf", &here, &there, &order), 3);
    e[k] = fabs(here - there);
    if (k == 0) assert_true(isnan(order));
  }
  // 80 and 640 are halves of the size; printed to four digits
  assert_close(order, log2(e[0] / e[1]), 1e-3, 0);
  char words[32];
  snprintf(words, sizeof words, " %.2f        - ", order);
  assert_holds(said, words);
  load_text("orders/index.html", text, sizeof text);
  snprintf(words, sizeof words, "<td>%.2f</td></tr>", order);
  assert_holds(text, words);
}

static size_t times_in(const char *text, const char *word)
{
  size_t count = 0;
  for (; (text = strstr(text, word)) != NULL; text++) count++;
  return count;
}

static void put_page(const vsc_bench_report *report, char *text, size_t size)
{
  char page[512];
  vsc_error error;
  snprintf(page, sizeof page, "%s", in_folder("."));
  assert_int_equal(vsc_bench_write_page(report, page, page, &error), VSC_OK);
  load_text("index.html", text, size);
}

// A case in the middle of a band from 0 to 4: its line is in the middle of the axis, between LEFT and the legend.
static void histories_are_drawn(void **state)
{
  (void)state;
  static char text[PROGRAM_TEXT];
  static const vsc_bench_quantity q = {.name = "distance", .measure = vsc_measure_history, .column = "point_p_u",
                                       .file = "teams.csv", .file_column = "p"};
  static const vsc_bench_variant variant = {.name = ""};
  static const vsc_bench_problem problem = {.name = "p", .title = "P", .variants = &variant, .variant_count = 1,
                                            .quantities = &q, .quantity_count = 1};
  save_text("teams.csv", "time_s,p_ux_mean_mm,p_ux_min_mm,p_ux_max_mm\n0,1,0,4\n1,3,0,4\n");
  must("mkdir -p runs/ours");
  save_text("runs/ours/signals.csv", "time [s],point_p_ux [mm]\n0,2\n1,2\n");
  vsc_bench_row row = {.quantity = &q, .value = 0.1, .reference = NAN};
  row.of = (vsc_bench_case){.problem = &problem, .variant = &variant, .kind = &vsc_bench_kinds[0], .name = "ours"};
  vsc_bench_report report = {0};
  assert_true(vsc_bench_keep(&report, &row));
  put_page(&report, text, sizeof text);
  assert_holds(text, "<polygon fill=\"#ccc\" points=\"52.0,24.0 330.0,24.0 330.0,224.0 52.0,224.0 \"/>");
  assert_holds(text, "points=\"52.0,124.0 330.0,124.0 \"/>");
  assert_holds(text, ">ours</text>");
  assert_int_equal(times_in(text, "<polyline"), 2);  // y and z have no columns
  report.rows[0].skipped = true;
  put_page(&report, text, sizeof text);
  assert_int_equal(times_in(text, "<polyline"), 0);
  vsc_bench_report_free(&report);
}

static void midlines_are_drawn(void **state)
{
  (void)state;
  static char text[PROGRAM_TEXT];
  must("mkdir -p curves");
  save_text("curves/land_p2_midline.csv", "s,x_mm,y_mm,z_mm\n0.1,-2.114,0,-26.9776\n0.5,-10.5161,0,-17.8381\n1,-8.1837,0,5\n");
  must("$V bench accuracy --only land_p2-plain-1 --reference curves -o lines" SCENES);
  load_text("lines/index.html", text, sizeof text);
  assert_holds(text, ">land_p2-plain-1</text>");
  assert_int_equal(times_in(text, "<polyline"), 2);  // y is 0 there, and not drawn
  // the base is held: both lines end in the same place
  double end[2][2];
  const char *at = text;
  for (int k = 0; k < 2; k++) {
    at = strstr(at, "<polyline") + 1;
    const char *const points = strstr(at, "points=");
    assert_int_equal(sscanf(points, "points=\"%*f,%*f %*f,%*f %lf,%lf", &end[k][0], &end[k][1]), 2);
  }
  // printed to 0.1
  assert_close(end[1][0], end[0][0], 0, 0.11);
  assert_close(end[1][1], end[0][1], 0, 0.11);
}

// Each of the beam's quantities is within its target with 900 quadratic tets; a wrong point or neighbour would be far off.
static void the_beam_bends_like_others(void **state)
{
  (void)state;
  must("$V bench accuracy --only land_p1-quadratic-3 -o bent" SCENES);
  assert_int_equal(times_in(said, " met\n"), 3);
  assert_holds(said, "distance of the mid-line");
  assert_holds(said, "strains");
}

static void signals_are_measured(void **state)
{
  (void)state;
  enum { ROWS = 401 };
  static char names[2][VSC_NAME] = {"time", "pull"};
  static double values[2 * ROWS];
  for (int k = 0; k < ROWS; k++) {
    values[k] = 0.01 * k;
    values[ROWS + k] = 3 + sin(2 * M_PI * 2.5 * values[k]);
  }
  vsc_signals signals = {.columns = 2, .rows = ROWS, .names = names, .values = values};
  const vsc_outcome outcome = {.signals = &signals};
  vsc_bench_quantity q = {.column = "pull", .at = {2, 3}};
  vsc_measured measured;
  vsc_error error;
  // a row lies on each peak; ten turns in the window
  assert_int_equal(vsc_measure_most(&outcome, &q, &measured, &error), VSC_OK);
  assert_close(measured.value, 4, 1e-12, 0);
  assert_int_equal(vsc_measure_least(&outcome, &q, &measured, &error), VSC_OK);
  assert_close(measured.value, 2, 1e-12, 0);
  assert_int_equal(vsc_measure_tone(&outcome, &q, &measured, &error), VSC_OK);
  assert_close(measured.value, 2.5, 1e-3, 0);
  q.at[1] = 2.2;
  assert_int_equal(vsc_measure_tone(&outcome, &q, &measured, &error), VSC_INPUT);
  assert_string_equal(error.text, "'pull' has no tone from 2 to 2.2 Hz");
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
      cmocka_unit_test(tones_are_found),
      cmocka_unit_test(closed_forms_have_their_printed_values),
      cmocka_unit_test(cases_are_counted),
      cmocka_unit_test(targets_are_judged),
      cmocka_unit_test(coarse_meshes_are_not_judged),
      cmocka_unit_test(orders_are_judged),
      cmocka_unit_test(steps_of_the_beat_halve),
      cmocka_unit_test(a_case_from_mesh_to_report),
      cmocka_unit_test(orders_are_told),
      cmocka_unit_test(histories_are_drawn),
      cmocka_unit_test(midlines_are_drawn),
      cmocka_unit_test(the_beam_bends_like_others),
      cmocka_unit_test(signals_are_measured),
      cmocka_unit_test(failures_are_told),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
