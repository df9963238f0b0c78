// SPDX-License-Identifier: GPL-3.0-or-later
// The frame stencil: how the three axes of an element follow its nodes.
//
//   g_a = sum_i B_ai x_i,  a = f, s, n          (at rest g_f, g_s, g_n are the unit fibre axes)
//   G = [g_f g_s g_n] = F R,  J = det G         (F: deformation gradient, R: the axes at rest)
//   f_i = -V sum_a P_a B_ai                     (P_a = d psi / d g_a: the law's answer)
//
// For a tet this is the element of Bourguignon & Cani 2000: the two points where an axis through
// the barycentre meets the faces move with the area coordinates of the faces, and the difference of
// their weights over the chord length r_a is B_ai = grad N_i . a (test_model_stencil.c builds
// both).
#ifndef VSC_MODEL_STENCIL_H
#define VSC_MODEL_STENCIL_H

#include <stdint.h>

#include "base/wide.h"

// Four tets that are computed together. Empty places have B = 0, V = 0 and node 0 at each corner,
// so that they contribute nothing: 88 bytes a tet.
typedef struct vsc_pack {
  vsc_wide B[3][3];             // [axis][corner - 1], 1/mm; corner 0 has minus the sum of the three
  vsc_wide V;                   // rest volume, mm^3
  uint16_t node[4][VSC_WIDTH];  // [corner][tet]: node number within the patch
} vsc_pack;

// B_ai = grad N_i . a (1/mm) of the linear tet with corners `x` (mm) and axes `frame` (rows f, s,
// n). Returns the rest volume, mm^3.
double vsc_stencil_tet(const double x[4][3], const double frame[9], double B[3][4]);

#endif
