// SPDX-License-Identifier: GPL-3.0-or-later
// Fibre axes of every tet from a voxel map of angles, safe for axes: f and -f, and angles on both
// sides of a wrap, are the same fibre.
#ifndef VSC_FIBERS_SAMPLE_H
#define VSC_FIBERS_SAMPLE_H

#include "mesh/axes.h"
#include "mesh/image.h"
#include "mesh/mesh.h"
#include "model/fiber_def.h"

// What the sampling found, for the report.
typedef struct vsc_fiber_report {
  size_t elements;         // all
  size_t with_data;        // elements with a fibre of their own
  size_t filled;           // taken from neighbours
  size_t passive;          // left without
  size_t fallback;         // elements that hold no voxel centre: the nearest voxels were interpolated
  double coherence[3];     // 10th, 50th, 90th percentile of (l1 - l2) / l1, l1 >= l2 the two largest
                           // eigenvalues of the mean f f^T: 1 = all voxels agree
  double azimuth[3];       // 10th, 50th, 90th percentile of the sampled axes, degrees, in [0, 180)
  double elevation[3];     // degrees, in [-90, 90], for azimuth in [0, 180)
} vsc_fiber_report;

// The axis of each tet is the eigenvector of the largest eigenvalue of sum_v w_v f_v f_v^T over the
// voxels v whose centre lies in the tet (when there are none: the 8 voxels round the tet's centre,
// trilinear weights times w), masked and weighted as `map` says. A missing array, an empty
// overlap between mesh and image, or non-finite angles inside the mask is VSC_INPUT.
vsc_status vsc_fibers_sample(const vsc_mesh *mesh, const vsc_image *image,
                             const vsc_angle_map_def *map, vsc_axes *axes, vsc_fiber_report *report,
                             vsc_error *error);

// Elements without a fibre take the mean axis (top eigenvector of the mean f f^T) of the neighbours
// across their faces that have one, ring by ring, in an order that does not depend on chance.
// Returns in *filled how many were filled.
vsc_status vsc_fibers_fill(const vsc_mesh *mesh, vsc_axes *axes, size_t *filled, vsc_error *error);

#endif
