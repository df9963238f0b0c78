// SPDX-License-Identifier: GPL-3.0-or-later
// The force of one patch on its nodes: the loop that a simulation spends its time in. Compiled once
// for each instruction set and each combination of terms, chosen when the loop starts. Internal to
// mech.
#ifndef VSC_MECH_KERNEL_H
#define VSC_MECH_KERNEL_H

#include "model/model.h"

// A patch with its nodes gathered: x, w and f are node x 4, aligned to 32 bytes.
typedef struct vsc_patch_work {
  const void *packs;  // of the patch's family
  size_t pack_count;
  const vsc_material *material;
  const vsc_membrane *membrane;  // of triangles and bends
  const vsc_cell_rule *rule;    // of its cells; used by all cells but tets
  const vsc_axis *axes;         // the material's further axes and pairs
  const vsc_pair *pairs;
  const vsc_four *mixtures;     // of each pack, as in vsc_mixture; NULL: the material's own moduli
  const void *law_data;         // law PAPER: vsc_chords or vsc_hex_axes of each pack
  const vsc_smoothed_pack *smoothed;  // smoothed tets: of each pack; else NULL
  const double *edge_stress;    // likewise: P_e of all edges, [edge][column][4], kPa
  const double *x;              // positions, mm
  const double *w;              // velocities, mm/ms; used with damping
  const double *pressure;  // U'(J) of the nodes' volume groups, kPa; used with node-averaged volume
  const vsc_four *activation;  // of each pack, or of all when activation_stride is 0; used when active
  size_t activation_stride;
  const vsc_four *multipliers;  // of each pack: added to what its frames share, kPa; or NULL
  bool shares_volume;  // whether the pressures of nodes count
  bool angular;        // law SPRINGS: whether any angular spring may have a modulus
  double stiffness_factor, damping_factor;  // of -df/dx and of -df/dw, what goes into tangents
  const double *before;  // positions of the iterate before, which foretells stresses; or NULL
  const vsc_four (*past)[6];  // tangents of materials with a Prony series: H of each frame of the pack, kPa
  double loss;                // likewise: L of S + H - L S_0 (mech/prony.h); `past` is NULL without
  double *f;       // forces, mN: added to
  double *volume;  // quarter volumes, mm^3: added to, by the volume pass
  double *gradient;  // F of each tet, [tet][column][4]: written by the gradient pass
} vsc_patch_work;

typedef void vsc_patch_kernel(const vsc_patch_work *work);

// A block of edge frames (model/smoothing.h).
typedef struct vsc_edge_work {
  const vsc_edge_frame *frames;  // of its packs
  size_t pack_count;
  const uint32_t *start;         // of its first edge on: where each one's tets begin in
  const uint32_t *slot;          // the lists of all edges
  const double *weight;
  const double *gradient;        // F of all slots, [slot][column][4]
  const double *rate;            // dF/dt likewise, 1/ms; NULL: nothing is damped
  const vsc_material *material;
  const vsc_axis *axes;          // the material's further axes and pairs
  const vsc_pair *pairs;
  const vsc_four *activation;    // of each pack, or of all when activation_stride is 0
  size_t activation_stride;
  double stiffness_factor, damping_factor;  // tangents only, as for patches
  vsc_four *tangent;             // of its packs, VSC_EDGE_TANGENT each: blocks (i, j), i >= j, of dP's
                                 // columns i by F's columns j, row by row, at 9 (i (i + 1)/2 + j); kPa
  double *stress;                // P_e (or its change) of its edges, [edge][column][4], kPa: written
} vsc_edge_work;

enum { VSC_EDGE_TANGENT = 54 };

typedef void vsc_edge_kernel(const vsc_edge_work *work);

// The matrices of the four elements, triangles or bends of pack k: block (i, j) of corners i >= j, row by row, at
// K + 9 (i (i + 1)/2 + j); mN/mm. `work->w` is NULL where nothing is damped.
typedef void vsc_tangent_kernel(const vsc_patch_work *work, size_t k, vsc_four *K);

// The springs of frames under law SPRINGS.
typedef enum vsc_frame_springs {
  VSC_AXIAL,     // along the axes alone
  VSC_ANGULAR,   // between them too
  VSC_COMPOSED,  // further axes or pairs, or inclusions
} vsc_frame_springs;

// Which kernel a patch needs.
typedef struct vsc_kernel_choice {
  uint32_t family;  // a vsc_family
  vsc_law law;
  bool damping;
  vsc_active_kind active;
  bool nodal_volume;
  bool smoothed;  // tets whose law is evaluated on edges
  vsc_frame_springs springs;
  bool general;   // the kernel of any law of strain
} vsc_kernel_choice;

// The force kernel for the processor this runs on; NULL where the patch itself has no force (cells
// of law CLASSICAL).
vsc_patch_kernel *vsc_force_kernel(const vsc_kernel_choice *choice);

// The kernel that adds a quarter of each tet's deformed volume to its nodes' `volume`.
vsc_patch_kernel *vsc_volume_kernel(void);

// F of each of a patch's smoothed tets, and the forces of their edges' stresses alone (the force kernels of
// smoothed tets add the volume's).
vsc_patch_kernel *vsc_gradient_kernel(void);
vsc_patch_kernel *vsc_edge_force_kernel(void);

// The stress of edges; their tangent; and the tangent times the gradients, into their stress.
vsc_edge_kernel *vsc_edge_stress_kernel(void);
vsc_edge_kernel *vsc_edge_tangent_kernel(void);
vsc_edge_kernel *vsc_edge_product_kernel(void);

// The tangent of a family: of cells under laws that are functions of strain (model/law.h), of triangles and of bends;
// NULL for springs on edges.
vsc_tangent_kernel *vsc_family_tangent(uint32_t family);

// The name of the instruction set in use: "AVX-512" (of cells; of all else AVX2), "AVX2" or "baseline".
const char *vsc_kernel_set(void);

#endif
