// SPDX-License-Identifier: GPL-3.0-or-later
// The shipped beat is believable: what it ejects, how it moves, that it keeps its volume and its
// energy, and that it repeats itself. Ranges: human left ventricles at rest.
#include <stdlib.h>

#include "base/parallel.h"
#include "close.h"
#include "mech/observe.h"
#include "mesh/surface.h"
#include "run/problem.h"
#include "solve/explicit.h"

#define LOOK 2.0     // ms between two looks
#define BASE_Z 20.0  // mm, the plane of the base
enum { MOST_LOOKS = 2000 };

// What is seen at one time.
typedef struct look {
  double cavity;     // mm^3
  double apex;       // z of the endocardial apex, mm
  double thickness;  // of the wall at the equator, mm
  double twist;      // of the apical part against rest, degrees, positive as physiology has it
  double volume;     // of the tissue, mm^3
  double group_low, group_high, inverted;
  double balance, energy;  // balance error; largest energy or work so far, uJ
} look;

typedef struct beat {
  vsc_problem *problem;
  vsc_state *state;
  vsc_ledger *ledger;
  vsc_cavity cavity;
  double *x;                 // node_count x 3, in the mesh's order, mm
  const double *endo, *epi;  // node arrays of the mesh
  size_t apex;               // the lowest node of the endocardium
  double period;
  size_t count;  // looks; the first is at rest
  look looks[MOST_LOOKS];
} beat;

static beat b;

static double radius(const double *x)
{
  return hypot(x[0], x[1]);
}

// The mean distance of the epicardium's nodes from the axis less that of the endocardium's, in the
// slab round z = -10.
static double wall_thickness(const double *x)
{
  const double *rest = b.problem->mesh->nodes;
  double sum[2] = {0}, count[2] = {0};
  for (size_t n = 0; n < b.problem->mesh->node_count; n++) {
    if (fabs(rest[3 * n + 2] + 10) >= 8 || (b.endo[n] < 0.5 && b.epi[n] < 0.5)) continue;
    const int outer = b.epi[n] > 0.5;
    sum[outer] += radius(x + 3 * n);
    count[outer]++;
  }
  return sum[1] / count[1] - sum[0] / count[0];
}

// The mean turn about z of the surfaces' nodes with z in [-62, -45] against rest. The base is held,
// so this is the twist. Seen from the apex towards the base, that is along +z, a physiological apex
// turns anticlockwise: that is clockwise about z, which points at the base.
static double apical_twist(const double *x)
{
  const double *rest = b.problem->mesh->nodes;
  double sum = 0, count = 0;
  for (size_t n = 0; n < b.problem->mesh->node_count; n++) {
    const double z = rest[3 * n + 2];
    if (z < -62 || z > -45 || (b.endo[n] < 0.5 && b.epi[n] < 0.5)) continue;
    const double turn = atan2(x[3 * n + 1], x[3 * n]) - atan2(rest[3 * n + 1], rest[3 * n]);
    sum -= remainder(turn, 2 * M_PI);
    count++;
  }
  return sum / count * 180 / M_PI;
}

static void take_look(double energy_so_far)
{
  vsc_totals t;
  vsc_observe(b.problem->model, b.state, b.ledger, false, &t);
  vsc_read_field(b.problem->model, b.state, VSC_FIELD_DISPLACEMENT, b.x);
  for (size_t i = 0; i < 3 * b.problem->mesh->node_count; i++) b.x[i] += b.problem->mesh->nodes[i];
  const double stored = t.kinetic + t.axial + t.angular + t.volume_energy;
  const double work = fmax(fabs(b.ledger->active), fabs(b.ledger->pressure));
  assert_true(b.count < MOST_LOOKS);
  b.looks[b.count++] = (look){.cavity = vsc_cavity_volume(&b.cavity, b.x, 3),
                              .apex = b.x[3 * b.apex + 2],
                              .thickness = wall_thickness(b.x),
                              .twist = apical_twist(b.x),
                              .volume = t.volume,
                              .group_low = t.group_low,
                              .group_high = t.group_high,
                              .inverted = t.inverted,
                              .balance = vsc_balance_error(b.ledger, &t),
                              .energy = fmax(energy_so_far, fmax(stored, work))};
}

static const double *node_array(const char *name)
{
  const vsc_array *array = vsc_arrays_find(&b.problem->mesh->node_data, name);
  if (array == NULL) fail_msg("the mesh has no node array %s", name);
  return array->values;
}

static void prepare(void)
{
  vsc_error error;
  if (vsc_problem_load(VSC_SOURCE_DIR "/data/beat.yaml", NULL, 0, &b.problem, &error) != VSC_OK)
    fail_msg("%s", error.text);
  const vsc_model *model = b.problem->model;
  const vsc_mesh *mesh = b.problem->mesh;
  if (vsc_state_create(model, &b.state, &error) != VSC_OK ||
      vsc_ledger_create(model, &b.ledger, &error) != VSC_OK ||
      vsc_start(model, b.state, &error) != VSC_OK ||
      vsc_cavity_make(&model->surfaces[vsc_model_find_surface(model, "endo")], mesh->node_count,
                      &b.cavity, &error) != VSC_OK)
    fail_msg("%s", error.text);
  b.x = malloc(3 * mesh->node_count * sizeof *b.x);
  assert_non_null(b.x);
  b.endo = node_array("endo");
  b.epi = node_array("epi");
  double lowest = HUGE_VAL;
  for (size_t n = 0; n < mesh->node_count; n++)
    if (b.endo[n] > 0.5 && mesh->nodes[3 * n + 2] < lowest) {
      lowest = mesh->nodes[3 * n + 2];
      b.apex = n;
    }
  b.period = b.problem->scene->definition.materials[0].active.curve.period;
}

// The number of the look at `time`.
static size_t at(double time)
{
  return (size_t)lround(time / LOOK);
}

// Of the first beat: the look with the smallest cavity.
static const look *end_systole(void)
{
  const look *smallest = b.looks;
  for (size_t k = 0; k <= at(b.period); k++)
    if (b.looks[k].cavity < smallest->cavity) smallest = &b.looks[k];
  return smallest;
}

static double stroke(void)
{
  return b.looks[0].cavity - end_systole()->cavity;
}

static void test_two_beats_run_to_the_end(void **state)
{
  (void)state;
  vsc_error error;
  prepare();
  assert_true(b.period > 0);
  take_look(0);
  const double end = 2 * b.period;
  for (size_t k = 1; k <= at(end); k++) {
    if (vsc_advance(b.problem->model, b.state, LOOK * (double)k, &error) != VSC_OK)
      fail_msg("%s", error.text);
    take_look(b.looks[b.count - 1].energy);
  }
  assert_int_equal(b.count, at(end) + 1);
}

static void test_ejection(void **state)
{
  (void)state;
  const double rest = b.looks[0].cavity, fraction = stroke() / rest;
  print_message("cavity %.1f ml to %.1f ml at %.0f ms: ejection fraction %.1f %%\n", 1e-3 * rest,
                1e-3 * end_systole()->cavity, LOOK * (double)(end_systole() - b.looks),
                100 * fraction);
  assert_true(fraction > 0.40 && fraction < 0.65);
}

static void test_shortening(void **state)
{
  (void)state;
  const double part = (end_systole()->apex - b.looks[0].apex) / (BASE_Z - b.looks[0].apex);
  print_message("the endocardial apex comes %.1f %% nearer to the base\n", 100 * part);
  assert_true(part > 0.10 && part < 0.25);
}

static void test_thickening(void **state)
{
  (void)state;
  const double part = end_systole()->thickness / b.looks[0].thickness - 1;
  print_message("wall at the equator: %.2f mm, thicker by %.1f %%\n", b.looks[0].thickness,
                100 * part);
  assert_true(part > 0.30 && part < 0.60);
}

static void test_twist(void **state)
{
  (void)state;
  const double degrees = end_systole()->twist;
  print_message("apical twist %.1f degrees\n", degrees);
  assert_true(degrees > 5 && degrees < 20);
}

static void test_volume_is_kept(void **state)
{
  (void)state;
  double wall = 0, low = 1, high = 1, inverted = 0;
  for (size_t k = 0; k < b.count; k++) {
    wall = fmax(wall, fabs(b.looks[k].volume / b.looks[0].volume - 1));
    low = fmin(low, b.looks[k].group_low);
    high = fmax(high, b.looks[k].group_high);
    inverted = fmax(inverted, b.looks[k].inverted);
  }
  print_message(
      "wall volume within %.3f %%; node-averaged volume ratios %.4f to %.4f; %.0f inverted\n",
      100 * wall, low, high, inverted);
  assert_true(wall < 0.005);
  assert_true(low > 1 - 0.015 && high < 1 + 0.015);
  assert_true(inverted == 0);
}

static void test_comes_back_to_rest(void **state)
{
  (void)state;
  const double first = b.looks[at(b.period)].cavity, second = b.looks[at(2 * b.period)].cavity;
  print_message("at the ends of the beats the cavity is %.3f %% and %.3f %% of the stroke off\n",
                100 * (first - b.looks[0].cavity) / stroke(),
                100 * (second - b.looks[0].cavity) / stroke());
  assert_close(first, b.looks[0].cavity, 0, 0.01 * stroke());
  assert_close(second, b.looks[0].cavity, 0, 0.01 * stroke());
}

static void test_second_beat_is_the_first(void **state)
{
  (void)state;
  double most = 0;
  for (size_t k = 0; k <= at(b.period); k++)
    most = fmax(most, fabs(b.looks[k].cavity - b.looks[k + at(b.period)].cavity));
  print_message("the second beat differs from the first by %.3f %% of the stroke\n",
                100 * most / stroke());
  assert_true(most < 0.01 * stroke());
}

// The trapezoidal sums of the works between looks are what is left of it.
static void test_energy_balances(void **state)
{
  (void)state;
  double most = 0;
  for (size_t k = 0; k < b.count; k++) most = fmax(most, fabs(b.looks[k].balance));
  const double largest = b.looks[b.count - 1].energy;
  print_message("energy: %.3f mJ of %.1f mJ unexplained, %.4f %%\n", 1e-3 * most, 1e-3 * largest,
                100 * most / largest);
  assert_true(most < 1e-3 * largest);
}

static int release(void **state)
{
  (void)state;
  free(b.x);
  vsc_cavity_free(&b.cavity);
  vsc_ledger_free(b.ledger);
  vsc_state_free(b.state);
  vsc_problem_free(b.problem);
  return 0;
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_two_beats_run_to_the_end),
      cmocka_unit_test(test_ejection),
      cmocka_unit_test(test_shortening),
      cmocka_unit_test(test_thickening),
      cmocka_unit_test(test_twist),
      cmocka_unit_test(test_volume_is_kept),
      cmocka_unit_test(test_comes_back_to_rest),
      cmocka_unit_test(test_second_beat_is_the_first),
      cmocka_unit_test(test_energy_balances),
  };
  return cmocka_run_group_tests(tests, NULL, release);
}
