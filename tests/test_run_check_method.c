// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera check` says about the method: what limits the step, how equilibria are solved; and about selections.
#include <math.h>

#include "block_scene.h"
#include "trap.h"

// The block with regions 1 and 2, which is where x > 10.
static void write_halves(const char *file)
{
  vsc_mesh *mesh = block_for_scene();
  double region[1000];
  assert_true(mesh->element_count <= 1000);
  for (size_t e = 0; e < mesh->element_count; e++) {
    double centre[3];
    vsc_mesh_element_centre(mesh, e, centre);
    region[e] = centre[0] > 10 ? 2 : 1;
  }
  const vsc_vtk_array array = {"region", 1, region, VSC_ON_ELEMENTS, true};
  if (vsc_vtk_write_mesh(in_folder(file), mesh, 1, &array, true, NULL) != VSC_OK) fail_msg("%s", file);
  vsc_mesh_free(mesh);
}

// A stiff half and a viscous one: what limits the step lies in the latter, and without its viscosity in the former.
static void test_damping_that_limits_the_step(void **state)
{
  (void)state;
  double node, element;
  static const char mode[] = "; limited most by damping, at node ", part[] = "; by stiffness alone by element ";
  write_halves("halves.vtu");
  save_text("halves.yaml",
            "mesh: {file: halves.vtu, unit: mm, region_array: region}\n"
            "materials:\n"
            "  - {name: a, regions: [1], axial: {f: 200 kPa, s: 200 kPa, n: 200 kPa}, angular: {fs: 100 kPa, sn: 100 kPa, nf: 100 kPa}, volume_modulus: 500 kPa}\n"
            "  - {name: b, regions: [2], law: guccione, guccione: {C: 2 kPa, bf: 8, bt: 2, bfs: 4}, volume_modulus: 100 kPa,\n"
            "     viscosity: 80 Pa s}\n"
            "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\ntime: {end: 1 ms}\n");
  must("$V check halves.yaml -t 1");
  assert_holds(line_of("terms"), "terms      springs, guccione, viscosity; volume");
  const char *line = line_of("step");
  assert_holds(line, mode);
  assert_holds(line, part);
  assert_int_equal(sscanf(strstr(line, mode) + strlen(mode), "%*u, at rest at (%lf", &node), 1);
  assert_int_equal(sscanf(strstr(line, part) + strlen(part), "%*u at (%lf", &element), 1);
  assert_true(node > 9 && element < 10);
  static const char advice[] = "; time.selective_mass_scaling makes steps of viscous tissue longer";
  assert_holds(line, advice);
  must("$V check halves.yaml -t 1 --set 'time.selective_mass_scaling=0.02 ms'");
  assert_null(strstr(line_of("step"), advice));
  assert_holds(line_of("inertia"), "of neighbours against one another: ");
  // not where that would be refused
  must("$V check halves.yaml -t 1 --set keep_volume=total");
  assert_holds(line_of("step"), mode);
  assert_null(strstr(line_of("step"), advice));
  must("$V check halves.yaml -t 1 --set 'materials[1].viscosity=0 Pa s'");
  assert_holds(line_of("step"), "; limited most by element ");
  assert_null(strstr(line_of("step"), "damping"));
  must("$V check halves.yaml -t 1 --set 'materials[1].viscosity=1e-3 Pa s'");
  assert_holds(line_of("step"), "; limited most at node ");
  assert_holds(line_of("step"), part);
}

// Selections are told by their place in the scene, with the key that is wrong.
static void test_arrays_that_no_selection_finds(void **state)
{
  (void)state;
  assert_int_equal(shell("$V check block.yaml --set 'node_sets[0].node_array=left'"), 2);
  assert_holds(complained, "block.yaml: node_sets[0] left: node_array: the mesh has no node array 'left', known arrays: ");
  assert_int_equal(shell("$V check block.yaml --set 'surfaces[1].node_array=x2'"), 2);
  assert_holds(complained, "block.yaml: surfaces[1] end: node_array: the mesh has no node array 'x2', known arrays: ");
}

static void test_volumes_kept_by_multipliers(void **state)
{
  (void)state;
  must("$V check block.yaml -t 1 --set solve=equilibrium");
  assert_null(strstr(line_of("solve"), "multipliers"));
  must("$V check block.yaml -t 1 --set solve=equilibrium --set volume=nodal --set solver.incompressible=1e-4");
  assert_holds(line_of("solve"), "signal, volumes kept to 0.0001 by multipliers; Newton");
}

static void counts_as_run(const char *options)
{
  char command[400], expected[60];
  snprintf(command, sizeof command, "$V check block.yaml -t 1 --set 'time.end=3 ms' %s", options);
  must(command);
  const char *line = line_of("cost"), *steps = strstr(line, "= about "), *frames = strstr(line, " MB of memory; ");
  assert_true(steps != NULL && frames != NULL);
  const double foretold = strtod(steps + strlen("= about "), NULL);
  snprintf(expected, sizeof expected, "%.0f", strtod(frames + strlen(" MB of memory; "), NULL));
  snprintf(command, sizeof command, "$V run block.yaml -t 1 -o counted --set 'time.end=3 ms' %s", options);
  must(command);
  assert_string_equal(summary("counted", "frames"), expected);
  const double taken = strtod(summary("counted", "steps"), NULL);
  // the step is followed as the tissue stiffens
  if (!(fabs(foretold - taken) <= 0.15 * taken)) fail_msg("%s: %g steps foretold, %g taken", options, foretold, taken);
}

// A step ends where a row, a frame or a checkpoint is due.
static void test_steps_and_frames_foretold(void **state)
{
  (void)state;
  counts_as_run("");
  counts_as_run("--set 'output.signals=0.01 ms'");
  counts_as_run("--set 'output.frames=0.03 ms' --set 'output.signals=0.5 ms'");
  counts_as_run("--set 'output.frames=10 ms'");
  counts_as_run("--set 'output.frames=0.7 ms'");
  counts_as_run("--set 'output.frames=10 ms' --set 'output.checkpoint=0.02 ms'");
  counts_as_run("--set 'time.step=0.02 ms' --set 'output.signals=0.01 ms' --set 'output.frames=10 ms'");
}

// Ellipsoids that are not those of the wall.
static void test_ellipsoids_beside_the_wall(void **state)
{
  (void)state;
  static const char warning[] = " of the wall's surface lies off both ellipsoids by more than a tenth of the wall";
  must("$V generate lv --endo-radius 26 --endo-length 66 --epi-radius 35.5 --epi-length 73 --base 10 --around 8 "
       "--along 4 --layers 4 -o wall.vtu");
  save_text("wall.yaml",
            "mesh: {file: wall.vtu, unit: mm}\n"
            "surfaces: [{name: inside, node_array: endo, value: 1}, {name: outside, node_array: epi, value: 1}]\n"
            "node_sets: [{name: base, node_array: base, value: 1}]\nfibers:\n  source: ellipsoid\n"
            "  ellipsoid: {endo_radius: 26 mm, endo_length: 66 mm, epi_radius: 35.5 mm, epi_length: 73 mm}\n"
            "materials: [{name: m, axial: {f: 10 kPa, s: 10 kPa, n: 10 kPa}, angular: {fs: 5 kPa, sn: 5 kPa, nf: 5 kPa}, volume_modulus: 100 kPa}]\n"
            "supports: [{set: base, held: [x, y, z]}]\ntime: {end: 1 ms}\n");
  const char *const surfaces[] = {"", "--set fibers.ellipsoid.endo=inside --set fibers.ellipsoid.epi=outside"};
  const char *const wrong[] = {"endo_length=5 mm", "endo_radius=10 mm", "centre=[0 mm, 0 mm, 30 mm]"};
  char command[400];
  for (int k = 0; k < 2; k++) {
    snprintf(command, sizeof command, "$V check wall.yaml -t 1 %s", surfaces[k]);
    must(command);
    assert_null(strstr(said, warning));
    for (int i = 0; i < 3; i++) {
      snprintf(command, sizeof command, "$V check wall.yaml -t 1 %s --set 'fibers.ellipsoid.%s'", surfaces[k], wrong[i]);
      must(command);
      assert_holds(said, warning);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_damping_that_limits_the_step),
      cmocka_unit_test(test_arrays_that_no_selection_finds),
      cmocka_unit_test(test_volumes_kept_by_multipliers),
      cmocka_unit_test(test_steps_and_frames_foretold),
      cmocka_unit_test(test_ellipsoids_beside_the_wall),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
