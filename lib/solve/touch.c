// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/touch.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "mech/step_limit.h"
#include "solve/incompressible.h"
#include "solve/moving.h"

#define PUSH 30.0        // k over what the node resists by itself
#define RAISE 10.0       // of k where depths fall slowly,
#define SLOWLY 0.25      // to more than this part,
#define MOST_RAISE 1e4   // but not to more than that
#define DEEPEST 1e-8     // of the body's size that is left
#define TOUCHING 1e-12   // of the body's size: nodes that near are taken to touch until a solution says more
#define LEAST_FREE 1e-2  // of the normal, below which supports hold a node against the obstacle

// An obstacle and a node that it stops.
typedef struct contact {
  size_t pair, obstacle;
  uint32_t node;
  double point[3];   // where the obstacle is, mm
  double gap;        // mm
  double normal[3];
  double push[3];    // d, along which the obstacle pushes
  double bend;       // of d: dd/dx is this times 1 - d d^T, 1/mm
  double stiffness;  // k, mN/mm
  double free;       // square of the normal's part in directions that are not held
} contact;

// d and how it bends: n, or in steps round a sphere of radius r, with the way y from its centre to the node,
// d = (y + y_0)/(|y| + |y_0|).
static void find_push(const vsc_touch *touch, const vsc_obstacle *obstacle, const double *x, contact *c)
{
  memcpy(c->push, c->normal, sizeof c->push);
  c->bend = 0;
  if (obstacle->kind == VSC_OBSTACLE_PLANE) return;
  c->bend = 1 / (obstacle->radius + c->gap);
  if (!touch->step) return;
  double point[3], normal[3];
  vsc_obstacle_place(obstacle, touch->former, point);
  const double *start = touch->start + 4 * (size_t)c->node;
  c->bend = 1 / (2 * obstacle->radius + c->gap + vsc_obstacle_gap(obstacle, point, start, normal));
  for (int i = 0; i < 3; i++) c->push[i] = c->bend * (x[i] - c->point[i] + start[i] - point[i]);
}

typedef void visitor(void *context, const contact *c);

// Calls `visit` for all pairs with nodes at x and obstacles where they are at `time`, in their order; nodes that are
// held against an obstacle are left out.
static void visit_all(const vsc_touch *touch, const double *x, double time, visitor *visit, void *context)
{
  const vsc_model *model = touch->model;
  contact c = {.pair = 0};
  for (c.obstacle = 0; c.obstacle < model->obstacle_count; c.obstacle++) {
    const vsc_obstacle *obstacle = &model->obstacles[c.obstacle];
    vsc_obstacle_place(obstacle, time, c.point);
    for (size_t k = 0; k < obstacle->node_count; k++, c.pair++) {
      c.node = obstacle->nodes[k];
      c.gap = vsc_obstacle_gap(obstacle, c.point, x + 4 * (size_t)c.node, c.normal);
      c.free = 0;
      for (size_t i = 0; i < 3; i++)
        if (model->inverse_mass[4 * (size_t)c.node + i] != 0) c.free += c.normal[i] * c.normal[i];
      if (c.free < LEAST_FREE * LEAST_FREE) continue;
      find_push(touch, obstacle, x + 4 * (size_t)c.node, &c);
      c.stiffness = PUSH * touch->raise / c.free *
                    (touch->factor[0] * touch->stiffness[c.node] + touch->factor[1] * model->mass[c.node]);
      visit(context, &c);
    }
  }
}

vsc_status vsc_touch_create(const vsc_model *model, double size, vsc_touch **touch, vsc_error *error)
{
  const size_t count = vsc_state_contacts(model);
  vsc_touch *made;
  *touch = NULL;
  if (count == 0) return VSC_OK;
  if (!VSC_NEW(made, 1) || !VSC_NEW(made->stiffness, model->node_count) || !VSC_NEW(made->multiplier, count) ||
      !VSC_NEW(made->force, count) || !VSC_NEW(made->start, 4 * model->node_count)) {
    vsc_touch_free(made);
    return vsc_fail_memory(error, "contact");
  }
  made->model = model;
  made->size = size;
  vsc_limit_stiffness(model, 0, made->stiffness);
  *touch = made;
  return VSC_OK;
}

void vsc_touch_free(vsc_touch *touch)
{
  if (touch == NULL) return;
  vsc_free(touch->stiffness);
  vsc_free(touch->multiplier);
  vsc_free(touch->force);
  vsc_free(touch->start);
  vsc_free(touch);
}

void vsc_touch_begin(vsc_touch *touch, const vsc_state *state, double time, bool step, double stiffness_factor,
                     double mass_factor)
{
  if (touch == NULL) return;
  memcpy(touch->multiplier, state->touch, vsc_state_contacts(touch->model) * sizeof *state->touch);
  touch->time = time;
  touch->factor[0] = stiffness_factor;
  touch->factor[1] = mass_factor;
  touch->raise = 1;
  touch->off = INFINITY;
  touch->from = state->x;
  touch->step = step;
  touch->former = state->time;
  memcpy(touch->start, state->x, 4 * touch->model->node_count * sizeof *touch->start);
}

// ---- one balance

typedef struct pushing {
  vsc_touch *touch;
  const double *x, *before;
  double *r;
} pushing;

// g_b + n_b . (x - x_b): the gap as it is seen from the iterate before; of planes the gap itself.
static double foretold_gap(const pushing *p, const contact *c)
{
  const vsc_obstacle *obstacle = &p->touch->model->obstacles[c->obstacle];
  if (p->before == NULL || obstacle->kind == VSC_OBSTACLE_PLANE) return c->gap;
  const double *before = p->before + 4 * (size_t)c->node;
  double normal[3], way[3];
  const double gap = vsc_obstacle_gap(obstacle, c->point, before, normal);
  vsc_subtract(p->x + 4 * (size_t)c->node, before, way);
  return gap + vsc_dot(normal, way);
}

static void push(void *context, const contact *c)
{
  const pushing *p = context;
  const double l = p->touch->multiplier[c->pair];
  const double t = l - c->stiffness * foretold_gap(p, c) > 0 ? l - c->stiffness * c->gap : 0;
  p->touch->force[c->pair] = t;
  for (size_t i = 0; i < 3; i++) p->r[4 * (size_t)c->node + i] += t * c->push[i];
}

void vsc_touch_push(vsc_touch *touch, const double *x, const double *before, double *r)
{
  if (touch == NULL) return;
  memset(touch->force, 0, vsc_state_contacts(touch->model) * sizeof *touch->force);
  visit_all(touch, x, touch->time, push, &(pushing){touch, x, before != NULL ? before : touch->from, r});
}

typedef struct stiffening {
  const vsc_touch *touch;
  vsc_tangent *tangent;
} stiffening;

static void stiffen(void *context, const contact *c)
{
  const stiffening *s = context;
  const double l = s->touch->multiplier[c->pair], bend = c->bend * l;
  double block[9];
  if (s->touch->force[c->pair] == 0 && l < c->stiffness * (c->gap - TOUCHING * s->touch->size)) return;
  // k d d^T - l bend (1 - d d^T)
  for (int r = 0; r < 3; r++)
    for (int q = 0; q < 3; q++)
      block[3 * r + q] = (c->stiffness + bend) * c->push[r] * c->push[q] - (r == q ? bend : 0);
  vsc_block_matrix_add(&s->tangent->matrix, c->node, c->node, 1, block);
}

void vsc_touch_tangent(const vsc_touch *touch, const double *x, vsc_tangent *tangent)
{
  if (touch == NULL) return;
  visit_all(touch, x, touch->time, stiffen, &(stiffening){touch, tangent});
}

typedef struct passage {
  const double *x, *next;  // node_count x 4
  const vsc_touch *touch;
  bool found;
  contact at;
} passage;

// The point of the way nearest to the centre is at the part s = -(x - c) . w/|w|^2 of the way w.
static void find_passage(void *context, const contact *c)
{
  passage *p = context;
  const vsc_obstacle *obstacle = &p->touch->model->obstacles[c->obstacle];
  double from[3], way[3];
  if (p->found || obstacle->kind != VSC_OBSTACLE_SPHERE) return;
  for (int i = 0; i < 3; i++) {
    from[i] = (c->gap + obstacle->radius) * c->normal[i];
    way[i] = p->next[4 * (size_t)c->node + (size_t)i] - p->x[4 * (size_t)c->node + (size_t)i];
  }
  const double square = vsc_dot(way, way);
  const double part = square > 0 ? fmin(fmax(-vsc_dot(from, way) / square, 0), 1) : 0;
  for (int i = 0; i < 3; i++) from[i] += part * way[i];
  p->found = vsc_norm(from) < 0.5 * obstacle->radius;
  p->at = *c;
}

bool vsc_touch_goes_through(const vsc_touch *touch, const double *x, const double *next, char *what, size_t size)
{
  passage p = {.touch = touch, .x = x, .next = next};
  char node[VSC_NODE_TEXT];
  if (touch == NULL) return false;
  visit_all(touch, x, touch->time, find_passage, &p);
  if (p.found)
    snprintf(what, size, "%s, would go through obstacles[%zu]",
             vsc_name_node(touch->model, p.at.node, node, sizeof node), p.at.obstacle);
  return p.found;
}

// ---- multipliers

typedef struct worst {
  const vsc_touch *touch;
  double off;  // the largest |g| of nodes with a force, mm
  contact at;
} worst;

static void find_worst(void *context, const contact *c)
{
  worst *w = context;
  if (w->touch->force[c->pair] == 0 || fabs(c->gap) <= w->off) return;
  w->off = fabs(c->gap);
  w->at = *c;
}

bool vsc_touch_update(vsc_touch *touch, const double *x)
{
  worst w = {.touch = touch};
  bool pulled = false;
  visit_all(touch, x, touch->time, find_worst, &w);
  for (size_t k = 0; k < vsc_state_contacts(touch->model); k++) {
    pulled |= touch->force[k] < 0;
    touch->multiplier[k] = fmax(touch->force[k], 0);
  }
  if (w.off > SLOWLY * touch->off) touch->raise = fmin(RAISE * touch->raise, MOST_RAISE);
  const bool settled = w.off <= DEEPEST * touch->size && !pulled;
  touch->off = settled ? INFINITY : w.off;
  touch->from = NULL;
  return settled;
}

double vsc_touch_norm(const vsc_touch *touch)
{
  double sum = 0;
  for (size_t k = 0; k < vsc_state_contacts(touch->model); k++) sum += touch->force[k] * touch->force[k];
  return sqrt(sum);
}

vsc_status vsc_touch_fail(const vsc_touch *touch, const double *x, vsc_error *error)
{
  worst w = {.touch = touch};
  char node[VSC_NODE_TEXT];
  visit_all(touch, x, touch->time, find_worst, &w);
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms %s, is still %.3g mm %s obstacles[%zu] after %d rounds of multipliers; give it more room "
                  "between obstacles and supports, or a smaller motion of the obstacle", touch->time,
                  vsc_name_node(touch->model, w.at.node, node, sizeof node), w.off,
                  w.at.gap < 0 ? "inside" : "off", w.at.obstacle, VSC_MOST_ROUNDS);
}

// ---- what obstacles do, in equilibria

typedef struct sum {
  const vsc_touch *touch;
  double force[VSC_MOST_OBSTACLES][3];
} sum;

static void add_force(void *context, const contact *c)
{
  sum *s = context;
  for (int i = 0; i < 3; i++) s->force[c->obstacle][i] += s->touch->force[c->pair] * c->normal[i];
}

// The way of an obstacle in the step of dt that ends at the touch's time.
static void find_way(const vsc_touch *touch, size_t o, double dt, double way[3])
{
  double now[3], former[3];
  vsc_obstacle_place(&touch->model->obstacles[o], touch->time, now);
  vsc_obstacle_place(&touch->model->obstacles[o], touch->time - dt, former);
  vsc_subtract(now, former, way);
}

static void keep(const vsc_touch *touch, vsc_state *state)
{
  memcpy(state->touch, touch->force, vsc_state_contacts(touch->model) * sizeof *state->touch);
}

void vsc_touch_reckon(const vsc_touch *touch, vsc_state *state, double dt)
{
  if (touch == NULL) return;
  sum s = {.touch = touch};
  visit_all(touch, state->x, touch->time, add_force, &s);
  for (size_t o = 0; o < touch->model->obstacle_count; o++) {
    vsc_contact_sums *sums = &state->contact[o];
    double way[3];
    find_way(touch, o, dt, way);
    for (int i = 0; i < 3; i++) {
      const double mean = 0.5 * (s.force[o][i] + sums->force[i]);
      sums->work += mean * way[i];
      sums->impulse[i] += mean * dt;
      sums->force[i] = s.force[o][i];
    }
  }
  keep(touch, state);
}

// ---- implicit steps

typedef struct stepping {
  const vsc_touch *touch;
  vsc_state *state;
  const double *x;   // node_count x 4
  double *vector;    // likewise
  double factor, dt;
  double way[VSC_MOST_OBSTACLES][3];  // of each obstacle in the step, mm; or its velocity at the end, mm/ms
} stepping;

static void put_out(void *context, const contact *c)
{
  const stepping *s = context;
  const double *inverse = s->touch->model->inverse_mass + 4 * (size_t)c->node;
  for (size_t i = 0; i < 3; i++)
    if (c->gap < 0 && inverse[i] != 0) s->vector[4 * (size_t)c->node + i] -= c->gap / c->free * c->normal[i];
}

void vsc_touch_put_out(vsc_touch *touch, double *x)
{
  if (touch == NULL) return;
  visit_all(touch, x, touch->time, put_out, &(stepping){.touch = touch, .vector = x});
}

// The part of `vector` along what is free of the normal, n_f: (v . n_f) n_f/|n_f|^2.
static void part_along(const stepping *s, const contact *c, const double *vector, double part[3])
{
  const double *inverse = s->touch->model->inverse_mass + 4 * (size_t)c->node;
  double along = 0;
  for (int i = 0; i < 3; i++)
    if (inverse[i] != 0) along += vector[i] * c->normal[i] / c->free;
  for (int i = 0; i < 3; i++) part[i] = inverse[i] != 0 ? along * c->normal[i] : 0;
}

static void take_part(void *context, const contact *c)
{
  const stepping *s = context;
  const size_t at = 4 * (size_t)c->node;
  double part[3];
  if (!(s->state->touch[c->pair] > 0)) return;
  part_along(s, c, s->x + at, part);
  for (size_t i = 0; i < 3; i++) s->vector[at + i] += part[i];
}

void vsc_touch_part(const vsc_touch *touch, vsc_state *state, const double *vector, double *part)
{
  if (touch == NULL) return;
  stepping s = {.touch = touch, .state = state, .x = vector, .vector = part};
  memset(part, 0, 4 * touch->model->node_count * sizeof *part);
  visit_all(touch, state->x, state->time, take_part, &s);
}

static void kick(void *context, const contact *c)
{
  const stepping *s = context;
  const size_t at = 4 * (size_t)c->node;
  const double R = s->factor * s->touch->force[c->pair];
  for (size_t i = 0; i < 3; i++) s->vector[at + i] += R * s->touch->model->inverse_mass[at + i] * c->push[i];
}

void vsc_touch_kick(const vsc_touch *touch, const double *x, double factor, double *vector)
{
  if (touch == NULL) return;
  visit_all(touch, x, touch->time, kick, &(stepping){.touch = touch, .vector = vector, .factor = factor});
}

static void strike(void *context, const contact *c)
{
  const stepping *s = context;
  double *vector = s->vector + 4 * (size_t)c->node, part[3];
  if (!(s->touch->force[c->pair] > 0)) return;
  part_along(s, c, vector, part);
  for (int i = 0; i < 3; i++) vector[i] -= part[i];
}

void vsc_touch_strike(const vsc_touch *touch, const double *x, double *vector)
{
  if (touch == NULL) return;
  visit_all(touch, x, touch->time, strike, &(stepping){.touch = touch, .vector = vector});
}

static void add_push(void *context, const contact *c)
{
  const stepping *s = context;
  for (size_t i = 0; i < 3; i++)
    s->vector[4 * (size_t)c->node + i] += s->factor * s->touch->force[c->pair] * c->push[i];
}

void vsc_touch_add(const vsc_touch *touch, const double *x, double push, double *force)
{
  if (touch == NULL) return;
  visit_all(touch, x, touch->time, add_push, &(stepping){.touch = touch, .vector = force, .factor = push});
}

static void reckon(void *context, const contact *c)
{
  const stepping *s = context;
  vsc_contact_sums *sums = &s->state->contact[c->obstacle];
  const double *way = s->way[c->obstacle];
  double moved[3];
  vsc_subtract(s->x + 4 * (size_t)c->node, s->state->x + 4 * (size_t)c->node, moved);
  for (int i = 0; i < 3; i++) {
    const double F = s->factor * s->touch->force[c->pair] * c->push[i];
    sums->impulse[i] += F * s->dt;
    sums->work += F * way[i];
    sums->lost += F * (way[i] - moved[i]);
  }
}

void vsc_touch_reckon_step(const vsc_touch *touch, vsc_state *state, const double *x, double dt, double push)
{
  if (touch == NULL) return;
  stepping s = {.touch = touch, .state = state, .x = x, .factor = push, .dt = dt};
  for (size_t o = 0; o < touch->model->obstacle_count; o++) find_way(touch, o, dt, s.way[o]);
  visit_all(touch, x, touch->time, reckon, &s);
}

static void stop(void *context, const contact *c)
{
  const stepping *s = context;
  const vsc_model *model = s->touch->model;
  const size_t at = 4 * (size_t)c->node;
  if (!(s->touch->force[c->pair] > 0)) return;
  vsc_contact_sums *sums = &s->state->contact[c->obstacle];
  const double *speed = s->way[c->obstacle];
  double *v = s->state->v + at, slip[3];
  vsc_subtract(v, speed, slip);
  // a node that was stopped before has not hit the obstacle: the scheme has made its slip
  const bool hits = !(s->state->touch[c->pair] > 0);
  const double away = vsc_dot(slip, c->normal) / c->free;
  for (size_t i = 0; i < 3; i++) {
    if (model->inverse_mass[at + i] == 0) continue;
    const double change = -away * c->normal[i], impulse = model->mass[c->node] * change;
    sums->impulse[i] += impulse;
    sums->work += impulse * speed[i];
    if (hits) sums->lost += impulse * (speed[i] - v[i] - 0.5 * change);
    v[i] += change;
  }
}

void vsc_touch_stop(const vsc_touch *touch, vsc_state *state, double dt)
{
  if (touch == NULL) return;
  const vsc_model *model = touch->model;
  stepping s = {.touch = touch, .state = state};
  for (size_t o = 0; o < model->obstacle_count; o++) {
    const vsc_obstacle *obstacle = &model->obstacles[o];
    const double rate = vsc_moving_rate(model, &obstacle->curve, touch->time, dt);
    for (int i = 0; i < 3; i++) s.way[o][i] = rate * obstacle->motion[i];
  }
  visit_all(touch, state->x, touch->time, stop, &s);
  keep(touch, state);
}
