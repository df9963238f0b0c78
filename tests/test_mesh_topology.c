// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "mesh/select.h"
#include "mesh/topology.h"

static int checkerboard(int i, int j, int k)
{
  return (i + j + k) % 2 == 0;
}

// Nodes that two tets share.
static int shared_nodes(const uint32_t a[4], const uint32_t b[4])
{
  int shared = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 4; j++) shared += a[i] == b[j];
  return shared;
}

static void every_tet_is_listed_at_its_nodes(void **state)
{
  (void)state;
  const int n[3] = {3, 2, 4};
  vsc_mesh *mesh = box_mesh(n, 1, NULL);
  vsc_topology topology;
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.node_start[0], 0);
  assert_int_equal(topology.node_start[mesh->node_count], 4 * mesh->element_count);
  for (size_t i = 0; i < mesh->node_count; i++)
    for (size_t k = topology.node_start[i]; k < topology.node_start[i + 1]; k++) {
      const uint32_t *tet = mesh->corners + 4 * (size_t)topology.node_elements[k];
      assert_true(tet[0] == i || tet[1] == i || tet[2] == i || tet[3] == i);
      if (k > topology.node_start[i])
        assert_true(topology.node_elements[k] > topology.node_elements[k - 1]);
    }
  vsc_topology_free(&topology);
  vsc_mesh_free(mesh);
}

// Against the comparison of all pairs.
static void neighbours_are_those_of_brute_force(void **state)
{
  (void)state;
  const int n[3] = {2, 3, 2};
  vsc_mesh *mesh = box_mesh(n, 1, checkerboard);
  vsc_topology topology;
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 0);
  for (size_t t = 0; t < mesh->element_count; t++)
    for (int i = 0; i < 4; i++) {
      const uint32_t *tet = mesh->corners + 4 * t;
      int32_t expected = -1;
      for (size_t o = 0; o < mesh->element_count; o++) {
        const uint32_t *other = mesh->corners + 4 * o;
        const int has_corner = other[0] == tet[i] || other[1] == tet[i] || other[2] == tet[i] ||
                               other[3] == tet[i];
        if (o != t && shared_nodes(tet, other) == 3 && !has_corner) expected = (int32_t)o;
      }
      assert_int_equal(topology.neighbours[t][i], expected);
    }
  vsc_topology_free(&topology);
  vsc_mesh_free(mesh);
}

static void overlapping_tets_are_counted(void **state)
{
  (void)state;
  const double nodes[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 2, 0, 0, -1};
  const uint32_t tets[] = {0, 1, 2, 3, 0, 1, 2, 4, 0, 1, 2, 5};
  vsc_mesh *mesh;
  assert_int_equal(vsc_mesh_from_arrays(6, nodes, 3, tets, &mesh, NULL), VSC_OK);
  vsc_topology topology;
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 1);
  int inside = 0;
  for (int t = 0; t < 3; t++)
    for (int i = 0; i < 4; i++) {
      if (topology.neighbours[t][i] < 0) continue;
      assert_int_equal(topology.neighbours[t][i], (t + 1) % 3);
      inside++;
    }
  assert_int_equal(inside, 3);
  vsc_topology_free(&topology);
  vsc_mesh_free(mesh);
}

static void the_boundary_of_a_box_faces_outwards(void **state)
{
  (void)state;
  const int n[3] = {3, 2, 4};
  vsc_mesh *mesh = box_mesh(n, 1, NULL);
  vsc_surface boundary;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(boundary.count, 2 * 2 * (3 * 2 + 2 * 4 + 4 * 3));
  assert_string_equal(boundary.name, "boundary");
  for (size_t t = 0; t < boundary.count; t++) {
    const double *corner[3];
    double ab[3], ac[3], normal[3];
    int axis = -1;
    for (int i = 0; i < 3; i++) corner[i] = mesh->nodes + 3 * (size_t)boundary.triangles[3 * t + i];
    vsc_subtract(corner[1], corner[0], ab);
    vsc_subtract(corner[2], corner[0], ac);
    vsc_cross(ab, ac, normal);
    for (int i = 0; i < 3; i++)
      if (fabs(normal[i]) > 0.5) axis = i;
    assert_true(axis >= 0);
    assert_close(corner[0][axis], normal[axis] > 0 ? n[axis] : 0, 0, 0);
  }
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

static void short_memory_is_reported(void **state)
{
  (void)state;
  const int n[3] = {1, 1, 1};
  vsc_mesh *mesh = box_mesh(n, 1, NULL);
  for (long after = 0; after < 4; after++) {
    vsc_surface boundary;
    vsc_error error;
    vsc_alloc_fail_after(after);
    assert_int_equal(vsc_boundary(mesh, &boundary, &error), VSC_SYSTEM);
    vsc_alloc_fail_after(-1);
    assert_int_equal(boundary.count, 0);
  }
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_tet_is_listed_at_its_nodes),
    cmocka_unit_test(neighbours_are_those_of_brute_force),
    cmocka_unit_test(overlapping_tets_are_counted),
    cmocka_unit_test(the_boundary_of_a_box_faces_outwards),
    cmocka_unit_test(short_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
