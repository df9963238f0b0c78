// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/mem.h"
#include "close.h"
#include "io/pvd.h"
#include "scratch.h"

static void add(vsc_pvd *pvd, double time, const char *frame)
{
  vsc_error error = {0};
  if (vsc_pvd_add(pvd, time, frame, &error) != VSC_OK) fail_msg("%s", error.text);
}

// A series of `count` frames, 0.1 s apart, in `name`.
static void write_series(const char *name, int count)
{
  vsc_pvd *pvd;
  char frame[40];
  assert_int_equal(vsc_pvd_open(scratch(name), -1, &pvd, NULL), VSC_OK);
  for (int i = 0; i < count; i++) {
    snprintf(frame, sizeof frame, "run/frame_%04d.vtu", i);
    add(pvd, i * 0.1, frame);
  }
  vsc_pvd_free(pvd);
}

static void the_file_is_what_paraview_reads(void **state)
{
  (void)state;
  write_series("plain.pvd", 2);
  char *text = scratch_load(scratch("plain.pvd"), NULL);
  assert_string_equal(text,
                      "<?xml version=\"1.0\"?>\n"
                      "<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
                      "  <Collection>\n"
                      "    <DataSet timestep=\"0\" part=\"0\" file=\"run/frame_0000.vtu\"/>\n"
                      "    <DataSet timestep=\"0.1\" part=\"0\" file=\"run/frame_0001.vtu\"/>\n"
                      "  </Collection>\n"
                      "</VTKFile>\n");
  free(text);
  assert_int_not_equal(access(scratch("plain.pvd.tmp"), F_OK), 0);
}

static void a_short_list_is_complete_after_every_frame(void **state)
{
  (void)state;
  vsc_pvd *pvd, *seen;
  assert_int_equal(vsc_pvd_open(scratch("live.pvd"), -1, &pvd, NULL), VSC_OK);
  for (int i = 0; i < 40; i++) {
    add(pvd, i, "f.vtu");
    assert_int_equal(vsc_pvd_open(scratch("live.pvd"), 1e9, &seen, NULL), VSC_OK);
    assert_int_equal(vsc_pvd_count(seen), i + 1);
    vsc_pvd_free(seen);
  }
  vsc_pvd_free(pvd);
}

static size_t frames_on_disk(const char *name)
{
  vsc_pvd *seen;
  assert_int_equal(vsc_pvd_open(scratch(name), 1e9, &seen, NULL), VSC_OK);
  const size_t count = vsc_pvd_count(seen);
  vsc_pvd_free(seen);
  return count;
}

// What is written in all must not grow as the square of the frames.
static void a_long_list_is_written_seldom(void **state)
{
  (void)state;
  enum { FRAMES = 2000 };
  vsc_pvd *pvd;
  int times = 0;
  assert_int_equal(vsc_pvd_open(scratch("long.pvd"), -1, &pvd, NULL), VSC_OK);
  for (size_t i = 0, before = 0; i < FRAMES; i++) {
    add(pvd, (double)i, "f.vtu");
    const size_t have = frames_on_disk("long.pvd");
    assert_in_range(have, i + 1 - i / 64, i + 1);
    times += have != before;
    before = have;
  }
  assert_in_range(times, 64, 64 + 64 * 4);  // 64 ln(2000 / 64) = 220 and the first 64
  assert_int_equal(vsc_pvd_finish(pvd, NULL), VSC_OK);
  assert_int_equal(frames_on_disk("long.pvd"), FRAMES);
  vsc_pvd_free(pvd);
}

static void resuming_trims(void **state)
{
  (void)state;
  write_series("cut.pvd", 10);
  const struct {
    double until;
    size_t kept;
  } cases[] = {{0, 0}, {0.3, 3}, {0.3 + 2e-9, 4}, {0.3 + 1e-10, 3}, {0.35, 4}, {7, 10}, {-1, 0}};
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    vsc_pvd *pvd;
    assert_int_equal(vsc_pvd_open(scratch("cut.pvd"), cases[c].until, &pvd, NULL), VSC_OK);
    assert_int_equal(vsc_pvd_count(pvd), cases[c].kept);
    for (size_t i = 0; i < cases[c].kept; i++) assert_true(vsc_pvd_time(pvd, i) == (int)i * 0.1);
    vsc_pvd_free(pvd);
  }
  vsc_pvd *pvd;
  assert_int_equal(vsc_pvd_open(scratch("cut.pvd"), 0.5, &pvd, NULL), VSC_OK);
  add(pvd, 0.5, "new.vtu");
  vsc_pvd_free(pvd);
  assert_int_equal(vsc_pvd_open(scratch("cut.pvd"), 7, &pvd, NULL), VSC_OK);
  assert_int_equal(vsc_pvd_count(pvd), 6);
  assert_string_equal(vsc_pvd_frame(pvd, 4), "run/frame_0004.vtu");
  assert_string_equal(vsc_pvd_frame(pvd, 5), "new.vtu");
  vsc_pvd_free(pvd);
}

static void times_and_names_come_back_exactly(void **state)
{
  (void)state;
  const double times[] = {-0.25, 0.1 + 0.2, 1. / 3, 1e5 + 1e-9};
  const char *names[] = {"a&b <c>.vtu", "\"quoted\" 'q'\t.vtu", "&amp;.vtu", "plain.vtu"};
  vsc_pvd *pvd;
  assert_int_equal(vsc_pvd_open(scratch("odd.pvd"), -1, &pvd, NULL), VSC_OK);
  for (int i = 0; i < 4; i++) add(pvd, times[i], names[i]);
  vsc_pvd_free(pvd);
  assert_int_equal(vsc_pvd_open(scratch("odd.pvd"), 1e9, &pvd, NULL), VSC_OK);
  assert_int_equal(vsc_pvd_count(pvd), 4);
  for (size_t i = 0; i < 4; i++) {
    assert_true(vsc_pvd_time(pvd, i) == times[i]);
    assert_string_equal(vsc_pvd_frame(pvd, i), names[i]);
  }
  vsc_pvd_free(pvd);
}

static void other_programs_files_are_read(void **state)
{
  (void)state;
  const char *text = "<VTKFile type='Collection'><Collection>\n"
                     "<DataSet group='' file='a.vtu' part='0'\n  timestep='1.5e-1'></DataSet>\n"
                     "</Collection></VTKFile>";
  vsc_pvd *pvd;
  assert_int_equal(vsc_pvd_open(scratch_text("other.pvd", text), 9, &pvd, NULL), VSC_OK);
  assert_int_equal(vsc_pvd_count(pvd), 1);
  assert_true(vsc_pvd_time(pvd, 0) == 0.15);
  assert_string_equal(vsc_pvd_frame(pvd, 0), "a.vtu");
  vsc_pvd_free(pvd);
}

// Comments, spaces round =, characters by number, elements that are none of ours, a list within another one.
static void all_of_xml_is_understood(void **state)
{
  (void)state;
  const char *text = "<?xml version='1.0' encoding='UTF-8'?>\n<!DOCTYPE VTKFile>\n"
                     "<VTKFile type='Collection'><DataSet timestep='0' file='outside.vtu'/><Collection>\n"
                     "<!-- <DataSet timestep='1' file='nowhere.vtu'/> -->\n"
                     "<DataSet timestep = '2' file\n=\n'a&#38;b&#x2e;vtu'/>\n"
                     "<Note><DataSet timestep='3' file='inside.vtu'/><![CDATA[<DataSet>]]></Note>\n"
                     "<DataSet other='file=\"c\" timestep=\"9\"' timestep='4' file='d>.vtu'/>\n"
                     "</Collection></VTKFile>";
  vsc_pvd *pvd;
  assert_int_equal(vsc_pvd_open(scratch_text("legal.pvd", text), 9, &pvd, NULL), VSC_OK);
  assert_int_equal(vsc_pvd_count(pvd), 2);
  assert_true(vsc_pvd_time(pvd, 0) == 2 && vsc_pvd_time(pvd, 1) == 4);
  assert_string_equal(vsc_pvd_frame(pvd, 0), "a&b.vtu");
  assert_string_equal(vsc_pvd_frame(pvd, 1), "d>.vtu");
  vsc_pvd_free(pvd);
}

static void a_fault_has_its_line(void **state)
{
  (void)state;
  const struct {
    const char *text, *said;
  } cases[] = {
      {"<VTKFile>\n<Collection>\n<DataSet timestep='x' file='a'/></Collection></VTKFile>",
       "is not a complete PVD file (line 3: a DataSet without timestep or file)"},
      {"<VTKFile>\n<Collection>\n", "is not a complete PVD file (line 3: "},
      {"<VTKFile><Piece/></VTKFile>", "is not a complete PVD file (no VTKFile with a Collection)"},
      {"<Other><Collection/></Other>", "is not a complete PVD file (no VTKFile with a Collection)"},
  };
  for (size_t c = 0; c < sizeof cases / sizeof cases[0]; c++) {
    vsc_pvd *pvd = NULL;
    vsc_error error = {.text = ""};
    assert_int_equal(vsc_pvd_open(scratch_text("fault.pvd", cases[c].text), 9, &pvd, &error), VSC_INPUT);
    if (strstr(error.text, cases[c].said) == NULL) fail_msg("%s", error.text);
  }
}

static void missing_is_empty(void **state)
{
  (void)state;
  vsc_pvd *pvd;
  assert_int_equal(vsc_pvd_open(scratch("nowhere.pvd"), 3, &pvd, NULL), VSC_OK);
  assert_int_equal(vsc_pvd_count(pvd), 0);
  vsc_pvd_free(pvd);
  vsc_pvd_free(NULL);
}

static void broken_files_are_refused(void **state)
{
  (void)state;
  const char *broken[] = {
    "", "garbage", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>",
    "<VTKFile><Collection></Collection>",
    "<VTKFile><Collection><DataSet timestep=\"0\" file=\"a\"",
    "<VTKFile><Collection><DataSet file=\"a\"/></Collection></VTKFile>",
    "<VTKFile><Collection><DataSet timestep=\"1\"/></Collection></VTKFile>",
    "<VTKFile><Collection><DataSet timestep=\"x\" file=\"a\"/></Collection></VTKFile>",
    "<VTKFile><Collection><DataSet timestep=\"\" file=\"a\"/></Collection></VTKFile>",
    "<VTKFile><Collection><DataSet timestep=\"nan\" file=\"a\"/></Collection></VTKFile>",
    "<VTKFile><Collection><DataSet timestep=\"1 file=a/></Collection></VTKFile>",
    "<VTKFile><Collection></VTKFile><DataSet",
  };
  for (size_t i = 0; i < sizeof broken / sizeof broken[0]; i++) {
    vsc_pvd *pvd = NULL;
    vsc_error error = {0};
    const char *path = scratch_text("broken.pvd", broken[i]);
    if (vsc_pvd_open(path, 9, &pvd, &error) != VSC_INPUT) fail_msg("taken: %s", broken[i]);
    assert_null(pvd);
    assert_ptr_equal(strstr(error.text, path), error.text);
  }
  vsc_pvd *pvd = NULL;
  assert_int_equal(vsc_pvd_open(scratch_folder, 9, &pvd, NULL), VSC_INPUT);
}

// Cut anywhere, a list is refused or keeps no more than it had.
static void truncated_files_are_refused(void **state)
{
  (void)state;
  write_series("whole.pvd", 3);
  size_t bytes;
  char *text = scratch_load(scratch("whole.pvd"), &bytes);
  for (size_t cut = 0; cut + 2 < bytes; cut++) {
    vsc_pvd *pvd = NULL;
    assert_int_equal(vsc_pvd_open(scratch_bytes("part.pvd", text, cut), 9, &pvd, NULL), VSC_INPUT);
  }
  free(text);
}

static void frames_must_follow_one_another(void **state)
{
  (void)state;
  vsc_pvd *pvd;
  vsc_error error;
  assert_int_equal(vsc_pvd_open(scratch("order.pvd"), -1, &pvd, NULL), VSC_OK);
  add(pvd, 1, "a");
  assert_int_equal(vsc_pvd_add(pvd, 1, "b", &error), VSC_INPUT);
  assert_int_equal(vsc_pvd_add(pvd, NAN, "b", &error), VSC_INPUT);
  assert_int_equal(vsc_pvd_count(pvd), 1);
  vsc_pvd_free(pvd);
}

static void what_cannot_be_written_is_reported(void **state)
{
  (void)state;
  vsc_pvd *pvd;
  vsc_error error;
  assert_int_equal(vsc_pvd_open(scratch("no_folder/a.pvd"), -1, &pvd, NULL), VSC_OK);
  assert_int_equal(vsc_pvd_add(pvd, 1, "a", &error), VSC_SYSTEM);
  assert_non_null(strstr(error.text, "no_folder/a.pvd: cannot be written: No such file"));
  vsc_pvd_free(pvd);
}

static void short_memory_is_reported(void **state)
{
  (void)state;
  write_series("mem.pvd", 2);
  for (long after = 0;; after++) {
    vsc_pvd *pvd = NULL;
    vsc_alloc_fail_after(after);
    vsc_status status = vsc_pvd_open(scratch("mem.pvd"), 9, &pvd, NULL);
    if (status == VSC_OK) status = vsc_pvd_add(pvd, 9, "c", NULL);
    vsc_alloc_fail_after(-1);
    vsc_pvd_free(pvd);
    if (status == VSC_OK) {
      assert_true(after > 6);
      return;
    }
    assert_int_equal(status, VSC_SYSTEM);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_file_is_what_paraview_reads),
    cmocka_unit_test(a_short_list_is_complete_after_every_frame),
    cmocka_unit_test(a_long_list_is_written_seldom),
    cmocka_unit_test(resuming_trims),
    cmocka_unit_test(times_and_names_come_back_exactly),
    cmocka_unit_test(other_programs_files_are_read),
    cmocka_unit_test(all_of_xml_is_understood),
    cmocka_unit_test(a_fault_has_its_line),
    cmocka_unit_test(missing_is_empty),
    cmocka_unit_test(broken_files_are_refused),
    cmocka_unit_test(truncated_files_are_refused),
    cmocka_unit_test(frames_must_follow_one_another),
    cmocka_unit_test(what_cannot_be_written_is_reported),
    cmocka_unit_test(short_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
