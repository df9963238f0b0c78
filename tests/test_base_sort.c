// SPDX-License-Identifier: GPL-3.0-or-later
// Records are sorted by their keys, and those with equal keys stay in their order.
#include "base/sort.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "close.h"

enum { MOST_WORDS = 6 };

// `keys` random words, the last of few values, and a number that tells the records' order.
static void fill(uint32_t *records, size_t count, size_t words, size_t keys)
{
  static const uint32_t masks[3] = {0xffffffffu, 0x00300000u, 3};
  uint64_t seed = 1;
  for (size_t k = 0; k < count; k++)
    for (size_t w = 0; w < words; w++) {
      seed = seed * UINT64_C(6364136223846793005) + 1442695040888963407u;
      records[words * k + w] = w < keys ? (uint32_t)(seed >> 32) & masks[(k + w) % 3] : (uint32_t)k;
    }
}

static void check(size_t count, size_t words, size_t keys)
{
  uint32_t *records, *seen;
  assert_true(VSC_NEW(records, words * count + 1) && VSC_NEW(seen, count));
  fill(records, count, words, keys);
  records[words * count] = 12345;  // nothing behind the last is touched
  assert_true(vsc_sort(records, count, words, keys));
  assert_int_equal(records[words * count], 12345);
  for (size_t k = 0; k < count; k++) {
    const uint32_t *record = records + words * k;
    assert_true(record[keys] < count);
    assert_int_equal(seen[record[keys]]++, 0);
    for (size_t w = keys; w < words; w++) assert_int_equal(record[w], record[keys]);
    if (k == 0) continue;
    size_t w = 0;
    while (w < keys && record[w] == record[w - words]) w++;
    assert_true(record[w] > record[w - words]);  // where all keys are equal: the order
  }
  vsc_free(records);
  vsc_free(seen);
}

static void records_are_sorted_by_their_keys(void **state)
{
  (void)state;
  for (size_t words = 2; words <= MOST_WORDS; words++)
    for (size_t keys = 1; keys < words; keys++)
      for (size_t count = 0; count < 5000; count = 3 * count + 1) check(count, words, keys);
}

// Wherever in a word the bits lie in which records differ, and however many these are.
static void any_bits_count(void **state)
{
  (void)state;
  enum { COUNT = 300 };
  for (int low = 0; low < 32; low++)
    for (int bits = 1; low + bits <= 32; bits++) {
      uint32_t records[COUNT][2], seed = 1;
      const uint32_t mask = UINT32_MAX >> (32 - bits) << low;
      for (uint32_t k = 0; k < COUNT; k++) {
        seed = seed * 1664525u + 1013904223u;
        records[k][0] = ((seed ^ seed >> 16) & mask) | (~mask & 0xa5a5a5a5u);
        records[k][1] = k;
      }
      assert_true(vsc_sort(records, COUNT, 2, 1));
      for (int k = 1; k < COUNT; k++) {
        const bool tied = records[k][0] == records[k - 1][0];
        assert_true(tied ? records[k][1] > records[k - 1][1] : records[k][0] > records[k - 1][0]);
      }
    }
}

static void short_memory_leaves_them_alone(void **state)
{
  (void)state;
  uint32_t records[4] = {3, 0, 1, 1};
  const uint32_t before[4] = {3, 0, 1, 1};
  vsc_alloc_fail_after(0);
  assert_false(vsc_sort(records, 2, 2, 1));
  vsc_alloc_fail_after(-1);
  assert_memory_equal(records, before, sizeof before);
}

// Differences that no int holds, too.
static void numbers_are_compared(void **state)
{
  (void)state;
  static const uint32_t small[2] = {1, UINT32_MAX};
  static const uint64_t large[2] = {1, UINT64_MAX};
  static const double real[2] = {-1e300, 1e-300};
  for (int a = 0; a < 2; a++)
    for (int b = 0; b < 2; b++) {
      assert_int_equal(vsc_compare_uint32(&small[a], &small[b]), a - b);
      assert_int_equal(vsc_compare_uint64(&large[a], &large[b]), a - b);
      assert_int_equal(vsc_compare_doubles(&real[a], &real[b]), a - b);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(records_are_sorted_by_their_keys),
      cmocka_unit_test(any_bits_count),
      cmocka_unit_test(numbers_are_compared),
      cmocka_unit_test(short_memory_leaves_them_alone),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
