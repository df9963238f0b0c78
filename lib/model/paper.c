// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/paper.h"

#include <math.h>

#include "base/vec3.h"
#include "mesh/cell.h"
#include "model/stencil.h"

static void barycentre(const double (*x)[3], int corners, double centre[3])
{
  for (int i = 0; i < 3; i++) {
    centre[i] = 0;
    for (int c = 0; c < corners; c++) centre[i] += x[c][i] / corners;
  }
}

static double distance(const double a[3], const double b[3])
{
  double way[3];
  vsc_subtract(a, b, way);
  return vsc_norm(way);
}

void vsc_paper_tet(const double x[4][3], const double frame[9], double r[3], double *radius)
{
  double B[3][4], centre[3];
  vsc_stencil_tet(x, frame, B);
  for (int a = 0; a < 3; a++) {
    // area coordinates along the axis are 1/4 + s B_ai: it leaves where the first of them is 0
    double ahead = INFINITY, behind = INFINITY;
    for (int i = 0; i < 4; i++) {
      if (B[a][i] < 0) ahead = fmin(ahead, 0.25 / -B[a][i]);
      if (B[a][i] > 0) behind = fmin(behind, 0.25 / B[a][i]);
    }
    r[a] = ahead + behind;
  }
  barycentre(x, 4, centre);
  *radius = 0;
  for (int i = 0; i < 4; i++) *radius += distance(x[i], centre);
}

// Bilinear weights of a face's four corners at zeta, eta in [-1, 1], and their derivatives.
static void bilinear(double zeta, double eta, double N[4], double D[2][4])
{
  static const double sign[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
  for (int i = 0; i < 4; i++) {
    const double a = 0.5 * (1 + sign[i][0] * zeta), b = 0.5 * (1 + sign[i][1] * eta);
    N[i] = a * b;
    D[0][i] = 0.5 * sign[i][0] * b;
    D[1][i] = 0.5 * sign[i][1] * a;
  }
}

// Where centre + s axis meets a face: Newton for zeta, eta, s; 0 when it misses the face.
static int meet_face(const double (*x)[3], const int face[4], const double centre[3],
                     const double axis[3], double N[4], double *s)
{
  enum { ROUNDS = 30 };
  double zeta = 0, eta = 0, D[2][4];
  int found = 0;
  *s = 0;
  for (int round = 0; round < ROUNDS && !found; round++) {
    double miss[3], column[3][3], dual[3];
    bilinear(zeta, eta, N, D);
    for (int i = 0; i < 3; i++) {
      miss[i] = centre[i] + *s * axis[i];
      column[0][i] = column[1][i] = 0;
      column[2][i] = -axis[i];
      for (int c = 0; c < 4; c++) {
        miss[i] -= N[c] * x[face[c]][i];
        column[0][i] += D[0][c] * x[face[c]][i];
        column[1][i] += D[1][c] * x[face[c]][i];
      }
    }
    vsc_cross(column[1], column[2], dual);
    const double determinant = vsc_dot(column[0], dual);
    if (determinant == 0) return 0;
    double change[3];
    for (int k = 0; k < 3; k++) {
      vsc_cross(column[(k + 1) % 3], column[(k + 2) % 3], dual);
      change[k] = vsc_dot(miss, dual) / determinant;
    }
    zeta += change[0];
    eta += change[1];
    *s += change[2];
    found = fabs(change[0]) + fabs(change[1]) < 1e-13;
  }
  bilinear(zeta, eta, N, D);
  const double edge = 1 + 1e-9;
  return found && fabs(zeta) <= edge && fabs(eta) <= edge;
}

int vsc_paper_hex(const double x[8][3], const double frame[9], double w[3][8], double r[3],
                  double radius[8])
{
  double centre[3];
  barycentre(x, 8, centre);
  for (int i = 0; i < 8; i++) radius[i] = distance(x[i], centre);
  for (int a = 0; a < 3; a++) {
    double ahead = INFINITY, behind = -INFINITY, weights[2][4] = {{0}};
    int met[2] = {-1, -1};
    for (int f = 0; f < 6; f++) {
      double N[4], s;
      if (!meet_face(x, vsc_cells[VSC_HEX].faces[f], centre, frame + 3 * a, N, &s)) continue;
      const int side = s < 0;
      if (side ? s <= behind : s >= ahead) continue;
      *(side ? &behind : &ahead) = s;
      met[side] = f;
      for (int c = 0; c < 4; c++) weights[side][c] = N[c];
    }
    if (met[0] < 0 || met[1] < 0) return 0;
    for (int i = 0; i < 8; i++) w[a][i] = 0;
    for (int side = 0; side < 2; side++)
      for (int c = 0; c < 4; c++)
        w[a][vsc_cells[VSC_HEX].faces[met[side]][c]] += side ? -weights[side][c] : weights[side][c];
    r[a] = ahead - behind;
  }
  return 1;
}
