// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a beat repeats the one before.
#ifndef VSC_RUN_CYCLE_H
#define VSC_RUN_CYCLE_H

#include "mech/state.h"

// The end of the last cycle, and how far the body has gone from there since.
typedef struct vsc_cycle {
  double *kept;       // node_count x 8: positions (mm), velocities (mm/ms) at the end of the last cycle; NULL: no
                      // cycle is watched. Owned
  double stroke;      // largest RMS distance from there since, mm
  double speed;       // largest RMS velocity since, mm/ms
  double ended;       // cycles so far
  double difference;  // of the last from the one before: vsc_cycle_end; 1 before there were two, and
                      // of a cycle in which nothing has moved, which repeats nothing
} vsc_cycle;

// Begins at the state. VSC_SYSTEM when memory is short.
vsc_status vsc_cycle_begin(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle, vsc_error *error);

// Takes the state, within a cycle, into stroke and speed.
void vsc_cycle_look(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle);

// Ends a cycle at the state and begins the next: sets `difference` to the larger of
//   RMS(x - x') / stroke and RMS(v - v') / speed,
// x' and v' those at the end of the cycle before; the first ends where it began, if ever, without telling
// anything: that was rest.
void vsc_cycle_end(const vsc_model *model, const vsc_state *state, vsc_cycle *cycle);

#endif
