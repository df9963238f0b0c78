// SPDX-License-Identifier: GPL-3.0-or-later
// Columns that are set in motion, through the program: their meshes, their energy, their way back.
#include "program.h"
#include "tools/plot/signals.h"
#include "tools/shapes_column.h"

#define SCENES VSC_SOURCE_DIR "/data/benchmarks/"

static void the_mesh_has_the_velocity(void **state)
{
  (void)state;
  vsc_column_shape shape = vsc_column_default();
  vsc_mesh *mesh = NULL;
  shape.bend = 10;
  shape.twist = 105;
  assert_int_equal(vsc_column_mesh(&shape, &mesh, NULL), VSC_OK);
  const vsc_array *velocity = vsc_arrays_find(&mesh->node_data, "velocity");
  assert_non_null(velocity);
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double *x = mesh->nodes + 3 * n, *v = velocity->values + 3 * n;
    // m and rad/s
    const double up = x[2] / 6000, turn = 105 * sin(M_PI / 2 * up);
    assert_close(v[0], 10 * up - turn * x[1] / 1000, 1e-13, 1e-13);
    assert_close(v[1], turn * x[0] / 1000, 1e-13, 1e-13);
    assert_close(v[2], 0, 0, 0);
  }
  vsc_mesh_free(mesh);
  shape.twist = NAN;
  assert_int_equal(vsc_column_mesh(&shape, &mesh, NULL), VSC_INPUT);
}

// Runs the benchmark's scene; returns the largest |balance_error| over the energy at the start.
static double drift(const char *command)
{
  vsc_signals *signals;
  double worst = 0;
  must(command);
  if (vsc_signals_read(in_folder("column/signals.csv"), &signals, NULL) != VSC_OK) fail_msg("no signals");
  const double *lost = vsc_signals_find(signals, "balance_error"),
               *kinetic = vsc_signals_find(signals, "energy_kinetic");
  for (size_t r = 0; r < signals->rows; r++) worst = fmax(worst, fabs(lost[r]));
  worst /= kinetic[0];
  vsc_signals_free(signals);
  return worst;
}

// It swings to one side and back for 1.2 s in 1.3 thousand steps of the length that the program finds. Steps that change
// their length from one to the next by a tenth, though well below the stable one, end at some ten times the energy.
static void energy_does_not_grow(void **state)
{
  (void)state;
  must("$V generate column --cells 3,3,18 --bend 10 -o bend.vtu");
  const double worst = drift("$V run " SCENES "column.yaml --set mesh.file=$PWD/bend.vtu -o column --threads 1 --set "
                             "time.end='1.2 s' --set output.signals='10 ms'");
  print_message("energy is off by %.2g of it\n", worst);
  assert_true(worst < 1e-4);  // 2.4e-5, the square of the step
  const double sideways = last_signal("column", "point_corner_ux");
  assert_true(sideways < -1000);  // past the middle by more than a metre
}

// When, of the rows behind 0.12 s, a corner is nearest to where it was, s.
static double back_after(void)
{
  vsc_signals *signals;
  double least = INFINITY, when = 0;
  if (vsc_signals_read(in_folder("column/signals.csv"), &signals, NULL) != VSC_OK) fail_msg("no signals");
  const double *time = vsc_signals_find(signals, "time"), *x = vsc_signals_find(signals, "point_corner_ux"),
               *y = vsc_signals_find(signals, "point_corner_uy");
  for (size_t r = 0; r < signals->rows; r++) {
    const double off = hypot(x[r], y[r]);
    if (time[r] < 0.12 || off >= least) continue;
    least = off;
    when = time[r];
  }
  print_message("the corner is off by %.0f mm after %g s\n", least, when);
  assert_true(least < 100);  // it has been at 1400
  vsc_signals_free(signals);
  return when;
}

// Quadratic tets twist by most of a turn and back, after 0.179 s; with two bricks across the width a little later.
static void a_twist_comes_back(void **state)
{
  (void)state;
  must("$V generate column --cells 2,2,12 --twist 105 -o twist.vtu");
  const double worst = drift("$V run " SCENES "column.yaml --set mesh.file=$PWD/twist.vtu -o column --threads 1 --set "
                             "time.end='0.21 s' --set mesh.order=2");
  print_message("energy is off by %.2g of it\n", worst);
  assert_true(worst < 1e-3);
  assert_close(last_signal("column", "inverted_elements"), 0, 0, 0);
  assert_close(back_after(), 0.179, 0.1, 0);  // 0.19
}

// The panel of nu = 0.4999 rises by 6.9614 mm.
static void cooks_membrane_rises_as_published(void **state)
{
  (void)state;
  must("$V generate cook --cells 8,8,1 -o cook.vtu");
  must("$V run " SCENES "cook.yaml --set mesh.file=$PWD/cook.vtu -o column --set mesh.order=2 --set "
       "'materials[0].neo_hookean.shear=80.19367958 kPa' --set 'materials[0].volume_modulus=400941.6667 kPa' "
       "--set 'output.points=[{name: end, at: [48 mm, 52 mm, 0.5 mm]}]'");
  const double rise = last_signal("column", "point_end_uy");
  print_message("the end rises by %.4f mm\n", rise);
  assert_close(rise, 6.9614, 0.02, 0);
}

static void warnings_and_words(void **state)
{
  (void)state;
  must("$V generate column --cells 2,2,12 --bend 10 -o bend.vtu");
  must("$V generate cook --cells 4,4,1 -o cook.vtu");
  must("$V check " SCENES "cook.yaml --set mesh.file=$PWD/cook.vtu");
  assert_holds(said, "dead traction on right up to 6.25 kPa (8 triangles)");
  must("$V check " SCENES "column.yaml --set mesh.file=$PWD/bend.vtu");
  assert_holds(said, "velocity   at the start: up to 10 m/s, momentum (3.3e+10, 0, 0) mg m/s");
  must("$V check " SCENES "column.yaml --set mesh.file=$PWD/bend.vtu --set 'node_sets[0].node_array=z1'");
  assert_holds(said, "supports hold 9 of the nodes that it moves");
  assert_int_equal(shell("$V check " SCENES "column.yaml --set mesh.file=$PWD/bend.vtu --set solve=equilibrium"), 2);
  assert_holds(complained, "an equilibrium has no velocity");
  assert_int_equal(shell("$V check " SCENES "column.yaml --set mesh.file=$PWD/bend.vtu --set "
                         "initial_velocity.node_array=speed"), 2);
  assert_holds(complained, "initial_velocity.node_array: the mesh has no node array 'speed'");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_mesh_has_the_velocity),
      cmocka_unit_test(energy_does_not_grow),
      cmocka_unit_test(a_twist_comes_back),
      cmocka_unit_test(cooks_membrane_rises_as_published),
      cmocka_unit_test(warnings_and_words),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
