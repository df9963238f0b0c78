// SPDX-License-Identifier: GPL-3.0-or-later
// What came of a case of `viscera bench stability`.
#ifndef VSC_TOOLS_BENCH_VERDICT_H
#define VSC_TOOLS_BENCH_VERDICT_H

#include "tools/bench/stress.h"

typedef enum vsc_verdict_kind {
  VSC_SURVIVES,  // to the end, with finite numbers and an energy that balances
  VSC_INSIDE_OUT,  // the same, but elements are inside out then, wholly or at a corner, or the body is wound, as the summary tells
  VSC_REFUSED,   // before the first step, with a message that names what is wrong
  VSC_STOPS,     // numerically, with a message that names element or node, place, time and remedy, and the energy where
                 // that did not balance
  VSC_UNENDED,   // still running after --limit seconds
  VSC_WRONG,     // anything else
  VSC_VERDICTS,
} vsc_verdict_kind;

extern const char *const vsc_verdict_names[VSC_VERDICTS];

typedef struct vsc_verdict {
  vsc_verdict_kind kind;
  int code;             // the program's exit code
  double balance;       // largest error of the energy balance over the largest energy or work; NAN where
                        // there is none (equilibria, law paper)
  double J_low, J_high; // extremes of the frames' volume ratios
  double inverted;      // elements inside out at the end
  double folded;        // hexahedra, wedges and pyramids inside out at a corner at the end
  double wound;         // edges round which the body lies more than once at the end
  double repeated;      // stretches gone again with shorter steps; of implicit runs steps rejected and failed
  double steps;
  double cpu_seconds;
  double claimed, limit;  // explicit: the step that is claimed and the true limit at the start, ms; else 0
  double below, above;  // what becomes of small velocities in 10^5 steps of 0.98 of what is claimed, in 2000 of 1.1 of the
                        // true limit, times what they were; 0: not tried
  char why[VSC_ERROR_TEXT];  // the program's message, or what is wrong
} vsc_verdict;

// Judges what a run of the case has left in FOLDER/run, having ended with `status` and the message in `error`.
// The balance of explicit runs may be off by a tenth of the largest energy or work, as their own watch has it.
// Implicit steps may lose energy, as their scheme does, and make a quarter of the largest at most: theirs is
// not watched, and steps as long as accuracy allows do not see each vibration.
void vsc_judge(const vsc_stress_case *at, const char *folder, vsc_status status, const vsc_error *error,
               vsc_verdict *verdict);

#endif
