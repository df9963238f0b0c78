// SPDX-License-Identifier: GPL-3.0-or-later
// Viscoelasticity by a Prony series: the passive stress of the law relaxes, each part g_i of it in its
// own time tau_i,
//
//   S = S_0 + sum_i (h_i - g_i S_0),   dh_i/dt + h_i/tau_i = g_i dS_0/dt
//
// in fibre axes (Simo 1987), so that the constants of the law are the instantaneous ones, and those of
// long times (1 - sum g_i) times as large. S_0 is the second Piola-Kirchhoff stress of the material's
// law without activity, -m/J of laws of the full deformation included; U'(J) and damping do not relax.
// With S_0 linear in time over a step, h_i has the exact value (Taylor, Pister & Goudreau 1970)
//
//   h_i <- e^(-dt/tau_i) h_i + g_i (1 - e^(-dt/tau_i)) tau_i/dt (S_0 - S_0 before)
//
// Of an element with inclusions the own material's share relaxes.
#ifndef VSC_MECH_PRONY_H
#define VSC_MECH_PRONY_H

#include "base/wide.h"
#include "mech/state.h"

// Doubles that a state of `model` keeps for its branches (vsc_state.prony): of each frame of four
// elements E, S_0 and all h_i, then of each patch its work. 0: no material has a series.
size_t vsc_prony_size(const vsc_model *model);

// Carries the branches over a step of `dt` (ms, above 0) that has led to the state's positions.
void vsc_prony_step(const vsc_model *model, vsc_state *state, double dt);

// sum_i (h_i - g_i S_0) of frame `frame` (counted through all patches) of `material`, kPa, as the last
// step has left it.
void vsc_prony_stress(const vsc_model *model, const vsc_material *material, const double *prony,
                      size_t frame, vsc_wide S[6]);

// Adds the force of this stress at positions x (node_count x 4) on a patch's nodes to `f` (its nodes
// x 4), mN. Nothing where the patch's material has no series.
void vsc_prony_force(const vsc_model *model, const vsc_patch *patch, const double *prony,
                     const double *x, double *f);

// Work on the body against S - S_0 since the start, sum V int (S - S_0) : dE, uJ: round a cycle what
// the branches dissipate. In a body held deformed it is below 0: the law's energy, counted in full
// elsewhere, is more than was put in.
double vsc_prony_work(const vsc_model *model, const vsc_state *state);

#endif
