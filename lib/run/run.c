// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/run.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "io/checkpoint.h"
#include "run/events.h"
#include "run/job.h"
#include "run/prestress.h"
#include "solve/solve.h"

#define CLOSER 16         // looks in place of one that did not balance
#define TURNS 4           // how often a way is gone again
#define CALM 16           // good looks after which shorter steps become longer again
#define LEAST_CAUTION 0x1p-6
#define MOST_VAIN 8       // stretches in a row that are gone again although elements turn inside out in shorter steps, too

void vsc_run_name(const char *file, char *name, size_t size)
{
  const char *slash = strrchr(file, '/');
  snprintf(name, size, "%s", slash ? slash + 1 : file);
  char *dot = strrchr(name, '.');
  if (dot != NULL && dot != name) *dot = '\0';
}

static vsc_status make_directory(const char *path, vsc_error *error)
{
  if (mkdir(path, 0777) == 0 || errno == EEXIST) return VSC_OK;
  return vsc_fail(error, VSC_SYSTEM, "%s: the folder cannot be made: %s; choose another with -o",
                  path, strerror(errno));
}

static vsc_status make_directories(const vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH];
  if (strlen(job->options->directory) > VSC_LONGEST_DIRECTORY)
    return vsc_fail(error, VSC_INPUT,
                    "%.60s...: a folder name of more than %d bytes; choose a shorter one with -o",
                    job->options->directory, VSC_LONGEST_DIRECTORY);
  const vsc_status status = make_directory(job->options->directory, error);
  vsc_job_path(job, "frames", path);
  return status == VSC_OK ? make_directory(path, error) : status;
}

// Removes a file of an older run, so that nothing lies there that does not belong to this one.
static void remove_file(const vsc_job *job, const char *what)
{
  char path[VSC_PATH];
  vsc_job_path(job, what, path);
  unlink(path);
}

static void remove_frames(const vsc_job *job, const vsc_pvd *old, size_t first)
{
  for (size_t k = first; k < vsc_pvd_count(old); k++) {
    const char *frame = vsc_pvd_frame(old, k);
    if (strncmp(frame, "frames/", 7) == 0 && strstr(frame, "..") == NULL) remove_file(job, frame);
  }
}

// The frames of a run that is resumed must be in its series, or they would be overwritten.
static vsc_status check_series(const vsc_job *job, const char *series, vsc_error *error)
{
  char first[VSC_PATH], name[VSC_NAME + 32];
  snprintf(name, sizeof name, VSC_FRAME_NAME, job->name, (size_t)0);
  vsc_job_path(job, name, first);
  if (!job->options->resume || access(series, F_OK) == 0 || access(first, F_OK) != 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: is missing, and %s would be overwritten: put it back, or move the frames to another folder",
                  series, first);
}

// What the series keeps of an earlier run is still there.
static vsc_status check_frames(const vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH];
  for (size_t k = 0; k < vsc_pvd_count(job->pvd); k++) {
    vsc_job_path(job, vsc_pvd_frame(job->pvd, k), path);
    struct stat facts;
    if (stat(path, &facts) != 0 || facts.st_size == 0)
      return vsc_fail(error, VSC_INPUT, "%s: is missing or empty, and the series has it: put it back, or begin anew without "
                      "--resume", path);
  }
  return VSC_OK;
}

// The series with the frames up to the checkpoint's time, or none. Nothing is written yet.
static vsc_status read_series(vsc_job *job, vsc_error *error)
{
  char series[VSC_PATH];
  vsc_job_path(job, ".pvd", series);
  // a frame at the checkpoint's own time stays
  const double keep = job->options->resume ? 1e-3 * job->state->time + 1e-6 : -1;
  vsc_status status = check_series(job, series, error);
  if (status == VSC_OK) status = vsc_pvd_open(series, keep, &job->pvd, error);
  return status == VSC_OK ? check_frames(job, error) : status;
}

// Writes the series; the files of other frames are removed.
static vsc_status open_series(vsc_job *job, vsc_error *error)
{
  char series[VSC_PATH];
  vsc_pvd *old = NULL;
  vsc_job_path(job, ".pvd", series);
  if (vsc_pvd_open(series, HUGE_VAL, &old, NULL) != VSC_OK) old = NULL;
  const vsc_status status = vsc_pvd_write(job->pvd, error);
  if (status == VSC_OK && old != NULL) remove_frames(job, old, vsc_pvd_count(job->pvd));
  vsc_pvd_free(old);
  if (status != VSC_OK) return status;
  job->frames = vsc_pvd_count(job->pvd);
  if (job->frames > 0) job->last_frame = 1e3 * vsc_pvd_time(job->pvd, job->frames - 1);
  return vsc_frame_writer_create(job->pvd, vsc_parallel_threads() > 1, &job->writer, error);
}

static vsc_status open_files(vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_status status = make_directories(job, error);
  if (status == VSC_OK && !job->options->resume) {
    remove_file(job, "checkpoint.h5");
    remove_file(job, "summary.json");
    remove_file(job, "convergence.csv");
  }
  if (status == VSC_OK && !job->problem->scene->prestress.loaded) {
    remove_file(job, "prestress.csv");
    remove_file(job, "reference.vtu");
  }
  vsc_job_path(job, "scene.yaml", path);
  if (status == VSC_OK) status = vsc_scene_write(job->problem->scene, path, error);
  return status == VSC_OK ? open_series(job, error) : status;
}

static vsc_status open_watch(vsc_job *job, double keep_until, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_job_path(job, "signals.csv", path);
  return vsc_watch_open(job->problem, path, keep_until, &job->watch, error);
}

// The time of the checkpoint must be known before the signals are opened, which trims them: so the
// state is read first with a watch on no file. No file is touched until all have been found sound.
static vsc_status resume(vsc_job *job, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_job_path(job, "signals.csv", path);
  vsc_status status = vsc_watch_open(job->problem, "/dev/null", -1, &job->watch, error);
  if (status == VSC_OK) status = vsc_job_load(job, error);
  if (status == VSC_OK) vsc_watch_resume(job->problem, job->state, job->watch);
  if (status == VSC_OK) status = vsc_watch_continues(job->problem, job->state, job->watch, path, error);
  if (status == VSC_OK) status = read_series(job, error);
  if (status != VSC_OK) return status;
  vsc_watch_free(job->watch);
  job->watch = NULL;
  status = open_watch(job, job->state->time, error);
  if (status == VSC_OK) status = vsc_job_trim_convergence(job, error);
  if (status == VSC_OK) status = open_files(job, error);
  if (status == VSC_OK) status = vsc_job_load(job, error);
  if (status == VSC_OK) vsc_watch_resume(job->problem, job->state, job->watch);
  return status;
}

static vsc_status observe(vsc_job *job, vsc_error *error)
{
  const vsc_status status = vsc_watch_observe(job->problem, job->state, job->watch, error);
  const double inverted = job->watch->totals.inverted;
  if (status == VSC_OK && job->heeds && inverted > job->inverted_before) {
    job->inverts = true;
    return vsc_fail(error, VSC_NUMERICAL, "at %.6g ms %.0f elements are inside out", job->state->time, inverted);
  }
  vsc_job_count_inverted(job);
  job->most_continued = fmax(job->most_continued, job->watch->totals.continued);
  if (status == VSC_OK) vsc_job_keep_good(job);
  return status;
}

static vsc_status write_row(vsc_job *job, vsc_error *error)
{
  const double begin = vsc_wall_seconds();
  const vsc_status status = vsc_watch_row(job->problem, job->state, job->watch, error);
  job->output_seconds += vsc_wall_seconds() - begin;
  if (status == VSC_OK) vsc_job_keep_good(job);  // with the marks that the row has left
  return status;
}

static vsc_status write_frame(vsc_job *job, vsc_error *error)
{
  const double begin = vsc_wall_seconds();
  const vsc_status status = vsc_job_write_frame(job, error);
  job->output_seconds += vsc_wall_seconds() - begin;
  return status;
}

static vsc_status save(vsc_job *job, vsc_error *error)
{
  const double begin = vsc_wall_seconds();
  const vsc_status status = vsc_job_save(job, error);
  job->output_seconds += vsc_wall_seconds() - begin;
  return status;
}

// The shape at rest, with a table of how it was found, or of how it was not; of a resumed run that of the checkpoint.
static vsc_status unload(vsc_job *job, vsc_error *error)
{
  if (job->options->resume) return vsc_in_scene(job->problem->scene->file, vsc_job_load_unloaded(job, error), error);
  vsc_status status = make_directories(job, error);
  if (status != VSC_OK) return status;
  status = vsc_in_scene(job->problem->scene->file, vsc_unload(job->problem, error), error);
  const vsc_status written = vsc_job_write_unloaded(job, status == VSC_OK ? error : NULL);
  return status == VSC_OK ? written : status;
}

static vsc_status start(vsc_job *job, vsc_error *error)
{
  vsc_problem *problem = job->problem;
  vsc_status status = vsc_job_spare_inputs(job, error);
  if (status == VSC_OK && problem->scene->prestress.loaded) status = unload(job, error);
  if (status == VSC_OK) status = vsc_problem_start(problem, &job->state, error);
  if (status == VSC_OK && problem->model->cycle > 0)
    status = vsc_cycle_begin(problem->model, job->state, &job->cycle, error);
  if (status != VSC_OK) return status;
  if (job->options->resume) {
    status = vsc_in_scene(problem->scene->file, vsc_solve_resume(problem->model, job->state, error), error);
    if (status == VSC_OK) status = resume(job, error);
    return status == VSC_OK ? vsc_job_make_good(job, error) : status;
  }
  status = vsc_in_scene(problem->scene->file, vsc_solve_start(problem->model, job->state, error), error);
  if (status == VSC_OK) status = read_series(job, error);
  if (status == VSC_OK) status = open_files(job, error);
  if (status == VSC_OK) status = open_watch(job, -1, error);
  if (status == VSC_OK) status = vsc_job_make_good(job, error);
  if (status == VSC_OK) status = observe(job, error);
  if (status == VSC_OK) status = write_row(job, error);
  if (status == VSC_OK) status = write_frame(job, error);
  return status == VSC_OK ? vsc_checkpoint_ready(error) : status;
}

static vsc_status go_to(vsc_job *job, double time, vsc_error *error)
{
  vsc_status status = vsc_solve_to(job->problem->model, job->state, time, error);
  const vsc_status written =
      vsc_job_write_convergence(job, status == VSC_OK ? error : NULL);
  if (status == VSC_OK) status = written;
  return status == VSC_OK ? observe(job, error) : status;
}

// On to `time` in so many looks of the way that began at `start`.
static vsc_status go_closer(vsc_job *job, double start, double time, int looks, vsc_error *error)
{
  for (int k = 1; k <= looks; k++) {
    const double next = k < looks ? start + (time - start) * k / looks : time;
    if (next <= job->state->time * (1 + VSC_SAME_TIME)) continue;
    const vsc_status status = go_to(job, next, error);
    if (status != VSC_OK) return status;
  }
  return VSC_OK;
}

// Steps that had to be shorter stay so until CALM looks have gone well with them: a motion that makes energy in
// long steps goes on doing so.
static void grow_calm(vsc_job *job)
{
  double *caution = &job->state->limit.caution;
  if (*caution == 1 || ++job->calm < CALM) return;
  *caution = fmin(2 * *caution, 1);
  job->calm = 0;
}

// Where elements turn inside out in steps of full length, shorter ones are tried, unless they have been of no use.
static void heed_inverted(vsc_job *job)
{
  const vsc_model *model = job->problem->model;
  job->inverted_before = job->watch->totals.inverted;
  job->inverts = false;
  job->heeds = model->solve.kind == VSC_SOLVE_EXPLICIT && model->step == 0 && job->state->limit.caution == 1 &&
               job->vain < MOST_VAIN;
}

// Behind a stretch before which shorter steps were tried `vain` times in a row for nothing: when they turn elements inside
// out, too, it is the load that does, and if that was all why they were taken (`only`) they need not stay so.
static void judge_inverted(vsc_job *job, double vain, bool only)
{
  const double inverted = job->watch->totals.inverted;
  const bool no_use = job->inverts && inverted > job->inverted_before;
  job->heeds = false;
  job->vain = inverted == 0 || (job->inverts && !no_use) ? 0 : no_use ? vain + 1 : vain;
  if (no_use && only) job->state->limit.caution = 1;
}

// To the next look. When energy does not balance there, because loads or vibrations have changed much
// since the last look, the same way is gone again with closer looks, then with steps of a half, a quarter,
// an eighth of their length and looks closer still, and so it is when numbers are no longer finite; what
// fails then is coming apart (or loses a number, of which it is told where that begins), but for what supports do that
// start or stop at once. Where elements turn inside out it is gone again once, in steps of half their length.
static vsc_status go_to_look(vsc_job *job, double time, vsc_error *error)
{
  const vsc_model *model = job->problem->model;
  const double start = job->state->time, repeated = job->repeated, usual = job->state->limit.caution, vain = job->vain;
  heed_inverted(job);
  vsc_status status = go_to(job, time, error);
  if (model->solve.kind != VSC_SOLVE_EXPLICIT) return status;
  const int turns = model->step > 0 ? 1 : TURNS;
  const int first = job->inverts ? 1 : 0;
  int turn = first;
  for (; status == VSC_NUMERICAL && turn < turns; turn++) {
    vsc_job_go_back(job);
    vsc_watch_resume(job->problem, job->state, job->watch);
    job->heeds = job->heeds && turn == 0;
    job->state->limit.caution = fmax(ldexp(usual, -turn), LEAST_CAUTION);
    job->repeated = repeated + turn;
    job->calm = 0;
    job->watch->settles = turn == turns - 1;
    status = go_closer(job, start, time, CLOSER << turn, error);
    job->watch->settles = false;
  }
  if (status == VSC_NUMERICAL && vsc_job_has_lost(job)) return vsc_job_find_lost(job, error);
  if (status == VSC_OK) judge_inverted(job, vain, first == 1 && turn == 2);
  if (status == VSC_OK) grow_calm(job);
  return status;
}

// Takes the look into the cycle, and ends that where it ends: then this is the last good state.
static void watch_cycle(vsc_job *job, double before)
{
  const vsc_model *model = job->problem->model;
  if (job->cycle.kept == NULL) return;
  vsc_cycle_look(model, job->state, &job->cycle);
  if (vsc_events_between(before, job->state->time, model->cycle, HUGE_VAL))
    vsc_cycle_end(model, job->state, &job->cycle);
  vsc_job_keep_good(job);
}

// Whether the last cycle has repeated the one before.
static bool repeats(const vsc_job *job)
{
  return job->cycle.kept != NULL && job->cycle.difference <= job->problem->model->cycle_tolerance;
}

static bool is_interrupted(const vsc_job *job)
{
  return vsc_is_set(job->options->interrupted);
}

// Goes on to the first look at or after `stop`: looks, and with them the steps, are where they
// would be without a stop.
static vsc_status advance(vsc_job *job, double stop, vsc_error *error)
{
  const vsc_output_def *output = &job->problem->scene->output;
  const double end = job->problem->model->end_time;
  vsc_state *state = job->state;
  vsc_status status = VSC_OK;
  vsc_error reason;  // of ways that are gone again, too
  // the ledger wants its looks, however rare the rows are
  const double look = vsc_events_look(job->problem->model, state, output->signal_interval);
  while (state->time < stop * (1 - VSC_SAME_TIME) && status == VSC_OK && !repeats(job) && !is_interrupted(job)) {
    const double before = state->time;
    status = go_to_look(job, vsc_events_next(job->problem, look, before), &reason);
    if (status != VSC_OK && is_interrupted(job)) {  // the method has given up on its way
      vsc_job_go_back(job);
      return VSC_OK;
    }
    if (status != VSC_OK && error != NULL) *error = reason;
    if (status == VSC_OK) watch_cycle(job, before);
    const bool last = repeats(job);
    if (status == VSC_OK && (last || vsc_events_between(before, state->time, output->signal_interval, end)))
      status = write_row(job, error);
    if (status == VSC_OK && (last || vsc_events_between(before, state->time, output->frame_interval, end)))
      status = write_frame(job, error);
    if (status == VSC_OK && output->checkpoint_interval > 0 &&
        vsc_events_between(before, state->time, output->checkpoint_interval, end))
      status = save(job, error);
    if (status == VSC_OK && job->options->progress != NULL)
      job->options->progress(job->options->progress_context, state->time, end,
                             vsc_wall_seconds() - job->start_wall);
  }
  return status;
}

static void fill_result(const vsc_job *job, vsc_run_result *result)
{
  result->steps = job->state->steps - job->start_steps;
  result->simulated = job->state->time - job->start_time;
  result->wall_seconds = vsc_wall_seconds() - job->start_wall;
  result->output_seconds = job->output_seconds;
  result->frame_cpu_seconds = vsc_frame_writer_seconds(job->writer);
  result->cpu_seconds = vsc_cpu_seconds() - job->start_cpu;
  if (result->cpu_seconds > 0)
    result->updates_per_second =
        result->steps * (double)job->problem->model->element_count / result->cpu_seconds;
  result->cycles = job->cycle.ended;
  result->cycle_difference = job->cycle.difference;
  result->repeats = repeats(job);
  result->repeated = job->repeated;
  result->most_inverted = job->most_inverted;
  result->inverted = job->watch->totals.inverted;
  result->wound = (double)job->wound.count;
  result->folded = (double)job->wound.folded;
  result->frames = job->pvd ? vsc_pvd_count(job->pvd) : 0;  // the writer has finished: a checkpoint was saved
  vsc_job_path(job, ".pvd", result->series);
  vsc_job_warn(job, result);
}

// Leaves the last good state and the reason; what fails now on top of that is not told.
static void save_failure(vsc_job *job, vsc_run_result *result, const vsc_error *error)
{
  if (job->writer == NULL || job->good == NULL || job->watch->rows == 0) return;
  const double repeated = job->repeated;
  vsc_job_go_back(job);
  job->repeated = repeated;
  vsc_watch_resume(job->problem, job->state, job->watch);
  if (job->frames == 0 || fabs(job->last_frame - job->state->time) > 1e-6) vsc_job_write_frame(job, NULL);
  vsc_job_save(job, NULL);
  vsc_job_find_wound(job, NULL);
  fill_result(job, result);
  vsc_job_summarize(job, result, error ? error->text : "failed", NULL);
}

static void close_job(vsc_job *job)
{
  vsc_watch_free(job->watch);
  vsc_frame_writer_free(job->writer);
  vsc_pvd_free(job->pvd);
  vsc_state_free(job->state);
  vsc_free(job->good);
  vsc_free(job->cycle.kept);
}

vsc_status vsc_run(vsc_problem *problem, const vsc_run_options *options, vsc_run_result *result,
                   vsc_error *error)
{
  vsc_job job = {.problem = problem, .options = options};
  job.start_wall = vsc_wall_seconds();
  job.start_cpu = vsc_cpu_seconds();
  *result = (vsc_run_result){0};
  vsc_run_name(problem->scene->file, job.name, sizeof job.name);
  vsc_status status = vsc_job_take_name(&job, error);
  if (status == VSC_OK) status = start(&job, error);
  job.begun_seconds = vsc_wall_seconds() - job.start_wall - job.output_seconds;
  if (status == VSC_OK) {
    vsc_solve_heed(problem->model, job.state, options->interrupted);
    job.start_steps = job.state->steps;
    job.start_time = job.state->time;
    const double end = problem->model->end_time;
    const double stop = options->stop_time > 0 ? fmin(options->stop_time, end) : end;
    status = advance(&job, stop, error);
    result->interrupted = is_interrupted(&job) && !repeats(&job) && job.state->time < stop * (1 - VSC_SAME_TIME);
  }
  if (status == VSC_OK) status = save(&job, error);
  if (status == VSC_OK) status = vsc_job_find_wound(&job, error);
  if (status == VSC_OK) {
    fill_result(&job, result);
    status = vsc_job_summarize(&job, result, NULL, error);
  } else if (job.state != NULL) {
    save_failure(&job, result, error);
  }
  close_job(&job);
  return status;
}
