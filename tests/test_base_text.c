// SPDX-License-Identifier: GPL-3.0-or-later
// Distances between words, the nearest of a list, names that fit their field.
#include "base/text.h"

#include <string.h>

#include "close.h"

static void test_distances(void **state)
{
  (void)state;
  assert_int_equal(vsc_edit_distance("", ""), 0);
  assert_int_equal(vsc_edit_distance("axial", "axial"), 0);
  assert_int_equal(vsc_edit_distance("AXIAL", "axial"), 0);  // without case
  assert_int_equal(vsc_edit_distance("", "abc"), 3);         // insertions
  assert_int_equal(vsc_edit_distance("abc", ""), 3);         // deletions
  assert_int_equal(vsc_edit_distance("axial", "axiel"), 1);  // a replacement
  assert_int_equal(vsc_edit_distance("fibre", "fiber"), 2);  // an exchange is two
  assert_int_equal(vsc_edit_distance("presure", "pressures"), 2);
}

// Symmetry and the triangle inequality on all pairs and triples.
static void test_distance_is_a_metric(void **state)
{
  (void)state;
  static const char *const words[] = {"", "a", "time", "item", "mite", "times", "emit", "tissue"};
  enum { WORDS = sizeof words / sizeof words[0] };
  for (int i = 0; i < WORDS; i++)
    for (int j = 0; j < WORDS; j++) {
      const size_t d = vsc_edit_distance(words[i], words[j]);
      assert_int_equal(d, vsc_edit_distance(words[j], words[i]));
      assert_true((d == 0) == (i == j));
      for (int k = 0; k < WORDS; k++)
        assert_true(d <=
                    vsc_edit_distance(words[i], words[k]) + vsc_edit_distance(words[k], words[j]));
    }
}

static void test_nearest(void **state)
{
  (void)state;
  static const char *const words[] = {"axial", "angular", "damping", "density"};
  assert_string_equal(vsc_nearest("Axail", words, 4), "axial");
  assert_string_equal(vsc_nearest("dampng", words, 4), "damping");
  assert_string_equal(vsc_nearest("density", words, 4), "density");
  assert_null(vsc_nearest("xyzzyplugh", words, 4));
  assert_null(vsc_nearest("axial", words, 0));
  // a tie goes to the first
  assert_string_equal(vsc_nearest("bat", (const char *const[]){"bar", "cat"}, 2), "bar");
}

// What is longer than the distance looks at is cut, not read past its end.
static void test_very_long_words(void **state)
{
  (void)state;
  char a[1000], b[1000];
  memset(a, 'a', sizeof a);
  memset(b, 'b', sizeof b);
  a[sizeof a - 1] = b[sizeof b - 1] = '\0';
  assert_int_equal(vsc_edit_distance(a, a), 0);
  assert_true(vsc_edit_distance(a, b) >= 100);
}

static void test_names_are_cut(void **state)
{
  (void)state;
  char name[VSC_NAME + 1], from[2 * VSC_NAME];
  memset(from, 'n', sizeof from - 1);
  from[sizeof from - 1] = '\0';
  name[VSC_NAME] = 7;
  vsc_copy_name(name, from);
  assert_int_equal(strlen(name), VSC_NAME - 1);
  assert_int_equal(name[VSC_NAME], 7);
  vsc_copy_name(name, "endo");
  assert_string_equal(name, "endo");
}

static void test_plain_names(void **state)
{
  (void)state;
  static const char *const plain[] = {"", "endo", "left ventricle", "a.b-c_1/2", "\xc3\xa9pi"};
  static const char *const odd[] = {"a,b", "a[0", "b]", "\"a\"", "a\\b", "a\nb", "a\tb", "a\x7f"};
  for (size_t k = 0; k < sizeof plain / sizeof plain[0]; k++) assert_true(vsc_name_is_plain(plain[k]));
  for (size_t k = 0; k < sizeof odd / sizeof odd[0]; k++) assert_false(vsc_name_is_plain(odd[k]));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_distances),     cmocka_unit_test(test_distance_is_a_metric),
      cmocka_unit_test(test_nearest),       cmocka_unit_test(test_very_long_words),
      cmocka_unit_test(test_names_are_cut), cmocka_unit_test(test_plain_names),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
