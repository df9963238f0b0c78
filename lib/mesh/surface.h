// SPDX-License-Identifier: GPL-3.0-or-later
// Measures of a surface: its area, and the volume of the cavity that it encloses.
#ifndef VSC_MESH_SURFACE_H
#define VSC_MESH_SURFACE_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"
#include "mesh/facets.h"

// A surface prepared for measuring the volume it encloses, again and again while its nodes move.
// Where it is open, each rim is a closed loop of nodes, capped by the fan of triangles between the
// loop's edges and the mean of its corners (which moves with them); on a quadratic mesh the triangles'
// outer sides are curved as the rim's edges are.
typedef struct vsc_cavity {
  char name[VSC_NAME];
  vsc_facets facets;    // of the surface
  size_t rim_count;     // 0: the surface is closed
  size_t *rim_start;    // rim_count + 1: rim r has the nodes rim_nodes[rim_start[r]..]; owned
  uint32_t *rim_nodes;  // in the order in which a cap continues the surface's turning; owned
  uint32_t *rim_mid;    // the middle of the edge from each of them to the next, or NULL; owned
} vsc_cavity;

// Prepares `surface` for vsc_cavity_volume; nodes are numbered below `node_count`. Any surface will
// do: several pieces, edges that join more than two triangles, rims that touch one another (they
// are taken apart into loops without repeated nodes), because the directed edges that no neighbour
// cancels always form closed loops. An edge that runs twice the same way without its reverse, as
// between triangles that are turned differently, becomes part of two rims. Fails with VSC_INPUT
// for a surface without triangles or with a node number out of range. The content of `cavity` is
// owned by the caller.
vsc_status vsc_cavity_make(const vsc_surface *surface, size_t node_count, vsc_cavity *cavity,
                           vsc_error *error);

// Node i becomes node number[i].
void vsc_cavity_renumber(vsc_cavity *cavity, const uint32_t *number);

// Frees the content; a zeroed one is fine.
void vsc_cavity_free(vsc_cavity *cavity);

// The volume enclosed, mm^3: by the divergence theorem minus one sixth of the sum of a . (b x c)
// over facets and caps, seen from one of the nodes, so that it does not change with translation;
// exactly so through faces of six nodes (mesh/face.h) and through bilinear ones (mesh/facets.h).
// Positive where the triangles' normals, which point out of the tissue, point into the cavity, as
// an endocardium's do; negative for a surface that encloses the tissue. Node i lies at
// positions[stride i .. stride i + 2].
double vsc_cavity_volume(const vsc_cavity *cavity, const double *positions, size_t stride);

// Makes a surface of six-node faces one of four times as many flat triangles between their nodes, without
// middles; others stay. VSC_SYSTEM when memory is short.
vsc_status vsc_surface_flatten(vsc_surface *surface, vsc_error *error);

// The area of a surface, mm^2; positions as above. Of curved faces by the points of mesh/face.h,
// of quadrilaterals the mean of both cuts.
double vsc_surface_area(const vsc_surface *surface, const double *positions, size_t stride);

#endif
