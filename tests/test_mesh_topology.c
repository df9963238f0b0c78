// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "hybrid_mesh.h"
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

// Gives the nodes other numbers: n becomes (n * factor) mod node_count.
static void renumber(vsc_mesh *mesh, size_t factor)
{
  for (size_t i = 0; i < mesh->start[mesh->element_count]; i++)
    mesh->corners[i] = (uint32_t)(mesh->corners[i] * factor % mesh->node_count);
}

// Against the comparison of all pairs.
static void compare_with_brute_force(vsc_mesh *mesh)
{
  vsc_topology topology;
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 0);
  assert_int_equal(topology.one_sided_faces, 0);
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
}

// The second mesh has more nodes than there are ranges of them, with neighbours in different ones.
static void neighbours_are_those_of_brute_force(void **state)
{
  (void)state;
  for (int large = 0; large < 2; large++) {
    const int n[3] = {large ? 7 : 2, large ? 7 : 3, large ? 8 : 2};
    vsc_mesh *mesh = box_mesh(n, 1, checkerboard);
    if (large) assert_true(mesh->node_count > 256);
    renumber(mesh, large ? 101 : 1);
    compare_with_brute_force(mesh);
    vsc_mesh_free(mesh);
  }
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
  assert_int_equal(topology.crowded_element, 2);
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

// An element pulled through a face, or put on the wrong side of it.
static void folds_are_counted(void **state)
{
  (void)state;
  const double nodes[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0.2, 0.2, 1, 0.3, 0.3, 2};
  for (int order = 0; order < 6; order++) {
    static const uint32_t orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    for (int below = 0; below < 2; below++) {
      double at[15];
      const uint32_t *o = orders[order], tets[] = {0, 1, 2, 3, o[0], o[1], o[2], 4};
      vsc_mesh *mesh;
      vsc_topology topology;
      memcpy(at, nodes, sizeof at);
      if (below) at[14] = -2;
      assert_int_equal(vsc_mesh_from_arrays(5, at, 2, tets, &mesh, NULL), VSC_OK);
      assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
      assert_int_equal(topology.one_sided_faces, !below);
      if (!below) assert_int_equal(topology.one_sided_element, 1);
      vsc_topology_free(&topology);
      vsc_mesh_free(mesh);
    }
  }
}

static int compare_nodes(const void *a, const void *b)
{
  const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

// The nodes of a face in ascending order; of three the last one twice.
static void face_nodes(const vsc_mesh *mesh, size_t element, int face, uint32_t nodes[4])
{
  const int *at = vsc_mesh_kind(mesh, element)->faces[face], corners = at[3] < 0 ? 3 : 4;
  for (int i = 0; i < corners; i++) nodes[i] = vsc_mesh_corners(mesh, element)[at[i]];
  qsort(nodes, (size_t)corners, sizeof *nodes, compare_nodes);
  if (corners == 3) nodes[3] = nodes[2];
}

// All faces of all kinds against all others; every element at each of its nodes.
static void neighbours_in_a_hybrid_mesh(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(4, 0.1, 3);
  vsc_topology topology;
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 0);
  assert_int_equal(topology.one_sided_faces, 0);
  assert_int_equal(topology.node_start[mesh->node_count], mesh->start[mesh->element_count]);
  for (size_t e = 0; e < mesh->element_count; e++) {
    for (int i = 0; i < vsc_mesh_kind(mesh, e)->corners; i++) {
      const uint32_t node = vsc_mesh_corners(mesh, e)[i];
      size_t found = 0;
      for (size_t k = topology.node_start[node]; k < topology.node_start[node + 1]; k++)
        found += topology.node_elements[k] == e;
      assert_int_equal(found, 1);
    }
    for (int f = 0; f < VSC_MOST_FACES; f++) {
      int32_t expected = VSC_OUTSIDE;
      uint32_t nodes[4], others[4];
      if (f < vsc_mesh_kind(mesh, e)->face_count) face_nodes(mesh, e, f, nodes);
      for (size_t o = 0; o < mesh->element_count && f < vsc_mesh_kind(mesh, e)->face_count; o++)
        for (int g = 0; g < vsc_mesh_kind(mesh, o)->face_count && o != e; g++) {
          face_nodes(mesh, o, g, others);
          if (memcmp(nodes, others, sizeof nodes) == 0) expected = (int32_t)o;
        }
      assert_int_equal(topology.neighbours[e][f], expected);
    }
  }
  vsc_topology_free(&topology);
  vsc_mesh_free(mesh);
}

// A hexahedron, and a tet on three nodes of one of its faces.
static void a_split_face_is_told(void **state)
{
  (void)state;
  const uint8_t kinds[2] = {VSC_HEX, VSC_TET};
  vsc_mesh *mesh = vsc_mesh_create_cells(9, 2, kinds, 0);
  for (uint32_t i = 0; i < 8; i++) mesh->corners[i] = i;
  const uint32_t tet[4] = {4, 6, 7, 8};
  memcpy(mesh->corners + 8, tet, sizeof tet);
  vsc_topology topology;
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  for (int f = 0; f < VSC_MOST_FACES; f++) {
    assert_int_equal(topology.neighbours[0][f], f == 5 ? VSC_SPLIT : VSC_OUTSIDE);
    assert_int_equal(topology.neighbours[1][f], VSC_OUTSIDE);
  }
  vsc_topology_free(&topology);
  vsc_mesh_free(mesh);
}

// All nodes shaken, the outer ones too: the boundary still closes. Whatever the corners' order, a
// quadrilateral is cut through its smallest node.
static void quadrilaterals_are_cut_through_their_smallest_node(void **state)
{
  (void)state;
  uint64_t seed = 5;
  vsc_mesh *mesh = hybrid_block(3, 0.1, 8);
  for (size_t i = 0; i < 3 * mesh->node_count; i++)
    mesh->nodes[i] += random_between(&seed, -0.1, 0.1);
  vsc_surface boundary;
  vsc_topology topology;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  double sum[3] = {0};
  for (size_t t = 0; t < boundary.count; t++) {
    const uint32_t *node = boundary.triangles + 3 * t;
    double ab[3], ac[3], normal[3];
    vsc_subtract(mesh->nodes + 3 * (size_t)node[1], mesh->nodes + 3 * (size_t)node[0], ab);
    vsc_subtract(mesh->nodes + 3 * (size_t)node[2], mesh->nodes + 3 * (size_t)node[0], ac);
    vsc_cross(ab, ac, normal);
    for (int k = 0; k < 3; k++) sum[k] += normal[k];
  }
  for (int k = 0; k < 3; k++) assert_close(sum[k], 0, 0, 1e-14);  // areas are about 1
  const uint32_t *triangle = boundary.triangles;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int f = 0; f < vsc_mesh_kind(mesh, e)->face_count; f++) {
      if (topology.neighbours[e][f] >= 0) continue;
      uint32_t nodes[4];
      face_nodes(mesh, e, f, nodes);
      const int pieces = vsc_mesh_kind(mesh, e)->faces[f][3] < 0 ? 1 : 2;
      for (int i = 0; i < pieces; i++, triangle += 3) {
        int held = 0;
        for (int k = 0; k < 3; k++)
          for (int n = 0; n < 4; n++)
            held += triangle[k] == nodes[n] && (n == 0 || nodes[n] != nodes[n - 1]);
        assert_int_equal(held, 3);
        if (pieces == 2) assert_int_equal(triangle[0], nodes[0]);
      }
    }
  assert_ptr_equal(triangle, boundary.triangles + 3 * boundary.count);
  vsc_surface_free(&boundary);
  vsc_topology_free(&topology);
  vsc_mesh_free(mesh);
}

// Faces that have all nodes but one in common are two: the largest, or the smallest among thousands.
static void all_nodes_of_a_face_count(void **state)
{
  (void)state;
  const uint8_t kinds[2] = {VSC_HEX, VSC_HEX};
  vsc_mesh *mesh = vsc_mesh_create_cells(13, 2, kinds, 0);
  uint8_t open[2];
  for (uint32_t i = 0; i < 16; i++) mesh->corners[i] = i < 11 ? i : i - 3;
  for (uint32_t i = 0; i < 3; i++) mesh->corners[8 + i] = i;
  assert_int_equal(vsc_open_faces(mesh, open, NULL), VSC_OK);
  assert_int_equal(open[0], 0x3f);
  assert_int_equal(open[1], 0x3f);
  mesh->corners[11] = 3;
  assert_int_equal(vsc_open_faces(mesh, open, NULL), VSC_OK);
  assert_true(open[0] == open[1] && open[0] != 0x3f);
  vsc_mesh_free(mesh);
  const uint32_t tets[2][8] = {{0, 4000, 4001, 4002, 2, 4000, 4001, 4003}, {0, 4000, 4001, 4002, 0, 4000, 4001, 4003}};
  for (int k = 0; k < 2; k++) {
    mesh = vsc_mesh_create(4096, 2, 0);
    memcpy(mesh->corners, tets[k], sizeof tets[k]);
    assert_int_equal(vsc_open_faces(mesh, open, NULL), VSC_OK);
    assert_true(open[0] == open[1] && (open[0] == 0xf) == (k == 0));
    vsc_mesh_free(mesh);
  }
}

// Of thousands of nodes, numbered anyhow, the faces that are open are those on the sides of the block.
static void large_meshes_have_their_boundary(void **state)
{
  (void)state;
  enum { SIDE = 13 };
  for (int hybrid = 0; hybrid < 2; hybrid++) {
    const int n[3] = {SIDE, SIDE, SIDE};
    vsc_mesh *mesh = hybrid ? hybrid_block(SIDE, 0.1, 4) : box_mesh(n, 1, NULL);
    uint8_t *open = NULL, *on_side = NULL;
    assert_true(mesh->node_count > 2048 && VSC_NEW(open, mesh->element_count) && VSC_NEW(on_side, mesh->node_count));
    const size_t factor = 1777;  // a prime, and no divisor of the number of nodes
    assert_true(mesh->node_count % factor != 0);
    for (size_t i = 0; i < mesh->node_count; i++)
      for (int a = 0; a < 3; a++) {
        const double x = mesh->nodes[3 * i + (size_t)a];
        on_side[i * factor % mesh->node_count] |= (uint8_t)((x < 1e-9) << a | (x > SIDE - 1e-9) << (3 + a));
      }
    renumber(mesh, factor);
    assert_int_equal(vsc_open_faces(mesh, open, NULL), VSC_OK);
    for (size_t e = 0; e < mesh->element_count; e++)
      for (int f = 0; f < vsc_mesh_kind(mesh, e)->face_count; f++) {
        uint32_t nodes[4];
        face_nodes(mesh, e, f, nodes);
        const int side = on_side[nodes[0]] & on_side[nodes[1]] & on_side[nodes[2]] & on_side[nodes[3]];
        assert_int_equal(open[e] >> f & 1, side != 0);
      }
    vsc_free(open);
    vsc_free(on_side);
    vsc_mesh_free(mesh);
  }
}

static void a_surface_is_its_own_boundary(void **state)
{
  (void)state;
  static const uint32_t triangles[6] = {0, 2, 1, 1, 3, 2};
  vsc_mesh *mesh = vsc_mesh_create(4, 0, 2);
  memcpy(mesh->triangles, triangles, sizeof triangles);
  vsc_surface boundary;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(boundary.count, 2);
  assert_memory_equal(boundary.triangles, triangles, sizeof triangles);
  assert_string_equal(boundary.name, "boundary");
  vsc_surface_free(&boundary);
  vsc_alloc_fail_after(0);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_SYSTEM);
  vsc_alloc_fail_after(-1);
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
    cmocka_unit_test(folds_are_counted),
    cmocka_unit_test(neighbours_in_a_hybrid_mesh),
    cmocka_unit_test(a_split_face_is_told),
    cmocka_unit_test(quadrilaterals_are_cut_through_their_smallest_node),
    cmocka_unit_test(all_nodes_of_a_face_count),
    cmocka_unit_test(large_meshes_have_their_boundary),
    cmocka_unit_test(a_surface_is_its_own_boundary),
    cmocka_unit_test(the_boundary_of_a_box_faces_outwards),
    cmocka_unit_test(short_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
