// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench: its sections and what it refuses, and the blocks whose steps it times.
#include "program.h"
#include "tools/bench/specimen.h"

static void sections_are_listed_and_others_refused(void **state)
{
  (void)state;
  must("$V bench --help");
  static const char *const sections[] = {"throughput", "growth", "skipping", "error", "accuracy", "paper"};
  for (size_t k = 0; k < sizeof sections / sizeof sections[0]; k++) assert_non_null(strstr(said, sections[k]));
  assert_int_equal(shell("$V bench speed"), 2);
  assert_non_null(strstr(complained, "speed: no section of that name"));
  assert_int_equal(shell("$V bench throughput --elements 3"), 2);
  assert_non_null(strstr(complained, "--elements 3: expected a number from 5"));
  assert_int_equal(shell("$V bench growth --csv no/such/folder.csv"), 2);
  assert_non_null(strstr(complained, "cannot be written"));
  must("$V bench error --help");
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

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sections_are_listed_and_others_refused),
      cmocka_unit_test(specimens_are_what_they_say),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
