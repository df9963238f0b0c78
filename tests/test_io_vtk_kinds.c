// SPDX-License-Identifier: GPL-3.0-or-later
// Files with elements of all kinds, and with surfaces.
#include <string.h>

#include "base/mem.h"
#include "close.h"
#include "hybrid_mesh.h"
#include "io/vtk.h"
#include "mesh/select.h"
#include "scratch.h"

static vsc_mesh *read_mesh(const char *path, double unit)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(path, unit, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static const vsc_array *array_of(const vsc_arrays *arrays, const char *name, int components)
{
  const vsc_array *array = vsc_arrays_find(arrays, name);
  if (array == NULL) fail_msg("no array %s", name);
  assert_int_equal(array->components, components);
  return array;
}

// Elements of all kinds with a number each: they come back as they went, in their order.
static void a_hybrid_mesh_comes_back(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.1, 5), *back = NULL;
  vsc_error error;
  double *numbers;
  if (!VSC_NEW(numbers, mesh->element_count)) fail_msg("no memory");
  for (size_t e = 0; e < mesh->element_count; e++) numbers[e] = (double)(7 * e % 100);
  const vsc_vtk_array array = {"number", 1, numbers, VSC_ON_ELEMENTS, true};
  const char *file = scratch("hybrid.vtu");
  if (vsc_vtk_write_mesh(file, mesh, 1, &array, true, &error) != VSC_OK ||
      vsc_vtk_read_mesh(file, 1, &back, &error) != VSC_OK)
    fail_msg("%s", error.text);
  assert_int_equal(back->report.turned_elements, 0);
  assert_int_equal(back->element_count, mesh->element_count);
  assert_memory_equal(back->kinds, mesh->kinds, mesh->element_count);
  assert_memory_equal(back->corners, mesh->corners,
                      mesh->start[mesh->element_count] * sizeof *mesh->corners);
  assert_memory_equal(back->nodes, mesh->nodes, 3 * mesh->node_count * sizeof *mesh->nodes);
  assert_memory_equal(vsc_arrays_find(&back->element_data, "number")->values, numbers,
                      mesh->element_count * sizeof *numbers);
  vsc_free(numbers);
  vsc_mesh_free(mesh);
  vsc_mesh_free(back);
}

// A surface alone: two triangles and a quad, which is cut in two; what lies on cells lies on both.
static void a_surface_is_read(void **state)
{
  (void)state;
  static const char text[] =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n"
      "0 0 0  1 0 0  1 1 0  0 1 0  2 0 0  2 1 0\nCELLS 3 13\n3 0 1 2\n3 0 2 3\n4 1 4 5 2\n"
      "CELL_TYPES 3\n5\n5\n9\nCELL_DATA 3\nSCALARS s float 1\nLOOKUP_TABLE default\n1 2 3\n";
  vsc_mesh *mesh = read_mesh(scratch_text("surface.vtk", text), 1);
  assert_int_equal(mesh->element_count, 0);
  assert_int_equal(mesh->triangle_count, 4);
  assert_int_equal(mesh->node_count, 6);
  assert_int_equal(mesh->report.ignored_cells, 0);
  const uint32_t halves[6] = {1, 4, 5, 1, 5, 2};
  assert_memory_equal(mesh->triangles + 6, halves, sizeof halves);
  const double values[4] = {1, 2, 3, 3};
  assert_memory_equal(array_of(&mesh->triangle_data, "s", 1)->values, values, sizeof values);
  vsc_mesh_free(mesh);
}

// A voxel numbers its corners row by row.
static void a_voxel_is_a_hexahedron(void **state)
{
  (void)state;
  static const char text[] =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
      "0 0 0  2 0 0  0 1 0  2 1 0  0 0 3  2 0 3  0 1 3  2 1 3\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\n"
      "CELL_TYPES 1\n11\n";
  vsc_mesh *mesh = read_mesh(scratch_text("voxel.vtk", text), 1);
  assert_int_equal(mesh->kinds[0], VSC_HEX);
  assert_int_equal(mesh->report.turned_elements, 0);
  assert_close(vsc_mesh_element_volume(mesh, 0), 6, 1e-15, 0);
  vsc_mesh_free(mesh);
}

// Volumes that no element can be made of are no holes: the file is refused. Faces may lie about.
static void other_volumes_are_refused(void **state)
{
  (void)state;
  const struct {
    int type;
    const char *words;  // NULL: taken
  } cases[] = {{41, "1 cells of VTK type 41 would be left out"}, {25, "1 quadratic hexahedra"}, {7, NULL}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    char text[1000];
    vsc_mesh *mesh = NULL;
    vsc_error error = {0};
    snprintf(text, sizeof text,
             "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 12 float\n"
             "0 0 0  1 0 0  1 1 0  0 1 0  0 0 1  1 0 1  1 1 1  0 1 1  0 0 2  1 0 2  1 1 2  0 1 2\nCELLS 2 18\n"
             "8 0 1 2 3 4 5 6 7\n8 4 5 6 7 8 9 10 11\nCELL_TYPES 2\n12\n%d\n",
             cases[k].type);
    const vsc_status status = vsc_vtk_read_mesh(scratch_text("others.vtk", text), 1, &mesh, &error);
    assert_int_equal(status, cases[k].words == NULL ? VSC_OK : VSC_INPUT);
    if (cases[k].words == NULL)
      assert_int_equal(mesh->report.ignored_cells, 1);
    else if (strstr(error.text, cases[k].words) == NULL || strstr(error.text, "Tetrahedralize") == NULL)
      fail_msg("\"%s\" not in \"%s\"", cases[k].words, error.text);
    vsc_mesh_free(mesh);
  }
}

// Writes the mesh as an ASCII legacy file: behind each third element a vertex, behind each fourth a
// triangle on nodes 0, 1, 2; array `number` is the cell's number. `swapped` writes wedges as other
// programs do, their triangles exchanged.
static const char *write_legacy(const vsc_mesh *mesh, bool swapped)
{
  static const int types[] = {10, 12, 13, 14};
  const char *path = scratch("hybrid.vtk");
  FILE *file = fopen(path, "w");
  assert_non_null(file);
  const size_t elements = mesh->element_count, vertices = elements / 3, triangles = elements / 4;
  const size_t cells = elements + vertices + triangles;
  fprintf(file,
          "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %zu double\n",
          mesh->node_count);
  for (size_t i = 0; i < 3 * mesh->node_count; i++) fprintf(file, "%.17g\n", mesh->nodes[i]);
  fprintf(file, "CELLS %zu %zu\n", cells,
          elements + mesh->start[elements] + 2 * vertices + 4 * triangles);
  for (size_t e = 0; e < elements; e++) {
    const int corners = vsc_mesh_kind(mesh, e)->corners;
    fprintf(file, "%d", corners);
    for (int i = 0; i < corners; i++)
      fprintf(file, " %u",
              vsc_mesh_corners(mesh, e)[mesh->kinds[e] == VSC_WEDGE && !swapped ? (i + 3) % 6 : i]);
    fprintf(file, "\n%s%s", e % 3 == 2 ? "1 0\n" : "", e % 4 == 3 ? "3 0 1 2\n" : "");
  }
  fprintf(file, "CELL_TYPES %zu\n", cells);
  for (size_t e = 0; e < elements; e++)
    fprintf(file, "%d\n%s%s", types[mesh->kinds[e]], e % 3 == 2 ? "1\n" : "",
            e % 4 == 3 ? "5\n" : "");
  fprintf(file, "CELL_DATA %zu\nSCALARS number int 1\nLOOKUP_TABLE default\n", cells);
  for (size_t c = 0; c < cells; c++) fprintf(file, "%zu\n", c);
  assert_int_equal(fclose(file), 0);
  return path;
}

static void a_legacy_file_of_all_kinds(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.1, 6);
  size_t wedges = 0;
  for (size_t e = 0; e < mesh->element_count; e++) wedges += mesh->kinds[e] == VSC_WEDGE;
  assert_true(wedges > 3);
  for (int swapped = 0; swapped < 2; swapped++) {
    vsc_mesh *back = read_mesh(write_legacy(mesh, swapped), 1);
    assert_int_equal(back->report.turned_elements, swapped ? wedges : 0);
    assert_int_equal(back->report.ignored_cells, mesh->element_count / 3);
    assert_int_equal(back->element_count, mesh->element_count);
    assert_int_equal(back->triangle_count, mesh->element_count / 4);
    assert_memory_equal(back->kinds, mesh->kinds, mesh->element_count);
    if (!swapped)
      assert_memory_equal(back->corners, mesh->corners,
                          mesh->start[mesh->element_count] * sizeof *mesh->corners);
    const double *number = array_of(&back->element_data, "number", 1)->values;
    for (size_t e = 0; e < mesh->element_count; e++) {
      assert_int_equal(back->element_source[e], e + e / 3 + e / 4);
      assert_close(number[e], (double)back->element_source[e], 0, 0);
      assert_close(vsc_mesh_element_volume(back, e), vsc_mesh_element_volume(mesh, e), 1e-14, 0);
    }
    const double *on_triangle = array_of(&back->triangle_data, "number", 1)->values;
    for (size_t t = 0; t < back->triangle_count; t++) {
      const size_t e = 4 * t + 3;
      assert_close(on_triangle[t], (double)(e + e / 3 + e / 4 + 1 + (e % 3 == 2)), 0, 0);
    }
    vsc_mesh_free(back);
  }
  vsc_mesh_free(mesh);
}

// Arrays on nodes, on elements and on triangles, each 0 on the other cells.
static void arrays_keep_their_places(void **state)
{
  (void)state;
  vsc_mesh *block = hybrid_block(2, 0.1, 2);
  vsc_surface boundary;
  vsc_error error;
  double *numbers;
  assert_int_equal(vsc_boundary(block, &boundary, NULL), VSC_OK);
  block->triangle_count = boundary.count;
  vsc_free(block->triangles);
  block->triangles = boundary.triangles;
  vsc_free(boundary.paired);
  assert_true(
      VSC_NEW(numbers, 3 * block->node_count + 3 * block->element_count + 3 * boundary.count));
  for (size_t i = 0; i < block->element_count + boundary.count; i++) numbers[i] = (double)i + 1;
  const vsc_vtk_array arrays[] = {{"n", 1, numbers, VSC_ON_NODES, true},
                                  {"e", 1, numbers, VSC_ON_ELEMENTS, false},
                                  {"t", 3, numbers, VSC_ON_TRIANGLES, false},
                                  {"whole", 1, numbers, VSC_ON_TRIANGLES, true}};
  const char *file = scratch("places.vtu");
  if (vsc_vtk_write_mesh(file, block, 4, arrays, true, &error) != VSC_OK)
    fail_msg("%s", error.text);
  vsc_mesh *back = read_mesh(file, 1);
  assert_int_equal(back->triangle_count, boundary.count);
  assert_memory_equal(back->triangles, boundary.triangles, 3 * boundary.count * sizeof(uint32_t));
  for (size_t i = 0; i < back->node_count; i++)
    assert_close(array_of(&back->node_data, "n", 1)->values[i], (double)i + 1, 0, 0);
  for (size_t e = 0; e < back->element_count; e++) {
    assert_close(array_of(&back->element_data, "e", 1)->values[e], (double)e + 1, 0, 0);
    assert_close(array_of(&back->element_data, "t", 3)->values[3 * e + 1], 0, 0, 0);
    assert_close(array_of(&back->element_data, "whole", 1)->values[e], 0, 0, 0);
  }
  for (size_t t = 0; t < back->triangle_count; t++) {
    assert_close(array_of(&back->triangle_data, "t", 3)->values[3 * t], numbers[3 * t], 0, 0);
    assert_close(array_of(&back->triangle_data, "whole", 1)->values[t], (double)t + 1, 0, 0);
    assert_close(array_of(&back->triangle_data, "e", 1)->values[t], 0, 0, 0);
  }
  vsc_free(numbers);
  vsc_mesh_free(back);
  vsc_mesh_free(block);
}

// A surface alone goes out and comes back.
static void a_surface_comes_back(void **state)
{
  (void)state;
  static const uint32_t triangles[6] = {0, 1, 2, 2, 1, 3};
  static const double values[2] = {4, 5};
  vsc_mesh *sheet = vsc_mesh_create(4, 0, 2);
  for (int i = 0; i < 4; i++) {
    sheet->nodes[3 * i] = i % 2;
    sheet->nodes[3 * i + 1] = i / 2;
  }
  memcpy(sheet->triangles, triangles, sizeof triangles);
  const vsc_vtk_array array = {"a", 1, values, VSC_ON_TRIANGLES, false};
  const char *file = scratch("sheet.vtu");
  assert_int_equal(vsc_vtk_write_mesh(file, sheet, 1, &array, false, NULL), VSC_OK);
  vsc_mesh *back = read_mesh(file, 10);
  assert_int_equal(back->element_count, 0);
  assert_memory_equal(back->triangles, triangles, sizeof triangles);
  assert_memory_equal(array_of(&back->triangle_data, "a", 1)->values, values, sizeof values);
  assert_close(back->nodes[9], 10, 0, 0);
  vsc_mesh_free(back);
  vsc_mesh_free(sheet);
}

// However a quad of the file turns, its triangles are those of the boundary, so that its values
// select them.
static void quads_select_the_boundary(void **state)
{
  (void)state;
  for (int turn = 0; turn < 4; turn++) {
    static const int top[4] = {6, 4, 3, 5};
    char text[1000];
    snprintf(text, sizeof text,
             "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 float\n"
             "0 0 0  1 0 0  1 1 0  1 1 1  1 0 1  0 1 1  0 0 1  0 1 0\nCELLS 2 14\n"
             "8 0 1 2 7 6 4 3 5\n4 %d %d %d %d\nCELL_TYPES 2\n12\n9\nCELL_DATA 2\n"
             "SCALARS mark int 1\nLOOKUP_TABLE default\n0 5\n",
             top[turn], top[(turn + 1) % 4], top[(turn + 2) % 4], top[(turn + 3) % 4]);
    vsc_mesh *mesh = read_mesh(scratch_text("quad.vtk", text), 1);
    assert_int_equal(mesh->report.ignored_cells, 0);
    assert_int_equal(mesh->triangle_count, 2);
    const vsc_selector selector = {
        .name = "top", .kind = VSC_SELECT_TRIANGLE_ARRAY, .array = "mark", .low = 5, .high = 5};
    vsc_surface boundary, surface;
    vsc_error error;
    assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
    if (vsc_select_surface(mesh, &boundary, &selector, &surface, &error) != VSC_OK)
      fail_msg("%s", error.text);
    assert_int_equal(surface.count, 2);
    vsc_surface_free(&surface);
    vsc_surface_free(&boundary);
    vsc_mesh_free(mesh);
  }
}

// VTK's own picture of a wedge (book and header): the first triangle's normal points outwards.
static void a_wedge_as_vtk_draws_it(void **state)
{
  (void)state;
  static const char text[] =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n"
      "0 1 0  0 0 0  0 0 2  1 1 0  1 0 0  1 0 2\nCELLS 1 7\n6 %s\nCELL_TYPES 1\n13\n";
  static const char *const orders[2] = {"0 1 2 3 4 5", "3 4 5 0 1 2"};
  for (int reversed = 0; reversed < 2; reversed++) {
    char file[400];
    snprintf(file, sizeof file, text, orders[reversed]);
    vsc_mesh *mesh = read_mesh(scratch_text("wedge.vtk", file), 1);
    assert_int_equal(mesh->report.turned_elements, reversed);
    assert_close(vsc_mesh_element_volume(mesh, 0), 1, 1e-15, 0);
    vsc_mesh_free(mesh);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_hybrid_mesh_comes_back), cmocka_unit_test(a_legacy_file_of_all_kinds),
      cmocka_unit_test(arrays_keep_their_places), cmocka_unit_test(a_surface_is_read),
      cmocka_unit_test(a_surface_comes_back),     cmocka_unit_test(quads_select_the_boundary),
      cmocka_unit_test(a_voxel_is_a_hexahedron),
    cmocka_unit_test(other_volumes_are_refused),  cmocka_unit_test(a_wedge_as_vtk_draws_it),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
