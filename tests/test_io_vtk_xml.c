// SPDX-License-Identifier: GPL-3.0-or-later
// XML files that VTK would fail on by a signal, allocate without bound for, or leave memory unset: VSC_INPUT each.
#define _GNU_SOURCE  // memmem
#include <string.h>

#include "base/mem.h"
#include "box_mesh.h"
#include "close.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
#include "scratch.h"
#include "write_tets.h"

static void assert_refused(vsc_status status, const vsc_error *error, const char *path, const char *words)
{
  if (status != VSC_INPUT) fail_msg("status %d (%s): %s", status, words, error->text);
  assert_ptr_equal(strstr(error->text, path), error->text);
  if (strstr(error->text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error->text);
}

static void assert_no_mesh(const char *path, const char *words)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  assert_refused(vsc_vtk_read_mesh(path, 1, &mesh, &error), &error, path, words);
}

// ---- Images

// An image of Int32, each piece with the numbers from `first` on.
static const char *write_image(const char *whole, size_t count, const char *const *extents, const size_t *points)
{
  char text[4000];
  size_t used = (size_t)snprintf(text, sizeof text,
                                 "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">"
                                 "<ImageData WholeExtent=\"%s\" Origin=\"0 0 0\" Spacing=\"1 1 1\">\n", whole);
  for (size_t i = 0; i < count; i++) {
    used += (size_t)snprintf(text + used, sizeof text - used,
                             "<Piece Extent=\"%s\"><PointData><DataArray type=\"Int32\" Name=\"a\" format=\"ascii\">",
                             extents[i]);
    for (size_t k = 0; k < points[i]; k++) used += (size_t)snprintf(text + used, sizeof text - used, "%zu ", k + 1);
    used += (size_t)snprintf(text + used, sizeof text - used, "</DataArray></PointData></Piece>\n");
  }
  snprintf(text + used, sizeof text - used, "</ImageData></VTKFile>\n");
  return scratch_text("pieces.vti", text);
}

static void assert_no_image(const char *path, const char *words)
{
  vsc_image *image = NULL;
  vsc_error error = {0};
  assert_refused(vsc_vtk_read_image(path, 1, &image, &error), &error, path, words);
}

static void pieces_that_fill_an_image(void **state)
{
  (void)state;
  vsc_error error = {0};
  vsc_image *image = NULL;
  const char *path = write_image("0 2 0 1 0 0", 2, (const char *const[]){"0 1 0 1 0 0", "1 2 0 1 0 0"}, (size_t[]){4, 4});
  if (vsc_vtk_read_image(path, 1, &image, &error) != VSC_OK) fail_msg("%s", error.text);
  const double *a = vsc_arrays_find(&image->data, "a")->values;
  assert_true(a[0] == 1 && a[3] == 3 && a[2] == 2 && a[5] == 4);
  vsc_image_free(image);
}

static void pieces_that_do_not(void **state)
{
  (void)state;
  const char *const half[] = {"0 1 0 1 0 0"}, *const twice[] = {"0 1 0 1 0 0", "0 1 0 1 0 0"};
  const char *const apart[] = {"0 1 0 1 0 0", "2 2 0 1 0 0"};
  assert_no_image(write_image("0 2 0 1 0 0", 1, half, (size_t[]){4}),
                  "its 1 pieces hold 1 cells, WholeExtent has 2: it is not complete");
  assert_no_image(write_image("0 2 0 1 0 0", 2, twice, (size_t[]){4, 4}), "pieces 0 and 1 overlap");
  assert_no_image(write_image("0 2 0 1 0 0", 2, apart, (size_t[]){4, 2}), "its 2 pieces hold 1 cells");
  assert_no_image(write_image("0 2 0 1 0 0", 0, half, (size_t[]){0}), "its 0 pieces");
  const char *const outside[] = {"0 2147483647 0 1 0 0", "-1 2 0 1 0 0", "0 2 0 1 0 1", "0 2 0 1", "0 2 0 1 0 99999999999"};
  for (size_t i = 0; i < 5; i++)
    assert_no_image(write_image("0 2 0 1 0 0", 1, &outside[i], (size_t[]){6}), i < 3 ? "leaves WholeExtent" : "six whole numbers");
  const char *const vast[] = {"0 99999 0 99999 0 0"};
  assert_no_image(write_image("0 99999 0 99999 0 0", 1, vast, (size_t[]){6}), "more than a file of that size can hold");
}

// ---- Counts

static const char *write_grid(const char *points, const char *array)
{
  char text[2000];
  snprintf(text, sizeof text,
           "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n<UnstructuredGrid>"
           "<Piece NumberOfPoints=\"%s\" NumberOfCells=\"1\">\n<Points><DataArray type=\"Float64\" "
           "NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 0 1 0 0 0 1</DataArray></Points>\n"
           "<Cells><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 3</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">4</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">10</DataArray></Cells>\n<PointData>%s</PointData>"
           "</Piece></UnstructuredGrid></VTKFile>\n", points, array);
  return scratch_text("grid.vtu", text);
}

static void counts_beyond_the_file(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(write_grid("4", ""), 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_mesh_free(mesh);
  assert_no_mesh(write_grid("300000000", ""), "line 2: Piece with NumberOfPoints=\"300000000\"");
  assert_no_mesh(write_grid("-4", ""), "Piece with NumberOfPoints=\"-4\"");
  static const char form[] = "<DataArray type=\"Float32\" Name=\"a\" NumberOfComponents=\"%s\" format=\"ascii\">1</DataArray>";
  const char *const widths[] = {"9223372036854775807", "2147483647", "4000", "-1"};
  for (size_t i = 0; i < 4; i++) {
    char array[200];
    snprintf(array, sizeof array, form, widths[i]);
    assert_no_mesh(write_grid("4", array), "DataArray with NumberOfComponents=");
  }
  assert_no_mesh(write_grid("4", "<DataArray type=\"Int8\" Name=\"a\" format=\"ascii\">1 2 3 4<InformationKey name=\"x\" "
                                 "location=\"y\" length=\"99999999999\"/></DataArray>"), "InformationKey with length=");
}

static void strips_beyond_the_file(void **state)
{
  (void)state;
  vsc_polydata *surface = NULL;
  vsc_error error = {0};
  const char *path = scratch_text("s.vtp", "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\"><PolyData>"
                                           "<Piece NumberOfPoints=\"3\" NumberOfStrips=\"4294967295\"></Piece></PolyData></VTKFile>");
  assert_refused(vsc_vtk_read_polydata(path, 1, &surface, &error), &error, path, "Piece with NumberOfStrips=");
}

// ---- Compressed arrays

static const char *write_box(void)
{
  vsc_mesh *mesh = box_mesh((int[]){2, 2, 2}, 1, NULL);
  const char *path = scratch("box.vtu");
  assert_int_equal(write_tets(path, mesh->node_count, mesh->nodes, mesh->element_count, mesh->corners, 0, NULL, 0, NULL,
                              false, NULL), VSC_OK);
  vsc_mesh_free(mesh);
  return path;
}

// Headers of 64 bits that are read as if they had 32: the size of a block is zero then.
static void headers_of_another_type(void **state)
{
  (void)state;
  static const char wide[] = " header_type=\"UInt64\"";
  size_t bytes;
  char *whole = scratch_load(write_box(), &bytes);
  char *place = memmem(whole, bytes, wide, strlen(wide));
  assert_non_null(place);
  memset(place, ' ', strlen(wide));
  assert_no_mesh(scratch_bytes("narrow.vtu", whole, bytes), "header_type (here UInt32) is wrong");
  free(whole);
}

// The same in data appended, raw or in base64: three numbers, then the sizes of the blocks.
static void headers_that_lie(void **state)
{
  (void)state;
  static const char form[] =
    "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"%s\" header_type=\"UInt32\" "
    "compressor=\"vtkZLibDataCompressor\">\n<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">"
    "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"2\"/></Points>"
    "</Piece></UnstructuredGrid>\n<AppendedData encoding=\"%s\">\n_##";
  static const char end[] = "\n</AppendedData></VTKFile>\n";
  const struct {
    const char *order, *encoding, *data, *words;
    size_t length;
  } cases[] = {
    {"LittleEndian", "raw", "\1\0\0\0\0\0\0\0\7\0\0\0", "1 blocks of 0 bytes, the last of 7", 12},
    {"BigEndian", "raw", "\0\0\0\1\0\0\0\0\0\0\0\7", "1 blocks of 0 bytes, the last of 7", 12},
    {"LittleEndian", "raw", "\0\0\0\0\1\0\0\0\1\0\0\0", "0 blocks of 1 bytes, the last of 1", 12},
    {"LittleEndian", "raw", "\0\0\0\x7f\1\0\0\0\0\0\0\0", "2130706432 blocks of 1 bytes", 12},
    {"LittleEndian", "base64", "AQAAAAAAAAAHAAAA", "1 blocks of 0 bytes, the last of 7", 16},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[2000];
    size_t length = (size_t)snprintf(text, sizeof text, form, cases[i].order, cases[i].encoding);
    memcpy(text + length, cases[i].data, cases[i].length);
    length += cases[i].length;
    memcpy(text + length, end, sizeof end);
    assert_no_mesh(scratch_bytes("header.vtu", text, length + sizeof end - 1), cases[i].words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(pieces_that_fill_an_image),
    cmocka_unit_test(pieces_that_do_not),
    cmocka_unit_test(counts_beyond_the_file),
    cmocka_unit_test(strips_beyond_the_file),
    cmocka_unit_test(headers_of_another_type),
    cmocka_unit_test(headers_that_lie),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
