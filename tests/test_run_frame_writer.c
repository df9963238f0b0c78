// SPDX-License-Identifier: GPL-3.0-or-later
// Frames by a thread of their own: all of them, in order, the same bytes as when written at once; the first failure
// is told, and nothing is written behind it.
#include "run/frame_writer.h"

#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"
#include "small_body.h"

enum { FRAMES = 12 };
static char folder[] = "/tmp/viscera-frames-XXXXXX";

static vsc_snapshot *make_snapshot(const vsc_mesh *mesh, int number, const char *place)
{
  vsc_snapshot *made;
  double *values;
  if (!VSC_NEW(made, 1) || !VSC_NEW(values, mesh->node_count)) fail_msg("no memory");
  for (size_t n = 0; n < mesh->node_count; n++) values[n] = sin((double)n + number);
  made->shown = *mesh;
  made->time = 0.5 * number;
  made->arrays[0] = (vsc_vtk_array){"wave", 1, values, VSC_ON_NODES, false};
  made->owned[0] = true;
  made->count = 1;
  snprintf(made->name, sizeof made->name, "%s%02d.vtu", place, number);
  snprintf(made->file, sizeof made->file, "%s/%s", folder, made->name);
  return made;
}

static void open_series(const char *name, bool beside, vsc_pvd **pvd, vsc_frame_writer **writer)
{
  vsc_error error;
  char file[128];
  snprintf(file, sizeof file, "%s/%s.pvd", folder, name);
  if (vsc_pvd_open(file, -1, pvd, &error) != VSC_OK || vsc_frame_writer_create(*pvd, beside, writer, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

static size_t read_file(const char *name, char *bytes, size_t size)
{
  char file[128];
  snprintf(file, sizeof file, "%s/%s", folder, name);
  FILE *stream = fopen(file, "rb");
  if (stream == NULL) fail_msg("%s is missing", file);
  const size_t count = fread(bytes, 1, size, stream);
  fclose(stream);
  return count;
}

static void a_thread_writes_what_is_written_at_once(void **state)
{
  (void)state;
  vsc_mesh *mesh = block_of(3, 3, 3, 1, 0.1);
  vsc_error error;
  for (int beside = 0; beside < 2; beside++) {
    vsc_pvd *pvd;
    vsc_frame_writer *writer;
    open_series(beside ? "b" : "a", beside, &pvd, &writer);
    for (int k = 0; k < FRAMES; k++)
      assert_int_equal(vsc_frame_writer_take(writer, make_snapshot(mesh, k, beside ? "b" : "a"), &error), VSC_OK);
    assert_int_equal(vsc_frame_writer_finish(writer, &error), VSC_OK);
    assert_int_equal(vsc_pvd_count(pvd), FRAMES);
    assert_true(vsc_frame_writer_seconds(writer) > 0);
    for (int k = 0; k < FRAMES; k++) assert_close(vsc_pvd_time(pvd, (size_t)k), 0.5 * k, 0, 0);
    vsc_frame_writer_free(writer);
    vsc_pvd_free(pvd);
  }
  for (int k = 0; k < FRAMES; k++) {
    static char bytes[2][1 << 18];
    char name[2][16];
    snprintf(name[0], sizeof name[0], "a%02d.vtu", k);
    snprintf(name[1], sizeof name[1], "b%02d.vtu", k);
    const size_t size = read_file(name[0], bytes[0], sizeof bytes[0]);
    assert_true(size > 100 && size < sizeof bytes[0]);
    assert_int_equal(read_file(name[1], bytes[1], sizeof bytes[1]), size);
    assert_memory_equal(bytes[0], bytes[1], size);
  }
  vsc_mesh_free(mesh);
}

// A writer that is freed has written what it has taken.
static void freeing_finishes(void **state)
{
  (void)state;
  vsc_mesh *mesh = block_of(3, 3, 3, 1, 0.1);
  vsc_error error;
  vsc_pvd *pvd;
  vsc_frame_writer *writer;
  open_series("freed", true, &pvd, &writer);
  for (int k = 0; k < 3; k++)
    assert_int_equal(vsc_frame_writer_take(writer, make_snapshot(mesh, k, "f"), &error), VSC_OK);
  vsc_frame_writer_free(writer);
  assert_int_equal(vsc_pvd_count(pvd), 3);
  vsc_pvd_free(pvd);
  vsc_mesh_free(mesh);
}

static void the_first_failure_ends_it(void **state)
{
  (void)state;
  vsc_mesh *mesh = block_of(2, 2, 2, 1, 0.1);
  for (int beside = 0; beside < 2; beside++) {
    vsc_pvd *pvd;
    vsc_frame_writer *writer;
    vsc_error error = {.text = ""};
    open_series("failing", beside, &pvd, &writer);
    assert_int_equal(vsc_frame_writer_take(writer, make_snapshot(mesh, 0, "g"), &error), VSC_OK);
    // of a folder that is not there; told at once, or to one of the next
    vsc_status status = vsc_frame_writer_take(writer, make_snapshot(mesh, 1, "missing/h"), &error);
    for (int k = 2; k < FRAMES; k++) status = vsc_frame_writer_take(writer, make_snapshot(mesh, k, "g"), &error);
    assert_int_equal(status, VSC_SYSTEM);
    error.text[0] = '\0';
    assert_int_equal(vsc_frame_writer_finish(writer, &error), VSC_SYSTEM);
    assert_non_null(strstr(error.text, "missing/h01.vtu"));
    assert_int_equal(vsc_pvd_count(pvd), 1);
    vsc_frame_writer_free(writer);
    vsc_pvd_free(pvd);
  }
  vsc_mesh_free(mesh);
}

static int make_folder(void **state)
{
  (void)state;
  return mkdtemp(folder) == NULL;
}

static int remove_folder(void **state)
{
  (void)state;
  char command[64];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_thread_writes_what_is_written_at_once),
      cmocka_unit_test(freeing_finishes),
      cmocka_unit_test(the_first_failure_ends_it),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
