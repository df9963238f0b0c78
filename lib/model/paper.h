// SPDX-License-Identifier: GPL-3.0-or-later
// The element of Bourguignon & Cani 2000 as printed: three axes through the barycentre, each between
// the two points where it meets the element's faces at rest.
#ifndef VSC_MODEL_PAPER_H
#define VSC_MODEL_PAPER_H

// Tet: lengths r_a of the axes (rows of `frame`) between the faces, mm, and the sum of the corners'
// distances from the barycentre. The points move with the faces' area coordinates, which makes
// l_a = r_a g_a with the frame's own g_a (test_model_stencil.c).
void vsc_paper_tet(const double x[4][3], const double frame[9], double r[3], double *radius);

// Hexahedron: weights w_ai of l_a = sum_i w_ai x_i, bilinear in the two faces that the axis meets;
// r_a = |l_a|; radius_i the distance of corner i from the barycentre, mm. Returns 0 when an axis
// meets no two faces (a cell too distorted), else 1.
int vsc_paper_hex(const double x[8][3], const double frame[9], double w[3][8], double r[3],
                  double radius[8]);

#endif
