// SPDX-License-Identifier: GPL-3.0-or-later
// What a run has left in its folder, read again.
#ifndef VSC_TOOLS_BENCH_OUTCOME_H
#define VSC_TOOLS_BENCH_OUTCOME_H

#include "mesh/mesh.h"
#include "tools/bench/problem.h"
#include "tools/plot/signals.h"

struct vsc_outcome {
  const vsc_bench_case *of;
  const char *folder;     // of the results
  const char *reference;  // folder of reference curves; NULL: there is none
  vsc_mesh *mesh;         // of the last frame, at rest; owned
  const double *moved;    // node_count x 3: its displacement, mm
  vsc_signals *signals;   // owned
  // of summary.json; 0 where it says nothing
  double nodes, elements;
  double unknowns;        // coordinates that are not held
  double iterations;      // of Newton's method, over the whole run
  double steps;
};

// Reads signals.csv, summary.json and the last frame of `folder`. VSC_INPUT when one is missing. On
// success the caller frees with vsc_outcome_close.
vsc_status vsc_outcome_open(const char *folder, vsc_outcome *outcome, vsc_error *error);

void vsc_outcome_close(vsc_outcome *outcome);

#endif
