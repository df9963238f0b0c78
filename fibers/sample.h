// SPDX-License-Identifier: GPL-3.0-or-later
// Fibre axes of every element from a voxel map of angles, safe for axes: f and -f, and angles on both
// sides of a wrap, are the same fibre. Nothing here averages an angle or a signed vector.
#ifndef VSC_FIBERS_SAMPLE_H
#define VSC_FIBERS_SAMPLE_H

#include <stdbool.h>

#include "mesh/axes.h"
#include "mesh/image.h"
#include "mesh/mesh.h"
#include "model/fiber_def.h"

// What was found, for `viscera check`.
typedef struct vsc_fiber_report {
  size_t elements;        // all
  size_t with_data;       // elements with a fibre of their own
  size_t filled;          // taken from neighbours
  size_t passive;         // left without
  size_t fallback;        // MAP: elements that hold too few voxel centres: the voxels round them
                          // were interpolated
  double coherence[3];    // MAP: 10th, 50th, 90th percentile of (l1 - l2) / l1, l1 >= l2 the two
                          // largest eigenvalues of the mean f f^T: 1 = all voxels agree. Else 0
  double azimuth[3];      // 10th, 50th, 90th percentile of the axes, degrees, in [0, 180)
  double elevation[3];    // degrees, in [-90, 90], for azimuth in [0, 180)
  size_t invalid;         // ARRAYS: zero or non-finite vectors, counted as no fibre
  size_t invalid_sheets;  // ARRAYS: zero or non-finite sheet vectors, or parallel to the fibre
                          // (within 1 degree), of elements with a fibre: completed by rule
  size_t opposed;         // ARRAYS on nodes: elements at whose nodes vectors differ by 90 to 170 degrees, so that as
                          // axes they turn the other way round, by more than 10
  size_t meeting;         // HELIX, ELLIPSOID with surfaces: nodes on both of them, where the depth jumps
  size_t wall_faces;      // ELLIPSOID: triangles of the wall's surfaces (of the boundary where none are named), base apart,
  size_t off_faces;       // and those that lie off both ellipsoids by more than a tenth of the wall
  bool constant;  // ARRAYS: all fibres are the same axis (within 0.06 degrees): perhaps a dummy
  double worst_sheet_angle;  // ARRAYS: largest deviation of sheet and fibre from a right angle,
                             // degrees
} vsc_fiber_report;

// The axis of each element is the eigenvector of the largest eigenvalue of the mean of f f^T over
// it, each voxel weighted as `map` says; voxels outside the mask, and those of weight 0, hold
// nothing.
//
// Which voxels: those whose centres lie in the element, each counting once; when fewer than 16 do,
// the 8 voxels round each of 20 points of the element's tets (vsc_mesh_split), with their trilinear
// weights times the tet's volume, which is the mean of the trilinear interpolant. How: the weighted
// mean of f f^T is moved from the centroid of those voxels to the centroid of the element along the
// gradient of their weighted linear fit, by at most twice their standard deviation. So it hardly
// matters that the mask cuts the neighbourhood of an element at the surface. A quadratic tet's mean is
// moved to each of its points in the same way. An element without any
// such voxel stays unknown.
//
// Origin, spacing and direction of the image are honoured; a left-handed direction too. Sets
// `known` of all mesh->element_count axes, the frames of those found (sheets by rule), and all of
// `report`. VSC_INPUT: an array is missing, has more than one component or not one value per voxel;
// a flat direction matrix; no voxel with data; voxels with data but non-finite angles or a negative
// or non-finite weight; an image that lies beside the mesh.
vsc_status vsc_fibers_sample(const vsc_mesh *mesh, const vsc_image *image,
                             const vsc_angle_map_def *map, vsc_axes *axes, vsc_fiber_report *report,
                             vsc_error *error);

// Elements without a fibre take the mean axis (top eigenvector of the mean f f^T, and the mean
// sheet axis in the same way) of the neighbours across their faces that have one, ring by ring, in
// an order that does not depend on chance. Returns in *filled how many were filled; parts of the
// mesh that hold no fibre at all stay without.
vsc_status vsc_fibers_fill(const vsc_mesh *mesh, vsc_axes *axes, size_t *filled, vsc_error *error);

// Azimuth in [0, 180) and elevation in [-90, 90], degrees, of a unit vector, the same bits for f
// and -f: f turned so that fy > 0 (or fy = 0, fx >= 0), azimuth = atan2(fy, fx), elevation =
// asin(fz). A fibre along z has azimuth 0 and elevation 90.
void vsc_fiber_angles(const double fiber[3], double *azimuth, double *elevation);

// Sets elements, with_data, passive and the percentiles of azimuth and elevation from `axes`.
vsc_status vsc_fiber_describe(const vsc_axes *axes, vsc_fiber_report *report, vsc_error *error);

#endif
