// SPDX-License-Identifier: GPL-3.0-or-later
// The stiffness of springs at rest, and springs for a wanted stiffness.
#include "close.h"

#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "model/calibration.h"
#include "model/elasticity.h"
#include "model/law_springs.h"
#include "model/law_volume.h"
#include "random.h"

// ---- a material with all that the law has

static vsc_material_def springs_of(const double axial[3], const double angular[3], double K)
{
  vsc_material_def material = vsc_default_material();
  memcpy(material.axial, axial, sizeof material.axial);
  memcpy(material.angular, angular, sizeof material.angular);
  material.volume_modulus = K;
  return material;
}

static vsc_axis_def more_axes[] = {{{1, 2, -0.5}, 6, 0}, {{-1, 0.4, 3}, 3, 0}};
static vsc_pair_def more_pairs[] = {{{0, 3}, 5}, {{4, 3}, 2.5}};

static vsc_material_def rich_material(void)
{
  vsc_material_def material = springs_of((double[]){12, 5, 3}, (double[]){2, 4, 1.5}, 40);
  material.axis_count = material.pair_count = 2;
  material.axes = more_axes;
  material.pairs = more_pairs;
  material.stabilization = 7;
  return material;
}

static void compliance_of(const vsc_material_def *material, double S[36])
{
  double C[36];
  assert_int_equal(vsc_stiffness_of(material, VSC_VOLUME_ELEMENT, C, NULL), VSC_OK);
  assert_int_equal(vsc_invert_six(C, S, NULL), VSC_OK);
}

// The nine numbers of any compliance.
static vsc_moduli moduli_of(const double S[36])
{
  vsc_moduli moduli;
  for (int a = 0; a < 3; a++) {
    const vsc_named_direction d = vsc_direction(a), e = vsc_direction((a + 1) % 3);
    moduli.young[a] = vsc_young(S, d.d);
    moduli.shear[a] = vsc_shear(S, d.d, e.d);
    moduli.poisson[a] = vsc_poisson(S, d.d, e.d);
  }
  return moduli;
}

// The energy of the law as it is written in its headers, at the axes g = (1 + strain) axis.
static double energy_of(const vsc_material_def *material, const double strain[6])
{
  const double F[9] = {1 + strain[0], strain[5] / 2, strain[4] / 2, strain[5] / 2, 1 + strain[1],
                       strain[3] / 2, strain[4] / 2, strain[3] / 2, 1 + strain[2]};
  vsc_springs law = {.rest_stretch = vsc_splat(1)};
  vsc_wide3 wide[3];
  double u[8][3], rest[8][3], length[8], normal[3];
  for (int a = 0; a < 3 + (int)material->axis_count; a++) {
    for (int i = 0; i < 3; i++) rest[a][i] = a < 3 ? a == i : material->axes[a - 3].direction[i];
    vsc_normalize(rest[a]);
    rotate_vector(F, rest[a], u[a]);
    length[a] = vsc_normalize(u[a]);
  }
  for (int a = 0; a < 3; a++) {
    law.axial[a] = vsc_splat(material->axial[a]);
    law.angular[a] = vsc_splat(material->angular[a]);
    wide[a] = (vsc_wide3){vsc_splat(F[a]), vsc_splat(F[3 + a]), vsc_splat(F[6 + a])};
  }
  const vsc_frame_axes frame = vsc_frame_of(wide);
  double energy =
      vsc_springs_axial_energy(&law, &frame)[0] + vsc_springs_angular_energy(&law, &frame)[0];
  for (size_t k = 0; k < material->axis_count; k++)
    energy += material->axes[k].modulus * pow(length[3 + k] - 1, 2) / 2;
  for (size_t p = 0; p < material->pair_count; p++) {
    const int a = material->pairs[p].axes[0], b = material->pairs[p].axes[1];
    energy +=
        material->pairs[p].modulus * pow(vsc_dot(u[a], u[b]) - vsc_dot(rest[a], rest[b]), 2) / 2;
  }
  vsc_cross(F, F + 3, normal);
  return energy + vsc_volume_energy(material->volume_modulus, vsc_dot(normal, F + 6));
}

static void test_stiffness_is_second_derivative_of_energy(void **state)
{
  (void)state;
  const vsc_material_def material = rich_material();
  uint64_t seed = 11;
  double C[36];
  assert_int_equal(vsc_stiffness_of(&material, VSC_VOLUME_ELEMENT, C, NULL), VSC_OK);
  for (int trial = 0; trial < 50; trial++) {
    const double h = 1e-4;
    double direction[6], plus[6], minus[6];
    random_fill(&seed, 1, direction, 6);
    for (int i = 0; i < 6; i++) {
      plus[i] = h * direction[i];
      minus[i] = -plus[i];
    }
    const double second = (energy_of(&material, plus) + energy_of(&material, minus)) / (h * h);
    // the even part leaves terms of h^2, with factors of some tens; rounding of the energy of the
    // volume (K times 1e-16) over h^2
    assert_close(second, vsc_product_six(direction, C, direction), 1e-6, 1e-6);
  }
}

static void test_stabilization_counts_beside_shared_volume(void **state)
{
  (void)state;
  const vsc_material_def material = rich_material();
  double own[36], shared[36];
  assert_int_equal(vsc_stiffness_of(&material, VSC_VOLUME_ELEMENT, own, NULL), VSC_OK);
  assert_int_equal(vsc_stiffness_of(&material, VSC_VOLUME_NODAL, shared, NULL), VSC_OK);
  for (int i = 0; i < 36; i++)
    assert_close(shared[i] - own[i], i / 6 < 3 && i % 6 < 3 ? 7 : 0, 0, 1e-13);
}

static void test_other_laws_have_no_stiffness(void **state)
{
  (void)state;
  vsc_material_def material = rich_material();
  double C[36];
  vsc_error error;
  material.law = VSC_LAW_PAPER;
  vsc_copy_name(material.name, "seed");
  assert_int_equal(vsc_stiffness_of(&material, VSC_VOLUME_NODAL, C, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "seed"));
  material = springs_of((double[]){1, 1, 0}, (double[]){1, 0, 0}, 0);
  assert_int_equal(vsc_stiffness_of(&material, VSC_VOLUME_NODAL, C, &error), VSC_OK);
  assert_int_equal(vsc_invert_six(C, C, &error), VSC_NUMERICAL);
}

static void test_three_axes_in_closed_form(void **state)
{
  (void)state;
  uint64_t seed = 5;
  for (int trial = 0; trial < 30; trial++) {
    double E[3], G[3], S[36], sum = 0;
    for (int a = 0; a < 3; a++) {
      E[a] = random_between(&seed, 1, 20);
      G[a] = random_between(&seed, 1, 20);
      sum += 1 / E[a];
    }
    const double K = random_between(&seed, 1, 500);
    const vsc_material_def material = springs_of(E, G, K);
    compliance_of(&material, S);
    // 1e-12: K / E, up to 500, times some roundings
    for (int i = 0; i < 9; i++) {
      const int a = i / 3, b = i % 3;
      const double wanted = (a == b ? 1 / E[a] : 0) - K / (1 + K * sum) / (E[a] * E[b]);
      assert_close(S[6 * a + b], wanted, 0, 1e-12);
    }
    assert_close(1 / S[35], G[0], 1e-14, 0);
    assert_close(1 / S[21], G[1], 1e-14, 0);
    assert_close(1 / S[28], G[2], 1e-14, 0);
  }
}

static void test_incompressible_limit(void **state)
{
  (void)state;
  const vsc_material_def material =
      springs_of((double[]){10, 4, 3}, (double[]){1, 2, 3}, 1e7);  // errors are E / K
  double S[36];
  compliance_of(&material, S);
  const vsc_moduli moduli = moduli_of(S);
  assert_close(moduli.young[0], 10 + 12.0 / 7, 1e-5, 0);
  assert_close(moduli.young[1], 4 + 30.0 / 13, 1e-5, 0);
  assert_close(moduli.young[2], 3 + 40.0 / 14, 1e-5, 0);
  assert_close(moduli.poisson[0], 3.0 / 7, 1e-5, 0);
}

// Springs on turned axes are the turned material.
static void test_turned_springs(void **state)
{
  (void)state;
  uint64_t seed = 3;
  for (int trial = 0; trial < 20; trial++) {
    const vsc_material_def straight = springs_of((double[]){9, 4, 2}, (double[]){3, 1, 5}, 30);
    vsc_material_def turned = springs_of((double[3]){0}, (double[3]){0}, 30);
    double R[9], S[36], T[36], d[3], e[3], help[3], Rd[3], Re[3];
    vsc_axis_def axes[3] = {{.modulus = 9}, {.modulus = 4}, {.modulus = 2}};
    vsc_pair_def pairs[3] = {{{3, 4}, 3}, {{4, 5}, 1}, {{5, 3}, 5}};
    random_rotation(&seed, R);
    for (int i = 0; i < 9; i++) axes[i % 3].direction[i / 3] = 1.7 * R[i];  // R times an axis
    turned.axis_count = turned.pair_count = 3;
    turned.axes = axes;
    turned.pairs = pairs;
    compliance_of(&straight, S);
    compliance_of(&turned, T);
    random_fill(&seed, 1, d, 3);
    random_fill(&seed, 1, help, 3);
    vsc_normalize(d);
    vsc_cross(d, help, e);
    vsc_normalize(e);
    rotate_vector(R, d, Rd);
    rotate_vector(R, e, Re);
    assert_close(vsc_young(T, Rd), vsc_young(S, d), 1e-12, 0);
    assert_close(vsc_shear(T, Rd, Re), vsc_shear(S, d, e), 1e-12, 0);
    assert_close(vsc_poisson(T, Rd, Re), vsc_poisson(S, d, e), 0, 1e-12);
  }
}

// With G = E rather than E/2: 1.3333, 1.6, 2, 2.4 at 0, 22.5, 45 degrees and along (1,1,1).
static void test_directions_that_are_no_axes(void **state)
{
  (void)state;
  const double one[3] = {1, 1, 1}, half[3] = {0.5, 0.5, 0.5};
  const vsc_material_def uneven = springs_of(one, one, 1), even = springs_of(one, half, 1);
  const double oblique[3] = {cos(M_PI / 8), sin(M_PI / 8), 0};
  double S[36], T[36];
  compliance_of(&uneven, S);
  compliance_of(&even, T);
  assert_close(vsc_young(S, vsc_direction(0).d), 4.0 / 3, 1e-14, 0);
  assert_close(vsc_young(S, oblique), 1.6, 1e-14, 0);
  assert_close(vsc_young(S, vsc_direction(3).d), 2, 1e-14, 0);
  assert_close(vsc_young(S, vsc_direction(9).d), 2.4, 1e-14, 0);
  const vsc_young_range range = vsc_young_over_sphere(S), flat = vsc_young_over_sphere(T);
  assert_close(range.low, 4.0 / 3, 1e-14, 0);
  assert_close(range.high, 2.4, 1e-14, 0);
  assert_true(range.mean > 1.6 && range.mean < 2.1);
  assert_close(flat.low, 4.0 / 3, 1e-13, 0);
  assert_close(flat.high, 4.0 / 3, 1e-13, 0);
  assert_close(flat.mean, 4.0 / 3, 1e-12, 0);  // a sum of 20,000
}

// ---- the inverse

static void test_isotropic(void **state)
{
  (void)state;
  vsc_moduli moduli;
  vsc_spring_constants springs;
  for (double nu = 0.1; nu < 0.5; nu += 0.13) {
    const double E = 10, mu = E / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
    assert_int_equal(vsc_moduli_isotropic(E, nu, &moduli, NULL), VSC_OK);
    assert_int_equal(vsc_calibrate(&moduli, 3, &springs, NULL), VSC_OK);
    for (int a = 0; a < 3; a++) {
      assert_close(springs.axial[a], 2 * mu, 1e-11, 0);
      assert_close(springs.angular[a], mu, 1e-12, 0);
    }
    assert_close(springs.volume_modulus, lambda, 1e-11, 0);
    assert_close(springs.least_energy, 1, 0, 1e-12);
    assert_close(springs.most_energy, 1, 0, 1e-12);
  }
}

static void test_springs_come_back(void **state)
{
  (void)state;
  uint64_t seed = 9;
  for (int trial = 0; trial < 50; trial++) {
    double E[3], G[3], S[36];
    for (int a = 0; a < 3; a++) {
      E[a] = random_between(&seed, 0.5, 20);
      G[a] = random_between(&seed, 0.5, 20);
    }
    const double K = random_between(&seed, 1, 200);
    const vsc_material_def material = springs_of(E, G, K);
    compliance_of(&material, S);
    const vsc_moduli moduli = moduli_of(S);
    vsc_spring_constants springs;
    assert_int_equal(vsc_calibrate(&moduli, 3, &springs, NULL), VSC_OK);
    // the condition of the matrix, K / E, up to 400, times roundings
    for (int a = 0; a < 3; a++) {
      assert_close(springs.axial[a], E[a], 1e-10, 0);
      assert_close(springs.angular[a], G[a], 1e-12, 0);
    }
    assert_close(springs.volume_modulus, K, 1e-10, 0);
  }
}

static void test_incompressible_example(void **state)
{
  (void)state;
  vsc_moduli wanted = {.young = {10, 4, 3}, .shear = {3, 2, 3}};
  double E[3], S[36];
  assert_int_equal(vsc_axial_incompressible(wanted.young, E, NULL), VSC_OK);
  assert_close(E[0], 9.694, 0, 5e-4);
  assert_close(E[1], 3.677, 0, 5e-4);
  assert_close(E[2], 0.334, 0, 5e-4);
  const vsc_material_def material = springs_of(E, wanted.shear, 1e6);
  compliance_of(&material, S);
  const vsc_moduli got = moduli_of(S);
  for (int a = 0; a < 3; a++) assert_close(got.young[a], wanted.young[a], 1e-5, 0);  // E / K
  // the same moduli with the ratios that follow, as an ordinary material
  assert_int_equal(vsc_moduli_incompressible(1e6, &wanted, NULL), VSC_OK);
  for (int a = 0; a < 3; a++) assert_close(got.poisson[a], wanted.poisson[a], 0, 1e-5);
}

// All-round pressure p shortens each axis by p / (3K), whatever Young's moduli are.
static void test_bulk_modulus(void **state)
{
  (void)state;
  vsc_moduli moduli = {.young = {10, 4, 3}, .shear = {3, 2, 3}};
  double S[36];
  assert_int_equal(vsc_moduli_incompressible(250, &moduli, NULL), VSC_OK);
  vsc_moduli_compliance(&moduli, S);
  for (int a = 0; a < 3; a++)
    assert_close(S[6 * a] + S[6 * a + 1] + S[6 * a + 2], 1 / (3 * 250.0), 0, 1e-15);
}

// |M - 1|^2, M = C_wanted^-1/2 C_springs C_wanted^-1/2, from the traces of S_wanted C_springs.
static double misfit(const vsc_moduli *moduli, const vsc_spring_constants *springs)
{
  vsc_material_def material;
  double S[36], C[36], P[36] = {0}, sum = 6;
  vsc_moduli_compliance(moduli, S);
  assert_int_equal(vsc_material_of_springs(springs, &material, NULL), VSC_OK);
  assert_int_equal(vsc_stiffness_of(&material, VSC_VOLUME_ELEMENT, C, NULL), VSC_OK);
  vsc_free(material.axes);
  for (int i = 0; i < 36; i++)
    for (int k = 0; k < 6; k++) P[i] += S[6 * (i / 6) + k] * C[6 * k + i % 6];
  for (int i = 0; i < 36; i++) sum += P[i] * P[6 * (i % 6) + i / 6] - (i % 7 == 0 ? 2 * P[i] : 0);
  return sum;
}

// No constant can be made larger or smaller to come nearer.
static void test_nothing_comes_nearer(void **state)
{
  (void)state;
  const vsc_moduli wishes[] = {
      {{10, 4, 3}, {3, 2, 3}, {0.3, 0.2, 0.1}},   // three couplings: not with three axes
      {{3, 8, 8}, {2, 3, 2}, {0.49, -0.3, 1.3}},  // softest along the fibre: E_f = 0
      {{10, 10, 10}, {6, 6, 6}, {-0.2, -0.2, -0.2}}};
  for (int w = 0; w < 3; w++)
    for (int axes = 3; axes <= 13; axes += axes == 3 ? 6 : 4) {
      vsc_spring_constants springs;
      assert_int_equal(vsc_calibrate(&wishes[w], axes, &springs, NULL), VSC_OK);
      const double best = misfit(&wishes[w], &springs);
      double *constants = springs.axial;  // the struct begins with eleven numbers
      for (int u = 0; u < (axes == 3 ? 7 : axes == 9 ? 10 : 11); u++) {
        const double kept = constants[u], least = u == 6 ? 0.0101 : 0;
        if (kept < 0) fail_msg("wish %d, %d axes: constant %d is %g", w, axes, u, kept);
        for (int side = -1; side <= 1; side += 2) {
          constants[u] = kept + 0.01 * side;
          if (constants[u] >= least) assert_true(misfit(&wishes[w], &springs) > best - 1e-9);
        }
        constants[u] = kept;
      }
      assert_true(springs.least_energy <= 1 + 1e-8 && springs.most_energy >= 1 - 1e-8);
    }
}

// The face diagonals make the couplings independent: all nine moduli.
static void test_nine_axes_match_nine_moduli(void **state)
{
  (void)state;
  const vsc_moduli wanted = {{10, 4, 3}, {3, 2, 3}, {0.3, 0.2, 0.1}};
  vsc_spring_constants springs, three;
  vsc_material_def material;
  double S[36];
  assert_int_equal(vsc_calibrate(&wanted, 9, &springs, NULL), VSC_OK);
  assert_int_equal(vsc_material_of_springs(&springs, &material, NULL), VSC_OK);
  assert_int_equal(material.axis_count, 4);  // one coupling is K's
  compliance_of(&material, S);
  vsc_free(material.axes);
  const vsc_moduli got = moduli_of(S);
  for (int a = 0; a < 3; a++) {
    assert_close(got.young[a], wanted.young[a], 1e-8, 0);
    assert_close(got.shear[a], wanted.shear[a], 1e-8, 0);
    assert_close(got.poisson[a], wanted.poisson[a], 1e-8, 0);
  }
  // three axes can't, and say by how much
  assert_int_equal(vsc_calibrate(&wanted, 3, &three, NULL), VSC_OK);
  assert_true(three.least_energy < 0.95 && three.most_energy > 1.05);
}

static void refused(const vsc_moduli *moduli, const char *what)
{
  vsc_error error = {0};
  vsc_spring_constants springs;
  assert_int_equal(vsc_calibrate(moduli, 3, &springs, &error), VSC_INPUT);
  if (strstr(error.text, what) == NULL) fail_msg("'%s' lacks '%s'", error.text, what);
}

static void test_refuses_what_no_material_has(void **state)
{
  (void)state;
  vsc_error error;
  vsc_moduli none;
  refused(&(vsc_moduli){{10, -4, 3}, {3, 2, 3}, {0}}, "Young's modulus s, -4 kPa");
  refused(&(vsc_moduli){{10, 4, 3}, {3, 2, 0}, {0}}, "shear modulus nf, 0 kPa");
  refused(&(vsc_moduli){{4, 16, 3}, {3, 2, 3}, {0.6, 0, 0}}, "Poisson's ratio fs, 0.6");
  refused(&(vsc_moduli){{1, 1, 1}, {1, 1, 1}, {0.5, 0.6, 0.7}}, "fs 0.5, sn 0.6, nf 0.7");
  assert_int_equal(vsc_moduli_isotropic(10, 0.5, &none, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "0.5"));
  vsc_moduli soft = {{1, 9, 9}, {1, 1, 1}, {0}};  // 1 > 1/3 + 1/3
  assert_int_equal(vsc_moduli_incompressible(1e4, &soft, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "along f, 1 kPa"));
  soft.young[0] = 9;
  assert_int_equal(vsc_moduli_incompressible(0.9, &soft, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "0.9 kPa"));
}

// Small strain of published laws of passive myocardium: both have the channels of the springs and
// no others, so that in the incompressible limit nothing of them is lost.
//   Guccione, C = 2 kPa, b = 8, 2, 4 (Land et al. 2015): E = C b = 16, 4, 4; G = 4, 2, 4.
//   Holzapfel & Ogden, a = 0.059, af = 18.472, as = 2.481, afs = 0.216 kPa (Arostica et al. 2025),
//   in tension along f and s: E = 2a + 4af, 2a + 4as, 2a; G = a + afs, a, a.
static void test_published_myocardium(void **state)
{
  (void)state;
  const double laws[2][6] = {{16, 4, 4, 4, 2, 4}, {74.006, 10.042, 0.118, 0.275, 0.059, 0.059}};
  for (int w = 0; w < 2; w++) {
    double S[36], E[3];
    const vsc_material_def material = springs_of(laws[w], laws[w] + 3, 1e7);
    compliance_of(&material, S);
    const vsc_moduli moduli = moduli_of(S);
    assert_int_equal(vsc_axial_incompressible(moduli.young, E, NULL), VSC_OK);
    // what K leaves, E / K, over the softest E
    for (int a = 0; a < 3; a++) assert_close(E[a], laws[w][a], 0, 1e-3);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_stiffness_is_second_derivative_of_energy),
      cmocka_unit_test(test_stabilization_counts_beside_shared_volume),
      cmocka_unit_test(test_other_laws_have_no_stiffness),
      cmocka_unit_test(test_three_axes_in_closed_form),
      cmocka_unit_test(test_incompressible_limit),
      cmocka_unit_test(test_turned_springs),
      cmocka_unit_test(test_directions_that_are_no_axes),
      cmocka_unit_test(test_isotropic),
      cmocka_unit_test(test_springs_come_back),
      cmocka_unit_test(test_incompressible_example),
      cmocka_unit_test(test_bulk_modulus),
      cmocka_unit_test(test_nothing_comes_nearer),
      cmocka_unit_test(test_nine_axes_match_nine_moduli),
      cmocka_unit_test(test_refuses_what_no_material_has),
      cmocka_unit_test(test_published_myocardium),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
