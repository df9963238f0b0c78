// SPDX-License-Identifier: GPL-3.0-or-later
// One line of text for every failure, whatever went into it.
#include "base/status.h"

#include <string.h>

#include "close.h"

static void test_message_and_status(void **state)
{
  (void)state;
  vsc_error error;
  assert_int_equal(vsc_fail(&error, VSC_INPUT, "%s: %d of %g", "key", 3, 0.5), VSC_INPUT);
  assert_int_equal(error.status, VSC_INPUT);
  assert_string_equal(error.text, "key: 3 of 0.5");
  assert_int_equal(vsc_fail(NULL, VSC_NUMERICAL, "nobody listens"), VSC_NUMERICAL);
}

static void test_exit_codes(void **state)
{
  (void)state;
  assert_int_equal(VSC_OK, 0);
  assert_int_equal(VSC_INPUT, 2);
  assert_int_equal(VSC_NUMERICAL, 3);
  assert_int_equal(VSC_SYSTEM, 4);
}

static void test_long_text_is_cut(void **state)
{
  (void)state;
  static char longest[2 * VSC_ERROR_TEXT];
  memset(longest, 'a', sizeof longest - 1);
  struct {
    vsc_error error;
    char guard;
  } kept = {.guard = 7};
  vsc_fail(&kept.error, VSC_SYSTEM, "%s", longest);
  assert_int_equal(strlen(kept.error.text), VSC_ERROR_TEXT - 1);
  assert_int_equal(kept.guard, 7);
}

static void test_control_characters_become_spaces(void **state)
{
  (void)state;
  vsc_error error;
  vsc_fail(&error, VSC_INPUT, "%s", "a\nb\tc\r\033[31md\001\xc3\xa9");
  assert_string_equal(error.text, "a b c  [31md \xc3\xa9");  // UTF-8 stays
}

static void test_entries_of_lists(void **state)
{
  (void)state;
  vsc_error error;
  assert_int_equal(vsc_in_list("surfaces", 2, vsc_fail(&error, VSC_INPUT, "end: is %s", "odd"), &error), VSC_INPUT);
  assert_string_equal(error.text, "surfaces[2] end: is odd");
  assert_int_equal(vsc_in_list("surfaces", 2, vsc_fail(&error, VSC_SYSTEM, "none"), &error), VSC_SYSTEM);
  assert_string_equal(error.text, "none");
  assert_int_equal(vsc_in_list("surfaces", 2, VSC_OK, &error), VSC_OK);
  assert_int_equal(vsc_in_list("surfaces", 2, VSC_INPUT, NULL), VSC_INPUT);
}

static void test_memory(void **state)
{
  (void)state;
  vsc_error error;
  assert_int_equal(vsc_fail_memory(&error, "a frame"), VSC_SYSTEM);
  assert_non_null(strstr(error.text, "out of memory for a frame"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_message_and_status),
      cmocka_unit_test(test_exit_codes),
      cmocka_unit_test(test_long_text_is_cut),
      cmocka_unit_test(test_control_characters_become_spaces),
      cmocka_unit_test(test_entries_of_lists), cmocka_unit_test(test_memory),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
