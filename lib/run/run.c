// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/run.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/mem.h"
#include "run/session.h"
#include "solve/explicit.h"

#define LONGEST_LOOK 1.0  // ms between two looks of the energy ledger
#define CLOSER 16         // looks in place of one that did not balance
#define SAME_TIME 1e-12   // part of a time by which multiples of intervals differ by rounding

static void name_of_scene(const char *file, char name[VSC_NAME])
{
  const char *slash = strrchr(file, '/');
  vsc_copy_name(name, slash ? slash + 1 : file);
  char *dot = strrchr(name, '.');
  if (dot != NULL && dot != name) *dot = '\0';
}

static vsc_status make_directory(const char *path, vsc_error *error)
{
  if (mkdir(path, 0777) == 0 || errno == EEXIST) return VSC_OK;
  return vsc_fail(error, VSC_SYSTEM, "%s: the folder cannot be made: %s; choose another with -o",
                  path, strerror(errno));
}

static vsc_status make_directories(const vsc_session *session, vsc_error *error)
{
  char path[VSC_PATH];
  if (strlen(session->options->directory) > VSC_LONGEST_DIRECTORY)
    return vsc_fail(error, VSC_INPUT,
                    "%.60s...: a folder name of more than %d bytes; choose a shorter one with -o",
                    session->options->directory, VSC_LONGEST_DIRECTORY);
  const vsc_status status = make_directory(session->options->directory, error);
  vsc_session_path(session, "frames", path);
  return status == VSC_OK ? make_directory(path, error) : status;
}

// Removes a file of an older run, so that nothing lies there that does not belong to this one.
static void remove_file(const vsc_session *session, const char *what)
{
  char path[VSC_PATH];
  vsc_session_path(session, what, path);
  unlink(path);
}

static void remove_frames(const vsc_session *session, const vsc_pvd *old, size_t first)
{
  for (size_t k = first; k < vsc_pvd_count(old); k++) {
    const char *frame = vsc_pvd_frame(old, k);
    if (strncmp(frame, "frames/", 7) == 0 && strstr(frame, "..") == NULL)
      remove_file(session, frame);
  }
}

// The series with the frames up to the checkpoint's time, or none; the others' files are removed.
static vsc_status open_series(vsc_session *session, vsc_error *error)
{
  char series[VSC_PATH];
  vsc_pvd *old = NULL;
  vsc_session_path(session, ".pvd", series);
  if (vsc_pvd_open(series, HUGE_VAL, &old, NULL) != VSC_OK) old = NULL;
  // a frame at the checkpoint's own time stays
  const double keep = session->options->resume ? 1e-3 * session->state->time + 1e-6 : -1;
  vsc_status status = vsc_pvd_open(series, keep, &session->pvd, error);
  if (status == VSC_OK) status = vsc_pvd_write(session->pvd, error);
  if (status == VSC_OK && old != NULL) remove_frames(session, old, vsc_pvd_count(session->pvd));
  vsc_pvd_free(old);
  return status;
}

static vsc_status open_files(vsc_session *session, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_status status = make_directories(session, error);
  if (status == VSC_OK && !session->options->resume) {
    remove_file(session, "checkpoint.h5");
    remove_file(session, "summary.json");
  }
  vsc_session_path(session, "scene.yaml", path);
  if (status == VSC_OK) status = vsc_scene_write(session->problem->scene, path, error);
  return status == VSC_OK ? open_series(session, error) : status;
}

static vsc_status open_watch(vsc_session *session, double keep_until, vsc_error *error)
{
  char path[VSC_PATH];
  vsc_session_path(session, "signals.csv", path);
  return vsc_watch_open(session->problem, path, keep_until, &session->watch, error);
}

// The time of the checkpoint must be known before the signals are opened, which trims them: so the
// state is read first with a watch on no file.
static vsc_status resume(vsc_session *session, vsc_error *error)
{
  vsc_status status = vsc_watch_open(session->problem, "/dev/null", -1, &session->watch, error);
  if (status == VSC_OK) status = vsc_session_load(session, error);
  if (status == VSC_OK) status = open_files(session, error);
  if (status != VSC_OK) return status;
  vsc_watch_free(session->watch);
  session->watch = NULL;
  status = open_watch(session, session->state->time, error);
  if (status == VSC_OK) status = vsc_session_load(session, error);
  if (status == VSC_OK) vsc_watch_resume(session->problem, session->state, session->watch);
  return status;
}

static vsc_status observe(vsc_session *session, vsc_error *error)
{
  const vsc_status status =
      vsc_watch_observe(session->problem, session->state, session->watch, error);
  session->most_inverted = fmax(session->most_inverted, session->watch->totals.inverted);
  if (status == VSC_OK) vsc_session_keep_good(session);
  return status;
}

static vsc_status write_row(vsc_session *session, vsc_error *error)
{
  return vsc_watch_row(session->problem, session->state, session->watch, error);
}

static vsc_status start(vsc_session *session, vsc_error *error)
{
  vsc_problem *problem = session->problem;
  vsc_status status = vsc_state_create(problem->model, &session->state, error);
  if (status == VSC_OK) status = vsc_session_make_good(session, error);
  if (status != VSC_OK) return status;
  if (session->options->resume) {
    status = resume(session, error);
    if (status == VSC_OK) vsc_session_keep_good(session);
    return status;
  }
  status =
      vsc_in_scene(problem->scene->file, vsc_start(problem->model, session->state, error), error);
  if (status == VSC_OK) status = open_files(session, error);
  if (status == VSC_OK) status = open_watch(session, -1, error);
  if (status == VSC_OK) status = observe(session, error);
  if (status == VSC_OK) status = write_row(session, error);
  if (status == VSC_OK) status = vsc_session_write_frame(session, error);
  return status;
}

// The next multiple of `interval` after `time`, or `end` if that comes first or the interval is 0.
static double next_event(double time, double interval, double end)
{
  if (!(interval > 0)) return end;
  const double next = interval * (floor(time / interval * (1 + SAME_TIME)) + 1);
  return next < end * (1 - SAME_TIME) ? next : end;
}

static bool is_event(double time, double interval, double end)
{
  if (time >= end) return true;
  return interval > 0 && fabs(time - interval * round(time / interval)) <= SAME_TIME * time;
}

static vsc_status go_to(vsc_session *session, double time, vsc_error *error)
{
  const vsc_status status = vsc_advance(session->problem->model, session->state, time, error);
  return status == VSC_OK ? observe(session, error) : status;
}

// To the next look. When energy does not balance there, because loads or vibrations have changed
// much since the last look, the same way is gone again with closer looks; what does not balance
// then is coming apart.
static vsc_status go_to_look(vsc_session *session, double time, vsc_error *error)
{
  const vsc_status status = go_to(session, time, error);
  if (status != VSC_NUMERICAL || session->state->time < time) return status;
  vsc_session_go_back(session);
  vsc_watch_resume(session->problem, session->state, session->watch);
  const double start = session->state->time;
  for (int k = 1; k < CLOSER; k++) {
    const vsc_status again = go_to(session, start + (time - start) * k / CLOSER, error);
    if (again != VSC_OK) return again;
  }
  return go_to(session, time, error);
}

// Goes on to the first look at or after `stop`: looks, and with them the steps, are where they
// would be without a stop.
static vsc_status advance(vsc_session *session, double stop, vsc_error *error)
{
  const vsc_output_def *output = &session->problem->scene->output;
  const double end = session->problem->model->end_time;
  vsc_state *state = session->state;
  vsc_status status = VSC_OK;
  // the ledger wants a look at least every LONGEST_LOOK, however rare the rows are
  const double look = output->signal_interval / ceil(output->signal_interval / LONGEST_LOOK);
  while (state->time < stop * (1 - SAME_TIME) && status == VSC_OK) {
    double next = next_event(state->time, look, end);
    next = fmin(next, next_event(state->time, output->frame_interval, end));
    next = fmin(next, next_event(state->time, output->checkpoint_interval, end));
    status = go_to_look(session, next, error);
    if (status == VSC_OK && is_event(next, output->signal_interval, end))
      status = write_row(session, error);
    if (status == VSC_OK && is_event(next, output->frame_interval, end))
      status = vsc_session_write_frame(session, error);
    if (status == VSC_OK && output->checkpoint_interval > 0 &&
        is_event(next, output->checkpoint_interval, end))
      status = vsc_session_save(session, error);
    if (status == VSC_OK && session->options->progress != NULL)
      session->options->progress(session->options->progress_context, state->time, end,
                                 vsc_wall_seconds() - session->start_wall);
  }
  return status;
}

static void fill_result(const vsc_session *session, vsc_run_result *result)
{
  result->steps = session->state->steps - session->start_steps;
  result->simulated = session->state->time - session->start_time;
  result->wall_seconds = vsc_wall_seconds() - session->start_wall;
  result->cpu_seconds = vsc_cpu_seconds() - session->start_cpu;
  if (result->cpu_seconds > 0)
    result->updates_per_second =
        result->steps * (double)session->problem->model->tet_count / result->cpu_seconds;
  result->frames = session->pvd ? vsc_pvd_count(session->pvd) : 0;
  vsc_session_path(session, ".pvd", result->series);
}

// Leaves the last good state and the reason; what fails now on top of that is not told.
static void save_failure(vsc_session *session, vsc_run_result *result, const vsc_error *error)
{
  if (session->pvd == NULL || session->watch == NULL || session->watch->rows == 0) return;
  vsc_session_go_back(session);
  const size_t frames = vsc_pvd_count(session->pvd);
  if (frames == 0 ||
      fabs(vsc_pvd_time(session->pvd, frames - 1) - 1e-3 * session->state->time) > 1e-9)
    vsc_session_write_frame(session, NULL);
  vsc_session_save(session, NULL);
  fill_result(session, result);
  vsc_session_summarize(session, result, error ? error->text : "failed", NULL);
}

static void close_session(vsc_session *session)
{
  vsc_watch_free(session->watch);
  vsc_pvd_free(session->pvd);
  vsc_state_free(session->state);
  vsc_free(session->good);
}

vsc_status vsc_run(vsc_problem *problem, const vsc_run_options *options, vsc_run_result *result,
                   vsc_error *error)
{
  vsc_session session = {.problem = problem, .options = options};
  session.start_wall = vsc_wall_seconds();
  session.start_cpu = vsc_cpu_seconds();
  *result = (vsc_run_result){0};
  name_of_scene(problem->scene->file, session.name);
  vsc_status status = start(&session, error);
  if (status == VSC_OK) {
    session.start_steps = session.options->resume ? session.state->steps : 0;
    session.start_time = session.options->resume ? session.state->time : 0;
    const double end = problem->model->end_time;
    const double stop = options->stop_time > 0 ? fmin(options->stop_time, end) : end;
    status = advance(&session, stop, error);
  }
  if (status == VSC_OK) status = vsc_session_save(&session, error);
  if (status == VSC_OK) {
    fill_result(&session, result);
    status = vsc_session_summarize(&session, result, NULL, error);
  } else if (session.state != NULL) {
    save_failure(&session, result, error);
  }
  close_session(&session);
  return status;
}
