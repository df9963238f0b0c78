// SPDX-License-Identifier: GPL-3.0-or-later
// Why a run goes back, and why it stops before its end.
#include "block_scene.h"
#include "run/run.h"

static double number(const char *run, const char *key)
{
  return strtod(summary(run, key), NULL);
}

// A support that jerks viscous tissue into motion: the ledger does not see it balance before looks are closer and steps,
// with the second repetition, are a half, a quarter and so on of what they may be; that counts among the steps saved.
// A load that tears it to pieces: what is told, and the last good state is kept.
static void test_repeated_with_shorter_steps(void **state)
{
  (void)state;
  static const char jerk[] =
      "mesh: {file: block.vtu, unit: mm, region_array: region}\n"
      "surfaces: [{name: end, boundary: true}]\n"
      "node_sets:\n"
      "  - {name: left, node_array: x0, value: 1}\n"
      "  - {name: right, node_array: x1, value: 1}\n"
      "materials:\n"
      "  - {name: muscle, axial: {f: 20 kPa, s: 20 kPa, n: 20 kPa}, viscosity: 60 Pa s, volume_modulus: 500 kPa,\n"
      "     angular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa}}\n"
      "supports:\n"
      "  - {set: left, held: [x, y, z]}\n"
      "  - {set: right, held: [x, y, z], motion: [1 mm, 0 mm, 0 mm], curve: {kind: ramp, duration: 5 ms}}\n"
      "time: {end: 3 ms}\n"
      "output: {frames: 5 ms, signals: 1 ms}\n";
  save_text("jerk.yaml", jerk);
  must("$V run jerk.yaml -q -o jerk");
  assert_string_equal(summary("jerk", "outcome"), "finished");
  const double repeated = number("jerk", "stretches_repeated_with_shorter_steps"), steps = number("jerk", "steps"),
               least = number("jerk", "shortest_allowed_step_ms");
  assert_true(repeated >= 1);
  assert_close(steps * least / 3, ldexp(1, (int)repeated), 0.05, 0);
  assert_close(number("jerk", "steps_saved"), 3 / least - steps, 0, 1e-4);
  // with looks that do not come closer each time it takes one time more
  must("$V run jerk.yaml -q -o soft --set 'materials[0].volume_modulus=100 kPa' --set 'time.end=1 ms'");
  assert_close(number("soft", "stretches_repeated_with_shorter_steps"), 2, 0, 0);
  assert_int_equal(shell("$V run jerk.yaml -q -o torn --set 'pressures=[{surface: end, peak: 100 MPa}]'"), 3);
  assert_non_null(strstr(complained, "the energy balance jumped"));
  assert_non_null(strstr(complained, " energy; element "));
  assert_true(strtod(summary("torn", "stretches_repeated_with_shorter_steps"), NULL) == 3);
}

// A load beyond all measure: what is told is where the first number is lost, on the end that it pushes, not the first node
// of a body of which nothing is left; and the state before is kept.
static void test_lost_numbers(void **state)
{
  (void)state;
  assert_int_equal(shell("$V run block.yaml -q -o lost --set 'pressures=[{surface: end, peak: 1e10 kPa}]'"), 3);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, " the position of node ");
  assert_holds(complained, ", at rest at (20, ");
  assert_holds(complained, ") mm, is no longer a finite number; it is of element ");
  assert_holds(complained, " mN a step before, is that of volume: the simulation has blown up; take a smaller time.safety");
  assert_string_equal(summary("lost", "outcome"), "failed");
  assert_true(number("lost", "stretches_repeated_with_shorter_steps") == 3);
  must("$V info lost/checkpoint.h5");
}

// One that leaves next to no step is told before the first, which would not end in any time: with the term behind it.
static void test_loads_beyond_any_step(void **state)
{
  (void)state;
  assert_int_equal(shell("$V run block.yaml -q -o beyond --set 'pressures=[{surface: end, peak: 1e20 kPa}]'"), 3);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, "at 0 ms the stable step has collapsed from ");
  assert_holds(complained, " is that of pressure: ");
}

// A bar of three cubes of six tets each, behind `before` points that nothing uses and as many cells that are no elements.
static void write_bar(const char *name, int before)
{
  static const int paths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  FILE *file = fopen(in_folder(name), "w");
  assert_non_null(file);
  fprintf(file, "# vtk DataFile Version 3.0\nbar\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %d double\n", 16 + before);
  for (int k = 0; k < before; k++) fputs("99 99 99\n", file);
  for (int p = 0; p < 16; p++) fprintf(file, "%d %d %d\n", p % 4, p / 4 % 2, p / 8);
  fprintf(file, "CELLS %d %d\n", 18 + before, 5 * 18 + 4 * before);
  for (int k = 0; k < before; k++) fprintf(file, "3 %d %d %d\n", before, before + 4, before + 1);
  for (int t = 0; t < 18; t++) {
    static const int steps[3] = {1, 4, 8};
    int corner[4] = {before + t / 6};
    for (int i = 0; i < 3; i++) corner[i + 1] = corner[i] + steps[paths[t % 6][i]];
    const int odd = t % 6 > 2;
    fprintf(file, "4 %d %d %d %d\n", corner[0], corner[1], corner[2 + odd], corner[3 - odd]);
  }
  fprintf(file, "CELL_TYPES %d\n", 18 + before);
  for (int c = 0; c < 18 + before; c++) fputs(c < before ? "5\n" : "10\n", file);
  fprintf(file, "POINT_DATA %d\n", 16 + before);  // VTK's reader leaks the cells of files that end before it
  fclose(file);
}

// The number behind `words` in what was complained of.
static long number_behind(const char *words)
{
  const char *at = strstr(complained, words);
  if (at == NULL) fail_msg("no '%s' in '%s'", words, complained);
  return strtol(at + strlen(words), NULL, 10);
}

// Nodes and elements have their numbers in the file, in whatever words, of every method.
static void test_numbers_of_the_file(void **state)
{
  (void)state;
  static const struct {
    const char *change, *node, *element;
  } all[] = {{"", " is node ", " element "},
             {"--set 'pressures[0].peak=1 MPa' --set solve=equilibrium", " is node ", "; it is of element "},
             {"--set 'pressures[0].peak=1e9 kPa' --set solve=explicit", " the position of node ", "; it is of element "},
             {"--set 'pressures[0].peak=1e20 kPa' --set solve=explicit", " pulls at node ", "; it is of element "}};
  save_text("bar.yaml", "mesh: {file: bar.vtk, unit: mm}\n"
                        "surfaces: [{name: all, boundary: true}]\n"
                        "node_sets: [{name: end, box: {low: [0 mm, 0 mm, 0 mm], high: [0 mm, 1 mm, 1 mm]}}]\n"
                        "materials: [{name: a, axial: {f: 10 kPa, s: 10 kPa, n: 10 kPa}, volume_modulus: 100 kPa,\n"
                        "  angular: {fs: 5 kPa, sn: 5 kPa, nf: 5 kPa}}]\n"
                        "supports: [{set: end, held: [x, y, z]}]\n"
                        "pressures: [{surface: all, peak: 1 MPa, curve: {kind: constant}}]\n"
                        "solve: equilibrium\n"
                        "time: {end: 10 ms}\n");
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    long told[2][2];
    for (int more = 0; more < 2; more++) {
      char command[256];
      write_bar("bar.vtk", 5 * more);
      snprintf(command, sizeof command, "$V run bar.yaml -q -o bar %s", all[k].change);
      assert_int_equal(shell(command), 3);
      told[more][0] = number_behind(all[k].node);
      told[more][1] = number_behind(all[k].element);
    }
    for (int i = 0; i < 2; i++) assert_int_equal(told[1][i], told[0][i] + 5);
  }
}

// What went well in the end leaves no message.
static void test_repeated_without_a_message(void **state)
{
  (void)state;
  char directory[256];
  vsc_problem *problem;
  vsc_run_result result;
  vsc_error error = {.text = ""};
  snprintf(directory, sizeof directory, "%s", in_folder("quiet"));
  assert_int_equal(vsc_problem_load(in_folder("jerk.yaml"), NULL, 0, &problem, &error), VSC_OK);
  const vsc_run_options options = {.directory = directory};
  assert_int_equal(vsc_run(problem, &options, &result, &error), VSC_OK);
  assert_true(result.repeated >= 1);
  assert_string_equal(error.text, "");
  vsc_problem_free(problem);
}

// After 16 looks that have balanced steps become longer again, twice as long at a time.
static void test_steps_grow_again(void **state)
{
  (void)state;
  must("$V run jerk.yaml -q -o calm --set 'time.end=50 ms' --stop '49 ms'");
  assert_true(number("calm", "stretches_repeated_with_shorter_steps") >= 1);
  must("$V run jerk.yaml -q -o calm --set 'time.end=50 ms' --resume");
  assert_close(number("calm", "steps_this_run") * last_signal("calm", "step [ms]"), 1, 0.05, 0);
}

// Implicit steps of 4 ms are cut to 2 ms by rows that lie 2 ms apart, and to 1.5 ms by rows 3 ms apart.
static void test_steps_that_rows_cut(void **state)
{
  (void)state;
  static const char implicit[] = "$V run jerk.yaml -q --set solve=implicit --set 'time={end: 12 ms, step: %s}' "
                                 "--set 'output={frames: 12 ms, signals: %s}' -o cut";
  static const char *const given[3][2] = {{"4 ms", "2 ms"}, {"2 ms", "3 ms"}, {"2 ms", "4 ms"}};
  static const double taken[3] = {2, 1.5, 2};
  for (int k = 0; k < 3; k++) {
    char line[256];
    snprintf(line, sizeof line, implicit, given[k][0], given[k][1]);
    must(line);
    assert_close(last_signal("cut", "step [ms]"), taken[k], 1e-9, 0);
  }
}

// Going back does not forget what the row before has marked: the mean force since then, times the support's way, is
// its work since then.
static void test_rows_before_a_repetition_count(void **state)
{
  (void)state;
  must("$V run jerk.yaml -q -o late --set 'time.end=3 ms' "
       "--set 'supports[1].curve={kind: ramp, start: 2 ms, duration: 5 ms}'");
  assert_true(number("late", "stretches_repeated_with_shorter_steps") >= 1);
  const double way = 0.2;  // mm in 1 ms
  assert_close(1e-3 * way * last_signal("late", "support_right_x"), last_signal("late", "work_supports"), 1e-6, 0);
}

// So viscous that no look is close enough where the support starts and stops: the run goes on, and its balance too.
static void test_jerks_of_viscous_tissue(void **state)
{
  (void)state;
  must("$V run jerk.yaml -q -o kicked --set 'materials[0].viscosity=500 Pa s' --set 'time.end=7 ms' "
       "--set 'supports[1].motion=[2 mm, 0 mm, 0 mm]' "
       "--set 'supports[1].curve={kind: half_sine, start: 5 ms, duration: 4 ms}'");
  assert_string_equal(summary("kicked", "outcome"), "finished");
}

// A damped block that beats every 20 ms stops when a beat repeats the last, says so, and does the same when it
// is stopped and resumed on the way; without a tolerance that it can reach it goes on to its end.
static void test_cycles(void **state)
{
  (void)state;
  static const char beating[] =
      "--set 'materials[0].active.curve={kind: half_sine, duration: 15 ms, period: 20 ms}' --set pressures=[] "
      "--set 'materials[0].damping={f: 300 Pa s, s: 300 Pa s, n: 300 Pa s}' "
      "--set 'time={end: 150 ms, cycle: 20 ms, cycle_tolerance: 0.03}' -t 1";
  char line[600], hash[32];
  snprintf(line, sizeof line, "$V run block.yaml -o beats %s", beating);
  must(line);
  assert_non_null(strstr(said, " repeats the one before to "));
  const double end = strtod(summary("beats", "time_s"), NULL), beats = strtod(summary("beats", "cycles"), NULL);
  assert_true(beats >= 2 && beats < 7);
  assert_close(end, 0.02 * beats, 1e-12, 0);
  assert_true(strtod(summary("beats", "cycle_difference"), NULL) <= 0.03);
  assert_string_equal(summary("beats", "outcome"), "finished");
  snprintf(hash, sizeof hash, "%s", summary("beats", "state_hash"));
  snprintf(line, sizeof line, "$V run block.yaml -q -o cut --stop '33 ms' %s", beating);
  must(line);
  snprintf(line, sizeof line, "$V run block.yaml -q -o cut --resume %s", beating);
  must(line);
  assert_string_equal(summary("cut", "state_hash"), hash);
  assert_true(strtod(summary("cut", "cycles"), NULL) == beats);
  snprintf(line, sizeof line, "$V run block.yaml -q -o never %s --set time.cycle_tolerance=1e-12 --set 'time.end=50 ms'",
           beating);
  must(line);
  assert_string_equal(summary("never", "time_s"), "0.05");
  assert_string_equal(summary("never", "repeats"), "no");
  assert_int_equal(shell("$V check block.yaml --set 'time.cycle=1 s'"), 2);
  assert_non_null(strstr(complained, "time.cycle: 1000 ms; expected a time above zero and before time.end"));
}

// A free column that turns in steps of the trapezoid far too long for it: its energy grows 50 times, and that is told.
static void test_energy_made_by_implicit_steps(void **state)
{
  (void)state;
  static const char turning[] =
      "mesh: {file: column.vtu, unit: mm}\n"
      "materials:\n"
      "  - {name: rubber, density: 1.1 g/cm3, law: neo_hookean, isochoric: true, neo_hookean: {shear: 5.9 MPa},\n"
      "     volume_modulus: 57 MPa}\n"
      "initial_velocity: {node_array: velocity, unit: 1 m/s}\n"
      "solve: implicit\n"
      "solver: {scheme: trapezoid}\n"
      "time: {end: 0.4 s, step: 10 ms}\n"
      "output: {frames: 200 ms, signals: 20 ms}\n";
  must("$V generate column --twist 105 --cells 2,2,6 -o column.vtu");
  save_text("turning.yaml", turning);
  must("$V run turning.yaml -o made");
  assert_holds(complained, "viscera: warning: by the energy balance implicit steps have made ");
  assert_true(strtod(summary("made", "most_energy_made_part"), NULL) > 0.5);
  assert_holds(summary("made", "warning"), "take shorter steps (time.step, ");
  must("$V run turning.yaml -q -o made");
  assert_string_equal(complained, "");
  must("$V run turning.yaml -o kept --set 'time.step=2 ms'");
  assert_null(strstr(complained, "energy"));
  assert_close(strtod(summary("kept", "energy_taken_part"), NULL), 0, 0, 0.1);
}

// Bricks of a law with large exponents are drawn to twice their length: that it goes on as a polynomial is told once.
static void test_frames_beyond_the_exponent(void **state)
{
  (void)state;
  static const char drawn[] =
      "mesh: {file: bricks.vtu, unit: mm}\n"
      "node_sets: [{name: a, node_array: x0, value: 1}, {name: b, node_array: x1, value: 1}]\n"
      "fibers: {source: constant, constant: {fiber: [1, 0, 0]}}\n"
      "materials:\n"
      "  - {name: muscle, density: 1 g/cm3, law: guccione, guccione: {C: 2 kPa, bf: 40, bt: 20, bfs: 30}, volume_modulus: 1 MPa}\n"
      "supports:\n"
      "  - {set: a, held: [x, y, z]}\n"
      "  - {set: b, held: [x, y, z], motion: [10 mm, 0 mm, 0 mm], curve: {kind: ramp, duration: 1 s}}\n"
      "solve: equilibrium\n"
      "time: {end: 1 s}\n"
      "output: {frames: 500 ms, signals: 500 ms}\n";
  must("$V generate block --cells 2,1,1 --size 10,5,5 --element hex -o bricks.vtu");
  save_text("drawn.yaml", drawn);
  must("$V run drawn.yaml -o beyond");
  assert_holds(complained, "viscera: warning: material muscle: 16 frames of elements at once were strained beyond exponent 20 of "
                           "the law, from where it goes on as a polynomial: stresses there are too low; take smaller loads");
  assert_string_equal(summary("beyond", "most_frames_beyond_exponent"), "16");
  assert_holds(summary("beyond", "warning"), "beyond exponent 20");
  must("$V run drawn.yaml -q -o beyond");
  assert_string_equal(complained, "");
  must("$V run drawn.yaml -o within --set 'supports[1].motion=[1 mm, 0 mm, 0 mm]'");
  assert_null(strstr(complained, "exponent"));
  assert_string_equal(summary("within", "most_frames_beyond_exponent"), "0");
}

// What begins to beat after some cycles does not repeat itself before.
static void test_cycles_of_rest(void **state)
{
  (void)state;
  // of this block at rest no force is off by rounding
  must("$V generate block --cells 4,2,2 --size 20,10,10 -o plain.vtu && "
       "$V run block.yaml -q -t 1 -o late --set mesh.file=plain.vtu --set volume=element --set pressures=[] "
       "--set 'fibers={source: constant, constant: {fiber: [1, 0, 0]}}' --set 'materials[0].active.delay=50 ms' "
       "--set 'materials[0].active.curve={kind: half_sine, duration: 15 ms, period: 20 ms}' "
       "--set 'time={end: 70 ms, cycle: 20 ms}'");
  assert_string_equal(summary("late", "time_s"), "0.07");
  assert_string_equal(summary("late", "repeats"), "no");
  assert_true(strtod(summary("late", "cycle_difference"), NULL) > 0.5);
}

// Equilibria and implicit steps do not go on to their next row either; what they had at the last one is kept.
static void test_interrupted_on_the_way(void **state)
{
  (void)state;
  static const char *const methods[] = {"implicit", "equilibrium", "explicit"};
  must("$V generate lv --around 24 --along 14 -o lv.vtu && $V generate map -o map.vti");
  for (int m = 0; m < 3; m++) {
    char script[1024];
    // a load so slow that its only row is far away
    snprintf(script, sizeof script,
             "$V run block.yaml -q -o way%d --set mesh.file=lv.vtu --set surfaces='[{name: end, node_array: endo, value: 1}, "
             "{name: skin, boundary: true}]' --set node_sets='[{name: left, node_array: base, value: 1}]' "
             "--set 'fibers={source: constant, constant: {fiber: [1, 0, 0]}}' --set solve=%s --set 'time.end=1000 s' "
             "--set 'materials[0].active.curve={kind: half_sine, duration: 20 ms, period: 40 ms}' "
             "--set 'output={frames: 1000 s, signals: %s}' &\n"
             "until [ -s way%d/frames/block_00000.vtu ]; do sleep 0.01; done\n"
             "kill -TERM $!\nwait $!\n[ $? = 143 ]\n",
             m, methods[m], m == 1 ? "0.2 s" : "1000 s", m);
    must(script);
    char run[16];
    snprintf(run, sizeof run, "way%d", m);
    assert_string_equal(summary(run, "outcome"), "stopped");
    snprintf(script, sizeof script, "ls %s/checkpoint.h5", run);
    must(script);
  }
}

// Told to stop, a run stops at its next look, with a checkpoint from which it goes on as if nothing had been.
static void test_interrupted(void **state)
{
  (void)state;
  static const char script[] =
      "$V run block.yaml -q -o told --set 'time.end=1000 s' --set output.frames='1 s' &\n"
      "until [ \"$(wc -l < told/signals.csv)\" -gt 3 ]; do sleep 0.01; done 2>/dev/null\n"
      "kill -TERM $!\n"
      "wait $!\n"
      "[ $? = 143 ]\n";
  char line[256];
  must(script);
  assert_holds(complained, "viscera: stopping");
  assert_holds(complained, "with --resume goes on from there");
  assert_string_equal(summary("told", "outcome"), "stopped");
  const double time = strtod(summary("told", "time_s"), NULL);
  assert_true(time > 0);
  snprintf(line, sizeof line, "$V run block.yaml -q -o told --set 'time.end=1000 s' --resume --stop '%.17g s'", time + 0.002);
  must(line);
  snprintf(line, sizeof line, "$V run block.yaml -q -o untold --set 'time.end=1000 s' --stop '%.17g s'", time + 0.002);
  must(line);
  assert_string_equal(summary("told", "time_s"), summary("untold", "time_s"));
  assert_string_equal(summary("told", "state_hash"), summary("untold", "state_hash"));
}

// Moduli whose forces are too large for numbers are not said to be none.
static void test_endless_stiffness(void **state)
{
  (void)state;
  assert_int_equal(shell("$V run block.yaml -q -o endless --set 'materials[0].axial.f=1e308 kPa'"), 3);
  assert_holds(complained, "the stiffness over the mass is not a finite number; check moduli");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_repeated_with_shorter_steps),
      cmocka_unit_test(test_lost_numbers),
      cmocka_unit_test(test_loads_beyond_any_step),
      cmocka_unit_test(test_numbers_of_the_file),
      cmocka_unit_test(test_repeated_without_a_message),
      cmocka_unit_test(test_steps_grow_again),
      cmocka_unit_test(test_steps_that_rows_cut),
      cmocka_unit_test(test_rows_before_a_repetition_count),
      cmocka_unit_test(test_energy_made_by_implicit_steps),
      cmocka_unit_test(test_frames_beyond_the_exponent),
      cmocka_unit_test(test_interrupted),
      cmocka_unit_test(test_interrupted_on_the_way),
      cmocka_unit_test(test_jerks_of_viscous_tissue),
      cmocka_unit_test(test_cycles),
      cmocka_unit_test(test_cycles_of_rest),
      cmocka_unit_test(test_endless_stiffness),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
