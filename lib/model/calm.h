// SPDX-License-Identifier: GPL-3.0-or-later
// How long loads stay about what they are: a step must not jump over what they do.
#ifndef VSC_MODEL_CALM_H
#define VSC_MODEL_CALM_H

#include "model/model.h"

// The longest time (ms), `most` at most, from `time` (ms) on in which
//   |c(t) - c(time)| <= 1/6 of the curve's range, and |c(t) - the chord from `time` to the end| <= 1 % of it
// for the curve c of every active material (at the delays of its elements: 64 between the least and the largest),
// pressure, moving support and obstacle, and not longer than a 16th of any of their periods. Forces are looked at once
// within a step: only what keeps to its chord cannot come and go behind that. Where a curve changes by more within two
// places of its table, these two places: a jump is passed.
// Obstacles keep within a hundredth of an element's size of their chord too, and a sphere moves by half its radius at
// most, so that it does not cross a thin body; but one that nowhere in the time is farther from where it is now than the
// nearest of its nodes at x (node_count x 4, mm) may do what it likes.
double vsc_model_calm(const vsc_model *model, const double *x, double time, double most);

// The least and the largest of what the cell array adds to the delay of material m in its elements, ms: 0 without an
// array, infinity and its opposite without elements.
void vsc_model_delays(const vsc_model *model, size_t m, double delays[2]);

#endif
