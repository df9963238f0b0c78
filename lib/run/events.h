// SPDX-License-Identifier: GPL-3.0-or-later
// When a run stops between steps: looks of the energy ledger, rows, frames, checkpoints, ends of cycles. Internal to the
// run room. Times and intervals are in ms.
#ifndef VSC_RUN_EVENTS_H
#define VSC_RUN_EVENTS_H

#include <stdbool.h>

#include "run/problem.h"

#define VSC_SAME_TIME 1e-12  // part of a time by which multiples of intervals differ by rounding

// The way between two looks: a whole part of `rows`, that between two rows of signals, not longer than a sixteenth of
// any curve's period and about the usual one; looks cost as much as some steps. Of methods without a ledger, `rows`.
double vsc_events_look(const vsc_model *model, const vsc_state *state, double rows);

// The first event after `time`: a multiple of `look`, of the intervals of the scene's output and of time.cycle, or the
// end.
double vsc_events_next(const vsc_problem *problem, double look, double time);

// Whether a multiple of `interval`, or the end, lies in (before, now]: steps of the user's length go past multiples.
bool vsc_events_between(double before, double now, double interval, double end);

// How many explicit steps of at most `dt` a run takes from `start` to its end, as each ends at an event where time.step is
// not given; where events are very many, extrapolated from the first.
double vsc_events_steps(const vsc_problem *problem, double look, double start, double dt);

// How many frames a run from `start` to its end writes, the first among them.
double vsc_events_frames(const vsc_problem *problem, double start);

#endif
