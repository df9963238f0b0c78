// SPDX-License-Identifier: GPL-3.0-or-later
// The Hilbert curve visits each cell once and never jumps; points are sorted along it.
#include "mesh/order.h"

#include <stdlib.h>
#include <string.h>

#include "close.h"

// Cells in the order of their index.
static void test_bijection_with_unit_steps(void **state)
{
  (void)state;
  for (int bits = 1; bits <= 4; bits++) {
    const uint32_t side = 1u << bits;
    const size_t cells = (size_t)side * side * side;
    uint32_t(*at)[3] = calloc(cells, sizeof *at);
    char *seen = calloc(cells, 1);
    assert_true(at != NULL && seen != NULL);
    for (uint32_t i = 0; i < side; i++)
      for (uint32_t j = 0; j < side; j++)
        for (uint32_t k = 0; k < side; k++) {
          const uint64_t index = vsc_hilbert_index((const uint32_t[]){i, j, k}, bits);
          assert_true(index < cells);
          assert_int_equal(seen[index]++, 0);
          memcpy(at[index], (const uint32_t[]){i, j, k}, sizeof at[index]);
        }
    for (size_t c = 1; c < cells; c++) {
      int distance = 0;
      for (int i = 0; i < 3; i++) distance += abs((int)at[c][i] - (int)at[c - 1][i]);
      assert_int_equal(distance, 1);
    }
    free(at);
    free(seen);
  }
}

// Cells of a coarse grid are contiguous runs of the finer one: the first digits do not change.
static void test_refinement_keeps_the_coarse_order(void **state)
{
  (void)state;
  uint32_t random = 1;
  for (int repeat = 0; repeat < 1000; repeat++) {
    uint32_t cell[3];
    for (int i = 0; i < 3; i++) {
      random = random * 1664525u + 1013904223u;
      cell[i] = random >> 11;  // 21 bits
    }
    const uint64_t block = vsc_hilbert_index(cell, 21) >> 9;  // of 8 x 8 x 8 cells
    cell[0] ^= 5;
    cell[2] ^= 7;
    assert_true(vsc_hilbert_index(cell, 21) >> 9 == block);
    cell[1] ^= 8;
    assert_true(vsc_hilbert_index(cell, 21) >> 9 != block);
  }
}

static void test_points_are_sorted(void **state)
{
  (void)state;
  enum { COUNT = 500 };
  double points[3 * COUNT];
  uint32_t group[COUNT], order[COUNT];
  srand(1);
  for (int p = 0; p < COUNT; p++) {
    for (int i = 0; i < 3; i++) points[3 * p + i] = rand() % 100 * 0.25 - 7;
    group[p] = (uint32_t)(rand() % 3);
  }
  assert_int_equal(vsc_order_hilbert(COUNT, points, group, order, NULL), VSC_OK);
  char seen[COUNT] = {0};
  double way = 0, crow = 0;
  for (int k = 0; k < COUNT; k++) {
    assert_int_equal(seen[order[k]]++, 0);
    if (k == 0) continue;
    assert_true(group[order[k]] >= group[order[k - 1]]);
    double step = 0, unsorted = 0;
    for (int i = 0; i < 3; i++) {
      step += pow(points[3 * order[k] + i] - points[3 * order[k - 1] + i], 2);
      unsorted += pow(points[3 * k + i] - points[3 * k - 3 + i], 2);
    }
    way += sqrt(step);
    crow += sqrt(unsorted);
  }
  assert_true(way < 0.4 * crow);  // neighbours in memory are neighbours in space
}

// Where a point lies along the curve through [0, side]^3.
static uint64_t index_of(const double point[3], double side)
{
  const double scale = ((1u << 20) - 1) / side;
  uint32_t cell[3];
  for (int i = 0; i < 3; i++) cell[i] = (uint32_t)(point[i] * scale);
  return vsc_hilbert_index(cell, 20);
}

// By group, whose numbers may be large, then along the curve to its last digit, then by number.
static void test_the_order_is_exact(void **state)
{
  (void)state;
  enum { COUNT = 5000 };
  static double points[3 * COUNT];
  static uint32_t group[COUNT], order[COUNT];
  static const uint32_t groups[4] = {4000000000u, 3000, 7, 0};
  srand(2);
  for (int p = 0; p < COUNT; p++) {
    for (int i = 0; i < 3; i++) points[3 * p + i] = p % 3 == 0 ? rand() % 4 : rand() % 100000 * 3e-5;
    group[p] = groups[rand() % 4];
  }
  assert_int_equal(vsc_order_hilbert(COUNT, points, group, order, NULL), VSC_OK);
  size_t ties = 0;
  for (int k = 1; k < COUNT; k++) {
    const uint32_t a = order[k - 1], b = order[k];
    const uint64_t before = index_of(points + 3 * a, 3), after = index_of(points + 3 * b, 3);
    assert_true(group[a] <= group[b]);
    if (group[a] < group[b]) continue;
    assert_true(before <= after);
    if (before == after) assert_true(a < b);
    ties += before == after;
  }
  assert_true(ties > COUNT / 5);
}

// Equal points, a single one and none at all have an order too: that of their numbers.
static void test_degenerate_points(void **state)
{
  (void)state;
  const double points[12] = {1, 2, 3, 1, 2, 3, 1, 2, 3, 1, 2, 3};
  uint32_t order[4];
  assert_int_equal(vsc_order_hilbert(4, points, NULL, order, NULL), VSC_OK);
  for (uint32_t k = 0; k < 4; k++) assert_int_equal(order[k], k);
  assert_int_equal(vsc_order_hilbert(1, points, NULL, order, NULL), VSC_OK);
  assert_int_equal(vsc_order_hilbert(0, points, NULL, order, NULL), VSC_OK);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_bijection_with_unit_steps),
      cmocka_unit_test(test_refinement_keeps_the_coarse_order),
      cmocka_unit_test(test_points_are_sorted),
      cmocka_unit_test(test_the_order_is_exact),
      cmocka_unit_test(test_degenerate_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
