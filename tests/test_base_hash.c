// SPDX-License-Identifier: GPL-3.0-or-later
// The hash that compares runs: FNV-1a's published values, and that every bit counts.
#include "base/hash.h"

#include <string.h>

#include "close.h"

// From the definition of the 64-bit FNV-1a hash (its authors' test vectors).
static void test_known_values(void **state)
{
  (void)state;
  assert_true(vsc_hash(VSC_HASH_START, "", 0) == UINT64_C(0xcbf29ce484222325));
  assert_true(vsc_hash(VSC_HASH_START, "a", 1) == UINT64_C(0xaf63dc4c8601ec8c));
  assert_true(vsc_hash(VSC_HASH_START, "foobar", 6) == UINT64_C(0x85944171f73967e8));
}

static void test_parts_are_the_whole(void **state)
{
  (void)state;
  const char text[] = "a heart beats";
  const uint64_t whole = vsc_hash(VSC_HASH_START, text, sizeof text);
  for (size_t cut = 0; cut <= sizeof text; cut++) {
    const uint64_t first = vsc_hash(VSC_HASH_START, text, cut);
    assert_true(vsc_hash(first, text + cut, sizeof text - cut) == whole);
  }
}

static void test_every_bit_counts(void **state)
{
  (void)state;
  double values[8] = {0, 1, -1, 0.1, 1e300, 5e-324, 3, 4};
  const uint64_t whole = vsc_hash(VSC_HASH_START, values, sizeof values);
  for (size_t bit = 0; bit < 8 * sizeof values; bit++) {
    unsigned char *byte = (unsigned char *)values + bit / 8;
    *byte ^= (unsigned char)(1u << bit % 8);
    assert_true(vsc_hash(VSC_HASH_START, values, sizeof values) != whole);
    *byte ^= (unsigned char)(1u << bit % 8);
  }
  const double zeros[2] = {0.0, -0.0};  // equal numbers, other bits
  assert_true(vsc_hash(VSC_HASH_START, zeros, 8) != vsc_hash(VSC_HASH_START, zeros + 1, 8));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_known_values),
      cmocka_unit_test(test_parts_are_the_whole),
      cmocka_unit_test(test_every_bit_counts),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
