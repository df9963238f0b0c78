// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about curves.
#include "block_scene.h"
#include "trap.h"

// How many warnings the block scene has with `options`, and that the first one holds `part`.
static int warnings_of(const char *options, const char *part)
{
  char command[512];
  int count = 0;
  snprintf(command, sizeof command, "$V check block.yaml -t 1 %s", options);
  must(command);
  for (const char *at = said; (at = strstr(at, "\nwarning ")) != NULL; at++) count++;
  if (count > 0) assert_holds(line_of("warning"), part);
  return count;
}

static void assert_warns(const char *options, const char *part)
{
  if (warnings_of(options, part) != 1) fail_msg("%s: %s", options, said);
}

#define PRESSED "--set time.end='1 s' --set 'pressures=[{surface: end, peak: 1 kPa, curve: {"

// Loads that come or go at once where a period ends; within 1 % of their range, or behind the end of the run, they do not.
static void curves_that_jump(void **state)
{
  (void)state;
  assert_warns(PRESSED "kind: double_hill, start: 1 ms, rise: 20 ms, fall: 300 ms, period: 100 ms}}]'",
               "pressures[0]: at the end of each period of its curve, 100 ms, the value jumps from 0.97 to 0: take a longer "
               "period, or values that meet there");
  assert_warns(PRESSED "kind: table, times: [10 ms, 50 ms, 90 ms], values: [0.5, 2, 0], period: 100 ms}}]'",
               " to 0.5: take");
  assert_warns(PRESSED "kind: bestel, period: 500 ms}}]'", "pressures[0]: at the end of each period of its curve, 500 ms");
  assert_warns("--set time.end='1 s' --set 'materials[0].active.curve={kind: double_hill, rise: 120 ms, fall: 900 ms, "
               "period: 800 ms}'", "material muscle: at the end of each period of its curve, 800 ms, the value jumps from 0.9");
  const char *const ramp = "motion: [1 mm, 0 mm, 0 mm], curve: {kind: table, times: [0 ms, 9 ms], values: [0, 0.3], period: 10 ms}}]'";
  char setting[256];
  snprintf(setting, sizeof setting, "--set 'supports=[{set: left, held: [x, y, z], %s", ramp);
  assert_warns(setting, "the support of left: at the end of each period of its curve, 10 ms, the value jumps from 0.3 to 0");
  snprintf(setting, sizeof setting, "--set 'obstacles=[{kind: sphere, point: [50 mm, 0 mm, 0 mm], radius: 5 mm, %s", ramp);
  assert_warns(setting, "obstacles[0]: at the end of each period");
  static const char *const fine[] = {
      PRESSED "kind: table, times: [0 ms, 50 ms, 90 ms], values: [0.009, 1, 0], period: 100 ms}}]'",
      PRESSED "kind: table, times: [0 ms, 500 ms], values: [0, 1], period: 1001 ms}}]'",
      PRESSED "kind: bestel, period: 1 s}}]'",
      PRESSED "kind: constant, period: 100 ms}}]'"};
  for (size_t k = 0; k < sizeof fine / sizeof fine[0]; k++)
    if (warnings_of(fine[k], "none") != 0) fail_msg("%s: %s", fine[k], said);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(curves_that_jump)};
  return cmocka_run_group_tests(tests, block_open, program_close);
}
