// SPDX-License-Identifier: GPL-3.0-or-later
// Files with quadratic tetrahedra and triangles.
#include <string.h>

#include "close.h"
#include "io/vtk.h"
#include "mesh/quadratic.h"
#include "scratch.h"
#include "tools/shapes.h"

static vsc_mesh *read_mesh(const char *path)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(path, 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

// A jittered block of quadratic tets whose boundary is listed as triangles.
static vsc_mesh *block_with_triangles(void)
{
  const vsc_block_shape shape = {
      .cells = {2, 2, 2}, .size = {2, 2, 2}, .tets_per_cell = 6, .jitter = 0.2, .seed = 3};
  vsc_mesh *mesh, *all;
  vsc_surface boundary;
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  all = vsc_mesh_create(mesh->node_count, mesh->element_count, boundary.count);
  memcpy(all->nodes, mesh->nodes, 3 * mesh->node_count * sizeof *mesh->nodes);
  memcpy(all->corners, mesh->corners, 4 * mesh->element_count * sizeof *mesh->corners);
  memcpy(all->triangles, boundary.triangles, 3 * boundary.count * sizeof *mesh->triangles);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
  assert_int_equal(vsc_mesh_clean(all, "block", NULL), VSC_OK);
  assert_int_equal(vsc_mesh_raise(&all, "block", NULL), VSC_OK);
  return all;
}

static void assert_same(const vsc_mesh *back, const vsc_mesh *mesh)
{
  assert_int_equal(back->node_count, mesh->node_count);
  assert_int_equal(back->element_count, mesh->element_count);
  assert_int_equal(back->triangle_count, mesh->triangle_count);
  assert_int_equal(back->report.turned_elements, 0);
  assert_memory_equal(back->kinds, mesh->kinds, mesh->element_count);
  assert_memory_equal(back->nodes, mesh->nodes, 3 * mesh->node_count * sizeof *mesh->nodes);
  assert_memory_equal(back->corners, mesh->corners,
                      10 * mesh->element_count * sizeof *mesh->corners);
  assert_memory_equal(back->triangles, mesh->triangles,
                      3 * mesh->triangle_count * sizeof *mesh->triangles);
  assert_memory_equal(back->triangle_mid, mesh->triangle_mid,
                      3 * mesh->triangle_count * sizeof *mesh->triangles);
}

static void it_comes_back_as_it_went(void **state)
{
  (void)state;
  vsc_mesh *mesh = block_with_triangles();
  double *numbers = vsc_arrays_add(&mesh->triangle_data, "label", 1, mesh->triangle_count)->values;
  for (size_t t = 0; t < mesh->triangle_count; t++) numbers[t] = (double)(t % 7);
  const vsc_vtk_array array = {"label", 1, numbers, VSC_ON_TRIANGLES, true};
  vsc_error error;
  const char *file = scratch("quadratic.vtu");
  if (vsc_vtk_write_mesh(file, mesh, 1, &array, true, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_mesh *back = read_mesh(file);
  assert_same(back, mesh);
  assert_memory_equal(vsc_arrays_find(&back->triangle_data, "label")->values, numbers,
                      mesh->triangle_count * sizeof *numbers);
  vsc_mesh_free(back);
  vsc_mesh_free(mesh);
}

// A legacy file as other programs write it: VTK's types 24 and 22; `linear` writes triangles of three
// points.
static void it_is_read_from_legacy_files(void **state)
{
  (void)state;
  vsc_mesh *mesh = block_with_triangles();
  for (int linear = 0; linear < 2; linear++) {
    const char *path = scratch("quadratic.vtk");
    FILE *file = fopen(path, "w");
    const size_t elements = mesh->element_count, triangles = mesh->triangle_count;
    const size_t width = linear ? 3 : 6;
    fprintf(file, "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS %zu double\n",
            mesh->node_count);
    for (size_t i = 0; i < 3 * mesh->node_count; i++) fprintf(file, "%.17g\n", mesh->nodes[i]);
    fprintf(file, "CELLS %zu %zu\n", elements + triangles, 11 * elements + (width + 1) * triangles);
    for (size_t e = 0; e < elements; e++) {
      fprintf(file, "10");
      for (int i = 0; i < 10; i++) fprintf(file, " %u", vsc_mesh_corners(mesh, e)[i]);
      fprintf(file, "\n");
    }
    for (size_t t = 0; t < triangles; t++) {
      fprintf(file, "%zu", width);
      for (size_t i = 0; i < width; i++)
        fprintf(file, " %u", i < 3 ? mesh->triangles[3 * t + i] : mesh->triangle_mid[3 * t + i - 3]);
      fprintf(file, "\n");
    }
    fprintf(file, "CELL_TYPES %zu\n", elements + triangles);
    for (size_t c = 0; c < elements + triangles; c++)
      fprintf(file, "%d\n", c < elements ? 24 : linear ? 5 : 22);
    assert_int_equal(fclose(file), 0);
    vsc_mesh *back = read_mesh(path);
    assert_same(back, mesh);
    vsc_mesh_free(back);
  }
  vsc_mesh_free(mesh);
}

// Quadratic triangles without quadratic elements are counted and left out.
static void lone_triangles_are_ignored(void **state)
{
  (void)state;
  static const char text[] =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 7 float\n"
      "0 0 0 1 0 0 0 1 0 0 0 1 .5 0 0 .5 .5 0 0 .5 0\nCELLS %d %d\n%s6 0 1 2 4 5 6\nCELL_TYPES %d\n%s22\n";
  char file[1024];
  vsc_error error;
  vsc_mesh *mesh = NULL;
  snprintf(file, sizeof file, text, 2, 12, "4 0 1 2 3\n", 2, "10\n");
  mesh = read_mesh(scratch_text("with.vtk", file));
  assert_int_equal(mesh->node_count, 4);
  assert_int_equal(mesh->triangle_count, 0);
  assert_int_equal(mesh->report.ignored_cells, 1);
  assert_string_equal(mesh->report.ignored_kinds, "1 quadratic triangles");
  vsc_mesh_free(mesh);
  snprintf(file, sizeof file, text, 1, 7, "", 1, "");
  assert_int_equal(vsc_vtk_read_mesh(scratch_text("alone.vtk", file), 1, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "1 quadratic triangles"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(it_comes_back_as_it_went),
      cmocka_unit_test(it_is_read_from_legacy_files),
      cmocka_unit_test(lone_triangles_are_ignored),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
