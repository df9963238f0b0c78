// SPDX-License-Identifier: GPL-3.0-or-later
// The same bits however a run is cut and with any number of threads; what a resumed and a failed
// run leave.
#include "block_scene.h"
#include "io/checkpoint.h"
#include "io/pvd.h"
#include "run/watch.h"

// The same bits in positions, velocities, accelerations, ledger, extrema: all of the checkpoint.
static void assert_same_checkpoints(const char *run, const char *other)
{
  static const struct {
    const char *name;
    size_t rows, columns;
  } parts[] = {{"position", 175, 4},      {"velocity", 175, 4}, {"acceleration", 175, 4},
               {"stiffest_mode", 175, 4}, {"works", 5, 1},      {"time_and_steps", 2, 1},
               {"step_limit", 8, 1},      {"watch", 15, 1},      {"signal_extrema", 2 * VSC_SIGNALS, 1}};
  const char *const runs[2] = {run, other};
  for (size_t p = 0; p < sizeof parts / sizeof parts[0]; p++) {
    static double values[2][175 * 4 + 2 * VSC_SIGNALS];
    for (int r = 0; r < 2; r++) {
      char name[64];
      vsc_error error;
      snprintf(name, sizeof name, "%s/checkpoint.h5", runs[r]);
      const vsc_block block = {parts[p].name, "", parts[p].rows, parts[p].columns, values[r]};
      const uint64_t hash = strtoull(summary(runs[r], "model_hash"), NULL, 16);
      if (vsc_checkpoint_read(in_folder(name), hash, 1, &block, &error) != VSC_OK)
        fail_msg("%s", error.text);
    }
    if (memcmp(values[0], values[1], sizeof values[0]) != 0)
      fail_msg("%s of %s and %s differ", parts[p].name, run, other);
  }
}

static void assert_same_frames(const char *run, const char *other)
{
  char command[256];
  snprintf(command, sizeof command, "diff -r %s/frames %s/frames", run, other);
  must(command);
}

// Two runs that have come to the same end.
static void assert_same_runs(const char *run, const char *other)
{
  char name[64], second[64];
  assert_string_equal(summary(run, "state_hash"), summary(other, "state_hash"));
  assert_string_equal(summary(run, "rows"), summary(other, "rows"));
  assert_same_checkpoints(run, other);
  snprintf(name, sizeof name, "%s/signals.csv", run);
  snprintf(second, sizeof second, "%s/signals.csv", other);
  assert_same_files(name, second);
  snprintf(name, sizeof name, "%s/block.pvd", run);
  snprintf(second, sizeof second, "%s/block.pvd", other);
  assert_same_files(name, second);
  assert_same_frames(run, other);
}

// The runs that the others are compared with: one thread, in one go.
static int open_with_runs(void **state)
{
  return block_open(state) != 0 || shell("$V run block.yaml -q -t 1 -o whole") != 0 ||
         shell("$V run block.yaml -q -t 1 -o marked --set 'output.checkpoint=5 ms'") != 0;
}

static void test_threads(void **state)
{
  (void)state;
  must("$V run block.yaml -o two -t 2");
  assert_same_runs("two", "whole");
  must("$V run block.yaml -o five -t 5");
  assert_same_runs("five", "whole");
}

static void test_cut_in_two(void **state)
{
  (void)state;
  must("$V run block.yaml -o cut -t 2 --stop '8 ms'");
  assert_string_equal(summary("cut", "outcome"), "stopped");
  assert_string_equal(summary("cut", "time_s"), "0.008");
  assert_string_equal(summary("cut", "rows"), "9");
  must("$V run block.yaml -o cut -t 1 --resume");
  assert_string_equal(summary("cut", "outcome"), "finished");
  assert_same_runs("cut", "whole");
}

// A run of `command` in one go, and another one with other numbers of threads, cut at a time that is no
// event and gone on.
static void cut_and_compare(const char *command, const char *whole)
{
  static const struct {
    const char *options, *outcome;
  } runs[] = {{"-t 1 -o %s", "finished"},
              {"-t 2 -o %s_cut --stop '7.77 ms'", "stopped"},
              {"-t 3 -o %s_cut --resume", "finished"}};
  char cut[64], options[96], text[640];
  snprintf(cut, sizeof cut, "%s_cut", whole);
  for (size_t k = 0; k < 3; k++) {
    snprintf(options, sizeof options, runs[k].options, whole);
    snprintf(text, sizeof text, "%s %s", command, options);
    must(text);
    assert_string_equal(summary(k == 0 ? whole : cut, "outcome"), runs[k].outcome);
  }
  assert_same_runs(cut, whole);
}

// What relaxes in a Prony series goes on as if nothing had been cut, in explicit steps and in implicit ones.
static void test_prony(void **state)
{
  (void)state;
  static char rows[PROGRAM_TEXT];
  char text[240];
  for (int k = 0; k < 2; k++) {
    snprintf(text, sizeof text,
             "$V run block.yaml -q --set 'materials[0].prony=[{modulus: 0.3, time: 5 ms}, "
             "{modulus: 0.2, time: 0.1 s}]' --set solve=%s", k == 0 ? "explicit" : "implicit");
    cut_and_compare(text, k == 0 ? "relaxing" : "creeping");
  }
  load_text("relaxing/signals.csv", rows, sizeof rows);
  assert_holds(rows, "work_prony [mJ]");
  assert_string_not_equal(summary("relaxing", "model_hash"), summary("whole", "model_hash"));
}

// With coupled masses, dashpots and a support that moves: momenta are kept besides velocities.
static void test_coupled_masses(void **state)
{
  (void)state;
  cut_and_compare("$V run block.yaml -q --set 'time.selective_mass_scaling=1 ms' "
                  "--set 'robin=[{surface: skin, stiffness: 1 kPa/mm, damping: 2 kPa ms/mm}]' "
                  "--set 'supports[0].motion=[1 mm, 0 mm, 0.5 mm]' "
                  "--set 'supports[0].curve={kind: half_sine, duration: 15 ms}'", "coupled");
  assert_true(atof(summary("coupled", "passes_of_coupled_masses")) >= 1);
  assert_true(atof(summary("coupled", "steps")) < 0.5 * atof(summary("whole", "steps")));
}

// With springs and dashpots on a surface and a support that moves, too: as above.
static void test_moved_supports(void **state)
{
  (void)state;
  static const char moved[] =
      "$V run block.yaml -q --set 'robin=[{surface: skin, stiffness: 1 kPa/mm, damping: 2 kPa ms/mm, "
      "direction: normal}]' --set 'supports[0].motion=[1 mm, 0 mm, 0.5 mm]' "
      "--set 'supports[0].curve={kind: half_sine, duration: 15 ms}'";
  cut_and_compare(moved, "moved");
  static char rows[PROGRAM_TEXT];
  load_text("moved/signals.csv", rows, sizeof rows);
  assert_holds(rows, "energy_springs [mJ]");
  assert_holds(rows, "support_left_x [mN],support_left_y [mN],support_left_z [mN],work_supports [mJ]");
  assert_string_not_equal(summary("moved", "model_hash"), summary("whole", "model_hash"));
}

// Implicitly, with a volume that is kept: its pressure goes on too.
static void test_kept_volume(void **state)
{
  (void)state;
  static char rows[PROGRAM_TEXT];
  cut_and_compare("$V run block.yaml -q --set keep_volume=total --set solve=implicit", "incompressible");
  load_text("incompressible/signals.csv", rows, sizeof rows);
  assert_holds(rows, "kept_volume_error [1],pressure_kept [kPa]");
  assert_close(last_signal("incompressible", "kept_volume_error"), 0, 0, 1e-11);
  assert_true(last_signal("incompressible", "pressure_kept") != 0);
  // what a checkpoint does not have is told of the last part alone
  const double solutions = strtod(summary("incompressible", "newton_solutions_this_run"), NULL);
  const double last = strtod(summary("incompressible_cut", "newton_solutions_this_run"), NULL);
  assert_true(last > 0 && last < solutions);
}

// Multipliers of contact and what is reckoned with them, in equilibria and implicit steps: as above.
static void test_contact(void **state)
{
  (void)state;
  static const char *const solves[] = {"equilibrium", "implicit"};
  for (int k = 0; k < 2; k++) {
    static char text[480], rows[PROGRAM_TEXT];
    char file[64];
    snprintf(text, sizeof text,
             "$V run block.yaml -q --set solve=%s --set 'obstacles=[{kind: sphere, point: [14 mm, 5 mm, 13 mm], "
             "radius: 3 mm, motion: [0 mm, 0 mm, -1 mm], curve: {kind: ramp, duration: 15 ms}}]'", solves[k]);
    cut_and_compare(text, solves[k]);
    snprintf(file, sizeof file, "%s/signals.csv", solves[k]);
    load_text(file, rows, sizeof rows);
    assert_holds(rows, "obstacle_0_x [mN],obstacle_0_y [mN],obstacle_0_z [mN],work_obstacles [mJ],lost_contact [mJ]");
  }
}

// A run that has come to its end goes on when the end is put off.
static void test_later_end(void **state)
{
  (void)state;
  must("$V run block.yaml -o longer --set 'time.end=10 ms'");
  assert_string_equal(summary("longer", "outcome"), "finished");
  must("$V run block.yaml -o longer --resume");
  assert_same_runs("longer", "whole");
}

// Cut at times that are no event, several times, once more at the end.
static void test_cut_anywhere(void **state)
{
  (void)state;
  must("$V run block.yaml -o pieces --stop '0.37 ms'");
  must("$V run block.yaml -o pieces --resume --stop '7.77 ms'");
  must("$V run block.yaml -o pieces --resume --stop '7.78 ms'");
  must("$V run block.yaml -o pieces --resume --stop '3 ms'");  // already behind it: nothing to do
  must("$V run block.yaml -o pieces --resume --stop '19.5 ms'");
  must("$V run block.yaml -o pieces --resume");
  must("$V run block.yaml -o pieces --resume");
  assert_same_runs("pieces", "whole");
}

// As after a crash: frames and rows lie behind the last checkpoint.
static void test_older_checkpoint(void **state)
{
  (void)state;
  must(
      "cp -r marked crashed && $V run block.yaml -q -o early --set 'output.checkpoint=5 ms' --stop "
      "'10 ms'");
  must(
      "cp early/checkpoint.h5 crashed/ && $V run block.yaml -o crashed --set 'output.checkpoint=5 "
      "ms' --resume");
  assert_same_runs("crashed", "marked");
}

static size_t series_length(const char *file)
{
  vsc_pvd *series = NULL;
  assert_int_equal(vsc_pvd_open(in_folder(file), HUGE_VAL, &series, NULL), VSC_OK);
  const size_t count = vsc_pvd_count(series);
  for (size_t f = 0; f < count; f++)
    assert_close(vsc_pvd_time(series, f), 0.002 * (double)f, 1e-12, 0);
  vsc_pvd_free(series);
  return count;
}

// The series, the frames and the rows are trimmed even when the resumed run stops before its first
// frame.
static void test_trimmed_at_once(void **state)
{
  (void)state;
  must(
      "cp -r marked short && cp early/checkpoint.h5 short/ && "
      "$V run block.yaml -o short --set 'output.checkpoint=5 ms' --resume --stop '11 ms'");
  assert_int_equal(series_length("short/block.pvd"), 6);
  must("ls short/frames");
  assert_int_equal(line_count(said), 6);
  static char rows[PROGRAM_TEXT];
  load_text("short/signals.csv", rows, sizeof rows);
  assert_int_equal(line_count(rows), 1 + 12);
  must("$V run block.yaml -o short --set 'output.checkpoint=5 ms' --resume");
  assert_same_runs("short", "marked");
}

// Without the files that a resumed run continues, it still goes on.
static void test_lost_files(void **state)
{
  (void)state;
  must("mkdir lost && cp early/checkpoint.h5 lost/");
  must("$V run block.yaml -o lost --set 'output.checkpoint=5 ms' --resume");
  assert_string_equal(summary("lost", "state_hash"), summary("marked", "state_hash"));
  static char rows[PROGRAM_TEXT];
  load_text("lost/signals.csv", rows, sizeof rows);
  assert_int_equal(line_count(rows), 1 + 10);  // header and 11 ms to 20 ms
  assert_holds(rows, "time [s],step [ms]");
}

// Rows that a machine has lost when it stopped are missed, one half written is taken away; frames without their
// series are not overwritten.
static void test_lost_rows(void **state)
{
  (void)state;
  must("cp -r early torn && head -n 8 early/signals.csv > torn/signals.csv");  // to 6 of 10 ms
  assert_int_equal(shell("$V run block.yaml -q -o torn --set 'output.checkpoint=5 ms' --resume"), 2);
  assert_holds(complained, "torn/signals.csv: its rows end at 6 ms, but the checkpoint is of 10 ms");
  must("head -c -40 early/signals.csv > torn/signals.csv");
  assert_int_equal(shell("$V run block.yaml -q -o torn --set 'output.checkpoint=5 ms' --resume"), 0);
  must("awk -F, 'NF != n && NR > 1 {exit 1} {n = NF}' torn/signals.csv");
  must("cp -r early headed && head -n 1 early/signals.csv > headed/signals.csv");
  assert_int_equal(shell("$V run block.yaml -q -o headed --resume"), 2);
  must("cp -r early holed && rm holed/frames/block_00002.vtu");
  assert_int_equal(shell("$V run block.yaml -q -o holed --resume"), 2);
  assert_holds(complained, "block_00002.vtu: is missing or empty");
  must("cp -r early bare && rm bare/block.pvd && ls bare/frames > before");
  assert_int_equal(shell("$V run block.yaml -q -o bare --resume"), 2);
  assert_holds(complained, "bare/block.pvd: is missing");
  must("ls bare/frames | diff before -");
}

// A disk that is full, or a limit of file sizes, which must not end the program: told in one line, nothing half written is left.
static void test_full_disk(void **state)
{
  (void)state;
  must("$V run block.yaml -q -o full");
  for (int blocks = 4; blocks <= 16; blocks += 4) {
    char command[128];
    snprintf(command, sizeof command, "ulimit -f %d && $V run block.yaml -q -o full", blocks);
    assert_int_equal(shell(command), 4);
    assert_holds(complained, "cannot be written: File too large");
    assert_int_equal(shell("ls full/*.tmp full/frames/*.tmp"), 2);
  }
}

// Another modulus, support, load, fibre or step is another model.
static void test_changed_scene_is_refused(void **state)
{
  (void)state;
  static const char *const changes[] = {"--set 'materials[0].axial.f=21 kPa'",
                                        "--set 'materials[0].volume_modulus=501 kPa'",
                                        "--set 'materials[0].active.tension=9 kPa'",
                                        "--set 'supports[0].held=[x, y]'",
                                        "--set 'pressures[0].peak=2 kPa'",
                                        "--set 'robin=[{surface: end, stiffness: 1 kPa/mm}]'",
                                        "--set 'supports[0].motion=[1 mm, 0 mm, 0 mm]'",
                                        "--set 'gravity=[0 m/s2, 0 m/s2, -9.81 m/s2]'",
                                        "--set 'time.safety=0.7'",
                                        "--set volume=element",
                                        "--set fibers.source=diagonal",
                                        "--set 'materials[0].damping.n=6 Pa s'",
                                        "--set 'materials[0].density=1 g/cm3'"};
  must("cp -r early kept");
  for (size_t k = 0; k < sizeof changes / sizeof changes[0]; k++) {
    char command[256];
    snprintf(command, sizeof command, "$V run block.yaml -q -o early --resume %s", changes[k]);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, "checkpoint.h5");
  }
  must("diff -r early kept");  // nothing was touched
}

// What does not change the motion may change: outputs.
static void test_other_outputs_are_no_other_model(void **state)
{
  (void)state;
  must(
      "cp -r early more && $V run block.yaml -o more --resume --set 'output.arrays=[displacement]' "
      "--set 'output.checkpoint=5 ms'");
  assert_string_equal(summary("more", "state_hash"), summary("marked", "state_hash"));
}

// The scene as understood lies in the run's own folder: a run may be resumed by it, in one series.
static void test_resumed_by_its_own_scene(void **state)
{
  (void)state;
  must("$V run block.yaml -o own --stop '8 ms' && $V run own/scene.yaml -q -o own --resume");
  assert_string_equal(summary("own", "state_hash"), summary("whole", "state_hash"));
  assert_same_files("own/signals.csv", "whole/signals.csv");
  assert_same_files("own/block.pvd", "whole/block.pvd");
  assert_same_frames("own", "whole");
  assert_true(access(in_folder("own/scene.pvd"), F_OK) != 0);
  // of two series one must be meant
  must("cp -r own doubtful && cp own/block.pvd doubtful/other.pvd && cp -r doubtful undoubted");
  assert_int_equal(shell("$V run doubtful/scene.yaml -q -o doubtful --resume"), 2);
  assert_holds(complained, "doubtful: has series of several names (.pvd), and none is called scene");
  must("diff -r doubtful undoubted && $V run block.yaml -q -o doubtful --resume");
}

// A run whose files would lie over those that it is made of is refused before anything is touched.
static void test_inputs_are_spared(void **state)
{
  (void)state;
  must("mkdir mine && cp block.yaml mine/scene.yaml && cp block.yaml mine/other.yaml && cp block.vtu mine/");
  assert_int_equal(shell("$V run mine/other.yaml -q -o mine"), 2);
  assert_holds(complained, "mine/scene.yaml: is a scene that no run has left");
  must("cmp block.yaml mine/scene.yaml");
  static const struct {
    const char *make, *run, *file;
  } cases[] = {
      {"cp block.yaml mine/scene.yaml", "mine/scene.yaml", "mine/scene.yaml: "},
      {"cp block.yaml mine/summary.json", "mine/summary.json --resume", "mine/summary.json: "},
      {"cp block.vtu mine/reference.vtu", "block.yaml --set mesh.file=mine/reference.vtu", "mine/reference.vtu: "},
      {"cp block.vtu mine/a.vtu && ln mine/a.vtu mine/convergence.csv", "block.yaml --set mesh.file=mine/a.vtu",
       "mine/a.vtu: "},
      {"mkdir mine/frames && cp block.vtu mine/frames/", "block.yaml --set mesh.file=mine/frames/block.vtu",
       "mine/frames/block.vtu: "},
      {"printf '0,0\\n20,1\\n' >mine/signals.csv",
       "block.yaml --set 'pressures[0].curve={kind: table, file: mine/signals.csv, time_unit: ms}'", "mine/signals.csv: "},
  };
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    char command[400];
    snprintf(command, sizeof command, "rm -rf mine before && mkdir mine && cp block.vtu mine/ && %s && cp -r mine before",
             cases[k].make);
    must(command);
    snprintf(command, sizeof command, "$V run -q -o mine %s", cases[k].run);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, cases[k].file);
    assert_holds(complained, "choose another folder than mine with -o");
    must("diff -r mine before");
  }
}

// Rows of other columns do not go on in the same table.
static void test_other_columns_are_refused(void **state)
{
  (void)state;
  must("rm -rf kept && cp -r early kept");
  assert_int_equal(shell("$V run block.yaml -q -o early --resume --set 'output.cavities=[]'"), 2);
  assert_holds(complained, "early/signals.csv: its columns are not those of this scene: it has cavity_skin [ml] besides; resume");
  assert_int_equal(shell("$V run block.yaml -q -o early --resume --set 'output.cavities=[end]' "
                         "--set 'output.points=[{name: tip, at: [20 mm, 5 mm, 5 mm]}]'"), 2);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, ": it lacks cavity_end [ml], it has cavity_skin [ml] besides; resume with the outputs");
  must("sed -i '1s/step .ms.,cavity_skin .ml./cavity_skin [ml],step [ms]/' early/signals.csv && cp early/signals.csv kept/");
  assert_int_equal(shell("$V run block.yaml -q -o early --resume"), 2);
  assert_holds(complained, ": another order; resume");
  must("diff -r early kept");  // nothing was touched
}

static void test_no_checkpoint(void **state)
{
  (void)state;
  assert_int_equal(shell("$V run block.yaml -o nothing --resume"), 2);
  assert_holds(complained, "checkpoint.h5: is not there");
  assert_int_equal(line_count(complained), 1);
  assert_int_equal(shell("ls nothing"), 2);  // and no folder is made
  must("cp -r early damaged && truncate -s 3000 damaged/checkpoint.h5");
  assert_int_equal(shell("$V run block.yaml -q -o damaged --resume"), 2);
  assert_int_equal(line_count(complained), 1);
}

// A new run where an older one was leaves nothing of that.
static void test_new_run_in_an_old_folder(void **state)
{
  (void)state;
  must("cp -r whole reused && $V run block.yaml -o reused --stop '3 ms'");
  assert_int_equal(series_length("reused/block.pvd"), 2);
  must("ls reused/frames");
  assert_int_equal(line_count(said), 2);
  // killed before its first checkpoint: the older one's must not be found
  must(
      "cp -r whole killed && (timeout -s KILL 2 $V run block.yaml -q -o killed --set "
      "'output={frames: 0.001 ms, "
      "signals: 1 ms}' || true)");
  assert_int_equal(shell("$V run block.yaml -q -o killed --resume"), 2);
}

// A pressure that crushes the block.
static void test_failing_run(void **state)
{
  (void)state;
  static const char failing[] = "$V run block.yaml -q -o failed --set 'pressures[0].peak=100 kPa'";
  assert_int_equal(shell(failing), 3);
  assert_int_equal(line_count(complained), 1);
  assert_holds(complained, " ms ");
  assert_string_equal(summary("failed", "outcome"), "failed");
  assert_true(strlen(summary("failed", "reason")) > 20);
  assert_holds(complained, summary("failed", "reason"));
  const double time = strtod(summary("failed", "time_s"), NULL);
  assert_true(time > 0 && time < 0.02);
  // its last frame is the last good state, at the time of the summary, with sound numbers
  vsc_pvd *series = NULL;
  assert_int_equal(vsc_pvd_open(in_folder("failed/block.pvd"), HUGE_VAL, &series, NULL), VSC_OK);
  const size_t last = vsc_pvd_count(series) - 1;
  assert_close(vsc_pvd_time(series, last), time, 1e-9, 0);
  char name[128];
  vsc_mesh *frame = NULL;
  snprintf(name, sizeof name, "failed/%s", vsc_pvd_frame(series, last));
  assert_int_equal(vsc_vtk_read_mesh(in_folder(name), 1, &frame, NULL), VSC_OK);
  const vsc_array *moved = vsc_arrays_find(&frame->node_data, "displacement");
  for (size_t k = 0; k < 3 * frame->node_count; k++) assert_true(fabs(moved->values[k]) < 1e3);
  vsc_mesh_free(frame);
  vsc_pvd_free(series);
  // its checkpoint is whole: going on fails in the same way, not earlier
  must("cp failed/signals.csv failed.csv");
  snprintf(name, sizeof name, "%s --resume", failing);
  assert_int_equal(shell(name), 3);
  assert_holds(summary("failed", "reason"), ": the simulation is coming apart; take a smaller time.safety");
  assert_true(strtod(summary("failed", "time_s"), NULL) >= time);
  assert_same_files("failed/signals.csv", "failed.csv");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_threads),
      cmocka_unit_test(test_cut_in_two),
      cmocka_unit_test(test_moved_supports),
      cmocka_unit_test(test_contact),
      cmocka_unit_test(test_prony),
      cmocka_unit_test(test_coupled_masses),
      cmocka_unit_test(test_kept_volume),
      cmocka_unit_test(test_later_end),
      cmocka_unit_test(test_cut_anywhere),
      cmocka_unit_test(test_older_checkpoint),
      cmocka_unit_test(test_trimmed_at_once),
      cmocka_unit_test(test_lost_files),
      cmocka_unit_test(test_lost_rows),
      cmocka_unit_test(test_full_disk),
      cmocka_unit_test(test_changed_scene_is_refused),
      cmocka_unit_test(test_other_outputs_are_no_other_model),
      cmocka_unit_test(test_resumed_by_its_own_scene),
      cmocka_unit_test(test_inputs_are_spared),
      cmocka_unit_test(test_no_checkpoint),
      cmocka_unit_test(test_other_columns_are_refused),
      cmocka_unit_test(test_new_run_in_an_old_folder),
      cmocka_unit_test(test_failing_run),
  };
  return cmocka_run_group_tests(tests, open_with_runs, program_close);
}
