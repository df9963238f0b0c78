// SPDX-License-Identifier: GPL-3.0-or-later
// The springs law: axial springs along the three axes of a frame and angular springs between them
// (Bourguignon & Cani 2000), in energy form. With n_a = |g_a|, u_a = g_a/n_a, c_ab = u_a . u_b:
//
//   psi = sum_a E_a (n_a - r_a)^2 / 2 + sum_{a<b} G_ab c_ab^2 / 2            (kPa = uJ/mm^3)
//   P_a = E_a (n_a - r_a) u_a + sum_b G_ab c_ab (u_b - c_ab u_a) / n_a
//
// r_a = 1 but for an active fibre, whose r_f and E_f vary in time. Axial damping adds
// eta_a (dg_a/dt . u_a) u_a. At rest the law is orthotropic elasticity without Poisson coupling:
// C_aa = E_a, shear moduli G_ab; E_a = 2 mu, G_ab = mu is isotropic.
//
// A law is three functions on four frames at once: energy, stress P(g) and, for solvers that need
// it, the tangent dP_a/dg_b. Only the first two are needed by explicit stepping.
#ifndef VSC_MODEL_LAW_SPRINGS_H
#define VSC_MODEL_LAW_SPRINGS_H

#include <stdbool.h>

#include "base/wide.h"

// Of an axis with less than this of its length at rest, direction and 1/length are g and 1 over this: they stay
// continuous down to a point, where the axis has no direction. Angular springs, whose stiffness goes with 1/length^2,
// would else hold a crushed body in the place by the shortness of its stable steps.
#define VSC_SHORTEST_AXIS 1e-2

// Lengths of three axes.
typedef struct vsc_axis_lengths {
  vsc_wide length[3];   // n_a
  vsc_wide inverse[3];  // 1/n_a (1/VSC_SHORTEST_AXIS for a shorter one)
} vsc_axis_lengths;

// Directions and lengths of three axes.
typedef struct vsc_frame_axes {
  vsc_wide3 u[3];       // unit vectors (shorter for an axis shorter than VSC_SHORTEST_AXIS)
  vsc_wide length[3];   // n_a
  vsc_wide inverse[3];  // 1/n_a (1/VSC_SHORTEST_AXIS likewise)
} vsc_frame_axes;

// n, but VSC_SHORTEST_AXIS of a shorter axis.
VSC_INLINE vsc_wide vsc_no_shorter(vsc_wide length)
{
  const vsc_wide shortest = vsc_splat(VSC_SHORTEST_AXIS);
  return vsc_select(length > shortest, length, shortest);
}

VSC_INLINE vsc_axis_lengths vsc_lengths_of(const vsc_wide3 g[3])
{
  vsc_axis_lengths lengths;
  vsc_wide safe[3];
  for (int a = 0; a < 3; a++) {
    lengths.length[a] = vsc_wide_sqrt(vsc_wide_dot(g[a], g[a]));
    safe[a] = vsc_no_shorter(lengths.length[a]);
  }
  // one division for the three inverses
  const vsc_wide product = 1.0 / (safe[0] * safe[1] * safe[2]);
  for (int a = 0; a < 3; a++) lengths.inverse[a] = product * safe[(a + 1) % 3] * safe[(a + 2) % 3];
  return lengths;
}

VSC_INLINE vsc_frame_axes vsc_frame_of_lengths(const vsc_wide3 g[3], const vsc_axis_lengths *lengths)
{
  vsc_frame_axes frame;
  for (int a = 0; a < 3; a++) {
    frame.length[a] = lengths->length[a];
    frame.inverse[a] = lengths->inverse[a];
    frame.u[a] = vsc_wide_scale(frame.inverse[a], g[a]);
  }
  return frame;
}

VSC_INLINE vsc_frame_axes vsc_frame_of(const vsc_wide3 g[3])
{
  const vsc_axis_lengths lengths = vsc_lengths_of(g);
  return vsc_frame_of_lengths(g, &lengths);
}

// Moduli of four frames: E_f, E_s, E_n; G_fs, G_sn, G_nf (kPa); r_f (1).
typedef struct vsc_springs {
  vsc_wide axial[3];
  vsc_wide angular[3];
  vsc_wide rest_stretch;
} vsc_springs;

// r_f of fibre springs that contract by `contraction`, side by side with inclusions' that do not: E is the modulus of
// both, `others` the inclusions' part of it; E (n - r_f) = (E - others) (n - 1 + contraction) + others (n - 1).
VSC_INLINE vsc_wide vsc_shared_rest(vsc_wide contraction, vsc_wide E, vsc_wide others)
{
  return 1 - contraction * ((E - others) / vsc_select(E > 0.0, E, vsc_splat(1)));
}

// psi of the three axial springs; angular springs apart, so that a ledger can tell them.
VSC_INLINE vsc_wide vsc_springs_axial_energy(const vsc_springs *law, const vsc_frame_axes *frame)
{
  vsc_wide energy = vsc_splat(0);
  for (int a = 0; a < 3; a++) {
    const vsc_wide strain = frame->length[a] - (a == 0 ? law->rest_stretch : vsc_splat(1));
    energy += 0.5 * law->axial[a] * strain * strain;
  }
  return energy;
}

VSC_INLINE vsc_wide vsc_springs_angular_energy(const vsc_springs *law, const vsc_frame_axes *frame)
{
  vsc_wide energy = vsc_splat(0);
  for (int a = 0; a < 3; a++) {
    const vsc_wide c = vsc_wide_dot(frame->u[a], frame->u[(a + 1) % 3]);
    energy += 0.5 * law->angular[a] * c * c;
  }
  return energy;
}

// P_a. `along[a]` is added to the axial force along u_a: damping, and whatever else pulls along an
// axis. `angular`: whether any G is above 0.
VSC_INLINE void vsc_springs_stress(const vsc_springs *law, const vsc_frame_axes *frame,
                                   const vsc_wide along[3], bool angular, vsc_wide3 P[3])
{
  vsc_wide axial[3];
  for (int a = 0; a < 3; a++)
    axial[a] = law->axial[a] * (frame->length[a] - (a == 0 ? law->rest_stretch : vsc_splat(1))) + along[a];
  if (!angular) {
    for (int a = 0; a < 3; a++) P[a] = vsc_wide_scale(axial[a], frame->u[a]);
    return;
  }
  // pair a is (a, a+1): w = G c
  vsc_wide c[3], w[3];
  for (int a = 0; a < 3; a++) {
    c[a] = vsc_wide_dot(frame->u[a], frame->u[(a + 1) % 3]);
    w[a] = law->angular[a] * c[a];
  }
  for (int a = 0; a < 3; a++) {
    const int next = (a + 1) % 3, last = (a + 2) % 3;
    const vsc_wide own = axial[a] - (w[a] * c[a] + w[last] * c[last]) * frame->inverse[a];
    P[a] = vsc_wide_combine(own, frame->u[a], w[a] * frame->inverse[a], frame->u[next],
                            w[last] * frame->inverse[a], frame->u[last]);
  }
}

#endif
