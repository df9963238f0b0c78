// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of a membrane at rest: their axes, their neighbours, and how they bend.
#ifndef VSC_MODEL_MEMBRANES_H
#define VSC_MODEL_MEMBRANES_H

#include "mesh/mesh.h"
#include "mesh/select.h"
#include "model/definition.h"

// All arrays have one item per triangle; owned.
typedef struct vsc_sheet {
  size_t count;
  uint32_t (*nodes)[6];   // its corners, then the third node of its neighbour across the edge from
                          // corner i to i + 1, or corner i itself where there is none
  double *area;           // mm^2
  double (*T)[2][2];      // g_a = sum_k T_ak h_k, h_k = x_k - x_0; 1/mm
  double (*M)[3][3];      // of the bend (model/law_bending.h), uJ; NULL: bends freely
  double (*fold)[3];      // phi at rest; NULL likewise
} vsc_sheet;

// Makes the sheet of `surface` (triangles of `mesh`) after `def`. Axis a of a triangle is the
// projection of def->direction into its plane, or where that is nearly normal to it (within 6
// degrees) of the global axis that is least so; b lies across. Two triangles that share an edge are
// neighbours; where three or more do, or one stands alone, the edge bends freely. Triangles may be
// turned either way. VSC_INPUT for a triangle without area. The content of *sheet is owned by the
// caller, to be released also after a failure.
vsc_status vsc_sheet_make(const vsc_mesh *mesh, const vsc_surface *surface,
                          const vsc_membrane_def *def, vsc_sheet *sheet, vsc_error *error);

void vsc_sheet_free(vsc_sheet *sheet);  // the content

// M of a triangle with corners `x` (mm, at rest) and the nodes `across` its edges; has[i]: there is
// a neighbour. The plate of rigidity D (uJ) and Poisson ratio nu stores
//   A/2 k.C k,  k = (k_11, k_22, 2 k_12),  C = D [1 nu 0; nu 1 0; 0 0 (1 - nu)/2],
// and a constant curvature k opens the edges by theta = L k: with the neighbour unfolded into the
// triangle's plane, u out of the edge and t along it, heights h, h' and feet f, f' (from the edge's
// middle) of the two third nodes, l its length,
//   theta = k_uu (h + h')/2 + k_ut (f' - f) + k_tt/2 [(f^2 - l^2/4)/h + (f'^2 - l^2/4)/h'].
// The least energy of all curvatures with these angles is A/2 theta.(L C^-1 L^T)^-1 theta: so an
// edge without neighbour carries no moment. Where angles cannot tell curvatures apart (a node with
// three triangles only), what they do tell is kept: eigenvalues below 1e-3 of the largest are left
// out. False when memory is short.
bool vsc_bend_stiffness(const double x[3][3], const double across[3][3], const bool has[3], double D,
                        double nu, double M[3][3]);

#endif
