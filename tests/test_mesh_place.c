// SPDX-License-Identifier: GPL-3.0-or-later
// Points found in meshes: inside, on faces, outside; in straight and in curved elements.
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "hybrid_mesh.h"
#include "mesh/place.h"
#include "mesh/quadratic.h"

enum { SIDE = 4 };  // mm, of the blocks

static vsc_mesh *curved_block(void)
{
  vsc_mesh *mesh = box_mesh((const int[3]){SIDE, SIDE, SIDE}, 1, NULL);
  if (vsc_mesh_raise(&mesh, "box", NULL) != VSC_OK) fail_msg("no quadratic mesh");
  uint64_t seed = 9;
  // middles inside the block move: faces between elements are curved, the block's own stay flat
  for (size_t n = (SIDE + 1) * (SIDE + 1) * (SIDE + 1); n < mesh->node_count; n++)
    for (size_t a = 0; a < 3; a++) {
      double *x = &mesh->nodes[3 * n + a];
      if (*x > 0 && *x < SIDE) *x += random_between(&seed, -0.05, 0.05);
    }
  return mesh;
}

static vsc_mesh *block(int kind)
{
  return kind == 0 ? hybrid_block(SIDE, 0.15, 5) : curved_block();
}

// Whatever the elements, the place found holds the point: positions are recovered, and with them every
// linear field. 1e-12: of coordinates up to 4 some rounding and Newton's last step.
static void points_inside_are_found(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    vsc_mesh *mesh = block(kind);
    uint64_t seed = 3;
    for (int round = 0; round < 300; round++) {
      double at[3], found[3];
      vsc_place place;
      for (int a = 0; a < 3; a++) at[a] = random_between(&seed, 0, SIDE);
      // on a face between bricks, on an edge, in a corner
      for (int a = 0; a < round % 4; a++) at[a] = round % 5 == 0 ? 0 : SIDE;
      vsc_place_find(mesh, at, &place);
      vsc_place_value(mesh, &place, 3, mesh->nodes, found);
      assert_close(place.distance, 0, 0, 1e-12);
      for (int a = 0; a < 3; a++) assert_close(found[a], at[a], 0, 1e-12);
    }
    vsc_mesh_free(mesh);
  }
}

// x(xi) of an element, and back.
static void places_within_an_element_come_back(void **state)
{
  (void)state;
  int seen[VSC_CELLS] = {0};
  for (int kind = 0; kind < 2; kind++) {
    vsc_mesh *mesh = block(kind);
    uint64_t seed = 4;
    for (size_t e = 0; e < mesh->element_count; e++) {
      double xi[3], N[VSC_MOST_CORNERS], D[3][VSC_MOST_CORNERS], at[3] = {0};
      for (int k = 0; k < 3; k++) xi[k] = random_between(&seed, 0, 0.33);  // within every kind
      vsc_cell_shape(mesh->kinds[e], xi, N, D);
      for (int i = 0; i < vsc_mesh_kind(mesh, e)->corners; i++)
        for (size_t a = 0; a < 3; a++)
          at[a] += N[i] * mesh->nodes[3 * (size_t)vsc_mesh_corners(mesh, e)[i] + a];
      vsc_place place;
      vsc_place_within(mesh, e, at, &place);
      assert_int_equal(place.element, e);
      for (int k = 0; k < 3; k++) assert_close(place.xi[k], xi[k], 0, 1e-11);
      seen[mesh->kinds[e]]++;
    }
    vsc_mesh_free(mesh);
  }
  for (int kind = 0; kind < VSC_CELLS; kind++) assert_true(seen[kind] > 0);
}

// Outside a block the nearest place is the point with its coordinates cut to the block's.
static void points_outside_find_the_nearest_place(void **state)
{
  (void)state;
  for (int kind = 0; kind < 2; kind++) {
    vsc_mesh *mesh = block(kind);
    uint64_t seed = 6;
    for (int round = 0; round < 100; round++) {
      double at[3], nearest[3], apart[3], found[3];
      vsc_place place;
      for (int a = 0; a < 3; a++) {
        at[a] = random_between(&seed, -2, SIDE + 2);
        nearest[a] = fmin(fmax(at[a], 0), SIDE);
      }
      vsc_subtract(at, nearest, apart);
      vsc_place_find(mesh, at, &place);
      vsc_place_value(mesh, &place, 3, mesh->nodes, found);
      // where no rounding hides it: steps end when |d| is 1e-14, distances are good to its root
      assert_close(place.distance, vsc_norm(apart), 0, 1e-10);
      for (int a = 0; a < 3; a++) assert_close(found[a], nearest[a], 0, 1e-6);
    }
    vsc_mesh_free(mesh);
  }
}

// Of a bulging face no place on a fine grid of its element is nearer than the one found. Whole steps of
// Gauss-Newton would lead away from it.
static void the_nearest_place_of_a_curved_face(void **state)
{
  (void)state;
  enum { GRID = 60 };
  vsc_mesh *mesh = box_mesh((const int[3]){1, 1, 1}, 1, NULL);
  if (vsc_mesh_raise(&mesh, "box", NULL) != VSC_OK) fail_msg("no quadratic mesh");
  uint64_t seed = 12;
  for (size_t i = 24; i < 3 * mesh->node_count; i++)
    mesh->nodes[i] += random_between(&seed, -0.25, 0.25);
  for (int round = 0; round < 60; round++) {
    double at[3], least = INFINITY;
    vsc_place place;
    for (int a = 0; a < 3; a++) at[a] = random_between(&seed, 1, 2);
    vsc_place_within(mesh, (size_t)round % 6, at, &place);
    for (int i = 0; i <= GRID; i++)
      for (int j = 0; i + j <= GRID; j++)
        for (int k = 0; i + j + k <= GRID; k++) {
          const double xi[3] = {(double)i / GRID, (double)j / GRID, (double)k / GRID};
          double D[3][VSC_MOST_CORNERS], x[3], apart[3];
          vsc_place other = {.element = (size_t)round % 6};
          vsc_cell_shape(VSC_TET10, xi, other.N, D);
          vsc_place_value(mesh, &other, 3, mesh->nodes, x);
          vsc_subtract(at, x, apart);
          least = fmin(least, vsc_norm(apart));
        }
    // the grid's nearest is at most a few of its meshes' sides (1/60) away along the face: the square
    // of that, over the distance, is what it may miss
    assert_true(place.distance <= least + 1e-12);
    assert_close(place.distance, least, 0, 2e-3);
  }
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(points_inside_are_found),
      cmocka_unit_test(places_within_an_element_come_back),
      cmocka_unit_test(points_outside_find_the_nearest_place),
      cmocka_unit_test(the_nearest_place_of_a_curved_face),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
