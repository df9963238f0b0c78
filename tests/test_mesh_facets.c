// SPDX-License-Identifier: GPL-3.0-or-later
// Facets: triangles as they are, both cuts of quadrilaterals, and what sums over them are.
#include "mesh/facets.h"

#include "base/vec3.h"
#include "kinds_body.h"
#include "mesh/surface.h"

// sum over facets of weight x (vector area)/3 on each node; nodes x 3.
static double *areas_of_nodes(const vsc_mesh *mesh, const vsc_facets *facets)
{
  double *area = numbers(3 * mesh->node_count);
  for (size_t k = 0; k < facets->count; k++) {
    const uint32_t *node = facets->corners + 3 * k;
    double a[3], b[3], n[3];
    vsc_subtract(mesh->nodes + 3 * (size_t)node[1], mesh->nodes + 3 * (size_t)node[0], a);
    vsc_subtract(mesh->nodes + 3 * (size_t)node[2], mesh->nodes + 3 * (size_t)node[0], b);
    vsc_cross(a, b, n);
    for (int i = 0; i < 3; i++)
      for (size_t c = 0; c < 3; c++) area[3 * node[i] + c] += vsc_facet_weight(facets, k) * n[c] / 6;
  }
  return area;
}

// Adds int N_i (dx/du x dx/dv) du dv of a bilinear face over [-1, 1]^2, by Gauss's 2 x 2 points: exact.
static void add_bilinear(const vsc_mesh *mesh, const uint32_t corner[4], double *area)
{
  static const double at[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int q = 0; q < 4; q++) {
    double t[2][3] = {{0}}, n[3];
    const double u = at[q][0] / sqrt(3), v = at[q][1] / sqrt(3);
    for (int i = 0; i < 4; i++)
      for (int c = 0; c < 3; c++) {
        const double x = mesh->nodes[3 * (size_t)corner[i] + (size_t)c];
        t[0][c] += at[i][0] * (1 + at[i][1] * v) / 4 * x;
        t[1][c] += at[i][1] * (1 + at[i][0] * u) / 4 * x;
      }
    vsc_cross(t[0], t[1], n);
    for (int i = 0; i < 4; i++)
      for (size_t c = 0; c < 3; c++)
        area[3 * corner[i] + c] += (1 + at[i][0] * u) * (1 + at[i][1] * v) / 4 * n[c];
  }
}

// Bends the outside too.
static void shake(vsc_mesh *mesh, uint64_t seed)
{
  for (size_t i = 0; i < 3 * mesh->node_count; i++) mesh->nodes[i] += random_between(&seed, -0.1, 0.1);
}

static void open_boundary(const vsc_mesh *mesh, vsc_surface *boundary, vsc_facets *facets)
{
  assert_int_equal(vsc_boundary(mesh, boundary, NULL), VSC_OK);
  assert_int_equal(vsc_facets_make(boundary, facets, NULL), VSC_OK);
}

// Any face of a hexahedron, bent or flat, gives its corners what the bilinear face does.
static void quadrilaterals_are_bilinear(void **state)
{
  (void)state;
  for (int bent = 0; bent < 2; bent++) {
    vsc_mesh *mesh = hex_block(1, 0, 5);
    vsc_surface boundary;
    vsc_facets facets;
    uint64_t seed = 7;
    for (size_t i = 0; i < 24; i++)  // flat: its sides are any quadrilaterals
      if (bent || mesh->nodes[3 * (i / 3) + 2] == 1) mesh->nodes[i] += i % 3 < 2 || bent ? random_between(&seed, -0.3, 0.3) : 0;
    open_boundary(mesh, &boundary, &facets);
    assert_int_equal(boundary.count, 12);
    assert_int_equal(facets.count, 24);
    assert_int_equal(facets.whole, 0);
    for (size_t face = 0; face < 6; face++) {
      const uint32_t *halves = boundary.triangles + 6 * face;
      const uint32_t corner[4] = {halves[0], halves[1], halves[2], halves[5]};
      vsc_facets one = {.count = 4, .corners = facets.corners + 12 * face};
      double *area = areas_of_nodes(mesh, &one), *expected = numbers(24);
      add_bilinear(mesh, corner, expected);
      for (size_t i = 0; i < 24; i++) assert_close(area[i], expected[i], 0, 1e-15);
      vsc_free(area);
      vsc_free(expected);
    }
    vsc_facets_free(&facets);
    vsc_surface_free(&boundary);
    vsc_mesh_free(mesh);
  }
}

// A body of all kinds with bent faces encloses the volume of its elements.
static void a_boundary_encloses_the_elements(void **state)
{
  (void)state;
  for (int kind = 0; kind < 4; kind++) {
    vsc_mesh *mesh = mesh_of((kinds_mesh)kind, 2, 11);
    vsc_surface boundary;
    vsc_cavity cavity;
    double volume = 0;
    if (kind != ALL_TETS10) shake(mesh, 13);
    for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
    assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
    assert_int_equal(vsc_cavity_make(&boundary, mesh->node_count, &cavity, NULL), VSC_OK);
    assert_int_equal(cavity.rim_count, 0);
    assert_close(-vsc_cavity_volume(&cavity, mesh->nodes, 3), volume, 1e-13, 0);
    vsc_cavity_free(&cavity);
    vsc_surface_free(&boundary);
    vsc_mesh_free(mesh);
  }
}

// Tets: no facet but the triangles, with their middles; renumbered ones.
static void triangles_stay(void **state)
{
  (void)state;
  for (int kind = ALL_TETS; kind <= ALL_TETS10; kind++) {
    vsc_mesh *mesh = mesh_of((kinds_mesh)kind, 2, 17);
    vsc_surface boundary;
    vsc_facets facets;
    uint32_t *number;
    open_boundary(mesh, &boundary, &facets);
    assert_null(boundary.paired);
    assert_int_equal(facets.count, boundary.count);
    assert_int_equal(facets.whole, boundary.count);
    assert_memory_equal(facets.corners, boundary.triangles, 3 * boundary.count * sizeof(uint32_t));
    assert_true((facets.mid != NULL) == (kind == ALL_TETS10));
    assert_true(VSC_NEW(number, mesh->node_count));
    for (size_t i = 0; i < mesh->node_count; i++) number[i] = (uint32_t)(2 * i + 1);
    vsc_facets_renumber(&facets, number);
    for (size_t i = 0; i < 3 * boundary.count; i++) {
      assert_int_equal(facets.corners[i], 2 * boundary.triangles[i] + 1);
      if (facets.mid != NULL) assert_int_equal(facets.mid[i], 2 * boundary.mid[i] + 1);
    }
    vsc_free(number);
    vsc_facets_free(&facets);
    vsc_surface_free(&boundary);
    vsc_mesh_free(mesh);
  }
}

// Of a face whose one half is selected, that half counts whole; the area is that of the selection. Whole faces
// of both kinds keep their areas, flat here, however they are cut.
static void halves_and_mixtures(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.2, 19);
  vsc_surface boundary, half, rest;
  vsc_facets facets;
  open_boundary(mesh, &boundary, &facets);
  assert_true(facets.whole > 0 && facets.whole < facets.count);
  assert_close(vsc_surface_area(&boundary, mesh->nodes, 3), 54, 1e-14, 0);
  double *area = areas_of_nodes(mesh, &facets), sum = 0;
  for (size_t i = 0; i < mesh->node_count; i++)
    if (mesh->nodes[3 * i] == 3) sum += area[3 * i];
  assert_true(sum >= 9 - 1e-13);
  size_t first = 0;
  while (!boundary.paired[first]) first++;
  const vsc_surface other = {.count = 1, .triangles = boundary.triangles + 3 * first};
  assert_int_equal(vsc_surface_without(&boundary, &other, &rest, NULL), VSC_OK);
  assert_int_equal(vsc_surface_without(&boundary, &rest, &half, NULL), VSC_OK);
  vsc_facets_free(&facets);
  assert_int_equal(vsc_facets_make(&half, &facets, NULL), VSC_OK);
  assert_int_equal(facets.count, 1);
  assert_int_equal(facets.whole, 1);
  assert_close(vsc_surface_area(&half, mesh->nodes, 3) + vsc_surface_area(&rest, mesh->nodes, 3), 54, 1e-14, 0);
  vsc_free(area);
  vsc_facets_free(&facets);
  vsc_surface_free(&half);
  vsc_surface_free(&rest);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(quadrilaterals_are_bilinear),
      cmocka_unit_test(a_boundary_encloses_the_elements),
      cmocka_unit_test(triangles_stay),
      cmocka_unit_test(halves_and_mixtures),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
