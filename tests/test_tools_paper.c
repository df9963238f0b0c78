// SPDX-License-Identifier: GPL-3.0-or-later
// The scenes of the paper's experiments: each is checked, and short parts of them are run, measured
// and drawn.
#include "program.h"

#include <glob.h>

#define SCENES VSC_SOURCE_DIR "/data/paper/"

// No scene is warned of, but for the paper's law, which deserves it.
static void scenes_pass_the_check(void **state)
{
  (void)state;
  static const char deserved[] = "law: paper keeps neither energy nor momenta";
  glob_t found = {0};
  assert_int_equal(glob(SCENES "*.yaml", 0, NULL, &found), 0);
  assert_true(found.gl_pathc >= 20);
  for (size_t k = 0; k < found.gl_pathc; k++) {
    char command[1024];
    snprintf(command, sizeof command, "$V check %s", found.gl_pathv[k]);
    must(command);
    for (const char *at = said; (at = strstr(at, "\nwarning  ")) != NULL; at++) {
      const char *end = strchr(at + 1, '\n'), *law = strstr(at, deserved);
      if (law == NULL || (end != NULL && law > end)) fail_msg("%s:%s", found.gl_pathv[k], at);
    }
  }
  globfree(&found);
}

// The number in column `column` (from 1) of the last line that was said.
static double last_number(int column)
{
  const char *line = said + strlen(said) - 1;
  while (line > said && line[-1] != '\n') line--;
  for (int c = 1; c < column; c++) line = strchr(line, ',') + 1;
  return strtod(line, NULL);
}

// Five milliseconds, before the springs answer: the bottom of a hanging block has fallen
// freely, the top has not moved, and nothing has turned.
static void a_hanging_block_goes_down(void **state)
{
  (void)state;
  must("$V run " SCENES "hanging.yaml --set time.end='5 ms' --set output.frames='5 ms' -o hang");
  must("$V measure --at z=0 hang");
  assert_int_equal((int)last_number(2), 37);
  // g t^2 / 2 while the wave from the top is on its way
  assert_close(last_number(5), -0.5 * 9.81e-3 * 5 * 5, 0.02, 0);
  assert_close(last_number(6), 0, 0, 0.1);
  must("$V measure --at z=100 --frames hang");
  assert_close(last_number(1), 0.005, 1e-9, 0);
  assert_close(last_number(5), 0, 0, 0);
  assert_close(last_number(7), 1, 1e-12, 0);
  must("$V plot --view --title blocks -o view.png 'hang=a block' hang/frames/hanging_00000.vtu");
  must("$V plot --curves energy_kinetic -o curve.png 'hang=a block' hang");
  char start[16];
  assert_true(load_text("view.png", start, sizeof start) > 8 && memcmp(start + 1, "PNG", 3) == 0);
  assert_true(load_text("curve.png", start, sizeof start) > 8 && memcmp(start + 1, "PNG", 3) == 0);
}

// Turned, drawn out and moved by hand: measured again.
static void slices_are_measured(void **state)
{
  (void)state;
  save_text("turned.vtu",
            "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\"><UnstructuredGrid><Piece "
            "NumberOfPoints=\"4\" NumberOfCells=\"1\"><Points><DataArray type=\"Float64\" "
            "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 2 0 0 0 2 0 0 0 2</DataArray></Points>"
            "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3"
            "</DataArray><DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>"
            "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells>"
            "<PointData><DataArray type=\"Float64\" Name=\"displacement\" "
            "NumberOfComponents=\"3\" format=\"ascii\">1 0 5  1 2 5  -1 0 5  0 0 0</DataArray>"
            "</PointData></Piece></UnstructuredGrid></VTKFile>");
  must("$V measure --at z=0 turned.vtu");
  assert_int_equal((int)last_number(2), 3);
  // (0,0) (2,0) (0,2) to (1,0) (3,2) (-1,2)
  assert_close(last_number(3), 1.0 / 3, 1e-5, 0);
  assert_close(last_number(4), 2.0 / 3, 1e-5, 0);
  assert_close(last_number(5), 5, 1e-5, 0);
  // the sums of a . b and of a x b about the centres are both 16/3
  assert_close(last_number(6), 45, 1e-5, 0);
  assert_close(last_number(7), sqrt(3), 1e-5, 0);
  assert_close(last_number(8), 1, 1e-5, 0);
  assert_close(last_number(9), 1, 1e-5, 0);
}

static void mistakes_are_named(void **state)
{
  (void)state;
  assert_int_equal(shell("$V measure"), 2);
  assert_int_equal(shell("$V measure --at q=3 x"), 2);
  assert_int_equal(shell("$V measure nowhere"), 2);
  assert_non_null(strstr(complained, "nowhere"));
  assert_int_equal(shell("$V measure --at z=17 " SCENES "tets.vtu"), 2);
  assert_int_equal(shell("$V plot --view nowhere"), 2);
  assert_int_equal(shell("$V plot --view --array nothing " SCENES "tets.vtu"), 2);
  assert_non_null(strstr(complained, "nothing"));
  assert_int_equal(shell("$V plot --view --range 3 " SCENES "tets.vtu"), 2);
  assert_int_equal(shell("$V plot --curves energy_kinetic nowhere"), 2);
  assert_int_equal(shell("$V plot --view"), 2);
}

// The blocks of Table 1 are the paper's.
static void the_blocks_are_those_of_table_1(void **state)
{
  (void)state;
  must("$V generate block --unstructured --points 222 --seed 29 -o again.vtu");
  assert_non_null(strstr(said, "222 nodes, 804 elements, 1000 mm3"));
  must("$V compare again.vtu " SCENES "tets.vtu");
  assert_non_null(strstr(said, "(positions)              points                0 "));
  must("$V info " SCENES "tets.vtu");
  assert_non_null(strstr(said, "804 tetrahedra"));
  must("$V info " SCENES "hexes.vtu");
  assert_non_null(strstr(said, "125 hexahedra"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(scenes_pass_the_check),
      cmocka_unit_test(a_hanging_block_goes_down),
      cmocka_unit_test(slices_are_measured),
      cmocka_unit_test(mistakes_are_named),
      cmocka_unit_test(the_blocks_are_those_of_table_1),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
