// SPDX-License-Identifier: GPL-3.0-or-later
// What springs are equivalent to at small strain, and springs from elastic constants.
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "kinds_body.h"
#include "model/calibration.h"

static vsc_material_def three_axes(double K)
{
  vsc_material_def m = vsc_default_material();
  memcpy(m.axial, (double[]){12, 7, 4}, sizeof m.axial);
  memcpy(m.angular, (double[]){3, 2, 5}, sizeof m.angular);
  m.volume_modulus = K;
  return m;
}

static void stiffness(const vsc_material_def *m, double C[36], double S[36])
{
  vsc_error error;
  if (vsc_stiffness_of(m, VSC_VOLUME_ELEMENT, C, &error) != VSC_OK ||
      vsc_invert_six(C, S, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

// The closed forms for three axes: C_ab = E_a delta_ab + K, S_ab = delta_ab/E_a - K/(1 + K s)/(E_a E_b).
static void three_axes_have_the_closed_form(void **state)
{
  (void)state;
  const vsc_material_def m = three_axes(30);
  double C[36], S[36], s = 0;
  stiffness(&m, C, S);
  for (int a = 0; a < 3; a++) s += 1 / m.axial[a];
  for (int a = 0; a < 3; a++)
    for (int b = 0; b < 3; b++) {
      assert_close(C[6 * a + b], 30 + (a == b ? m.axial[a] : 0), 1e-15, 0);
      assert_close(S[6 * a + b],
                   (a == b ? 1 / m.axial[a] : 0) - 30 / (1 + 30 * s) / m.axial[a] / m.axial[b], 0,
                   1e-15);
    }
  assert_close(C[7 * 3], 2, 1e-15, 0);  // sn
  assert_close(C[7 * 4], 5, 1e-15, 0);  // nf
  assert_close(C[7 * 5], 3, 1e-15, 0);  // fs
}

// e . C e is the second derivative of the energy that the simulation stores, also with further axes and
// pairs that are not at right angles: differences over h have an error of h^2 (h = 1e-3: 1e-5).
static void the_energy_has_this_stiffness(void **state)
{
  (void)state;
  vsc_axis_def axes[2];
  vsc_pair_def pairs[2];
  vsc_material_def m = springs_material(axes, pairs);
  random_body body;
  uint64_t seed = 9;
  double C[36], S[36], at_rest;
  vsc_totals totals;
  kinds_open(&body, random_block(2, 4), &m, VSC_VOLUME_ELEMENT, 5);
  for (size_t e = 0; e < body.mesh->element_count; e++)  // frames are the global axes
    memcpy(body.axes->frames + 9 * e, (double[]){1, 0, 0, 0, 1, 0, 0, 0, 1}, 72);
  vsc_ledger_free(body.ledger);
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body_build(&body);
  stiffness(&m, C, S);
  const size_t nodes = body.mesh->node_count;
  double *x = numbers(3 * nodes);
  at_rest = kinds_energy(&body, body.mesh->nodes, &totals);
  for (int round = 0; round < 10; round++) {
    const double h = 1e-3;
    double e[6], second = -2 * at_rest;
    random_fill(&seed, 1, e, 6);
    for (int side = -1; side <= 1; side += 2) {
      const double F[9] = {1 + side * h * e[0],     side * h * e[5] / 2,     side * h * e[4] / 2,
                           side * h * e[5] / 2,     1 + side * h * e[1],     side * h * e[3] / 2,
                           side * h * e[4] / 2,     side * h * e[3] / 2,     1 + side * h * e[2]};
      for (size_t n = 0; n < nodes; n++) rotate_vector(F, body.mesh->nodes + 3 * n, x + 3 * n);
      second += kinds_energy(&body, x, &totals);
    }
    assert_close(second / h / h / body.model->total_volume, vsc_product_six(e, C, e), 3e-5, 0);
  }
  vsc_free(x);
  body_close(&body);
}

// One material seen from a turned frame: Young's modulus along a direction is what it is.
static void isotropic_is_the_same_all_round(void **state)
{
  (void)state;
  for (double nu = 0; nu < 0.5; nu += 0.07) {
    vsc_material_def m = vsc_default_material();
    const vsc_orthotropic wanted = vsc_isotropic(10, nu);
    double C[36], S[36], residual;
    vsc_error error;
    if (vsc_calibrate(&wanted, VSC_THREE_AXES, &m, &residual, &error) != VSC_OK)
      fail_msg("%s", error.text);
    assert_true(residual < 1e-9);
    // E_a = 2 mu, G = mu, K = lambda
    const double mu = 10 / (2 * (1 + nu)), lambda = 2 * mu * nu / (1 - 2 * nu);
    for (int a = 0; a < 3; a++) {
      assert_close(m.axial[a], 2 * mu, 1e-9, 0);
      assert_close(m.angular[a], mu, 1e-9, 0);
    }
    assert_close(m.volume_modulus, lambda, 1e-9, 1e-8);
    if (nu == 0) continue;  // without K some deformation would be free only by rounding
    stiffness(&m, C, S);
    const vsc_young_range range = vsc_young_over_sphere(S);
    assert_close(range.low, 10, 1e-8, 0);
    assert_close(range.high, 10, 1e-8, 0);
  }
}

// Constants that three axes can have come back as they went; those they cannot are met no worse with
// more axes, and a residual says so.
static void calibration_inverts(void **state)
{
  (void)state;
  double C[36], S[36], residual[3];
  vsc_error error;
  vsc_material_def m = three_axes(30);
  stiffness(&m, C, S);
  const vsc_orthotropic own = vsc_constants_of(S);
  vsc_material_def back = vsc_default_material();
  assert_int_equal(vsc_calibrate(&own, VSC_THREE_AXES, &back, &residual[0], &error), VSC_OK);
  assert_true(residual[0] < 1e-9);
  for (int a = 0; a < 3; a++) {
    assert_close(back.axial[a], m.axial[a], 1e-8, 0);
    assert_close(back.angular[a], m.angular[a], 1e-8, 0);
  }
  assert_close(back.volume_modulus, 30, 1e-8, 0);
  const vsc_orthotropic odd = {{16, 8, 5}, {4, 2, 4}, {0.3, 0.4, 0.15}};
  const vsc_calibration_axes axes[3] = {VSC_THREE_AXES, VSC_NINE_AXES, VSC_THIRTEEN_AXES};
  for (int k = 0; k < 3; k++) {
    vsc_material_def fit = vsc_default_material();
    assert_int_equal(vsc_calibrate(&odd, axes[k], &fit, &residual[k], &error), VSC_OK);
    for (int a = 0; a < 3; a++) assert_true(fit.axial[a] >= 0 && fit.angular[a] >= 0);
    for (size_t a = 0; a < fit.axis_count; a++) assert_true(fit.axes[a].modulus > 0);
    vsc_free(fit.axes);
  }
  assert_true(residual[0] > 0.05);
  assert_true(residual[1] <= residual[0] + 1e-12 && residual[2] <= residual[1] + 1e-12);
}

// The incompressible limit: Y = 10, 4, 3 needs E = 9.694, 3.677, 0.334, and K = 1e4 E comes back to it
// within E/K.
static void incompressible_materials_need_nothing_more(void **state)
{
  (void)state;
  const vsc_orthotropic wanted = {{10, 4, 3}, {2, 1, 2}, {0}};
  const double expected[3] = {9.694, 3.677, 0.334};
  vsc_material_def m = vsc_default_material();
  vsc_error error;
  double C[36], S[36];
  assert_int_equal(vsc_calibrate_incompressible(&wanted, 1e5, &m, &error), VSC_OK);
  for (int a = 0; a < 3; a++) assert_close(m.axial[a], expected[a], 0, 5e-4);
  stiffness(&m, C, S);
  const vsc_orthotropic got = vsc_constants_of(S);
  for (int a = 0; a < 3; a++) {
    assert_close(got.young[a], wanted.young[a], 2e-4, 0);
    assert_close(got.shear[a], wanted.shear[a], 1e-12, 0);
  }
}

static void impossible_materials_are_named(void **state)
{
  (void)state;
  vsc_material_def m = vsc_default_material();
  vsc_error error;
  double residual;
  vsc_orthotropic o = vsc_isotropic(10, 0.5);
  assert_int_equal(vsc_calibrate(&o, VSC_THREE_AXES, &m, &residual, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "0.5"));
  o = vsc_isotropic(10, 0.3);
  o.shear[1] = 0;
  assert_int_equal(vsc_calibrate(&o, VSC_THREE_AXES, &m, &residual, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "G_sn"));
  o = (vsc_orthotropic){{16, 8, 4}, {1, 1, 1}, {0}};
  assert_int_equal(vsc_calibrate_incompressible(&o, 1e4, &m, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "Y_n = 4"));
  o.young[2] = 1;  // roots of the inverses: 0.25 + 0.354 < 1
  assert_int_equal(vsc_calibrate_incompressible(&o, 1e4, &m, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "no incompressible"));
  m.law = VSC_LAW_PAPER;
  double C[36];
  assert_int_equal(vsc_stiffness_of(&m, VSC_VOLUME_NODAL, C, &error), VSC_INPUT);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(three_axes_have_the_closed_form),
      cmocka_unit_test(the_energy_has_this_stiffness),
      cmocka_unit_test(isotropic_is_the_same_all_round),
      cmocka_unit_test(calibration_inverts),
      cmocka_unit_test(incompressible_materials_need_nothing_more),
      cmocka_unit_test(impossible_materials_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
