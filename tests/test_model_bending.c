// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of bending: forces are the gradient of the energy, rigid motion is free, nothing is
// pushed or turned as a whole, and a sheet of any triangles bends like the plate.
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "close.h"
#include "model/law_bending.h"
#include "model/membranes.h"
#include "random.h"
#include "sheet_mesh.h"

enum { N = VSC_BEND_NODES, FOLDS = VSC_BEND_FOLDS };

// A triangle with its neighbours and theirs, far from flat and from regular.
static const double bent[N][3] = {{0, 0, 0},        {2, 0.2, 0.1},    {0.7, 1.6, -0.2},
                                  {1.1, -1.4, 0.6}, {2.3, 1.7, 1},    {-0.9, 1.1, -0.5},
                                  {-0.3, -1, 0.8},  {2.5, -1.1, 0.2}, {3.2, 0.9, 0.4},
                                  {1.6, 2.6, 0.3},  {-0.3, 2.4, 0.5}, {-1.2, -0.1, 0.1}};

static vsc_bends bends_of(const double G[3][FOLDS], const double rest[FOLDS])
{
  vsc_bends bends;
  for (int j = 0; j < FOLDS; j++) {
    bends.rest[j] = vsc_splat(rest[j]);
    for (int k = 0; k < 3; k++) bends.G[k][j] = vsc_splat(G[k][j]);
  }
  return bends;
}

static vsc_bends some_bends(void)
{
  uint64_t seed = 4;
  double G[3][FOLDS], rest[FOLDS];
  random_fill(&seed, 1.5, G[0], 3 * FOLDS);
  random_fill(&seed, 0.3, rest, FOLDS);
  return bends_of((const double(*)[FOLDS])G, rest);
}

// Lane `lane` holds x, the others something else.
static void folds_of(const double x[N][3], int lane, vsc_fold folds[FOLDS])
{
  vsc_wide3 wide[N];
  for (int i = 0; i < N; i++) {
    wide[i] = (vsc_wide3){vsc_splat(i), vsc_splat(i * i), vsc_splat(0.5)};
    wide[i].x[lane] = x[i][0];
    wide[i].y[lane] = x[i][1];
    wide[i].z[lane] = x[i][2];
  }
  vsc_bend_folds(wide, folds);
}

static double energy_of(const vsc_bends *bends, const double x[N][3])
{
  vsc_fold folds[FOLDS];
  folds_of(x, 2, folds);
  return vsc_bend_energy(bends, folds)[2];
}

static void forces_of(const vsc_bends *bends, const double x[N][3], double f[N][3])
{
  vsc_fold folds[FOLDS];
  vsc_wide3 wide[N];
  folds_of(x, 1, folds);
  const vsc_wide nothing[FOLDS] = {vsc_splat(0)};
  vsc_bend_forces(bends, folds, nothing, wide);
  for (int i = 0; i < N; i++) {
    f[i][0] = wide[i].x[1];
    f[i][1] = wide[i].y[1];
    f[i][2] = wide[i].z[1];
  }
}

// A random state: the bent one moved by up to 0.4 per node, turned.
static void random_state(uint64_t *seed, double x[N][3])
{
  double R[9], move[3 * N];
  random_rotation(seed, R);
  random_fill(seed, 0.4, move, 3 * N);
  for (int i = 0; i < N; i++) {
    double at[3];
    for (int d = 0; d < 3; d++) at[d] = bent[i][d] + move[3 * i + d];
    rotate_vector(R, at, x[i]);
  }
}

// (E(x + hd) - E(x - hd))/2h + f.d = O(h^2): halving h divides it by 4.
static void forces_are_the_gradient(void **state)
{
  (void)state;
  enum { STEPS = 4, DIRECTIONS = 20 };
  const vsc_bends bends = some_bends();
  uint64_t seed = 5;
  for (int round = 0; round < 50; round++) {
    double x[N][3], f[N][3], errors[STEPS] = {0};
    random_state(&seed, x);
    forces_of(&bends, x, f);
    for (int k = 0; k < DIRECTIONS; k++) {
      double d[3 * N], slope = 0;
      random_fill(&seed, 1, d, 3 * N);
      for (int i = 0; i < 3 * N; i++) slope -= f[i / 3][i % 3] * d[i];
      for (int s = 0; s < STEPS; s++) {
        const double h = ldexp(1, -9 - s);
        double plus[N][3], minus[N][3];
        for (int i = 0; i < 3 * N; i++) {
          plus[i / 3][i % 3] = x[i / 3][i % 3] + h * d[i];
          minus[i / 3][i % 3] = x[i / 3][i % 3] - h * d[i];
        }
        errors[s] += fabs((energy_of(&bends, plus) - energy_of(&bends, minus)) / (2 * h) - slope);
      }
    }
    for (int s = 0; s + 1 < STEPS; s++) assert_close(log2(errors[s] / errors[s + 1]), 2, 0, 0.05);
  }
}

static void forces_neither_push_nor_turn(void **state)
{
  (void)state;
  const vsc_bends bends = some_bends();
  uint64_t seed = 6;
  for (int round = 0; round < 1000; round++) {
    double x[N][3], f[N][3], sum[3] = {0}, torque[3] = {0}, size = 0;
    random_state(&seed, x);
    forces_of(&bends, x, f);
    for (int i = 0; i < N; i++)
      for (int d = 0; d < 3; d++) {
        const int e = (d + 1) % 3, g = (d + 2) % 3;
        sum[d] += f[i][d];
        torque[d] += x[i][e] * f[i][g] - x[i][g] * f[i][e];
        size = fmax(size, fabs(f[i][d]));
      }
    for (int d = 0; d < 3; d++) {
      assert_close(sum[d], 0, 0, 1e-14 * size);
      assert_close(torque[d], 0, 0, 1e-13 * size);
    }
  }
}

// Energy and forces turn with the body; a mirrored body with mirrored rest angles has the same.
static void the_law_turns_and_mirrors(void **state)
{
  (void)state;
  const vsc_bends bends = some_bends();
  vsc_bends mirrored = bends;
  for (int j = 0; j < FOLDS; j++) mirrored.rest[j] = -mirrored.rest[j];
  uint64_t seed = 7;
  for (int round = 0; round < 200; round++) {
    double x[N][3], f[N][3], Rx[N][3], Rf[N][3], R[9], mx[N][3], mf[N][3];
    random_state(&seed, x);
    random_rotation(&seed, R);
    for (int i = 0; i < N; i++) {
      rotate_vector(R, x[i], Rx[i]);
      for (int d = 0; d < 3; d++) {
        mx[i][d] = d == 2 ? -x[i][d] : x[i][d];
        Rx[i][d] += d + 1;
      }
    }
    forces_of(&bends, x, f);
    forces_of(&bends, Rx, Rf);
    forces_of(&mirrored, mx, mf);
    // angles follow positions of size 5 to some 1e-15
    assert_close(energy_of(&bends, Rx), energy_of(&bends, x), 1e-13, 0);
    assert_close(energy_of(&mirrored, mx), energy_of(&bends, x), 1e-14, 0);
    for (int i = 0; i < N; i++) {
      double turned[3];
      rotate_vector(R, f[i], turned);
      for (int d = 0; d < 3; d++) {
        assert_close(Rf[i][d], turned[d], 0, 2e-12);
        assert_close(mf[i][d], d == 2 ? -f[i][d] : f[i][d], 0, 1e-13);
      }
    }
  }
}

// phi = 2 sin(theta/2) for each angle, up to the neighbour lying on the triangle.
static void angles_up_to_a_half_turn(void **state)
{
  (void)state;
  for (int degrees = -180; degrees <= 180; degrees += 5) {
    const double theta = degrees * M_PI / 180;
    double x[N][3] = {{0, 0, 0}, {2, 0, 0}, {0.5, 1, 0}, {0}, {3, 3, 0}, {-3, 3, 0}};
    x[3][0] = 1.2;
    x[3][1] = -0.7 * cos(theta);
    x[3][2] = 0.7 * sin(theta);
    vsc_fold folds[FOLDS];
    folds_of(x, 0, folds);
    const double sign = abs(degrees) == 180 ? folds[0].phi[0] / 2 : 1;
    assert_close(fabs(sign), 1, 0, 1e-15);
    assert_close(folds[0].phi[0], abs(degrees) == 180 ? 2 * sign : 2 * sin(theta / 2), 0, 5e-16);
    assert_close(folds[0].slope[0], cos(theta / 2), 0, 5e-16);
    assert_close(folds[0].on_r.z[0], cos(theta) / 0.7, 0, 5e-15);
  }
}

// dphi/dt by a central difference, of error h^2; damping is what it leads by.
static void damping_follows_the_rates(void **state)
{
  (void)state;
  const vsc_bends bends = some_bends();
  uint64_t seed = 10;
  for (int round = 0; round < 100; round++) {
    const double h = 1e-4;
    double x[N][3], plus[N][3], minus[N][3];
    vsc_wide3 v[N], damped[N], shifted[N];
    vsc_wide rates[FOLDS];
    vsc_fold folds[FOLDS], after[FOLDS], before[FOLDS];
    random_state(&seed, x);
    for (int i = 0; i < N; i++) {
      double speed[3];
      random_fill(&seed, 1, speed, 3);
      v[i] = (vsc_wide3){vsc_splat(speed[0]), vsc_splat(speed[1]), vsc_splat(speed[2])};
      for (int d = 0; d < 3; d++) {
        plus[i][d] = x[i][d] + h * speed[d];
        minus[i][d] = x[i][d] - h * speed[d];
      }
    }
    folds_of(x, 3, folds);
    folds_of(plus, 3, after);
    folds_of(minus, 3, before);
    vsc_bend_rates(folds, v, rates);
    for (int i = 0; i < FOLDS; i++)
      assert_close((after[i].phi[3] - before[i].phi[3]) / (2 * h), rates[i][3], 0, 1e-5);
    vsc_bends moved = bends;
    const vsc_wide nothing[FOLDS] = {vsc_splat(0)};
    for (int j = 0; j < FOLDS; j++) moved.rest[j] -= rates[j];
    vsc_bend_forces(&bends, folds, rates, damped);
    vsc_bend_forces(&moved, folds, nothing, shifted);
    for (int i = 0; i < N; i++) assert_close(damped[i].y[3], shifted[i].y[3], 1e-12, 1e-12);
    assert_true(vsc_bend_square(&bends, rates)[3] > 0);
  }
}

// Where the triangle or its neighbour has no area nothing is infinite.
static void triangles_without_area_are_left_out(void **state)
{
  (void)state;
  const vsc_bends bends = some_bends();
  for (int moved = 0; moved < N; moved++)
    for (int onto = 0; onto < N; onto++) {
      double x[N][3], f[N][3];
      memcpy(x, bent, sizeof x);
      memcpy(x[moved], x[onto], sizeof x[moved]);
      forces_of(&bends, x, f);
      assert_true(isfinite(energy_of(&bends, x)));
      for (int i = 0; i < 3 * N; i++) assert_true(isfinite(f[i / 3][i % 3]));
    }
}

// ---- sheets

static vsc_membrane_def plate(double D, double nu)
{
  vsc_membrane_def def = vsc_default_membrane();
  def.bending = D;
  def.axial[0] = def.axial[1] = 1;
  def.area_modulus = nu / (1 - nu);  // nu = K/(E + K)
  return def;
}

static vsc_sheet make_sheet(const vsc_mesh *mesh, const vsc_membrane_def *def)
{
  vsc_sheet sheet;
  const vsc_surface surface = all_triangles(mesh);
  assert_int_equal(vsc_sheet_make(mesh, &surface, def, &sheet, NULL), VSC_OK);
  return sheet;
}

// Energy of triangle k of a sheet with its nodes at x.
static double triangle_energy(const vsc_sheet *sheet, size_t k, const double *x)
{
  double at[N][3];
  for (int i = 0; i < N; i++) memcpy(at[i], x + 3 * (size_t)sheet->nodes[k][i], sizeof at[i]);
  const vsc_bends bends = bends_of((const double(*)[FOLDS])sheet->G[k], sheet->fold[k]);
  return energy_of(&bends, (const double(*)[3])at);
}

static bool is_inner(const vsc_sheet *sheet, size_t k)
{
  for (int j = 0; j < FOLDS; j++)
    if (sheet->nodes[k][vsc_bend_fold_nodes[j][3]] == sheet->nodes[k][vsc_bend_fold_nodes[j][0]])
      return false;
  return true;
}

// The flat sheet with z = (k_11 x^2 + 2 k_12 x y + k_22 y^2)/2.
static void curve_sheet(const vsc_mesh *mesh, const double k[3], double *x)
{
  for (size_t n = 0; n < mesh->node_count; n++) {
    const double *flat = mesh->nodes + 3 * n;
    x[3 * n] = flat[0];
    x[3 * n + 1] = flat[1];
    x[3 * n + 2] =
        (k[0] * flat[0] * flat[0] + 2 * k[1] * flat[0] * flat[1] + k[2] * flat[1] * flat[1]) / 2;
  }
}

// D/2 [(k_11 + k_22)^2 - 2 (1 - nu)(k_11 k_22 - k_12^2)]
static double plate_energy(double D, double nu, const double k[3])
{
  const double trace = k[0] + k[2];
  return D / 2 * (trace * trace - 2 * (1 - nu) * (k[0] * k[2] - k[1] * k[1]));
}

// Any constant curvature of any flat sheet costs in each inner triangle what the plate's does. The
// slopes of at most 1e-4 change angles by their square.
static void any_sheet_bends_like_the_plate(void **state)
{
  (void)state;
  const struct {
    double hx, hy, jitter;
    sheet_cut cut;
  } sheets[] = {{1, 1, 0, CUT_ONE_WAY},   {1, 1, 0, CUT_BY_TURNS},  {1, 0.866, 0, CUT_LEANING},
                {1, 0.4, 0, CUT_ONE_WAY}, {1, 1, 0.3, CUT_ONE_WAY}, {1, 1, 0.3, CUT_BY_TURNS}};
  uint64_t seed = 8;
  for (size_t s = 0; s < sizeof sheets / sizeof *sheets; s++) {
    const double D = 2.5, nu = 0.3;
    const vsc_membrane_def def = plate(D, nu);
    vsc_mesh *mesh =
        sheet_mesh(8, 8, sheets[s].hx, sheets[s].hy, sheets[s].cut, sheets[s].jitter, 3);
    vsc_sheet sheet = make_sheet(mesh, &def);
    double *x = malloc(3 * mesh->node_count * sizeof *x);
    for (int round = 0; round < 30; round++) {
      double k[3];
      random_fill(&seed, 1e-5, k, 3);
      curve_sheet(mesh, k, x);
      size_t inner = 0;
      for (size_t t = 0; t < sheet.count; t++) {
        const double whole = plate_energy(D, nu, k) * sheet.area[t];
        const double own = triangle_energy(&sheet, t, x);
        if (is_inner(&sheet, t)) assert_close(own, whole, 1e-6, 0);
        inner += is_inner(&sheet, t);
      }
      assert_true(inner > 60);
    }
    free(x);
    vsc_sheet_free(&sheet);
    vsc_mesh_free(mesh);
  }
}

// A curved sheet at rest moved and turned as a whole stores nothing.
// A triangle with one neighbour: its free edges carry no moment, whichever numbers its corners have.
static void free_edges_carry_no_moment(void **state)
{
  (void)state;
  const double nu = 0.3, R[3] = {1, sqrt(1 - nu * nu), sqrt((1 - nu) / 2)};
  uint64_t seed = 21;
  for (int round = 0; round < 200; round++) {
    double first = 0;
    const double tip[2] = {random_between(&seed, -0.3, 1.3), random_between(&seed, 0.3, 1.5)};
    const double corners[3][2] = {{0, 0}, {1, 0}, {tip[0], tip[1]}};
    const double across[2] = {random_between(&seed, 0, 1), random_between(&seed, -1.5, -0.4)};
    for (int turn = 0; turn < 3; turn++) {
      double x[N][3] = {{0}}, G[3][FOLDS], energy = 0;
      bool has[FOLDS] = {false};
      for (int i = 0; i < 3; i++) memcpy(x[i], corners[(i + turn) % 3], 2 * sizeof(double));
      const int hinge = (3 - turn) % 3;
      has[hinge] = true;
      memcpy(x[3 + hinge], across, sizeof across);
      assert_true(vsc_bend_stiffness((const double(*)[3])x, has, 2, nu, G));
      for (int k = 0; k < 3; k++) energy += G[k][hinge] * G[k][hinge];
      if (turn == 0) first = energy;
      // a few hundred roundings of slopes that slender triangles make large
      assert_close(energy, first, 1e-11, 0);
      // M = C k in the basis whose first vector lies along edge 0
      const double k[3] = {G[0][hinge] - nu * G[1][hinge] / R[1], G[1][hinge] / R[1],
                           G[2][hinge] / R[2]};
      const double M[3] = {k[0] + nu * k[1], nu * k[0] + k[1], (1 - nu) / 2 * k[2]};
      const double along[2] = {x[1][0] - x[0][0], x[1][1] - x[0][1]};
      for (int i = 0; i < 3; i++) {
        if (has[i]) continue;
        const double *p = x[i], *q = x[(i + 1) % 3];
        const double edge[2] = {q[0] - p[0], q[1] - p[1]};
        const double size = hypot(edge[0], edge[1]) * hypot(along[0], along[1]);
        const double t[2] = {(edge[0] * along[0] + edge[1] * along[1]) / size,
                             (along[0] * edge[1] - along[1] * edge[0]) / size};
        const double moment = M[0] * t[1] * t[1] + M[1] * t[0] * t[0] - 2 * M[2] * t[0] * t[1];
        assert_close(moment, 0, 0, 1e-12 * sqrt(energy));
      }
    }
  }
}

static void rigid_motion_of_a_curved_sheet_is_free(void **state)
{
  (void)state;
  uint64_t seed = 9;
  const vsc_membrane_def def = plate(3, 0.2);
  vsc_mesh *mesh = sheet_mesh(6, 6, 1, 1, CUT_ONE_WAY, 0.25, 4);
  double *x = malloc(3 * mesh->node_count * sizeof *x);
  curve_sheet(mesh, (const double[3]){0.2, 0.1, -0.3}, x);
  memcpy(mesh->nodes, x, 3 * mesh->node_count * sizeof *x);
  vsc_sheet sheet = make_sheet(mesh, &def);
  for (int round = 0; round < 20; round++) {
    double R[9];
    random_rotation(&seed, R);
    for (size_t n = 0; n < mesh->node_count; n++) {
      rotate_vector(R, mesh->nodes + 3 * n, x + 3 * n);
      for (int d = 0; d < 3; d++) x[3 * n + (size_t)d] += 7 * d;
    }
    // angles of 20-mm positions to some 1e-14, squared, times M of at most some 100
    for (size_t t = 0; t < sheet.count; t++)
      assert_close(triangle_energy(&sheet, t, x), 0, 0, 1e-25);
  }
  free(x);
  vsc_sheet_free(&sheet);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_are_the_gradient),
      cmocka_unit_test(forces_neither_push_nor_turn),
      cmocka_unit_test(the_law_turns_and_mirrors),
      cmocka_unit_test(angles_up_to_a_half_turn),
      cmocka_unit_test(damping_follows_the_rates),
      cmocka_unit_test(triangles_without_area_are_left_out),
      cmocka_unit_test(any_sheet_bends_like_the_plate),
      cmocka_unit_test(free_edges_carry_no_moment),
      cmocka_unit_test(rigid_motion_of_a_curved_sheet_is_free),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
