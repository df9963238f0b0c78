// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions and rules of the kinds of elements, and what a hybrid mesh adds up to.
#include "base/vec3.h"
#include "close.h"
#include "hybrid_mesh.h"
#include "mesh/surface.h"

enum { MOST = VSC_MOST_CORNERS };

// A random point of the reference element, away from a pyramid's apex.
static void random_point(vsc_cell kind, uint64_t *seed, double xi[3])
{
  for (int k = 0; k < 3; k++) xi[k] = random_between(seed, -1, 1);
  if (kind == VSC_PYRAMID) xi[2] = 0.9 * random_part(seed);
  const bool tet = kind == VSC_TET || kind == VSC_TET10;
  while (tet || kind == VSC_WEDGE) {
    for (int k = 0; k < (tet ? 3 : 2); k++) xi[k] = random_part(seed);
    if (xi[0] + xi[1] + (tet ? xi[2] : 0) <= 1) break;
  }
}

// They sum to 1, their derivatives to 0, and the derivatives are those of the functions (differences
// over 1e-6: rounding 1e-10).
static void shape_functions_are_what_they_should(void **state)
{
  (void)state;
  uint64_t seed = 3;
  for (int kind = 0; kind < VSC_CELLS; kind++)
    for (int round = 0; round < 50; round++) {
      double xi[3], N[MOST], D[3][MOST], ahead[MOST], behind[MOST], unused[3][MOST], sum = 0;
      random_point((vsc_cell)kind, &seed, xi);
      vsc_cell_shape((vsc_cell)kind, xi, N, D);
      for (int i = 0; i < MOST; i++) sum += N[i];
      assert_close(sum, 1, 1e-15, 1e-15);
      for (int k = 0; k < 3; k++) {
        double moved[3] = {xi[0], xi[1], xi[2]}, total = 0;
        moved[k] = xi[k] + 1e-6;
        vsc_cell_shape((vsc_cell)kind, moved, ahead, unused);
        moved[k] = xi[k] - 1e-6;
        vsc_cell_shape((vsc_cell)kind, moved, behind, unused);
        for (int i = 0; i < MOST; i++) {
          assert_close(D[k][i], (ahead[i] - behind[i]) / 2e-6, 0, 1e-9);
          total += D[k][i];
        }
        // quadratic: sums of numbers up to 4
        assert_close(total, 0, 0, kind == VSC_TET10 ? 4e-15 : 1e-15);
      }
    }
}

// Corners of the reference elements.
static const double REFERENCE[VSC_CELLS][MOST][3] = {
    [VSC_TET] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
    [VSC_HEX] = {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1},
                 {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}},
    [VSC_WEDGE] = {{0, 0, -1}, {1, 0, -1}, {0, 1, -1}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}},
    [VSC_PYRAMID] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 1}},
    [VSC_TET10] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {.5, 0, 0},
                   {.5, .5, 0}, {0, .5, 0}, {0, 0, .5}, {.5, 0, .5}, {0, .5, .5}}};

// sum_i N_i X_i gives back the place, so that linear functions are met; a pyramid's coordinates
// shrink towards its apex. Each function is 1 at its own corner and 0 at the others.
static void linear_functions_are_met(void **state)
{
  (void)state;
  uint64_t seed = 4;
  double N[MOST], D[3][MOST];
  for (int kind = 0; kind < VSC_CELLS; kind++) {
    for (int round = 0; round < 50; round++) {
      double xi[3], place[3] = {0};
      random_point((vsc_cell)kind, &seed, xi);
      vsc_cell_shape((vsc_cell)kind, xi, N, D);
      for (int i = 0; i < vsc_cells[kind].corners; i++)
        for (int k = 0; k < 3; k++) place[k] += N[i] * REFERENCE[kind][i][k];
      for (int k = 0; k < 3; k++) {
        const double shrunk = kind == VSC_PYRAMID && k < 2 ? 1 - xi[2] : 1;
        assert_close(place[k], shrunk * xi[k], 0, 1e-15);
      }
    }
    for (int i = 0; i < vsc_cells[kind].corners; i++) {
      vsc_cell_shape((vsc_cell)kind, REFERENCE[kind][i], N, D);
      for (int j = 0; j < MOST; j++) assert_close(N[j], i == j, 0, 0);
    }
  }
}

// Faces turn counter-clockwise seen from outside, so that the reference volume comes out, which is
// also the sum of the rule's weights (of the pyramid: 4/3, its weights being those of a box 2 x 2 x
// 1); each edge lies on two faces, which run along it in opposite ways.
static void faces_and_edges_fit(void **state)
{
  (void)state;
  static const double volumes[VSC_CELLS] = {1. / 6, 8, 1, 4. / 3, 1. / 6};
  static const double boxes[VSC_CELLS] = {1. / 6, 8, 1, 4, 1. / 6};
  for (int k = 0; k < VSC_CELLS; k++) {
    const vsc_cell_kind *kind = &vsc_cells[k];
    const vsc_cell_rule rule = vsc_cell_rule_of((vsc_cell)k);
    int runs[8][8] = {{0}};
    double volume = 0, weight = 0;
    for (int f = 0; f < kind->face_count; f++) {
      const int *v = kind->faces[f], corners = v[3] < 0 ? 3 : 4;
      for (int i = 0; i < corners; i++) runs[v[i]][v[(i + 1) % corners]]++;
      for (int cut = 0; cut < corners - 2; cut++)
        volume += vsc_tet_volume((double[3]){0.1, 0.2, 0.3}, REFERENCE[k][v[0]],
                                 REFERENCE[k][v[cut + 1]], REFERENCE[k][v[cut + 2]]);
    }
    for (int q = 0; q < rule.points; q++) weight += rule.weight[q];
    assert_close(volume, volumes[k], 1e-15, 0);
    assert_close(weight, boxes[k], 1e-15, 0);
    int sides = 0;
    for (int i = 0; i < 8; i++)
      for (int j = 0; j < 8; j++) sides += runs[i][j];
    assert_int_equal(sides, 2 * kind->edge_count);
    for (int e = 0; e < kind->edge_count; e++) {
      assert_int_equal(runs[kind->edges[e][0]][kind->edges[e][1]], 1);
      assert_int_equal(runs[kind->edges[e][1]][kind->edges[e][0]], 1);
      const int middle = vsc_cell_middle(kind, kind->edges[e][1], kind->edges[e][0]);
      assert_int_equal(middle, k == VSC_TET10 ? 4 + e : -1);
      for (int a = 0; a < 3 && middle >= 0; a++)
        assert_close(REFERENCE[k][middle][a], 0.5 * (REFERENCE[k][kind->edges[e][0]][a] +
                                                     REFERENCE[k][kind->edges[e][1]][a]), 0, 0);
    }
  }
}

// Integral of grad N_i over a face's triangle, whose N are linear there: normal area / 3.
static void add_flux(const double (*x)[3], int a, int b, int c, double weight, double (*flux)[3])
{
  double first[3], second[3], normal[3];
  vsc_subtract(x[b], x[a], first);
  vsc_subtract(x[c], x[a], second);
  vsc_cross(first, second, normal);
  const int corner[3] = {a, b, c};
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) flux[corner[i]][k] += weight * normal[k] / 6;
}

// By Gauss' theorem the integral of grad N_i over the cell is that of N_i n over its faces. On a
// four-cornered face both are integrated exactly by a 2 x 2 rule.
static void add_quad_flux(const double (*x)[3], const int v[4], double (*flux)[3])
{
  static const double sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  const double gauss = 1 / sqrt(3);
  for (int q = 0; q < 4; q++) {
    double N[4], first[3] = {0}, second[3] = {0}, normal[3];
    for (int i = 0; i < 4; i++) {
      const double a = 0.5 * (1 + sign[i][0] * sign[q][0] * gauss);
      const double b = 0.5 * (1 + sign[i][1] * sign[q][1] * gauss);
      N[i] = a * b;
      for (int k = 0; k < 3; k++) {
        first[k] += 0.5 * sign[i][0] * b * x[v[i]][k];
        second[k] += 0.5 * sign[i][1] * a * x[v[i]][k];
      }
    }
    vsc_cross(first, second, normal);
    for (int i = 0; i < 4; i++)
      for (int k = 0; k < 3; k++) flux[v[i]][k] += N[i] * normal[k];
  }
}

static void rules_integrate_gradients_exactly(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.2, 5);
  for (size_t e = 0; e < mesh->element_count; e++) {
    const vsc_cell_kind *kind = vsc_mesh_kind(mesh, e);
    const vsc_cell_rule rule = vsc_cell_rule_of((vsc_cell)mesh->kinds[e]);
    double x[8][3], flux[8][3] = {{0}}, sum[8][3] = {{0}}, volume = 0;
    for (int c = 0; c < kind->corners; c++)
      memcpy(x[c], mesh->nodes + 3 * (size_t)vsc_mesh_corners(mesh, e)[c], sizeof x[c]);
    for (int f = 0; f < kind->face_count; f++)
      if (kind->faces[f][3] < 0)
        add_flux((const double(*)[3])x, kind->faces[f][0], kind->faces[f][1], kind->faces[f][2], 1, flux);
      else
        add_quad_flux((const double(*)[3])x, kind->faces[f], flux);
    double det[VSC_MOST_POINTS];
    vsc_mesh_jacobians(mesh, e, &rule, det);
    for (int q = 0; q < rule.points; q++) {
      double h[3][3] = {{0}};
      for (int k = 0; k < 3; k++)
        for (int c = 0; c < kind->corners; c++)
          for (int i = 0; i < 3; i++) h[k][i] += rule.D[q][k][c] * x[c][i];
      for (int k = 0; k < 3; k++) {
        double dual[3];
        vsc_cross(h[(k + 1) % 3], h[(k + 2) % 3], dual);
        if (k == 0) volume += rule.weight[q] * vsc_dot(h[0], dual);
        assert_close(det[q], vsc_dot(h[k], dual), 1e-13, 0);
        for (int c = 0; c < kind->corners; c++)
          for (int i = 0; i < 3; i++) sum[c][i] += rule.weight[q] * rule.D[q][k][c] * dual[i];
      }
    }
    assert_close(volume, vsc_mesh_element_volume(mesh, e), 1e-13, 0);
    for (int c = 0; c < kind->corners; c++)
      for (int i = 0; i < 3; i++) assert_close(sum[c][i], flux[c][i], 0, 1e-14);
  }
  vsc_mesh_free(mesh);
}

// The boundary of a hybrid block closes, and encloses what its elements hold. Its faces are plane, so
// that the way in which they are cut in two does not count.
static void the_boundary_of_a_hybrid_mesh_closes(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(4, 0.2, 7);
  vsc_surface boundary;
  vsc_cavity cavity;
  vsc_error error;
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
  assert_close(volume, 64, 1e-14, 0);
  if (vsc_boundary(mesh, &boundary, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_int_equal(boundary.count, 6 * 16 * 2);
  if (vsc_cavity_make(&boundary, mesh->node_count, &cavity, &error) != VSC_OK)
    fail_msg("%s", error.text);
  assert_int_equal(cavity.rim_count, 0);
  assert_close(vsc_cavity_volume(&cavity, mesh->nodes, 3), -64, 1e-14, 0);
  assert_close(vsc_surface_area(&boundary, mesh->nodes, 3), 96, 1e-14, 0);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

// Elements that are read left-handed come out right-handed, and what is folded is refused.
static void left_handed_elements_are_turned(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.2, 9), *mirrored = hybrid_block(3, 0.2, 9);
  vsc_error error;
  for (size_t n = 0; n < mirrored->node_count; n++) mirrored->nodes[3 * n] *= -1;
  if (vsc_mesh_clean(mirrored, "mirrored", &error) != VSC_OK) fail_msg("%s", error.text);
  assert_int_equal(mirrored->report.turned_elements, mirrored->element_count);
  for (size_t e = 0; e < mesh->element_count; e++)
    assert_close(vsc_mesh_element_volume(mirrored, e), vsc_mesh_element_volume(mesh, e), 1e-13, 0);
  // one corner of the first hexahedron pulled through the opposite one
  size_t hex = 0;
  while (mesh->kinds[hex] != VSC_HEX) hex++;
  double *far = mesh->nodes + 3 * (size_t)vsc_mesh_corners(mesh, hex)[6];
  const double *near = mesh->nodes + 3 * (size_t)vsc_mesh_corners(mesh, hex)[0];
  for (int i = 0; i < 3; i++) far[i] = near[i] + 0.02;
  assert_int_equal(vsc_mesh_clean(mesh, "folded.vtu", &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "folded.vtu"));
  vsc_mesh_free(mesh);
  vsc_mesh_free(mirrored);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(shape_functions_are_what_they_should),
      cmocka_unit_test(linear_functions_are_met),
      cmocka_unit_test(faces_and_edges_fit),
      cmocka_unit_test(rules_integrate_gradients_exactly),
      cmocka_unit_test(the_boundary_of_a_hybrid_mesh_closes),
      cmocka_unit_test(left_handed_elements_are_turned),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
