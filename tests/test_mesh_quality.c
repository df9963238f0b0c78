// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "box_mesh.h"
#include "close.h"
#include "hybrid_mesh.h"
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

static vsc_element_quality quality_of(vsc_cell kind, const double (*at)[3])
{
  const uint8_t kinds[1] = {(uint8_t)kind};
  const size_t corners = (size_t)vsc_cells[kind].corners;
  vsc_mesh *mesh = vsc_mesh_create_cells(corners, 1, kinds, 0);
  memcpy(mesh->nodes, at, 3 * corners * sizeof(double));
  for (size_t i = 0; i < corners; i++) mesh->corners[i] = (uint32_t)i;
  const vsc_element_quality quality = vsc_mesh_element_quality(mesh, 0);
  vsc_mesh_free(mesh);
  return quality;
}

static const double CUBE[8][3] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0},
                                  {0, 0, 2}, {2, 0, 2}, {2, 2, 2}, {0, 2, 2}};

// With equal edges every kind is perfect; the angles between faces are those of the cube, of the
// prism on a regular triangle and of half an octahedron.
static void elements_with_equal_edges_are_perfect(void **state)
{
  (void)state;
  const double h = sqrt(3) / 2, top = sqrt(0.5);
  const double wedge[6][3] = {{0, 0, 0}, {1, 0, 0}, {0.5, h, 0}, {0, 0, 1}, {1, 0, 1}, {0.5, h, 1}};
  const double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, top}};
  const struct {
    vsc_cell kind;
    const double (*at)[3];
    double min_dihedral, max_dihedral, volume;
  } rows[] = {{VSC_HEX, CUBE, 90, 90, 8},
              {VSC_WEDGE, wedge, 60, 90, h / 2},
              {VSC_PYRAMID, pyramid, acos(1 / sqrt(3)) * 180 / M_PI, acos(-1. / 3) * 180 / M_PI,
               top / 3}};
  for (int r = 0; r < 3; r++) {
    const vsc_element_quality quality = quality_of(rows[r].kind, rows[r].at);
    assert_close(quality.shape, 1, 1e-14, 0);
    assert_close(quality.min_dihedral, rows[r].min_dihedral, 1e-13, 0);
    assert_close(quality.max_dihedral, rows[r].max_dihedral, 1e-13, 0);
    assert_close(quality.edge_ratio, 1, 1e-14, 0);
    assert_close(quality.volume, rows[r].volume, 1e-14, 0);
  }
}

static void bent_elements_by_hand(void **state)
{
  (void)state;
  // sheared by 1 in 1: at each corner two edges at 45 degrees, the third across
  double at[8][3];
  memcpy(at, CUBE, sizeof at);
  for (int i = 4; i < 8; i++) at[i][0] += 2;
  vsc_element_quality quality = quality_of(VSC_HEX, (const double(*)[3])at);
  assert_close(quality.shape, sqrt(0.5), 1e-14, 0);
  assert_close(quality.min_dihedral, 45, 1e-13, 0);
  assert_close(quality.max_dihedral, 135, 1e-13, 0);
  assert_close(quality.edge_ratio, sqrt(2), 1e-14, 0);
  // one corner pulled through the plane of its neighbours
  memcpy(at, CUBE, sizeof at);
  for (int k = 0; k < 3; k++) at[6][k] = 1;
  quality = quality_of(VSC_HEX, (const double(*)[3])at);
  assert_true(quality.volume > 0 && quality.shape < -0.3);
  // half a cube: 45 degrees, of 60
  const double wedge[6][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  quality = quality_of(VSC_WEDGE, wedge);
  assert_close(quality.shape, sqrt(2. / 3), 1e-14, 0);
  assert_close(quality.min_dihedral, 45, 1e-13, 0);
  // a steeple: at the apex u / (u^2 + 1/2)^(3/2) of u = height over side, over sin 45
  double pyramid[5][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 3}};
  quality = quality_of(VSC_PYRAMID, (const double(*)[3])pyramid);
  assert_close(quality.shape, 3 / pow(9.5, 1.5) * sqrt(2), 1e-14, 0);
  // a flat one: at the base
  pyramid[4][2] = 0.1;
  quality = quality_of(VSC_PYRAMID, (const double(*)[3])pyramid);
  assert_close(quality.shape, 0.1 / sqrt(0.51) * sqrt(2), 1e-13, 0);
}

// An element whose corners are numbered from another one on is the same element.
static void numbering_does_not_count(void **state)
{
  (void)state;
  static const int next[VSC_CELLS][8] = {[VSC_HEX] = {1, 2, 3, 0, 5, 6, 7, 4},
                                         [VSC_WEDGE] = {1, 2, 0, 4, 5, 3},
                                         [VSC_PYRAMID] = {1, 2, 3, 0, 4}};
  static const double at[VSC_CELLS][8][3] = {
      [VSC_HEX] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                   {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      [VSC_WEDGE] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
      [VSC_PYRAMID] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 2}}};
  uint64_t seed = 6;
  for (int round = 0; round < 200; round++) {
    const vsc_cell kind = (vsc_cell)(1 + round % 3);
    double shaken[8][3], renumbered[8][3];
    for (int i = 0; i < 8; i++)
      for (int k = 0; k < 3; k++)
        shaken[i][k] = at[kind][i][k] + random_between(&seed, -0.2, 0.2);
    for (int i = 0; i < 8; i++) memcpy(renumbered[i], shaken[next[kind][i]], sizeof renumbered[i]);
    const vsc_element_quality one = quality_of(kind, (const double(*)[3])shaken);
    const vsc_element_quality other = quality_of(kind, (const double(*)[3])renumbered);
    assert_close(other.shape, one.shape, 0, 1e-14);
    assert_close(other.min_dihedral, one.min_dihedral, 0, 1e-12);
    assert_close(other.max_dihedral, one.max_dihedral, 0, 1e-12);
    assert_close(other.edge_ratio, one.edge_ratio, 1e-15, 0);
    assert_close(other.volume, one.volume, 1e-14, 0);
  }
}

// Each kind counts alike in the summary; turned and enlarged, all shapes are the same.
static void a_hybrid_mesh_is_summarised(void **state)
{
  (void)state;
  uint64_t seed = 9;
  double R[9];
  random_rotation(&seed, R);
  vsc_mesh *mesh = hybrid_block(3, 0.2, 4), *turned = hybrid_block(3, 0.2, 4);
  for (size_t i = 0; i < mesh->node_count; i++) {
    rotate_vector(R, mesh->nodes + 3 * i, turned->nodes + 3 * i);
    for (int k = 0; k < 3; k++) turned->nodes[3 * i + (size_t)k] = 7 * turned->nodes[3 * i + (size_t)k] + 40;
  }
  vsc_quality_summary summary;
  assert_int_equal(vsc_mesh_quality(mesh, &summary, NULL), VSC_OK);
  double sum = 0, least = 1;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_element_quality one = vsc_mesh_element_quality(mesh, e);
    const vsc_element_quality other = vsc_mesh_element_quality(turned, e);
    // places of about 60, rounded to 1e-14, against edges of 7
    assert_close(other.shape, one.shape, 0, 1e-13);
    assert_close(other.volume, 343 * one.volume, 0, 1e-11);
    assert_close(other.min_dihedral, one.min_dihedral, 0, 1e-11);
    assert_close(other.max_dihedral, one.max_dihedral, 0, 1e-11);
    assert_true(one.shape > 0 && one.shape < 1);
    sum += one.shape;
    least = fmin(least, one.shape);
  }
  assert_close(summary.shape_mean, sum / (double)mesh->element_count, 1e-14, 0);
  assert_close(summary.worst[0].shape, least, 0, 0);
  assert_close(summary.volume, 27, 1e-14, 0);
  vsc_mesh_free(mesh);
  vsc_mesh_free(turned);
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
    cmocka_unit_test(elements_with_equal_edges_are_perfect),
    cmocka_unit_test(bent_elements_by_hand),
    cmocka_unit_test(numbering_does_not_count),
    cmocka_unit_test(a_hybrid_mesh_is_summarised),
    cmocka_unit_test(the_worst_are_found_in_order),
    cmocka_unit_test(edges_and_few_tets),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
