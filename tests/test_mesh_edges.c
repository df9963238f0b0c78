// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/mem.h"
#include "close.h"
#include "mesh/edges.h"

// Three triangles, of which 0 and 1 share the edge 2 5, and 2 passes the edge 1 5 of 1 the same way.
static void sides_of_one_edge_follow_one_another(void **state)
{
  (void)state;
  const uint32_t corners[] = {9, 5, 2, 0, 2, 5, 1, 0, 1, 7, 5, 0};  // four numbers a triangle
  const vsc_side wanted[] = {{1, 2, 1, 2, 1}, {1, 5, 1, 1, 0}, {1, 5, 2, 2, 0}, {1, 7, 2, 0, 1}, {2, 5, 0, 1, 0}, {2, 5, 1, 0, 1}};
  vsc_side *sides;
  vsc_error error;
  assert_int_equal(vsc_sides_list(corners, 4, 3, &sides, &error), VSC_OK);
  size_t edges = 0, end = 0;
  for (size_t first = 0; first < 9; first = end, edges++) {
    end = vsc_sides_end(sides, 9, first);
    assert_true(end > first && end <= 9);
    for (size_t k = first + 1; k < end; k++) {
      assert_true(sides[k].low == sides[first].low && sides[k].high == sides[first].high);
      assert_true(sides[k].triangle > sides[k - 1].triangle);
    }
    assert_true(end == 9 || sides[end].low > sides[first].low || sides[end].high > sides[first].high);
  }
  assert_int_equal(edges, 7);
  assert_memory_equal(sides, wanted, sizeof wanted);
  vsc_free(sides);
}

static void no_triangles_have_no_sides(void **state)
{
  (void)state;
  vsc_side *sides;
  assert_int_equal(vsc_sides_list(NULL, 3, 0, &sides, NULL), VSC_OK);
  vsc_free(sides);
}

// Two quadratic tets on the edge 0 1, which both or the second alone have 9 in its middle.
static void middles_that_are_apart_are_told(void **state)
{
  (void)state;
  const uint8_t kinds[2] = {VSC_TET10, VSC_TET10};
  for (int same = 0; same < 2; same++) {
    const uint32_t corners[20] = {0, 1, 2, 3, same ? 9 : 10, 11, 12, 13, 14, 15, 1, 0, 4, 5, 9, 16, 17, 18, 19, 20};
    vsc_mesh *mesh = vsc_mesh_create_cells(21, 2, kinds, 0);
    vsc_edges edges;
    for (int i = 0; i < 20; i++) mesh->corners[i] = corners[i];
    assert_int_equal(vsc_edges_list(mesh, &edges, NULL), VSC_OK);
    assert_int_equal(edges.count, 11);
    assert_int_equal(edges.apart, !same);
    assert_int_equal(vsc_edges_find(&edges, 1, 0)->middle, 9);  // the smaller one
    vsc_edges_free(&edges);
    vsc_mesh_free(mesh);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sides_of_one_edge_follow_one_another),
      cmocka_unit_test(no_triangles_have_no_sides),
      cmocka_unit_test(middles_that_are_apart_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
