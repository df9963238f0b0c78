// SPDX-License-Identifier: GPL-3.0-or-later
// Viscoelasticity by a Prony series: the passive stress of the law relaxes, each part g_i of it in its
// own time tau_i,
//
//   S = S_0 + sum_i (h_i - g_i S_0),   dh_i/dt + h_i/tau_i = g_i dS_0/dt
//
// in fibre axes (Simo 1987), so that the constants of the law are the instantaneous ones, and those of
// long times (1 - sum g_i) times as large. S_0 is the second Piola-Kirchhoff stress of the material's
// law without activity, -m/J of laws of the full deformation included; U'(J) and damping do not relax.
// With S_0 linear in time over a step of dt, h_i has the exact value (Taylor, Pister & Goudreau 1970)
//
//   h_i <- e^(-dt/tau_i) h_i + g_i w_i (S_0 - S_0 before),  w_i = (1 - e^(-dt/tau_i)) tau_i/dt,
//
// else one that is off by dt^2; so the stress at a step's end is a function of the strain there,
//
//   S = S_0 + H - L S_0,  H = sum_i [e^(-dt/tau_i) h_i - g_i w_i S_0 before],  L = sum_i g_i (1 - w_i),
//
// which implicit steps balance where forces do: dt is then the way from the step's start to there, and
// once the step is done the branches go over the whole of it (solve/implicit.h). dt = 0 is a jump, of
// which nothing has relaxed yet. Equilibria are what remains for dt = infinity: h_i = 0 and
// S = (1 - sum g_i) S_0, at every time whose load they bear.
// Of an element with inclusions the own material's share relaxes.
#ifndef VSC_MECH_PRONY_H
#define VSC_MECH_PRONY_H

#include "base/wide.h"
#include "mech/state.h"

// Doubles that a state of `model` keeps for its branches (vsc_state.prony): of each frame of four
// elements E, S_0 and all h_i, then of each patch its work. 0: no material has a series.
size_t vsc_prony_size(const vsc_model *model);

// Carries the branches over a step of `dt` (ms; 0 or infinite: as above) that has led to the state's
// positions.
void vsc_prony_step(const vsc_model *model, vsc_state *state, double dt);

// sum_i (h_i - g_i S_0) of frame `frame` (counted through all patches) of `material`, kPa, as the last
// step has left it.
void vsc_prony_stress(const vsc_model *model, const vsc_material *material, const double *prony,
                      size_t frame, vsc_wide S[6]);

// Adds the force of H - L S_0, at the end of a step of `dt` (ms) that leads to positions x (node_count
// x 4), on a patch's nodes to `f` (its nodes x 4), mN. Nothing where the patch's material has no series.
void vsc_prony_force(const vsc_model *model, const vsc_patch *patch, const double *prony, double dt,
                     const double *x, double *f);

// H of all frames of pack k of a patch whose material has a series, kPa, and as its value L: what tangents
// need of such a step (mech/kernel_tangent.h).
double vsc_prony_past(const vsc_model *model, const vsc_patch *patch, size_t k, const double *prony,
                      double dt, vsc_wide (*H)[6]);

// Work on the body against S - S_0 since the start, sum V int (S - S_0) : dE, uJ: round a cycle what
// the branches dissipate. In a body held deformed it is below 0: the law's energy, counted in full
// elsewhere, is more than was put in; so it is in equilibria.
double vsc_prony_work(const vsc_model *model, const vsc_state *state);

#endif
