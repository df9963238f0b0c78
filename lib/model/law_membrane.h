// SPDX-License-Identifier: GPL-3.0-or-later
// The law of a sheet's triangles: axial springs along two axes in the plane, an angular spring
// between them (Bourguignon & Cani 2000, section 6, in energy form) and a spring for the area. With
// n_a = |g_a|, u_a = g_a/n_a, c = u_a . u_b, J = |g_a x g_b|, m = (g_a x g_b)/J:
//
//   psi = E_a (n_a - 1)^2 / 2 + E_b (n_b - 1)^2 / 2 + G c^2 / 2 + K (J - 1)^2 / 2   (kPa)
//   P_a = E_a (n_a - 1) u_a + G c (u_b - c u_a) / n_a + K (J - 1) g_b x m
//   P_b = E_b (n_b - 1) u_b + G c (u_a - c u_b) / n_b + K (J - 1) m x g_a
//
// per volume at rest, thickness times area. Axial damping adds eta_a (dg_a/dt . u_a) u_a. At rest
// C_aa = E_a + K, C_ab = K, shear modulus G: E_a = E_b = 2 G = E/(1 + nu), K = nu E/(1 - nu^2) is
// the isotropic sheet in plane stress. A triangle bends and turns in space freely: only lengths in
// its plane count, so that a mirrored triangle is at rest too.
#ifndef VSC_MODEL_LAW_MEMBRANE_H
#define VSC_MODEL_LAW_MEMBRANE_H

#include "model/law_springs.h"

// Two axes of four triangles.
typedef struct vsc_sheet_axes {
  vsc_wide3 g[2], u[2];            // axes, and their unit vectors (0 without direction)
  vsc_wide length[2], inverse[2];  // n, 1/n (0 without direction)
  vsc_wide3 normal;                // m (0 where the triangle has no area)
  vsc_wide J, c;
} vsc_sheet_axes;

VSC_INLINE vsc_sheet_axes vsc_sheet_axes_of(const vsc_wide3 g[2])
{
  vsc_sheet_axes axes;
  for (int a = 0; a < 2; a++) {
    axes.g[a] = g[a];
    axes.length[a] = vsc_wide_sqrt(vsc_wide_dot(g[a], g[a]));
    axes.inverse[a] = vsc_wide_inverse(axes.length[a], VSC_NO_LENGTH);
    axes.u[a] = vsc_wide_scale(axes.inverse[a], g[a]);
  }
  axes.normal = vsc_wide_cross(g[0], g[1]);
  axes.J = vsc_wide_sqrt(vsc_wide_dot(axes.normal, axes.normal));
  axes.normal = vsc_wide_scale(vsc_wide_inverse(axes.J, VSC_NO_LENGTH), axes.normal);
  axes.c = vsc_wide_dot(axes.u[0], axes.u[1]);
  return axes;
}

// E_a, E_b, G, K (kPa) of a membrane; the same for its four triangles.
typedef struct vsc_sheet_moduli {
  double axial[2], angular, area;
} vsc_sheet_moduli;

VSC_INLINE vsc_wide vsc_sheet_energy(const vsc_sheet_moduli *law, const vsc_sheet_axes *axes)
{
  vsc_wide energy = law->angular * axes->c * axes->c;
  for (int a = 0; a < 2; a++)
    energy += law->axial[a] * (axes->length[a] - 1.0) * (axes->length[a] - 1.0);
  energy += law->area * (axes->J - 1.0) * (axes->J - 1.0);
  return 0.5 * energy;
}

// P_a, P_b. `along[a]` is added to the axial force along u_a: damping.
VSC_INLINE void vsc_sheet_stress(const vsc_sheet_moduli *law, const vsc_sheet_axes *axes,
                                 const vsc_wide along[2], vsc_wide3 P[2])
{
  const vsc_wide turning = law->angular * axes->c, spreading = law->area * (axes->J - 1.0);
  const vsc_wide3 cofactor[2] = {vsc_wide_cross(axes->g[1], axes->normal),
                                 vsc_wide_cross(axes->normal, axes->g[0])};
  for (int a = 0; a < 2; a++) {
    const vsc_wide across = turning * axes->inverse[a];
    const vsc_wide own = law->axial[a] * (axes->length[a] - 1.0) + along[a] - across * axes->c;
    P[a] = vsc_wide_combine(own, axes->u[a], across, axes->u[1 - a], spreading, cofactor[a]);
  }
}

// The same law as a function of strain, e = (e_aa, e_bb, 2 e_ab), g_a . g_b = delta_ab + 2 e_ab, for tangents:
// S = dpsi/de, so that P_a = S_aa g_a + S_ab g_b, and D = dS/de, kPa.
typedef struct vsc_sheet_answer {
  vsc_wide S[3], D[3][3];
} vsc_sheet_answer;

// With A, B = n_a^2, n_b^2 and gamma = g_a . g_b, so that c^2 = gamma^2/(A B) and J^2 = A B - gamma^2:
//   S_aa = E_a (1 - 1/n_a) - G c^2/A + K (1 - 1/J) B,   S_ab = G gamma/(A B) - K (1 - 1/J) gamma.
VSC_INLINE void vsc_sheet_tangent(const vsc_sheet_moduli *law, const vsc_sheet_axes *axes, vsc_sheet_answer *answer)
{
  const vsc_wide square[2] = {axes->length[0] * axes->length[0], axes->length[1] * axes->length[1]};
  const vsc_wide inverse[2] = {axes->inverse[0] * axes->inverse[0], axes->inverse[1] * axes->inverse[1]};
  const vsc_wide gamma = vsc_wide_dot(axes->g[0], axes->g[1]), both = inverse[0] * inverse[1];
  const vsc_wide over = vsc_wide_inverse(axes->J, VSC_NO_LENGTH);
  const vsc_wide G = law->angular * both, spread = law->area * (1.0 - over), K = law->area * over * over * over;
  for (int a = 0; a < 2; a++) {
    const vsc_wide other = square[1 - a], shear = G * gamma * gamma * inverse[a];
    answer->S[a] = law->axial[a] * (1.0 - axes->inverse[a]) - shear + spread * other;
    answer->D[a][a] = law->axial[a] * inverse[a] * axes->inverse[a] + 4.0 * shear * inverse[a] + K * other * other;
    answer->D[a][2] = answer->D[2][a] = -2.0 * G * gamma * inverse[a] - K * other * gamma;
  }
  answer->S[2] = (G - spread) * gamma;
  answer->D[0][1] = answer->D[1][0] = 2.0 * G * gamma * gamma * both + 2.0 * spread + K * square[0] * square[1];
  answer->D[2][2] = G - spread + K * gamma * gamma;
}

#endif
