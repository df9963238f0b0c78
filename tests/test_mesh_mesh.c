// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "trap.h"

static const double CORNERS[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1, 1, 1};

// Cleans two tets, (0 1 2 3) and the given one, on five nodes of which the last is at `last`;
// returns the status and the message.
static vsc_status clean_two(const uint32_t second[4], const double last[3], vsc_error *error)
{
  vsc_mesh *mesh = vsc_mesh_create(5, 2, 0);
  const uint32_t first[4] = {0, 1, 2, 3};
  memcpy(mesh->nodes, CORNERS, sizeof CORNERS);
  memcpy(mesh->nodes + 12, last, 3 * sizeof *last);
  memcpy(mesh->corners, first, sizeof first);
  memcpy(mesh->corners + 4, second, 4 * sizeof *second);
  mesh->element_source[1] = 77;
  mesh->node_source[4] = 99;
  const vsc_status status = vsc_mesh_clean(mesh, "heart.vtu", error);
  vsc_mesh_free(mesh);
  return status;
}

static void assert_refused(const uint32_t second[4], const double last[3], const char *word,
                           const char *id)
{
  vsc_error error = {0};
  assert_int_equal(clean_two(second, last, &error), VSC_INPUT);
  assert_int_equal(error.status, VSC_INPUT);
  assert_ptr_equal(strstr(error.text, "heart.vtu: "), error.text);
  assert_non_null(strstr(error.text, word));
  assert_non_null(strstr(error.text, id));
  assert_null(strchr(error.text, '\n'));
}

static void broken_meshes_are_refused_with_ids(void **state)
{
  (void)state;
  const double good[3] = {1, 1, 1};
  assert_refused((uint32_t[]){1, 2, 3, 5}, good, "not among the 5", "cells 77");
  assert_refused((uint32_t[]){1, 2, 3, UINT32_MAX}, good, "not among", "cells 77");
  assert_refused((uint32_t[]){1, 2, 3, 3}, good, "same point twice", "cells 77");
  assert_refused((uint32_t[]){1, 2, 3, 4}, (double[]){1. / 3, 1. / 3, 1. / 3}, "degenerate",
                 "cells 77");
  assert_refused((uint32_t[]){1, 2, 3, 4}, (double[]){1, 0, 0}, "degenerate", "cells 77");
  assert_refused((uint32_t[]){1, 2, 3, 4}, (double[]){1, 1, NAN}, "not finite", "points 99");
  assert_refused((uint32_t[]){1, 2, 3, 4}, (double[]){-INFINITY, 1, 1}, "not finite", "points 99");
  trap_off();  // the volume overflows
  assert_refused((uint32_t[]){1, 2, 3, 4}, (double[]){1e200, 1e200, 1e200}, "degenerate",
                 "cells 77");
  trap_on();
}

static void a_thin_tet_is_not_degenerate(void **state)
{
  (void)state;
  vsc_error error = {0};
  const double shift = 1e-6;
  assert_int_equal(clean_two((uint32_t[]){1, 2, 3, 4},
                             (double[]){1. / 3 + shift, 1. / 3, 1. / 3}, &error), VSC_OK);
  assert_int_equal(clean_two((uint32_t[]){1, 2, 3, 4},
                             (double[]){1. / 3 + 1e-11, 1. / 3, 1. / 3}, &error), VSC_INPUT);
}

static void at_most_five_ids_are_named(void **state)
{
  (void)state;
  const int n[3] = {2, 2, 2};
  vsc_mesh *mesh = box_mesh_raw(n, 1, NULL);
  for (size_t i = 0; i < 4 * mesh->element_count; i++) mesh->corners[i] = 0;
  vsc_error error;
  assert_int_equal(vsc_mesh_clean(mesh, "m", &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "48 tetrahedra"));
  assert_non_null(strstr(error.text, "cells 0, 1, 2, 3, 4 and 43 more"));
  vsc_mesh_free(mesh);
}

static void a_mesh_without_tets_is_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  vsc_error error;
  assert_int_equal(vsc_mesh_from_arrays(4, CORNERS, 0, NULL, &mesh, &error), VSC_INPUT);
  assert_null(mesh);
  assert_non_null(strstr(error.text, "neither"));
  assert_int_equal(vsc_mesh_from_arrays(0, NULL, 0, NULL, &mesh, NULL), VSC_INPUT);
}

static void left_handed_tets_are_turned(void **state)
{
  (void)state;
  const int n[3] = {3, 2, 2};
  vsc_mesh *raw = box_mesh_raw(n, 0.5, NULL);
  size_t left = 0;
  for (size_t t = 0; t < raw->element_count; t++) left += vsc_mesh_element_volume(raw, t) < 0;
  assert_int_equal(left, raw->element_count / 2);
  vsc_mesh *mesh;
  assert_int_equal(vsc_mesh_from_arrays(raw->node_count, raw->nodes, raw->element_count, raw->corners,
                                        &mesh, NULL), VSC_OK);
  assert_int_equal(mesh->report.turned_elements, left);
  double sum = 0;
  for (size_t t = 0; t < mesh->element_count; t++) {
    assert_true(vsc_mesh_element_volume(mesh, t) > 0);
    sum += vsc_mesh_element_volume(mesh, t);
    assert_int_equal(mesh->corners[4 * t], raw->corners[4 * t]);
    assert_int_equal(mesh->corners[4 * t + 1], raw->corners[4 * t + 1]);
  }
  assert_close(sum, 1.5, 1e-14, 0);
  vsc_mesh_free(raw);
  vsc_mesh_free(mesh);
}

// One tet on nodes 1, 3, 4, 6 of seven; triangles with and without unused nodes; node 5 is NaN but
// no tet uses it.
static vsc_mesh *sparse_mesh(void)
{
  vsc_mesh *mesh = vsc_mesh_create(7, 1, 3);
  const uint32_t tet[4] = {3, 1, 6, 4}, triangles[9] = {1, 3, 2, 3, 1, 6, 0, 1, 3};
  for (int i = 0; i < 4; i++) memcpy(mesh->nodes + 3 * tet[i], CORNERS + 3 * i, 3 * sizeof(double));
  mesh->nodes[3 * 5] = NAN;
  memcpy(mesh->corners, tet, sizeof tet);
  memcpy(mesh->triangles, triangles, sizeof triangles);
  vsc_array *node = vsc_arrays_add(&mesh->node_data, "n", 2, 7);
  for (int i = 0; i < 14; i++) node->values[i] = i;
  vsc_array *mark = vsc_arrays_add(&mesh->triangle_data, "mark", 1, 3);
  for (int i = 0; i < 3; i++) mark->values[i] = 10 + i;
  return mesh;
}

static void unused_nodes_are_dropped_with_their_data(void **state)
{
  (void)state;
  vsc_mesh *mesh = sparse_mesh();
  assert_int_equal(vsc_mesh_clean(mesh, "m", NULL), VSC_OK);
  assert_int_equal(mesh->node_count, 4);
  assert_int_equal(mesh->report.file_nodes, 7);
  assert_int_equal(mesh->report.file_cells, 4);
  assert_int_equal(mesh->report.unused_nodes, 3);
  assert_int_equal(mesh->report.loose_triangles, 2);
  assert_int_equal(mesh->triangle_count, 1);
  const uint32_t source[4] = {1, 3, 4, 6}, tet[4] = {1, 0, 3, 2}, triangle[3] = {1, 0, 3};
  const vsc_array *node = vsc_arrays_find(&mesh->node_data, "n");
  const vsc_array *mark = vsc_arrays_find(&mesh->triangle_data, "mark");
  assert_int_equal(node->tuples, 4);
  assert_int_equal(mark->tuples, 1);
  assert_close(mark->values[0], 11, 0, 0);
  for (int i = 0; i < 4; i++) {
    assert_int_equal(mesh->node_source[i], source[i]);
    assert_int_equal(mesh->corners[i], tet[i]);
    assert_close(node->values[2 * i + 1], 2 * source[i] + 1, 0, 0);
    if (i < 3) assert_int_equal(mesh->triangles[i], triangle[i]);
  }
  assert_close(vsc_mesh_element_volume(mesh, 0), 1. / 6, 1e-15, 0);
  vsc_mesh_free(mesh);
}

static void triangles_out_of_range_are_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = sparse_mesh();
  mesh->triangles[4] = 7;
  vsc_error error;
  assert_int_equal(vsc_mesh_clean(mesh, "m", &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "triangles 1"));
  vsc_mesh_free(mesh);
}

static void arrays_are_found_and_hinted(void **state)
{
  (void)state;
  vsc_arrays arrays = {0};
  char text[256];
  vsc_arrays_hint(&arrays, "fiber", text, sizeof text);
  assert_string_equal(text, ", there are no arrays of that kind");
  assert_non_null(vsc_arrays_add(&arrays, "region", 1, 4));
  vsc_arrays_add(&arrays, "fiber", 3, 4)->values[11] = 5;
  assert_null(vsc_arrays_add(&arrays, "none", 0, 4));
  assert_null(vsc_arrays_add(&arrays, "huge", 3, SIZE_MAX / 2));
  assert_null(vsc_arrays_add(&arrays, "wraps round", 3, SIZE_MAX / 3 + 2));
  assert_int_equal(arrays.count, 2);
  assert_close(vsc_arrays_find(&arrays, "fiber")->values[11], 5, 0, 0);
  assert_null(vsc_arrays_find(&arrays, "fibre"));
  vsc_arrays_hint(&arrays, "fibre", text, sizeof text);
  assert_string_equal(text, ", known arrays: region, fiber; did you mean fiber?");
  vsc_arrays_hint(&arrays, "qqqq", text, sizeof text);
  assert_string_equal(text, ", known arrays: region, fiber");
  vsc_arrays_add(&arrays, "fibre2", 1, 1);
  vsc_arrays_hint(&arrays, "fibres", text, sizeof text);
  assert_non_null(strstr(text, "; did you mean fibre2?"));
  for (int i = 0; i < 40; i++) vsc_arrays_add(&arrays, "another_name", 1, 1);
  for (size_t size = 1; size < sizeof text; size++) {
    vsc_arrays_hint(&arrays, "fibre", text, size);
    assert_true(strlen(text) < size);
    if (size > 80) assert_non_null(strstr(text, "...; did you mean fibre2?"));
  }
  vsc_arrays_free(&arrays);
  assert_int_equal(arrays.count, 0);
}

static void box_and_centre(void **state)
{
  (void)state;
  const int n[3] = {1, 2, 3};
  vsc_mesh *mesh = box_mesh(n, 2, NULL);
  double low[3], high[3], centre[3];
  vsc_mesh_box(mesh, low, high);
  for (int axis = 0; axis < 3; axis++) {
    assert_close(low[axis], 0, 0, 0);
    assert_close(high[axis], 2 * n[axis], 0, 0);
  }
  // Kuhn's first tet: (0 0 0) (2 0 0) (2 2 0) (2 2 2)
  vsc_mesh_element_centre(mesh, 0, centre);
  assert_close(centre[0], 1.5, 0, 1e-15);
  assert_close(centre[1], 1.0, 0, 1e-15);
  assert_close(centre[2], 0.5, 0, 1e-15);
  vsc_mesh_free(mesh);
}

static void short_memory_is_reported(void **state)
{
  (void)state;
  const uint32_t tet[4] = {0, 1, 2, 3};
  for (long after = 0;; after++) {
    vsc_mesh *mesh = NULL;
    vsc_error error = {0};
    vsc_alloc_fail_after(after);
    const vsc_status status = vsc_mesh_from_arrays(5, CORNERS, 1, tet, &mesh, &error);
    vsc_alloc_fail_after(-1);
    if (status == VSC_OK) {
      assert_true(after > 5);
      vsc_mesh_free(mesh);
      return;
    }
    assert_int_equal(status, VSC_SYSTEM);
    assert_non_null(strstr(error.text, "memory"));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(broken_meshes_are_refused_with_ids),
    cmocka_unit_test(a_thin_tet_is_not_degenerate),
    cmocka_unit_test(at_most_five_ids_are_named),
    cmocka_unit_test(a_mesh_without_tets_is_refused),
    cmocka_unit_test(left_handed_tets_are_turned),
    cmocka_unit_test(unused_nodes_are_dropped_with_their_data),
    cmocka_unit_test(triangles_out_of_range_are_refused),
    cmocka_unit_test(arrays_are_found_and_hinted),
    cmocka_unit_test(box_and_centre),
    cmocka_unit_test(short_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
