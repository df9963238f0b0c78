// SPDX-License-Identifier: GPL-3.0-or-later
// Edge-smoothed linear tets: the law sees deformation averaged over the tets round each edge of the
// mesh, which takes away most of a linear tet's stiffness in bending and shear. With the tets t of one
// material round edge e, each of which gives every one of its six edges a sixth of its volume,
//
//   V_e = sum_t V_t/6,  F_e = sum_t w_et F_t,  w_et = V_t/6/V_e     (F: deformation gradient, global axes)
//   g_a = F_e a,  P_e = sum_a P_a (x) a,  energy V_e psi            (a: the edge's own axes f, s, n)
//   P_t = sum over the six edges of t of P_e/6,  f_i = - sum_t V_t P_t grad N_i
//
// Where an edge touches several materials it has a frame in each. Volume energies U(J) stay with the tets
// and the groups of their nodes; the -m ln J of a law that is not free of stress at rest goes with the law.
#ifndef VSC_MODEL_SMOOTHING_H
#define VSC_MODEL_SMOOTHING_H

#include <stddef.h>
#include <stdint.h>

#include "base/wide.h"

enum {
  VSC_TET_EDGES = 6,
  VSC_MOST_EDGE_PACKS = 64,  // of a block: few enough that small meshes have work for several threads
};

// What four smoothed tets have beside their frame.
typedef struct vsc_smoothed_pack {
  vsc_four axes[3][3];                      // [axis][coordinate]: unit vectors f, s, n at rest
  uint32_t edge[VSC_TET_EDGES][VSC_WIDTH];  // their edges, in the order of the kind's list
} vsc_smoothed_pack;

// Frames of four edges. Empty places are copies of the last edge with V = 0.
typedef struct vsc_edge_frame {
  vsc_four axes[3][3];  // [axis][coordinate]: unit vectors f, s, n at rest
  vsc_four V;           // V_e, mm^3
} vsc_edge_frame;

// Packs of edges of one material, neighbours in space.
typedef struct vsc_edge_block {
  uint32_t material;
  uint32_t first_pack, pack_count;
} vsc_edge_block;

typedef struct vsc_smoothing {
  size_t edge_count;       // edges with a frame, counted in each material; 0: no tet is smoothed
  size_t pack_count;       // of four edges
  vsc_edge_frame *frames;  // pack_count; owned
  uint32_t *start;         // 4 pack_count + 1: edge e averages the tets slot[start[e]] .. slot[start[e + 1] - 1]
  uint32_t *slot;          // tets' slots in the model; owned, like all here
  double *weight;          // w_et of each
  size_t block_count;
  vsc_edge_block *blocks;
  double *amplitude;  // 4 pack_count: mean of the tets' amplitudes of activation; NULL: 1 everywhere
  double *delay;      // 4 pack_count: mean of their delays, ms; NULL: 0 everywhere
} vsc_smoothing;

void vsc_smoothing_free(vsc_smoothing *smoothing);  // the content

#endif
