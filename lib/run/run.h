// SPDX-License-Identifier: GPL-3.0-or-later
// The loop that the tools share: start or resume, advance from event to event, write signals,
// frames and checkpoints, and leave a summary.
#ifndef VSC_RUN_RUN_H
#define VSC_RUN_RUN_H

#include <signal.h>
#include <stdbool.h>

#include "run/problem.h"

// Called after each look at the energy (stop_time below), often between two rows of signals: simulated time and end (ms),
// wall seconds since the start.
typedef void vsc_progress(void *context, double time, double end, double wall_seconds);

typedef struct vsc_run_options {
  const char *directory;  // results go here; made when missing
  bool resume;            // go on from the directory's checkpoint
  double stop_time;  // ms; > 0: stop at the first look at the energy that is not before it, leaving a checkpoint. Explicit
                     // steps look each millisecond or 32 steps, other methods at each row of signals
  const volatile sig_atomic_t *interrupted;  // not 0: stop, leaving a checkpoint of the last look; may be NULL
  vsc_progress *progress;  // may be NULL
  void *progress_context;
} vsc_run_options;

// The name of a scene's file without folder and ending, of at most size - 1 bytes: that of a run's files.
void vsc_run_name(const char *file, char *name, size_t size);

// What a run has done.
typedef struct vsc_run_result {
  double steps;      // of this call
  double simulated;  // ms, of this call
  double wall_seconds, cpu_seconds;
  double output_seconds;      // of the wall clock: that stepping has waited for output
  double frame_cpu_seconds;   // of the processor time: writing frames
  double updates_per_second;  // element updates per CPU second, everything included
  size_t frames;              // in the series now
  double repeated;            // how often a stretch was gone again with shorter steps, of all calls
  double most_inverted;       // most elements that were inside out at the same time, of all calls
  double inverted;            // that are in the end
  double wound;               // edges round which the body lies more than once in the end (mesh/wound.h)
  double folded;              // hexahedra, wedges and pyramids that are inside out at a corner in the end
  double cycles;              // that were watched so far (time.cycle)
  double cycle_difference;    // of the last from the one before (run/cycle.h)
  bool interrupted;           // the run stopped before stop_time and its end because it was told to
  bool repeats;               // the run stopped because it was below time.cycle_tolerance
  char series[VSC_PATH];      // the PVD file
  char warning[3 * VSC_ERROR_TEXT];  // what is suspicious of it, in one line: energy that implicit steps have made, frames beyond
                                     // a law's largest exponent, elements inside out, edges round which the body lies more
                                     // than once; empty: nothing
} vsc_run_result;

// Part of the largest energy or work that implicit steps may make before that is warned of: half of it, so that energy
// has doubled out of nothing. With rows as close as the shipped scenes and the benchmarks have them it is below 0.005; the
// balance itself is off by up to 0.36 with rows ten times as rare.
#define VSC_MOST_ENERGY_MADE 0.5

// Runs `problem` to its end. The directory then holds NAME.pvd and frames/, signals.csv,
// summary.json, checkpoint.h5 and scene.yaml (the scene as understood), NAME being the scene file's
// name, or, of a run that is resumed with a scene file of another name, that of the series which it goes on with; with
// prestress, whose shape at rest is found first (vsc_unload; a resumed run has it from its checkpoint), also
// prestress.csv, a row for each iteration, and reference.vtu, that shape. A failed run leaves the frames up to then, a frame and a checkpoint of the last good state,
// and the reason in summary.json; the same reason is in `error`. VSC_INPUT, and nothing is touched, when one of these
// files is among those that the run is made of.
vsc_status vsc_run(vsc_problem *problem, const vsc_run_options *options, vsc_run_result *result,
                   vsc_error *error);

#endif
