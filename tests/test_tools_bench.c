// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench: its sections and what it refuses, and the blocks whose steps it times.
#include <math.h>

#include "base/vec3.h"
#include "program.h"
#include "tools/bench/specimen.h"

static void sections_are_listed_and_others_refused(void **state)
{
  (void)state;
  must("$V bench --help");
  assert_holds(said, "[bench, in the current folder]");
  static const char *const sections[] = {"throughput", "growth", "skipping", "start", "error", "stability", "accuracy", "paper"};
  for (size_t k = 0; k < sizeof sections / sizeof sections[0]; k++) assert_non_null(strstr(said, sections[k]));
  assert_int_equal(shell("$V bench speed"), 2);
  assert_non_null(strstr(complained, "speed: no section of that name"));
  assert_int_equal(shell("$V bench throughput --elements 3"), 2);
  assert_non_null(strstr(complained, "--elements 3: expected a number from 5"));
  assert_int_equal(shell("$V bench growth --csv no/such/folder.csv"), 2);
  assert_non_null(strstr(complained, "cannot be written"));
  assert_int_equal(shell("$V bench growth -o no/such/folder"), 2);
  assert_holds(complained, "no/such/folder: cannot be made: ");
  assert_int_equal(shell("$V bench growth -o folder --csv table.csv"), 2);
  assert_holds(complained, "--output says already where the table goes");
  assert_int_equal(shell("$V bench skipping more"), 2);
  assert_holds(complained, "'more' means nothing here");
  assert_int_equal(shell("$V bench -o no/such/folder"), 4);
  assert_holds(complained, "--output no/such/folder: cannot be made: ");
  assert_int_equal(shell("$V bench -o folder growth"), 2);
  assert_holds(complained, "viscera bench growth -o DIR");
  must("$V bench error --help");
  assert_int_equal(shell("$V bench error --only speed -o none"), 2);
  assert_non_null(strstr(complained, "--only speed: there are the tables time, space, real_time and slivers"));
  assert_int_equal(shell("test -e none"), 1);
}

// The volume of a mesh of tets and the area of its boundary.
static void measure(const vsc_mesh *mesh, double *volume, double *area)
{
  vsc_surface boundary;
  *volume = *area = 0;
  for (size_t e = 0; e < mesh->element_count; e++) *volume += vsc_mesh_element_volume(mesh, e);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  for (size_t t = 0; t < boundary.count; t++) {
    const uint32_t *node = boundary.triangles + 3 * t;
    double a[3], b[3], n[3];
    vsc_subtract(mesh->nodes + 3 * node[1], mesh->nodes + 3 * node[0], a);
    vsc_subtract(mesh->nodes + 3 * node[2], mesh->nodes + 3 * node[0], b);
    vsc_cross(a, b, n);
    *area += vsc_norm(n) / 2;
  }
  vsc_surface_free(&boundary);
}

// Every kind has about as many elements as it is asked for, in a cube of 1 mm edges; a step of each costs
// something and its model takes memory.
static void specimens_are_what_they_say(void **state)
{
  (void)state;
  static const vsc_specimen specimens[] = {
      {.name = "tets"},
      {.name = "cloud", .kind = VSC_SPECIMEN_CLOUD, .damping = true, .nodal = true},
      {.name = "quadratic", .kind = VSC_SPECIMEN_QUADRATIC, .law = VSC_LAW_GUCCIONE},
      {.name = "hexes", .kind = VSC_SPECIMEN_HEXES, .active = VSC_ACTIVE_TENSION},
      {.name = "smoothed", .law = VSC_LAW_HOLZAPFEL_OGDEN, .nodal = true, .smoothed = true},
  };
  for (size_t k = 0; k < sizeof specimens / sizeof specimens[0]; k++) {
    vsc_mesh *mesh;
    vsc_error error;
    vsc_specimen_cost cost;
    double read, volume, area;
    if (vsc_specimen_mesh(specimens[k].kind, 60, &mesh, &read, &error) != VSC_OK) fail_msg("%s", error.text);
    assert_true(mesh->element_count >= 50 && mesh->element_count <= 160);
    assert_true(isnan(read) == (specimens[k].kind != VSC_SPECIMEN_CLOUD));
    measure(mesh, &volume, &area);
    assert_close(volume, pow(round(cbrt(volume)), 3), 1e-12, 0);
    if (vsc_specimen_time(&specimens[k], mesh, false, &cost, &error) != VSC_OK) fail_msg("%s", error.text);
    assert_true(cost.elements == mesh->element_count && cost.nodes == mesh->node_count);
    assert_true(cost.one > 0 && cost.one < INFINITY);
    assert_true(cost.traffic > 88.0 * (double)cost.elements);
#ifndef __SANITIZE_ADDRESS__  // whose allocator does not say what it has given out
    assert_true(cost.bytes > 100.0 * (double)cost.elements);
#endif
    vsc_mesh_free(mesh);
  }
}

// A large cloud is a small one mirrored again and again: without gaps, so that its boundary is the cube's alone, its tets
// in no order, no two of its corners alike.
static void a_mirrored_cloud_is_one_block(void **state)
{
  (void)state;
  vsc_mesh *mesh;
  vsc_error error;
  double read, volume, area;
  if (vsc_specimen_mesh(VSC_SPECIMEN_CLOUD, 14000, &mesh, &read, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_close((double)mesh->element_count, 14000, 0.05, 0);
  assert_true(read > 0);
  measure(mesh, &volume, &area);
  const double side = round(cbrt(volume));
  assert_close(volume, side * side * side, 1e-12, 0);
  assert_close(area, 6 * side * side, 1e-12, 0);
  double apart = 0;
  for (size_t t = 1; t < mesh->element_count; t++)
    apart += fabs(mesh->nodes[3 * mesh->corners[4 * t]] - mesh->nodes[3 * mesh->corners[4 * t - 4]]);
  assert_true(apart / (double)mesh->element_count > 0.25 * side);  // a third of it by chance
  vsc_mesh_free(mesh);
}

// Tables and pictures of sections that time steps, of blocks so small that they are done at once.
static void sections_leave_tables_and_pictures(void **state)
{
  (void)state;
  static const struct {
    const char *name;
    int lines;
  } all[] = {{"throughput", 14}, {"growth", 2}, {"skipping", 28}};
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    char command[128], file[64], text[256];
    static char table[PROGRAM_TEXT];
    // of growth the smallest block
    snprintf(command, sizeof command, "$V bench %s -n %d -o left", all[k].name, k == 1 ? 1000 : 5);
    must(command);
    snprintf(text, sizeof text, "written: left/%s.csv, left/%s.png\n", all[k].name, all[k].name);
    assert_holds(said, text);
    assert_holds(said, " kernels, double precision; ");
    snprintf(file, sizeof file, "left/%s.csv", all[k].name);
    load_text(file, table, sizeof table);
    assert_int_equal(line_count(table), all[k].lines);
    snprintf(file, sizeof file, "left/%s.png", all[k].name);
    assert_true(load_text(file, table, sizeof table) > 1000);
  }
  // every row has its share of the roofline
  static char table[PROGRAM_TEXT];
  load_text("left/throughput.csv", table, sizeof table);
  assert_null(strstr(table, ",nan\n"));
  assert_null(strstr(table, ",0\n"));
  must("$V bench growth -n 1000 --csv alone.csv");
  assert_null(strstr(said, "written"));
  assert_int_equal(shell("ls alone.csv && ls alone.png"), 2);
}

static void pictures_of_tables(void **state)
{
  (void)state;
  static char first[PROGRAM_TEXT], second[PROGRAM_TEXT];
  static const char head[] = "table,series,what,elements,processor seconds a simulated second,percent of the stroke\n"
                             "time,\"explicit\",\"a reference\",100,3,nan\ntime,\"explicit\",\"safety, 0.8\",100,3,1e-4\n";
  char table[1024];
  snprintf(table, sizeof table, "%sspace,\"tets\",\"tets\",100,2,20\nspace,\"tets\",\"tets\",400,9,5\n", head);
  save_text("error.csv", table);
  must("$V plot --errors error.csv -o error.png");
  const size_t length = load_text("error.png", first, sizeof first);
  assert_true(length > 1000);
  assert_memory_equal(first, "\x89PNG", 4);
  snprintf(table, sizeof table, "%sspace,\"tets\",\"tets\",100,2,20\nspace,\"tets\",\"tets\",400,9,8\n", head);
  save_text("error.csv", table);
  must("$V plot --errors error.csv -o error.png");
  assert_false(load_text("error.png", second, sizeof second) == length && memcmp(first, second, length) == 0);
  save_text("stability.csv", "stress,law,element,method,outcome\nflat,springs,tets,explicit,survives\n"
                             "flat,springs,hexes,implicit,stops\nflat,springs,hexes,coupled,inside out\n");
  // a full disk leaves nothing behind
  assert_int_equal(shell("ulimit -f 1; $V plot --errors error.csv -o full.png >/dev/null"), 4);
  assert_int_equal(shell("ls full.png*"), 2);
  must("$V plot --outcomes stability.csv -o stability.png");
  assert_true(load_text("stability.png", first, sizeof first) > 1000);
  assert_int_equal(shell("$V plot --outcomes error.csv -o no.png"), 2);
  assert_non_null(strstr(complained, "error.csv: expected stress, law, element, method, outcome"));
  assert_int_equal(shell("$V plot --errors stability.csv -o no.png"), 2);
  assert_non_null(strstr(complained, "stability.csv: expected table, series, what"));
  assert_int_equal(shell("$V plot --errors missing.csv -o no.png"), 2);
  assert_int_equal(shell("$V plot --errors error.csv"), 2);
  assert_int_equal(shell("$V plot --bench error.csv -o no.png"), 2);
  assert_holds(complained, "error.csv: expected a table as `viscera bench throughput`");
  save_text("half.csv", "what,ns a tet,over,of\n\"springs\",20\n");
  assert_int_equal(shell("$V plot --bench half.csv -o no.png"), 2);
  assert_int_equal(shell("$V plot --bench missing.csv -o no.png"), 2);
  assert_int_equal(shell("$V plot --bench half.csv"), 2);
  assert_holds(complained, "--bench: give the PNG by -o");
  assert_int_equal(shell("test -e no.png"), 1);
}

// Of a row that bench error has left, of that table: its elements, its error in per cent (NAN: the reference).
static void error_row(const char *table, const char *what, double *elements, double *percent)
{
  static char text[PROGRAM_TEXT];
  char wanted[128];
  double cost;
  load_text("errors/error.csv", text, sizeof text);
  snprintf(wanted, sizeof wanted, "\",\"%s\",", what);  // the series stands before it
  const char *row = strstr(text, wanted);
  if (row == NULL) fail_msg("no %s in '%s'", what, text);
  assert_int_equal(sscanf(row + strlen(wanted), "%lf,%lf,%lf", elements, &cost, percent), 3);
  while (row > text && row[-1] != '\n') row--;
  assert_memory_equal(row, table, strlen(table));
}

static void bench_errors(const char *table, const char *end)
{
  char command[512];
  snprintf(command, sizeof command, "sed 's/end: 300 ms/end: %s/; s/start: 10 ms/start: 0 ms/' "
           "'" VSC_SOURCE_DIR "/data/benchmarks/beating_ventricle.yaml' > short.yaml", end);
  must(command);
  snprintf(command, sizeof command, "$V bench error --quick --only %s --scene short.yaml -o errors", table);
  must(command);
}

// The first moments of a beat: what all are compared with is finer than they are, and every kind of element is there.
static void errors_are_told_against_a_finer_mesh(void **state)
{
  (void)state;
  static const char *const kinds[] = {"quadratic tets, curved, explicit", "quadratic tets, curved, implicit 1e-5",
                                      "quadratic tets, straight, coupled for 0.05 ms", "tets, node-averaged",
                                      "tets, each alone", "tets, smoothed", "hexahedra", "wedges"};
  double elements, finer, fewer, percent;
  bench_errors("space", "1 ms");
  error_row("space", "quadratic tets, curved, coupled for 0.01 ms", &finer, &percent);
  assert_true(isnan(percent));
  error_row("space", "quadratic tets, curved, coupled for 0.05 ms", &elements, &percent);
  assert_true(finer >= 2 * elements && percent > 0);
  for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
    error_row("space", kinds[k], &fewer, &percent);
    assert_true(fewer <= elements && percent > 0 && percent < 100);
  }
}

// Implicit steps have the length that is asked for: their error falls with it.
static void errors_fall_with_the_step(void **state)
{
  (void)state;
  static const char *const shorter[] = {"implicit, steps of 2 ms", "implicit, steps of 1 ms", "implicit, steps of 0.5 ms"};
  double elements, error, last;
  bench_errors("time", "20 ms");
  error_row("time", "explicit, safety 0.1", &elements, &error);
  assert_true(isnan(error));
  error_row("time", "implicit, steps of 4 ms", &elements, &last);
  for (int k = 0; k < 3; k++) {
    error_row("time", shorter[k], &elements, &error);
    assert_true(0 < error && error < 0.4 * last);
    last = error;
  }
}

// The first frame is on the disk before the program has ended, and shares of the time are parts of it.
static void starts_are_timed(void **state)
{
  (void)state;
  double least, median, most, all, parts[5];
  int threads;
  must("$V generate block --cells 2,2,2 -o block.vtu");
  save_text("block.yaml", "mesh: {file: block.vtu, unit: mm}\n"
                          "node_sets: [{name: foot, node_array: z0, value: 1}]\n"
                          "materials: [{name: liver, law: neo_hookean, neo_hookean: {shear: 5 kPa}, volume_modulus: 100 kPa}]\n"
                          "supports: [{set: foot, held: [x, y, z]}]\n"
                          "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\ntime: {end: 1 s}\n");
  must("$V bench start --scene block.yaml --times 3 -t 1 -o out");
  const char *line = strstr(said, "shell to first frame");
  assert_non_null(line);
  assert_int_equal(sscanf(line, "shell to first frame %lf %lf %lf", &least, &median, &most), 3);
  assert_true(0 < least && least <= median && median <= most);
  line = strstr(said, "writing frames\n");
  assert_non_null(line);
  assert_int_equal(sscanf(line, "writing frames\n %d %lf %lf %lf %lf %lf %lf", &threads, &all, &parts[0], &parts[1],
                          &parts[2], &parts[3], &parts[4]), 7);
  assert_int_equal(threads, 1);
  double sum = 0;
  for (int k = 0; k < 5; k++) {
    assert_true(parts[k] >= 0);
    sum += parts[k];
  }
  assert_close(sum, 100, 0, 0.26);  // each to 0.05
  assert_holds(said, "written: out/start.csv, out/start.png\n");
  static char table[PROGRAM_TEXT];
  load_text("out/start.csv", table, sizeof table);
  assert_holds(table, "table,what,seconds,least,most\nto the first frame,\"shell to first frame\",");
  assert_holds(table, "0.1 s on 1 thread,steps,");
  assert_int_equal(shell("$V bench start --times 0"), 2);
  assert_int_equal(shell("$V bench start --scene missing.yaml --times 1 -o none"), 2);
  assert_holds(complained, "missing.yaml: cannot be read; what comes with viscera lies in data/");
  assert_int_equal(shell("test -e none"), 1);
  save_text("bad.yaml", "mesh: {file: nowhere.vtu, unit: mm}\n");
  assert_int_equal(shell("$V bench start --scene bad.yaml --times 1 -o out"), 4);
  assert_non_null(strstr(complained, "log.txt says why"));
}

// The data that come with the program are found from any folder, and missed with one message by a program that lies
// elsewhere.
static void data_are_found_from_anywhere(void **state)
{
  (void)state;
  must("$V bench start --times 1 -t 1 -o anywhere");
  assert_holds(said, "data/beat.yaml, 1 starts");
  must("$V bench accuracy --only beam-0.3-quadratic-1 --no-pictures -o anywhere");
  assert_holds(said, " kernels, double precision; ");
  assert_holds(said, "anywhere/accuracy.csv, ");
  must("cp $V alone");
  static const char *const sections[] = {"start", "accuracy --only beam", "error --quick"};
  for (size_t k = 0; k < sizeof sections / sizeof sections[0]; k++) {
    char command[128];
    snprintf(command, sizeof command, "./alone bench %s -o missed", sections[k]);
    assert_int_equal(shell(command), 2);
    assert_holds(complained, "cannot be read; what comes with viscera lies in data/ of its sources or in share/viscera");
  }
  assert_int_equal(shell("test -e missed"), 1);
}

// Cases from the list: one that the tissue survives, one that stops with a message that names all it should, one that ends
// with elements inside out.
static void stresses_are_judged(void **state)
{
  (void)state;
  static char table[PROGRAM_TEXT], picture[PROGRAM_TEXT];
  must("$V bench stability --list");
  assert_non_null(strstr(said, "flat-springs-nodal-explicit\n"));
  must("$V bench stability --only nothing-springs-tets-implicit -t 1 -o judged");
  load_text("judged/stability.csv", table, sizeof table);
  assert_non_null(strstr(table, "\nnothing,springs,tets,implicit,survives,0,"));
  assert_true(load_text("judged/stability.png", picture, sizeof picture) > 1000);
  must("$V bench stability --only crush-springs-tets-equilibrium -t 1 -o judged");
  load_text("judged/stability.csv", table, sizeof table);
  assert_non_null(strstr(table, "\ncrush,springs,tets,equilibrium,stops,3,"));
  assert_non_null(strstr(table, "turn inside out"));
  must("$V bench stability --only crush-springs-hexes-coupled -t 1 -o judged");
  load_text("judged/stability.csv", table, sizeof table);
  assert_non_null(strstr(table, "\ncrush,springs,hexes,coupled,inside out,0,"));
  assert_non_null(strstr(table, " elements inside out in the end\""));
  assert_int_equal(shell("$V bench stability --only nonsense -o judged"), 2);
  assert_non_null(strstr(complained, "no case holds 'nonsense'; --list names them"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_are_listed_and_others_refused),
      cmocka_unit_test(specimens_are_what_they_say),
      cmocka_unit_test(a_mirrored_cloud_is_one_block),
      cmocka_unit_test(sections_leave_tables_and_pictures),
      cmocka_unit_test(pictures_of_tables),
      cmocka_unit_test(errors_are_told_against_a_finer_mesh),
      cmocka_unit_test(errors_fall_with_the_step),
      cmocka_unit_test(starts_are_timed),
      cmocka_unit_test(data_are_found_from_anywhere),
      cmocka_unit_test(stresses_are_judged),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
