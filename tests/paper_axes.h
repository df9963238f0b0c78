// SPDX-License-Identifier: GPL-3.0-or-later
// The construction of Bourguignon & Cani 2000 taken literally, for tests: where an axis through the
// barycentre of a tet meets its faces, and with which area coordinates.
#ifndef VSC_TESTS_PAPER_AXES_H
#define VSC_TESTS_PAPER_AXES_H

#include <string.h>

#include "base/vec3.h"
#include "random.h"

// Area coordinates of `point` in the triangle x[face[0..2]]: the parts of the area vector.
static inline void area_coordinates(const double x[4][3], const int face[3], const double point[3],
                             double coordinates[3])
{
  double whole[3], first[3], second[3];
  vsc_subtract(x[face[1]], x[face[0]], first);
  vsc_subtract(x[face[2]], x[face[0]], second);
  vsc_cross(first, second, whole);
  for (int k = 0; k < 3; k++) {
    double part[3];
    vsc_subtract(x[face[(k + 1) % 3]], point, first);
    vsc_subtract(x[face[(k + 2) % 3]], point, second);
    vsc_cross(first, second, part);
    coordinates[k] = vsc_dot(part, whole) / vsc_dot(whole, whole);
  }
}

// How far along `axis` from `centre` the plane of the face lies; infinite when the axis runs along
// it.
static inline double distance_to_face(const double x[4][3], const int face[3], const double centre[3],
                               const double axis[3])
{
  double first[3], second[3], normal[3], way[3];
  vsc_subtract(x[face[1]], x[face[0]], first);
  vsc_subtract(x[face[2]], x[face[0]], second);
  vsc_cross(first, second, normal);
  vsc_subtract(x[face[0]], centre, way);
  const double slope = vsc_dot(axis, normal);
  return slope != 0 ? vsc_dot(way, normal) / slope : INFINITY;
}

// Where the axis leaves the tet on one side (+1 or -1): the nearest of the four planes; the point's
// weights go to `weights` (4), its distance is returned.
static inline double leave(const double x[4][3], const double axis[3], double side, double weights[4])
{
  static const int faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  double centre[3], direction[3], nearest = INFINITY;
  for (int i = 0; i < 3; i++) {
    centre[i] = (x[0][i] + x[1][i] + x[2][i] + x[3][i]) / 4;
    direction[i] = side * axis[i];
  }
  const int *met = faces[0];
  for (int f = 0; f < 4; f++) {
    const double distance = distance_to_face(x, faces[f], centre, direction);
    if (!(distance > 0 && distance < nearest)) continue;
    nearest = distance;
    met = faces[f];
  }
  double point[3], coordinates[3];
  for (int i = 0; i < 3; i++) point[i] = centre[i] + nearest * direction[i];
  area_coordinates(x, met, point, coordinates);
  memset(weights, 0, 4 * sizeof *weights);
  for (int k = 0; k < 3; k++) weights[met[k]] = coordinates[k];
  return nearest;
}

static inline double longest_edge(const double x[4][3])
{
  double longest = 0;
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < i; j++) {
      double edge[3];
      vsc_subtract(x[i], x[j], edge);
      longest = fmax(longest, vsc_norm(edge));
    }
  return longest;
}

// A right-handed tet of size `size` with V > 0.01 L^3 (the regular one has 0.118).
static inline void random_tet(uint64_t *seed, double size, double x[4][3])
{
  double longest;
  do {
    random_fill(seed, size, &x[0][0], 12);
    longest = longest_edge(x);
  } while (vsc_tet_volume(x[0], x[1], x[2], x[3]) < 0.01 * longest * longest * longest);
}

#endif
