// SPDX-License-Identifier: GPL-3.0-or-later
// The triangles of a membrane at rest: their axes, their neighbours, and how they bend.
#ifndef VSC_MODEL_MEMBRANES_H
#define VSC_MODEL_MEMBRANES_H

#include "mesh/mesh.h"
#include "mesh/select.h"
#include "model/definition.h"
#include "model/law_bending.h"

// All arrays have one item per triangle; owned.
typedef struct vsc_sheet {
  size_t count;
  uint32_t (*nodes)[VSC_BEND_NODES];  // model/law_bending.h; what is not there is the fold's p
  double *area;                       // mm^2
  double (*T)[2][2];                  // g_a = sum_k T_ak h_k, h_k = x_k - x_0; 1/mm
  double (*G)[3][VSC_BEND_FOLDS];     // of the bend; NULL: bends freely
  double (*fold)[VSC_BEND_FOLDS];     // phi at rest; NULL likewise
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

// G of a bend with nodes `x` (mm, at rest); has[j]: fold j is there. The plate of rigidity D (uJ)
// and Poisson ratio nu stores
//   A/2 k.C k,  k = (k_11, k_22, 2 k_12),  C = D [1 nu 0; nu 1 0; 0 0 (1 - nu)/2].
// In a sheet of triangles curvature is what the normal slope s across each edge tells,
//   k = sum_edges (l s/A) u u^T,
// u out of the edge, s the slope in the edge's middle over that of the triangle. The two sides'
// slopes add up to theta, s = theta/2 + rho and theta/2 - rho, so that a sheet under constant
// moments is in equilibrium whatever rho is. A curvature k opens the edge by
//   s = k_uu h/2 - k_ut f + k_tt (f^2 - l^2/4)/(2 h)
// on the side of a triangle of height h and foot f (along the edge's direction t, from its middle),
// and with -f for f on the neighbour's, unfolded: rho is half the difference of these for the mean
// of the two triangles' own curvatures, those that their three angles tell. So any constant
// curvature of any flat sheet costs what the plate's does. Where folds are missing, curvature
// relaxes to the least energy: free edges carry no moment. A curvature that angles hardly tell
// (eigenvalues below 1e-2 of the largest) is left out of rho. False when memory is short.
bool vsc_bend_stiffness(const double x[VSC_BEND_NODES][3], const bool has[VSC_BEND_FOLDS], double D,
                        double nu, double G[3][VSC_BEND_FOLDS]);

#endif
