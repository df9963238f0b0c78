// SPDX-License-Identifier: GPL-3.0-or-later
// Meshes that are the shape under load, through the program: a body is loaded, its loaded shape is the mesh of another
// scene, and what comes out is the body that it was.
#include "base/vec3.h"
#include "block_scene.h"
#include "mesh/quadratic.h"
#include "mesh/select.h"
#include "mesh/surface.h"
#include "tools/plot/signals.h"

static const char octant[] =
    "mesh:\n"
    "  file: octant.vtu\n"
    "  unit: mm\n"
    "  order: 2\n"
    "  curved:\n"
    "    - {surface: inner, ellipsoid: {centre: [0 mm, 0 mm, 0 mm], radii: [10 mm, 10 mm, 10 mm]}}\n"
    "    - {surface: outer, ellipsoid: {centre: [0 mm, 0 mm, 0 mm], radii: [14 mm, 14 mm, 14 mm]}}\n"
    "surfaces:\n"
    "  - {name: inner, node_array: inner, value: 1}\n"
    "  - {name: outer, node_array: outer, value: 1}\n"
    "node_sets:\n"
    "  - {name: x0, node_array: x0, value: 1}\n"
    "  - {name: y0, node_array: y0, value: 1}\n"
    "  - {name: z0, node_array: z0, value: 1}\n"
    "materials: [{name: rubber, law: neo_hookean, neo_hookean: {shear: 10 kPa}, volume_modulus: 100 kPa}]\n"
    "volume: element\n"
    "supports: [{set: x0, held: [x]}, {set: y0, held: [y]}, {set: z0, held: [z]}]\n"
    "pressures: [{surface: inner, peak: 2 kPa}]\n"
    "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\n"
    "solve: equilibrium\n"
    "time: {end: 1 ms}\n"
    "output: {precision: double}\n";

static vsc_mesh *read_mesh(const char *file)
{
  vsc_mesh *mesh = NULL;
  vsc_error error;
  if (vsc_vtk_read_mesh(in_folder(file), 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static const double *values_of(const vsc_arrays *arrays, const char *name)
{
  const vsc_array *array = vsc_arrays_find(arrays, name);
  if (array == NULL) fail_msg("no array %s", name);
  return array->values;
}

// The mesh of a frame, its nodes where the frame has them.
static vsc_mesh *read_moved(const char *frame)
{
  vsc_mesh *mesh = read_mesh(frame);
  const double *moved = values_of(&mesh->node_data, "displacement");
  for (size_t i = 0; i < 3 * mesh->node_count; i++) mesh->nodes[i] += moved[i];
  return mesh;
}

// The largest distance of a node of a from that of b.
static double distance(const vsc_mesh *a, const vsc_mesh *b)
{
  double most = 0;
  assert_int_equal(a->node_count, b->node_count);
  for (size_t n = 0; n < a->node_count; n++) {
    double way[3];
    vsc_subtract(a->nodes + 3 * n, b->nodes + 3 * n, way);
    most = fmax(most, vsc_norm(way));
  }
  return most;
}

// The largest sine of the angle between axes of two files' elements, which have no sign.
static double turn(const vsc_mesh *a, const char *name_a, const vsc_mesh *b, const char *name_b)
{
  const double *of_a = values_of(&a->element_data, name_a), *of_b = values_of(&b->element_data, name_b);
  double most = 0;
  for (size_t e = 0; e < a->element_count; e++) {
    double across[3];
    vsc_cross(of_a + 3 * e, of_b + 3 * e, across);
    most = fmax(most, vsc_norm(across) / (vsc_norm(of_a + 3 * e) * vsc_norm(of_b + 3 * e)));
  }
  return most;
}

// Writes a frame as a mesh of the shape that it shows, with its axes and the node arrays of the file that was run
// (made quadratic where the frame is).
static void write_loaded(const char *file, const char *frame, const char *loaded)
{
  vsc_mesh *shape = read_moved(frame), *mesh = read_mesh(file);
  vsc_error error;
  if (vsc_mesh_is_quadratic(shape) && vsc_mesh_raise(&mesh, file, &error) != VSC_OK) fail_msg("%s", error.text);
  enum { MOST = 7 };
  vsc_vtk_array arrays[MOST];
  size_t count = 0;
  for (; count < mesh->node_data.count; count++) {
    const vsc_array *item = &mesh->node_data.items[count];
    assert_true(count + 2 < MOST && item->tuples == shape->node_count);
    arrays[count] = (vsc_vtk_array){item->name, 1, item->values, VSC_ON_NODES, false};
  }
  for (int a = 0; a < 2; a++) {
    const char *name = a == 0 ? "fiber" : "sheet";
    arrays[count++] = (vsc_vtk_array){name, 3, values_of(&shape->element_data, name), VSC_ON_ELEMENTS, false};
  }
  if (vsc_vtk_write_mesh(in_folder(loaded), shape, count, arrays, true, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_mesh_free(mesh);
  vsc_mesh_free(shape);
}

static const char moved_block[] =
    "--set solve=equilibrium --set solver.tolerance=1e-10 --set 'time.end=8 ms' --set 'output.frames=5 ms' --set 'output.signals=5 ms' "
    "--set output.precision=double --set 'output.arrays=[displacement, fiber, sheet]' "
    "--set 'supports[0].motion=[1 mm, 0 mm, 0.5 mm]' --set 'supports[0].curve={kind: ramp, duration: 10 ms}'";

static const char loaded_block[] =
    "--set mesh.file=loaded.vtu --set 'mesh.region_array=' --set 'fibers.arrays={fiber: fiber, sheet: sheet}' "
    "--set 'prestress={mesh: loaded, time: 5 ms, tolerance: 1e-6 mm}'";

// Fibres that differ from element to element, active tension, pressure, gravity and a support that has moved: the
// shape at rest is the block to some times the tolerance, its fibres those that the block had.
static void a_block_comes_back(void **state)
{
  (void)state;
  char command[1024];
  snprintf(command, sizeof command, "$V run block.yaml -o rest %s", moved_block);
  must(command);
  write_loaded("block.vtu", "rest/frames/block_00001.vtu", "loaded.vtu");
  snprintf(command, sizeof command, "$V run block.yaml -o back %s %s", moved_block, loaded_block);
  must(command);
  vsc_mesh *block = read_mesh("block.vtu"), *rest = read_mesh("back/reference.vtu"), *loaded = read_mesh("loaded.vtu");
  assert_true(distance(block, loaded) > 1);
  assert_close(distance(block, rest), 0, 0, 5e-6);
  // 5e-6 mm over elements of 2 mm and more
  assert_close(turn(block, "direction", rest, "fiber"), 0, 0, 2e-5);
  assert_true(turn(block, "direction", loaded, "fiber") > 0.05);
  assert_close(strtod(summary("back", "prestress_rest_to_mesh_mm"), NULL), distance(block, loaded), 0, 5e-6);
  vsc_mesh_free(block);
  vsc_mesh_free(rest);
  vsc_mesh_free(loaded);
}

// From there the body goes on as the one that was loaded from rest, and its first frame is the mesh.
static void it_goes_on_from_there(void **state)
{
  (void)state;
  vsc_mesh *first = read_mesh("back/frames/block_00000.vtu"), *start = read_moved("back/frames/block_00000.vtu");
  vsc_mesh *loaded = read_mesh("loaded.vtu"), *last = read_moved("back/frames/block_00001.vtu");
  vsc_mesh *expected = read_moved("rest/frames/block_00002.vtu");
  assert_close(distance(first, loaded), 0, 0, 0);
  assert_close(distance(start, loaded), 0, 0, 1e-6);
  assert_close(turn(first, "fiber", loaded, "fiber"), 0, 0, 2e-6);
  assert_true(distance(start, last) > 0.2);
  assert_close(distance(last, expected), 0, 0, 1e-5);
  vsc_mesh_free(first);
  vsc_mesh_free(start);
  vsc_mesh_free(loaded);
  vsc_mesh_free(last);
  vsc_mesh_free(expected);
  // what was done on the way that both have gone
  static const char *const works[] = {"work_supports", "work_pressure", "work_active"};
  vsc_signals *rest = NULL, *back = NULL;
  if (vsc_signals_read(in_folder("rest/signals.csv"), &rest, NULL) != VSC_OK ||
      vsc_signals_read(in_folder("back/signals.csv"), &back, NULL) != VSC_OK)
    fail_msg("no signals");
  assert_int_equal(rest->rows, 3);
  assert_int_equal(back->rows, 2);
  assert_close(*vsc_signals_find(back, "time"), 0.005, 0, 0);
  for (size_t k = 0; k < sizeof works / sizeof works[0]; k++) {
    const double *whole = vsc_signals_find(rest, works[k]), *part = vsc_signals_find(back, works[k]);
    assert_true(part[0] == 0 && fabs(part[1]) > 1e-5);
    // 1e-6 mm of 1 mm
    assert_close(part[1], whole[2] - whole[1], 1e-5, 0);
  }
  vsc_signals_free(rest);
  vsc_signals_free(back);
}

// The last row of a run's prestress.csv: its first number, and the largest distance, mm.
static double last_distance(const char *run, int *iteration)
{
  static char table[PROGRAM_TEXT];
  char name[64];
  double relaxation, largest = -1;
  snprintf(name, sizeof name, "%s/prestress.csv", run);
  load_text(name, table, sizeof table);
  for (char *line = table; line != NULL && *line != '\0'; line = strchr(line, '\n') ? strchr(line, '\n') + 1 : NULL)
    sscanf(line, "%d,%lf,%lf", iteration, &relaxation, &largest);
  return largest;
}

// Equilibria are as good as the distance that is asked for, whatever the run's own: it falls as with exact ones, and is
// never nothing because the mesh was taken for its own loaded shape.
static void distances_are_true(void **state)
{
  (void)state;
  static const char run[] = "$V run block.yaml -o %s %s --set 'prestress={mesh: loaded, time: 5 ms, tolerance: 1e-8 mm, "
                            "iterations: 40}' --set 'time.end=6 ms' %s";
  char command[512];
  static const char *const methods[][2] = {{"--set solve=equilibrium", "--set solver.tolerance=1e-12"},
                                           {"--set solve=explicit", ""},
                                           {"--set solve=equilibrium", "--set solver.tolerance=1e-5"}};
  double exact = 0;
  int wanted = 0;
  for (int k = 0; k < 3; k++) {
    int iterations = -1;
    snprintf(command, sizeof command, run, "near", methods[k][0], methods[k][1]);
    must(command);
    const double distance = last_distance("near", &iterations);
    if (k == 0) {
      exact = distance;
      wanted = iterations;
    }
    assert_int_equal(iterations, wanted);
    assert_close(distance, exact, 0.1, 0);
  }
}

// Quadratic tets, bent: nodes in the middle of edges belong to the shape.
static void a_curved_octant_comes_back(void **state)
{
  (void)state;
  must("$V generate octant --inner 10 --outer 14 --layers 1 --around 2 -o octant.vtu");
  save_text("octant.yaml", octant);
  must("$V run octant.yaml -o whole --set solver.tolerance=1e-10 "
       "--set 'output.arrays=[displacement, fiber, sheet]'");
  write_loaded("octant.vtu", "whole/frames/octant_00001.vtu", "swollen.vtu");
  must("$V run octant.yaml -o shrunk --set mesh.file=swollen.vtu --set mesh.order=1 --set 'mesh.curved=[]' "
       "--set 'prestress={mesh: loaded, tolerance: 1e-6 mm}' --set solver.tolerance=1e-10");
  vsc_mesh *before = read_mesh("whole/frames/octant_00000.vtu"), *rest = read_mesh("shrunk/reference.vtu");
  vsc_mesh *swollen = read_mesh("swollen.vtu"), *shown = read_moved("shrunk/reference.vtu");
  assert_true(vsc_mesh_is_quadratic(rest));
  assert_true(distance(before, swollen) > 0.5);
  assert_close(distance(before, rest), 0, 0, 5e-6);
  assert_close(distance(shown, swollen), 0, 0, 1e-12);
  vsc_mesh_free(before);
  vsc_mesh_free(rest);
  vsc_mesh_free(swollen);
  vsc_mesh_free(shown);
}

// Under loads that do not change nothing moves, whatever the method, and the mesh's fibres are those of the frames.
static void under_constant_loads_it_stays(void **state)
{
  (void)state;
  static const char *const methods[] = {"explicit", "implicit", "equilibrium",
                                        "equilibrium --set solver.method=relaxation --set solver.tolerance=1e-4 "
                                        "--set 'output.signals=10 ms' --set 'output.frames=10 ms'"};
  vsc_mesh *block = read_mesh("block.vtu");
  for (size_t k = 0; k < sizeof methods / sizeof methods[0]; k++) {
    char command[1024];
    snprintf(command, sizeof command,
             "$V run block.yaml -o still --set prestress.mesh=loaded --set 'pressures[0].curve={kind: constant}' "
             "--set 'materials[0].active.curve={kind: constant}' --set 'output.points=[{name: p, at: [20 mm, 10 mm, "
             "10 mm]}]' --set 'output.precision=double' --set 'time.end=10 ms' --set solve=%s", methods[k]);
    must(command);
    vsc_mesh *frame = read_mesh("still/frames/block_00000.vtu"), *start = read_moved("still/frames/block_00000.vtu");
    // the tolerance, and what it turns elements of 2 mm by
    assert_close(distance(start, block), 0, 0, 0.01);
    assert_close(turn(block, "direction", frame, "fiber"), 0, 0, 0.02);
    assert_true(strtod(summary("still", "prestress_rest_to_mesh_mm"), NULL) > 1);
    vsc_signals *s = NULL;
    if (vsc_signals_read(in_folder("still/signals.csv"), &s, NULL) != VSC_OK) fail_msg("no signals");
    const double *x = vsc_signals_find(s, "point_p_x"), *kinetic = vsc_signals_find(s, "energy_kinetic");
    assert_close(*vsc_signals_find(s, "point_p_ux"), x[0] - 20, 0, 1e-10);
    for (size_t row = 0; row < s->rows; row++) {
      // equilibria to a part of 1e-6 (relaxation 1e-4) of the forces that have moved it by some mm
      assert_close(x[row], x[0], 0, k < 3 ? 2e-5 : 2e-3);
      assert_true(kinetic[row] <= 1e-9 * *vsc_signals_find(s, "energy_axial"));
    }
    vsc_signals_free(s);
    vsc_mesh_free(frame);
    vsc_mesh_free(start);
  }
  vsc_mesh_free(block);
}

static void a_resumed_run_has_the_same_bits(void **state)
{
  (void)state;
  static const char *const runs[] = {"-t 1 -o one", "-t 2 -o cut --stop '3.3 ms'", "-t 3 -o cut --resume"};
  for (int k = 0; k < 3; k++) {
    char command[256];
    snprintf(command, sizeof command, "$V run block.yaml --set 'prestress={mesh: loaded, time: 2 ms}' "
             "--set 'time.end=6 ms' %s", runs[k]);
    must(command);
  }
  assert_string_equal(summary("one", "state_hash"), summary("cut", "state_hash"));
  assert_same_files("one/signals.csv", "cut/signals.csv");
  assert_same_files("one/prestress.csv", "cut/prestress.csv");
  assert_same_files("one/reference.vtu", "cut/reference.vtu");
  assert_same_files("one/block.pvd", "cut/block.pvd");
  must("diff -r one/frames cut/frames");
}

// A resumed run has the shape at rest from its checkpoint, with the last row of its table: there is no search, which would
// not come to an end here. Of another mesh or other loads it is refused.
static void a_resumed_run_does_not_search(void **state)
{
  (void)state;
  static const char *const others[] = {"prestress.tolerance=0.5 mm", "prestress.time=1 ms", "pressures[0].peak=2 kPa",
                                       "mesh.unit=cm"};
  char command[256];
  must("$V run block.yaml -o known --set 'prestress={mesh: loaded, time: 2 ms}' --set 'time.end=6 ms' --stop '3.3 ms'");
  must("cp -r known before");
  for (size_t k = 0; k < sizeof others / sizeof others[0]; k++) {
    snprintf(command, sizeof command, "$V run block.yaml -q -o known --set 'prestress={mesh: loaded, time: 2 ms}' "
             "--set 'time.end=6 ms' --set '%s' --resume", others[k]);
    assert_int_equal(shell(command), 2);
    assert_holds(complained, "known/checkpoint.h5: belongs to another model");
  }
  must("diff -r known before");
  must("$V run block.yaml -q -o known --set 'prestress={mesh: loaded, time: 2 ms, iterations: 1}' --set 'time.end=6 ms' "
       "--resume");
  assert_string_equal(summary("known", "state_hash"), summary("one", "state_hash"));
  assert_string_equal(summary("known", "prestress_iterations"), summary("one", "prestress_iterations"));
  assert_string_equal(summary("known", "prestress_rest_to_mesh_mm"), summary("one", "prestress_rest_to_mesh_mm"));
  assert_same_files("known/prestress.csv", "one/prestress.csv");
  assert_int_equal(shell("$V run block.yaml -q -o anew --set 'prestress={mesh: loaded, time: 2 ms, iterations: 1}' "
                         "--set 'time.end=6 ms'"), 3);
}

// The shipped ventricle on a coarse mesh, given at the end of its filling.
static void a_ventricle_at_end_diastole(void **state)
{
  (void)state;
  static const char scene[] =
      "%s '" VSC_SOURCE_DIR "/data/beat.yaml' --set mesh.file=\"$PWD\"/small.vtu --set prestress.mesh=loaded "
      "--set 'pressures=[{surface: endo, peak: 1 kPa}]' --set 'materials[0].volume_modulus=1 MPa' "
      "--set 'time.end=4 ms' %s";
  char command[1024];
  must("$V generate lv --around 16 --along 7 --layers 2 -o small.vtu");
  snprintf(command, sizeof command, scene, "$V check", "");
  must(command);
  assert_holds(said, "the mesh is the shape under the loads of 0 ms");
  assert_holds(said, "to 0.01 mm in at most 20 iterations");
  snprintf(command, sizeof command, scene, "$V run", "-o filled");
  must(command);
  assert_holds(said, "the shape at rest, in reference.vtu, is up to 2.18 mm from the mesh");
  vsc_mesh *mesh = read_mesh("small.vtu"), *rest = read_mesh("filled/reference.vtu");
  vsc_surface boundary, endo;
  vsc_cavity cavity;
  const vsc_selector inside = {.kind = VSC_SELECT_NODE_ARRAY, .array = "endo", .low = 1, .high = 1};
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_select_surface(mesh, &boundary, &inside, &endo, NULL), VSC_OK);
  assert_int_equal(vsc_cavity_make(&endo, mesh->node_count, &cavity, NULL), VSC_OK);
  const double filled = vsc_cavity_volume(&cavity, mesh->nodes, 3), empty = vsc_cavity_volume(&cavity, rest->nodes, 3);
  vsc_signals *s = NULL;
  if (vsc_signals_read(in_folder("filled/signals.csv"), &s, NULL) != VSC_OK) fail_msg("no signals");
  // 0.01 mm on 120 cm2 of endocardium
  assert_close(1e3 * *vsc_signals_find(s, "cavity_endo"), filled, 0, 120);
  assert_true(empty < 0.9 * filled && empty > 0.7 * filled);
  vsc_signals_free(s);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&boundary);
  vsc_surface_free(&endo);
  vsc_mesh_free(mesh);
  vsc_mesh_free(rest);
}

static void what_is_refused(void **state)
{
  (void)state;
  static const char *const bad[][2] = {
      {"--set 'materials=[{name: edges, law: classical, classical: {stiffness: 1 mN/mm}}]'", "prestress.mesh: loaded; not with law: paper or classical"},
      {"--set 'materials[0].prony=[{modulus: 0.3, time: 5 ms}]'", "not with prony"},
      {"--set 'membranes=[{name: m, surface: skin, thickness: 1 mm, axial: {a: 1 kPa, b: 1 kPa}, angular: 1 kPa}]'",
       "not with membranes"},
      {"--set 'obstacles=[{kind: plane, point: [0 mm, 0 mm, -9 mm], normal: [0, 0, 1]}]'", "not with obstacles"},
      {"--set keep_volume=total", "not with keep_volume; take a large volume_modulus"},
      {"--set solve=equilibrium --set solver.incompressible=1e-3", "not with solver.incompressible"},
      {"--set 'prestress.time=20 ms'", "prestress.time: 20 ms; expected a time from 0 ms on and before time.end"},
      {"--set 'prestress.time=-1 ms'", "prestress.time: -1 ms"},
      {"--set 'prestress.time=1 ms' --set 'time.step=0.03 ms'", "expected a multiple of time.step, 0.03 ms"},
      {"--set 'prestress.tolerance=0 mm'", "prestress.tolerance: 0 mm; expected a length above zero"},
      {"--set prestress.iterations=0", "prestress.iterations: 0; expected one at least"},
      {"--set prestress.mesh=image", "prestress.mesh"}};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char command[512];
    snprintf(command, sizeof command, "$V check block.yaml --set prestress.mesh=loaded %s", bad[b][0]);
    if (shell(command) != 2) fail_msg("%s: %s", bad[b][0], said);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b][1]);
  }
  must("$V check block.yaml --set prestress.mesh=loaded");
  assert_holds(said, "nothing loads the body at 0 ms");
  must("$V check block.yaml --set prestress.mesh=loaded --set 'prestress.time=2 ms'");
  assert_true(strstr(said, "nothing loads the body") == NULL);
}

// What was not found is told with how far it is off, and its table is left; what lies there of another run is not.
static void what_is_not_found_is_told(void **state)
{
  (void)state;
  static char table[PROGRAM_TEXT];
  must("$V run block.yaml -o lost --set 'prestress={mesh: loaded, time: 4 ms}' --set 'time.end=5 ms'");
  assert_true(access(in_folder("lost/reference.vtu"), F_OK) == 0);
  assert_int_equal(shell("$V run block.yaml -o lost --set 'prestress={mesh: loaded, time: 4 ms, iterations: 2, "
                         "tolerance: 1e-5 mm}'"), 3);
  assert_holds(complained, "block.yaml: prestress: the loaded shape stays ");
  assert_holds(complained, "wanted are 1e-05 mm");
  load_text("lost/prestress.csv", table, sizeof table);
  assert_holds(table, "iteration,relaxation [1],largest [mm],mean [mm]\n0,0,");
  assert_int_equal(line_count(table), 4);
  assert_true(access(in_folder("lost/reference.vtu"), F_OK) != 0);
  assert_int_equal(shell("$V run block.yaml -o lost --set 'prestress={mesh: loaded}' --set "
                         "'pressures=[{surface: end, peak: 1 kPa}]' --set 'supports[0].held=[x]'"), 3);
  assert_holds(complained, "does not bear the loads as a rest shape; take smaller loads or stiffer tissue: at 0 ms");
  assert_holds(complained, "free to move along y, z");
  must("$V check block.yaml --set 'prestress={mesh: loaded}' --set 'supports[0].held=[x]'");
  assert_holds(said, "prestress: the body is free to move along y, z");
  must("$V run block.yaml -o lost --set 'time.end=1 ms'");
  assert_true(access(in_folder("lost/prestress.csv"), F_OK) != 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_block_comes_back),          cmocka_unit_test(it_goes_on_from_there),
      cmocka_unit_test(distances_are_true),
      cmocka_unit_test(a_curved_octant_comes_back),  cmocka_unit_test(under_constant_loads_it_stays),
      cmocka_unit_test(a_resumed_run_has_the_same_bits), cmocka_unit_test(a_resumed_run_does_not_search),
      cmocka_unit_test(a_ventricle_at_end_diastole),
      cmocka_unit_test(what_is_refused),             cmocka_unit_test(what_is_not_found_is_told),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
