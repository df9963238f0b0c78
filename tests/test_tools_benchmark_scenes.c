// SPDX-License-Identifier: GPL-3.0-or-later
// The benchmarks' scenes through the program: what they say is understood, and the smallest one is right.
#include "program.h"

#define SCENES VSC_SOURCE_DIR "/data/benchmarks/"

static void the_ventricles_are_understood(void **state)
{
  (void)state;
  must("$V generate lv --like land --around 8 --along 5 --layers 1 -o land.vtu");
  must("$V generate lv --like arostica --around 8 --along 5 --layers 1 -o arostica.vtu");
  must("$V check " SCENES "land_p2.yaml --set mesh.file=$PWD/land.vtu");
  must("$V check " SCENES "land_p3.yaml --set mesh.file=$PWD/land.vtu");
  must("$V check " SCENES "arostica_0a.yaml --set mesh.file=$PWD/arostica.vtu");
  must("$V check " SCENES "arostica_0b.yaml --set mesh.file=$PWD/arostica.vtu");
  must("$V check " SCENES "arostica_1.yaml --set mesh.file=$PWD/arostica.vtu");
  // a key of a driver that means nothing to it
  assert_int_equal(shell("$V check " SCENES "arostica_1.yaml --set mesh.file=$PWD/arostica.vtu "
                         "--set 'materials[0].active.curve.filling=1 1/s'"), 2);
  assert_holds(complained, "filling");
  assert_int_equal(shell("$V check " SCENES "land_p3.yaml --set mesh.file=$PWD/land.vtu "
                         "--set 'fibers.ellipsoid.endo=inside'"), 2);
  assert_holds(complained, "inside");
}

// Mass makes the real-time heart's steps as long as it says.
static void the_heart_in_real_time_is_understood(void **state)
{
  (void)state;
  must("$V generate lv --around 24 --along 15 -o heart.vtu");
  must("$V check " SCENES "real_time.yaml --set mesh.file=$PWD/heart.vtu");
  assert_holds(line_of("mass"), "for steps of 0.2");
  assert_holds(line_of("inertia"), "passes over the nodes in each step");
  assert_holds(line_of("warnings"), "none");
}

// One pass over the nodes makes the bar's steps 2.5 times as long.
static void the_bar_with_slivers_is_understood(void **state)
{
  (void)state;
  must("$V generate block --cells 24,8,8 --size 48,16,16 --tets 6 --slivers 40 -o bar.vtu");
  must("$V info bar.vtu");
  assert_holds(line_of("  angles"), " 0.3 to ");
  must("$V check " SCENES "slivers.yaml --set mesh.file=$PWD/bar.vtu --set 'time.selective_mass_scaling=0.05 ms'");
  assert_holds(line_of("inertia"), ": 1 pass over ");
  assert_int_equal(shell("$V generate block --cells 24,8,8 --slivers 73 -o bar.vtu"), 2);
  assert_holds(complained, "block: 73 slivers, there are places for 72");
}

// Ten cubes of five quadratic tets: 4.1695 mm, within 2 %.
static void the_beam_bends_as_published(void **state)
{
  (void)state;
  must("$V generate block --size 10,1,1 --cells 10,1,1 -o beam.vtu");
  must("$V run " SCENES "land_p1.yaml --set mesh.file=$PWD/beam.vtu -o beam --set "
       "'output.points=[{name: tip, at: [10 mm, 0.5 mm, 1 mm]}]'");
  const double height = 1 + last_signal("beam", "point_tip_uz");
  print_message("the tip is at %.4f mm\n", height);
  assert_close(height, 4.1695, 0.02, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_ventricles_are_understood),
      cmocka_unit_test(the_heart_in_real_time_is_understood),
      cmocka_unit_test(the_bar_with_slivers_is_understood),
      cmocka_unit_test(the_beam_bends_as_published),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
