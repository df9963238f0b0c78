// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/loads.h"

#include <string.h>

#include "base/parallel.h"
#include "base/vec3.h"

enum { NODES_PER_PIECE = 512 };

// ---- faces

void vsc_face_push(const vsc_face_rule *rule, const double x[][3], double f[][3])
{
  memset(f, 0, (size_t)rule->nodes * sizeof *f);
  for (int q = 0; q < rule->points; q++) {
    double t1[3], t2[3], n[3];
    vsc_face_tangents(rule, q, x, t1, t2, n);
    for (int i = 0; i < rule->nodes; i++)
      for (int k = 0; k < 3; k++) f[i][k] -= rule->weight[q] * rule->N[q][i] * n[k];
  }
}

// K += factor [a]x
static void add_turned(double factor, const double a[3], double K[9])
{
  for (int k = 0; k < 3; k++) {
    const int next = (k + 1) % 3, last = (k + 2) % 3;
    K[3 * k + next] -= factor * a[last];
    K[3 * k + last] += factor * a[next];
  }
}

void vsc_face_push_tangent(const vsc_face_rule *rule, const double x[][3],
                           double K[][VSC_FACE_NODES][9])
{
  memset(K, 0, (size_t)rule->nodes * sizeof *K);
  for (int q = 0; q < rule->points; q++) {
    double t1[3], t2[3], n[3];
    vsc_face_tangents(rule, q, x, t1, t2, n);
    for (int i = 0; i < rule->nodes; i++)
      for (int j = 0; j < rule->nodes; j++) {
        const double part = rule->weight[q] * rule->N[q][i];
        add_turned(part * rule->dN[q][1][j], t1, K[i][j]);
        add_turned(-part * rule->dN[q][0][j], t2, K[i][j]);
      }
  }
}

static void gather_face(const vsc_pressure *load, size_t face, const double *x,
                        uint32_t node[VSC_FACE_NODES], double at[][3])
{
  const uint32_t *mid = load->facets.mid != NULL ? load->facets.mid + 3 * face : NULL;
  memcpy(node, load->facets.corners + 3 * face, 3 * sizeof *node);
  if (mid != NULL) memcpy(node + 3, mid, 3 * sizeof *node);
  vsc_face_places(node, mid, x, 4, at);
}

// ---- pressures and dead tractions

static bool is_dead(const vsc_pressure *load)
{
  return vsc_norm(load->direction) > 0;
}

// f_i = d int N_i dA of a face at rest.
static void drag(const vsc_face_rule *rule, const double rest[][3], const double direction[3], double f[][3])
{
  memset(f, 0, (size_t)rule->nodes * sizeof *f);
  for (int q = 0; q < rule->points; q++) {
    double t1[3], t2[3], n[3];
    vsc_face_tangents(rule, q, rest, t1, t2, n);
    for (int i = 0; i < rule->nodes; i++)
      for (int k = 0; k < 3; k++) f[i][k] += rule->weight[q] * rule->N[q][i] * vsc_norm(n) * direction[k];
  }
}

// The forces of a facet under a load of 1 kPa, as far as it counts, and where its nodes are.
static void face_forces(const vsc_model *model, const vsc_pressure *load, size_t face, const double *x,
                        uint32_t node[VSC_FACE_NODES], double at[][3], double f[][3])
{
  double rest[VSC_FACE_NODES][3];
  gather_face(load, face, x, node, at);
  if (is_dead(load)) {
    gather_face(load, face, model->rest, node, rest);
    drag(&load->rule, (const double(*)[3])rest, load->direction, f);
  } else {
    vsc_face_push(&load->rule, (const double(*)[3])at, f);
  }
  const double weight = vsc_facet_weight(&load->facets, face);
  for (int i = 0; i < load->rule.nodes; i++)
    for (int k = 0; k < 3; k++) f[i][k] *= weight;
}

// The same of facets first, ... end - 1 with three nodes, which each take a third:
// f_i = -p/6 (x_1 - x_0) x (x_2 - x_0).
static void add_flat_pressure(const vsc_facets *facets, size_t first, size_t end, double pressure, const double *x,
                              double *force)
{
  for (size_t face = first; face < end; face++) {
    const uint32_t *node = facets->corners + 3 * face;
    double a[3], b[3], n[3];
    vsc_subtract(x + 4 * (size_t)node[1], x + 4 * (size_t)node[0], a);
    vsc_subtract(x + 4 * (size_t)node[2], x + 4 * (size_t)node[0], b);
    vsc_cross(a, b, n);
    for (int i = 0; i < 3; i++)
      for (size_t k = 0; k < 3; k++) force[4 * (size_t)node[i] + k] -= pressure / 6 * n[k];
  }
}

static void add_pressure(const vsc_model *model, const vsc_pressure *load, double pressure, const double *x,
                         double *force)
{
  const vsc_facets *facets = &load->facets;
  if (load->rule.nodes == 3 && !is_dead(load)) {
    add_flat_pressure(facets, 0, facets->whole, pressure, x, force);
    add_flat_pressure(facets, facets->whole, facets->count, 0.5 * pressure, x, force);
    return;
  }
  for (size_t face = 0; face < facets->count; face++) {
    uint32_t node[VSC_FACE_NODES];
    double at[VSC_FACE_NODES][3], f[VSC_FACE_NODES][3];
    face_forces(model, load, face, x, node, at, f);
    for (int i = 0; i < load->rule.nodes; i++)
      for (int k = 0; k < 3; k++) force[4 * (size_t)node[i] + (size_t)k] += pressure * f[i][k];
  }
}

// (K + K^T)/2 of a face's blocks, times `factor`.
static void sink_symmetric(double K[VSC_FACE_NODES][VSC_FACE_NODES][9], int nodes, double factor,
                           const uint32_t *node, vsc_block_sink *sink, void *context)
{
  for (int i = 0; i < nodes; i++)
    for (int j = 0; j < nodes; j++) {
      double block[9];
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
          block[3 * r + c] = 0.5 * factor * (K[i][j][3 * r + c] + K[j][i][3 * c + r]);
      sink(context, node[i], node[j], block);
    }
}

static void pressure_tangent(const vsc_pressure *load, double factor, const double *x,
                             vsc_block_sink *sink, void *context)
{
  for (size_t face = 0; face < load->facets.count; face++) {
    uint32_t node[VSC_FACE_NODES];
    double at[VSC_FACE_NODES][3], K[VSC_FACE_NODES][VSC_FACE_NODES][9];
    gather_face(load, face, x, node, at);
    vsc_face_push_tangent(&load->rule, (const double(*)[3])at, K);
    sink_symmetric(K, load->rule.nodes, factor * vsc_facet_weight(&load->facets, face), node, sink, context);
  }
}

size_t vsc_loads_push_count(const vsc_model *model)
{
  size_t count = 0;
  for (size_t p = 0; p < model->pressure_count; p++)
    count += 6 * model->pressures[p].facets.count * (size_t)model->pressures[p].rule.nodes;
  return count;
}

double vsc_loads_pressure_work(const vsc_model *model, const double *x, double time, double *push)
{
  double work = 0;
  for (size_t p = 0; p < model->pressure_count; p++) {
    const vsc_pressure *load = &model->pressures[p];
    const double pressure = vsc_model_pressure(model, p, time);
    for (size_t face = 0; face < load->facets.count; face++) {
      uint32_t node[VSC_FACE_NODES];
      double at[VSC_FACE_NODES][3], f[VSC_FACE_NODES][3];
      face_forces(model, load, face, x, node, at, f);
      for (int i = 0; i < load->rule.nodes; i++, push += 6)
        for (int k = 0; k < 3; k++) {
          const double force = pressure * f[i][k];
          work += 0.5 * (force + push[k]) * (at[i][k] - push[3 + k]);
          push[k] = force;
          push[3 + k] = at[i][k];
        }
    }
  }
  return work;
}

// ---- springs and dashpots on surfaces

// What the nodes of one support do to one another.
typedef struct bed_work {
  const vsc_robin *bed;
  const vsc_wide *x, *rest, *w;
  vsc_wide *pull;  // one for each row
  vsc_wide *force;
} bed_work;

static size_t piece_end(const bed_work *b, size_t piece)
{
  const size_t end = (piece + 1) * NODES_PER_PIECE;
  return end < b->bed->node_count ? end : b->bed->node_count;
}

// t_j = stiffness (x_j - X_j) + damping w_j
VSC_CLONED static void pull_rows(void *context, size_t piece, int thread)
{
  (void)thread;
  const bed_work *b = context;
  for (size_t row = piece * NODES_PER_PIECE, end = piece_end(b, piece); row < end; row++) {
    const uint32_t j = b->bed->nodes[row];
    b->pull[row] = b->bed->stiffness * (b->x[j] - b->rest[j]);
    if (b->w != NULL) b->pull[row] += b->bed->damping * b->w[j];
  }
}

// f_i -= sum_j W_ij t_j
VSC_CLONED static void push_rows(void *context, size_t piece, int thread)
{
  (void)thread;
  const bed_work *b = context;
  const vsc_robin *bed = b->bed;
  const vsc_wide *blocks = (const vsc_wide *)bed->blocks;
  for (size_t row = piece * NODES_PER_PIECE, end = piece_end(b, piece); row < end; row++) {
    vsc_wide sum = vsc_splat(0);
    for (uint32_t k = bed->start[row]; k < bed->start[row + 1]; k++) {
      const vsc_wide *W = blocks + 3 * (size_t)k, pull = b->pull[bed->columns[k]];
      sum += W[0] * pull[0] + W[1] * pull[1] + W[2] * pull[2];
    }
    b->force[bed->nodes[row]] -= sum;
  }
}

static void add_bed(const vsc_model *model, const vsc_robin *bed, const double *x, const double *w, double *pull,
                    double *force)
{
  bed_work work = {.bed = bed,
                   .x = (const vsc_wide *)x,
                   .rest = (const vsc_wide *)model->rest,
                   .w = (const vsc_wide *)w,
                   .pull = (vsc_wide *)pull,
                   .force = (vsc_wide *)force};
  const size_t pieces = (bed->node_count + NODES_PER_PIECE - 1) / NODES_PER_PIECE;
  vsc_parallel_for(pieces, pull_rows, &work);
  vsc_parallel_for(pieces, push_rows, &work);
}

static void bed_tangent(const vsc_robin *bed, double factor, vsc_block_sink *sink, void *context)
{
  for (size_t row = 0; row < bed->node_count; row++)
    for (uint32_t k = bed->start[row]; k < bed->start[row + 1]; k++) {
      double block[9];
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++)
          block[3 * r + c] = factor * bed->blocks[12 * (size_t)k + 4 * (size_t)c + (size_t)r];
      sink(context, bed->nodes[row], bed->nodes[bed->columns[k]], block);
    }
}

// (d - origin) . W (d - origin) of a support; `origin` may be NULL: 0.
static double bed_square(const vsc_robin *bed, const double *d, const double *origin)
{
  double square = 0;
  for (size_t row = 0; row < bed->node_count; row++) {
    const size_t i = 4 * (size_t)bed->nodes[row];
    for (uint32_t k = bed->start[row]; k < bed->start[row + 1]; k++) {
      const double *W = bed->blocks + 12 * (size_t)k;
      const size_t j = 4 * (size_t)bed->nodes[bed->columns[k]];
      for (size_t c = 0; c < 3; c++)
        for (size_t r = 0; r < 3; r++)
          square += (d[i + r] - (origin ? origin[i + r] : 0)) * W[4 * c + r] *
                    (d[j + c] - (origin ? origin[j + c] : 0));
    }
  }
  return square;
}

double vsc_loads_energy(const vsc_model *model, const double *x)
{
  double energy = 0;
  for (size_t r = 0; r < model->robin_count; r++)
    energy += 0.5 * model->robins[r].stiffness * bed_square(&model->robins[r], x, model->rest);
  return energy;
}

double vsc_loads_dissipation(const vsc_model *model, const double *v)
{
  double power = 0;
  for (size_t r = 0; r < model->robin_count; r++)
    if (model->robins[r].damping > 0)
      power += model->robins[r].damping * bed_square(&model->robins[r], v, NULL);
  return power;
}

// ---- all

bool vsc_loads_work(const vsc_model *model, double time, double load)
{
  for (size_t p = 0; p < model->pressure_count; p++)
    if (load * vsc_model_pressure(model, p, time) != 0) return true;
  return model->robin_count > 0;
}

void vsc_loads_push(const vsc_model *model, const double *x, double time, double load, double *force)
{
  for (size_t p = 0; p < model->pressure_count; p++) {
    const double pressure = load * vsc_model_pressure(model, p, time);
    if (pressure != 0) add_pressure(model, &model->pressures[p], pressure, x, force);
  }
}

void vsc_loads_hold(const vsc_model *model, const double *x, const double *w, double *pull, double *force)
{
  for (size_t r = 0; r < model->robin_count; r++)
    add_bed(model, &model->robins[r], x, model->robins[r].damping > 0 ? w : NULL, pull, force);
}

void vsc_loads_tangent(const vsc_model *model, const double *x, double time, double load,
                       double stiffness_factor, double damping_factor, vsc_block_sink *sink,
                       void *context)
{
  for (size_t p = 0; p < model->pressure_count; p++) {
    const double factor = stiffness_factor * load * vsc_model_pressure(model, p, time);
    if (factor != 0 && !is_dead(&model->pressures[p])) pressure_tangent(&model->pressures[p], factor, x, sink, context);
  }
  for (size_t r = 0; r < model->robin_count; r++) {
    const vsc_robin *bed = &model->robins[r];
    bed_tangent(bed, stiffness_factor * bed->stiffness + damping_factor * bed->damping, sink,
                context);
  }
}
