// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE  // memmem, dladdr
#include <dlfcn.h>
#include <inttypes.h>

#include "close.h"
#include "io/checkpoint.h"
#include "io/hdf5.h"
#include "scratch.h"

static const uint64_t HASH = UINT64_C(0xfedcba9876543210);
enum { ROWS = 50000, BLOCKS = 3 };

static double positions[4 * ROWS], single[1], list[7];
static double back_positions[4 * ROWS], back_single[1], back_list[7];

static const vsc_block OUT[BLOCKS] = {{"positions", "mm", ROWS, 4, positions},
                                      {"time", "ms", 1, 1, single},
                                      {"list", "1", 7, 1, list}};
static const vsc_block IN[BLOCKS] = {{"positions", "mm", ROWS, 4, back_positions},
                                     {"time", "ms", 1, 1, back_single},
                                     {"list", "1", 7, 1, back_list}};

// Every bit pattern must come back: random bits, among them NaNs with a load, and the odd ones.
static void fill(void)
{
  uint64_t bits = 88172645463325252u;
  for (size_t i = 0; i < 4 * ROWS; i++) {
    bits ^= bits << 13;
    bits ^= bits >> 7;
    bits ^= bits << 17;
    memcpy(&positions[i], &bits, sizeof bits);
  }
  const double odd[7] = {0, -0.0, NAN, INFINITY, -INFINITY, 5e-324, 1. / 3};
  memcpy(list, odd, sizeof odd);
  single[0] = 123.456;
}

static const char *write_good(const char *name)
{
  fill();
  vsc_error error = {0};
  const char *path = scratch(name);
  if (vsc_checkpoint_write(path, HASH, BLOCKS, OUT, &error) != VSC_OK) fail_msg("%s", error.text);
  return path;
}

static void assert_refused(const char *path, uint64_t hash, size_t count, const vsc_block *blocks,
                           const char *words)
{
  vsc_error error = {0};
  assert_int_equal(vsc_checkpoint_read(path, hash, count, blocks, &error), VSC_INPUT);
  assert_ptr_equal(strstr(error.text, path), error.text);
  assert_null(strchr(error.text, '\n'));
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
}

static void every_bit_comes_back(void **state)
{
  (void)state;
  const char *path = write_good("a.h5");
  assert_int_not_equal(access(scratch("a.h5.tmp"), F_OK), 0);
  assert_int_equal(vsc_checkpoint_read(path, HASH, BLOCKS, IN, NULL), VSC_OK);
  assert_memory_equal(back_positions, positions, sizeof positions);
  assert_memory_equal(back_single, single, sizeof single);
  assert_memory_equal(back_list, list, sizeof list);
}

static void blocks_are_found_by_name(void **state)
{
  (void)state;
  const char *path = write_good("a.h5");
  const vsc_block some[2] = {IN[2], IN[1]};
  memset(back_list, 0, sizeof back_list);
  assert_int_equal(vsc_checkpoint_read(path, HASH, 2, some, NULL), VSC_OK);
  assert_memory_equal(back_list, list, sizeof list);
}

static void empty_blocks_are_fine(void **state)
{
  (void)state;
  const vsc_block empty[2] = {{"none", "1", 0, 1, NULL}, {"nothing", "1", 0, 4, NULL}};
  assert_int_equal(vsc_checkpoint_write(scratch("e.h5"), 1, 2, empty, NULL), VSC_OK);
  assert_int_equal(vsc_checkpoint_read(scratch("e.h5"), 1, 2, empty, NULL), VSC_OK);
  vsc_block other = empty[1];
  other.columns = 3;
  assert_refused(scratch("e.h5"), 1, 1, &other, "shape");
}

static void other_models_and_shapes_are_refused(void **state)
{
  (void)state;
  const char *path = write_good("a.h5");
  assert_refused(path, HASH + 1, BLOCKS, IN, "belongs to another model");
  vsc_block block = IN[0];
  block.rows--;
  assert_refused(path, HASH, 1, &block, "data set positions has another shape");
  block = IN[0];
  block.columns = 3;
  assert_refused(path, HASH, 1, &block, "shape");
  block.columns = 1;
  assert_refused(path, HASH, 1, &block, "dimensions");
  block = IN[2];
  block.name = "velocities";
  assert_refused(path, HASH, 1, &block, "no data set velocities");
}

static void foreign_files_are_refused(void **state)
{
  (void)state;
  assert_refused(scratch("missing.h5"), HASH, BLOCKS, IN, "No such file");
  assert_refused(scratch_text("empty.h5", ""), HASH, BLOCKS, IN, "no HDF5 file");
  assert_refused(scratch_text("text.h5", "garbage, and more of it\n"), HASH, BLOCKS, IN, "no HDF5");
  assert_refused(scratch_folder, HASH, BLOCKS, IN, "no HDF5");
}

static void truncated_files_are_refused(void **state)
{
  (void)state;
  size_t bytes;
  char *whole = scratch_load(write_good("a.h5"), &bytes);
  for (int part = 0; part < 40; part++) {
    const char *path = scratch_bytes("cut.h5", whole, bytes * (size_t)part / 40);
    assert_refused(path, HASH, BLOCKS, IN, "is damaged, cut short or no HDF5 file");
  }
  free(whole);
}

// A flipped bit in the numbers is seen by the checksum.
static void damaged_numbers_are_refused(void **state)
{
  (void)state;
  size_t bytes;
  char *whole = scratch_load(write_good("a.h5"), &bytes);
  char *place = memmem(whole, bytes, positions + 1000, 64);
  assert_non_null(place);
  place[11] ^= 4;
  assert_refused(scratch_bytes("bad.h5", whole, bytes), HASH, BLOCKS, IN, "positions is damaged");
  place[11] ^= 4;
  char *format = memmem(whole, bytes, "viscera checkpoint", 18);
  assert_non_null(format);
  format[0] = 'V';
  assert_refused(scratch_bytes("bad.h5", whole, bytes), HASH, BLOCKS, IN, "no viscera checkpoint");
  format[0] = 'v';
  const int64_t one = 1;
  char *version = memmem(whole, bytes, "version", 7);
  assert_non_null(version);
  char *number = NULL;  // the last 1 before the next attribute
  for (char *at = version; at < (char *)memmem(version, 400, "model_hash", 10); at++)
    if (memcmp(at, &one, sizeof one) == 0) number = at;
  assert_non_null(number);
  number[0] = 9;
  assert_refused(scratch_bytes("bad.h5", whole, bytes), HASH, BLOCKS, IN, "checkpoint version 9");
  free(whole);
}

static void what_cannot_be_written_is_reported(void **state)
{
  (void)state;
  vsc_error error = {0};
  const char *path = scratch("no_folder/a.h5");
  assert_int_equal(vsc_checkpoint_write(path, HASH, BLOCKS, OUT, &error), VSC_SYSTEM);
  assert_non_null(strstr(error.text, "cannot be written: No such file"));
  // Two blocks of one name cannot both be written: the old file stays, no temporary one is left.
  const vsc_block twice[2] = {OUT[1], OUT[1]};
  const char *old = scratch_text("old.h5", "old");
  assert_int_equal(vsc_checkpoint_write(old, HASH, 2, twice, &error), VSC_SYSTEM);
  char *text = scratch_load(old, NULL);
  assert_string_equal(text, "old");
  free(text);
  assert_int_not_equal(access(scratch("old.h5.tmp"), F_OK), 0);
}

static void hdf5_is_silent(void **state)
{
  (void)state;
  const char *path = scratch_text("text.h5", "garbage");
  const int kept = scratch_hush();
  const vsc_status status = vsc_checkpoint_read(path, HASH, BLOCKS, IN, NULL);
  const size_t printed = scratch_unhush(kept);
  assert_int_equal(status, VSC_INPUT);
  assert_int_equal(printed, 0);
}

// HDF5's own function of this name, found through the module beside the library.
static void *hdf5_function(const char *name)
{
  char module[600];
  Dl_info library;
  assert_int_not_equal(dladdr((void *)(uintptr_t)vsc_checkpoint_read, &library), 0);
  const char *slash = strrchr(library.dli_fname, '/');
  snprintf(module, sizeof module, "%.*s/viscera/hdf5.so", (int)(slash - library.dli_fname), library.dli_fname);
  void *handle = dlopen(module, RTLD_LAZY | RTLD_NOLOAD);
  void *function = handle != NULL ? dlsym(handle, name) : NULL;
  if (function == NULL) fail_msg("%s: no %s", module, name);
  dlclose(handle);
  return function;
}

// Who uses HDF5 beside the library is told of errors as before.
static void hdf5_prints_again(void **state)
{
  (void)state;
  const char *path = scratch_text("text.h5", "garbage");
  void *before = NULL, *after = NULL, *data;
  int (*handler)(int64_t, void **, void **);
  assert_int_equal(vsc_checkpoint_ready(NULL), VSC_OK);
  *(void **)&handler = hdf5_function("H5Eget_auto2");
  assert_true(handler(0, &before, &data) >= 0 && before != NULL);
  assert_int_equal(vsc_hdf5_contents(path, stdout, NULL), VSC_INPUT);
  assert_true(handler(0, &after, &data) >= 0);
  assert_ptr_equal(after, before);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(every_bit_comes_back),
    cmocka_unit_test(blocks_are_found_by_name),
    cmocka_unit_test(empty_blocks_are_fine),
    cmocka_unit_test(other_models_and_shapes_are_refused),
    cmocka_unit_test(foreign_files_are_refused),
    cmocka_unit_test(truncated_files_are_refused),
    cmocka_unit_test(damaged_numbers_are_refused),
    cmocka_unit_test(what_cannot_be_written_is_reported),
    cmocka_unit_test(hdf5_is_silent),
    cmocka_unit_test(hdf5_prints_again),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
