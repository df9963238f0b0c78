// SPDX-License-Identifier: GPL-3.0-or-later
// What is written down while the simulation runs: the rows of signals.csv and their extrema.
#ifndef VSC_RUN_WATCH_H
#define VSC_RUN_WATCH_H

#include <stdio.h>

#include "mech/observe.h"
#include "mesh/surface.h"
#include "run/problem.h"

// Columns of signals.csv: room for 55 that every scene may have, one for each cavity and pressure,
// three for each obstacle and each support that moves, six for each observed point.
enum {
  VSC_SIGNALS = 55 + VSC_OUTPUT_ARRAYS + VSC_MOST_PRESSURES + 3 * VSC_MOST_OBSTACLES +
                3 * VSC_MOST_MOVED + 6 * VSC_OUTPUT_POINTS,
  VSC_SIGNAL_NAME = 96
};

typedef struct vsc_watch {
  FILE *file;          // signals.csv, open for appending
  char path[VSC_PATH]; // its name
  vsc_ledger *ledger;  // owned
  vsc_totals totals, former;  // of the last look, and of the one before
  size_t cavity_count;
  vsc_cavity *cavities;                        // with the model's node numbers; owned
  uint32_t (*point_nodes)[VSC_MOST_CORNERS];   // of each observed point's element, in the model; owned
  size_t signal_count;                         // columns
  size_t balance_column;                       // of the balance error
  char names[VSC_SIGNALS][VSC_SIGNAL_NAME];    // "name [unit]"
  double values[VSC_SIGNALS];                  // the last row
  double low[VSC_SIGNALS], high[VSC_SIGNALS];  // over all rows
  double rows;
  double balance;       // balance error of the last look, uJ
  double energy_scale;  // largest energy or work seen, uJ
  bool settles;         // looks are as close as they get: jumps of supports are settled (vsc_watch_observe)
} vsc_watch;

// Opens `file`, in which rows up to `keep_until` (ms; below 0: none) stay (vsc_watch_trim). The caller owns *watch.
vsc_status vsc_watch_open(const vsc_problem *problem, const char *file, double keep_until,
                          vsc_watch **watch, vsc_error *error);

// Observes the state and carries the energy ledger on. VSC_NUMERICAL, since the simulation is coming apart although all
// numbers are finite, when since the last look the energy balance has jumped by more than 5 % of the largest energy or
// work seen (at least that of 3 % strain everywhere), when it is off by more than 10 % of that in all, or when an element
// has more than 1000 times its volume at rest (inside out, too). Only explicit steps are held to the balance, and of these
// not law PAPER, which makes energy, and a forced step. With watch->settles: where the speed of a support jumps in
// damped tissue, what was dissipated since the last look is taken from the balance if the ledger's trapezoid is off by
// more than that.
vsc_status vsc_watch_observe(const vsc_problem *problem, vsc_state *state, vsc_watch *watch,
                             vsc_error *error);

// Appends what was observed last as a row.
vsc_status vsc_watch_row(const vsc_problem *problem, vsc_state *state, vsc_watch *watch,
                         vsc_error *error);

// Renews what the next row needs from a state that was read from a checkpoint, without writing.
void vsc_watch_resume(const vsc_problem *problem, vsc_state *state, vsc_watch *watch);

// The most energy that any row has had too much, as the balance says, of the largest energy or work of all; 0 where
// none had. Of all rows, those before a checkpoint too.
double vsc_watch_energy_made(const vsc_watch *watch);

// Takes from the rows of `file`, left by the run that is resumed, those after `keep_until` (ms) and those that were cut
// short; a file that is missing has none.
vsc_status vsc_watch_trim(const char *file, double keep_until, vsc_error *error);

// Whether the rows of `file`, left by the run that is resumed, have the columns that vsc_watch_resume has named; a file
// that is missing or empty has none yet. VSC_INPUT with a column that only one of the two has, and when rows up to the
// state's time are lost: when they end earlier by more than they lie apart and than output.signals, or when they begin
// with the run's first row and are fewer than the checkpoint has counted; the last one may be missing.
vsc_status vsc_watch_continues(const vsc_problem *problem, const vsc_state *state, const vsc_watch *watch, const char *file,
                               vsc_error *error);

void vsc_watch_free(vsc_watch *watch);  // NULL is fine

#endif
