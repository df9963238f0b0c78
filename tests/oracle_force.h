// SPDX-License-Identifier: GPL-3.0-or-later
// The forces of a random_body computed in the plainest way, from the mesh and the definition alone:
// one tet after the other, deformation gradients, first Piola-Kirchhoff stress, no stencil, no
// patches.
#ifndef VSC_TESTS_ORACLE_FORCE_H
#define VSC_TESTS_ORACLE_FORCE_H

#include "base/vec3.h"
#include "random_body.h"

// One tet: rest and deformed edge matrices (columns x_i - x_0), F = Ds Dm^-1.
typedef struct oracle_tet {
  const uint32_t *node;
  const vsc_material_def *material;
  const double *frame;  // rows f, s, n
  double V, J;
  double inverse[9];  // Dm^-1: row i is grad N_i
  double F[9];
  double rate[9];  // dF/dt
  double activation;
} oracle_tet;

static inline double oracle_ramp(double time)
{
  return fmin(fmax(time / RAMP_TIME, 0), 1);
}

static inline double oracle_activation(const random_body *body, size_t t, double time)
{
  const vsc_array *region = vsc_arrays_find(&body->mesh->element_data, "region");
  if (region->values[t] != 1 || !body->axes->known[t]) return 0;
  const vsc_active_def *active = &body->materials[0].active;
  if (active->kind == VSC_ACTIVE_NONE) return 0;
  double amplitude = 1, delay = active->delay;
  if (active->amplitude_array[0])
    amplitude = vsc_arrays_find(&body->mesh->element_data, "strength")->values[t];
  if (active->delay_array[0])
    delay += active->delay_unit * vsc_arrays_find(&body->mesh->element_data, "late")->values[t];
  return amplitude * oracle_ramp(time - delay);
}

// Columns times rows: M = sum_i (x_i - x_0) (row i of inverse).
static inline void oracle_gradient(const oracle_tet *tet, const double *x, double M[9])
{
  memset(M, 0, 9 * sizeof *M);
  for (int i = 0; i < 3; i++)
    for (int r = 0; r < 3; r++) {
      const double edge = x[3 * (size_t)tet->node[i + 1] + r] - x[3 * (size_t)tet->node[0] + r];
      for (int c = 0; c < 3; c++) M[3 * r + c] += edge * tet->inverse[3 * i + c];
    }
}

static inline double oracle_determinant(const double M[9])
{
  double product[3];
  vsc_cross(M + 3, M + 6, product);
  return vsc_dot(M, product);
}

static inline oracle_tet oracle_read(const random_body *body, size_t t, const double *x,
                                     const double *w, double time)
{
  const vsc_mesh *mesh = body->mesh;
  const vsc_array *region = vsc_arrays_find(&mesh->element_data, "region");
  oracle_tet tet = {.node = mesh->corners + 4 * t,
                    .frame = body->axes->frames + 9 * t,
                    .material = &body->materials[region->values[t] == 1 ? 0 : 1],
                    .activation = oracle_activation(body, t, time)};
  double edge[9];
  for (int i = 0; i < 3; i++)
    vsc_subtract(mesh->nodes + 3 * (size_t)tet.node[i + 1], mesh->nodes + 3 * (size_t)tet.node[0],
                 edge + 3 * i);
  const double determinant = oracle_determinant(edge);
  for (int i = 0; i < 3; i++) {
    vsc_cross(edge + 3 * ((i + 1) % 3), edge + 3 * ((i + 2) % 3), tet.inverse + 3 * i);
    for (int k = 0; k < 3; k++) tet.inverse[3 * i + k] /= determinant;
  }
  tet.V = determinant / 6;
  oracle_gradient(&tet, x, tet.F);
  if (w) oracle_gradient(&tet, w, tet.rate);
  tet.J = oracle_determinant(tet.F);
  return tet;
}

// U'(J)
static inline double oracle_pressure(double K, double J)
{
  return J > 0.2 ? K * (J - 1 / J) / 2 : K * (-2.4 + 13 * (J - 0.2));
}

// P_a of all springs, of active tension and of damping; P is [axis][component].
static inline void oracle_springs(const oracle_tet *tet, vsc_active_kind active, double P[9])
{
  const vsc_material_def *m = tet->material;
  double g[3][3], n[3];
  for (int a = 0; a < 3; a++) {
    rotate_vector(tet->F, tet->frame + 3 * a, g[a]);
    n[a] = vsc_norm(g[a]);
  }
  for (int a = 0; a < 3; a++) {
    double E = m->axial[a], r = 1, T = 0, rate[3];
    rotate_vector(tet->rate, tet->frame + 3 * a, rate);
    if (a == 0 && active == VSC_ACTIVE_SPRING) {
      E = (1 - tet->activation) * E + tet->activation * m->active.stiffness;
      r = (1 - tet->activation) + tet->activation * m->active.rest_stretch;
    }
    if (a == 0 && active == VSC_ACTIVE_TENSION) T = tet->activation * m->active.tension;
    const double along =
        E * (1 - r / n[a]) + T + m->damping[a] * vsc_dot(rate, g[a]) / (n[a] * n[a]);
    for (int i = 0; i < 3; i++) P[3 * a + i] = along * g[a][i];
    for (int b = 0; b < 3; b++) {
      if (b == a) continue;
      const int pair = (a + 1) % 3 == b ? a : b;
      const double c = vsc_dot(g[a], g[b]) / (n[a] * n[b]);
      for (int i = 0; i < 3; i++)
        P[3 * a + i] +=
            m->angular[pair] * c * (g[b][i] / (n[a] * n[b]) - c * g[a][i] / (n[a] * n[a]));
    }
  }
}

// Adds the forces of stress S = sum_a P_a a^T + p cof F to the tet's nodes.
static inline void oracle_scatter(const oracle_tet *tet, const double P[9], double p, double *force)
{
  double S[9], row[3];
  for (int r = 0; r < 3; r++) {
    vsc_cross(tet->F + 3 * ((r + 1) % 3), tet->F + 3 * ((r + 2) % 3), row);
    for (int c = 0; c < 3; c++) {
      S[3 * r + c] = p * row[c];
      for (int a = 0; a < 3; a++) S[3 * r + c] += P[3 * a + r] * tet->frame[3 * a + c];
    }
  }
  for (int i = 0; i < 3; i++) {
    double on_node[3];
    rotate_vector(S, tet->inverse + 3 * i, on_node);
    for (int r = 0; r < 3; r++) {
      force[3 * (size_t)tet->node[i + 1] + r] -= tet->V * on_node[r];
      force[3 * (size_t)tet->node[0] + r] += tet->V * on_node[r];
    }
  }
}

// p_n = U'(J_n) of each node's group, whose compliance 1/K is the mean of its tets'.
static inline double *oracle_node_pressures(const random_body *body, const double *x)
{
  const size_t nodes = body->mesh->node_count;
  double *p = numbers(4 * nodes), *rest = p + nodes, *now = rest + nodes, *compliance = now + nodes;
  for (size_t t = 0; t < body->mesh->element_count; t++) {
    const oracle_tet tet = oracle_read(body, t, x, NULL, 0);
    for (int c = 0; c < 4; c++) {
      rest[tet.node[c]] += tet.V / 4;
      now[tet.node[c]] += tet.V / 4 * tet.J;
      compliance[tet.node[c]] += tet.V / 4 / tet.material->volume_modulus;
    }
  }
  for (size_t n = 0; n < nodes; n++) p[n] = oracle_pressure(rest[n] / compliance[n], now[n] / rest[n]);
  return p;
}

// Weight, and the pressure on the whole boundary as the gradient of the body's volume.
static inline void oracle_loads(const random_body *body, const oracle_tet *tet, double time,
                                double *force)
{
  static const double none[9] = {0};
  const double *gravity = body->definition.gravity;
  for (int c = 0; c < 4; c++)
    for (int i = 0; i < 3; i++)
      force[3 * (size_t)tet->node[c] + i] += tet->material->density * tet->V / 4 * gravity[i];
  if (body->definition.pressure_count > 0)
    oracle_scatter(tet, none, body->pressure.peak * oracle_ramp(time), force);
}

// The total force on each node (mesh order, nodes x 3).
static inline void oracle_force(const random_body *body, const double *x, const double *w,
                                double time, double *force)
{
  const bool nodal = body->definition.volume == VSC_VOLUME_NODAL;
  double *p = nodal ? oracle_node_pressures(body, x) : NULL;
  memset(force, 0, 3 * body->mesh->node_count * sizeof *force);
  for (size_t t = 0; t < body->mesh->element_count; t++) {
    const oracle_tet tet = oracle_read(body, t, x, w, time);
    const vsc_material_def *m = tet.material;
    double P[9], pressure = oracle_pressure(nodal ? m->stabilization : m->volume_modulus, tet.J);
    for (int c = 0; nodal && c < 4; c++) pressure += p[tet.node[c]] / 4;
    oracle_springs(&tet, m->active.kind, P);
    oracle_scatter(&tet, P, pressure, force);
    oracle_loads(body, &tet, time, force);
  }
  vsc_free(p);
}

#endif
