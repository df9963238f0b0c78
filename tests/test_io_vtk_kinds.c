// SPDX-License-Identifier: GPL-3.0-or-later
// Elements of all kinds and surfaces through VTK files.
#include "close.h"
#include "hybrid_mesh.h"
#include "io/vtk.h"
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

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_hybrid_mesh_comes_back),
      cmocka_unit_test(a_surface_is_read),
      cmocka_unit_test(a_voxel_is_a_hexahedron),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
