// SPDX-License-Identifier: GPL-3.0-or-later
// A closed surface of eight faces with six nodes each, and its volume in the plainest way.
#ifndef VSC_TESTS_OCTAHEDRON_H
#define VSC_TESTS_OCTAHEDRON_H

#include <string.h>

#include "base/vec3.h"
#include "close.h"
#include "random.h"

enum { OCTA_FACES = 8, OCTA_CORNERS = 6, OCTA_NODES = 18 };

// Nodes 0 to 5 are corners, the others lie in the middle of edges.
typedef struct octahedron {
  double x[4 * OCTA_NODES];
  uint32_t triangles[3 * OCTA_FACES], mid[3 * OCTA_FACES];  // edges 01, 12, 20
} octahedron;

// The place of the middle of edge a b: made when it is first asked for.
static inline uint32_t octahedron_mid(octahedron *o, uint32_t a, uint32_t b, uint32_t *count,
                                      uint32_t edges[OCTA_NODES][2])
{
  for (uint32_t m = OCTA_CORNERS; m < *count; m++)
    if ((edges[m][0] == a && edges[m][1] == b) || (edges[m][0] == b && edges[m][1] == a)) return m;
  const uint32_t made = (*count)++;
  edges[made][0] = a;
  edges[made][1] = b;
  for (int k = 0; k < 3; k++) o->x[4 * made + k] = (o->x[4 * a + k] + o->x[4 * b + k]) / 2;
  return made;
}

// Of radius 1 with normals outwards, each node moved by up to `noise`.
static inline void octahedron_make(octahedron *o, double noise, uint64_t seed)
{
  static const double corner[OCTA_CORNERS][3] = {{1, 0, 0},  {0, 1, 0},  {0, 0, 1},
                                                 {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
  uint32_t edges[OCTA_NODES][2], count = OCTA_CORNERS;
  memset(o, 0, sizeof *o);
  for (int n = 0; n < OCTA_CORNERS; n++) memcpy(o->x + 4 * n, corner[n], sizeof corner[n]);
  for (uint32_t f = 0; f < OCTA_FACES; f++) {
    // one corner of each axis; an odd number of opposite ones turns the face round
    const uint32_t a = f & 1 ? 3 : 0, b = f & 2 ? 4 : 1, c = f & 4 ? 5 : 2;
    const int odd = ((f & 1) + (f >> 1 & 1) + (f >> 2 & 1)) % 2;
    const uint32_t node[3] = {a, odd ? c : b, odd ? b : c};
    for (int i = 0; i < 3; i++) {
      o->triangles[3 * f + (uint32_t)i] = node[i];
      o->mid[3 * f + (uint32_t)i] = octahedron_mid(o, node[i], node[(i + 1) % 3], &count, edges);
    }
  }
  assert_int_equal(count, OCTA_NODES);
  for (int n = 0; n < OCTA_NODES; n++)
    for (int k = 0; k < 3; k++) o->x[4 * n + k] += random_between(&seed, -noise, noise);
}

// Puts all nodes on the sphere of radius 1.
static inline void octahedron_round(octahedron *o)
{
  for (int n = 0; n < OCTA_NODES; n++) vsc_normalize(o->x + 4 * n);
}

// x, dx/du and dx/dv of a face at (u, v), by interpolating along edges and between them.
static inline void octahedron_place(const octahedron *o, int face, int nodes, double u, double v,
                                    double x[3], double t1[3], double t2[3])
{
  const double w = 1 - u - v;
  const double N[6] = {w - 2 * w * (u + v), u - 2 * u * (v + w), v - 2 * v * (u + w),
                       4 * w * u,           4 * u * v,           4 * v * w};
  const double Nu[6] = {1 - 4 * w, 4 * u - 1, 0, 4 * (w - u), 4 * v, -4 * v};
  const double Nv[6] = {1 - 4 * w, 0, 4 * v - 1, -4 * u, 4 * u, 4 * (w - v)};
  const double L[3] = {w, u, v}, Lu[3] = {-1, 1, 0}, Lv[3] = {-1, 0, 1};
  for (int k = 0; k < 3; k++) x[k] = t1[k] = t2[k] = 0;
  for (int i = 0; i < nodes; i++) {
    const uint32_t node = i < 3 ? o->triangles[3 * face + i] : o->mid[3 * face + i - 3];
    for (int k = 0; k < 3; k++) {
      const double at = o->x[4 * node + (uint32_t)k];
      x[k] += at * (nodes == 3 ? L[i] : N[i]);
      t1[k] += at * (nodes == 3 ? Lu[i] : Nu[i]);
      t2[k] += at * (nodes == 3 ? Lv[i] : Nv[i]);
    }
  }
}

// Point p of 25 by Gauss's five (degree 9) in u and in v/(1 - u); weights sum to 1/2.
static inline void octahedron_point(int p, double *u, double *v, double *weight)
{
  static const double place[5] = {0, 0.53846931010568309104, -0.53846931010568309104,
                                  0.90617984593866399280, -0.90617984593866399280};
  static const double part[5] = {0.56888888888888888889, 0.47862867049936646804,
                                 0.47862867049936646804, 0.23692688505618908751,
                                 0.23692688505618908751};
  *u = (1 + place[p / 5]) / 2;
  *v = (1 - *u) * (1 + place[p % 5]) / 2;
  *weight = part[p / 5] * part[p % 5] / 4 * (1 - *u);
}

// (1/3) int x . n dA over faces of 3 or 6 nodes.
static inline double octahedron_volume(const octahedron *o, int nodes)
{
  double volume = 0;
  for (int face = 0; face < OCTA_FACES; face++)
    for (int p = 0; p < 25; p++) {
      double u, v, weight, x[3], t1[3], t2[3], n[3];
      octahedron_point(p, &u, &v, &weight);
      octahedron_place(o, face, nodes, u, v, x, t1, t2);
      vsc_cross(t1, t2, n);
      volume += weight * vsc_dot(x, n) / 3;
    }
  return volume;
}

#endif
