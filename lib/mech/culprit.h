// SPDX-License-Identifier: GPL-3.0-or-later
// What pulls at a node where a simulation fails: for messages.
#ifndef VSC_MECH_CULPRIT_H
#define VSC_MECH_CULPRIT_H

#include "mech/state.h"

typedef struct vsc_culprit {
  const char *term;  // the one whose force on the node is largest, "volume", "active tension" ...; NULL: not known
  double force;      // of it, mN; infinite where that is not a finite number
  uint32_t element;  // of those round the node the one with the largest energy, its number in the file; VSC_NO_ELEMENT: none
} vsc_culprit;

// The culprit at `node` of the body at positions x and velocities w (node_count x 4; w may be NULL: nothing is damped)
// under the loads of `time` (ms): forces are evaluated with one term less at a time, and what that takes away is the
// term's. Damping is that of elements and of surfaces. The term is not known where memory is short, or where positions
// are such that no term by itself is a finite number. Uses the scratch, as vsc_force does.
vsc_culprit vsc_find_culprit(const vsc_model *model, const double *x, const double *w, double time, vsc_scratch *scratch,
                             size_t node);

// Takes another term into account, whose force on the node (mN, three components) the caller knows.
void vsc_culprit_weigh(vsc_culprit *culprit, const char *term, const double force[3]);

enum { VSC_CULPRIT_TEXT = 160 };  // room for its text

// "; it is of element 7, and the largest force on it, 3.1 mN, is that of volume": for messages, behind what names a node;
// what is not known is left out. `when`, "" or " a step before", goes behind the force. Writes at most `size` bytes with
// the terminating zero and returns `text`.
const char *vsc_name_culprit(const vsc_culprit *culprit, const char *when, char *text, size_t size);

#endif
