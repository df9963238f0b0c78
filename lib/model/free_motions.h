// SPDX-License-Identifier: GPL-3.0-or-later
// Ways in which nothing keeps a body from moving as one rigid thing.
#ifndef VSC_MODEL_FREE_MOTIONS_H
#define VSC_MODEL_FREE_MOTIONS_H

#include "model/model.h"

// How many of the six rigid motions u = t + w x (X - c) neither supports nor springs on surfaces resist: the
// dimension of the null space of
//   G_ab = sum over held directions i of nodes n of u_a,i(n) u_b,i(n) + sum over robin of u_a^T S u_b,
// a and b over the six. `text` (of `size` bytes) tells them: "move along y, z and turn about x" where they go
// along and about global axes, else in how many ways. Obstacles and membranes do not count.
int vsc_free_motions(const vsc_model *model, char *text, size_t size);

#endif
