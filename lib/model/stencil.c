// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/stencil.h"

#include "base/vec3.h"

double vsc_stencil_tet(const double x[4][3], const double frame[9], double B[3][4])
{
  double edge[3][3];
  for (int i = 0; i < 3; i++) vsc_subtract(x[i + 1], x[0], edge[i]);
  const double volume = vsc_tet_volume(x[0], x[1], x[2], x[3]);
  for (int a = 0; a < 3; a++) B[a][0] = 0;
  for (int i = 0; i < 3; i++) {
    // grad N_1 = (e_2 x e_3) / 6V, and cyclically
    double gradient[3];
    vsc_cross(edge[(i + 1) % 3], edge[(i + 2) % 3], gradient);
    for (int a = 0; a < 3; a++) {
      B[a][i + 1] = vsc_dot(gradient, frame + 3 * a) / (6 * volume);
      B[a][0] -= B[a][i + 1];
    }
  }
  return volume;
}
