// SPDX-License-Identifier: GPL-3.0-or-later
// Shape functions and integrals on faces of three and six nodes.
#include "mesh/face.h"

#include "close.h"

static double power(double base, int exponent)
{
  double product = 1;
  while (exponent-- > 0) product *= base;
  return product;
}

static double factorial(int n)
{
  return n < 2 ? 1 : n * factorial(n - 1);
}

static const double corners[6][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0}, {0.5, 0.5}, {0, 0.5}};

// Where a point of the rule lies: sum_i N_i x_i.
static void place_of(const vsc_face_rule *rule, int q, double place[2])
{
  for (int k = 0; k < 2; k++) {
    place[k] = 0;
    for (int i = 0; i < rule->nodes; i++) place[k] += rule->N[q][i] * corners[i][k];
  }
}

// int xi^a eta^b = a! b! / (a + b + 2)!
static void assert_exact(const vsc_face_rule *rule, int degree, double allowed)
{
  for (int a = 0; a <= degree; a++)
    for (int b = 0; a + b <= degree; b++) {
      double sum = 0, place[2];
      for (int q = 0; q < rule->points; q++) {
        place_of(rule, q, place);
        sum += rule->weight[q] * power(place[0], a) * power(place[1], b);
      }
      assert_close(sum, factorial(a) * factorial(b) / factorial(a + b + 2), 0, allowed);
    }
}

static void rules_are_exact_to_their_degree(void **state)
{
  (void)state;
  for (int nodes = 3; nodes <= 6; nodes += 3) {
    const vsc_face_rule flux = vsc_face_rule_of(nodes, VSC_FACE_FLUX);
    const vsc_face_rule mass = vsc_face_rule_of(nodes, VSC_FACE_MASS);
    assert_int_equal(flux.points, nodes == 3 ? 1 : 6);
    assert_int_equal(mass.points, 12);
    assert_exact(&flux, nodes == 3 ? 1 : 4, 1e-16);  // rounding
    assert_exact(&mass, 6, 2e-15);  // the points are known to 15 digits
  }
}

// Any quadratic field is what its values at the nodes say, and so are its derivatives.
static void shapes_reproduce_quadratics(void **state)
{
  (void)state;
  const vsc_face_rule rule = vsc_face_rule_of(6, VSC_FACE_MASS);
  for (int q = 0; q < rule.points; q++) {
    double place[2], value = 0, slope[2] = {0, 0}, one = 0;
    place_of(&rule, q, place);
    for (int i = 0; i < 6; i++) {
      const double u = corners[i][0], v = corners[i][1];
      const double field = 1 - 2 * u + 3 * v + 4 * u * u - 5 * u * v + 6 * v * v;
      value += rule.N[q][i] * field;
      one += rule.N[q][i];
      for (int k = 0; k < 2; k++) slope[k] += rule.dN[q][k][i] * field;
    }
    const double u = place[0], v = place[1];
    // rounding of numbers of about 10
    assert_close(one, 1, 0, 1e-15);
    assert_close(value, 1 - 2 * u + 3 * v + 4 * u * u - 5 * u * v + 6 * v * v, 0, 1e-14);
    assert_close(slope[0], -2 + 8 * u - 5 * v, 0, 1e-14);
    assert_close(slope[1], 3 - 5 * u + 12 * v, 0, 1e-14);
  }
}

// The normal's length is twice the area of a flat triangle, at every point and with either number of
// nodes.
static void the_normal_measures_area(void **state)
{
  (void)state;
  static const double corner[3][3] = {{1, 2, 3}, {4, 2, 3}, {1, 2, 7}};
  double x[6][3];
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      x[i][k] = corner[i][k];
      x[3 + i][k] = (corner[i][k] + corner[(i + 1) % 3][k]) / 2;
    }
  for (int nodes = 3; nodes <= 6; nodes += 3) {
    const vsc_face_rule rule = vsc_face_rule_of(nodes, VSC_FACE_MASS);
    for (int q = 0; q < rule.points; q++) {
      double t1[3], t2[3], n[3];
      vsc_face_tangents(&rule, q, (const double(*)[3])x, t1, t2, n);
      assert_close(n[0], 0, 0, 1e-13);
      assert_close(n[1], -12, 1e-14, 0);
      assert_close(n[2], 0, 0, 1e-13);
    }
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rules_are_exact_to_their_degree),
      cmocka_unit_test(shapes_reproduce_quadratics),
      cmocka_unit_test(the_normal_measures_area),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
