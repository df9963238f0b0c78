// SPDX-License-Identifier: GPL-3.0-or-later
// What a run that fails goes back to, and what a resumed one touches before it goes on.
#include "block_scene.h"
#include "io/checkpoint.h"

enum { NODES = 175 };

// A block of `rows` x `columns` numbers that a run's checkpoint holds.
static void read_block(const char *run, const char *name, size_t rows, size_t columns, double *values)
{
  char file[64];
  vsc_error error;
  snprintf(file, sizeof file, "%s/checkpoint.h5", run);
  const vsc_block block = {name, "", rows, columns, values};
  if (vsc_checkpoint_read(in_folder(file), strtoull(summary(run, "model_hash"), NULL, 16), 1, &block, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

// Both hold the same numbers, not all of them 0.
static void assert_same_block(const char *run, const char *other, const char *name, size_t rows, size_t columns)
{
  static double values[2][8 * NODES];
  double most = 0;
  read_block(run, name, rows, columns, values[0]);
  read_block(other, name, rows, columns, values[1]);
  for (size_t k = 0; k < rows * columns; k++) most = fmax(most, fabs(values[0][k]));
  assert_true(most > 0);
  if (memcmp(values[0], values[1], rows * columns * sizeof(double)) != 0) fail_msg("%s of %s and %s differ", name, run, other);
}

// A load that tears the block from `begin` to `end` ms on, and rows only where a run ends.
static void command_of(char *command, size_t size, const char *run, const char *more, double begin, double end)
{
  snprintf(command, size,
           "$V run block.yaml -q -t 1 -o %s --set 'pressures=[{surface: end, peak: -1 GPa, curve: {kind: table, "
           "times: [0 ms, %g ms, %g ms], values: [0, 0, 1]}}]' %s", run, begin, end, more);
}

// Runs the block to where it is torn, and another to `stop` ms just before.
static void tear(const char *torn, const char *whole, const char *more, double begin, double end, double stop)
{
  char command[1024], options[512];
  command_of(command, sizeof command, torn, more, begin, end);
  assert_int_equal(shell(command), 3);
  snprintf(options, sizeof options, "%s --stop '%g ms'", more, stop);
  command_of(command, sizeof command, whole, options, begin, end);
  must(command);
}

// Torn right behind the end of a cycle of which there is no row: that end is not lost.
static void test_a_cycle_that_has_ended(void **state)
{
  (void)state;
  static const char cycles[] = "--set 'time={end: 20 ms, cycle: 5 ms, cycle_tolerance: 1e-9}' "
                               "--set 'output={frames: 20 ms, signals: 20 ms}'";
  tear("torn", "ended", cycles, 10, 10.2, 10);
  assert_string_equal(summary("ended", "cycles"), "2");
  assert_string_equal(summary("torn", "cycles"), "2");
  assert_same_block("torn", "ended", "last_cycle", 2 * NODES, 4);
}

// Multipliers of a solution that was given up are not kept beside positions of the last good one.
static void test_multipliers(void **state)
{
  (void)state;
  static const char rest[] = "--set solve=equilibrium --set solver.incompressible=1e-5 --set 'materials[0].active.kind=none'"
                             " --set 'gravity=[0 m/s2, 0 m/s2, -9.81 m/s2]' --set 'time.end=8 ms'";
  tear("crushed", "sound", rest, 4, 4.5, 4);
  assert_string_equal(summary("crushed", "time_s"), "0.004");
  assert_same_block("crushed", "sound", "position", NODES, 4);
  assert_same_block("crushed", "sound", "node_multipliers", NODES, 1);
}

static const char iterated[] = "$V run block.yaml -q -t 1 --set solve=equilibrium --set 'time.end=8 ms' "
                               "--set 'output={frames: 2 ms, signals: 1 ms}'";

// As after a crash behind the last checkpoint: rows of convergence.csv are there once.
static void test_iterations_are_trimmed(void **state)
{
  (void)state;
  char command[512];
  snprintf(command, sizeof command, "%s -o still && cp -r still crashed", iterated);
  must(command);
  snprintf(command, sizeof command, "%s -o early --stop '4 ms' && cp early/checkpoint.h5 crashed/", iterated);
  must(command);
  snprintf(command, sizeof command, "%s -o crashed --resume", iterated);
  must(command);
  assert_same_files("crashed/convergence.csv", "still/convergence.csv");
  assert_same_files("crashed/signals.csv", "still/signals.csv");
}

// A resumed run that is refused has changed nothing.
static void test_refused_before_anything_is_touched(void **state)
{
  (void)state;
  char command[512];
  must("cp -r still holed && cp early/checkpoint.h5 holed/ && rm holed/frames/block_00001.vtu && cp -r holed kept");
  snprintf(command, sizeof command, "%s -o holed --resume", iterated);
  assert_int_equal(shell(command), 2);
  assert_holds(complained, "block_00001.vtu: is missing or empty");
  must("diff -r holed kept");
}

// Rows that are missed where somebody has deleted some, not where the file was removed; nothing is changed.
static void test_deleted_rows(void **state)
{
  (void)state;
  must("$V run block.yaml -q -o gap --stop '10 ms' && sed -i '5,6d' gap/signals.csv && "
       "cp -r gap before");  // 3 and 4 ms
  assert_int_equal(shell("$V run block.yaml -q -o gap --resume"), 2);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, "gap/signals.csv: it has 9 of the 11 rows that were written up to 10 ms, and its widest gap is from "
                           "2 to 5 ms; remove it");
  must("diff -r gap before && rm gap/signals.csv");
  must("$V run block.yaml -q -o gap --resume --stop '15 ms' && $V run block.yaml -q -o gap --resume");
  must("test $(tail -n +2 gap/signals.csv | wc -l) = 10");  // from 11 ms on
}

// A file that takes no row is named.
static void test_no_room_for_rows(void **state)
{
  (void)state;
  must("mkdir full && ln -s /dev/full full/signals.csv");
  assert_int_equal(shell("$V run block.yaml -q -o full"), 4);
  assert_holds(complained, "full/signals.csv: cannot be written: No space left");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_a_cycle_that_has_ended),
      cmocka_unit_test(test_multipliers),
      cmocka_unit_test(test_iterations_are_trimmed),
      cmocka_unit_test(test_refused_before_anything_is_touched),
      cmocka_unit_test(test_deleted_rows),
      cmocka_unit_test(test_no_room_for_rows),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
