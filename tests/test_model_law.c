// SPDX-License-Identifier: GPL-3.0-or-later
// Laws of strain: at rest free of stress, stress is the energy's derivative and the tangent the
// stress's, also beyond the largest exponent and near inversion; objectivity; small-strain moduli.
#include "model/law.h"

#include "base/vec3.h"
#include "kinds_body.h"
#include "model/small_strain.h"
#include "tissue_laws.h"

// A model that holds the material.
static void law_open(random_body *body, const vsc_material_def *material)
{
  kinds_open(body, random_block(1, 3), material, VSC_VOLUME_ELEMENT, 4);
}

static vsc_law_input input_of(const random_body *body)
{
  const vsc_material *material = &body->model->materials[0];
  return (vsc_law_input){.material = material,
                         .axes = body->model->axes,
                         .pairs = body->model->pairs,
                         .moduli = vsc_moduli_or(material, NULL),
                         .activation = vsc_splat(0.7)};
}

static void spread(const double e[6], vsc_wide wide[6])
{
  for (int k = 0; k < 6; k++) wide[k] = vsc_splat(e[k]);
}

static vsc_law_answer evaluate(const random_body *body, const double e[6])
{
  const vsc_law_input in = input_of(body);
  vsc_law_answer answer;
  vsc_wide wide[6];
  spread(e, wide);
  vsc_law_evaluate(&in, wide, VSC_LAW_TANGENT, &answer);
  return answer;
}

static double energy(const random_body *body, const double e[6])
{
  const vsc_law_input in = input_of(body);
  vsc_law_answer answer;
  vsc_wide wide[6];
  spread(e, wide);
  vsc_law_evaluate(&in, wide, VSC_LAW_ENERGY, &answer);
  return answer.energy[0];
}

// Frame `G` by rows g_a.
static void strain_of_rows(const double G[9], double e[6])
{
  for (int a = 0; a < 3; a++) {
    e[a] = 0.5 * (vsc_dot(G + 3 * a, G + 3 * a) - 1);
    e[3 + a] = vsc_dot(G + 3 * a, G + 3 * ((a + 1) % 3));
  }
}

// A strain that some deformation has.
static void random_strain(uint64_t *seed, double size, double e[6])
{
  double G[9];
  random_fill(seed, size, G, 9);
  for (int i = 0; i < 9; i += 4) G[i] += 1;
  strain_of_rows(G, e);
}

static void laws_are_free_of_stress_at_rest(void **state)
{
  (void)state;
  static const double rest[6] = {0};
  for (int k = 0; k < TISSUE_LAWS; k++) {
    random_body body;
    const vsc_material_def material = tissue_law(k);
    law_open(&body, &material);
    const vsc_law_answer answer = evaluate(&body, rest);
    assert_true(answer.energy[0] == 0);
    // the logarithm's share of S is -m at rest; sums of a few numbers of 1 to 3
    for (int i = 0; i < 6; i++)
      assert_close(answer.S[i][0], i < 3 ? body.model->materials[0].rest_shear : 0, 0, 1e-15 * 8);
    body_close(&body);
  }
}

// (f(e + h d) - f(e - h d))/2h of the energy
static double energy_slope(const random_body *body, const double e[6], int k, double h)
{
  double at[6], value[2];
  for (int side = 0; side < 2; side++) {
    memcpy(at, e, sizeof at);
    at[k] += side ? -h : h;
    value[side] = energy(body, at);
  }
  return (value[0] - value[1]) / (2 * h);
}

// Errors of central differences with steps 2^-8 and 2^-9 fall by 4: order 2 is seen to 3 %. With 2^-10
// and 2^-11, extrapolated, what is left is of order 4, some (2^-10)^4 times fifth derivatives of
// exponentials, and rounding.
static void check_stress(const random_body *body, const double e[6])
{
  const vsc_law_answer answer = evaluate(body, e);
  double coarse = 0, fine = 0, size = 0;
  for (int k = 0; k < 6; k++) size = fmax(size, fabs(answer.S[k][0]));
  for (int k = 0; k < 6; k++) {
    const double S = answer.S[k][0];
    coarse += fabs(energy_slope(body, e, k, ldexp(1, -8)) - S);
    fine += fabs(energy_slope(body, e, k, ldexp(1, -9)) - S);
    const double third = energy_slope(body, e, k, ldexp(1, -10));
    const double fourth = energy_slope(body, e, k, ldexp(1, -11));
    assert_close((4 * fourth - third) / 3, S, 0, 2e-8 * size);
  }
  // quadratic energies have no error but rounding
  if (coarse > 1e-9 * size) assert_close(log2(coarse / fine), 2, 0, 0.06);
}

// Tangents from differences of the stress with steps h and h/2, extrapolated.
static void check_tangent(const random_body *body, const double e[6], double step)
{
  const vsc_law_answer answer = evaluate(body, e);
  double size = 0;
  for (int k = 0; k < 36; k++) size = fmax(size, fabs(answer.D[k / 6][k % 6][0]));
  for (int l = 0; l < 6; l++) {
    double slope[2][6];
    for (int s = 0; s < 2; s++) {
      const double h = ldexp(step, -s);
      double up[6], down[6];
      memcpy(up, e, sizeof up);
      memcpy(down, e, sizeof down);
      up[l] += h;
      down[l] -= h;
      const vsc_law_answer high = evaluate(body, up), low = evaluate(body, down);
      for (int k = 0; k < 6; k++) slope[s][k] = (high.S[k][0] - low.S[k][0]) / (2 * h);
    }
    for (int k = 0; k < 6; k++) {
      assert_close((4 * slope[1][k] - slope[0][k]) / 3, answer.D[k][l][0], 0, 1e-8 * size);
      assert_close(answer.D[k][l][0], answer.D[l][k][0], 1e-14, 1e-15 * size);
    }
  }
}

static void stress_is_the_energys_derivative(void **state)
{
  (void)state;
  uint64_t seed = 11;
  for (int k = 0; k < TISSUE_LAWS; k++) {
    random_body body;
    const vsc_material_def material = tissue_law(k);
    law_open(&body, &material);
    for (int trial = 0; trial < 20; trial++) {
      double e[6];
      random_strain(&seed, 0.25, e);
      // the sharp switch has a kink in the stress, which a difference must not step over
      if (material.compression == VSC_FIBRES_SHARP && (fabs(e[0]) < 0.01 || fabs(e[1]) < 0.01)) continue;
      check_stress(&body, e);
    }
    body_close(&body);
  }
}

static void tangents_are_the_stresss_derivative(void **state)
{
  (void)state;
  uint64_t seed = 12;
  for (int k = 0; k < TISSUE_LAWS; k++) {
    random_body body;
    const vsc_material_def material = tissue_law(k);
    law_open(&body, &material);
    for (int trial = 0; trial < 20; trial++) {
      double e[6];
      random_strain(&seed, 0.25, e);
      if (material.compression == VSC_FIBRES_SHARP && (fabs(e[0]) < 1e-3 || fabs(e[1]) < 1e-3)) continue;
      check_tangent(&body, e, 0x1p-11);
    }
    body_close(&body);
  }
}

// Strains so large that exponents are beyond 20, where S is linear in Q; and so flat that I_3 is
// below 0.04.
static void laws_are_smooth_where_they_are_continued(void **state)
{
  (void)state;
  static const double far[6] = {1.6, 0.9, 1.2, 0.8, -0.6, 0.5};
  static const double flat[6] = {0.1, -0.49, 0.05, 0.02, 0.01, -0.03};
  for (int k = 0; k < TISSUE_LAWS; k++) {
    random_body body;
    const vsc_material_def material = tissue_law(k);
    law_open(&body, &material);
    const vsc_law_answer answer = evaluate(&body, far);
    if (material.law == VSC_LAW_GUCCIONE || material.law == VSC_LAW_FUNG)
      assert_true(material.isochoric || answer.exponent[0] > VSC_LARGEST_EXPONENT);
    if (material.law == VSC_LAW_NEO_HOOKEAN) assert_true(answer.exponent[0] == 0);
    check_tangent(&body, far, 0x1p-11);
    check_tangent(&body, flat, 0x1p-16);  // I_3^(-1/3) is steep there
    check_stress(&body, far);
    body_close(&body);
  }
}

// P turns with the body: P(RG) = R P(G).
static void laws_are_objective(void **state)
{
  (void)state;
  uint64_t seed = 13;
  for (int k = 0; k < TISSUE_LAWS; k++) {
    random_body body;
    const vsc_material_def material = tissue_law(k);
    law_open(&body, &material);
    double R[9], G[9], P[2][9];
    random_rotation(&seed, R);
    random_fill(&seed, 0.25, G, 9);
    for (int i = 0; i < 9; i += 4) G[i] += 1;
    for (int turned = 0; turned < 2; turned++) {
      double e[6];
      vsc_wide3 g[3], force[3];
      for (int a = 0; a < 3; a++) {
        double row[3];
        rotate_vector(R, G + 3 * a, row);
        const double *to = turned ? row : G + 3 * a;
        g[a] = (vsc_wide3){vsc_splat(to[0]), vsc_splat(to[1]), vsc_splat(to[2])};
      }
      vsc_wide wide[6];
      vsc_strain_of(g, wide);
      for (int i = 0; i < 6; i++) e[i] = wide[i][0];
      const vsc_law_answer answer = evaluate(&body, e);
      vsc_stress_on_axes(answer.S, g, force);
      for (int a = 0; a < 3; a++) {
        P[turned][3 * a] = force[a].x[0];
        P[turned][3 * a + 1] = force[a].y[0];
        P[turned][3 * a + 2] = force[a].z[0];
      }
    }
    for (int a = 0; a < 3; a++) {
      double turned[3];
      rotate_vector(R, P[0] + 3 * a, turned);
      for (int i = 0; i < 3; i++) assert_close(turned[i], P[1][3 * a + i], 1e-12, 1e-12);
    }
    body_close(&body);
  }
}

// A change of size alone costs an isochoric law nothing.
static void isochoric_laws_do_not_see_volume(void **state)
{
  (void)state;
  uint64_t seed = 14;
  for (int k = 1; k < 10; k += 2) {
    random_body body;
    const vsc_material_def material = tissue_law(k);
    law_open(&body, &material);
    double G[9], e[6], larger[6];
    random_fill(&seed, 0.25, G, 9);
    for (int i = 0; i < 9; i += 4) G[i] += 1;
    strain_of_rows(G, e);
    for (int i = 0; i < 9; i++) G[i] *= 1.3;
    strain_of_rows(G, larger);
    assert_close(energy(&body, e), energy(&body, larger), 1e-12, 0);
    body_close(&body);
  }
}

static void small_strain_moduli_are_the_constants(void **state)
{
  (void)state;
  random_body body;
  double D[36];
  vsc_material_def material = tissue_law(2);  // Guccione: C bf, C bt; C bfs/2, C bt/2
  law_open(&body, &material);
  vsc_rest_tangent(body.model, &body.model->materials[0], D);
  const double diagonal[6] = {16, 4, 4, 4, 2, 4};
  for (int k = 0; k < 36; k++) assert_close(D[k], k % 7 == 0 ? diagonal[k / 7] : 0, 0, 1e-15 * 16);
  // (16 + 4)/4 at 45 degrees to fibre and sheet
  assert_close(vsc_material_shear(body.model, &body.model->materials[0]), 5, 1e-15, 0);
  assert_close(vsc_material_stiffest(body.model, &body.model->materials[0]), 16, 1e-15, 0);
  body_close(&body);
  // isotropic laws: mu; 2 (c1 + c2); c1 c2, whether they see volume or not
  static const double shear[4] = {3, 3, 4, 4};
  for (int k = 0; k < 4; k++) {
    material = tissue_law(k < 2 ? k : k + 4);
    law_open(&body, &material);
    assert_close(vsc_material_shear(body.model, &body.model->materials[0]), shear[k], 1e-14, 0);
    body_close(&body);
  }
  for (int k = 8; k < 10; k++) {
    material = tissue_law(k);
    law_open(&body, &material);
    assert_close(vsc_material_shear(body.model, &body.model->materials[0]), 0.7 * 2.5, 1e-14, 0);
    assert_close(vsc_material_stiffest(body.model, &body.model->materials[0]),
                 k == 9 ? 3.5 : 3 * 4 * 0.7 * 2.5 * 2.5 - 2 * 2 * 0.7 * 2.5, 1e-12, 0);
    body_close(&body);
  }
}

// T = a tension max(0, 1 + beta (lambda - 1)) along the fibre, and parts of it across.
static void tension_depends_on_length(void **state)
{
  (void)state;
  random_body body;
  vsc_material_def material = tissue_law(13);
  material.active.kind = VSC_ACTIVE_TENSION;
  material.active.tension = 30;
  material.active.length_factor = 2;
  law_open(&body, &material);
  uint64_t seed = 15;
  for (int trial = 0; trial < 20; trial++) {
    double e[6];
    random_strain(&seed, 0.2, e);
    check_tangent(&body, e, 0x1p-11);
  }
  body_close(&body);
  material.active.sheet_fraction = 0.3;
  material.active.normal_fraction = 0.2;
  law_open(&body, &material);
  const double e[6] = {0.22, 0, 0, 0, 0, 0};  // lambda = 1.2
  const double slack[6] = {-0.48, 0, 0, 0, 0, 0};  // lambda = 0.2: no tension at all
  const vsc_law_answer active = evaluate(&body, e), loose = evaluate(&body, slack);
  body.model->materials[0].active = VSC_ACTIVE_NONE;
  const vsc_law_answer passive = evaluate(&body, e), still = evaluate(&body, slack);
  const double T = 0.7 * 30 * 1.4, parts[3] = {1, 0.3, 0.2};
  for (int k = 0; k < 6; k++) {
    assert_close(active.S[k][0] - passive.S[k][0], k < 3 ? parts[k] * T : 0, 1e-13, 1e-14);
    assert_close(loose.S[k][0], still.S[k][0], 0, 0);
  }
  // half of dT/dE_ff on either side
  assert_close(active.D[1][0][0] - passive.D[1][0][0], 0.5 * 0.3 * 0.7 * 30 * 2 / 1.2, 1e-12, 0);
  body.model->materials[0].active = VSC_ACTIVE_TENSION;
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(laws_are_free_of_stress_at_rest),
      cmocka_unit_test(stress_is_the_energys_derivative),
      cmocka_unit_test(tangents_are_the_stresss_derivative),
      cmocka_unit_test(laws_are_smooth_where_they_are_continued),
      cmocka_unit_test(laws_are_objective),
      cmocka_unit_test(isochoric_laws_do_not_see_volume),
      cmocka_unit_test(small_strain_moduli_are_the_constants),
      cmocka_unit_test(tension_depends_on_length),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
