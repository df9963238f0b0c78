// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that end wound round an edge, or with an element inside out at a corner, every frame of them the right way out, are
// told.
#include "close.h"
#include "program.h"

enum { SECTORS = 5 };

// Five tets round the axis between points 1 and 2 of the file; point 0 belongs to none. The points round it have `id` 3 to
// 7, and are moved by supports until the ring lies twice round the axis.
static void save_ring(const char *law)
{
  static char mesh[2048], scene[4096];
  size_t m = (size_t)snprintf(mesh, sizeof mesh, "# vtk DataFile Version 3.0\nring\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                              "POINTS 8 double\n9 9 9 0 0 0 0 0 1\n");
  size_t s = (size_t)snprintf(scene, sizeof scene, "mesh: {file: ring.vtk, unit: mm}\nmaterials: [{name: ring, %s}]\nnode_sets:\n"
                              "  - {name: n2, node_array: id, value: 2}\n", law);
  static char supports[2048];
  size_t u = (size_t)snprintf(supports, sizeof supports, "supports:\n  - {set: n2, held: [x, y]}\n");
  for (int i = 0; i < SECTORS; i++) {
    const double from = 2 * M_PI * i / SECTORS, to = 2 * from;
    m += (size_t)snprintf(mesh + m, sizeof mesh - m, "%.9f %.9f 0.5\n", cos(from), sin(from));
    s += (size_t)snprintf(scene + s, sizeof scene - s, "  - {name: n%d, node_array: id, value: %d}\n", 3 + i, 3 + i);
    u += (size_t)snprintf(supports + u, sizeof supports - u,
                          "  - {set: n%d, held: [x, y, z], motion: [%.6f mm, %.6f mm, 0 mm],\n"
                          "     curve: {kind: ramp, duration: 20 ms}}\n",
                          3 + i, cos(to) - cos(from), sin(to) - sin(from));
  }
  m += (size_t)snprintf(mesh + m, sizeof mesh - m, "CELLS 5 25\n");
  for (int i = 0; i < SECTORS; i++)
    m += (size_t)snprintf(mesh + m, sizeof mesh - m, "4 1 %d %d 2\n", 3 + i, 3 + (i + 1) % SECTORS);
  snprintf(mesh + m, sizeof mesh - m, "CELL_TYPES 5\n10\n10\n10\n10\n10\nPOINT_DATA 8\nSCALARS id double 1\nLOOKUP_TABLE default\n"
           "0 1 2 3 4 5 6 7\n");
  snprintf(scene + s, sizeof scene - s, "%stime: {end: 30 ms}\noutput: {frames: 30 ms, signals: 1 ms}\n", supports);
  save_text("ring.vtk", mesh);
  save_text("ring.yaml", scene);
}

static const char told[] =
    "the body ends wound: round 1 edge its elements lie more than once, the first is that between nodes 1 and 2 at (0, 0, 0.5) "
    "mm; take a smaller load, a larger volume_modulus, or a finer mesh there";

static void a_body_that_ends_wound_is_told(void **state)
{
  (void)state;
  save_ring("axial: {f: 20 kPa, s: 20 kPa, n: 20 kPa}, angular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa}, "
            "damping: {f: 5 Pa s, s: 5 Pa s, n: 5 Pa s}, volume_modulus: 60 kPa, stabilization: 10 kPa");
  must("$V run ring.yaml -o twice");
  assert_string_equal(summary("twice", "outcome"), "finished");
  assert_string_equal(summary("twice", "inverted_elements"), "0");
  assert_true(last_signal("twice", "J_min") > 0.5 && last_signal("twice", "J_max") < 1.5);
  assert_string_equal(summary("twice", "wound_edges"), "1");
  assert_holds(summary("twice", "warning"), told);
  assert_holds(complained, told);
}

// That is the state at its end, also of a run that goes on.
static void only_the_end_counts(void **state)
{
  (void)state;
  char hash[32];
  snprintf(hash, sizeof hash, "%s", summary("twice", "state_hash"));
  must("$V run ring.yaml -o stopped --stop '5 ms'");
  assert_string_equal(summary("stopped", "wound_edges"), "0");
  assert_null(strstr(complained, "wound"));
  must("$V run ring.yaml -o stopped --resume");
  assert_string_equal(summary("stopped", "wound_edges"), "1");
  assert_string_equal(summary("stopped", "state_hash"), hash);
}

// Springs on edges, which have no elements of their own.
static void so_are_classical_springs(void **state)
{
  (void)state;
  save_ring("law: classical, classical: {stiffness: 20 N/m, damping: 0.01 N s/m}");
  must("$V run ring.yaml -q -o edges");
  assert_string_equal(summary("edges", "wound_edges"), "1");
  assert_holds(summary("edges", "warning"), told);
}

// A brick whose corner is pushed in, beyond the plane of the three corners beside it.
static void a_corner_that_ends_inside_out_is_told(void **state)
{
  (void)state;
  save_text("brick.vtk", "# vtk DataFile Version 3.0\nbrick\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n"
            "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n12\n"
            "POINT_DATA 8\nSCALARS id double 1\nLOOKUP_TABLE default\n1 0 0 0 0 0 2 0\n");
  save_text("brick.yaml", "mesh: {file: brick.vtk, unit: mm}\n"
            "node_sets: [{name: rest, node_array: id, value: 0}, {name: low, node_array: id, value: 1}, "
            "{name: corner, node_array: id, value: 2}]\n"
            "materials: [{name: brick, axial: {f: 20 kPa, s: 20 kPa, n: 20 kPa}, angular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa}, "
            "damping: {f: 5 Pa s, s: 5 Pa s, n: 5 Pa s}, volume_modulus: 60 kPa, stabilization: 10 kPa}]\n"
            "supports:\n  - {set: rest, held: [x, y, z]}\n  - {set: low, held: [x, y]}\n"
            "  - {set: corner, held: [x, y, z], motion: [-0.4 mm, -0.4 mm, -0.4 mm], curve: {kind: ramp, duration: 20 ms}}\n"
            "time: {end: 30 ms}\noutput: {frames: 30 ms, signals: 1 ms}\n");
  must("$V run brick.yaml -o corner");
  assert_string_equal(summary("corner", "inverted_elements"), "0");
  assert_string_equal(summary("corner", "wound_edges"), "0");
  assert_string_equal(summary("corner", "folded_elements"), "1");
  assert_holds(complained, "1 element is inside out at a corner in the end: the first is element 0, a hexahedron, at (0.5, "
               "0.5, 0.5) mm; take a smaller load, a larger stabilization, or a finer mesh there");
  must("$V run brick.yaml -o nearly --set 'time.end=10 ms'");
  assert_string_equal(summary("nearly", "folded_elements"), "0");
  assert_null(strstr(complained, "inside out"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_body_that_ends_wound_is_told),
      cmocka_unit_test(only_the_end_counts),
      cmocka_unit_test(so_are_classical_springs),
      cmocka_unit_test(a_corner_that_ends_inside_out_is_told),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
