// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "mesh/surface.h"
#include "octahedron.h"

static const int SIZE[3] = {5, 5, 5};

// A block of 5 x 5 x 5 cubes with cubes cut out.
static int cup(int i, int j, int k)  // open at the top
{
  return i == 0 || i == 4 || j == 0 || j == 4 || k == 0;
}

static int hollow(int i, int j, int k)
{
  return cup(i, j, k) || k == 4;
}

static int tube(int i, int j, int k)  // open at both ends
{
  (void)k;
  return i == 0 || i == 4 || j == 0 || j == 4;
}

static int two_wells(int i, int j, int k)  // two shafts that touch along the edge (2 2 z)
{
  (void)k;
  return !(i == 1 && j == 1) && !(i == 2 && j == 2);
}

// The boundary's triangles that lie strictly inside the outer planes of the box: the cavity's wall.
static vsc_surface inner_wall(const vsc_mesh *mesh)
{
  vsc_surface boundary;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  size_t kept = 0;
  for (size_t t = 0; t < boundary.count; t++) {
    double centre[3] = {0};
    for (int i = 0; i < 3; i++)
      for (int axis = 0; axis < 3; axis++)
        centre[axis] += mesh->nodes[3 * (size_t)boundary.triangles[3 * t + i] + axis] / 3;
    int inside = 1;
    for (int axis = 0; axis < 3; axis++) inside &= centre[axis] > 1e-9 && centre[axis] < 5 - 1e-9;
    if (inside)
      memmove(boundary.triangles + 3 * kept++, boundary.triangles + 3 * t,
              3 * sizeof *boundary.triangles);
  }
  boundary.count = kept;
  return boundary;
}

static void check_cavity(int (*solid)(int, int, int), size_t rims, double volume)
{
  vsc_mesh *mesh = box_mesh(SIZE, 1, solid);
  vsc_surface wall = inner_wall(mesh);
  vsc_cavity cavity;
  assert_int_equal(vsc_cavity_make(&wall, mesh->node_count, &cavity, NULL), VSC_OK);
  assert_int_equal(cavity.rim_count, rims);
  assert_close(vsc_cavity_volume(&cavity, mesh->nodes, 3), volume, 1e-13, 0);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&wall);
  vsc_mesh_free(mesh);
}

static void cavities_of_known_volume(void **state)
{
  (void)state;
  check_cavity(hollow, 0, 27);
  check_cavity(cup, 1, 36);
  check_cavity(tube, 2, 45);
}

// The two shafts share an edge of four triangles; at each end their rims touch in one node.
static void touching_rims_are_taken_apart(void **state)
{
  (void)state;
  check_cavity(two_wells, 4, 10);
}

static void the_whole_boundary_encloses_minus_the_tissue(void **state)
{
  (void)state;
  vsc_mesh *mesh = box_mesh(SIZE, 1, two_wells);
  vsc_surface boundary;
  vsc_cavity cavity;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_cavity_make(&boundary, mesh->node_count, &cavity, NULL), VSC_OK);
  assert_int_equal(cavity.rim_count, 0);
  assert_close(vsc_cavity_volume(&cavity, mesh->nodes, 3), -(125 - 10), 1e-13, 0);
  assert_close(vsc_surface_area(&boundary, mesh->nodes, 3), 6 * 25 - 4 + 2 * 4 * 5, 1e-13, 0);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

// Any affine map multiplies the volume by its determinant, caps included, wherever it moves to.
static void volume_follows_affine_maps(void **state)
{
  (void)state;
  srand(5);
  vsc_mesh *mesh = box_mesh(SIZE, 1, cup);
  vsc_surface wall = inner_wall(mesh);
  vsc_cavity cavity;
  assert_int_equal(vsc_cavity_make(&wall, mesh->node_count, &cavity, NULL), VSC_OK);
  double *moved;
  assert_true(VSC_NEW(moved, 4 * mesh->node_count));
  for (int round = 0; round < 50; round++) {
    double a[3][3], far[3], cross[3];
    for (int r = 0; r < 3; r++) {
      far[r] = round == 0 ? 0 : 1e4 * rand() / RAND_MAX;
      for (int c = 0; c < 3; c++) a[r][c] = (r == c) + 1.0 * rand() / RAND_MAX - 0.5;
    }
    for (size_t i = 0; i < mesh->node_count; i++) {
      for (int r = 0; r < 3; r++) moved[4 * i + r] = far[r] + vsc_dot(a[r], mesh->nodes + 3 * i);
      moved[4 * i + 3] = NAN;
    }
    vsc_cross(a[1], a[2], cross);
    assert_close(vsc_cavity_volume(&cavity, moved, 4), 36 * vsc_dot(a[0], cross), 1e-9, 1e-9);
  }
  vsc_free(moved);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&wall);
  vsc_mesh_free(mesh);
}

// The cap moves with its rim: lifting a flat rim of area 9 by 1 adds 9.
static void the_cap_moves_with_its_rim(void **state)
{
  (void)state;
  vsc_mesh *mesh = box_mesh(SIZE, 1, cup);
  vsc_surface wall = inner_wall(mesh);
  vsc_cavity cavity;
  assert_int_equal(vsc_cavity_make(&wall, mesh->node_count, &cavity, NULL), VSC_OK);
  assert_int_equal(cavity.rim_start[1], 12);
  for (size_t k = 0; k < 12; k++) {
    assert_close(mesh->nodes[3 * (size_t)cavity.rim_nodes[k] + 2], 5, 0, 0);
    mesh->nodes[3 * (size_t)cavity.rim_nodes[k] + 2] = 6;
  }
  assert_close(vsc_cavity_volume(&cavity, mesh->nodes, 3), 45, 1e-13, 0);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&wall);
  vsc_mesh_free(mesh);
}

// Random triangles on few nodes: edges of every multiplicity. Whatever comes out, the rims close
// the surface, which shows in a volume that does not change with translation.
static void any_triangles_can_be_closed(void **state)
{
  (void)state;
  srand(7);
  for (int round = 0; round < 2000; round++) {
    enum { NODES = 12 };
    uint32_t triangles[60];
    double x[3 * NODES], shifted[3 * NODES];
    vsc_surface surface = {.name = "random", .count = 1 + (size_t)rand() % 20,
                           .triangles = triangles};
    for (size_t i = 0; i < 60; i++) triangles[i] = (uint32_t)rand() % NODES;
    for (size_t i = 0; i < 3 * NODES; i++) {
      x[i] = 1.0 * rand() / RAND_MAX;
      shifted[i] = x[i];
    }
    vsc_cavity cavity;
    assert_int_equal(vsc_cavity_make(&surface, NODES, &cavity, NULL), VSC_OK);
    for (size_t rim = 0; rim < cavity.rim_count; rim++) {
      for (size_t k = cavity.rim_start[rim]; k < cavity.rim_start[rim + 1]; k++)
        for (size_t l = cavity.rim_start[rim]; l < k; l++)
          assert_int_not_equal(cavity.rim_nodes[k], cavity.rim_nodes[l]);
    }
    const double volume = vsc_cavity_volume(&cavity, x, 3);
    // Another origin of the sum: the first triangle's corners in another order, and last.
    uint32_t first[3];
    uint32_t *corners = cavity.facets.corners, *last = corners + 3 * (cavity.facets.count - 1);
    memcpy(first, corners, sizeof first);
    memmove(corners, corners + 3, (size_t)((char *)last - (char *)corners));
    memcpy(last, first, sizeof first);
    for (size_t i = 0; i < 3 * NODES; i++) shifted[i] += 100;
    assert_close(vsc_cavity_volume(&cavity, shifted, 3), volume, 1e-10, 1e-10);
    vsc_cavity_free(&cavity);
  }
}

static void bad_surfaces_are_refused(void **state)
{
  (void)state;
  uint32_t triangle[3] = {0, 1, 2};
  vsc_surface surface = {.name = "endo", .count = 1, .triangles = triangle};
  vsc_cavity cavity;
  vsc_error error;
  assert_int_equal(vsc_cavity_make(&surface, 2, &cavity, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "surface endo: triangle 0 names node 2"));
  surface.count = 0;
  assert_int_equal(vsc_cavity_make(&surface, 3, &cavity, &error), VSC_INPUT);
  surface.count = 1;
  for (long after = 0; after < 8; after++) {
    vsc_alloc_fail_after(after);
    assert_int_equal(vsc_cavity_make(&surface, 3, &cavity, &error), VSC_SYSTEM);
    vsc_alloc_fail_after(-1);
    assert_null(cavity.facets.corners);
  }
}

// Puts the middles of a face's edges into the plane of its corners.
static void flatten_face(octahedron *o, int face)
{
  double a[3], b[3], n[3];
  const uint32_t *node = o->triangles + 3 * face;
  vsc_subtract(o->x + 4 * node[1], o->x + 4 * node[0], a);
  vsc_subtract(o->x + 4 * node[2], o->x + 4 * node[0], b);
  vsc_cross(a, b, n);
  vsc_normalize(n);
  for (int i = 0; i < 3; i++) {
    double *x = o->x + 4 * o->mid[3 * face + i], way[3];
    vsc_subtract(x, o->x + 4 * node[0], way);
    const double height = vsc_dot(way, n);
    for (int k = 0; k < 3; k++) x[k] -= height * n[k];
  }
}

// Faces of six nodes count as curved as they are. Without a flat face whose edges are curved, the cap along
// these edges closes the same volume, wherever it lies and whatever its nodes are called.
static void curved_faces_and_rims(void **state)
{
  (void)state;
  octahedron o;
  vsc_cavity whole, open;
  octahedron_make(&o, 0.2, 7);
  flatten_face(&o, OCTA_FACES - 1);
  vsc_surface surface = {.count = OCTA_FACES, .triangles = o.triangles, .mid = o.mid};
  assert_int_equal(vsc_cavity_make(&surface, OCTA_NODES, &whole, NULL), VSC_OK);
  surface.count--;
  assert_int_equal(vsc_cavity_make(&surface, OCTA_NODES, &open, NULL), VSC_OK);
  assert_int_equal(whole.rim_count, 0);
  assert_int_equal(open.rim_count, 1);
  const double volume = -octahedron_volume(&o, 6);
  assert_close(vsc_cavity_volume(&whole, o.x, 4), volume, 1e-14, 0);
  assert_close(vsc_cavity_volume(&open, o.x, 4), volume, 1e-14, 0);
  uint32_t number[OCTA_NODES];
  double moved[4 * OCTA_NODES];
  for (uint32_t n = 0; n < OCTA_NODES; n++) {
    number[n] = (5 * n + 3) % OCTA_NODES;
    for (uint32_t k = 0; k < 3; k++) moved[4 * number[n] + k] = o.x[4 * n + k] + 3 - k;
  }
  vsc_cavity_renumber(&open, number);
  assert_close(vsc_cavity_volume(&open, moved, 4), volume, 1e-13, 0);
  vsc_cavity_free(&whole);
  vsc_cavity_free(&open);
}

static void curved_faces_have_curved_area(void **state)
{
  (void)state;
  octahedron o;
  octahedron_make(&o, 0, 7);
  vsc_surface surface = {.count = OCTA_FACES, .triangles = o.triangles, .mid = o.mid};
  assert_close(vsc_surface_area(&surface, o.x, 4), 4 * sqrt(3), 1e-14, 0);
  octahedron_round(&o);
  double area = 0, x[3], t1[3], t2[3], n[3];
  for (int face = 0; face < OCTA_FACES; face++)
    for (int p = 0; p < 25; p++) {
      double u, v, weight;
      octahedron_point(p, &u, &v, &weight);
      octahedron_place(&o, face, 6, u, v, x, t1, t2);
      vsc_cross(t1, t2, n);
      area += weight * vsc_norm(n);
    }
  assert_close(vsc_surface_area(&surface, o.x, 4), area, 1e-3, 0);  // no polynomial
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(cavities_of_known_volume),
    cmocka_unit_test(touching_rims_are_taken_apart),
    cmocka_unit_test(the_whole_boundary_encloses_minus_the_tissue),
    cmocka_unit_test(volume_follows_affine_maps),
    cmocka_unit_test(the_cap_moves_with_its_rim),
    cmocka_unit_test(any_triangles_can_be_closed),
    cmocka_unit_test(bad_surfaces_are_refused),
    cmocka_unit_test(curved_faces_and_rims),
    cmocka_unit_test(curved_faces_have_curved_area),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
