// SPDX-License-Identifier: GPL-3.0-or-later
// Observed points: their signals are the displacement of the tissue there, in every kind of mesh.
#include "block_scene.h"
#include "mesh/place.h"
#include "tools/plot/signals.h"

static const char points[] =
    "--set 'output.points=[{name: corner, at: [2 cm, 10 mm, 10 mm]}, "
    "{name: within, at: [7.3 mm, 4.1 mm, 6.2 mm]}, "
    "{name: beside, at: [20.5 mm, 5 mm, 5 mm], reach: 1 mm}]' --set output.precision=double ";

static double last(const vsc_signals *s, const char *point, const char *what, int axis)
{
  char name[64];
  snprintf(name, sizeof name, "point_%s_%s%c", point, what, "xyz"[axis]);
  const double *values = vsc_signals_find(s, name);
  if (values == NULL) fail_msg("no column %s", name);
  return values[s->rows - 1];
}

// What the last frame says at the place of the mesh nearest to `at`.
static void check_point(const vsc_mesh *frame, const vsc_signals *s, const char *point,
                        const double at[3])
{
  double moved[3], rest[3];
  vsc_place place;
  vsc_place_find(frame, at, &place);
  vsc_place_value(frame, &place, 3, vsc_arrays_find(&frame->node_data, "displacement")->values, moved);
  vsc_place_value(frame, &place, 3, frame->nodes, rest);
  double most = 0;
  for (int a = 0; a < 3; a++) {
    // twelve digits of positions up to 20 mm are written
    assert_close(last(s, point, "u", a), moved[a], 0, 1e-10);
    assert_close(last(s, point, "", a), rest[a] + moved[a], 0, 1e-10);
    most = fmax(most, fabs(moved[a]));
  }
  assert_true(most > 1e-3);
}

static void check_run(const char *settings, const char *frame_file)
{
  char command[1024];
  vsc_signals *s = NULL;
  vsc_mesh *frame = NULL;
  snprintf(command, sizeof command, "$V run block.yaml -o out %s %s", points, settings);
  must(command);
  if (vsc_signals_read(in_folder("out/signals.csv"), &s, NULL) != VSC_OK) fail_msg("no signals");
  if (vsc_vtk_read_mesh(in_folder(frame_file), 1, &frame, NULL) != VSC_OK) fail_msg("no frame");
  check_point(frame, s, "corner", (const double[3]){20, 10, 10});
  check_point(frame, s, "within", (const double[3]){7.3, 4.1, 6.2});
  check_point(frame, s, "beside", (const double[3]){20.5, 5, 5});
  // at rest: the way is 0, the place where it was wanted
  assert_true(*vsc_signals_find(s, "point_within_uy") == 0);
  assert_close(*vsc_signals_find(s, "point_within_y"), 4.1, 1e-12, 0);
  assert_close(*vsc_signals_find(s, "point_beside_x"), 20, 1e-9, 0);
  vsc_signals_free(s);
  vsc_mesh_free(frame);
}

static void of_linear_tets(void **state)
{
  (void)state;
  check_run("", "out/frames/block_00010.vtu");
}

static void of_quadratic_tets(void **state)
{
  (void)state;
  check_run("--set mesh.order=2 --set volume=element --set 'time.end=4 ms'",
            "out/frames/block_00002.vtu");
}

static void a_check_says_where_they_are(void **state)
{
  (void)state;
  char command[1024];
  snprintf(command, sizeof command, "$V check block.yaml %s", points);
  must(command);
  assert_holds(said, "within: in element ");
  assert_holds(said, "0.5 mm from where it was wanted");
}

static void what_is_refused(void **state)
{
  (void)state;
  static const char *const bad[][2] = {
      {"[{name: p, at: [22 mm, 5 mm, 5 mm]}]", "lies 2 mm outside the body"},
      {"[{name: p, at: [22 mm, 5 mm, 5 mm], reach: 1 mm}]", "(20, 5, 5) mm"},
      {"[{name: p, at: [1 mm, 5 mm, 5 mm], reach: -1 mm}]", "output.points[0].reach"},
      {"[{name: p, at: [1 mm, 5 mm]}]", "output.points[0].at"},
      {"[{at: [1 mm, 5 mm, 5 mm]}]", "output.points[0].name"},
      {"[{name: \"a,b\", at: [1 mm, 5 mm, 5 mm]}]", "without commas"},
      {"[{name: p, at: [1 mm, 5 mm, 5 mm]}, {name: p, at: [2 mm, 5 mm, 5 mm]}]", "another point"}};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char command[512];
    snprintf(command, sizeof command, "$V check block.yaml --set 'output.points=%s'", bad[b][0]);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b][1]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(of_linear_tets),
      cmocka_unit_test(of_quadratic_tets),
      cmocka_unit_test(a_check_says_where_they_are),
      cmocka_unit_test(what_is_refused),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
