// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/stencil.h"

#include "base/vec3.h"

double vsc_stencil_frame(const double h[3][3], const double frame[9], double T[3][3])
{
  double dual[3][3];
  for (int k = 0; k < 3; k++) vsc_cross(h[(k + 1) % 3], h[(k + 2) % 3], dual[k]);
  const double determinant = vsc_dot(h[0], dual[0]);
  // T_ak = (h_{k+1} x h_{k+2}) . a / det
  for (int a = 0; a < 3; a++)
    for (int k = 0; k < 3; k++) T[a][k] = vsc_dot(dual[k], frame + 3 * a) / determinant;
  return determinant;
}

double vsc_stencil_tet(const double x[4][3], const double frame[9], double B[3][4])
{
  double edge[3][3], T[3][3];
  for (int i = 0; i < 3; i++) vsc_subtract(x[i + 1], x[0], edge[i]);
  const double determinant = vsc_stencil_frame(edge, frame, T);
  for (int a = 0; a < 3; a++) {
    B[a][0] = 0;
    for (int i = 0; i < 3; i++) {
      B[a][i + 1] = T[a][i];
      B[a][0] -= T[a][i];
    }
  }
  return determinant / 6;
}
