// SPDX-License-Identifier: GPL-3.0-or-later
// Reading and writing good files; broken ones are in test_io_vtk_broken.c.
#define _GNU_SOURCE  // memmem
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "io/vtk.h"
#include "mesh/surface.h"
#include "scratch.h"
#include "trap.h"
#include "write_tets.h"

static vsc_mesh *read_mesh(const char *path, double unit)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(path, unit, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static vsc_image *read_image(const char *path, double unit)
{
  vsc_image *image = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_image(path, unit, &image, &error) != VSC_OK) fail_msg("%s", error.text);
  return image;
}

static const vsc_array *array_of(const vsc_arrays *arrays, const char *name, int components)
{
  const vsc_array *array = vsc_arrays_find(arrays, name);
  if (array == NULL) fail_msg("no array %s", name);
  assert_int_equal(array->components, components);
  return array;
}

// Two tets, a triangle, a hexahedron and a vertex, in millimetres; the second tet is left-handed;
// point 8 is used by no tet. Arrays of every number type and one of texts.
static const char MIXED_VTU[] =
  "<?xml version=\"1.0\"?>\n"
  "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
  "<UnstructuredGrid><Piece NumberOfPoints=\"9\" NumberOfCells=\"5\">\n"
  "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\">\n"
  "0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1  9 9 9</DataArray></Points>\n"
  "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">\n"
  "8  0 1 3 4  0 1 4  0 1 2 3 4 5 6 7  6 5 2 7</DataArray>\n"
  "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">1 5 8 16 20</DataArray>\n"
  "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">1 10 5 23 10</DataArray></Cells>\n"
  "<PointData>\n"
  "<DataArray type=\"Int16\" Name=\"p\" format=\"ascii\">0 -1 2 3 4 5 6 7 8</DataArray>\n"
  "</PointData><CellData>\n"
  "<DataArray type=\"UInt8\" Name=\"u8\" format=\"ascii\">200 201 202 203 204</DataArray>\n"
  "<DataArray type=\"Int8\" Name=\"i8\" format=\"ascii\">-1 -2 -3 -4 -5</DataArray>\n"
  "<DataArray type=\"UInt16\" Name=\"u16\" format=\"ascii\">60000 1 2 3 4</DataArray>\n"
  "<DataArray type=\"Int32\" Name=\"i32\" format=\"ascii\">0 -70000 5 6 7</DataArray>\n"
  "<DataArray type=\"UInt32\" Name=\"u32\" format=\"ascii\">0 4000000000 5 6 7</DataArray>\n"
  "<DataArray type=\"Int64\" Name=\"i64\" format=\"ascii\">0 -5000000000 5 6 7</DataArray>\n"
  "<DataArray type=\"UInt64\" Name=\"u64\" format=\"ascii\">0 5000000000 5 6 7</DataArray>\n"
  "<DataArray type=\"Float64\" Name=\"f64\" format=\"ascii\" NumberOfComponents=\"2\">\n"
  "0 1 2 3 4 5 6 7 8 9.25</DataArray>\n"
  "<DataArray type=\"String\" Name=\"text\" format=\"ascii\">65 0 66 0 67 0 68 0 69 0</DataArray>\n"
  "</CellData></Piece></UnstructuredGrid></VTKFile>\n";

static void a_mixed_grid_is_sorted(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_mesh(scratch_text("mixed.vtu", MIXED_VTU), 10);
  assert_int_equal(mesh->report.file_nodes, 9);
  assert_int_equal(mesh->report.file_cells, 5);
  assert_int_equal(mesh->report.ignored_cells, 2);
  assert_string_equal(mesh->report.ignored_kinds, "1 vertices, 1 cells of VTK type 23");
  assert_int_equal(mesh->report.turned_elements, 1);
  assert_int_equal(mesh->report.unused_nodes, 1);
  assert_int_equal(mesh->element_count, 2);
  assert_int_equal(mesh->element_source[0], 1);
  assert_int_equal(mesh->element_source[1], 4);
  assert_int_equal(mesh->triangle_count, 1);
  assert_int_equal(mesh->node_count, 8);
  assert_close(vsc_mesh_element_volume(mesh, 0), 1000. / 6, 1e-14, 0);
  assert_close(vsc_mesh_element_volume(mesh, 1), 1000. / 6, 1e-14, 0);
  const uint32_t triangle[3] = {0, 1, 4};
  assert_memory_equal(mesh->triangles, triangle, sizeof triangle);
  vsc_mesh_free(mesh);
}

static void every_number_type_is_read(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_mesh(scratch_text("types.vtu", MIXED_VTU), 1);
  const struct {
    const char *name;
    double first, second, triangle;
  } rows[] = {{"u8", 201, 204, 202}, {"i8", -2, -5, -3}, {"u16", 1, 4, 2}, {"i32", -70000, 7, 5},
              {"u32", 4e9, 7, 5}, {"i64", -5e9, 7, 5}, {"u64", 5e9, 7, 5}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; i++) {
    const vsc_array *on_tets = array_of(&mesh->element_data, rows[i].name, 1);
    const vsc_array *on_triangles = array_of(&mesh->triangle_data, rows[i].name, 1);
    assert_int_equal(on_tets->tuples, 2);
    assert_int_equal(on_triangles->tuples, 1);
    assert_close(on_tets->values[0], rows[i].first, 0, 0);
    assert_close(on_tets->values[1], rows[i].second, 0, 0);
    assert_close(on_triangles->values[0], rows[i].triangle, 0, 0);
  }
  const double pairs[4] = {2, 3, 8, 9.25};
  assert_memory_equal(array_of(&mesh->element_data, "f64", 2)->values, pairs, sizeof pairs);
  assert_false(array_of(&mesh->element_data, "f64", 2)->single);
  assert_null(vsc_arrays_find(&mesh->element_data, "text"));
  assert_int_equal(mesh->element_data.count, 8);
  const double nodes[8] = {0, -1, 2, 3, 4, 5, 6, 7};
  assert_memory_equal(array_of(&mesh->node_data, "p", 1)->values, nodes, sizeof nodes);
  vsc_mesh_free(mesh);
}

static void check_legacy(const vsc_mesh *mesh)
{
  assert_int_equal(mesh->element_count, 1);
  assert_int_equal(mesh->triangle_count, 1);
  assert_close(vsc_mesh_element_volume(mesh, 0), 8. / 6, 1e-14, 0);
  assert_close(array_of(&mesh->element_data, "first", 1)->values[0], 3, 0, 0);
  assert_close(array_of(&mesh->triangle_data, "second", 1)->values[0], 6, 0, 0);
  assert_close(array_of(&mesh->element_data, "fiber", 3)->values[1], 1, 0, 0);
  assert_close(array_of(&mesh->node_data, "field", 2)->values[7], 8, 0, 0);
}

// All arrays of a legacy file come, not only the first of a kind, in the old and the new format.
static void legacy_files_are_read(void **state)
{
  (void)state;
  static const char head[] =
    "# vtk DataFile Version %s\nheart\nASCII\nDATASET UNSTRUCTURED_GRID\n"
    "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n%s"
    "CELL_TYPES 2\n10\n5\nCELL_DATA 2\n"
    "SCALARS first int 1\nLOOKUP_TABLE default\n3 4\n"
    "SCALARS second double 1\nLOOKUP_TABLE default\n5 6\n"
    "VECTORS fiber float\n0 1 0 0 0 1\n"
    "POINT_DATA 4\nFIELD FieldData 1\nfield 2 4 float\n1 2 3 4 5 6 7 8\n";
  const char *versions[][2] = {
    {"2.0", "CELLS 2 9\n4 0 1 2 3\n3 0 1 2\n"},
    {"3.0", "CELLS 2 9\n4 0 1 2 3\n3 0 1 2\n"},
    {"4.2", "CELLS 2 9\n4 0 1 2 3\n3 0 1 2\n"},
    {"5.1", "CELLS 3 7\nOFFSETS vtktypeint64\n0 4 7\nCONNECTIVITY vtktypeint64\n0 1 2 3 0 1 2\n"}};
  const char *endings[] = {"", "METADATA\nINFORMATION 0\n\n", "METADATA\nINFORMATION 0\n",
                           "METADATA\nINFORMATION 0", "METADATA\nCOMPONENT_NAMES\na\nb\n\n", "\n \n"};
  for (size_t v = 0; v < sizeof versions / sizeof versions[0]; v++)
    for (size_t e = 0; e < sizeof endings / sizeof endings[0]; e++) {
      char text[2000];
      const int length = snprintf(text, sizeof text, head, versions[v][0], versions[v][1]);
      strcpy(text + length, endings[e]);
      vsc_mesh *mesh = read_mesh(scratch_text("old.VTK", text), 2);
      check_legacy(mesh);
      vsc_mesh_free(mesh);
    }
}

// Fills `file` with a binary legacy file, big-endian, of one cell; returns its length. Its last 48
// bytes are an array that repeats the points.
static size_t binary_legacy(const uint32_t cell[5], char *file)
{
  const float points[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  uint32_t words[18];
  memcpy(words, points, sizeof points);
  memcpy(words + 12, cell, 5 * sizeof *cell);
  words[17] = 10;
  for (int i = 0; i < 18; i++) words[i] = __builtin_bswap32(words[i]);
  const struct {
    const char *title;
    int first, count;
  } parts[] = {{"# vtk DataFile Version 3.0\nx\nBINARY\nDATASET UNSTRUCTURED_GRID\n"
                "POINTS 4 float\n", 0, 12},
               {"\nCELLS 1 5\n", 12, 5},
               {"\nCELL_TYPES 1\n", 17, 1},
               {"\nPOINT_DATA 4\nVECTORS position float\n", 0, 12}};
  size_t used = 0;
  for (int p = 0; p < 4; p++) {
    used += (size_t)sprintf(file + used, "%s", parts[p].title);
    memcpy(file + used, words + parts[p].first, (size_t)parts[p].count * sizeof *words);
    used += (size_t)parts[p].count * sizeof *words;
  }
  return used;
}

static void binary_legacy_files_are_read(void **state)
{
  (void)state;
  char file[1000];
  const size_t used = binary_legacy((uint32_t[]){4, 0, 1, 2, 3}, file);
  vsc_mesh *mesh = read_mesh(scratch_bytes("binary.vtk", file, used), 1);
  assert_close(vsc_mesh_element_volume(mesh, 0), 1. / 6, 1e-14, 0);
  assert_memory_equal(array_of(&mesh->node_data, "position", 3)->values, mesh->nodes,
                      12 * sizeof(double));
  vsc_mesh_free(mesh);
  for (size_t cut = used - 48; cut < used; cut++)
    assert_int_equal(vsc_vtk_read_mesh(scratch_bytes("cut.vtk", file, cut), 1, &mesh, NULL),
                     VSC_INPUT);
}

// A wrong list of cells, which VTK would follow beyond its end.
static void binary_legacy_lists_are_checked(void **state)
{
  (void)state;
  const uint32_t lists[][5] = {{5, 0, 1, 2, 3}, {3, 0, 1, 2, 3}, {UINT32_MAX, 0, 1, 2, 3}};
  for (int i = 0; i < 3; i++) {
    char file[1000];
    vsc_mesh *mesh = NULL;
    vsc_error error = {0};
    const char *path = scratch_bytes("list.vtk", file, binary_legacy(lists[i], file));
    assert_int_equal(vsc_vtk_read_mesh(path, 1, &mesh, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, "announced by CELLS 1 5"));
  }
}

// Writes a box with triangles and arrays; the mesh and the numbers in `shade` are returned.
static vsc_mesh *write_box(const char *path, bool double_precision, double *shade)
{
  const int n[3] = {3, 4, 2};
  vsc_mesh *mesh = box_mesh(n, 1. / 3, NULL);
  vsc_surface boundary;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  for (size_t i = 0; i < mesh->element_count; i++) shade[i] = (double)i - 10.4;
  const vsc_vtk_array arrays[] = {{"position", 3, mesh->nodes, VSC_ON_NODES, false},
                                  {"shade", 1, shade, VSC_ON_ELEMENTS, false},
                                  {"region", 1, shade, VSC_ON_ELEMENTS, true}};
  vsc_error error = {0};
  if (write_tets(path, mesh->node_count, mesh->nodes, mesh->element_count, mesh->corners,
                         boundary.count, boundary.triangles, 3, arrays, double_precision,
                         &error) != VSC_OK)
    fail_msg("%s", error.text);
  vsc_surface_free(&boundary);
  return mesh;
}

static void what_is_written_reads_back(void **state)
{
  (void)state;
  for (int precision = 0; precision < 2; precision++) {
    double shade[200];
    const double tolerance = precision ? 0 : 1e-7;
    vsc_mesh *mesh = write_box(scratch("box.vtu"), precision, shade);
    vsc_mesh *back = read_mesh(scratch("box.vtu"), 1);
    assert_int_equal(back->node_count, mesh->node_count);
    assert_int_equal(back->element_count, mesh->element_count);
    assert_int_equal(back->triangle_count, 2 * 2 * (12 + 8 + 6));
    assert_int_equal(back->report.turned_elements, 0);
    assert_memory_equal(back->corners, mesh->corners, 4 * mesh->element_count * sizeof *mesh->corners);
    const vsc_array *position = array_of(&back->node_data, "position", 3);
    for (size_t i = 0; i < 3 * mesh->node_count; i++) {
      assert_close(back->nodes[i], mesh->nodes[i], tolerance, 0);
      assert_close(position->values[i], mesh->nodes[i], tolerance, 0);
    }
    for (size_t i = 0; i < mesh->element_count; i++) {
      assert_close(array_of(&back->element_data, "shade", 1)->values[i], shade[i], tolerance, 0);
      assert_close(array_of(&back->element_data, "region", 1)->values[i], (double)i - 10, 0, 0);
    }
    assert_close(array_of(&back->triangle_data, "shade", 1)->values[5], 0, 0, 0);
    vsc_mesh_free(back);
    vsc_mesh_free(mesh);
  }
}

static void the_encoding_is_the_promised_one(void **state)
{
  (void)state;
  double shade[200];
  size_t bytes;
  vsc_mesh_free(write_box(scratch("box.vtu"), false, shade));
  char *text = scratch_load(scratch("box.vtu"), &bytes);
  const char *promised[] = {"header_type=\"UInt64\"", "compressor=\"vtkZLibDataCompressor\"",
                            "type=\"Float32\" Name=\"position\"", "type=\"Int32\" Name=\"region\"",
                            "format=\"binary\""};
  for (size_t i = 0; i < sizeof promised / sizeof promised[0]; i++)
    if (memmem(text, bytes, promised[i], strlen(promised[i])) == NULL) fail_msg("%s", promised[i]);
  assert_null(memmem(text, bytes, "Float64", 7));
  assert_null(memmem(text, bytes, "appended", 8));
  assert_int_not_equal(access(scratch("box.vtu.tmp"), F_OK), 0);
  free(text);
}

// Infinite values in an array are the array's business, whoever wrote the file.
static void infinite_values_are_read(void **state)
{
  (void)state;
  const double nodes[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const double values[4] = {1, INFINITY, NAN, -INFINITY};
  const uint32_t tet[4] = {0, 1, 2, 3};
  const vsc_vtk_array array = {"a", 1, values, VSC_ON_NODES, false};
  trap_off();  // VTK compares NaN for their range
  assert_int_equal(write_tets(scratch("inf.vtu"), 4, nodes, 1, tet, 0, NULL, 1, &array,
                                      true, NULL), VSC_OK);
  trap_on();
  size_t bytes;
  char *text = scratch_load(scratch("inf.vtu"), &bytes);
  assert_null(strstr(text, "InformationKey"));
  for (int foreign = 0; foreign < 2; foreign++) {
    vsc_mesh *mesh = read_mesh(scratch("inf.vtu"), 1);
    const double *back = array_of(&mesh->node_data, "a", 1)->values;
    assert_true(back[1] == INFINITY && isnan(back[2]) && back[3] == -INFINITY);
    vsc_mesh_free(mesh);
    char *end = strstr(text, "</DataArray>");
    assert_non_null(end);
    char longer[8000];
    const int length = snprintf(longer, sizeof longer,
                                "%.*s<InformationKey name=\"L2_NORM_RANGE\" "
                                "location=\"vtkDataArray\" length=\"2\"><Value index=\"0\">0"
                                "</Value><Value index=\"1\">inf</Value></InformationKey>%s",
                                (int)(end - text), text, end);
    scratch_bytes("inf.vtu", longer, (size_t)length);
  }
  free(text);
}

static void what_cannot_be_written_is_reported(void **state)
{
  (void)state;
  const double nodes[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};
  const uint32_t tet[4] = {0, 1, 2, 3};
  vsc_error error = {0};
  const char *path = scratch("no_folder/out.vtu");
  assert_int_equal(write_tets(path, 4, nodes, 1, tet, 0, NULL, 0, NULL, false, &error),
                   VSC_SYSTEM);
  assert_ptr_equal(strstr(error.text, path), error.text);
  assert_non_null(strstr(error.text, "No such file"));
}

// A left-handed image, oblique, with two arrays.
static void images_read_back(void **state)
{
  (void)state;
  const size_t size[3] = {4, 3, 5};
  const double direction[9] = {0, 0.6, 0.8, 1, 0, 0, 0, 0.8, -0.6};
  vsc_image *image = vsc_image_create(size);
  for (int i = 0; i < 9; i++) image->direction[i] = direction[i];
  for (int i = 0; i < 3; i++) {
    image->origin[i] = 7 - 5 * i;
    image->spacing[i] = 0.5 + 0.25 * i;
  }
  vsc_array *angle = vsc_arrays_add(&image->data, "angle", 1, 60);
  for (int i = 0; i < 60; i++) angle->values[i] = i / 8.;
  vsc_arrays_add(&image->data, "vector", 3, 60)->values[179] = 2.5;
  vsc_error error = {0};
  if (vsc_vtk_write_image(scratch("a.vti"), image, &error) != VSC_OK) fail_msg("%s", error.text);

  vsc_image *back = read_image(scratch("a.vti"), 10);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(back->size[i], size[i]);
    assert_close(back->spacing[i], 10 * image->spacing[i], 1e-14, 0);
    assert_close(back->origin[i], 10 * image->origin[i], 1e-14, 0);
  }
  for (int i = 0; i < 9; i++) assert_close(back->direction[i], direction[i], 1e-14, 1e-15);
  const vsc_array *there = array_of(&back->data, "angle", 1);
  assert_true(there->single);
  assert_memory_equal(there->values, vsc_arrays_find(&image->data, "angle")->values,
                      60 * sizeof(double));
  assert_close(array_of(&back->data, "vector", 3)->values[179], 2.5, 0, 0);
  vsc_image_free(back);
  vsc_image_free(image);
}

// Where the file's point (or cell) `index` lies after reading.
static void assert_place(const vsc_image *image, double i, double j, double k, double x, double y,
                         double z)
{
  double position[3];
  vsc_image_position(image, (double[]){i, j, k}, position);
  assert_close(position[0], x, 1e-14, 1e-14);
  assert_close(position[1], y, 1e-14, 1e-14);
  assert_close(position[2], z, 1e-14, 1e-14);
}

static vsc_image *read_image_text(const char *attributes, const char *extent,
                                  const char *point_data, const char *cell_data)
{
  char text[2000];
  snprintf(text, sizeof text,
           "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
           "<ImageData WholeExtent=\"%s\" %s><Piece Extent=\"%s\">\n"
           "<PointData>%s</PointData><CellData>%s</CellData></Piece></ImageData></VTKFile>\n",
           extent, attributes, extent, point_data, cell_data);
  return read_image(scratch_text("image.vti", text), 2);
}

static void extents_spacings_and_cells_are_honoured(void **state)
{
  (void)state;
  static const char on_points[] = "<DataArray type=\"Int16\" Name=\"a\" format=\"ascii\">"
                                  "0 1 2 3 4 5 6 7 8 9 10 11</DataArray>";
  static const char on_cells[] = "<DataArray type=\"UInt8\" Name=\"c\" format=\"ascii\">"
                                 "5 6</DataArray>";
  static const char place[] = "Origin=\"1 2 3\" Spacing=\"0.5 -1 2\"";

  vsc_image *image = read_image_text(place, "10 12 -1 0 5 6", on_points, on_cells);
  assert_null(vsc_arrays_find(&image->data, "c"));
  assert_int_equal(array_of(&image->cell_data, "c", 1)->tuples, 2);
  assert_int_equal(array_of(&image->data, "a", 1)->tuples, 12);
  assert_int_equal(image->size[0], 3);
  assert_true(image->spacing[1] > 0);
  assert_place(image, 0, 0, 0, 2 * 6, 2 * 3, 2 * 13);
  assert_place(image, 2, 1, 1, 2 * 7, 2 * 2, 2 * 15);
  vsc_image_take_cells(image);
  assert_int_equal(image->data.count, 1);
  assert_int_equal(image->size[0] * image->size[1] * image->size[2], 2);
  assert_close(array_of(&image->data, "c", 1)->values[1], 6, 0, 0);
  assert_place(image, 1, 0, 0, 2 * 6.75, 2 * 2.5, 2 * 14);
  vsc_image_free(image);

  image = read_image_text(place, "10 12 -1 0 5 6", "", on_cells);
  assert_int_equal(image->size[0], 2);
  assert_int_equal(image->size[1], 1);
  assert_int_equal(image->size[2], 1);
  assert_close(array_of(&image->data, "c", 1)->values[1], 6, 0, 0);
  assert_place(image, 0, 0, 0, 2 * 6.25, 2 * 2.5, 2 * 14);
  assert_place(image, 1, 0, 0, 2 * 6.75, 2 * 2.5, 2 * 14);
  assert_int_equal(image->cell_data.count, 0);
  vsc_image_free(image);

  // One slice: its cells lie in its plane, and a zero spacing across it does no harm.
  image = read_image_text("Origin=\"0 0 4\" Spacing=\"1 1 0\"", "0 2 0 1 0 0", "", on_cells);
  assert_int_equal(image->size[2], 1);
  assert_place(image, 1, 0, 0, 2 * 1.5, 2 * 0.5, 2 * 4);
  vsc_image_free(image);
}

static void legacy_images_are_read(void **state)
{
  (void)state;
  vsc_image *image = read_image(
    scratch_text("points.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n"
                               "DIMENSIONS 2 2 1\nORIGIN 1 1 1\nSPACING 2 2 2\nPOINT_DATA 4\n"
                               "SCALARS a short 1\nLOOKUP_TABLE default\n1 2 3 4\n"), 1);
  assert_close(array_of(&image->data, "a", 1)->values[3], 4, 0, 0);
  assert_place(image, 1, 1, 0, 3, 3, 1);
  vsc_image_free(image);
}

static void vtk_is_silent(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  char *half = strdup(MIXED_VTU);
  half[1000] = '\0';
  const int kept = scratch_hush();
  const vsc_status xml = vsc_vtk_read_mesh(scratch_text("half.vtu", half), 1, &mesh, NULL);
  const vsc_status legacy =
    vsc_vtk_read_mesh(scratch_text("half.vtk", "# vtk DataFile Version 3.0\nx\nASCII\n"
                                               "DATASET UNSTRUCTURED_GRID\nPOINTS 9 float\n1"),
                      1, &mesh, NULL);
  const size_t printed = scratch_unhush(kept);
  free(half);
  assert_int_equal(xml, VSC_INPUT);
  assert_int_equal(legacy, VSC_INPUT);
  assert_int_equal(printed, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_mixed_grid_is_sorted),
    cmocka_unit_test(every_number_type_is_read),
    cmocka_unit_test(legacy_files_are_read),
    cmocka_unit_test(binary_legacy_files_are_read),
    cmocka_unit_test(binary_legacy_lists_are_checked),
    cmocka_unit_test(what_is_written_reads_back),
    cmocka_unit_test(infinite_values_are_read),
    cmocka_unit_test(the_encoding_is_the_promised_one),
    cmocka_unit_test(what_cannot_be_written_is_reported),
    cmocka_unit_test(images_read_back),
    cmocka_unit_test(extents_spacings_and_cells_are_honoured),
    cmocka_unit_test(legacy_images_are_read),
    cmocka_unit_test(vtk_is_silent),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
