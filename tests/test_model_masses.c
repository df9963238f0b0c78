// SPDX-License-Identifier: GPL-3.0-or-later
// Masses of the nodes: lumped, by what is nearest, and all alike.
#include "base/vec3.h"
#include "kinds_body.h"
#include "model/masses.h"
#include "paper_axes.h"

static double sum_of(const double *values, size_t count)
{
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += values[i];
  return sum;
}

// Both ways share out the volume of the body, and give no node less than nothing.
static void everything_is_shared_out(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.15, 3);
  double *voronoi = numbers(mesh->node_count), *density = numbers(mesh->element_count);
  double lumped[VSC_MOST_CORNERS], weight = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const size_t corners = (size_t)vsc_mesh_kind(mesh, e)->corners;
    density[e] = 1 + (double)(e % 3);
    weight += density[e] * vsc_mesh_element_volume(mesh, e);
    const vsc_cell_rule rule = vsc_cell_rule_of((vsc_cell)mesh->kinds[e]);
    vsc_lumped_volumes(mesh, &rule, e, lumped);
    assert_close(sum_of(lumped, corners), vsc_mesh_element_volume(mesh, e), 1e-14, 0);
    for (size_t c = 0; c < corners; c++) assert_true(lumped[c] > 0);
  }
  assert_int_equal(vsc_voronoi_masses(mesh, density, voronoi, NULL), VSC_OK);
  assert_close(sum_of(voronoi, mesh->node_count), weight, 1e-13, 0);
  for (size_t n = 0; n < mesh->node_count; n++) assert_true(voronoi[n] > 0);
  vsc_free(voronoi);
  vsc_free(density);
  vsc_mesh_free(mesh);
}

// Random points of a tet, counted by their nearest corner: 200,000 of them know a part to 1/300.
static void a_node_has_what_is_nearest_to_it(void **state)
{
  (void)state;
  enum { POINTS = 200000 };
  uint64_t seed = 11;
  for (int round = 0; round < 4; round++) {
    vsc_mesh *mesh = vsc_mesh_create(4, 1, 0);
    double x[4][3], masses[4];
    size_t counts[4] = {0};
    random_tet(&seed, 1, x);
    memcpy(mesh->nodes, x, sizeof x);
    for (uint32_t c = 0; c < 4; c++) mesh->corners[c] = c;
    assert_int_equal(vsc_voronoi_masses(mesh, (double[]){1}, masses, NULL), VSC_OK);
    for (int k = 0; k < POINTS; k++) {
      double share[4], point[3] = {0}, least = INFINITY, sum = 0;
      int nearest = 0;
      for (int c = 0; c < 4; c++) sum += share[c] = -log(1 - random_part(&seed));
      for (int c = 0; c < 4; c++)
        for (int i = 0; i < 3; i++) point[i] += share[c] / sum * x[c][i];
      for (int c = 0; c < 4; c++) {
        double way[3];
        vsc_subtract(point, x[c], way);
        if (vsc_dot(way, way) < least) nearest = c;
        least = fmin(least, vsc_dot(way, way));
      }
      counts[nearest]++;
    }
    for (int c = 0; c < 4; c++)
      assert_close(masses[c] / vsc_mesh_element_volume(mesh, 0), (double)counts[c] / POINTS, 0, 0.005);
    vsc_mesh_free(mesh);
  }
}

// A node of a grid of cubes has the cell of half a spacing round it, however the cubes are cut: the
// paper's reason for taking these volumes. A quarter of each tet depends on the cut.
static void a_regular_grid_has_equal_masses_inside(void **state)
{
  (void)state;
  vsc_block_shape shape = vsc_block_default();
  vsc_mesh *mesh;
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  double least[2] = {INFINITY, INFINITY}, most[2] = {0, 0};
  for (int kind = 0; kind < 2; kind++) {
    random_body body = {.mesh = mesh};
    vsc_material_def material = springs_material(NULL, NULL);
    material.density = 2;
    body.definition = vsc_default_definition();
    body.definition.end_time = 1;
    body.definition.material_count = 1;
    body.definition.materials = &material;
    body.definition.masses = kind == 0 ? VSC_MASS_VORONOI : VSC_MASS_LUMPED;
    body_build(&body);
    double total = 0;
    for (size_t n = 0; n < mesh->node_count; n++) {
      const double *x = body.model->rest + 4 * n, mass = body.model->mass[n];
      total += mass;
      bool inner = true;
      for (int i = 0; i < 3; i++) inner = inner && x[i] > 0.1 && x[i] < shape.size[i] - 0.1;
      if (!inner) continue;
      least[kind] = fmin(least[kind], mass);
      most[kind] = fmax(most[kind], mass);
    }
    assert_close(total, 2 * 1000, 1e-13, 0);
    vsc_ledger_free(body.ledger);
    vsc_state_free(body.state);
    vsc_model_free(body.model);
  }
  assert_close(least[0], 2 * 2.5 * 2.5 * 2.5, 1e-12, 0);
  assert_close(most[0], least[0], 1e-12, 0);
  assert_true(most[1] > 1.5 * least[1]);
  vsc_mesh_free(mesh);
}

static void equal_masses_are_equal_and_weigh_the_same(void **state)
{
  (void)state;
  random_body body;
  const vsc_material_def material = springs_material(NULL, NULL);
  kinds_open(&body, hybrid_block(3, 0.1, 5), &material, VSC_VOLUME_NODAL, 6);
  const double total = body.model->total_mass;
  vsc_ledger_free(body.ledger);
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body.definition.masses = VSC_MASS_EQUAL;
  body_build(&body);
  const size_t nodes = body.model->node_count;
  for (size_t n = 0; n < nodes; n++)
    assert_close(body.model->mass[n], total / (double)nodes, 1e-13, 0);
  assert_close(body.model->total_mass, 27 * 1.06, 1e-13, 0);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(everything_is_shared_out),
      cmocka_unit_test(a_node_has_what_is_nearest_to_it),
      cmocka_unit_test(a_regular_grid_has_equal_masses_inside),
      cmocka_unit_test(equal_masses_are_equal_and_weigh_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
