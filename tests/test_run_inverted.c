// SPDX-License-Identifier: GPL-3.0-or-later
// Elements that turn inside out in explicit runs: shorter steps are tried, and what they do not help is told.
#include "block_scene.h"

// The far end of a block is pushed through the near one, and comes back.
static const char pushed[] =
    "mesh: {file: block.vtu, unit: mm}\n"
    "node_sets:\n"
    "  - {name: left, node_array: x0, value: 1}\n"
    "  - {name: right, node_array: x1, value: 1}\n"
    "fibers: {source: constant, constant: {fiber: [1, 0, 0]}}\n"
    "materials:\n"
    "  - {name: muscle, axial: {f: 20 kPa, s: 20 kPa, n: 20 kPa}, angular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa},\n"
    "     damping: {f: 5 Pa s, s: 5 Pa s, n: 5 Pa s}, volume_modulus: 60 kPa}\n"
    "supports:\n"
    "  - {set: left, held: [x, y, z]}\n"
    "  - {set: right, held: [x, y, z], motion: [-24 mm, 0 mm, 0 mm], curve: {kind: half_sine, duration: 320 ms}}\n"
    "time: {end: 200 ms}\n"
    "output: {frames: 100 ms, signals: 1 ms}\n";

static double number(const char *run, const char *key)
{
  return strtod(summary(run, key), NULL);
}

// What a load does is not mended by shorter steps: of some hundred stretches, many with more elements inside out, no more
// than a few are gone again, and the run goes on. It says how many are inside out, which was the first, where and when.
static void what_the_load_does_is_told(void **state)
{
  (void)state;
  char words[160];
  save_text("pushed.yaml", pushed);
  must("$V run pushed.yaml -o through -t 1");
  assert_string_equal(summary("through", "outcome"), "finished");
  const double most = number("through", "most_inverted_elements"), end = number("through", "inverted_elements");
  const double tried = number("through", "stretches_repeated_with_shorter_steps");
  assert_true(end > 0 && end <= most && most > 20);
  assert_close(end, last_signal("through", "inverted_elements"), 0, 0);
  assert_true(tried >= 8 && tried <= 14);
  assert_holds(said, "times a stretch was gone again with shorter steps");
  snprintf(words, sizeof words, "viscera: warning: up to %.0f elements at a time were inside out, %.0f are in the end: the "
           "first was element ", most, end);
  assert_holds(complained, words);
  const double when = strtod(strstr(complained, " mm, at ") + strlen(" mm, at "), NULL);
  assert_true(when > 40 && when < 90);
  assert_holds(complained, " ms; take a smaller load, a larger volume_modulus, or a finer mesh there");
  assert_holds(summary("through", "warning"), "elements at a time were inside out");
  assert_null(strstr(complained, "time.step"));
  must("$V run pushed.yaml -o upright --set 'time.end=5 ms'");
  assert_string_equal(summary("upright", "most_inverted_elements"), "0");
  assert_string_equal(summary("upright", "inverted_elements"), "0");
  assert_string_equal(summary("upright", "stretches_repeated_with_shorter_steps"), "0");
  assert_null(strstr(complained, "inside out"));
}

// The same bits and words on two threads, and when the run is stopped among stretches that are gone again.
static void nothing_changes_it(void **state)
{
  (void)state;
  char hash[32], warning[1024];
  snprintf(hash, sizeof hash, "%s", summary("through", "state_hash"));
  snprintf(warning, sizeof warning, "%s", summary("through", "warning"));
  must("$V run pushed.yaml -q -o two -t 2");
  must("$V run pushed.yaml -q -o cut -t 1 --stop '75 ms' && $V run pushed.yaml -q -o cut -t 1 --resume --stop '100 ms'");
  // not halved for sixteen looks each time, after which it would be tried again
  assert_true(number("cut", "stretches_repeated_with_shorter_steps") >= 4);
  must("$V run pushed.yaml -q -o cut -t 1 --resume");
  for (int run = 0; run < 2; run++) {
    assert_string_equal(summary(run ? "cut" : "two", "state_hash"), hash);
    assert_string_equal(summary(run ? "cut" : "two", "warning"), warning);
  }
  assert_same_files("cut/signals.csv", "through/signals.csv");
}

// Steps of a length that the scene has are not made shorter: that is said.
static void steps_of_a_given_length(void **state)
{
  (void)state;
  must("$V run pushed.yaml -o given --set 'supports[1].curve.duration=40 ms' --set 'time={end: 11 ms, step: 0.005 ms}'");
  assert_true(number("given", "most_inverted_elements") > 20);
  assert_string_equal(summary("given", "stretches_repeated_with_shorter_steps"), "0");
  assert_holds(complained, " ms; take a shorter time.step, a smaller load, ");
}

// One tet of law paper, whose energy is not watched; its tip is shot at its base.
static const char tip[] =
    "# vtk DataFile Version 3.0\ntip\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 double\n"
    "0 0 0 1 0 0 0 1 0 0.25 0.25 1\nCELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\nPOINT_DATA 4\n"
    "SCALARS base double 1\nLOOKUP_TABLE default\n1 1 1 0\n"
    "VECTORS velocity double\n0 0 0 0 0 0 0 0 0 0 0 -9.75\n";
static const char shot[] =
    "mesh: {file: tip.vtk, unit: mm}\n"
    "node_sets: [{name: base, node_array: base, value: 1}]\n"
    "materials:\n"
    "  - {name: paper, density: 1 g/cm3, law: paper, paper: {axial: {f: 20 N/m, s: 20 N/m, n: 20 N/m},\n"
    "     angular: {fs: 5 mN, sn: 5 mN, nf: 5 mN}, volume: 1 N/m}}\n"
    "initial_velocity: {node_array: velocity, unit: 1 m/s}\n"
    "supports: [{set: base, held: [x, y, z]}]\n"
    "time: {end: 1 ms}\n"
    "output: {frames: 1 ms, signals: 1 ms}\n";

// It comes through where steps are long, as with one of the same length that the scene gives. In steps of half that length
// it does not, and the run takes these.
static void what_long_steps_do_is_undone(void **state)
{
  (void)state;
  char line[256];
  save_text("tip.vtk", tip);
  save_text("shot.yaml", shot);
  must("$V run shot.yaml -o halved");
  assert_string_equal(summary("halved", "most_inverted_elements"), "0");
  assert_string_equal(summary("halved", "stretches_repeated_with_shorter_steps"), "1");
  assert_null(strstr(complained, "inside out"));
  snprintf(line, sizeof line, "$V run shot.yaml -q -o long --set 'time={end: 1 ms, step: %.17g ms}'",
           1 / ceil(1 / number("halved", "shortest_allowed_step_ms")));
  must(line);
  assert_string_equal(summary("long", "most_inverted_elements"), "1");
  must("$V run shot.yaml -q -o short --set time.safety=0.4");
  assert_string_equal(summary("short", "most_inverted_elements"), "0");
  assert_string_equal(summary("short", "stretches_repeated_with_shorter_steps"), "0");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_the_load_does_is_told),
      cmocka_unit_test(nothing_changes_it),
      cmocka_unit_test(steps_of_a_given_length),
      cmocka_unit_test(what_long_steps_do_is_undone),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
