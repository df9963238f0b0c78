// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench: its sections and what it refuses, and the blocks whose steps it times.
#include "program.h"
#include "tools/bench/specimen.h"

static void sections_are_listed_and_others_refused(void **state)
{
  (void)state;
  must("$V bench --help");
  static const char *const sections[] = {"throughput", "growth", "skipping", "start", "error", "stability", "accuracy", "paper"};
  for (size_t k = 0; k < sizeof sections / sizeof sections[0]; k++) assert_non_null(strstr(said, sections[k]));
  assert_int_equal(shell("$V bench speed"), 2);
  assert_non_null(strstr(complained, "speed: no section of that name"));
  assert_int_equal(shell("$V bench throughput --elements 3"), 2);
  assert_non_null(strstr(complained, "--elements 3: expected a number from 5"));
  assert_int_equal(shell("$V bench growth --csv no/such/folder.csv"), 2);
  assert_non_null(strstr(complained, "cannot be written"));
  must("$V bench error --help");
  assert_int_equal(shell("$V bench error --only speed -o none"), 2);
  assert_non_null(strstr(complained, "--only speed: there are the tables time, space, real_time and slivers"));
  assert_int_equal(shell("test -e none"), 1);
}

// Every kind has about as many elements as it is asked for, in a cube of 1 mm edges; a step of each costs
// something and its model takes memory.
static void specimens_are_what_they_say(void **state)
{
  (void)state;
  static const vsc_specimen specimens[] = {
      {.name = "tets"},
      {.name = "shuffled", .kind = VSC_SPECIMEN_SHUFFLED, .damping = true, .nodal = true},
      {.name = "quadratic", .kind = VSC_SPECIMEN_QUADRATIC, .law = VSC_LAW_GUCCIONE},
      {.name = "hexes", .kind = VSC_SPECIMEN_HEXES, .active = VSC_ACTIVE_TENSION},
      {.name = "smoothed", .law = VSC_LAW_HOLZAPFEL_OGDEN, .nodal = true, .smoothed = true},
  };
  for (size_t k = 0; k < sizeof specimens / sizeof specimens[0]; k++) {
    vsc_mesh *mesh;
    vsc_error error;
    vsc_specimen_cost cost;
    assert_int_equal(vsc_specimen_mesh(specimens[k].kind, 60, &mesh, &error), VSC_OK);
    assert_true(mesh->element_count >= 60 && mesh->element_count <= 160);
    double volume = 0, cube = 0;
    for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
    cube = cbrt(volume);
    assert_true(fabs(cube - round(cube)) < 1e-12);
    if (vsc_specimen_time(&specimens[k], mesh, false, &cost, &error) != VSC_OK) fail_msg("%s", error.text);
    assert_true(cost.elements == mesh->element_count && cost.nodes == mesh->node_count);
    assert_true(cost.one > 0);
#ifndef __SANITIZE_ADDRESS__  // whose allocator does not say what it has given out
    assert_true(cost.bytes > 100.0 * (double)cost.elements);
#endif
    vsc_mesh_free(mesh);
  }
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
  assert_int_equal(shell("test -e no.png"), 1);
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
  assert_int_equal(shell("$V bench start --times 0"), 2);
  assert_int_equal(shell("$V bench start --scene missing.yaml --times 1 -o out"), 4);
  assert_non_null(strstr(complained, "log.txt says why"));
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
      cmocka_unit_test(pictures_of_tables),
      cmocka_unit_test(starts_are_timed),
      cmocka_unit_test(stresses_are_judged),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
