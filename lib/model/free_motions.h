// SPDX-License-Identifier: GPL-3.0-or-later
// Ways in which nothing keeps a body, or a part of it that is joined to no other, from moving as one rigid thing.
#ifndef VSC_MODEL_FREE_MOTIONS_H
#define VSC_MODEL_FREE_MOTIONS_H

#include "model/model.h"

// How many of the six rigid motions u = t + w x (X - c) neither supports nor springs on surfaces resist: the
// dimension of the null space of
//   G_ab = sum over held directions i of nodes n of u_a,i(n) u_b,i(n) + sum over robin of u_a^T S u_b,
// a and b over the six; where elements and membranes leave the mesh in several parts, those of the first part
// that has any. `text` (of `size` bytes, VSC_FREE_TEXT hold it all) tells them: "move along y, z and turn about x"
// where they go along and about global axes, else in how many ways; and of several parts, where that one is.
// Obstacles do not count. 0 when memory is short.
enum { VSC_FREE_TEXT = 240 };
int vsc_free_motions(const vsc_model *model, char *text, size_t size);

// How many of these parts nothing holds at all, so that all six motions are free; *parts is the number of all parts.
// `text` (as above) tells where the first such part is: "48 elements with node 3 at (0, 0, 7) mm". Obstacles do not
// count. 0 parts when memory is short.
size_t vsc_loose_parts(const vsc_model *model, size_t *parts, char *text, size_t size);

#endif
