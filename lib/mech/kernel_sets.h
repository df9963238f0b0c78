// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels of each instruction set. Internal to mech.
#ifndef VSC_MECH_KERNEL_SETS_H
#define VSC_MECH_KERNEL_SETS_H

#include "mech/kernel.h"

// Of cells under laws of strain.
typedef struct vsc_cell_kernels {
  vsc_patch_kernel *tets[3][2][3][2];    // law SPRINGS: [springs][damping][active kind][nodal volume]
  vsc_patch_kernel *solids[2][4];        // likewise: [damping][hexes, wedges, pyramids, quadratic tets]
  vsc_patch_kernel *laws[2][VSC_CELLS];  // any law of strain: [damping][family]
  vsc_patch_kernel *volume;
} vsc_cell_kernels;

typedef struct vsc_kernels {
  const char *name;
  vsc_cell_kernels cells;
  vsc_patch_kernel *paper_tets[2];       // [damping]
  vsc_patch_kernel *paper_hexes[2];      // [damping]
  vsc_patch_kernel *springs[2];          // classical: [damping]
  vsc_patch_kernel *triangles[2];        // [damping]
  vsc_patch_kernel *bends[2];            // [damping]
  vsc_tangent_kernel *tangents[VSC_FAMILIES];
  vsc_patch_kernel *smoothed[2];         // tets: [nodal volume]
  vsc_patch_kernel *gradient, *edge_force;
  vsc_edge_kernel *edge_stress, *edge_tangent, *edge_product;
} vsc_kernels;

extern const vsc_kernels vsc_kernels_baseline;  // whatever the compiler's default is
#ifdef __x86_64__
extern const vsc_kernels vsc_kernels_avx2;
extern const vsc_cell_kernels vsc_cells_avx512;  // eight at once

// Whether this processor has what these need.
bool vsc_computes_eight(void);
#endif

#endif
