// SPDX-License-Identifier: GPL-3.0-or-later
// Blocks of hexahedra, wedges, all kinds, and of unstructured tets.
#include "close.h"

#include <string.h>

#include "mesh/quality.h"
#include "mesh/select.h"
#include "mesh/topology.h"
#include "tools/shapes_block.h"
#include "tools/shapes_cloud.h"

// A sound mesh of the box: it is filled, neighbours fit, its surface is that of a ball, and the
// arrays mark the nodes on the faces.
static void is_a_box(const vsc_mesh *mesh, const double size[3])
{
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    assert_true(vsc_mesh_element_volume(mesh, e) > 0);
    volume += vsc_mesh_element_volume(mesh, e);
  }
  assert_close(volume, size[0] * size[1] * size[2], 1e-10, 0);
  vsc_topology topology = {0};
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 0);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int f = 0; f < VSC_MOST_FACES; f++)
      assert_int_not_equal(topology.neighbours[e][f], VSC_SPLIT);
  vsc_topology_free(&topology);
  vsc_surface boundary = {.count = 0};
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  size_t outside = 0;
  for (size_t i = 0; i < mesh->node_count; i++) {
    bool on_face = false;
    for (size_t a = 0; a < 6; a++) {
      const double at = mesh->nodes[3 * i + a / 2], plane = a % 2 == 0 ? 0 : size[a / 2];
      assert_int_equal(mesh->node_data.items[a].values[i], at == plane);
      on_face = on_face || at == plane;
    }
    outside += on_face;
  }
  assert_int_equal(boundary.count, 2 * outside - 4);
  vsc_surface_free(&boundary);
  for (size_t e = 0; e < mesh->element_count; e++)
    assert_int_equal(vsc_arrays_find(&mesh->element_data, "region")->values[e], 1);
}

static void blocks_of_all_kinds(void **state)
{
  (void)state;
  const size_t bricks = 5 * 3 * 4, across = 3 * 4;
  const size_t expected[4][VSC_CELLS] = {[VSC_BLOCK_TETS] = {5 * bricks},
                                         [VSC_BLOCK_HEXES] = {[VSC_HEX] = bricks},
                                         [VSC_BLOCK_WEDGES] = {[VSC_WEDGE] = 2 * bricks},
                                         [VSC_BLOCK_MIXED] = {[VSC_TET] = (2 + 6 * 2) * across,
                                                              [VSC_HEX] = across,
                                                              [VSC_WEDGE] = 2 * across,
                                                              [VSC_PYRAMID] = 5 * across}};
  for (int kind = 0; kind < 4; kind++)
    for (int jittered = 0; jittered < 2; jittered++) {
      vsc_block_shape shape = {
          .cells = {5, 3, 4}, .size = {10, 5, 8}, .tets_per_cell = 5, .seed = 2};
      shape.jitter = 0.2 * jittered;
      vsc_mesh *mesh = NULL;
      size_t count[VSC_CELLS] = {0};
      assert_int_equal(vsc_block_of(&shape, (vsc_block_kind)kind, &mesh, NULL), VSC_OK);
      is_a_box(mesh, shape.size);
      for (size_t e = 0; e < mesh->element_count; e++) count[mesh->kinds[e]]++;
      size_t moved = 0;  // along x, of the grid's inner nodes
      for (size_t n = 0; n < 6 * 4 * 5; n++) moved += fabs(remainder(mesh->nodes[3 * n], 2)) > 1e-9;
      assert_int_equal(moved, jittered * 4 * 2 * 3);
      assert_memory_equal(count, expected[kind], sizeof count);
      assert_int_equal(mesh->node_count, 6 * 4 * 5 + (kind == VSC_BLOCK_MIXED ? across : 0));
      vsc_mesh_free(mesh);
    }
}

static void too_thin_to_be_mixed(void **state)
{
  (void)state;
  vsc_block_shape shape = vsc_block_default();
  shape.cells[0] = 3;
  vsc_mesh *mesh = NULL;
  vsc_error error;
  assert_int_equal(vsc_block_of(&shape, VSC_BLOCK_MIXED, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "at least 4"));
  shape.cells[0] = 0;
  assert_int_equal(vsc_block_of(&shape, VSC_BLOCK_HEXES, &mesh, &error), VSC_INPUT);
}

static void scattered_points_fill_the_box(void **state)
{
  (void)state;
  static const vsc_cloud_shape shapes[] = {
      {{10, 10, 10}, 222, 29}, {{10, 10, 20}, 300, 4}, {{1, 30, 2}, 150, 5}, {{1, 1, 1}, 9, 6}};
  for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
    vsc_mesh *mesh = NULL, *again = NULL;
    vsc_error error = {.text = ""};
    if (vsc_cloud_mesh(&shapes[k], &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
    assert_int_equal(mesh->node_count, shapes[k].points);
    is_a_box(mesh, shapes[k].size);
    assert_int_equal(vsc_cloud_mesh(&shapes[k], &again, NULL), VSC_OK);
    assert_int_equal(again->element_count, mesh->element_count);
    assert_memory_equal(again->corners, mesh->corners, 4 * mesh->element_count * sizeof(uint32_t));
    assert_memory_equal(again->nodes, mesh->nodes, 3 * mesh->node_count * sizeof(double));
    vsc_mesh_free(again);
    vsc_mesh_free(mesh);
  }
}

static void nonsense_is_refused(void **state)
{
  (void)state;
  static const vsc_cloud_shape shapes[] = {{{10, 0, 10}, 222, 1},
                                           {{10, 10, INFINITY}, 222, 1},
                                           {{10, 10, 10}, 8, 1},
                                           {{10, 10, 10}, 200000, 1}};
  for (size_t k = 0; k < sizeof shapes / sizeof shapes[0]; k++) {
    vsc_mesh *mesh = NULL;
    vsc_error error;
    assert_int_equal(vsc_cloud_mesh(&shapes[k], &mesh, &error), VSC_INPUT);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(blocks_of_all_kinds),
      cmocka_unit_test(too_thin_to_be_mixed),
      cmocka_unit_test(scattered_points_fill_the_box),
      cmocka_unit_test(nonsense_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
