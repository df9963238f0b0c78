// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces and centre lines through VTK files.
#include <string.h>

#include "close.h"
#include "io/vtk_polydata.h"
#include "scratch.h"

static vsc_polydata *read_good(const char *path, double unit)
{
  vsc_polydata *p = NULL;
  vsc_error error;
  if (vsc_vtk_read_polydata(path, unit, &p, &error) != VSC_OK) fail_msg("%s", error.text);
  return p;
}

// A triangle, a square (fanned) and a line of three points, with radii.
static const char LEGACY[] =
    "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 7 float\n"
    "0 0 0  1 0 0  1 1 0  0 1 0  5 0 0  6 0 0  7 1 0\n"
    "LINES 1 4\n3 4 5 6\nPOLYGONS 2 9\n3 0 1 2\n4 0 1 2 3\n"
    "POINT_DATA 7\nSCALARS radius float 1\nLOOKUP_TABLE default\n0 0 0 0 1 2 3\n";

static void legacy_files_are_read(void **state)
{
  (void)state;
  vsc_polydata *p = read_good(scratch_text("p.vtk", LEGACY), 10);
  assert_int_equal(p->point_count, 7);
  assert_int_equal(p->triangle_count, 3);
  assert_int_equal(p->segment_count, 2);
  const uint32_t segments[4] = {4, 5, 5, 6};
  assert_memory_equal(p->segments, segments, sizeof segments);
  const uint32_t triangles[9] = {0, 1, 2, 0, 1, 2, 0, 2, 3};
  assert_memory_equal(p->triangles, triangles, sizeof triangles);
  assert_close(p->points[3 * 6], 70, 0, 0);
  assert_close(vsc_arrays_find(&p->point_data, "radius")->values[6], 3, 0, 0);
  vsc_polydata_free(p);
}

static void what_is_written_reads_back(void **state)
{
  (void)state;
  vsc_polydata *p = read_good(scratch_text("p.vtk", LEGACY), 1);
  vsc_error error;
  const char *file = scratch("p.vtp");
  if (vsc_vtk_write_polydata(file, p, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_polydata *back = read_good(file, 1);
  assert_int_equal(back->point_count, p->point_count);
  assert_int_equal(back->triangle_count, p->triangle_count);
  assert_int_equal(back->segment_count, p->segment_count);
  assert_memory_equal(back->points, p->points, 21 * sizeof(double));
  assert_memory_equal(back->triangles, p->triangles, 9 * sizeof(uint32_t));
  assert_memory_equal(back->segments, p->segments, 4 * sizeof(uint32_t));
  assert_memory_equal(vsc_arrays_find(&back->point_data, "radius")->values,
                      vsc_arrays_find(&p->point_data, "radius")->values, 7 * sizeof(double));
  vsc_polydata_free(p);
  vsc_polydata_free(back);
}

// A field whose name begins like a list is none.
static void fields_of_cells_are_no_lists(void **state)
{
  (void)state;
  static const char text[] =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
      "0 0 0  1 0 0  1 1 0\nPOLYGONS 1 4\n3 0 1 2\n"
      "CELL_DATA 1\nFIELD FieldData 1\nlines_id 1 1 float\n7\n"
      "POINT_DATA 3\nSCALARS radius float 1\nLOOKUP_TABLE default\n1 2 3\n";
  vsc_polydata *p = read_good(scratch_text("f.vtk", text), 1);
  assert_int_equal(p->triangle_count, 1);
  assert_int_equal(p->segment_count, 0);
  vsc_polydata_free(p);
}

// Every cut of the file, and lists that lie, end in one line that names the file; none crashes.
static void broken_files_are_refused(void **state)
{
  (void)state;
  vsc_error error;
  vsc_polydata *p = NULL;
  size_t refused = 0;
  for (size_t cut = 0; cut < sizeof LEGACY; cut++) {
    char text[sizeof LEGACY];
    memcpy(text, LEGACY, cut);
    text[cut] = '\0';
    const char *file = scratch_text("cut.vtk", text);
    error.text[0] = '\0';
    if (vsc_vtk_read_polydata(file, 1, &p, &error) == VSC_OK) {
      vsc_polydata_free(p);
      continue;
    }
    refused++;
    assert_non_null(strstr(error.text, "cut.vtk"));
    assert_null(strchr(error.text, '\n'));
  }
  assert_true(refused > 150);  // but cuts within the radii, and behind the lists
  static const char *const lies[][2] = {{"4 0 1 2 3\n", "9 0 1 2 3\n"},
                                        {"3 0 1 2\n", "3 0 1 77\n"},
                                        {"LINES 1 4", "LINES 9 4"},
                                        {"POLYDATA", "STRUCTURED_POINTS"}};
  for (size_t k = 0; k < sizeof lies / sizeof lies[0]; k++) {
    char text[sizeof LEGACY + 16];
    const char *at = strstr(LEGACY, lies[k][0]);
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - LEGACY), LEGACY, lies[k][1],
             at + strlen(lies[k][0]));
    assert_int_equal(vsc_vtk_read_polydata(scratch_text("lie.vtk", text), 1, &p, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, "lie.vtk"));
    assert_null(strchr(error.text, '\n'));
  }
  assert_int_equal(vsc_vtk_read_polydata(scratch("none.vtp"), 1, &p, &error), VSC_INPUT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(legacy_files_are_read),
      cmocka_unit_test(what_is_written_reads_back),
      cmocka_unit_test(fields_of_cells_are_no_lists),
      cmocka_unit_test(broken_files_are_refused),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
