// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/contact.h"

#include <math.h>
#include <stdatomic.h>
#include <string.h>

#include "base/parallel.h"
#include "base/vec3.h"

enum { MOST_ROUNDS = 8, NODES_PER_PIECE = 512 };
// Parts of an element's size: below this a depth is rounding; as near as that a node is to all obstacles that it touches.
static const double ROUNDING = 1e-13, NEAR = 1e-3;
// Part of the normal, in directions that are not held, below which a node is held against the obstacle.
static const double LEAST_FREE = 1e-6;

// An obstacle at the end of a step.
typedef struct pusher {
  const vsc_obstacle *obstacle;
  vsc_contact_sums *sums;
  double point[3];
  double speed[3];  // of the obstacle in this step, mm/ms
} pusher;

// Removes held directions; returns what is left of the length.
static double free_part(const double *inverse_mass, const double normal[3], double way[3])
{
  for (int i = 0; i < 3; i++) way[i] = inverse_mass[i] > 0 ? normal[i] : 0;
  return vsc_normalize(way);
}

// Shortens the velocity along the surface by at most `most`; `way` is the free part of the normal.
// Returns true when nothing of it is left.
static bool rub(const vsc_model *model, uint32_t node, const pusher *p, const double way[3],
                double most, double v[3])
{
  double slip[3];
  for (int i = 0; i < 3; i++)
    slip[i] = model->inverse_mass[4 * (size_t)node + i] > 0 ? v[i] - p->speed[i] : 0;
  const double normal = vsc_dot(slip, way);
  for (int i = 0; i < 3; i++) slip[i] -= normal * way[i];
  const double size = vsc_norm(slip);
  if (!(size > 0)) return true;
  const double part = fmin(most / size, 1);
  for (int i = 0; i < 3; i++) v[i] -= part * slip[i];
  return part == 1;
}

// Velocity into the obstacle, as it would be without the reaction still to come, is taken away; returns
// how much that was, below 0 where the node leaves.
static double stop(const pusher *p, const double way[3], double v[3])
{
  double slip[3];
  vsc_subtract(v, p->speed, slip);
  const double inward = -vsc_dot(slip, way);
  for (int i = 0; i < 3 && inward > 0; i++) v[i] += inward * way[i];
  return inward;
}

// An obstacle gives a node an impulse along axis i.
static void load(vsc_state *state, uint32_t node, int i, double impulse, const pusher *p)
{
  double *pending = state->pending + 4 * (size_t)node;
  pending[i] += impulse;
  pending[3] += impulse * p->speed[i];
  p->sums->impulse[i] += impulse;
  p->sums->work += impulse * p->speed[i];
}

// J = m (v' - v) of one node.
static void count_impulse(const vsc_model *model, vsc_state *state, uint32_t node,
                          const double before[3], const double after[3], const pusher *p)
{
  for (int i = 0; i < 3; i++) {
    const double impulse = model->mass[node] * (after[i] - before[i]);
    load(state, node, i, impulse, p);
  }
}

// In directions in which a support holds the node still the support bears what an obstacle that pushes with `size` along
// what is free of `normal`, a part `free` of it, pushes there.
static void load_held(const vsc_model *model, vsc_state *state, uint32_t node, double size, const double normal[3],
                      double free, const pusher *p)
{
  for (int i = 0; i < 3; i++) {
    const size_t place = 4 * (size_t)node + (size_t)i;
    if (model->inverse_mass[place] == 0 && state->v[place] == 0) load(state, node, i, size * normal[i] / free, p);
  }
}

// Into `way` what is free of the normal along which the obstacle pushes the node, itself into `normal`, and how far it
// has to go for its gap, below 0, to close; returns the length of the free part, 0 for a node that is held against the
// obstacle. A sphere pushes along the normal where the step has begun: two steps that end on it have moved the node across
// that (SHAKE), so that sliding round it makes no energy. With the way y from its centre and radius r,
//   |y + depth way| = r.
static double find_way(const vsc_model *model, uint32_t node, double dt, const pusher *p, const double *x,
                       const double *v, double gap, double normal[3], double way[3], double *depth)
{
  const double *inverse_mass = model->inverse_mass + 4 * (size_t)node;
  double free = free_part(inverse_mass, normal, way);
  if (free < LEAST_FREE) return 0;
  if (p->obstacle->kind == VSC_OBSTACLE_PLANE) {
    *depth = -gap / vsc_dot(way, normal);
    return free;
  }
  double start[3], former[3], first[3], y[3];
  for (int i = 0; i < 3; i++) {
    start[i] = x[i] - dt * v[i];
    former[i] = p->point[i] - dt * p->speed[i];
  }
  vsc_obstacle_gap(p->obstacle, former, start, first);
  // unless the node has gone far round it
  if (vsc_dot(first, normal) > 0.5) {
    memcpy(normal, first, sizeof first);
    free = free_part(inverse_mass, normal, way);
  }
  vsc_subtract(x, p->point, y);
  const double along = vsc_dot(way, y), left = -gap * (2 * p->obstacle->radius + gap);
  *depth = left / (along + sqrt(along * along + left));
  return free;
}

// Damping sees the velocity at the end of the step, where the obstacle still stops the node.
static void stop_predicted(const vsc_model *model, vsc_state *state, uint32_t node, const pusher *p,
                           const double before[3], bool stuck)
{
  double *predicted = state->scratch.predicted + 4 * (size_t)node, normal[3], way[3];
  const double *v = state->v + 4 * (size_t)node;
  vsc_obstacle_gap(p->obstacle, p->point, state->x + 4 * (size_t)node, normal);
  free_part(model->inverse_mass + 4 * (size_t)node, normal, way);
  for (int i = 0; i < 3; i++) predicted[i] += v[i] - before[i];
  stop(p, way, predicted);
  if (stuck) rub(model, node, p, way, INFINITY, predicted);
}

static void mark(const vsc_model *model, vsc_state *state, uint32_t node, const pusher *p, const double way[3])
{
  double *kept = state->contact_normal + 4 * (size_t)node;
  const double number = (double)(p->obstacle - model->obstacles);
  uint8_t *touch = &state->contact_count[node];
  *touch = *touch != VSC_APART && (kept[3] != number || *touch == VSC_TOUCHES_SEVERAL) ? VSC_TOUCHES_SEVERAL : VSC_TOUCHES;
  memcpy(kept, way, 3 * sizeof *kept);
  kept[3] = number;
}

static bool put_back(const vsc_model *model, vsc_state *state, uint32_t node, double dt,
                     const pusher *p)
{
  double *x = state->x + 4 * (size_t)node, *v = state->v + 4 * (size_t)node;
  double normal[3], way[3], before[3], depth;
  const double gap = vsc_obstacle_gap(p->obstacle, p->point, x, normal);
  // most nodes are outside, and need no length
  if (gap >= 0 || gap >= -ROUNDING * (model->element_size + vsc_norm(x))) return false;
  const double free = find_way(model, node, dt, p, x, v, gap, normal, way, &depth);
  if (free < LEAST_FREE) return false;  // held against the obstacle
  memcpy(before, v, sizeof before);
  for (int i = 0; i < 3; i++) {
    x[i] += depth * way[i];
    v[i] += depth / dt * way[i];
  }
  bool stuck = false;
  if (p->obstacle->friction > 0) {
    double rubbed[3];
    memcpy(rubbed, v, sizeof rubbed);
    stuck = rub(model, node, p, way, p->obstacle->friction * depth / dt, rubbed);
    for (int i = 0; i < 3; i++) {
      x[i] += dt * (rubbed[i] - v[i]);
      v[i] = rubbed[i];
    }
  }
  if (model->terms.damping) stop_predicted(model, state, node, p, before, stuck);
  count_impulse(model, state, node, before, v, p);
  load_held(model, state, node, model->mass[node] * depth / dt, normal, free, p);
  mark(model, state, node, p, way);
  return true;
}

static pusher pusher_of(const vsc_model *model, vsc_state *state, size_t o, double dt)
{
  pusher p = {.obstacle = &model->obstacles[o], .sums = &state->contact[o]};
  double former[3];
  vsc_obstacle_place(p.obstacle, state->time, p.point);
  vsc_obstacle_place(p.obstacle, state->time - dt, former);
  for (int i = 0; i < 3; i++) p.speed[i] = (p.point[i] - former[i]) / dt;
  return p;
}

// Nodes of an obstacle, looked at in pieces.
typedef struct outlook {
  const vsc_obstacle *obstacle;
  const double *x;
  double point[3], reach;  // square of the radius, and what rounding may add to it
  atomic_bool *near;
} outlook;

// Whether any node may be inside: without roots, for the many steps in which none is.
static void look_out(void *context, size_t piece, int thread)
{
  (void)thread;
  const outlook *o = context;
  const size_t last = (piece + 1) * NODES_PER_PIECE, count = o->obstacle->node_count;
  const double *normal = o->obstacle->normal;
  bool near = false;
  for (size_t k = piece * NODES_PER_PIECE; k < (last < count ? last : count); k++) {
    double way[3];
    vsc_subtract(o->x + 4 * (size_t)o->obstacle->nodes[k], o->point, way);
    near |= o->obstacle->kind == VSC_OBSTACLE_PLANE ? !(vsc_dot(way, normal) >= 0) : !(vsc_dot(way, way) >= o->reach);
  }
  if (near) atomic_store_explicit(o->near, true, memory_order_relaxed);
}

static bool all_outside(const vsc_model *model, const vsc_state *state)
{
  atomic_bool near = false;
  for (size_t k = 0; k < model->obstacle_count && !near; k++) {
    const vsc_obstacle *obstacle = &model->obstacles[k];
    outlook o = {.obstacle = obstacle, .x = state->x, .near = &near};
    o.reach = (1 + 1e-12) * obstacle->radius * obstacle->radius;
    vsc_obstacle_place(obstacle, state->time, o.point);
    vsc_parallel_for((obstacle->node_count + NODES_PER_PIECE - 1) / NODES_PER_PIECE, look_out, &o);
  }
  return !near;
}

size_t vsc_contact_resolve(const vsc_model *model, vsc_state *state, double dt, bool fresh)
{
  size_t all = 0;
  if (fresh) memset(state->contact_count, 0, model->node_count * sizeof *state->contact_count);
  if (all_outside(model, state)) return 0;
  for (int round = 0; round < MOST_ROUNDS; round++) {
    size_t moved = 0;
    for (size_t o = 0; o < model->obstacle_count; o++) {
      const pusher p = pusher_of(model, state, o, dt);
      for (size_t k = 0; k < p.obstacle->node_count; k++)
        moved += put_back(model, state, p.obstacle->nodes[k], dt, &p);
    }
    all += moved;
    if (moved == 0) break;
  }
  return all;
}

void vsc_contact_load(const vsc_model *model, vsc_state *state, uint32_t node,
                      const double impulse[3], double dt)
{
  const pusher p = pusher_of(model, state, (size_t)state->contact_normal[4 * (size_t)node + 3], dt);
  for (int i = 0; i < 3; i++) load(state, node, i, impulse[i], &p);
}

void vsc_contact_account(const vsc_model *model, vsc_state *state)
{
  for (size_t n = 0; n < model->node_count; n++) {
    double *impulse = state->pending + 4 * n;
    const double *former = state->former + 4 * n, *v = state->v + 4 * n;
    if (impulse[0] == 0 && impulse[1] == 0 && impulse[2] == 0) continue;
    // what obstacles have worked less what the node has got of it
    vsc_contact_sums *sums = &state->contact[(size_t)state->contact_normal[4 * n + 3]];
    sums->lost += impulse[3];
    for (int i = 0; i < 3; i++) sums->lost -= 0.5 * impulse[i] * (former[i] + v[i]);
    memset(impulse, 0, 4 * sizeof *impulse);
  }
}

// Whether the node touched this obstacle in the last step.
static bool touched(const vsc_model *model, const vsc_state *state, uint32_t node, const pusher *p, double gap)
{
  const uint8_t touch = state->contact_count[node];
  if (touch == VSC_APART) return false;
  if (touch == VSC_TOUCHES_SEVERAL) return gap < NEAR * model->element_size;
  return state->contact_normal[4 * (size_t)node + 3] == (double)(p->obstacle - model->obstacles);
}

// Whether the obstacle stops the node.
static bool settle(const vsc_model *model, vsc_state *state, uint32_t node, double dt, const pusher *p)
{
  double *v = state->v + 4 * (size_t)node, normal[3], way[3], before[3];
  const double gap = vsc_obstacle_gap(p->obstacle, p->point, state->x + 4 * (size_t)node, normal);
  if (!touched(model, state, node, p, gap)) return false;
  const double free = free_part(model->inverse_mass + 4 * (size_t)node, normal, way);
  if (free < LEAST_FREE) return false;
  memcpy(before, v, sizeof before);
  const double inward = stop(p, way, v), rounding = ROUNDING * model->element_size / dt;
  const bool stops = inward > rounding;
  if (stops && p->obstacle->friction > 0) rub(model, node, p, way, p->obstacle->friction * inward, v);
  count_impulse(model, state, node, before, v, p);
  if (inward > 0) load_held(model, state, node, model->mass[node] * inward, normal, free, p);
  uint8_t *touch = &state->contact_count[node];
  if (*touch == VSC_TOUCHES_SEVERAL) return stops;
  memcpy(state->contact_normal + 4 * (size_t)node, way, sizeof way);
  if (fabs(inward) > rounding) *touch = stops ? VSC_TOUCHES : VSC_LEAVES;
  return stops;
}

size_t vsc_contact_settle(const vsc_model *model, vsc_state *state, double dt)
{
  size_t stopped = 0;
  for (size_t o = 0; o < model->obstacle_count; o++) {
    const pusher p = pusher_of(model, state, o, dt);
    for (size_t k = 0; k < p.obstacle->node_count; k++)
      stopped += settle(model, state, p.obstacle->nodes[k], dt, &p);
  }
  return stopped;
}
