// SPDX-License-Identifier: GPL-3.0-or-later
#include "mesh/face.h"

#include "base/vec3.h"

// Points that go over into one another when the corners are exchanged: (a, b, 1 - a - b) in all orders
// of area coordinates, each with `weight` (all points of a rule together: 1).
typedef struct orbit {
  double weight, a, b;
} orbit;

static const orbit of_degree_4[] = {
    {0.22338158967801146570, 0.44594849091596488632, 0.44594849091596488632},
    {0.10995174365532186764, 0.09157621350977074346, 0.09157621350977074346},
};

static const orbit of_degree_6[] = {
    {0.116786275726379, 0.249286745170910, 0.249286745170910},
    {0.050844906370207, 0.063089014491502, 0.063089014491502},
    {0.082851075618374, 0.053145049844817, 0.310352451033784},
};

static void fill_triangle(vsc_face_rule *rule, int q)
{
  static const double slope[2][3] = {{-1, 1, 0}, {-1, 0, 1}};
  for (int k = 0; k < 2; k++)
    for (int i = 0; i < 3; i++) rule->dN[q][k][i] = slope[k][i];
}

// N_i = L_i (2 L_i - 1) at corners, 4 L_i L_j at the middles, of area coordinates L.
static void fill_quadratic(vsc_face_rule *rule, int q, const double L[3])
{
  static const double slope[2][3] = {{-1, 1, 0}, {-1, 0, 1}};
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    rule->N[q][i] = L[i] * (2 * L[i] - 1);
    rule->N[q][3 + i] = 4 * L[i] * L[j];
    for (int k = 0; k < 2; k++) {
      rule->dN[q][k][i] = (4 * L[i] - 1) * slope[k][i];
      rule->dN[q][k][3 + i] = 4 * (L[i] * slope[k][j] + L[j] * slope[k][i]);
    }
  }
}

static void add_point(vsc_face_rule *rule, double weight, double a, double b)
{
  const int q = rule->points++;
  const double L[3] = {1 - a - b, a, b};
  rule->weight[q] = weight / 2;
  for (int i = 0; i < 3; i++) rule->N[q][i] = L[i];
  if (rule->nodes == 3)
    fill_triangle(rule, q);
  else
    fill_quadratic(rule, q, L);
}

static void add_orbit(vsc_face_rule *rule, const orbit *o)
{
  const double c = 1 - o->a - o->b;
  add_point(rule, o->weight, o->a, o->b);
  add_point(rule, o->weight, o->b, c);
  add_point(rule, o->weight, c, o->a);
  if (o->a == o->b) return;
  add_point(rule, o->weight, o->b, o->a);
  add_point(rule, o->weight, c, o->b);
  add_point(rule, o->weight, o->a, c);
}

vsc_face_rule vsc_face_rule_of(int nodes, vsc_face_use use)
{
  vsc_face_rule rule = {.nodes = nodes};
  if (use == VSC_FACE_FLUX && nodes == 3) {
    add_point(&rule, 1, 1.0 / 3, 1.0 / 3);
  } else if (use == VSC_FACE_FLUX) {
    for (int k = 0; k < 2; k++) add_orbit(&rule, &of_degree_4[k]);
  } else {
    for (int k = 0; k < 3; k++) add_orbit(&rule, &of_degree_6[k]);
  }
  return rule;
}

void vsc_face_places(const uint32_t corner[3], const uint32_t *mid, const double *positions,
                     size_t stride, double x[][3])
{
  for (int i = 0; i < 3; i++)
    for (int k = 0; k < 3; k++) {
      x[i][k] = positions[stride * corner[i] + (size_t)k];
      if (mid != NULL) x[3 + i][k] = positions[stride * mid[i] + (size_t)k];
    }
}

void vsc_face_tangents(const vsc_face_rule *rule, int q, const double x[][3], double t1[3],
                       double t2[3], double n[3])
{
  for (int k = 0; k < 3; k++) t1[k] = t2[k] = 0;
  for (int i = 0; i < rule->nodes; i++)
    for (int k = 0; k < 3; k++) {
      t1[k] += rule->dN[q][0][i] * x[i][k];
      t2[k] += rule->dN[q][1][i] * x[i][k];
    }
  vsc_cross(t1, t2, n);
}
