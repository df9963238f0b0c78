// SPDX-License-Identifier: GPL-3.0-or-later
// How well shaped the elements are, for `viscera check`.
#ifndef VSC_MESH_QUALITY_H
#define VSC_MESH_QUALITY_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/mesh.h"

enum { VSC_WORST_ELEMENTS = 5 };

// The shape of one element.
typedef struct vsc_element_quality {
  double shape;         // tet: the mean ratio 12 (3 V)^(2/3) / (sum of the six squared edge
                        // lengths) (Liu and Joe, BIT 34, 1994), of a quadratic one that of its
                        // corners. Other kinds: the scaled Jacobian,
                        // det of the unit vectors along the three edges at a corner, least over the
                        // corners (at a pyramid's apex: over the four triples of edges) and divided
                        // by that of the element with equal edges. 1 for such an element, towards 0
                        // for a flat one; below 0 for a hexahedron, wedge or pyramid with a corner
                        // turned inside out
  double min_dihedral;  // smallest angle between two faces that share an edge, degrees (a
                        // quadrilateral's normal is its mean one); regular tet: 70.53
  double max_dihedral;  // largest one, degrees
  double edge_ratio;    // longest edge over shortest, >= 1
  double volume;        // mm^3
} vsc_element_quality;

typedef struct vsc_quality_summary {
  size_t element_count;
  double shape_mean;      // mean over the elements
  double shape_p5;        // 5th percentile (nearest rank)
  double min_dihedral;    // extremes over all elements, degrees
  double max_dihedral;
  double max_edge_ratio;
  double shortest_edge;   // mm
  double longest_edge;    // mm
  double volume;          // sum, mm^3
  double min_volume;      // mm^3
  double max_volume;      // mm^3
  size_t poor;            // elements with a shape below 0.2
  size_t worst_count;     // the elements of the smallest shapes, worst first; <= VSC_WORST_ELEMENTS
  size_t worst_element[VSC_WORST_ELEMENTS];    // number in the mesh
  uint32_t worst_source[VSC_WORST_ELEMENTS];   // number of the cell in the file
  double worst_centre[VSC_WORST_ELEMENTS][3];  // where it is, mm
  vsc_element_quality worst[VSC_WORST_ELEMENTS];
} vsc_quality_summary;

// The shape of element `element` of a clean mesh.
vsc_element_quality vsc_mesh_element_quality(const vsc_mesh *mesh, size_t element);

// Summarises a clean mesh; without elements all is 0. Fails with VSC_SYSTEM when memory is short.
vsc_status vsc_mesh_quality(const vsc_mesh *mesh, vsc_quality_summary *summary, vsc_error *error);

#endif
