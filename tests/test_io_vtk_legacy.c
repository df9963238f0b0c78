// SPDX-License-Identifier: GPL-3.0-or-later
// Legacy files that VTK would read past an end, or allocate without bound for: each ends in VSC_INPUT.
#include <string.h>

#include "close.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
#include "scratch.h"

// VTK's reader of legacy files loses memory when a file breaks off.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
  return "leak:libvtk\n";
}

#define GRID "# vtk DataFile Version 4.2\nheart POINTS 900000000 float\nASCII\nDATASET UNSTRUCTURED_GRID\n"
#define POINTS "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
#define CELLS "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n"
#define POLYDATA "# vtk DataFile Version 4.2\nvessel\nASCII\nDATASET POLYDATA\n"
#define NEW_POLYDATA "# vtk DataFile Version 5.1\nvessel\nASCII\nDATASET POLYDATA\n"

static void assert_refused(vsc_status status, const vsc_error *error, const char *path, const char *words)
{
  if (status != VSC_INPUT) fail_msg("status %d (%s): %s", status, words, error->text);
  assert_ptr_equal(strstr(error->text, path), error->text);
  if (strstr(error->text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error->text);
}

static void assert_no_mesh(const char *text, const char *words)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  const char *path = scratch_text("grid.vtk", text);
  assert_refused(vsc_vtk_read_mesh(path, 1, &mesh, &error), &error, path, words);
}

static void assert_no_lines(const char *text, const char *words)
{
  vsc_polydata *lines = NULL;
  vsc_error error = {0};
  const char *path = scratch_text("lines.vtk", text);
  assert_refused(vsc_vtk_read_polydata(path, 1, &lines, &error), &error, path, words);
}

static vsc_mesh *read_good(const char *text)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(scratch_text("good.vtk", text), 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static void points_that_are_not_there(void **state)
{
  (void)state;
  assert_no_lines(POLYDATA "POINTS 2 float\n0 0 0 10 10 10\nLINES 1 3\n2 0 100000000000\n",
                  "LINES names point 100000000000, the file has points 0 to 1");
  assert_no_lines(POLYDATA "POINTS 2 float\n0 0 0 10 10 10\nLINES 1 3\n2 -7 1\n", "LINES names point -7");
  assert_no_lines(POLYDATA "LINES 1 3\n2 0 1\nPOINTS 2 float\n0 0 0 10 10 10\n", "LINES but no POINTS before");
  assert_no_lines(NEW_POLYDATA "LINES 2 2\nOFFSETS vtktypeint64\n0 2\nCONNECTIVITY vtktypeint64\n0 1\n",
                  "LINES but no POINTS before");
  assert_no_mesh(GRID POINTS "CELLS 1 5\n4 0 1 2 4\nCELL_TYPES 1\n10\n", "CELLS names point 4");
}

// VTK takes offsets for the older format where it understands the version so.
static void offsets_of_another_version(void **state)
{
  (void)state;
  static const char form[] = "# vtk DataFile Version %s\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n" POINTS
                             "CELLS 2 4\nOFFSETS vtktypeint64\n0 4\nCONNECTIVITY vtktypeint64\n0 1 2 3\nCELL_TYPES 1\n10\n";
  const char *const versions[] = {"5.1", "nan", "4.2", "-5.1", "7", "5.x", "3000000000.1"};
  for (int k = 0; k < 7; k++) {
    char text[1000];
    snprintf(text, sizeof text, form, versions[k]);
    if (k == 0) vsc_mesh_free(read_good(text));
    else assert_no_mesh(text, "CELLS come as OFFSETS, which the version in its first line does not have");
  }
}

static void counts_beyond_the_file(void **state)
{
  (void)state;
  assert_no_mesh(GRID "POINTS 300000000 float\n0 0 0 1 0 0\n" CELLS, "POINTS announces 300000000 times 3 numbers");
  assert_no_mesh(GRID POINTS "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 2000000000\n10\n", "CELL_TYPES announces 2000000000 ");
  assert_no_lines(NEW_POLYDATA "POINTS 2 float\n0 0 0 1 1 1\nLINES 900000000 2\nOFFSETS vtktypeint64\n0 2\n"
                           "CONNECTIVITY vtktypeint64\n0 1\n", "LINES announces 900000000 ");
  assert_no_lines(NEW_POLYDATA "POINTS 2 float\n0 0 0 1 1 1\nLINES 2 900000000\nOFFSETS vtktypeint64\n0 2\n"
                           "CONNECTIVITY vtktypeint64\n0 1\n", "LINES announces 900000000 ");
}

static void arrays_beyond_the_file(void **state)
{
  (void)state;
  static const char *const arrays[][2] = {
    {"FIELD f 1\nheat 1 9223372036854775807 int\n1 2 3 4\n", "heat announces 9223372036854775807 times 1 "},
    {"FIELD f 1\nheat 2147483647 4 double\n1 2 3 4\n", "heat announces 4 times 2147483647 "},
    {"FIELD f 1\nheat 1 -4 double\n1 2 3 4\n", "heat announces -4 times 1 "},
    {"SCALARS heat float 500000000\nLOOKUP_TABLE default\n1 2 3 4\n", "SCALARS announces 4 times 500000000 "},
    {"COLOR_SCALARS heat 500000000\n1 2 3 4\n", "COLOR_SCALARS announces 4 times 500000000 "},
    {"LOOKUP_TABLE own 500000000\n1 1 1 1\n", "LOOKUP_TABLE announces 500000000 times 4 "},
    {"FIELD f 1\nheat 1 4 int\n1 2 3 4\nMETADATA\nINFORMATION 1\nNAME L2 LOCATION vtkDataArray\nDATA 90000000000 0 1\n\n",
     "DATA announces 90000000000 "},
  };
  for (size_t i = 0; i < sizeof arrays / sizeof arrays[0]; i++) {
    char text[1000];
    snprintf(text, sizeof text, GRID POINTS CELLS "POINT_DATA 4\n%s", arrays[i][0]);
    assert_no_mesh(text, arrays[i][1]);
  }
  assert_no_mesh(GRID POINTS CELLS "POINT_DATA 4000000000\nVECTORS v float\n1 2 3\n", "VECTORS announces 4000000000 ");
}

// The same words where they are names, and numbers that are no counts.
static void arrays_of_such_names(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_good(GRID POINTS CELLS
                             "CELL_DATA 1\nFIELD f 4\ncells 1 1 int\n900000000\npoints 1 1 int\n900000000\n"
                             "cell_types 1 1 int\n900000000\nDATA 1 1 int\n900000000\n"
                             "POINT_DATA 4\nSCALARS heat float\nLOOKUP_TABLE default\n900000000 2 3 4\n"
                             "VECTORS way double\n900000000 900000000 1 1 1 1 1 1 1 1 1 1\n"
                             "FIELD f 1\nintensity 1 4 int\n1 2 900000000 900000000\n");
  assert_true(vsc_arrays_find(&mesh->element_data, "cells")->values[0] == 9e8);
  assert_true(vsc_arrays_find(&mesh->node_data, "heat")->values[0] == 9e8);
  assert_true(vsc_arrays_find(&mesh->node_data, "intensity")->values[3] == 9e8);
  vsc_mesh_free(mesh);
  mesh = read_good(GRID "FIELD FieldData 1\nTIME 1 1 double\n0.5\n" POINTS CELLS "CELL_DATA 1\nPOINT_DATA 4\n");
  vsc_mesh_free(mesh);
}

// What follows a name that the file ends with is no count.
static void names_at_the_end(void **state)
{
  (void)state;
  assert_no_mesh(GRID POINTS CELLS "POINT_DATA 4\nFIELD f 2\na 1 4 int\n1 2 3 4\nb", "damaged or cut short");
  assert_no_mesh(GRID POINTS CELLS "POINT_DATA 4\nFIELD f 2\na 1 4 int\n1 2 3 4\nb 1", "damaged or cut short");
  assert_no_mesh(GRID POINTS CELLS "POINT_DATA 4\nFIELD f 2\na 1 4 int\n1 2 3 4\nb 1 4", "damaged or cut short");
}

static void images(void **state)
{
  (void)state;
  static const char form[] = "# vtk DataFile Version 4.2\nmap\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\n"
                             "ORIGIN 0 0 0\nSPACING 1 1 1\nPOINT_DATA 4\nFIELD f 1\ncells %s int\n1 2 3 900000000\n";
  char text[1000];
  vsc_image *image = NULL;
  vsc_error error = {0};
  snprintf(text, sizeof text, form, "1 4");
  if (vsc_vtk_read_image(scratch_text("i.vtk", text), 1, &image, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_true(vsc_arrays_find(&image->data, "cells")->values[3] == 9e8);
  vsc_image_free(image);
  snprintf(text, sizeof text, form, "1 4000000000");
  const char *path = scratch_text("i.vtk", text);
  assert_refused(vsc_vtk_read_image(path, 1, &image, &error), &error, path, "cells announces 4000000000 ");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(points_that_are_not_there),
    cmocka_unit_test(offsets_of_another_version),
    cmocka_unit_test(counts_beyond_the_file),
    cmocka_unit_test(arrays_beyond_the_file),
    cmocka_unit_test(arrays_of_such_names),
    cmocka_unit_test(names_at_the_end),
    cmocka_unit_test(images),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
