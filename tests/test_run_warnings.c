// SPDX-License-Identifier: GPL-3.0-or-later
// Warnings about curves, and about elements that lock or are too few through a wall.
#include "block_scene.h"
#include "box_mesh.h"
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

#define BAR "--set mesh.file=bar.vtu --set 'fibers={source: constant, constant: {fiber: [1, 0, 0]}}' "

// A stabilization from ten times the shear modulus at rest on, twenty times where laws stiffen; any kind of element.
static void stabilization_that_locks(void **state)
{
  (void)state;
  assert_warns("--set 'materials[0].stabilization=110 kPa'",
               "material muscle: stabilization is 11 times the shear modulus at rest (10 kPa), so elements of every kind lock");
  must("$V generate block --cells 8,4,4 --size 16,8,8 --element hex -o bar.vtu");
  assert_warns(BAR "--set 'materials[0].stabilization=110 kPa'", "leave it out, or take about the shear modulus of the stretched");
  must("$V generate block --cells 4,2,2 --size 16,8,8 -o bar.vtu");
  assert_warns(BAR "--set mesh.order=2 --set 'materials[0].stabilization=110 kPa'", "stabilization is 11 times");
  if (warnings_of("--set 'materials[0].stabilization=90 kPa'", "none") != 0) fail_msg("%s", said);
  save_text("stiffens.yaml",
            "mesh: {file: block.vtu, unit: mm}\n"
            "node_sets: [{name: left, node_array: x0, value: 1}]\n"
            "fibers: {source: constant, constant: {fiber: [1, 0, 0]}}\n"
            "materials: [{name: muscle, law: guccione, guccione: {C: 2 kPa, bf: 8, bt: 2, bfs: 4}, volume_modulus: 1 MPa,\n"
            "  stabilization: 90 kPa, viscosity: 1 Pa s, active: {kind: tension, tension: 10 kPa}}]\n"
            "supports: [{set: left, held: [x, y, z]}]\n"
            "time: {end: 10 ms}\n");
  must("$V check stiffens.yaml -t 1");
  assert_holds(line_of("warnings"), "none");
  must("$V check stiffens.yaml -t 1 --set 'materials[0].stabilization=110 kPa'");
  assert_holds(line_of("warning"), "material muscle: stabilization is ");
}

#define THIN "where at most two layers lie through it: they bend too little (a beam of two layers by "

// Linear tets in slender bodies of one or two layers; not of three, not in stout bodies, not other elements.
static void tets_that_bend_too_little(void **state)
{
  (void)state;
  must("$V generate block --cells 16,2,2 --size 32,4,4 -o bar.vtu");
  assert_warns(BAR, "100 % of its elements are linear tets with node-averaged volume " THIN "24 %, of four by 9 %); where it");
  assert_warns(BAR "--set tets=smoothed", "smoothed tets " THIN "11 %, of four by 4 %)");
  assert_warns(BAR "--set volume=element --set 'materials[0].volume_modulus=100 kPa' --set 'materials[0].stabilization=0 kPa'",
               "linear tets " THIN "26 %, of four by 12 %)");
  if (warnings_of(BAR "--set mesh.order=2", "none") != 0) fail_msg("%s", said);
  static const char *const fine[] = {"--cells 24,3,3 --size 32,4,4", "--cells 2,2,2 --size 10,10,10",
                                     "--cells 16,2,2 --size 32,4,4 --element hex"};
  for (size_t k = 0; k < sizeof fine / sizeof fine[0]; k++) {
    char command[256];
    snprintf(command, sizeof command, "$V generate block %s -o bar.vtu", fine[k]);
    must(command);
    if (warnings_of(BAR, "none") != 0) fail_msg("%s: %s", fine[k], said);
  }
}

// A block of 6 x 6 x 6 cubes of 2 mm, continued by a wall of 14 x 6, one thick.
static int has_cube(int i, int j, int k)
{
  (void)j;
  return i < 6 || k == 0;
}

// A part of the body that has one layer is enough where fibres turn; the message names an element amid it.
static void one_layer_beside_many(void **state)
{
  (void)state;
  static const int cells[3] = {20, 6, 6};
  vsc_mesh *mesh = box_mesh(cells, 2, has_cube);
  assert_int_equal(vsc_vtk_write_mesh(in_folder("wall.vtu"), mesh, 0, NULL, true, NULL), VSC_OK);
  vsc_mesh_free(mesh);
  save_text("wall.yaml",
            "mesh: {file: wall.vtu, unit: mm}\n"
            "node_sets: [{name: left, plane: {point: [0 mm, 0 mm, 0 mm], normal: [1, 0, 0], tolerance: 0.1 mm}}]\n"
            "fibers: {source: helicoidal}\n"
            "materials: [{name: muscle, law: neo_hookean, neo_hookean: {shear: 5 kPa}, volume_modulus: 500 kPa,\n"
            "  viscosity: 1 Pa s, active: {kind: tension, tension: 10 kPa}}]\n"
            "supports: [{set: left, held: [x, y, z]}]\n"
            "time: {end: 10 ms}\n");
  must("$V check wall.yaml -t 1");
  assert_holds(line_of("warning"), "mesh: 27 % of the elements, as ");
  assert_holds(line_of("warning"), "mm, have no node inside beside them, so the wall has fewer than two layers there");
  double x = 0, z = 0;
  assert_int_equal(sscanf(strchr(line_of("warning"), '('), "(%lf, %*f, %lf) mm", &x, &z), 2);
  assert_true(x > 12 && z < 2);
  must("$V check wall.yaml -t 1 --set 'fibers={source: constant, constant: {fiber: [1, 0, 0]}}'");
  assert_holds(line_of("warnings"), "none");
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(curves_that_jump), cmocka_unit_test(stabilization_that_locks),
                                     cmocka_unit_test(tets_that_bend_too_little), cmocka_unit_test(one_layer_beside_many)};
  return cmocka_run_group_tests(tests, block_open, program_close);
}
