// SPDX-License-Identifier: GPL-3.0-or-later
// The program from outside: its dispatch, `viscera info`, `viscera compare`.
#include "close.h"
#include "trap.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/mem.h"
#include "io/checkpoint.h"
#include "io/pvd.h"
#include "io/vtk.h"
#include "write_tets.h"
#include "mesh/image.h"
#include "mesh/mesh.h"

static char folder[] = "/tmp/viscera-program-XXXXXX";
static char said[8192], complained[8192];

static const char *in_folder(const char *name)
{
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void read_back(const char *name, char *text, size_t size)
{
  FILE *stream = fopen(in_folder(name), "r");
  assert_non_null(stream);
  text[fread(text, 1, size - 1, stream)] = '\0';
  fclose(stream);
}

// Runs the program in the folder; stdout to `said`, stderr to `complained`; returns the exit code.
static int run(const char *arguments)
{
  char command[1024];
  snprintf(command, sizeof command, "cd %s && (%s %s) >out 2>err", folder, VSC_PROGRAM, arguments);
  const int status = system(command);
  read_back("out", said, sizeof said);
  read_back("err", complained, sizeof complained);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

static void assert_holds(const char *text, const char *part)
{
  if (strstr(text, part) != NULL) return;
  print_error("expected '%s' in '%s'\n", part, text);
  fail();
}

static int line_count(const char *text)
{
  int lines = 0;
  for (; *text != '\0'; text++) lines += *text == '\n';
  return lines;
}

// Tets on points with arrays p (points) and c (cells), each value plus `shift`: one tet of four
// points, two that share a face (five points), or two apart (eight points).
static void write_mesh(const char *file, size_t nodes, double shift)
{
  static const double points[24] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1,
                                    1, 1, 1, 2, 1, 1, 1, 2, 1, 1, 1, 2};
  static const uint32_t shared[8] = {0, 1, 2, 3, 1, 2, 3, 4}, apart[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  double p[24], c[2] = {3 + shift, 4 + shift};
  for (int i = 0; i < 24; i++) p[i] = i + shift;
  const vsc_vtk_array arrays[] = {{"p", 3, p, VSC_ON_NODES, false}, {"c", 1, c, VSC_ON_ELEMENTS, false}};
  assert_int_equal(write_tets(in_folder(file), nodes, points, nodes == 4 ? 1 : 2,
                                      nodes == 8 ? apart : shared, 0, NULL, 2, arrays, true, NULL),
                   VSC_OK);
}

// Two triangles alone with an array `t`, plus `shift`.
static void write_sheet(const char *file, double shift)
{
  static const uint32_t triangles[6] = {0, 1, 2, 2, 1, 3};
  const double t[2] = {5 + shift, 6 + shift};
  vsc_mesh *sheet = vsc_mesh_create(4, 0, 2);
  assert_non_null(sheet);
  for (size_t i = 0; i < 4; i++) {
    sheet->nodes[3 * i] = (double)(i % 2);
    sheet->nodes[3 * i + 1] = (double)(i / 2);
  }
  memcpy(sheet->triangles, triangles, sizeof triangles);
  const vsc_vtk_array array = {"t", 1, t, VSC_ON_TRIANGLES, false};
  assert_int_equal(vsc_vtk_write_mesh(in_folder(file), sheet, 1, &array, true, NULL), VSC_OK);
  vsc_mesh_free(sheet);
}

static void write_series(const char *file, const char *const *frames, const double *times,
                         int count)
{
  vsc_pvd *series = NULL;
  assert_int_equal(vsc_pvd_open(in_folder(file), -1, &series, NULL), VSC_OK);
  for (int f = 0; f < count; f++)
    assert_int_equal(vsc_pvd_add(series, times[f], frames[f], NULL), VSC_OK);
  vsc_pvd_free(series);
}

static int make_files(void **state)
{
  (void)state;
  if (mkdtemp(folder) == NULL) return -1;
  write_mesh("a.vtu", 5, 0);
  write_mesh("b.vtu", 5, 0.5);
  write_mesh("small.vtu", 4, 0);
  write_mesh("apart.vtu", 8, 0);
  write_sheet("sheet.vtu", 0);
  write_sheet("other.vtu", 1);
  write_series("a.pvd", (const char *[]){"a.vtu", "a.vtu", "a.vtu"}, (double[]){0, 0.1, 0.2}, 3);
  write_series("b.pvd", (const char *[]){"a.vtu", "b.vtu"}, (double[]){0, 0.1}, 2);
  const size_t size[3] = {2, 3, 4};
  vsc_image *image = vsc_image_create(size);
  assert_non_null(image);
  vsc_array *angles = vsc_arrays_add(&image->data, "azimuth", 1, 24);
  assert_non_null(angles);
  for (int i = 0; i < 24; i++) angles->values[i] = 10 * i;
  assert_int_equal(vsc_vtk_write_image(in_folder("map.vti"), image, NULL), VSC_OK);
  vsc_image_free(image);
  double positions[15] = {0};
  const vsc_block block = {"position", "mm", 5, 3, positions};
  assert_int_equal(vsc_checkpoint_write(in_folder("end.h5"), UINT64_MAX - 1, 1, &block, NULL),
                   VSC_OK);
  FILE *garbage = fopen(in_folder("garbage.h5"), "w");
  assert_non_null(garbage);
  fputs("no HDF5", garbage);
  fclose(garbage);
  return 0;
}

static int remove_files(void **state)
{
  (void)state;
  char command[256];
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return system(command);
}

static void test_dispatch(void **state)
{
  (void)state;
  assert_int_equal(run("--version"), 0);
  assert_holds(said, "viscera ");
  assert_int_equal(run("--help"), 0);
  assert_holds(said, "compare");
  assert_int_equal(run(""), 2);
  assert_int_equal(run("comprae a b"), 2);
  assert_holds(complained, "did you mean 'compare'");
  assert_int_equal(line_count(complained), 1);
  assert_int_equal(run("xyzzyplugh"), 2);
  assert_holds(complained, "unknown verb");
}

static void test_every_verb_has_help_with_examples(void **state)
{
  (void)state;
  static const char *const verbs[] = {"run",    "check",    "info", "compare",
                                      "schema", "generate", "plot"};
  for (size_t v = 0; v < sizeof verbs / sizeof verbs[0]; v++) {
    char arguments[64];
    snprintf(arguments, sizeof arguments, "%s --help", verbs[v]);
    assert_int_equal(run(arguments), 0);
    assert_holds(said, "Usage: viscera");
    assert_holds(said, "Example");
    assert_string_equal(complained, "");
    snprintf(arguments, sizeof arguments, "help %s", verbs[v]);
    assert_int_equal(run(arguments), 0);
    snprintf(arguments, sizeof arguments, "%s --nonsense", verbs[v]);
    assert_int_equal(run(arguments), 2);
    assert_holds(complained, "viscera: ");
    assert_string_equal(said, "");
  }
}

static void test_a_full_disk_is_an_error(void **state)
{
  (void)state;
  assert_int_equal(run("info a.vtu >/dev/full"), 4);
  assert_holds(complained, "writing the output failed");
}

static void test_info(void **state)
{
  (void)state;
  assert_int_equal(run("info a.vtu"), 0);
  assert_holds(said, "2 tetrahedra");
  assert_holds(said, "(0, 0, 0) to (1, 1, 1)");
  assert_holds(said, " 3 to 4\n");
  assert_true(line_count(said) < 25);
  assert_int_equal(run("info map.vti"), 0);
  assert_holds(said, "2 x 3 x 4");
  assert_holds(said, " 0 to 230\n");
  assert_int_equal(run("info a.pvd"), 0);
  assert_holds(said, "frames                 3");
  assert_holds(said, "0 s to 0.2 s");
  assert_int_equal(run("info end.h5"), 0);
  assert_holds(said, "viscera checkpoint");
  assert_holds(said, "5 x 3 [mm]");
  assert_holds(said, "18446744073709551614");
  write_mesh("LOUD.VTU", 5, 0);
  assert_int_equal(run("info LOUD.VTU"), 0);
}

static void test_info_of_strange_numbers(void **state)
{
  (void)state;
  static const double points[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, none[4] = {NAN, NAN, NAN, INFINITY},
                      some[4] = {NAN, 4, -INFINITY, 5};
  static const uint32_t corners[4] = {0, 1, 2, 3};
  const vsc_vtk_array arrays[] = {{"none", 1, none, VSC_ON_NODES, false}, {"some", 1, some, VSC_ON_NODES, false}};
  trap_off();
  assert_int_equal(write_tets(in_folder("strange.vtu"), 4, points, 1, corners, 0, NULL, 2, arrays, true, NULL), VSC_OK);
  trap_on();
  assert_int_equal(run("info strange.vtu"), 0);
  assert_holds(said, " no finite number\n");
  assert_holds(said, " 4 to 5, 2 NOT FINITE\n");
}

static void save_scene(const char *material)
{
  FILE *stream = fopen(in_folder("scene.yaml"), "w");
  assert_non_null(stream);
  fprintf(stream,
          "mesh: {file: a.vtu, unit: mm}\nfibers: {source: constant, constant: {fiber: [1, 0, 0]}}\n"
          "materials: [{name: m, density: 1 g/cm3, %s}]\ntime: {end: 1 ms}\n",
          material);
  assert_int_equal(fclose(stream), 0);
}

static void test_info_of_scenes(void **state)
{
  (void)state;
  save_scene("axial: {f: 3 kPa, s: 2 kPa, n: 1 kPa}, angular: {fs: 4 kPa, sn: 5 kPa, nf: 6 kPa}, volume_modulus: 9 kPa");
  assert_int_equal(run("info scene.yaml"), 0);
  assert_holds(said, "fibres                 one direction everywhere\n");
  assert_holds(said, "m: springs, axial 3, 2, 1, angular 4, 5, 6 kPa; passive\n");
  save_scene("law: neo_hookean, neo_hookean: {shear: 7 kPa}, volume_modulus: 50 kPa");
  assert_int_equal(run("info scene.yaml"), 0);
  assert_holds(said, "m: law neo_hookean, shear 7 kPa; passive\n");
  save_scene("law: classical, classical: {stiffness: 8 mN/mm}");
  assert_int_equal(run("info scene.yaml"), 0);
  assert_holds(said, "m: law classical, 8 mN/mm; passive\n");
}

// Arrays on cells are told beside those on points.
static void test_info_of_an_image_with_both(void **state)
{
  (void)state;
  FILE *file = fopen(in_folder("both.vti"), "w");
  assert_non_null(file);
  fputs("<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 2 0 1 0 0\">"
        "<Piece Extent=\"0 2 0 1 0 0\"><PointData><DataArray type=\"Float64\" Name=\"p\" format=\"ascii\">1 2 3 4 5 6"
        "</DataArray></PointData><CellData><DataArray type=\"Float64\" Name=\"c\" format=\"ascii\">7 8</DataArray>"
        "</CellData></Piece></ImageData></VTKFile>", file);
  fclose(file);
  assert_int_equal(run("info both.vti"), 0);
  assert_holds(said, "arrays on points\n    p                    1 to 6\n");
  assert_holds(said, "arrays on cells\n    c                    7 to 8\n");
}

static void test_info_says_what_is_wrong(void **state)
{
  (void)state;
  static const char *const bad[] = {"",        "none.vtu",   "none.vti", "none.pvd",
                                    "none.h5", "garbage.h5", "a.txt"};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char arguments[64];
    snprintf(arguments, sizeof arguments, "info %s", bad[b]);
    assert_int_equal(run(arguments), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b]);
  }
  // The good ones of several are told all the same.
  assert_int_equal(run("info none.vtu a.vtu"), 2);
  assert_holds(said, "2 tetrahedra");
}

// The numbers of an array's row: max abs, RMS, relative L2.
static void norms_of(const char *array, double norms[3])
{
  char name[64], where[16];
  for (const char *line = said; line != NULL && *line != '\0'; line = strchr(line, '\n')) {
    line += *line == '\n';
    if (sscanf(line, "%63s %15s %lf %lf %lf", name, where, &norms[0], &norms[1], &norms[2]) == 5 &&
        strcmp(name, array) == 0)
      return;
  }
  print_error("no row of '%s' in '%s'\n", array, said);
  fail();
}

static void test_compare_meshes(void **state)
{
  (void)state;
  double n[3];
  assert_int_equal(run("compare a.vtu a.vtu --tolerance 0"), 0);
  norms_of("p", n);
  assert_close(n[0] + n[1] + n[2], 0, 0, 0);
  assert_int_equal(run("compare b.vtu a.vtu"), 0);
  norms_of("p", n);  // all 15 values are off by 0.5; the sum of 0^2 .. 14^2 is 1015
  assert_close(n[0], 0.5, 1e-5, 0);
  assert_close(n[1], 0.5, 1e-5, 0);
  assert_close(n[2], sqrt(15 * 0.25 / 1015), 1e-5, 0);
  norms_of("c", n);
  assert_close(n[2], sqrt(0.5 / 25), 1e-5, 0);
  assert_int_equal(run("compare -t 0.15 b.vtu a.vtu"), 0);
  assert_int_equal(run("compare -t 0.14 b.vtu a.vtu"), 1);
  assert_holds(said, "above the tolerance");
}

static void test_surfaces(void **state)
{
  (void)state;
  double n[3];
  assert_int_equal(run("info sheet.vtu"), 0);
  assert_holds(said, "no elements, 2 triangles");
  assert_holds(said, "arrays on triangles");
  assert_holds(said, " 5 to 6\n");
  assert_null(strstr(said, "arrays on elements"));
  assert_int_equal(run("compare other.vtu sheet.vtu"), 0);
  norms_of("t", n);
  assert_close(n[0], 1, 1e-5, 0);
  assert_null(strstr(said, "elements"));
}

static void test_compare_series(void **state)
{
  (void)state;
  double n[3];
  assert_int_equal(run("compare b.pvd a.pvd"), 0);
  assert_holds(said, "frames at equal times: 2");
  assert_holds(said, "times missing in b.pvd [s]: 0.2\n");
  norms_of("c", n);  // one frame of two is off by 0.5
  assert_close(n[0], 0.5, 1e-5, 0);
  assert_close(n[1], 0.5 / sqrt(2), 1e-5, 0);
  assert_close(n[2], sqrt(0.5 / 50), 1e-5, 0);
  assert_int_equal(run("compare -t 9 b.pvd a.pvd"), 1);  // a frame is missing
  assert_int_equal(run("compare -t 0 a.pvd a.pvd"), 0);
}

static void test_compare_refuses(void **state)
{
  (void)state;
  assert_int_equal(run("compare a.vtu sheet.vtu"), 2);
  assert_holds(complained, "5 points and 2 elements");
  assert_int_equal(run("compare sheet.vtu a.vtu"), 2);
  assert_holds(complained, "5 and 2");
  assert_int_equal(run("compare a.vtu a.pvd"), 2);
  assert_int_equal(run("compare a.vtu none.vtu"), 2);
  assert_int_equal(run("compare a.pvd none.pvd"), 2);
  assert_int_equal(run("compare a.vtu"), 2);
  assert_int_equal(run("compare -t -1 a.vtu a.vtu"), 2);
  assert_int_equal(run("compare -t x a.vtu a.vtu"), 2);
  assert_int_equal(line_count(complained), 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_dispatch),
      cmocka_unit_test(test_every_verb_has_help_with_examples),
      cmocka_unit_test(test_a_full_disk_is_an_error),
      cmocka_unit_test(test_info_of_an_image_with_both),
      cmocka_unit_test(test_info),
      cmocka_unit_test(test_info_of_strange_numbers), cmocka_unit_test(test_info_of_scenes),
      cmocka_unit_test(test_info_says_what_is_wrong),
      cmocka_unit_test(test_compare_meshes),
      cmocka_unit_test(test_surfaces),
      cmocka_unit_test(test_compare_series),
      cmocka_unit_test(test_compare_refuses),
  };
  return cmocka_run_group_tests(tests, make_files, remove_files);
}
