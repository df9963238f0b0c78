// SPDX-License-Identifier: GPL-3.0-or-later
// The frame stencil: how three axes inside an element follow its nodes.
//
//   h_k = sum_i D_ki x_i,  k = 1, 2, 3          (derivatives of position by the cell's own
//                                               coordinates at a point; D is the same for all cells
//                                               of a kind)
//   g_a = sum_k T_ak h_k,  a = f, s, n          (at rest g_f, g_s, g_n are the unit fibre axes)
//   G = [g_f g_s g_n] = F R,  J = det G         (F: deformation gradient, R: the axes at rest)
//   f_i = -V sum_a P_a B_ai,  B_ai = sum_k T_ak D_ki   (P_a = d psi / d g_a: the law's answer)
//
// A tet has one frame, with h_k = x_k - x_0 and T_ak = B_ak; a hexahedron or a pyramid has eight, a
// wedge six. For a tet this is the element of Bourguignon & Cani 2000: the two points where an axis
// through the barycentre meets the faces move with the area coordinates of the faces, and the
// difference of their weights over the chord length r_a is B_ai = grad N_i . a (test_model_stencil.c
// builds both).
#ifndef VSC_MODEL_STENCIL_H
#define VSC_MODEL_STENCIL_H

#include <stddef.h>
#include <stdint.h>

#include "base/wide.h"
#include "mesh/cell.h"

// One frame of four cells that are computed together. Empty places have T = 0 and V = 0, so that
// they contribute nothing.
typedef struct vsc_frame {
  vsc_four T[3][3];  // [axis][k], 1/mm for a tet
  vsc_four V;        // rest volume that the frame stands for, mm^3
} vsc_frame;

// Four tets: their frame, and node 0 at each corner of an empty place; 88 bytes a tet. The packs of
// other kinds are alike: their frames, then their nodes.
typedef struct vsc_pack {
  vsc_four B[3][3];             // [axis][corner - 1], 1/mm; corner 0 has minus the sum of the three
  vsc_four V;                   // rest volume, mm^3
  uint16_t node[4][VSC_WIDTH];  // [corner][tet]: node number within the patch
} vsc_pack;

// Bytes of a pack of `corners` corners and `frames` frames; a whole number of vectors.
static inline size_t vsc_pack_bytes(int corners, int frames)
{
  const size_t bytes = (size_t)frames * sizeof(vsc_frame) +
                       (size_t)corners * VSC_WIDTH * sizeof(uint16_t);
  return (bytes + sizeof(vsc_four) - 1) / sizeof(vsc_four) * sizeof(vsc_four);
}

// B_ai = grad N_i . a (1/mm) of the linear tet with corners `x` (mm) and axes `frame` (rows f, s,
// n). Returns the rest volume, mm^3.
double vsc_stencil_tet(const double x[4][3], const double frame[9], double B[3][4]);

// T of a frame at rest: `h` (rows h_1, h_2, h_3) at that point, axes `frame` (rows f, s, n):
// sum_k T_ak h_k = a. Returns det [h_1 h_2 h_3], which times the point's weight is V.
double vsc_stencil_frame(const double h[3][3], const double frame[9], double T[3][3]);

#endif
