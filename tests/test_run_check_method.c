// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera check` says about the method: what limits the step, how equilibria are solved; and about selections.
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

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_damping_that_limits_the_step),
      cmocka_unit_test(test_arrays_that_no_selection_finds),
      cmocka_unit_test(test_volumes_kept_by_multipliers),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
