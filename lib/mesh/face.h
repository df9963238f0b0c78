// SPDX-License-Identifier: GPL-3.0-or-later
// Faces of three nodes, or of six: the corners, then the middles of edges 01, 12, 20. How a place on a
// face depends on its nodes, and the points over which integrals on it are summed.
#ifndef VSC_MESH_FACE_H
#define VSC_MESH_FACE_H

#include <stddef.h>
#include <stdint.h>

enum { VSC_FACE_NODES = 6, VSC_FACE_POINTS = 12 };  // the most

// What a rule integrates exactly.
typedef enum vsc_face_use {
  VSC_FACE_FLUX,  // N_i (t_1 x t_2), on curved faces too
  VSC_FACE_MASS,  // N_i N_j on flat faces with straight edges; degree 6
} vsc_face_use;

// Shape functions at the points of a rule, x(xi, eta) = sum_i N_i x_i over 0 <= xi, eta, xi + eta <= 1.
typedef struct vsc_face_rule {
  int nodes;   // 3 or 6
  int points;  // used of the arrays
  double weight[VSC_FACE_POINTS];  // sum 1/2, the area of the triangle of xi and eta
  double N[VSC_FACE_POINTS][VSC_FACE_NODES];
  double dN[VSC_FACE_POINTS][2][VSC_FACE_NODES];  // by xi, by eta
} vsc_face_rule;

// The rule for faces of 3 or 6 `nodes`: one point (FLUX, 3 nodes), six of degree 4 (FLUX, 6 nodes; Strang &
// Fix 1973), twelve of degree 6 (MASS; Dunavant 1985).
vsc_face_rule vsc_face_rule_of(int nodes, vsc_face_use use);

// The places of a face's nodes: three corners and, where `mid` is not NULL, the middles of its edges.
// Node i lies at positions[stride i .. stride i + 2].
void vsc_face_places(const uint32_t corner[3], const uint32_t *mid, const double *positions,
                     size_t stride, double x[][3]);

// t_1 = dx/dxi and t_2 = dx/deta at point q of the face with its nodes at x, and n = t_1 x t_2, whose
// length is the area per area of the triangle of xi and eta; all in the units of x.
void vsc_face_tangents(const vsc_face_rule *rule, int q, const double x[][3], double t1[3],
                       double t2[3], double n[3]);

#endif
