// SPDX-License-Identifier: GPL-3.0-or-later
// The beginning of a beat on a measured human heart, when its files are there.
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "close.h"
#include "io/vtk.h"
#include "run/run.h"
#include "scratch.h"

static const char scene[] = VSC_SOURCE_DIR "/tests/human_heart.yaml";

static vsc_problem *load_or_skip(const char *const *settings, size_t count)
{
  if (access(VSC_SOURCE_DIR "/../shared/data/heart_human_biv_tet.vtu", R_OK) != 0 ||
      access(VSC_SOURCE_DIR "/../shared/data/heart_human_angles.vti", R_OK) != 0) {
    print_message("skipped: shared/data with the human heart is not there\n");
    skip();
  }
  vsc_problem *problem;
  vsc_error error;
  if (vsc_problem_load(scene, settings, count, &problem, &error) != VSC_OK) fail_msg("%s", error.text);
  return problem;
}

static void the_map_covers_the_heart(void **state)
{
  (void)state;
  vsc_problem *problem = load_or_skip(NULL, 0);
  assert_int_equal(problem->mesh->element_count, 37381);
  assert_int_equal(problem->fibers.with_data + problem->fibers.filled, 37381);
  assert_int_equal(problem->fibers.passive, 0);
  // the map holds every direction that a heart has: angles in degrees, not in tenths
  assert_true(problem->fibers.azimuth[2] - problem->fibers.azimuth[0] > 90);
  assert_true(problem->fibers.elevation[2] > 30 && problem->fibers.elevation[0] < -30);
  vsc_problem_free(problem);
}

static void the_heart_begins_to_beat(void **state)
{
  (void)state;
  const char *settings[] = {"time.end=24 ms", "output.frames=12 ms"};
  vsc_problem *problem = load_or_skip(settings, 2);
  const vsc_run_options options = {.directory = scratch_folder};
  vsc_run_result result;
  vsc_error error;
  if (vsc_run(problem, &options, &result, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_int_equal(result.frames, 3);

  vsc_mesh *frame;
  char file[600];
  snprintf(file, sizeof file, "%s/frames/human_heart_00002.vtu", options.directory);
  if (vsc_vtk_read_mesh(file, 1, &frame, &error) != VSC_OK) fail_msg("%s", error.text);
  const vsc_array *ratio = vsc_arrays_find(&frame->element_data, "volume_ratio");
  const vsc_array *stretch = vsc_arrays_find(&frame->element_data, "stretch_f");
  assert_non_null(ratio);
  assert_non_null(stretch);
  double mean = 0;
  for (size_t t = 0; t < frame->element_count; t++) {
    assert_true(ratio->values[t] > 0.5 && ratio->values[t] < 2);
    mean += stretch->values[t] / (double)frame->element_count;
  }
  // 24 ms into the rise of the tension the fibres have begun to shorten
  assert_true(mean > 0.9 && mean < 0.9999);
  vsc_mesh_free(frame);
  vsc_problem_free(problem);
}

// The frames lie in a folder of their own.
static int remove_frames(void **state)
{
  char file[600];
  for (int k = 0; k < 3; k++) {
    snprintf(file, sizeof file, "%s/frames/human_heart_%05d.vtu", scratch_folder, k);
    unlink(file);
  }
  rmdir(scratch("frames"));
  return scratch_close(state);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(the_map_covers_the_heart),
                                     cmocka_unit_test(the_heart_begins_to_beat)};
  return cmocka_run_group_tests(tests, scratch_open, remove_frames);
}
