// SPDX-License-Identifier: GPL-3.0-or-later
// Incompressible bodies under tension and simple shear, in closed form where there is one, else against
// figures of an independent computation to the digits they have.
#include <string.h>

#include "base/vec3.h"
#include "kinds_body.h"
#include "model/law.h"

static vsc_material_def guccione_material(void)
{
  vsc_material_def m = vsc_default_material();
  m.law = VSC_LAW_GUCCIONE;
  m.guccione = (vsc_guccione_def){.C = 2, .fibre = 8, .cross = 2, .shear = 4};
  m.volume_modulus = 1;
  return m;
}

// Constants in Pa, so that stresses are too.
static vsc_material_def myocardium(vsc_fibre_switch compression)
{
  vsc_material_def m = vsc_default_material();
  m.law = VSC_LAW_HOLZAPFEL_OGDEN;
  m.holzapfel_ogden = (vsc_holzapfel_ogden_def){.a = 59, .b = 8.023, .a_f = 18472, .b_f = 16.026,
                                                .a_s = 2481, .b_s = 11.12, .a_fs = 216,
                                                .b_fs = 11.436, .steepness = 100};
  m.compression = compression;
  m.volume_modulus = 1;
  return m;
}

// sigma = F S F^T of the law alone, fibres along x, sheets along y; rows of F.
static void cauchy(const vsc_material_def *material, const double F[9], double sigma[9])
{
  random_body body;
  kinds_open(&body, random_block(1, 3), material, VSC_VOLUME_ELEMENT, 4);
  const vsc_law_input in = {.material = &body.model->materials[0],
                            .moduli = vsc_moduli_or(&body.model->materials[0], NULL)};
  vsc_wide3 g[3], P[3];
  vsc_law_answer answer;
  vsc_wide e[6];
  for (int a = 0; a < 3; a++)
    g[a] = (vsc_wide3){vsc_splat(F[a]), vsc_splat(F[3 + a]), vsc_splat(F[6 + a])};
  vsc_strain_of(g, e);
  vsc_law_evaluate(&in, e, VSC_LAW_STRESS, &answer);
  vsc_stress_on_axes(answer.S, g, P);
  for (int i = 0; i < 9; i++) sigma[i] = 0;
  for (int a = 0; a < 3; a++) {
    const double p[3] = {P[a].x[0], P[a].y[0], P[a].z[0]};
    for (int i = 0; i < 9; i++) sigma[i] += p[i / 3] * F[3 * (i % 3) + a];
  }
  body_close(&body);
}

// Normal stresses at stretches l (l_0 l_1 l_2 = 1), up to the pressure.
static void stretched(const vsc_material_def *material, const double l[3], double normal[3])
{
  const double F[9] = {l[0], 0, 0, 0, l[1], 0, 0, 0, l[2]};
  double sigma[9];
  cauchy(material, F, sigma);
  for (int a = 0; a < 3; a++) normal[a] = sigma[4 * a];
}

// Stress of a bar stretched along `axis` with free sides; `l` are its stretches then. Bisection on
// the next axis' stretch until both sides carry the same.
static double pulled(const vsc_material_def *material, int axis, double stretch, double l[3])
{
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  double low = 0.5 / sqrt(stretch), high = 2 / sqrt(stretch), normal[3] = {0};
  l[axis] = stretch;
  while (high - low > 1e-15) {
    l[b] = 0.5 * (low + high);
    l[c] = 1 / (stretch * l[b]);
    stretched(material, l, normal);
    if (l[b] == low || l[b] == high) break;
    if (normal[b] < normal[c])
      low = l[b];
    else
      high = l[b];
  }
  return normal[axis] - 0.5 * (normal[b] + normal[c]);
}

// Shear stress of a plane of normal i shifted along j by `gamma`.
static double sheared(const vsc_material_def *material, int i, int j, double gamma)
{
  double F[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1}, sigma[9];
  F[3 * j + i] = gamma;
  cauchy(material, F, sigma);
  return sigma[3 * i + j];
}

static void rubber_is_its_closed_form(void **state)
{
  (void)state;
  vsc_material_def m = vsc_default_material();
  m.law = VSC_LAW_NEO_HOOKEAN;
  m.shear = 3;
  m.volume_modulus = 1;
  double l[3], normal[3];
  for (double stretch = 0.7; stretch < 2; stretch += 0.25) {
    const double expected = 3 * (stretch * stretch - 1 / stretch);
    assert_close(pulled(&m, 0, stretch, l), expected, 1e-13, 0);
    const double plane[3] = {stretch, stretch, 1 / (stretch * stretch)};
    stretched(&m, plane, normal);
    assert_close(normal[0] - normal[2], 3 * (pow(stretch, 2) - pow(stretch, -4)), 1e-13, 0);
  }
  for (double gamma = -0.6; gamma < 1; gamma += 0.5) assert_close(sheared(&m, 0, 1, gamma), 3 * gamma, 1e-14, 0);
}

// dpsi/dI_1 and dpsi/dI_2 of both laws of two invariants.
static void invariant_slopes(const vsc_material_def *m, double I1, double W[2])
{
  const double c1 = m->law == VSC_LAW_MOONEY_RIVLIN ? m->mooney_rivlin.c1 : m->veronda_westmann.c1;
  const double c2 = m->law == VSC_LAW_MOONEY_RIVLIN ? m->mooney_rivlin.c2 : m->veronda_westmann.c2;
  W[0] = m->law == VSC_LAW_MOONEY_RIVLIN ? c1 : c1 * c2 * exp(c2 * (I1 - 3));
  W[1] = m->law == VSC_LAW_MOONEY_RIVLIN ? c2 : -0.5 * c1 * c2;
}

static vsc_material_def of_invariants(int which)
{
  vsc_material_def m = vsc_default_material();
  m.law = which == 0 ? VSC_LAW_MOONEY_RIVLIN : VSC_LAW_VERONDA_WESTMANN;
  m.mooney_rivlin = (vsc_invariants_def){1.4, 0.6};
  m.veronda_westmann = (vsc_invariants_def){0.7, 2.5};
  m.volume_modulus = 1;
  return m;
}

// Pulled 2 (l^2 - 1/l) (W_1 + W_2/l), in two directions 2 (l^2 - 1/l^4) (W_1 + l^2 W_2), sheared 2 gamma (W_1 + W_2).
static void laws_of_two_invariants_are_their_closed_forms(void **state)
{
  (void)state;
  for (int which = 0; which < 2; which++) {
    const vsc_material_def m = of_invariants(which);
    double l[3], normal[3], W[2];
    for (double x = 0.75; x < 1.6; x += 0.2) {
      invariant_slopes(&m, x * x + 2 / x, W);
      for (int axis = 0; axis < 3; axis++)
        assert_close(pulled(&m, axis, x, l), 2 * (x * x - 1 / x) * (W[0] + W[1] / x), 1e-12, 1e-12);
      const double plane[3] = {x, 1 / (x * x), x};
      stretched(&m, plane, normal);
      invariant_slopes(&m, 2 * x * x + pow(x, -4), W);
      assert_close(normal[0] - normal[1], 2 * (x * x - pow(x, -4)) * (W[0] + x * x * W[1]), 1e-12, 1e-12);
      assert_close(normal[2], normal[0], 1e-13, 0);
    }
    for (double gamma = -0.7; gamma < 1; gamma += 0.3) {
      invariant_slopes(&m, 3 + gamma * gamma, W);
      assert_close(sheared(&m, 2, 0, gamma), 2 * gamma * (W[0] + W[1]), 1e-12, 0);
    }
  }
}

static const double usyk[6] = {8, 6, 3, 12, 4, 5};  // ff ss nn fs sn nf

static vsc_material_def usyk_material(void)
{
  vsc_material_def m = vsc_default_material();
  m.law = VSC_LAW_FUNG;
  m.fung.C = 0.88;
  memcpy(m.fung.b, usyk, sizeof usyk);
  m.volume_modulus = 1;
  return m;
}

// l_a^2 S_a = C e^Q b_aa l_a^2 E_a at stretches along the axes.
static void usyk_stresses(const double l[3], double normal[3])
{
  double Q = 0;
  for (int a = 0; a < 3; a++) Q += usyk[a] * pow((l[a] * l[a] - 1) / 2, 2);
  for (int a = 0; a < 3; a++) normal[a] = 0.88 * exp(Q) * usyk[a] * l[a] * l[a] * (l[a] * l[a] - 1) / 2;
}

// Pulled along each axis, stretched in two directions by different stretches, sheared in all six ways:
// C e^Q (b_ii gamma^3 + b_ij gamma)/2, Q = b_ii gamma^4/4 + b_ij gamma^2/2.
static void fung_is_its_closed_form(void **state)
{
  (void)state;
  const vsc_material_def m = usyk_material();
  double l[3], normal[3], expected[3];
  for (double x = 0.85; x < 1.35; x += 0.15)
    for (int axis = 0; axis < 3; axis++) {
      const int b = (axis + 1) % 3, c = (axis + 2) % 3;
      const double stress = pulled(&m, axis, x, l);
      usyk_stresses(l, expected);
      assert_close(expected[b], expected[c], 1e-10, 1e-12);  // free sides
      assert_close(stress, expected[axis] - expected[b], 1e-10, 1e-12);
      const double plane[3] = {x, 1.1, 1 / (1.1 * x)};
      stretched(&m, plane, normal);
      usyk_stresses(plane, expected);
      for (int a = 0; a < 3; a++) assert_close(normal[a], expected[a], 1e-12, 1e-14);
    }
  for (double gamma = -0.4; gamma < 0.5; gamma += 0.2)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        if (i == j) continue;
        const double b = usyk[3 + (j == (i + 1) % 3 ? i : j)];
        const double Q = usyk[i] * pow(gamma, 4) / 4 + b * gamma * gamma / 2;
        assert_close(sheared(&m, i, j, gamma), 0.88 * exp(Q) * (usyk[i] * pow(gamma, 3) + b * gamma) / 2, 1e-12, 1e-14);
      }
}

// Springs: E_a l_a (l_a - 1) along the axes; sheared E_i gamma (1 - 1/n) + G_ij gamma/n^4, n^2 = 1 + gamma^2.
static void springs_are_their_closed_form(void **state)
{
  (void)state;
  static const double E[3] = {9, 6, 6}, G[3] = {3, 2, 5};
  vsc_material_def m = vsc_default_material();
  memcpy(m.axial, E, sizeof E);
  memcpy(m.angular, G, sizeof G);
  m.volume_modulus = 60;
  double l[3], normal[3];
  for (double x = 0.7; x < 1.7; x += 0.3) {
    const double side = 1 / sqrt(x);
    assert_close(pulled(&m, 0, x, l), 9 * x * (x - 1) - 6 * side * (side - 1), 1e-12, 1e-12);
    const double plane[3] = {x, 1.2, 1 / (1.2 * x)};
    stretched(&m, plane, normal);
    for (int a = 0; a < 3; a++) assert_close(normal[a], E[a] * plane[a] * (plane[a] - 1), 1e-13, 1e-13);
  }
  for (double gamma = -0.5; gamma < 1; gamma += 0.4)
    for (int i = 0; i < 3; i++)
      for (int j = 0; j < 3; j++) {
        if (i == j) continue;
        const double n = sqrt(1 + gamma * gamma), g = G[j == (i + 1) % 3 ? i : j];
        assert_close(sheared(&m, i, j, gamma), E[i] * gamma * (1 - 1 / n) + g * gamma / pow(n, 4), 1e-12, 1e-14);
      }
}

// l'_a^2 S_a of the law on l' = J^(-1/3) l, less its mean: what an isochoric law has at stretches l, J times Cauchy's.
static void isochoric_stresses(const vsc_material_def *m, const double l[3], double expected[3])
{
  double mean = 0, q[3], I1 = 0, W[2] = {0};
  const double J = l[0] * l[1] * l[2];
  for (int a = 0; a < 3; a++) q[a] = l[a] * l[a] * pow(J, -2. / 3), I1 += q[a];
  const double k[3] = {sqrt(q[0]), sqrt(q[1]), sqrt(q[2])};
  if (m->law == VSC_LAW_FUNG) usyk_stresses(k, expected);
  if (m->law == VSC_LAW_MOONEY_RIVLIN || m->law == VSC_LAW_VERONDA_WESTMANN) invariant_slopes(m, I1, W);
  if (m->law == VSC_LAW_NEO_HOOKEAN) W[0] = m->shear / 2;
  if (m->law == VSC_LAW_HOLZAPFEL_OGDEN) W[0] = 29.5 * exp(8.023 * (I1 - 3));
  for (int a = 0; a < 3 && m->law != VSC_LAW_FUNG; a++) expected[a] = 2 * (W[0] + W[1] * (I1 - q[a])) * q[a];
  for (int a = 0; a < 3; a++) mean += expected[a] / 3;
  for (int a = 0; a < 3; a++) expected[a] -= mean;
  if (m->law != VSC_LAW_HOLZAPFEL_OGDEN) return;
  const double a_k[2] = {18472, 2481}, b_k[2] = {16.026, 11.12};  // fibres and sheets see the whole deformation
  for (int a = 0; a < 2; a++) {
    const double x = l[a] * l[a] - 1;
    if (x > 0) expected[a] += 2 * a_k[a] * x * exp(b_k[a] * x * x) * l[a] * l[a];
  }
}

// Swollen, shrunk, pulled and pressed; and what is sheared and swollen has the shear stress of what is sheared alone.
static void isochoric_laws_are_their_closed_forms(void **state)
{
  (void)state;
  static const double stretches[4][3] = {{1.2, 1.1, 1.05}, {0.9, 0.8, 1.1}, {1.15, 1.15, 1.15}, {1.2, 0.8, 0.9}};
  vsc_material_def laws[5] = {of_invariants(0), of_invariants(1), usyk_material(), myocardium(VSC_FIBRES_SHARP),
                              vsc_default_material()};
  laws[4].law = VSC_LAW_NEO_HOOKEAN;
  laws[4].shear = 3;
  laws[4].volume_modulus = 1;
  for (int k = 0; k < 5; k++) {
    laws[k].isochoric = true;
    double normal[3], expected[3], sigma[9];
    for (int s = 0; s < 4; s++) {
      stretched(&laws[k], stretches[s], normal);
      isochoric_stresses(&laws[k], stretches[s], expected);
      const double size = fabs(expected[0]) + fabs(expected[1]) + fabs(expected[2]);
      for (int a = 0; a < 3; a++) assert_close(normal[a], expected[a], 0, 1e-12 * (1 + size));
    }
    if (laws[k].law == VSC_LAW_HOLZAPFEL_OGDEN) continue;
    const double swollen[9] = {1.1, 0, 0, 0.3 * 1.1, 1.1, 0, 0, 0, 1.1};
    cauchy(&laws[k], swollen, sigma);
    laws[k].isochoric = false;
    assert_close(sigma[1], sheared(&laws[k], 0, 1, 0.3), 1e-12, 0);
  }
}

// Figures of six digits.
static void guccione_is_as_published(void **state)
{
  (void)state;
  const vsc_material_def m = guccione_material();
  static const double stretch[4] = {0.9, 1.1, 1.2, 1.3};
  static const double fibre[4] = {-1.60852, 2.42069, 8.09652, 26.4673};
  static const double cross[4] = {-0.751228, 0.784450, 1.90477, 3.82963};
  static const double sides[4][2] = {
      {1.084624, 1.024421}, {0.924098, 0.983760}, {0.855740, 0.973817}, {0.794276, 0.968467}};
  static const double both[4][2] = {
      {-3.55212, -2.39269}, {2.89508, 1.10506}, {10.3305, 3.27747}, {39.7318, 11.319}};
  for (int k = 0; k < 4; k++) {
    const double x = stretch[k];
    double l[3], normal[3];
    const double Ef = (x * x - 1) / 2, Et = (1 / x - 1) / 2;
    const double closed = 2 * exp(8 * Ef * Ef + 4 * Et * Et) * (8 * x * x * Ef - 2 * Et / x);
    assert_close(pulled(&m, 0, x, l), closed, 1e-12, 0);
    assert_close(closed, fibre[k], 5e-6, 0);
    assert_close(pulled(&m, 1, x, l), cross[k], 5e-6, 0);
    assert_close(l[2], sides[k][0], 0, 6e-7);
    assert_close(l[0], sides[k][1], 0, 6e-7);
    const double plane[3] = {x, x, 1 / (x * x)};
    stretched(&m, plane, normal);
    assert_close(normal[0] - normal[2], both[k][0], 5e-6, 0);
    assert_close(normal[1] - normal[2], both[k][1], 5e-6, 0);
  }
  static const double shears[2][3] = {{0.93896, 0.88467, 0.433324}, {3.06129, 2.41033, 1.10305}};
  for (int k = 0; k < 2; k++) {
    const double gamma = 0.2 * (k + 1);
    assert_close(sheared(&m, 0, 1, gamma), shears[k][0], 6e-6, 0);
    assert_close(sheared(&m, 0, 2, gamma), shears[k][0], 6e-6, 0);
    assert_close(sheared(&m, 1, 0, gamma), shears[k][1], 6e-6, 0);
    assert_close(sheared(&m, 2, 0, gamma), shears[k][1], 6e-6, 0);
    assert_close(sheared(&m, 1, 2, gamma), shears[k][2], 6e-6, 0);
    assert_close(sheared(&m, 2, 1, gamma), shears[k][2], 6e-6, 0);
  }
}

static void isotropic_guccione_is_as_published(void **state)
{
  (void)state;
  vsc_material_def m = guccione_material();
  m.guccione = (vsc_guccione_def){.C = 10, .fibre = 1, .cross = 1, .shear = 1};
  static const double stretch[4] = {0.9, 1.1, 1.2, 1.5};
  static const double stress[4] = {-1.40802, 1.70944, 4.11068, 23.7062};
  double l[3];
  for (int k = 0; k < 4; k++)
    for (int axis = 0; axis < 3; axis++)
      assert_close(pulled(&m, axis, stretch[k], l), stress[k], 5e-6, 0);
  assert_close(sheared(&m, 0, 1, 0.2), 1.06143, 5e-6, 0);
  assert_close(sheared(&m, 1, 2, 0.4), 2.52936, 5e-6, 0);
}

static void holzapfel_ogden_is_as_published(void **state)
{
  (void)state;
  const vsc_material_def m = myocardium(VSC_FIBRES_SHARP);
  static const double stretch[4] = {0.9, 1.05, 1.1, 1.2};
  static const double stress[3][4] = {{-35.175, 4949.88, 19054.3, 521058},
                                      {-35.726, 639.616, 2081.16, 27150.9},
                                      {-1637.41, 9.38838, 22.2578, 84.2298}};
  static const double both[4][2] = {
      {-133.95, -133.95}, {4961.11, 650.845}, {19103.1, 2129.96}, {522007, 28100.2}};
  double l[3], normal[3];
  for (int k = 0; k < 4; k++) {
    for (int axis = 0; axis < 3; axis++)
      assert_close(pulled(&m, axis, stretch[k], l), stress[axis][k], 2e-5, 0);
    const double plane[3] = {stretch[k], stretch[k], 1 / (stretch[k] * stretch[k])};
    stretched(&m, plane, normal);
    assert_close(normal[0] - normal[2], both[k][0], 1e-5, 0);
    assert_close(normal[1] - normal[2], both[k][1], 1e-5, 0);
  }
  pulled(&m, 0, 0.9, l);
  assert_close(l[1], 1.001899, 0, 6e-7);
  static const double shears[2][5] = {{387.751, 319.493, 124.931, 56.6737, 16.2651},
                                      {4187.36, 3648.88, 1045.82, 507.345, 85.1936}};
  for (int k = 0; k < 2; k++) {
    const double gamma = 0.2 * (k + 1), *expected = shears[k];
    assert_close(sheared(&m, 0, 1, gamma), expected[0], 6e-6, 0);
    assert_close(sheared(&m, 0, 2, gamma), expected[1], 6e-6, 0);
    assert_close(sheared(&m, 1, 0, gamma), expected[2], 6e-6, 0);
    assert_close(sheared(&m, 1, 2, gamma), expected[3], 6e-6, 0);
    assert_close(sheared(&m, 2, 0, gamma), expected[4], 6e-6, 0);
    assert_close(sheared(&m, 2, 1, gamma), expected[4], 6e-6, 0);
  }
}

static void smooth_switch_is_as_published(void **state)
{
  (void)state;
  const vsc_material_def m = myocardium(VSC_FIBRES_SMOOTH);
  double l[3];
  assert_close(sheared(&m, 0, 1, 0.2), 392.872, 6e-6, 0);
  assert_close(sheared(&m, 0, 2, 0.2), 324.615, 6e-6, 0);
  assert_close(sheared(&m, 1, 0, 0.2), 125.619, 6e-6, 0);
  assert_close(sheared(&m, 1, 2, 0.2), 57.3617, 6e-6, 0);
  assert_close(sheared(&m, 2, 0, 0.2), 16.2651, 6e-6, 0);
  assert_close(pulled(&m, 0, 1.05, l), 4949.80, 6e-6, 0);
}

// Dispersed evenly, fibres are a part of the ground: x = (I1 - 3)/3, and the stress is isotropic.
static void even_dispersion_is_isotropic(void **state)
{
  (void)state;
  vsc_material_def m = myocardium(VSC_FIBRES_SHARP);
  m.holzapfel_ogden.kappa_f = 1.0 / 3;
  m.holzapfel_ogden.a_s = m.holzapfel_ogden.a_fs = 0;
  double l[3];
  const double stress = pulled(&m, 0, 1.1, l);
  assert_close(stress, pulled(&m, 2, 1.1, l), 1e-12, 0);
  // sigma = 2 (l^2 - 1/l) (a/2 e^(b (I1 - 3)) + a_f x/3 e^(b_f x^2))
  const double x = (1.21 + 2 / 1.1 - 3) / 3;
  const double ground = 29.5 * exp(8.023 * 3 * x), fibres = 18472 * x / 3 * exp(16.026 * x * x);
  assert_close(stress, 2 * (1.21 - 1 / 1.1) * (ground + fibres), 1e-12, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rubber_is_its_closed_form),
      cmocka_unit_test(laws_of_two_invariants_are_their_closed_forms),
      cmocka_unit_test(fung_is_its_closed_form),
      cmocka_unit_test(springs_are_their_closed_form),
      cmocka_unit_test(isochoric_laws_are_their_closed_forms),
      cmocka_unit_test(guccione_is_as_published),
      cmocka_unit_test(isotropic_guccione_is_as_published),
      cmocka_unit_test(holzapfel_ogden_is_as_published),
      cmocka_unit_test(smooth_switch_is_as_published),
      cmocka_unit_test(even_dispersion_is_isotropic),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
