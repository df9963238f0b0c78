// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "close.h"
#include "trap.h"
#include "mesh/axes.h"

static double between(double low, double high)
{
  return low + (high - low) * rand() / RAND_MAX;
}

static void random_vector(double v[3], double size)
{
  for (int i = 0; i < 3; i++) v[i] = size * between(-1, 1);
}

static void new_axes_are_global_and_unknown(void **state)
{
  (void)state;
  vsc_axes *axes = vsc_axes_create(3);
  assert_int_equal(axes->count, 3);
  for (size_t i = 0; i < 27; i++) assert_close(axes->frames[i], i % 9 % 4 == 0, 0, 0);
  for (size_t i = 0; i < 3; i++) assert_int_equal(axes->known[i], 0);
  assert_true(vsc_axes_valid(axes));
  vsc_axes_free(axes);
  vsc_axes_free(NULL);
}

static void frames_are_orthonormal_whatever_comes_in(void **state)
{
  (void)state;
  srand(1);
  vsc_axes *axes = vsc_axes_create(1);
  for (int round = 0; round < 20000; round++) {
    double fiber[3], sheet[3];
    const double size = pow(10, between(-5, 5));
    random_vector(fiber, size);
    random_vector(sheet, pow(10, between(-5, 5)));
    if (round % 4 == 1)
      for (int i = 0; i < 3; i++) sheet[i] = fiber[i] + between(-1, 1) * 0.03 * size;
    const int made = vsc_axes_complete(fiber, round % 2 ? sheet : NULL, axes->frames);
    assert_int_equal(made, vsc_norm(fiber) >= 1e-6);
    assert_true(vsc_axes_valid(axes));
    if (made) assert_close(vsc_dot(fiber, axes->frames), vsc_norm(fiber), 1e-14, 0);
  }
  vsc_axes_free(axes);
}

static void the_sheet_follows_its_hint(void **state)
{
  (void)state;
  double frame[9];
  const double fiber[3] = {2, 0, 0}, sheet[3] = {5, 0, -3};
  assert_true(vsc_axes_complete(fiber, sheet, frame));
  const double expected[9] = {1, 0, 0, 0, 0, -1, 0, 1, 0};
  for (int i = 0; i < 9; i++) assert_close(frame[i], expected[i], 0, 1e-15);
}

// Without a usable hint the sheet starts from the global axis with the smallest component of f.
static void the_rule_without_a_hint(void **state)
{
  (void)state;
  const double near = tan(0.9 * M_PI / 180), beyond = tan(1.1 * M_PI / 180);
  const double fiber[3] = {0.6, -0.8, 0};
  const double hints[][3] = {{0, 0, 0}, {0.6, -0.8, near}, {-0.6, 0.8, near}, {NAN, 0, 1},
                             {0, INFINITY, 1}};
  double by_rule[9], frame[9];
  assert_true(vsc_axes_complete(fiber, NULL, by_rule));
  const double expected[9] = {0.6, -0.8, 0, 0, 0, 1, -0.8, -0.6, 0};
  for (int i = 0; i < 9; i++) assert_close(by_rule[i], expected[i], 0, 1e-15);
  for (size_t h = 0; h < sizeof hints / sizeof hints[0]; h++) {
    trap_off();
    assert_true(vsc_axes_complete(fiber, hints[h], frame));
    trap_on();
    assert_memory_equal(frame, by_rule, sizeof frame);
  }
  const double used[3] = {0.6, -0.8, -beyond};
  assert_true(vsc_axes_complete(fiber, used, frame));
  assert_close(frame[5], -1, 1e-12, 0);
}

static void ties_go_to_the_first_axis(void **state)
{
  (void)state;
  double frame[9];
  assert_true(vsc_axes_complete((double[]){0, 0, 4}, NULL, frame));
  assert_close(frame[3], 1, 0, 0);
  assert_true(vsc_axes_complete((double[]){1, 1, 1}, NULL, frame));
  assert_true(frame[3] > 0.8);
  assert_true(vsc_axes_complete((double[]){1, 0, 0}, NULL, frame));
  assert_close(frame[4], 1, 0, 0);
}

static void a_useless_fiber_leaves_the_frame_alone(void **state)
{
  (void)state;
  const double useless[][3] = {{0, 0, 0}, {9e-7, 0, 0}, {NAN, 0, 1}, {0, INFINITY, 0}};
  double frame[9];
  for (size_t u = 0; u < sizeof useless / sizeof useless[0]; u++) {
    for (int i = 0; i < 9; i++) frame[i] = 7;
    trap_off();
    assert_false(vsc_axes_complete(useless[u], NULL, frame));
    trap_on();
    for (int i = 0; i < 9; i++) assert_close(frame[i], 7, 0, 0);
  }
  assert_true(vsc_axes_complete((double[]){1e300, 1e300, 0}, NULL, frame));
  assert_close(frame[0], sqrt(0.5), 1e-14, 0);
}

static void bad_frames_are_seen(void **state)
{
  (void)state;
  vsc_axes *axes = vsc_axes_create(2);
  double *second = axes->frames + 9;
  second[8] = -1;  // left-handed
  assert_false(vsc_axes_valid(axes));
  second[8] = 1;
  assert_true(vsc_axes_valid(axes));
  second[1] = 1e-8;
  assert_false(vsc_axes_valid(axes));
  second[1] = NAN;
  trap_off();
  assert_false(vsc_axes_valid(axes));
  trap_on();
  vsc_axes_free(axes);
}

static void short_memory_gives_null(void **state)
{
  (void)state;
  for (long after = 0; after < 3; after++) {
    vsc_alloc_fail_after(after);
    assert_null(vsc_axes_create(2));
    vsc_alloc_fail_after(-1);
  }
  assert_null(vsc_axes_create(SIZE_MAX / 4));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(new_axes_are_global_and_unknown),
    cmocka_unit_test(frames_are_orthonormal_whatever_comes_in),
    cmocka_unit_test(the_sheet_follows_its_hint),
    cmocka_unit_test(the_rule_without_a_hint),
    cmocka_unit_test(ties_go_to_the_first_axis),
    cmocka_unit_test(a_useless_fiber_leaves_the_frame_alone),
    cmocka_unit_test(bad_frames_are_seen),
    cmocka_unit_test(short_memory_gives_null),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
