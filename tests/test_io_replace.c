// SPDX-License-Identifier: GPL-3.0-or-later
// Texts that are whole or absent, also where the disk is full.
#include "close.h"

#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include "io/replace.h"
#include "scratch.h"

static void assert_text(const char *file, const char *text)
{
  char *found = scratch_load(file, NULL);
  assert_string_equal(found, text);
  free(found);
}

static void a_text_replaces_another(void **state)
{
  (void)state;
  vsc_replacement text;
  const char *file = scratch_text("table.csv", "old\n");
  assert_int_equal(vsc_replace_begin(file, &text, NULL), VSC_OK);
  fputs("new\n", text.stream);
  assert_text(file, "old\n");
  assert_int_equal(vsc_replace_end(&text, false, NULL), VSC_OK);
  assert_text(file, "new\n");
  assert_int_not_equal(access(text.temporary, F_OK), 0);
}

// Files may have 1000 bytes, which a stream's buffer only learns when it is emptied.
static void what_cannot_be_written_leaves_nothing(void **state)
{
  (void)state;
  vsc_error error;
  vsc_replacement text;
  struct rlimit before, little;
  const char *file = scratch_text("table.csv", "old\n");
  assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
  little = (struct rlimit){1000, before.rlim_max};
  signal(SIGXFSZ, SIG_IGN);
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &little), 0);
  for (int lines = 200; lines <= 20000; lines *= 100) {
    assert_int_equal(vsc_replace_begin(file, &text, &error), VSC_OK);
    for (int k = 0; k < lines; k++) fputs("0123456789\n", text.stream);
    assert_int_equal(vsc_replace_end(&text, false, &error), VSC_SYSTEM);
    assert_non_null(strstr(error.text, "cannot be written"));
    assert_text(file, "old\n");
    assert_int_not_equal(access(text.temporary, F_OK), 0);
  }
  assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
  assert_int_equal(vsc_replace_begin("/nowhere/table.csv", &text, &error), VSC_SYSTEM);
  assert_int_equal(error.status, VSC_SYSTEM);
}

// A device is no file that could be replaced.
static void devices_are_written_to(void **state)
{
  (void)state;
  vsc_error error;
  struct stat facts;
  vsc_replacement text;
  assert_int_equal(vsc_replace_begin("/dev/null", &text, &error), VSC_OK);
  fputs("lost\n", text.stream);
  assert_int_equal(vsc_replace_end(&text, false, &error), VSC_OK);
  assert_int_equal(vsc_replace_begin("/dev/full", &text, &error), VSC_OK);
  fputs("lost\n", text.stream);
  assert_int_equal(vsc_replace_end(&text, false, &error), VSC_SYSTEM);
  assert_int_equal(stat("/dev/full", &facts), 0);
  assert_true(S_ISCHR(facts.st_mode));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_text_replaces_another),
      cmocka_unit_test(what_cannot_be_written_leaves_nothing),
      cmocka_unit_test(devices_are_written_to),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
