// SPDX-License-Identifier: GPL-3.0-or-later
// A run under way, and the files it writes. Internal to the run room.
#ifndef VSC_RUN_JOB_H
#define VSC_RUN_JOB_H

#include "io/pvd.h"
#include "mesh/wound.h"
#include "run/cycle.h"
#include "run/frame_writer.h"
#include "run/run.h"
#include "run/watch.h"
#include "solve/solve.h"

// Bytes of the name of a run's folder; a slash and a file's name come behind it.
enum { VSC_LONGEST_DIRECTORY = VSC_PATH - VSC_NAME - 112 };

// A frame's file in that folder: the scene's name, the frame's number (size_t).
#define VSC_FRAME_NAME "frames/%s_%05zu.vtu"

typedef struct vsc_job {
  vsc_problem *problem;
  const vsc_run_options *options;
  char name[VSC_NAME];  // the scene file's name without folder and ending
  vsc_state *state;
  vsc_watch *watch;
  vsc_pvd *pvd;              // the writer's until that has finished
  vsc_frame_writer *writer;
  size_t frames;             // so far, those on their way to the disk too
  double last_frame;         // time of the last one, ms
  vsc_cycle cycle;
  double *good;  // what vsc_job_keep_good has kept; owned
  double start_wall, start_cpu, start_steps, start_time;
  double begun_seconds;   // wall clock until the first step could be done, without output
  double output_seconds;  // wall clock that the run has waited for rows, frames and checkpoints
  double converged_rows;  // of convergence.csv so far
  double most_inverted;  // largest number of elements with J <= 0 at any look
  double inverted_element, inverted_time;  // the first of them, in the mesh, and when, ms; where there was one
  vsc_wound wound;         // edges round which the body lies more than once in the end, corners that are inside out
  double inverted_before;  // as many had J <= 0 when the stretch under way began
  bool heeds;              // more of them end the stretch: it is to be gone again
  bool inverts;            // that has happened in it
  double vain;             // stretches in a row that shorter steps have not saved from it, since there were none
  double repeated;       // how often a stretch was gone again with shorter steps
  double calm;           // stretches since that went well with the shorter ones
  double most_continued;  // largest number of frames beyond a law's largest exponent at any row
} vsc_job;

// DIRECTORY/what, or DIRECTORY/NAME.what when `what` begins with a dot.
void vsc_job_path(const vsc_job *job, const char *what, char path[VSC_PATH]);

// Of a run that is resumed under another name (its own DIRECTORY/scene.yaml, a scene file that was renamed): the name that its
// files have, which is that of the one PVD file in the folder. VSC_INPUT where there are several and none has job->name.
vsc_status vsc_job_take_name(vsc_job *job, vsc_error *error);

// VSC_INPUT when a file that the run would write, replace or remove is one that it is made of: the scene's own, its
// mesh, map, vessels or curves. Of a resumed run the scene may be DIRECTORY/scene.yaml.
vsc_status vsc_job_spare_inputs(const vsc_job *job, vsc_error *error);

// VSC_INPUT when the scene asks for an array that its model does not have.
vsc_status vsc_frames_check(const vsc_problem *problem, vsc_error *error);

// Gives the current state to the writer, as a VTU frame for the PVD.
vsc_status vsc_job_write_frame(vsc_job *job, vsc_error *error);

// Writes what problem->unloaded has to DIRECTORY/prestress.csv and, where the shape at rest was found (problem->model
// is of it), the shape to DIRECTORY/reference.vtu: double precision, with the displacement to the mesh, the axes and
// the regions. A reference.vtu of another run is removed.
vsc_status vsc_job_write_unloaded(vsc_job *job, vsc_error *error);

// Appends what Newton's method did since the last call to DIRECTORY/convergence.csv; nothing where the
// method has no Newton.
vsc_status vsc_job_write_convergence(vsc_job *job, vsc_error *error);

// Takes from the rows of that file, left by the run that is resumed, those after the state's time.
vsc_status vsc_job_trim_convergence(const vsc_job *job, vsc_error *error);

// Writes (behind all frames) or reads DIRECTORY/checkpoint.h5.
vsc_status vsc_job_save(vsc_job *job, vsc_error *error);
vsc_status vsc_job_load(vsc_job *job, vsc_error *error);

// With prestress: takes the shape at rest from DIRECTORY/checkpoint.h5, which must be of this scene and mesh. The model is
// that of the run which has found it, to the bit, whatever the processor.
vsc_status vsc_job_load_unloaded(vsc_job *job, vsc_error *error);

// That of the model; with prestress that of the model on the mesh and of what is asked for: a shape that was found has other
// bits on other processors.
uint64_t vsc_job_hash(const vsc_job *job);

// Memory for the last good state, which is the present one (after vsc_solve_start, with a watch); then: remembers all
// that a checkpoint would hold, or goes back to what was remembered last.
vsc_status vsc_job_make_good(vsc_job *job, vsc_error *error);
void vsc_job_keep_good(vsc_job *job);
void vsc_job_go_back(vsc_job *job);

// Whether numbers of the state are lost: explicit steps leave it as it is when they fail.
bool vsc_job_has_lost(const vsc_job *job);

// Goes on from the last good state, one step at a time of the length that was tried last, to where the first number is
// lost, at most twice as far as to where it was missed: VSC_NUMERICAL, with that node, its element and what pulled most
// there, or with the message that `error` has where that is not met again. The state is to be thrown away.
vsc_status vsc_job_find_lost(vsc_job *job, vsc_error *error);

// Takes the elements that the last look has found inside out into most_inverted, the first of all with place and time.
void vsc_job_count_inverted(vsc_job *job);

// Finds for job->wound round which edges the body lies more than once in the present state, and which elements are inside
// out at a corner. VSC_SYSTEM when memory is short.
vsc_status vsc_job_find_wound(vsc_job *job, vsc_error *error);

// What is suspicious of the run, and what to do, into result->warning: energy that implicit steps have made, frames
// beyond the largest exponent of their law, elements that were inside out (how many, where it began), those that are at
// corners and edges round which the body ends wound (how many, one and its place). Nothing where there is nothing.
void vsc_job_warn(const vsc_job *job, vsc_run_result *result);

// Writes DIRECTORY/summary.json; `failure` is NULL for a run that has reached its end.
vsc_status vsc_job_summarize(const vsc_job *job, const vsc_run_result *result, const char *failure,
                             vsc_error *error);

#endif
