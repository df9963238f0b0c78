// SPDX-License-Identifier: GPL-3.0-or-later
// Explicit and implicit steps of the shipped beat, as they are by default, go the same way.
#include "program.h"

enum { MOST_ROWS = 512 };

// The cavity's volume in the rows of a run, ml; returns how many.
static size_t cavity_of(const char *run, double values[MOST_ROWS])
{
  static char text[PROGRAM_TEXT];
  char name[128];
  size_t column = 0, rows = 0;
  snprintf(name, sizeof name, "%.64s/signals.csv", run);
  load_text(name, text, sizeof text);
  const char *found = strstr(text, "cavity_endo"), *line = strchr(text, '\n');
  if (found == NULL) fail_msg("%s: no cavity_endo", name);
  for (const char *at = text; at < found; at++) column += *at == ',';
  for (; line != NULL && line[1] != '\0'; line = strchr(line + 1, '\n')) {
    const char *at = line + 1;
    for (size_t k = 0; k < column; k++) at = strchr(at, ',') + 1;
    assert_true(rows < MOST_ROWS);
    values[rows++] = strtod(at, NULL);
  }
  return rows;
}

// A coarse ventricle, from rest through systole and back: within 0.5 % of the stroke at every row.
static void both_methods_go_the_same_way(void **state)
{
  (void)state;
  static const char *const methods[2] = {"explicit", "implicit"};
  static double cavity[2][MOST_ROWS];
  size_t rows[2];
  must("$V generate lv --around 12 --along 8 --layers 2 -o lv.vtu && $V generate map -o map.vti");
  for (int m = 0; m < 2; m++) {
    char command[512];
    snprintf(command, sizeof command,
             "$V run " VSC_SOURCE_DIR "/data/beat.yaml -q -o %s --set solve=%s --set mesh.file=$PWD/lv.vtu "
             "--set fibers.map.file=$PWD/map.vti --set 'time.end=400 ms' --set 'output.signals=4 ms' "
             "--set 'output.frames=400 ms'", methods[m], methods[m]);
    must(command);
    rows[m] = cavity_of(methods[m], cavity[m]);
  }
  assert_int_equal(rows[0], 101);
  assert_int_equal(rows[1], 101);
  double smallest = cavity[0][0], off = 0;
  for (size_t k = 0; k < 101; k++) {
    smallest = fmin(smallest, cavity[0][k]);
    off = fmax(off, fabs(cavity[0][k] - cavity[1][k]));
  }
  const double stroke = cavity[0][0] - smallest;
  print_message("%.1f ml of %.1f are ejected; the methods differ by %.3f %% of that\n", stroke, cavity[0][0],
                100 * off / stroke);
  assert_true(stroke > 0.4 * cavity[0][0]);
  assert_true(off > 0 && off < 0.005 * stroke);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(both_methods_go_the_same_way)};
  return cmocka_run_group_tests(tests, program_open, program_close);
}
