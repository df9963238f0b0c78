// SPDX-License-Identifier: GPL-3.0-or-later
// How well shaped the tets are, for `viscera check`.
#ifndef VSC_MESH_QUALITY_H
#define VSC_MESH_QUALITY_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/mesh.h"

enum { VSC_WORST_TETS = 5 };

// The shape of one tet.
typedef struct vsc_tet_quality {
  double mean_ratio;    // 12 (3 V)^(2/3) / (sum of the six squared edge lengths): 1 for a regular
                        // tet, towards 0 for a flat one (Liu and Joe, BIT 34, 1994)
  double min_dihedral;  // smallest angle between two faces, degrees; regular: 70.53
  double max_dihedral;  // largest one, degrees
  double edge_ratio;    // longest edge over shortest, >= 1
  double volume;        // mm^3
} vsc_tet_quality;

typedef struct vsc_quality_summary {
  size_t element_count;
  double mean_ratio_mean;   // mean over the tets
  double mean_ratio_p5;     // 5th percentile (nearest rank)
  double min_dihedral;      // extremes over all tets, degrees
  double max_dihedral;
  double max_edge_ratio;
  double shortest_edge;     // mm
  double longest_edge;      // mm
  double volume;            // sum, mm^3
  double min_volume;        // mm^3
  double max_volume;        // mm^3
  size_t poor;              // tets with a mean ratio below 0.2
  size_t worst_count;       // the tets of the smallest mean ratios, worst first; <= VSC_WORST_TETS
  size_t worst_tet[VSC_WORST_TETS];           // number in the mesh
  uint32_t worst_source[VSC_WORST_TETS];      // number of the cell in the file
  double worst_centre[VSC_WORST_TETS][3];     // where it is, mm
  vsc_tet_quality worst[VSC_WORST_TETS];
} vsc_quality_summary;

// The shape of tet `tet` of a clean mesh.
vsc_tet_quality vsc_mesh_tet_quality(const vsc_mesh *mesh, size_t tet);

// Summarises a clean mesh. Fails with VSC_SYSTEM when memory is short.
vsc_status vsc_mesh_quality(const vsc_mesh *mesh, vsc_quality_summary *summary, vsc_error *error);

#endif
