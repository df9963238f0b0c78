// SPDX-License-Identifier: GPL-3.0-or-later
// Two meshes at rest, and where the places of the one lie in the other.
#ifndef VSC_TOOLS_COMPARE_PAIR_H
#define VSC_TOOLS_COMPARE_PAIR_H

#include <stdbool.h>

#include "mesh/place.h"

// Zeroed, but for the wishes, it is empty.
typedef struct vsc_pair {
  double reach;       // a wish: mm that A's places may lie outside B; 0: half the size of B's elements
  bool interpolate;   // a wish: also between meshes of the same connectivity
  vsc_mesh *a, *b;    // owned; NULL when empty
  bool same;          // nodes compared value by value; elements too, unless there are centres
  double *node_volumes;     // A's: mm^3 that each node stands for (vsc_lumped_volumes)
  double *element_volumes;  // A's, mm^3
  vsc_place *nodes;    // where A's nodes lie in B; NULL when same
  vsc_place *centres;  // where the centres of A's elements lie in B; NULL when the elements are the same
  double limit;        // mm: places further outside than that are left out
  size_t outside;      // nodes of A that lie outside B, but not further; more than 1e-6 of its size
  size_t left_out;     // those further outside
  double furthest;     // mm, of all of them
  double furthest_at[3];
} vsc_pair;

// Whether the meshes are those of the pair, but for their arrays.
bool vsc_pair_holds(const vsc_pair *pair, const vsc_mesh *a, const vsc_mesh *b);

// Makes the pair of two meshes, which it owns from then on, also after a failure. VSC_INPUT, with the
// names of the files, when they are different and one has no elements.
vsc_status vsc_pair_make(vsc_pair *pair, vsc_mesh *a, const char *file_a, vsc_mesh *b,
                         const char *file_b, vsc_error *error);

void vsc_pair_free(vsc_pair *pair);  // leaves it empty, with its wishes

#endif
