// SPDX-License-Identifier: GPL-3.0-or-later
// Many points found in a mesh: what VTK's search finds is what looking through all elements finds.
#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "hybrid_mesh.h"
#include "io/vtk_probe.h"
#include "mesh/quadratic.h"
#include "random.h"

enum { SIDE = 4, POINTS = 500 };

static void check(vsc_mesh *mesh, double low, double high)
{
  double *at, found[3];
  vsc_place *places;
  uint64_t seed = 8;
  if (!VSC_NEW(at, 3 * POINTS) || !VSC_NEW(places, POINTS)) fail_msg("no memory");
  for (size_t i = 0; i < 3 * POINTS; i++) at[i] = random_between(&seed, low, high);
  // the mesh's own nodes, where many elements meet
  for (size_t i = 0; i < 150; i++) at[i] = mesh->nodes[i];
  vsc_error error;
  if (vsc_vtk_probe(mesh, POINTS, at, places, &error) != VSC_OK) fail_msg("%s", error.text);
  for (size_t i = 0; i < POINTS; i++) {
    vsc_place slow;
    vsc_place_find(mesh, at + 3 * i, &slow);
    assert_close(places[i].distance, slow.distance, 0, 1e-10);
    vsc_place_value(mesh, &places[i], 3, mesh->nodes, found);
    // inside the point itself; outside the steps of the search end 1e-6 beside the nearest place at worst
    double apart[3];
    vsc_subtract(at + 3 * i, found, apart);
    assert_close(vsc_norm(apart), slow.distance, 0, 1e-10);
  }
  vsc_free(at);
  vsc_free(places);
  vsc_mesh_free(mesh);
}

static void all_linear_kinds(void **state)
{
  (void)state;
  check(hybrid_block(SIDE, 0.15, 5), 0, SIDE);
  check(hybrid_block(SIDE, 0.15, 5), -1, SIDE + 1);
}

static void quadratic_tets(void **state)
{
  (void)state;
  for (int outside = 0; outside < 2; outside++) {
    vsc_mesh *mesh = box_mesh((const int[3]){SIDE, SIDE, SIDE}, 1, NULL);
    if (vsc_mesh_raise(&mesh, "box", NULL) != VSC_OK) fail_msg("no quadratic mesh");
    check(mesh, -outside, SIDE + outside);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(all_linear_kinds),
                                     cmocka_unit_test(quadratic_tets)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
