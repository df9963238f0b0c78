// SPDX-License-Identifier: GPL-3.0-or-later
// What a run leaves behind: series, frames, signals, summary, checkpoint, scene.
#include "block_scene.h"
#include "io/pvd.h"
#include "run/run.h"

static vsc_pvd *open_series(const char *file)
{
  vsc_pvd *series = NULL;
  vsc_error error;
  if (vsc_pvd_open(in_folder(file), HUGE_VAL, &series, &error) != VSC_OK)
    fail_msg("%s", error.text);
  return series;
}

static vsc_mesh *read_frame(const char *run, const char *frame)
{
  char name[256];
  vsc_mesh *mesh = NULL;
  vsc_error error;
  snprintf(name, sizeof name, "%s/%s", run, frame);
  if (vsc_vtk_read_mesh(in_folder(name), 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

// signals.csv of a run: columns and rows.
typedef struct signals {
  int columns, rows;
  char names[64][64];
  double values[64][64];  // [row][column]
} signals;

static void read_signals(const char *run, signals *s)
{
  static char text[PROGRAM_TEXT];
  char name[64];
  snprintf(name, sizeof name, "%s/signals.csv", run);
  load_text(name, text, sizeof text);
  *s = (signals){0};
  char *line_place = NULL;
  char *line = strtok_r(text, "\n", &line_place);
  assert_non_null(line);
  for (char *word = strtok(line, ","); word != NULL; word = strtok(NULL, ","))
    snprintf(s->names[s->columns++], 64, "%s", word);
  while ((line = strtok_r(NULL, "\n", &line_place)) != NULL) {
    char *end = line;
    for (int c = 0; c < s->columns; c++) {
      s->values[s->rows][c] = strtod(end, &end);
      assert_true(*end == (c + 1 < s->columns ? ',' : '\0'));
      end++;
    }
    s->rows++;
  }
}

static int column(const signals *s, const char *name)
{
  for (int c = 0; c < s->columns; c++)
    if (strcmp(s->names[c], name) == 0) return c;
  fail_msg("no column %s", name);
  return 0;
}

static void test_series_and_frames(void **state)
{
  (void)state;
  static const char *const always[] = {"fiber", "active_tension", "stretch_f", "volume_ratio",
                                       "region"};
  must("$V run block.yaml -o a");
  assert_holds(said, "a/block.pvd");
  assert_int_equal(line_count(said), 1);
  vsc_pvd *series = open_series("a/block.pvd");
  assert_int_equal(vsc_pvd_count(series), 11);
  for (size_t f = 0; f < 11; f++) {
    assert_close(vsc_pvd_time(series, f), 0.002 * (double)f, 1e-12, 0);
    vsc_mesh *frame = read_frame("a", vsc_pvd_frame(series, f));
    assert_int_equal(frame->node_count, 7 * 5 * 5);
    assert_int_equal(frame->element_count, 6 * 4 * 4 * 5);
    for (size_t k = 0; k < sizeof always / sizeof always[0]; k++)
      assert_non_null(vsc_arrays_find(&frame->element_data, always[k]));
    assert_non_null(vsc_arrays_find(&frame->node_data, "displacement"));
    assert_non_null(vsc_arrays_find(&frame->node_data, "velocity"));
    assert_non_null(vsc_arrays_find(&frame->node_data, "volume_ratio"));
    // the axes that were used are in the first frame
    assert_true((vsc_arrays_find(&frame->element_data, "sheet") != NULL) == (f == 0));
    assert_true((vsc_arrays_find(&frame->element_data, "normal") != NULL) == (f == 0));
    vsc_mesh_free(frame);
  }
  vsc_pvd_free(series);
  assert_int_equal(shell("ls a a/frames | grep -c tmp"), 1);  // no temporary file is left
}

static void test_chosen_arrays(void **state)
{
  (void)state;
  must(
      "$V run block.yaml -o chosen --set 'output.arrays=[displacement, stretch_f]' --set "
      "'time.end=4 ms'");
  for (int f = 0; f < 2; f++) {
    vsc_mesh *frame = read_frame("chosen", f ? "frames/block_00001.vtu" : "frames/block_00000.vtu");
    assert_int_equal(frame->node_data.count, 1);
    assert_int_equal(frame->element_data.count, f ? 1 : 4);  // the first frame has its axes too
    vsc_mesh_free(frame);
  }
}

// Strain and stress come when asked for, as tensors; the one is zero in the first frame.
static void test_derived_arrays(void **state)
{
  (void)state;
  static const struct {
    const char *name;
    int components;
  } derived[] = {{"strain_fiber", 6},          {"strain", 6},       {"principal_strains", 3},
                 {"principal_strain_axis", 3}, {"stress_fiber", 6}, {"stress", 6},
                 {"von_mises", 1},             {"principal_stresses", 3},
                 {"principal_stress_axis", 3}, {"helix_angle", 1}};
  char command[512] = "$V run block.yaml -o derived --set 'time.end=4 ms' --set "
                      "'output.axis=[0, 0, 1]' --set 'output.arrays=[region";
  for (size_t k = 0; k < sizeof derived / sizeof derived[0]; k++) {
    strcat(command, ", ");
    strcat(command, derived[k].name);
  }
  must(strcat(command, "]'"));
  for (int f = 0; f < 2; f++) {
    vsc_mesh *frame = read_frame("derived", f ? "frames/block_00001.vtu" : "frames/block_00000.vtu");
    for (size_t k = 0; k < sizeof derived / sizeof derived[0]; k++) {
      const vsc_array *array = vsc_arrays_find(&frame->element_data, derived[k].name);
      assert_non_null(array);
      assert_int_equal(array->components, derived[k].components);
      double most = 0;
      for (size_t i = 0; i < (size_t)array->components * frame->element_count; i++)
        most = fmax(most, fabs(array->values[i]));
      const bool axis = strstr(array->name, "axis") != NULL || strcmp(array->name, "helix_angle") == 0;
      // rounding of the block at rest through its modulus of volume
      if (f == 0 && !axis)
        assert_true(most < 1e-9);
      else
        assert_true(most > 1e-3 && isfinite(most));
    }
    vsc_mesh_free(frame);
  }
}

static void test_signals(void **state)
{
  (void)state;
  static const char *const known[] = {"time [s]",
                                      "step [ms]",
                                      "cavity_skin [ml]",
                                      "wall_volume [ml]",
                                      "pressure_end [kPa]",
                                      "active_tension_max [kPa]",
                                      "stretch_f_min [1]",
                                      "J_min [1]",
                                      "J_node_max [1]",
                                      "inverted_elements [1]",
                                      "energy_kinetic [mJ]",
                                      "work_active [mJ]",
                                      "work_pressure [mJ]",
                                      "dissipated [mJ]",
                                      "balance_error [mJ]",
                                      "momentum_x [mg m/s]"};
  static signals s;
  read_signals("a", &s);
  assert_int_equal(s.rows, 21);
  for (size_t k = 0; k < sizeof known / sizeof known[0]; k++) column(&s, known[k]);
  const int skin = column(&s, "cavity_skin [ml]"), wall = column(&s, "wall_volume [ml]");
  const int pressure = column(&s, "pressure_end [kPa]"),
            tension = column(&s, "active_tension_max [kPa]");
  for (int r = 0; r < s.rows; r++) {
    assert_close(s.values[r][0], 1e-3 * r, 1e-11, 0);
    assert_close(s.values[r][skin], -s.values[r][wall], 1e-10, 0);  // the skin surrounds the tissue
    assert_close(s.values[r][pressure], fmin(0.1 * r, 1), 1e-10, 0);
    // the curve's table is linear between points 20/8192 ms apart
    if (r < 20) assert_close(s.values[r][tension], 10 * sin(M_PI * r / 20), 0, 2e-6);
  }
  assert_close(s.values[0][wall], 2, 1e-11, 0);
}

// Extrema of signals.csv (12 digits) and summary.json (10 digits).
static void test_summary(void **state)
{
  (void)state;
  static signals s;
  read_signals("a", &s);
  for (int c = 0; c < s.columns; c++) {
    double low = s.values[0][c], high = low, told[2];
    for (int r = 1; r < s.rows; r++) {
      low = fmin(low, s.values[r][c]);
      high = fmax(high, s.values[r][c]);
    }
    assert_int_equal(
        sscanf(summary_raw("a", s.names[c]), "{\"min\": %lf, \"max\": %lf}", told, told + 1), 2);
    assert_close(told[0], low, 1e-9, 0);
    assert_close(told[1], high, 1e-9, 0);
  }
  assert_string_equal(summary_raw("a", "outcome"), "\"finished\"");
  assert_string_equal(summary_raw("a", "rows"), "21");
  assert_string_equal(summary_raw("a", "nodes"), "175");
  assert_string_equal(summary_raw("a", "elements"), "480");
  assert_string_equal(summary_raw("a", "frames"), "11");
  assert_string_equal(summary_raw("a", "time_s"), "0.02");
  assert_string_equal(summary_raw("a", "held_nodes"), "25");
  assert_close(strtod(summary_raw("a", "mass_g"), NULL), 2 * 1.06, 1e-9, 0);
  must("python3 -m json.tool a/summary.json || ! command -v python3");
  must("$V info a/checkpoint.h5");
  assert_holds(said, "position");
}

// The scene as understood is the same scene.
static void test_scene_as_understood(void **state)
{
  (void)state;
  char hash[64];
  must("$V run a/scene.yaml -o again");
  snprintf(hash, sizeof hash, "%s", summary_raw("a", "model_hash"));
  assert_string_equal(summary_raw("again", "model_hash"), hash);
  assert_same_files("again/signals.csv", "a/signals.csv");
}

// Two loads on one surface have two columns and two keys, none of them that of a surface with such a name.
static void test_columns_of_one_surface(void **state)
{
  (void)state;
  static char text[PROGRAM_TEXT];
  must("$V run block.yaml -q -o pushed --set 'pressures=[{surface: end, peak: 1 kPa}, {surface: end, peak: 2 kPa, "
       "direction: [0, 1, 0]}, {surface: skin, peak: 0.5 kPa}]' --set 'time.end=2 ms'");
  load_text("pushed/signals.csv", text, sizeof text);
  assert_holds(text, ",pressure_end [kPa],pressure_end_2 [kPa],pressure_skin [kPa],");
  assert_close(last_signal("pushed", "pressure_end_2"), 2, 1e-15, 0);
  load_text("pushed/summary.json", text, sizeof text);
  assert_holds(text, "\"pressure_end_2 [kPa]\": {");
  must("$V run block.yaml -q -o pushed --set 'surfaces=[{name: end, node_array: x1, value: 1}, {name: end_2, boundary: true}]' "
       "--set 'pressures=[{surface: end, peak: 1 kPa}, {surface: end, peak: 2 kPa}, {surface: end_2, peak: 0.5 kPa}]' "
       "--set 'output.cavities=[end]' --set 'time.end=2 ms'");
  load_text("pushed/signals.csv", text, sizeof text);
  assert_holds(text, ",pressure_end [kPa],pressure_end_3 [kPa],pressure_end_2 [kPa],");
  assert_close(last_signal("pushed", "pressure_end_2"), 0.5, 1e-15, 0);
}

static void assert_same_axis(const double *a, const double *b)
{
  assert_close(fabs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]), 1, 1e-12, 0);
}

// A file with nodes and elements in another order, some left-handed: the frames keep the file's
// order, and each node moves as it does in the other file. Only the order of sums differs; a few
// hundred steps leave 1e-12 of that.
static void test_order_of_the_file(void **state)
{
  (void)state;
  uint32_t *nodes = shuffled(175, 1), *tets = shuffled(480, 2);
  write_block("mixed.vtu", nodes, tets);
  must("$V run block.yaml -o plain --set output.precision=double");
  must("$V run block.yaml -o mixed --set output.precision=double --set mesh.file=mixed.vtu");
  for (int last = 0; last < 2; last++) {
    const char *name = last ? "frames/block_00010.vtu" : "frames/block_00000.vtu";
    vsc_mesh *plain = read_frame("plain", name), *mixed = read_frame("mixed", name);
    const double *there = vsc_arrays_find(&plain->node_data, "displacement")->values;
    const double *here = vsc_arrays_find(&mixed->node_data, "displacement")->values;
    double most = 0;
    for (size_t p = 0; p < 175; p++)
      for (int i = 0; i < 3; i++) {
        assert_true(mixed->nodes[3 * p + i] == plain->nodes[3 * nodes[p] + i]);
        assert_close(here[3 * p + i], there[3 * nodes[p] + i], 0, 1e-10);
        most = fmax(most, fabs(here[3 * p + i]));
      }
    assert_true(last ? most > 0.1 : most == 0);
    const double *fiber = vsc_arrays_find(&mixed->element_data, "fiber")->values;
    const double *other = vsc_arrays_find(&plain->element_data, "fiber")->values;
    for (size_t p = 0; p < 480; p++) assert_same_axis(fiber + 3 * p, other + 3 * tets[p]);
    vsc_mesh_free(plain);
    vsc_mesh_free(mixed);
  }
  free(nodes);
  free(tets);
}

// The fibres of the first frame are those of the file.
static void test_fibres_of_the_first_frame(void **state)
{
  (void)state;
  vsc_mesh *file = NULL, *frame = read_frame("mixed", "frames/block_00000.vtu");
  assert_int_equal(vsc_vtk_read_mesh(in_folder("mixed.vtu"), 1, &file, NULL), VSC_OK);
  const double *given = vsc_arrays_find(&file->element_data, "direction")->values;
  const double *f = vsc_arrays_find(&frame->element_data, "fiber")->values;
  const double *s = vsc_arrays_find(&frame->element_data, "sheet")->values;
  const double *n = vsc_arrays_find(&frame->element_data, "normal")->values;
  for (size_t t = 0; t < 3 * 480; t += 3) {
    const double length =
        sqrt(given[t] * given[t] + given[t + 1] * given[t + 1] + given[t + 2] * given[t + 2]);
    assert_same_axis(
        f + t, (const double[]){given[t] / length, given[t + 1] / length, given[t + 2] / length});
    assert_close(f[t] * s[t] + f[t + 1] * s[t + 1] + f[t + 2] * s[t + 2], 0, 0, 1e-12);
    assert_same_axis(n + t, (const double[]){f[t + 1] * s[t + 2] - f[t + 2] * s[t + 1],
                                             f[t + 2] * s[t] - f[t] * s[t + 2],
                                             f[t] * s[t + 1] - f[t + 1] * s[t]});
  }
  vsc_mesh_free(file);
  vsc_mesh_free(frame);
}

static void assert_times(const char *run, const char *intervals, int rows, const double *row_times,
                         int frames, const double *frame_times)
{
  static signals s;
  char command[256], file[64];
  snprintf(command, sizeof command,
           "$V run block.yaml -q -o %s --set 'output={%s}' --set 'time.end=11 ms'", run, intervals);
  must(command);
  read_signals(run, &s);
  assert_int_equal(s.rows, rows);
  for (int r = 0; r < rows; r++) assert_close(s.values[r][0], 1e-3 * row_times[r], 1e-11, 0);
  snprintf(file, sizeof file, "%s/block.pvd", run);
  vsc_pvd *series = open_series(file);
  assert_int_equal(vsc_pvd_count(series), frames);
  for (int f = 0; f < frames; f++)
    assert_close(vsc_pvd_time(series, (size_t)f), 1e-3 * frame_times[f], 1e-11, 0);
  vsc_pvd_free(series);
}

// Intervals that do not fit into one another nor into the end: rows and frames lie at the multiples
// and at the end.
static void test_intervals(void **state)
{
  (void)state;
  assert_times("odd", "frames: 2.5 ms, signals: 3 ms, checkpoint: 4 ms", 5,
               (const double[]){0, 3, 6, 9, 11}, 6, (const double[]){0, 2.5, 5, 7.5, 10, 11});
  assert_times("rare", "frames: 50 ms, signals: 70 ms", 2, (const double[]){0, 11}, 2,
               (const double[]){0, 11});
  assert_times("slow", "frames: 3 ms, signals: 7 ms", 3, (const double[]){0, 7, 11}, 5,
               (const double[]){0, 3, 6, 9, 11});
  assert_times("fifths", "frames: 5.5 ms, signals: 2.2 ms", 6,
               (const double[]){0, 2.2, 4.4, 6.6, 8.8, 11}, 3, (const double[]){0, 5.5, 11});
}

// Steps of the user's length lead past multiples of the intervals: rows and frames come with the first
// step that is not before them, and a forced step is told in the summary.
static void test_fixed_steps(void **state)
{
  (void)state;
  static signals s;
  must("$V run block.yaml -q -o fixed --set 'output={frames: 0.5 ms, signals: 0.2 ms}' --set 'time={end: 2 ms, "
       "step: 0.03 ms, force: true}'");
  read_signals("fixed", &s);
  assert_int_equal(s.rows, 11);
  for (int r = 0; r < s.rows; r++) {
    const double step = ceil(0.2 * r / 0.03 * (1 - 1e-12));
    assert_close(s.values[r][0], 1e-3 * 0.03 * step, 1e-11, 0);
  }
  vsc_pvd *series = open_series("fixed/block.pvd");
  assert_int_equal(vsc_pvd_count(series), 5);
  for (size_t f = 0; f < 5; f++)
    assert_close(vsc_pvd_time(series, f), 1e-3 * 0.03 * ceil(0.5 * (double)f / 0.03 * (1 - 1e-12)), 1e-11, 0);
  vsc_pvd_free(series);
  must("grep -q forced_step fixed/summary.json");
}

// 0.1 is no binary fraction: 110 multiples of it, none twice, none left out.
static void test_many_rows(void **state)
{
  (void)state;
  must(
      "$V run block.yaml -o many --set 'output={frames: 0.3 ms, signals: 0.1 ms}' --set "
      "'time.end=5.1 ms'");
  static signals s;
  read_signals("many", &s);
  assert_int_equal(s.rows, 52);
  for (int r = 0; r < s.rows; r++) assert_close(s.values[r][0], 1e-4 * r, 1e-11, 0);
  assert_string_equal(summary_raw("many", "frames"), "18");
}

typedef struct heard {
  int calls;
  double time, end;
} heard;

static void hear(void *context, double time, double end, double wall_seconds)
{
  heard *h = context;
  assert_true(time > h->time && wall_seconds >= 0);
  *h = (heard){h->calls + 1, time, end};
}

static void test_library_call(void **state)
{
  (void)state;
  char directory[256];
  vsc_error error;
  vsc_problem *problem;
  vsc_run_result result;
  heard h = {0};
  snprintf(directory, sizeof directory, "%s", in_folder("library"));
  assert_int_equal(vsc_problem_load(in_folder("block.yaml"), NULL, 0, &problem, &error), VSC_OK);
  const vsc_run_options options = {
      .directory = directory, .progress = hear, .progress_context = &h};
  if (vsc_run(problem, &options, &result, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_int_equal(h.calls, 20);
  assert_true(h.time == 20 && h.end == 20);
  assert_true(result.simulated == 20 && result.steps > 20 && result.frames == 11);
  assert_true(result.cpu_seconds > 0 && result.wall_seconds > 0 && result.updates_per_second > 0);
  assert_string_equal(result.series, in_folder("library/block.pvd"));
  assert_same_files("library/signals.csv", "a/signals.csv");
  vsc_problem_free(problem);
}

// Names up to the longest: the frames keep their numbers and endings.
static void test_long_names(void **state)
{
  (void)state;
  must("cp block.yaml a_scene_with_a_name_that_is_nearly_as_long_as_a_name_may_be.yaml");
  must(
      "$V run a_scene_with_a_name_that_is_nearly_as_long_as_a_name_may_be.yaml --set 'time.end=4 "
      "ms'");
  must("ls a_scene_with_a_name_that_is_nearly_as_long_as_a_name_may_be/frames");
  assert_holds(said, "a_scene_with_a_name_that_is_nearly_as_long_as_a_name_may_be_00002.vtu");
  assert_int_equal(line_count(said), 3);
  assert_int_equal(shell("$V run block.yaml -o $(printf '%0500d' 0)"), 2);
  assert_holds(complained, "folder name of more than");
  must(
      "d=deep; for i in $(seq 30); do d=$d/ninebytes; done; mkdir -p $d && $V run block.yaml -o "
      "$d/x --set 'time.end=2 ms' "
      "&& ls $d/x/checkpoint.h5 $d/x/frames/block_00001.vtu");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_series_and_frames),
      cmocka_unit_test(test_chosen_arrays),
      cmocka_unit_test(test_derived_arrays),
      cmocka_unit_test(test_signals),
      cmocka_unit_test(test_summary),
      cmocka_unit_test(test_scene_as_understood),
      cmocka_unit_test(test_columns_of_one_surface),
      cmocka_unit_test(test_order_of_the_file),
      cmocka_unit_test(test_fibres_of_the_first_frame),
      cmocka_unit_test(test_intervals),
      cmocka_unit_test(test_fixed_steps),
      cmocka_unit_test(test_many_rows),
      cmocka_unit_test(test_library_call),
      cmocka_unit_test(test_long_names),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
