// SPDX-License-Identifier: GPL-3.0-or-later
// The stencil of a tet against the construction of Bourguignon & Cani 2000: an axis through the
// barycentre meets the tet's surface in two points; the nodes pull them along with their area
// coordinates in the faces that were met.
#include "close.h"
#include "model/stencil.h"
#include "paper_axes.h"

enum { ROUNDS = 20000 };

// w_i / r of the paper for one axis: the difference of the two points' weights over their distance.
static void paper_weights(const double x[4][3], const double axis[3], double weights[4])
{
  double front[4], back[4];
  const double chord = leave(x, axis, 1, front) + leave(x, axis, -1, back);
  for (int i = 0; i < 4; i++) weights[i] = (front[i] - back[i]) / chord;
}

static double largest_entry(const double *values, int count)
{
  double largest = 0;
  for (int i = 0; i < count; i++) largest = fmax(largest, fabs(values[i]));
  return largest;
}

static void the_gradient_form_is_the_papers_construction(void **state)
{
  (void)state;
  uint64_t seed = 1;
  for (int round = 0; round < ROUNDS; round++) {
    double x[4][3], frame[9], B[3][4];
    random_tet(&seed, pow(10, random_between(&seed, -2, 2)), x);
    random_rotation(&seed, frame);
    vsc_stencil_tet(x, frame, B);
    for (int a = 0; a < 3; a++) {
      double paper[4];
      paper_weights(x, frame + 3 * a, paper);
      // both divide by 6V or a face, at worst some hundred times smaller than L^3
      for (int i = 0; i < 4; i++)
        assert_close(B[a][i], paper[i], 0, 1e-13 * largest_entry(B[a], 4));
    }
  }
}

// An axis that meets an edge or a vertex has no single face, but the same weights: the regular tet
// with corners (1,1,1), (1,-1,-1), (-1,1,-1), (-1,-1,1). Its axis (1,1,1)/sqrt 3 runs from the
// vertex at distance sqrt 3 to the face at -1/sqrt 3: chord 4/sqrt 3, weights (1, -1/3, -1/3, -1/3)
// . sqrt 3/4. Its axis z runs from edge to edge: chord 2, weights (1, -1, -1, 1)/2 . 1/2.
static void axes_through_corners_and_edges_are_no_special_case(void **state)
{
  (void)state;
  const double x[4][3] = {{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}};
  const double p = 1 / sqrt(3), q = 1 / sqrt(2), h = 1 / sqrt(6);
  const double frame[9] = {p, p, p, q, -q, 0, h, h, -2 * h};
  const double global[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  double B[3][4];
  // edge vectors (-2,0,-2), (0,-2,-2), (-2,-2,0): determinant 16, volume 16/6
  assert_close(vsc_stencil_tet(x, frame, B), 8. / 3, 1e-15, 0);
  for (int i = 0; i < 4; i++) assert_close(B[0][i], (i == 0 ? 1 : -1. / 3) * sqrt(3) / 4, 1e-15, 0);
  vsc_stencil_tet(x, global, B);
  const double along_z[4] = {0.25, -0.25, -0.25, 0.25};
  for (int i = 0; i < 4; i++) assert_close(B[2][i], along_z[i], 1e-15, 0);
}

static void at_rest_the_stencil_gives_the_axes(void **state)
{
  (void)state;
  uint64_t seed = 2;
  for (int round = 0; round < ROUNDS; round++) {
    double x[4][3], frame[9], B[3][4];
    random_tet(&seed, 10, x);
    random_rotation(&seed, frame);
    vsc_stencil_tet(x, frame, B);
    for (int a = 0; a < 3; a++) {
      double scale = 0;
      for (int i = 0; i < 4; i++) scale += 10 * fabs(B[a][i]);
      for (int k = 0; k < 3; k++) {
        double axis = 0;
        for (int i = 0; i < 4; i++) axis += B[a][i] * x[i][k];
        // positions of up to 10 cancel; B itself is good to 1e-16 L^3/V
        assert_close(axis, frame[3 * a + k], 0, 1e-14 * scale);
      }
    }
  }
}

// G = F R exactly, whatever F: B differentiates linear fields.
static void a_homogeneous_deformation_is_recovered(void **state)
{
  (void)state;
  uint64_t seed = 3;
  for (int round = 0; round < 2000; round++) {
    double x[4][3], frame[9], F[9], B[3][4], moved[4][3];
    random_tet(&seed, 1, x);
    random_rotation(&seed, frame);
    random_fill(&seed, 1, F, 9);
    vsc_stencil_tet(x, frame, B);
    for (int i = 0; i < 4; i++) rotate_vector(F, x[i], moved[i]);
    for (int a = 0; a < 3; a++) {
      double expected[3];
      rotate_vector(F, frame + 3 * a, expected);
      for (int k = 0; k < 3; k++) {
        double axis = 0;
        for (int i = 0; i < 4; i++) axis += B[a][i] * moved[i][k];
        assert_close(axis, expected[k], 0, 1e-14 * (1 + 4 * largest_entry(B[a], 4)));
      }
    }
  }
}

static void coefficients_do_not_see_translation(void **state)
{
  (void)state;
  uint64_t seed = 4;
  for (int round = 0; round < 2000; round++) {
    double x[4][3], frame[9], B[3][4], far[3][4];
    random_tet(&seed, 1, x);
    random_rotation(&seed, frame);
    const double volume = vsc_stencil_tet(x, frame, B);
    for (int a = 0; a < 3; a++)
      assert_close(B[a][0] + B[a][1] + B[a][2] + B[a][3], 0, 0, 1e-15 * largest_entry(B[a], 4));
    for (int i = 0; i < 12; i++) (&x[0][0])[i] += 100;
    // positions of 100 are rounded to 1.4e-14; L^3/V is at most 100
    assert_close(vsc_stencil_tet(x, frame, far), volume, 1e-12, 0);
    for (int a = 0; a < 3; a++)
      for (int i = 0; i < 4; i++)
        assert_close(far[a][i], B[a][i], 0, 1e-12 * largest_entry(&B[0][0], 12));
  }
}

// The unit right-angled corner: volume 1/6, gradients (-1,-1,-1), x, y, z.
static void the_unit_corner_by_hand(void **state)
{
  (void)state;
  const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const double frame[9] = {0, 1, 0, 0, 0, 1, 1, 0, 0};  // f = y, s = z, n = x
  const double expected[3][4] = {{-1, 0, 1, 0}, {-1, 0, 0, 1}, {-1, 1, 0, 0}};
  double B[3][4];
  assert_close(vsc_stencil_tet(x, frame, B), 1. / 6, 1e-16, 0);
  for (int a = 0; a < 3; a++)
    for (int i = 0; i < 4; i++) assert_close(B[a][i], expected[a][i], 1e-15, 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_gradient_form_is_the_papers_construction),
      cmocka_unit_test(axes_through_corners_and_edges_are_no_special_case),
      cmocka_unit_test(at_rest_the_stencil_gives_the_axes),
      cmocka_unit_test(a_homogeneous_deformation_is_recovered),
      cmocka_unit_test(coefficients_do_not_see_translation),
      cmocka_unit_test(the_unit_corner_by_hand),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
