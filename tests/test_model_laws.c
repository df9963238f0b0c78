// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of the springs law: stress = derivative of energy, objectivity, symmetries, degenerate
// axes, and its small-strain elasticity together with the volume energy, in closed form.
#include <stdbool.h>
#include <string.h>

#include "close.h"
#include "model/law_springs.h"
#include "model/law_volume.h"
#include "random.h"

// Moduli, rest stretch and K of one point; P and G are [axis][component].
typedef struct law {
  double axial[3], angular[3], rest, K;
} law;

static const law soft = {.axial = {7, 3, 2}, .angular = {1.5, 0.8, 2.2}, .rest = 1, .K = 0};
static const law active = {.axial = {90, 3, 2}, .angular = {1.5, 0.8, 2.2}, .rest = 0.8, .K = 0};
static const law whole = {.axial = {7, 3, 2}, .angular = {1.5, 0.8, 2.2}, .rest = 1, .K = 40};

static vsc_springs springs_of(const law *l)
{
  vsc_springs springs = {.rest_stretch = vsc_splat(l->rest)};
  for (int a = 0; a < 3; a++) {
    springs.axial[a] = vsc_splat(l->axial[a]);
    springs.angular[a] = vsc_splat(l->angular[a]);
  }
  return springs;
}

// Lane `lane` holds G, the others something else.
static vsc_frame_axes frame_in_lane(const double G[9], int lane, vsc_wide3 g[3])
{
  for (int a = 0; a < 3; a++) {
    g[a] = (vsc_wide3){vsc_splat(a + 0.5), vsc_splat(0.25), vsc_splat(-a)};
    g[a].x[lane] = G[3 * a];
    g[a].y[lane] = G[3 * a + 1];
    g[a].z[lane] = G[3 * a + 2];
  }
  return vsc_frame_of(g);
}

static double determinant(const double G[9])
{
  return G[0] * (G[4] * G[8] - G[5] * G[7]) - G[1] * (G[3] * G[8] - G[5] * G[6]) +
         G[2] * (G[3] * G[7] - G[4] * G[6]);
}

static double energy_of(const law *l, const double G[9])
{
  vsc_wide3 g[3];
  const vsc_springs springs = springs_of(l);
  const vsc_frame_axes frame = frame_in_lane(G, 2, g);
  const vsc_wide energy =
      vsc_springs_axial_energy(&springs, &frame) + vsc_springs_angular_energy(&springs, &frame);
  return energy[2] + vsc_volume_energy(l->K, determinant(G));
}

static void stress_of(const law *l, const double G[9], double P[9])
{
  vsc_wide3 g[3], stress[3];
  const vsc_springs springs = springs_of(l);
  const vsc_frame_axes frame = frame_in_lane(G, 1, g);
  const vsc_wide nothing[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  vsc_springs_stress(&springs, &frame, nothing, true, stress);
  const double pressure = vsc_volume_stress(vsc_splat(l->K), vsc_splat(determinant(G)))[0];
  for (int a = 0; a < 3; a++) {
    const double *b = G + 3 * ((a + 1) % 3), *c = G + 3 * ((a + 2) % 3);
    P[3 * a] = stress[a].x[1] + pressure * (b[1] * c[2] - b[2] * c[1]);
    P[3 * a + 1] = stress[a].y[1] + pressure * (b[2] * c[0] - b[0] * c[2]);
    P[3 * a + 2] = stress[a].z[1] + pressure * (b[0] * c[1] - b[1] * c[0]);
  }
}

static double dot9(const double a[9], const double b[9])
{
  double sum = 0;
  for (int i = 0; i < 9; i++) sum += a[i] * b[i];
  return sum;
}

// Rows of G turned by R: g_a -> R g_a.
static void turned(const double R[9], const double G[9], double RG[9])
{
  for (int a = 0; a < 3; a++) rotate_vector(R, G + 3 * a, RG + 3 * a);
}

static void moved(const double G[9], double size, const double D[9], double result[9])
{
  for (int i = 0; i < 9; i++) result[i] = G[i] + size * D[i];
}

static double difference_error(const law *l, const double G[9], const double D[9], double h)
{
  double plus[9], minus[9], P[9];
  moved(G, h, D, plus);
  moved(G, -h, D, minus);
  stress_of(l, G, P);
  return fabs((energy_of(l, plus) - energy_of(l, minus)) / (2 * h) - dot9(P, D));
}

// (psi(G + hD) - psi(G - hD))/2h - P:D = h^2 psi'''/6 + O(h^4), summed over random directions D (in
// one of them psi''' may vanish): halving h divides it by 4. The next term is some h^2 of it.
static void check_derivative(const law *l, const double G[9], uint64_t *seed)
{
  enum { DIRECTIONS = 20, STEPS = 4 };
  double errors[STEPS] = {0};
  for (int d = 0; d < DIRECTIONS; d++) {
    double D[9];
    random_fill(seed, 1, D, 9);
    for (int k = 0; k < STEPS; k++) errors[k] += difference_error(l, G, D, ldexp(1, -7 - k));
  }
  for (int k = 0; k + 1 < STEPS; k++) assert_close(log2(errors[k] / errors[k + 1]), 2, 0, 0.02);
}

static const double states[][9] = {
    {1, 0, 0, 0, 1, 0, 0, 0, 1},         // rest
    {1.4, 0, 0, 0, 0.9, 0, 0, 0, 0.8},   // stretch
    {0.6, 0, 0, 0, 0.7, 0, 0, 0, 0.65},  // compression
    {1, 0, 0, 0.5, 1, 0, -0.2, 0.3, 1},  // shear
    {1.2, 0.3, -0.1, 0.2, 0.8, 0.4, -0.3, 0.1, 0.9},
};
enum { STATES = sizeof states / sizeof states[0] };

static void stress_is_the_derivative_of_energy(void **state)
{
  (void)state;
  const law *laws[] = {&soft, &active, &whole};
  uint64_t seed = 11;
  for (int l = 0; l < 3; l++)
    for (int s = 0; s < STATES; s++)
      for (int round = 0; round < 5; round++) {
        double R[9], G[9];
        random_rotation(&seed, R);
        turned(R, states[s], G);
        check_derivative(laws[l], G, &seed);
      }
}

static void each_part_is_a_gradient_of_its_own(void **state)
{
  (void)state;
  uint64_t seed = 12;
  for (int part = 0; part < 6; part++) {
    law one = {.rest = 0.9};
    if (part < 3)
      one.axial[part] = 5;
    else
      one.angular[part - 3] = 5;
    check_derivative(&one, states[4], &seed);
  }
}

static void rigid_rotation_costs_nothing(void **state)
{
  (void)state;
  uint64_t seed = 13;
  for (int round = 0; round < 1000; round++) {
    double R[9], P[9];
    random_rotation(&seed, R);
    stress_of(&whole, R, P);
    // R is orthonormal to some 1e-16, times moduli of 40
    for (int i = 0; i < 9; i++) assert_close(P[i], 0, 0, 40 * 2e-15);
    assert_close(energy_of(&whole, R), 0, 0, 1e-28);
  }
}

static void the_law_turns_with_the_body(void **state)
{
  (void)state;
  const law *laws[] = {&soft, &active, &whole};
  uint64_t seed = 14;
  for (int round = 0; round < 1000; round++) {
    const law *l = laws[round % 3];
    const double *G = states[round % STATES];
    double R[9], RG[9], P[9], RP[9], P_of_RG[9];
    random_rotation(&seed, R);
    turned(R, G, RG);
    stress_of(l, G, P);
    turned(R, P, RP);
    stress_of(l, RG, P_of_RG);
    for (int i = 0; i < 9; i++) assert_close(P_of_RG[i], RP[i], 0, 1e-15 * 200);
    assert_close(energy_of(l, RG), energy_of(l, G), 1e-14, 1e-15);
  }
}

// Moments balance in each point: sum_a g_a x P_a = 0, that is S symmetric.
static void the_stress_has_no_torque(void **state)
{
  (void)state;
  uint64_t seed = 15;
  for (int round = 0; round < 1000; round++) {
    double G[9], P[9];
    random_fill(&seed, 1.5, G, 9);
    stress_of(&whole, G, P);
    const double size = sqrt(dot9(P, P) * dot9(G, G));
    for (int i = 0; i < 3; i++) {
      const int j = (i + 1) % 3, k = (i + 2) % 3;
      double torque = 0;
      for (int a = 0; a < 3; a++)
        torque += G[3 * a + j] * P[3 * a + k] - G[3 * a + k] * P[3 * a + j];
      assert_close(torque, 0, 0, 1e-15 * size);
    }
  }
}

// Axes by another name: moduli and axes permuted together give permuted forces. Pairs are
// fs, sn, nf; exchanging f and s exchanges sn and nf.
static void the_names_of_the_axes_do_not_matter(void **state)
{
  (void)state;
  static const int axes[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};
  static const int pairs[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int p = 0; p < 6; p++) {
    law other = soft;
    double P[9], P_other[9], G_other[9];
    const double *G = states[4];
    for (int a = 0; a < 3; a++) {
      other.axial[a] = soft.axial[axes[p][a]];
      other.angular[a] = soft.angular[pairs[p][a]];
      memcpy(G_other + 3 * a, G + 3 * axes[p][a], 3 * sizeof(double));
    }
    stress_of(&soft, G, P);
    stress_of(&other, G_other, P_other);
    assert_close(energy_of(&other, G_other), energy_of(&soft, G), 1e-14, 0);
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < 3; i++) assert_close(P_other[3 * a + i], P[3 * axes[p][a] + i], 0, 1e-14);
  }
}

// dP/d(size) at rest along D: central differences of 2^-7 and its half and quarter, extrapolated
// twice: the error is O(h^6) = 1e-13 times a higher derivative, and rounding 1e-16 K / h.
static void rest_slope(const law *l, const double D[9], double slope[9])
{
  double table[3][9];
  for (int k = 0; k < 3; k++) {
    const double h = ldexp(1, -7 - k);
    double G[9], plus[9], minus[9];
    moved(states[0], h, D, G);
    stress_of(l, G, plus);
    moved(states[0], -h, D, G);
    stress_of(l, G, minus);
    for (int i = 0; i < 9; i++) table[k][i] = (plus[i] - minus[i]) / (2 * h);
  }
  for (int i = 0; i < 9; i++) {
    const double first = (4 * table[1][i] - table[0][i]) / 3;
    const double second = (4 * table[2][i] - table[1][i]) / 3;
    slope[i] = (16 * second - first) / 15;
  }
}

// C = diag(E_f, E_s, E_n) + K (all ones) on the normal strains; shear moduli G_ab; nothing else.
static void small_strain_elasticity_is_the_closed_form(void **state)
{
  (void)state;
  const double atol = 4e-12;  // moduli of 40 times the extrapolation's 1e-13
  for (int b = 0; b < 3; b++) {
    double D[9] = {0}, slope[9];
    D[4 * b] = 1;
    rest_slope(&whole, D, slope);
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < 3; i++) {
        const double expected = a == i ? whole.K + (a == b ? whole.axial[a] : 0) : 0;
        assert_close(slope[3 * a + i], expected, 0, atol);
      }
  }
  for (int pair = 0; pair < 3; pair++) {
    // engineering shear 1 of the pair (a, b): strain 1/2 on both sides
    const int a = pair, b = (pair + 1) % 3;
    double D[9] = {0}, slope[9];
    D[3 * a + b] = D[3 * b + a] = 0.5;
    rest_slope(&whole, D, slope);
    for (int i = 0; i < 9; i++) {
      const bool sheared = i == 3 * a + b || i == 3 * b + a;
      assert_close(slope[i], sheared ? whole.angular[pair] : 0, 0, atol);
    }
    D[3 * b + a] = -0.5;  // a small rotation
    rest_slope(&whole, D, slope);
    for (int i = 0; i < 9; i++) assert_close(slope[i], 0, 0, atol);
  }
}

// E_a = 2 mu, G = mu, K = lambda: the stress of any small strain is 2 mu e + lambda tr(e) I.
static void springs_of_two_mu_and_mu_are_isotropic(void **state)
{
  (void)state;
  const double mu = 3, lambda = 11;
  const law isotropic = {
      .axial = {2 * mu, 2 * mu, 2 * mu}, .angular = {mu, mu, mu}, .rest = 1, .K = lambda};
  uint64_t seed = 16;
  for (int round = 0; round < 100; round++) {
    double D[9], slope[9];
    random_fill(&seed, 1, D, 9);
    rest_slope(&isotropic, D, slope);
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < 3; i++) {
        const double strain = 0.5 * (D[3 * a + i] + D[3 * i + a]);
        const double trace = a == i ? D[0] + D[4] + D[8] : 0;
        assert_close(slope[3 * a + i], 2 * mu * strain + lambda * trace, 0, 2e-11);
      }
  }
}

// What pulls along an axis is added along its unit vector and nowhere else.
static void along_pulls_along_the_axis(void **state)
{
  (void)state;
  const vsc_springs springs = springs_of(&soft);
  const vsc_wide nothing[3] = {vsc_splat(0), vsc_splat(0), vsc_splat(0)};
  const vsc_wide pull[3] = {vsc_splat(2), vsc_splat(-3), vsc_splat(5)};
  vsc_wide3 g[3], without[3], with[3];
  const vsc_frame_axes frame = frame_in_lane(states[4], 3, g);
  vsc_springs_stress(&springs, &frame, nothing, true, without);
  vsc_springs_stress(&springs, &frame, pull, true, with);
  for (int a = 0; a < 3; a++) {
    const double *G = states[4] + 3 * a;
    const double length = sqrt(G[0] * G[0] + G[1] * G[1] + G[2] * G[2]);
    assert_close(with[a].x[3] - without[a].x[3], pull[a][3] * G[0] / length, 0, 1e-14);
    assert_close(with[a].y[3] - without[a].y[3], pull[a][3] * G[1] / length, 0, 1e-14);
    assert_close(with[a].z[3] - without[a].z[3], pull[a][3] * G[2] / length, 0, 1e-14);
  }
}

// By hand: f stretched to 2 along x, s turned by 60 degrees towards it, n at rest. c_fs = 1/2.
// P_f = E_f 1 x + G_fs 1/2 (s - x/2)/2;  P_s = G_fs 1/2 (x - s/2).
static void a_case_by_hand(void **state)
{
  (void)state;
  const double r = sqrt(3) / 2;
  const double G[9] = {2, 0, 0, 0.5, r, 0, 0, 0, 1};
  const double expected[9] = {7, 1.5 / 4 * r, 0, 1.5 / 2 * 0.75, -1.5 / 4 * r, 0, 0, 0, 0};
  double P[9];
  stress_of(&soft, G, P);
  for (int i = 0; i < 9; i++) assert_close(P[i], expected[i], 0, 2e-15);
  assert_close(energy_of(&soft, G), 7 / 2. + 1.5 / 8, 1e-15, 0);
}

// An axis of next to no length gives no force along or across it, and the two others keep theirs.
static void degenerate_axes_are_left_out(void **state)
{
  (void)state;
  for (int a = 0; a < 3; a++) {
    const double lengths[] = {0, 1e-300, 1e-20, 1e-17};
    for (int k = 0; k < 4; k++) {
      law others = soft;
      double G[9], without[9], P[9];
      memcpy(G, states[4], sizeof G);
      others.axial[a] = others.angular[a] = others.angular[(a + 2) % 3] = 0;
      stress_of(&others, G, without);
      for (int i = 0; i < 3; i++) G[3 * a + i] = i == 1 ? lengths[k] : 0;
      stress_of(&soft, G, P);
      for (int i = 0; i < 9; i++) {
        if (i / 3 == a)
          assert_close(P[i], 0, 0, 1e-12);
        else
          assert_close(P[i], without[i], 0, 1e-14);
      }
      assert_true(isfinite(energy_of(&soft, G)));
    }
  }
  double nothing[9] = {0}, P[9];
  stress_of(&whole, nothing, P);
  for (int i = 0; i < 9; i++) assert_true(P[i] == 0);
}

// Down to VSC_SHORTEST_AXIS a short axis has a direction; below, forces fade with it from what they were there.
static void a_short_axis_is_still_an_axis(void **state)
{
  (void)state;
  const double G[9] = {1.01 * VSC_SHORTEST_AXIS, 0, 0, 0, 1, 0, 0, 0, 1};
  double P[9];
  stress_of(&soft, G, P);
  assert_close(P[0], 7 * (1.01 * VSC_SHORTEST_AXIS - 1), 1e-9, 0);
  for (int i = 1; i < 9; i++) assert_close(P[i], 0, 0, 1e-9);
  double before[9];
  for (int side = 0; side < 2; side++) {
    const double n = VSC_SHORTEST_AXIS * (side ? 1 - 1e-9 : 1 + 1e-9);
    const double skewed[9] = {0.8 * n, 0.6 * n, 0, 0, 1, 0, 0, 0, 1};
    stress_of(&soft, skewed, P);
    for (int i = 0; i < 9 && side; i++) assert_close(P[i], before[i], 0, 1e-5);
    memcpy(before, P, sizeof before);
  }
  // moduli of the frame's angles over 1e-4 at most, whatever is left of the axis
  for (int k = 3; k < 20; k++) {
    const double n = pow(10, -k), skewed[9] = {0.8 * n, 0.6 * n, 0, 0, 1, 0, 0, 0, 1};
    stress_of(&soft, skewed, P);
    for (int i = 0; i < 3; i++) assert_close(P[i], 0, 0, 1e6 * n);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(stress_is_the_derivative_of_energy),
      cmocka_unit_test(each_part_is_a_gradient_of_its_own),
      cmocka_unit_test(rigid_rotation_costs_nothing),
      cmocka_unit_test(the_law_turns_with_the_body),
      cmocka_unit_test(the_stress_has_no_torque),
      cmocka_unit_test(the_names_of_the_axes_do_not_matter),
      cmocka_unit_test(small_strain_elasticity_is_the_closed_form),
      cmocka_unit_test(springs_of_two_mu_and_mu_are_isotropic),
      cmocka_unit_test(along_pulls_along_the_axis),
      cmocka_unit_test(a_case_by_hand),
      cmocka_unit_test(degenerate_axes_are_left_out),
      cmocka_unit_test(a_short_axis_is_still_an_axis),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
