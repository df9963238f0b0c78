// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of a sheet's law in its plane, and of the sheet made from a mesh.
#include <stdbool.h>
#include <string.h>

#include "close.h"
#include "model/law_membrane.h"
#include "model/membranes.h"
#include "random.h"
#include "sheet_mesh.h"

static const vsc_sheet_moduli general = {.axial = {7, 3}, .angular = 1.5, .area = 11};

// G: g_a, g_b by rows, in lane `lane`; the others hold something else.
static vsc_sheet_axes axes_in_lane(const double G[6], int lane)
{
  vsc_wide3 g[2];
  for (int a = 0; a < 2; a++) {
    g[a] = (vsc_wide3){vsc_splat(a + 0.5), vsc_splat(0.25), vsc_splat(-a)};
    g[a].x[lane] = G[3 * a];
    g[a].y[lane] = G[3 * a + 1];
    g[a].z[lane] = G[3 * a + 2];
  }
  return vsc_sheet_axes_of(g);
}

static double energy_of(const vsc_sheet_moduli *law, const double G[6])
{
  const vsc_sheet_axes axes = axes_in_lane(G, 2);
  return vsc_sheet_energy(law, &axes)[2];
}

static void stress_of(const vsc_sheet_moduli *law, const double G[6], const double along[2],
                      double P[6])
{
  const vsc_sheet_axes axes = axes_in_lane(G, 1);
  const vsc_wide pull[2] = {vsc_splat(along[0]), vsc_splat(along[1])};
  vsc_wide3 stress[2];
  vsc_sheet_stress(law, &axes, pull, stress);
  for (int a = 0; a < 2; a++) {
    P[3 * a] = stress[a].x[1];
    P[3 * a + 1] = stress[a].y[1];
    P[3 * a + 2] = stress[a].z[1];
  }
}

static const double nothing[2] = {0, 0};

static void random_state(uint64_t *seed, double G[6])
{
  double R[9], move[6];
  random_rotation(seed, R);
  random_fill(seed, 0.4, move, 6);
  move[0] += 1;
  move[4] += 1;
  rotate_vector(R, move, G);
  rotate_vector(R, move + 3, G + 3);
}

// The central difference's error is O(h^2): halving h divides it by 4, for each modulus alone.
static void stress_is_the_derivative_of_energy(void **state)
{
  (void)state;
  enum { STEPS = 4, DIRECTIONS = 20 };
  const vsc_sheet_moduli laws[] = {
      general, {.axial = {5, 0}}, {.axial = {0, 5}}, {.angular = 5}, {.area = 5}};
  uint64_t seed = 3;
  for (int round = 0; round < 50; round++) {
    const vsc_sheet_moduli *law = &laws[round % 5];
    double G[6], P[6], errors[STEPS] = {0};
    random_state(&seed, G);
    stress_of(law, G, nothing, P);
    for (int k = 0; k < DIRECTIONS; k++) {
      double d[6], slope = 0, plus[6], minus[6];
      random_fill(&seed, 1, d, 6);
      for (int i = 0; i < 6; i++) slope += P[i] * d[i];
      for (int s = 0; s < STEPS; s++) {
        const double h = ldexp(1, -7 - s);
        for (int i = 0; i < 6; i++) {
          plus[i] = G[i] + h * d[i];
          minus[i] = G[i] - h * d[i];
        }
        errors[s] += fabs((energy_of(law, plus) - energy_of(law, minus)) / (2 * h) - slope);
      }
    }
    for (int s = 0; s + 1 < STEPS; s++) assert_close(log2(errors[s] / errors[s + 1]), 2, 0, 0.05);
  }
}

static void rotation_and_mirror_cost_nothing(void **state)
{
  (void)state;
  uint64_t seed = 4;
  for (int round = 0; round < 1000; round++) {
    double R[9], P[6];
    random_rotation(&seed, R);
    // orthonormal to some 1e-16, times moduli of 11
    const double turned[6] = {R[0], R[3], R[6], R[1], R[4], R[7]};
    const double mirrored[6] = {R[0], R[3], R[6], -R[1], -R[4], -R[7]};
    for (int m = 0; m < 2; m++) {
      stress_of(&general, m ? mirrored : turned, nothing, P);
      for (int i = 0; i < 6; i++) assert_close(P[i], 0, 0, 11 * 2e-15);
      assert_close(energy_of(&general, m ? mirrored : turned), 0, 0, 1e-28);
    }
  }
}

// sum_a g_a x P_a = 0, and what is turned answers turned.
static void the_law_turns_without_torque(void **state)
{
  (void)state;
  uint64_t seed = 5;
  for (int round = 0; round < 1000; round++) {
    double G[6], P[6], R[9], RG[6], RP[6], expected[6];
    random_state(&seed, G);
    random_rotation(&seed, R);
    stress_of(&general, G, nothing, P);
    for (int a = 0; a < 2; a++) {
      rotate_vector(R, G + 3 * a, RG + 3 * a);
      rotate_vector(R, P + 3 * a, expected + 3 * a);
    }
    stress_of(&general, RG, nothing, RP);
    for (int i = 0; i < 6; i++) assert_close(RP[i], expected[i], 0, 5e-14);
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      const double torque = G[j] * P[k] - G[k] * P[j] + G[3 + j] * P[3 + k] - G[3 + k] * P[3 + j];
      assert_close(torque, 0, 0, 2e-14);
    }
  }
}

// Damping and its like go along the axis only.
static void along_pulls_along_the_axis(void **state)
{
  (void)state;
  uint64_t seed = 6;
  double G[6], without[6], with[6];
  random_state(&seed, G);
  const double pull[2] = {2, -3};
  stress_of(&general, G, nothing, without);
  stress_of(&general, G, pull, with);
  for (int a = 0; a < 2; a++) {
    const double *g = G + 3 * a, length = sqrt(g[0] * g[0] + g[1] * g[1] + g[2] * g[2]);
    for (int i = 0; i < 3; i++)
      assert_close(with[3 * a + i] - without[3 * a + i], pull[a] * g[i] / length, 0, 1e-14);
  }
}

// C = [E_a + K, K; K, E_b + K], shear modulus G: one difference of 1e-6, whose error is its square
// times some moduli and rounding of 1e-16/1e-6.
static void small_strain_elasticity_is_the_closed_form(void **state)
{
  (void)state;
  const double h = 1e-6, C[2][2] = {{18, 11}, {11, 14}};
  for (int b = 0; b < 2; b++) {
    double plus[6] = {1, 0, 0, 0, 1, 0}, minus[6] = {1, 0, 0, 0, 1, 0}, P[2][6];
    plus[4 * b] += h;
    minus[4 * b] -= h;
    stress_of(&general, plus, nothing, P[0]);
    stress_of(&general, minus, nothing, P[1]);
    for (int a = 0; a < 2; a++)
      assert_close((P[0][4 * a] - P[1][4 * a]) / (2 * h), C[a][b], 0, 1e-8);
  }
  const double sheared[6] = {1, h / 2, 0, h / 2, 1, 0};
  double P[6];
  stress_of(&general, sheared, nothing, P);
  assert_close(P[1] / h, general.angular, 0, 1e-5);
  assert_close(P[3] / h, general.angular, 0, 1e-5);
}

// By hand: a stretched to 2, b at 60 degrees to it: c = 1/2, J = sqrt 3.
static void a_case_by_hand(void **state)
{
  (void)state;
  const double r = sqrt(3) / 2, G[6] = {2, 0, 0, 0.5, r, 0};
  double P[6];
  stress_of(&general, G, nothing, P);
  const double K = 11 * (2 * r - 1);
  // P_a = 7 x + 0.75 (u_b - x/2)/2 + K g_b x z,  P_b = 0.75 (x - u_b/2) + K z x g_a
  const double expected[6] = {7 + K * r,   0.375 * r - K * 0.5, 0,
                              0.75 * 0.75, -0.375 * r + 2 * K,  0};
  for (int i = 0; i < 6; i++) assert_close(P[i], expected[i], 0, 1e-14);
  assert_close(energy_of(&general, G), 7 / 2. + 1.5 / 8 + 11 * (2 * r - 1) * (2 * r - 1) / 2, 1e-15,
               0);
}

static void degenerate_axes_are_left_out(void **state)
{
  (void)state;
  const double flat[3][6] = {{0}, {1, 0, 0, 0, 0, 0}, {1, 0, 0, 2, 0, 0}};
  for (int s = 0; s < 3; s++) {
    double P[6];
    stress_of(&general, flat[s], nothing, P);
    assert_true(isfinite(energy_of(&general, flat[s])));
    for (int i = 0; i < 6; i++) assert_true(isfinite(P[i]));
  }
}

// ---- the sheet

static vsc_mesh *turned_sheet(const double R[9])
{
  vsc_mesh *mesh = sheet_mesh(5, 4, 1, 0.7, CUT_BY_TURNS, 0.3, 2);
  for (size_t n = 0; n < mesh->node_count; n++) {
    double x[3];
    rotate_vector(R, mesh->nodes + 3 * n, x);
    memcpy(mesh->nodes + 3 * n, x, sizeof x);
  }
  return mesh;
}

// Axes are unit and at right angles at rest, a along the direction as projected.
static void axes_are_orthonormal_at_rest(void **state)
{
  (void)state;
  uint64_t seed = 7;
  for (int round = 0; round < 20; round++) {
    double R[9], area = 0;
    random_rotation(&seed, R);
    vsc_mesh *mesh = turned_sheet(R);
    vsc_membrane_def def = vsc_default_membrane();
    random_fill(&seed, 1, def.direction, 3);
    const vsc_surface surface = all_triangles(mesh);
    vsc_sheet sheet;
    assert_int_equal(vsc_sheet_make(mesh, &surface, &def, &sheet, NULL), VSC_OK);
    assert_null(sheet.G);
    for (size_t k = 0; k < sheet.count; k++) {
      double g[2][3];
      const double *x0 = mesh->nodes + 3 * (size_t)sheet.nodes[k][0];
      for (int a = 0; a < 2; a++)
        for (int i = 0; i < 3; i++) {
          g[a][i] = 0;
          for (int e = 0; e < 2; e++)
            g[a][i] +=
                sheet.T[k][a][e] * (mesh->nodes[3 * (size_t)sheet.nodes[k][e + 1] + i] - x0[i]);
        }
      const double normal[3] = {R[2], R[5], R[8]};
      double along = 0, dots[3] = {0};
      for (int i = 0; i < 3; i++) {
        dots[0] += g[0][i] * g[0][i];
        dots[1] += g[1][i] * g[1][i];
        dots[2] += g[0][i] * g[1][i];
        along += def.direction[i] * g[1][i];
      }
      assert_close(dots[0], 1, 0, 1e-13);
      assert_close(dots[1], 1, 0, 1e-13);
      assert_close(dots[2], 0, 0, 1e-13);
      double out = 0, whole = 0;
      for (int i = 0; i < 3; i++) {
        out += def.direction[i] * normal[i];
        whole += def.direction[i] * def.direction[i];
      }
      if (whole - out * out > 0.02 * whole) assert_close(along, 0, 0, 1e-13);
      area += sheet.area[k];
    }
    assert_close(area, 5 * 4 * 0.7, 1e-13, 0);
    vsc_sheet_free(&sheet);
    vsc_mesh_free(mesh);
  }
}

// Neighbours see each other; where three triangles meet none does; a triangle may be turned over.
static void neighbours_share_an_edge(void **state)
{
  (void)state;
  const double x[5][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}};
  const uint32_t triangles[9] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
  for (size_t count = 1; count <= 3; count++) {
    vsc_mesh *mesh = vsc_mesh_create(5, 0, count);
    memcpy(mesh->nodes, x, sizeof x);
    memcpy(mesh->triangles, triangles, 3 * count * sizeof *triangles);
    vsc_membrane_def def = vsc_default_membrane();
    def.axial[0] = def.axial[1] = def.bending = 1;
    const vsc_surface surface = all_triangles(mesh);
    vsc_sheet sheet;
    assert_int_equal(vsc_sheet_make(mesh, &surface, &def, &sheet, NULL), VSC_OK);
    for (size_t k = 0; k < count; k++) {
      const bool paired = count == 2;
      assert_int_equal(sheet.nodes[k][3], paired ? 3 - k : 0);
      double square = 0;
      for (int i = 0; i < 3; i++) square += sheet.G[k][i][0] * sheet.G[k][i][0];
      assert_true((square > 0) == paired);
      assert_int_equal(sheet.nodes[k][4], 1);
      assert_int_equal(sheet.nodes[k][5], 2 + k);
    }
    vsc_sheet_free(&sheet);
    vsc_mesh_free(mesh);
  }
}

static void a_triangle_without_area_is_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = sheet_mesh(2, 2, 1, 1, CUT_ONE_WAY, 0, 1);
  memcpy(mesh->nodes, mesh->nodes + 3, 3 * sizeof(double));
  const vsc_membrane_def def = vsc_default_membrane();
  const vsc_surface surface = all_triangles(mesh);
  vsc_sheet sheet;
  vsc_error error;
  assert_int_equal(vsc_sheet_make(mesh, &surface, &def, &sheet, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "has no area"));
  vsc_sheet_free(&sheet);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_is_the_derivative_of_energy),
      cmocka_unit_test(rotation_and_mirror_cost_nothing),
      cmocka_unit_test(the_law_turns_without_torque),
      cmocka_unit_test(along_pulls_along_the_axis),
      cmocka_unit_test(small_strain_elasticity_is_the_closed_form),
      cmocka_unit_test(a_case_by_hand),
      cmocka_unit_test(degenerate_axes_are_left_out),
      cmocka_unit_test(axes_are_orthonormal_at_rest),
      cmocka_unit_test(neighbours_share_an_edge),
      cmocka_unit_test(a_triangle_without_area_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
