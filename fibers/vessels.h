// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels that the mesh does not resolve: how much of each element is vessel, and which way it runs
// there.
#ifndef VSC_FIBERS_VESSELS_H
#define VSC_FIBERS_VESSELS_H

#include <stdbool.h>

#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "mesh/polydata.h"
#include "model/fiber_def.h"

// What was found, for `viscera check`.
typedef struct vsc_vessel_report {
  bool surface;         // else centre lines
  size_t pieces;        // triangles or segments
  size_t elements;      // that hold some of the vessel
  size_t directed;      // that took its direction
  double volume;        // sum over the elements of fraction times volume, mm^3
  double own_volume;    // surface: enclosed; lines: sum of pi (r1^2 + r1 r2 + r2^2) l / 3, mm^3
  double shared;        // volume that former vessels had taken already, mm^3
  size_t open_edges;    // surface: see vsc_closure
  size_t turned_edges;  // likewise
} vsc_vessel_report;

// The part `fraction` (element_count, in [0, 1]) of each element that lies in the vessel, by
// VSC_CELL_POINTS points where its wall is near, and the vessel's `direction` there (element_count x
// 3, unit length and no sign; zero where the fraction is 0 or no direction is found).
//
// Surface (no radius in the definition): inside is where the surface winds round the point, counted
// by the signs of the triangles that a ray along +x crosses; the sign of the whole does not matter.
// Of a surface with open edges six rays along the axes are counted, and their mean must be above
// one half. The direction is the axis to which the wall's normals n are most orthogonal: the
// eigenvector of the smallest eigenvalue of sum A n n^T over the triangles near the middle of the
// element's part of the vessel, A their areas; near is at first the element's size and grows until
// the normals span a plane (second eigenvalue 0.3 of the first), so up to about the vessel's radius.
//
// Centre lines: inside is nearer to a segment than the radius there, linear along the segment. Ends
// are cut flat, joints are balls. The direction is the mean axis (top eigenvector of the mean t t^T)
// of the segments that the points inside belong to.
//
// Fills the report but for `directed` and `shared`. VSC_INPUT: no triangles, no lines, no such
// radius array, radii that are negative or not finite, a surface that encloses nothing.
vsc_status vsc_vessel_sample(const vsc_mesh *mesh, const vsc_polydata *polydata,
                             const vsc_vessel_def *definition, double *fraction, double *direction,
                             vsc_vessel_report *report, vsc_error *error);

// Reads each vessel's file (`count` vessels), adds its element array <name>_fraction to the mesh, and
// gives elements with at least the threshold of it the vessel's direction as fibre axis (sheet by
// rule); of several vessels in an element the one with the largest fraction counts. What former
// vessels took of an element is no longer there for later ones: fractions never add up to more than 1.
// `reports` has room for `count`. VSC_INPUT as above, and for an array of that name in the mesh.
vsc_status vsc_vessels_make(vsc_mesh *mesh, const vsc_vessel_def *vessels, size_t count,
                            vsc_axes *axes, vsc_vessel_report *reports, vsc_error *error);

#endif
