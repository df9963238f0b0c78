// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera generate`: what it refuses, and what it says of a ventricle.
#include "program.h"

static void names_have_the_ending_of_what_is_written(void **state)
{
  (void)state;
  static const char *const bad[][2] = {{"block -o x.vtk", "x.vtu"},    {"block -o a.b/x", "a.b/x.vtu"},
                                       {"map -o m.vtu", "m.vti"},      {"vessels -o ve.vtu", "ve.vtp"},
                                       {"sheet -o sheet", "sheet.vtu"}};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char command[128];
    snprintf(command, sizeof command, "$V generate %s", bad[b][0]);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b][1]);
  }
  assert_int_equal(shell("test -e x.vtk || test -e m.vtu || test -e ve.vtu"), 1);
  must("$V generate block -o X.VTU && $V info X.VTU");
}

static void options_of_other_shapes_are_refused(void **state)
{
  (void)state;
  static const char *const bad[][2] = {
      {"block --unstructured --element hex", "block --unstructured has no --element"},
      {"block --points 9", "block has no --points, which is an option of block --unstructured"},
      {"block --endo-angle 9", "block has no --endo-angle, which is an option of map"},
      {"lv --jitter 0.1", "lv has no --jitter, which is an option of block, sheet"},
      {"tube --jitter 0.1", "tube has no --jitter"},
      {"liver --tree portal", "liver has no --tree"}};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char command[128];
    snprintf(command, sizeof command, "$V generate %s", bad[b][0]);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b][1]);
  }
}

// Every option that the help tells of a shape.
static void options_of_a_shape_are_taken(void **state)
{
  (void)state;
  static const char *const good[] = {
      "lv --like land --endo-radius 7 --endo-length 17 --epi-radius 10 --epi-length 20 --base 5 --around 8 "
      "--along 4 --layers 1 --element hex --base-rise 0.1 --along-x --surfaces",
      "map --like land --endo-radius 7 --endo-length 17 --epi-radius 10 --epi-length 20 --base 5 "
      "--endo-angle 50 --epi-angle=-50 --spacing 3",
      "block --cells 3,2,2 --size 1,1,1 --tets 6 --jitter 0.1 --seed 2 --slivers 1 --element tet",
      "block --unstructured --points 30 --size 1,1,1 --seed 2",
      "sheet --cells 2,2 --size 1,1 --jitter 0.1 --seed 2",
      "tube --radius 1 --length 2 --around 6 --along 3",
      "cook --cells 2,2,1 --thickness 2 --element tet --tets 6",
      "column --bend 1 --twist 1 --cells 2,2,2 --size 1,1,6 --element tet --tets 6",
      "cylinder --inner 1 --outer 2 --length 1 --layers 1 --around 2 --along 1 --element hex",
      "octant --inner 1 --outer 2 --layers 1 --around 2 --element hex",
      "liver --bricks 3", "vessels --tree hepatic"};
  for (size_t k = 0; k < sizeof good / sizeof good[0]; k++) {
    char command[256];
    snprintf(command, sizeof command, "$V generate %s", good[k]);
    must(command);
  }
}

// --like is what the others change, wherever it stands.
static void likeness_comes_first(void **state)
{
  (void)state;
  must("$V generate lv --like land --around 8 --along 4 --layers 1 --base 4 -o first.vtu");
  must("$V generate lv --around 8 --along 4 --layers 1 --base 4 --like land -o last.vtu");
  must("cmp first.vtu last.vtu");
  must("$V generate lv --around 8 --along 4 --layers 1 --base 4 -o human.vtu");
  assert_int_equal(shell("cmp -s first.vtu human.vtu"), 1);
  assert_int_equal(shell("$V generate lv --around x --like land"), 2);
  assert_holds(complained, "--around 'x' does not fit");
  assert_int_equal(shell("$V generate lv --around 8 --like mars"), 2);
  assert_holds(complained, "--like 'mars' does not fit");
}

// A coarse mesh encloses much less than the ellipsoid.
static void a_ventricle_is_told_as_its_mesh_is(void **state)
{
  (void)state;
  double wall, cavity;
  must("$V generate lv --around 4 --along 1 --layers 1 -o coarse.vtu");
  assert_int_equal(sscanf(strstr(said, "wall"), "wall %lf ml, cavity %lf ml", &wall, &cavity), 2);
  save_text("coarse.yaml",
            "mesh: {file: coarse.vtu, unit: mm}\nsurfaces: [{name: endo, node_array: endo, value: 1}]\n"
            "fibers: {source: none}\ntime: {end: 1 ms}\n"
            "materials: [{name: m, density: 1 g/cm3, law: neo_hookean, neo_hookean: {shear: 1 kPa}, volume_modulus: 9 kPa}]\n");
  must("$V check coarse.yaml");
  double checked;
  const char *at = strstr(said, "a cavity of ");
  assert_non_null(at);
  assert_int_equal(sscanf(at, "a cavity of %lf ml", &checked), 1);
  assert_close(cavity, checked, 2e-3, 0);  // one digit is printed
  assert_true(cavity < 0.6 * 134);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(names_have_the_ending_of_what_is_written),
      cmocka_unit_test(options_of_other_shapes_are_refused),
      cmocka_unit_test(options_of_a_shape_are_taken),
      cmocka_unit_test(likeness_comes_first),
      cmocka_unit_test(a_ventricle_is_told_as_its_mesh_is),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
