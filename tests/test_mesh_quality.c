// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "box_mesh.h"
#include "close.h"
#include "mesh/quality.h"

static vsc_mesh *one_tet(const double nodes[12])
{
  vsc_mesh *mesh;
  const uint32_t tet[4] = {0, 1, 2, 3};
  assert_int_equal(vsc_mesh_from_arrays(4, nodes, 1, tet, &mesh, NULL), VSC_OK);
  return mesh;
}

static void a_regular_tet_is_perfect(void **state)
{
  (void)state;
  const double nodes[12] = {1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1};
  vsc_mesh *mesh = one_tet(nodes);
  const vsc_element_quality quality = vsc_mesh_element_quality(mesh, 0);
  assert_close(quality.shape, 1, 1e-14, 0);
  assert_close(quality.min_dihedral, acos(1. / 3) * 180 / M_PI, 1e-13, 0);
  assert_close(quality.max_dihedral, acos(1. / 3) * 180 / M_PI, 1e-13, 0);
  assert_close(quality.edge_ratio, 1, 1e-14, 0);
  assert_close(quality.volume, 8. / 3, 1e-14, 0);
  vsc_mesh_free(mesh);
}

// The corner of a cube: right angles at the legs, acos(1/sqrt 3) at the hypotenuses.
static void a_corner_tet_by_hand(void **state)
{
  (void)state;
  const double nodes[12] = {0, 0, 0, 2, 0, 0, 0, 2, 0, 0, 0, 2};
  vsc_mesh *mesh = one_tet(nodes);
  const vsc_element_quality quality = vsc_mesh_element_quality(mesh, 0);
  assert_close(quality.shape, 12 * pow(4, 2. / 3) / (3 * 4 + 3 * 8), 1e-14, 0);
  assert_close(quality.min_dihedral, acos(1 / sqrt(3)) * 180 / M_PI, 1e-13, 0);
  assert_close(quality.max_dihedral, 90, 1e-13, 0);
  assert_close(quality.edge_ratio, sqrt(2), 1e-14, 0);
  vsc_mesh_free(mesh);
}

static void a_flat_tet_is_bad(void **state)
{
  (void)state;
  const double nodes[12] = {-1, 0, 0, 1, 0, 0, 0, -1, 1e-4, 0, 1, 1e-4};
  vsc_mesh *mesh = one_tet(nodes);
  const vsc_element_quality quality = vsc_mesh_element_quality(mesh, 0);
  assert_true(quality.shape < 0.01);
  assert_true(quality.min_dihedral < 0.02);
  assert_true(quality.max_dihedral > 179.98);
  vsc_mesh_free(mesh);
}

// Seven stretched cubes' worth of tets, some squeezed: the worst are those of a full sort.
static void the_worst_are_found_in_order(void **state)
{
  (void)state;
  const int n[3] = {3, 3, 3};
  vsc_mesh *mesh = box_mesh(n, 1, NULL);
  for (size_t i = 0; i < mesh->node_count; i++) mesh->nodes[3 * i] *= 1 + 0.05 * (double)i;
  for (size_t t = 0; t < mesh->element_count; t++) mesh->element_source[t] = (uint32_t)(1000 + t);
  vsc_quality_summary summary;
  assert_int_equal(vsc_mesh_quality(mesh, &summary, NULL), VSC_OK);
  assert_int_equal(summary.element_count, mesh->element_count);
  assert_int_equal(summary.worst_count, VSC_WORST_ELEMENTS);
  double sum = 0, volume = 0, last = 0;
  size_t poor = 0;
  for (size_t t = 0; t < mesh->element_count; t++) {
    const vsc_element_quality quality = vsc_mesh_element_quality(mesh, t);
    sum += quality.shape;
    volume += quality.volume;
    poor += quality.shape < 0.2;
    assert_true(quality.min_dihedral >= summary.min_dihedral);
    assert_true(quality.max_dihedral <= summary.max_dihedral);
    assert_true(quality.edge_ratio <= summary.max_edge_ratio);
    assert_true(quality.volume >= summary.min_volume && quality.volume <= summary.max_volume);
  }
  assert_close(summary.shape_mean, sum / (double)mesh->element_count, 1e-13, 0);
  assert_close(summary.volume, volume, 1e-13, 0);
  assert_int_equal(summary.poor, poor);
  for (size_t k = 0; k < VSC_WORST_ELEMENTS; k++) {
    const size_t tet = summary.worst_element[k];
    const double ratio = vsc_mesh_element_quality(mesh, tet).shape;
    double centre[3];
    vsc_mesh_element_centre(mesh, tet, centre);
    size_t below = 0;
    for (size_t t = 0; t < mesh->element_count; t++)
      below += vsc_mesh_element_quality(mesh, t).shape < ratio;
    assert_true(below <= k);
    assert_true(ratio >= last);
    assert_int_equal(summary.worst_source[k], 1000 + tet);
    assert_memory_equal(summary.worst_centre[k], centre, sizeof centre);
    assert_close(summary.worst[k].shape, ratio, 0, 0);
    for (size_t l = 0; l < k; l++) assert_int_not_equal(summary.worst_element[l], tet);
    last = ratio;
  }
  assert_true(summary.shape_p5 > summary.worst[4].shape);
  assert_true(summary.shape_p5 < summary.shape_mean);
  vsc_mesh_free(mesh);
}

static void edges_and_few_tets(void **state)
{
  (void)state;
  const double nodes[12] = {0, 0, 0, 2, 0, 0, 0, 3, 0, 0, 0, 6};
  vsc_mesh *mesh = one_tet(nodes);
  vsc_quality_summary summary;
  assert_int_equal(vsc_mesh_quality(mesh, &summary, NULL), VSC_OK);
  assert_int_equal(summary.worst_count, 1);
  assert_close(summary.shortest_edge, 2, 1e-15, 0);
  assert_close(summary.longest_edge, sqrt(45), 1e-15, 0);
  assert_close(summary.min_volume, 6, 1e-15, 0);
  assert_close(summary.shape_p5, summary.worst[0].shape, 0, 0);
  vsc_alloc_fail_after(0);
  assert_int_equal(vsc_mesh_quality(mesh, &summary, NULL), VSC_SYSTEM);
  mesh->element_count = 0;
  assert_int_equal(vsc_mesh_quality(mesh, &summary, NULL), VSC_OK);
  assert_int_equal(summary.worst_count, 0);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_regular_tet_is_perfect),
    cmocka_unit_test(a_corner_tet_by_hand),
    cmocka_unit_test(a_flat_tet_is_bad),
    cmocka_unit_test(the_worst_are_found_in_order),
    cmocka_unit_test(edges_and_few_tets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
