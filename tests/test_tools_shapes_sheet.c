// SPDX-License-Identifier: GPL-3.0-or-later
// The generated sheet and tube: counts, marks, areas, neighbours, and what is refused.
#include <string.h>

#include "close.h"
#include "mesh/surface.h"
#include "sheet_mesh.h"
#include "tools/shapes_sheet.h"

static size_t marked(const vsc_mesh *mesh, const char *name)
{
  const vsc_array *array = vsc_arrays_find(&mesh->node_data, name);
  size_t count = 0;
  for (size_t n = 0; n < mesh->node_count; n++) count += array->values[n] == 1;
  return count;
}

static void a_sheet_is_flat_and_whole(void **state)
{
  (void)state;
  vsc_sheet_shape shape = vsc_sheet_default();
  shape.cells[0] = 7;
  shape.cells[1] = 5;
  shape.size[0] = 3;
  shape.size[1] = 2;
  shape.jitter = 0.3;
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_sheet_mesh(&shape, &mesh, NULL), VSC_OK);
  assert_int_equal(vsc_mesh_clean(mesh, "sheet", NULL), VSC_OK);
  assert_int_equal(mesh->node_count, 48);
  assert_int_equal(mesh->triangle_count, 70);
  assert_int_equal(mesh->element_count, 0);
  assert_int_equal(marked(mesh, "x0"), 6);
  assert_int_equal(marked(mesh, "x1"), 6);
  assert_int_equal(marked(mesh, "y0"), 8);
  assert_int_equal(marked(mesh, "y1"), 8);
  const vsc_surface all = all_triangles(mesh);
  assert_close(vsc_surface_area(&all, mesh->nodes, 3), 6, 1e-14, 0);
  for (size_t t = 0; t < mesh->triangle_count; t++) {
    const double *x[3];
    for (int i = 0; i < 3; i++) x[i] = mesh->nodes + 3 * (size_t)mesh->triangles[3 * t + i];
    assert_true((x[1][0] - x[0][0]) * (x[2][1] - x[0][1]) >
                (x[1][1] - x[0][1]) * (x[2][0] - x[0][0]));
    assert_true(x[0][2] == 0);
  }
  // jitter moves the inner nodes along both axes, and no others
  size_t moved[2] = {0};
  for (size_t n = 0; n < mesh->node_count; n++)
    for (size_t i = 0; i < 2; i++) {
      const double cells = mesh->nodes[3 * n + i] / (shape.size[i] / (double)shape.cells[i]);
      moved[i] += fabs(cells - round(cells)) > 1e-9;
    }
  assert_int_equal(moved[0], 6 * 4);
  assert_int_equal(moved[1], 6 * 4);
  vsc_mesh_free(mesh);
}

static void a_tube_is_open_at_two_ends(void **state)
{
  (void)state;
  vsc_tube_shape shape = vsc_tube_default();
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_tube_mesh(&shape, &mesh, NULL), VSC_OK);
  assert_int_equal(vsc_mesh_clean(mesh, "tube", NULL), VSC_OK);
  assert_int_equal(mesh->node_count, 32 * 21);
  assert_int_equal(mesh->triangle_count, 2 * 32 * 20);
  assert_int_equal(marked(mesh, "z0"), 32);
  assert_int_equal(marked(mesh, "z1"), 32);
  const vsc_surface all = all_triangles(mesh);
  assert_close(vsc_surface_area(&all, mesh->nodes, 3), 40 * 64 * 10 * sin(M_PI / 32), 1e-13, 0);
  vsc_cavity cavity;
  assert_int_equal(vsc_cavity_make(&all, mesh->node_count, &cavity, NULL), VSC_OK);
  assert_int_equal(cavity.rim_count, 2);
  // normals outwards: it surrounds a prism
  assert_close(vsc_cavity_volume(&cavity, mesh->nodes, 3), -40 * 16 * 100 * sin(M_PI / 16), 1e-12,
               0);
  vsc_cavity_free(&cavity);
  vsc_mesh_free(mesh);
}

static void nonsense_is_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  vsc_error error;
  vsc_sheet_shape sheet = vsc_sheet_default();
  sheet.cells[1] = 0;
  assert_int_equal(vsc_sheet_mesh(&sheet, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "0 cells along y"));
  sheet = vsc_sheet_default();
  sheet.size[0] = -1;
  assert_int_equal(vsc_sheet_mesh(&sheet, &mesh, &error), VSC_INPUT);
  sheet = vsc_sheet_default();
  sheet.jitter = 0.5;
  assert_int_equal(vsc_sheet_mesh(&sheet, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "jitter 0.5"));
  vsc_tube_shape tube = vsc_tube_default();
  tube.around = 2;
  assert_int_equal(vsc_tube_mesh(&tube, &mesh, &error), VSC_INPUT);
  tube = vsc_tube_default();
  tube.radius = 0;
  assert_int_equal(vsc_tube_mesh(&tube, &mesh, &error), VSC_INPUT);
  assert_null(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_sheet_is_flat_and_whole),
      cmocka_unit_test(a_tube_is_open_at_two_ends),
      cmocka_unit_test(nonsense_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
