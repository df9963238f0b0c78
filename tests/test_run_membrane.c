// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets through the program: generated, checked, run, resumed and read again; a capsule on a
// block.
#include "program.h"

static const char strip[] =
    "mesh: {file: strip.vtu, unit: mm}\n"
    "node_sets: [{name: end, node_array: x0, value: 1}]\n"
    "membranes:\n"
    "  - {name: cloth, surface: triangles, thickness: 0.1 mm, density: 1 g/cm3, axial: {a: 1 MPa, "
    "b: 1 MPa},\n"
    "     angular: 0.5 MPa, damping: {a: 10 Pa s, b: 10 Pa s}, bending: 0.1 mN mm}\n"
    "supports: [{set: end, held: [x, y, z]}]\n"
    "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\n"
    "time: {end: 40 ms}\n"
    "output: {frames: 20 ms, signals: 2 ms}\n";

static void a_strip_falls(void **state)
{
  (void)state;
  must("$V generate sheet --cells 20,4 --size 20,4 -o strip.vtu");
  assert_holds(said, "105 nodes, 160 triangles, 80 mm2");
  save_text("strip.yaml", strip);
  must("$V check strip.yaml");
  assert_holds(said, "membrane   cloth: 160 triangles, 0.8 cm2, 0.1 mm thick, 0.008 g");
  assert_holds(said, "a triangle of cloth");
  assert_holds(said, "warnings   none");
  must("$V run strip.yaml -o out");
  must("$V info out/frames/strip_00002.vtu");
  assert_holds(said, "160 triangles");
  assert_holds(said, "displacement");
  const double fallen = -last_signal("out", "energy_gravity");
  assert_true(fallen > 0);
  assert_true(last_signal("out", "energy_membrane") > 0 &&
              last_signal("out", "energy_bending") > 0);
  // all that it fell for is elsewhere
  assert_close(last_signal("out", "balance_error") / fallen, 0, 0, 2e-3);
  assert_true(last_signal("out", "J_min") == 1);
}

static void a_sheet_is_resumed_bit_for_bit(void **state)
{
  (void)state;
  must("$V run strip.yaml -o part --stop 20ms");
  must("$V run strip.yaml -o part --resume");
  assert_same_files("part/signals.csv", "out/signals.csv");
  assert_same_files("part/frames/strip_00002.vtu", "out/frames/strip_00002.vtu");
}

// Implicitly, with other threads and cut in two: the same bits; and where it comes to rest when it is clamped.
static void a_sheet_is_solved_for(void **state)
{
  (void)state;
  must("$V run strip.yaml -q -t 1 -o calm --set solve=implicit");
  must("$V run strip.yaml -q -t 2 -o cut --set solve=implicit --stop '17 ms'");
  must("$V run strip.yaml -q -t 1 -o cut --set solve=implicit --resume");
  assert_same_files("cut/signals.csv", "calm/signals.csv");
  // steps from their error, of 1e-4 of the size a step
  assert_close(last_signal("calm", "energy_gravity"), last_signal("out", "energy_gravity"), 5e-3, 0);
  must("$V run strip.yaml -q -o still --set solve=equilibrium --set 'node_sets=[{name: end, box: {low: [-1 mm, -1 mm, "
       "-1 mm], high: [1.01 mm, 9 mm, 1 mm]}}]'");
  assert_true(last_signal("still", "energy_bending") > 10 * last_signal("still", "energy_membrane"));
  assert_true(last_signal("still", "energy_gravity") < 0);
}

// A block pulled by its weight stretches less in a stiff capsule.
static void a_capsule_holds_a_block(void **state)
{
  (void)state;
  must("$V generate block --cells 4,2,2 --size 20,10,10 -o block.vtu");
  save_text(
      "block.yaml",
      "mesh: {file: block.vtu, unit: mm, region_array: region}\n"
      "node_sets: [{name: end, node_array: x0, value: 1}]\n"
      "materials:\n"
      "  - {name: soft, axial: {f: 2 kPa, s: 2 kPa, n: 2 kPa}, angular: {fs: 1 kPa, sn: 1 kPa, nf: "
      "1 kPa},\n"
      "     damping: {f: 20 Pa s, s: 20 Pa s, n: 20 Pa s}, volume_modulus: 50 kPa, stabilization: "
      "1 kPa}\n"
      "membranes:\n"
      "  - {name: capsule, surface: boundary, thickness: 0.1 mm, axial: {a: 500 kPa, b: 500 kPa},\n"
      "     angular: 250 kPa, bending: 0.1 mN mm, damping: {a: 10 Pa s, b: 10 Pa s}}\n"
      "supports: [{set: end, held: [x, y, z]}]\n"
      "gravity: [9.81 m/s2, 0 m/s2, 0 m/s2]\n"
      "time: {end: 150 ms}\n");
  must("$V check block.yaml");
  assert_holds(said, "membrane   capsule: 80 triangles, 10 cm2");
  must("$V run block.yaml -o tight");
  must(
      "$V run block.yaml -o loose --set 'membranes[0].axial.a=1 Pa' --set 'membranes[0].axial.b=1 "
      "Pa' "
      "--set 'membranes[0].angular=1 Pa' --set 'membranes[0].bending=0 mN mm'");
  const double tight = last_signal("tight", "energy_gravity"),
               loose = last_signal("loose", "energy_gravity");
  assert_true(loose < 0 && tight < 0 && tight > 0.6 * loose);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_strip_falls),
      cmocka_unit_test(a_sheet_is_resumed_bit_for_bit),
      cmocka_unit_test(a_sheet_is_solved_for),
      cmocka_unit_test(a_capsule_holds_a_block),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
