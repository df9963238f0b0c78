// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic tetrahedra through the program: a ventricle checked, run, resumed, brought to equilibrium.
#include "program.h"

#include "io/vtk.h"
#include "mesh/select.h"

static const char ventricle[] =
    "mesh:\n"
    "  file: lv.vtu\n"
    "  unit: mm\n"
    "  order: 2\n"
    "  curved:\n"
    "    - {surface: endo, ellipsoid: {centre: [0 mm, 0 mm, 0 mm], radii: [7 mm, 7 mm, 17 mm]}}\n"
    "    - {surface: epi, ellipsoid: {centre: [0 mm, 0 mm, 0 mm], radii: [10 mm, 10 mm, 20 mm]}}\n"
    "surfaces:\n"
    "  - {name: endo, node_array: endo, value: 1}\n"
    "  - {name: epi, node_array: epi, value: 1}\n"
    "  - {name: base, node_array: base, value: 1}\n"
    "node_sets: [{name: base, surface: base}]\n"
    "fibers: {source: helix, helix: {endo: endo, epi: epi}}\n"
    "materials:\n"
    "  - {name: muscle, density: 1.06 g/cm3, axial: {f: 30 kPa, s: 20 kPa, n: 20 kPa},\n"
    "     angular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa}, damping: {f: 1 Pa s, s: 1 Pa s, n: 1 Pa s},\n"
    "     volume_modulus: 300 kPa}\n"
    "supports: [{set: base, held: [x, y, z]}]\n"
    "pressures: [{surface: endo, peak: 2 kPa, curve: {kind: ramp, duration: 5 ms}}]\n"
    "time: {end: 10 ms}\n"
    "output: {frames: 5 ms, cavities: [endo], precision: double}\n";

// Lengths and volumes of Land et al. 2015, whose cavity holds 2.492 ml and whose wall 3.235.
static void a_ventricle_is_checked(void **state)
{
  (void)state;
  must("$V generate lv --endo-radius 7 --endo-length 17 --epi-radius 10 --epi-length 20 --base 5 "
       "--around 12 --along 5 --layers 1 -o lv.vtu");
  assert_holds(said, "152 nodes, 345 elements");
  save_text("lv.yaml", ventricle);
  must("$V check lv.yaml");
  assert_holds(said, "798 nodes, 345 quadratic tetrahedra");
  assert_holds(said, "tissue 3.23");
  assert_holds(said, "endo: 138 triangles");
  assert_holds(said, "a cavity of 2.49");
  assert_holds(said, "base (72 nodes) held in x y z");
  assert_holds(said, "fibres     helix: 345 of 345 elements");
  assert_holds(said, "fewer than two layers");
  must("$V check lv.yaml --set mesh.order=1 --set 'mesh.curved=[]'");
  assert_holds(said, "152 nodes, 345 tetrahedra");
  assert_holds(said, "a cavity of 2.33");
}

// The frames show quadratic elements, whose last one has the cavity of the signals.
static void it_is_run(void **state)
{
  (void)state;
  must("$V run lv.yaml -o out");
  must("$V info out/frames/lv_00002.vtu");
  assert_holds(said, "345: 345 quadratic tetrahedra");
  assert_holds(said, "points                 798");
  vsc_mesh *mesh;
  vsc_error error;
  vsc_surface boundary;
  if (vsc_vtk_read_mesh(in_folder("out/frames/lv_00002.vtu"), 1, &mesh, &error) != VSC_OK)
    fail_msg("%s", error.text);
  const vsc_array *moved = vsc_arrays_find(&mesh->node_data, "displacement");
  assert_non_null(moved);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  // the corners of one side of the base stay with their middles, the apex has moved
  double most = 0;
  for (size_t k = 0; k < 3 * boundary.count; k++) {
    const uint32_t middle = boundary.mid[k];
    const double length = sqrt(moved->values[3 * middle] * moved->values[3 * middle] +
                               moved->values[3 * middle + 1] * moved->values[3 * middle + 1] +
                               moved->values[3 * middle + 2] * moved->values[3 * middle + 2]);
    if (fabs(mesh->nodes[3 * middle + 2] - 5) < 1e-9) assert_close(length, 0, 0, 0);
    most = fmax(most, length);
  }
  assert_true(most > 0.1 && most < 5);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
  // what the pressure has done is in the springs, the motion and the heat (trapezoids of 1 ms)
  assert_close(last_signal("out", "balance_error"), 0, 0, 0.02 * last_signal("out", "work_pressure"));
  must("$V compare out/frames/lv_00002.vtu out/frames/lv_00002.vtu");
}

static void it_is_resumed_bit_for_bit(void **state)
{
  (void)state;
  must("$V run lv.yaml -o part --stop 5ms");
  must("$V run lv.yaml -o part --resume");
  assert_same_files("part/signals.csv", "out/signals.csv");
  assert_same_files("part/frames/lv_00002.vtu", "out/frames/lv_00002.vtu");
}

// Motion that comes to rest and equilibrium agree where the cavity is.
static void it_comes_to_equilibrium(void **state)
{
  (void)state;
  must("$V run lv.yaml --set solve=equilibrium -o balance");
  must("$V run lv.yaml --set time.end='60 ms' --set output.frames='60 ms' "
       "--set 'materials[0].damping={f: 30 Pa s, s: 30 Pa s, n: 30 Pa s}' -o rest");
  const double still = last_signal("balance", "cavity_endo");
  assert_true(still > 2.6);
  assert_close(last_signal("rest", "cavity_endo"), still, 2e-3, 0);
}

static void wrong_wishes_are_named(void **state)
{
  (void)state;
  assert_int_equal(shell("$V check lv.yaml --set mesh.order=3"), 2);
  assert_holds(complained, "mesh.order: 3; expected 1");
  assert_int_equal(shell("$V check lv.yaml --set mesh.order=1"), 2);
  assert_holds(complained, "use mesh.order: 2");
  assert_int_equal(shell("$V check lv.yaml --set 'mesh.curved[0].surface=endos'"), 2);
  assert_holds(complained, "no surface is named \"endos\"");
  assert_int_equal(
      shell("$V check lv.yaml --set 'mesh.curved[0].ellipsoid.radii=[7 mm, 7 mm, 12 mm]'"), 2);
  assert_holds(complained, "off the ellipsoid");
  assert_int_equal(
      shell("$V check lv.yaml --set 'mesh.curved[0].ellipsoid.radii=[7 mm, 0 mm, 12 mm]'"), 2);
  assert_holds(complained, "expected lengths above zero");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_ventricle_is_checked),   cmocka_unit_test(it_is_run),
      cmocka_unit_test(it_is_resumed_bit_for_bit), cmocka_unit_test(it_comes_to_equilibrium),
      cmocka_unit_test(wrong_wishes_are_named),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
