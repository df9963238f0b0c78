// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/lost.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "solve/explicit.h"

// The last two states in which all is finite: places now, velocities and accelerations now and before (node_count x 4).
typedef struct past {
  double *x, *v, *a, *former_v, *former_a;
  double time, dt;  // ms; dt: from the one to the other, 0 where there is but one
} past;

static void release(past *p)
{
  vsc_free(p->x);
  vsc_free(p->v);
  vsc_free(p->a);
  vsc_free(p->former_v);
  vsc_free(p->former_a);
}

static void keep(const vsc_model *model, const vsc_state *state, past *p)
{
  const size_t bytes = 4 * model->node_count * sizeof *p->x;
  memcpy(p->former_v, p->v, bytes);
  memcpy(p->former_a, p->a, bytes);
  memcpy(p->x, state->x, bytes);
  memcpy(p->v, state->v, bytes);
  memcpy(p->a, state->a, bytes);
  p->dt = state->time - p->time;
  p->time = state->time;
}

static bool is_finite(const vsc_state *state, size_t node)
{
  for (size_t i = 4 * node; i < 4 * node + 3; i++)
    if (!isfinite(state->x[i]) || !isfinite(state->v[i])) return false;
  return true;
}

// Without overflow where squares would.
static double size_of(const double *a)
{
  return hypot(hypot(a[0], a[1]), a[2]);
}

// Of the nodes that are lost the one that was accelerated most; those that are held were not.
static size_t first_of(const vsc_model *model, const vsc_state *state, const past *p)
{
  size_t first = vsc_state_find_bad(model, state);
  double most = size_of(p->a + 4 * first);
  for (size_t n = first + 1; n < model->node_count; n++) {
    const double size = size_of(p->a + 4 * n);
    if (is_finite(state, n) || !(size > most)) continue;
    first = n;
    most = size;
  }
  return first;
}

// What obstacles and kept volumes did in the last good step is what forces do not explain of its velocities.
static void weigh_restraints(const vsc_model *model, const past *p, size_t node, vsc_culprit *culprit)
{
  const char *name = model->kept.count == 0       ? "an obstacle"
                     : model->obstacle_count == 0 ? "a kept volume"
                                                  : "an obstacle or a kept volume";
  double force[3];
  if (model->obstacle_count + model->kept.count == 0 || !(p->dt > 0)) return;
  for (size_t i = 0; i < 3; i++) {
    const size_t k = 4 * node + i;
    force[i] = model->mass[node] * ((p->v[k] - p->former_v[k]) / p->dt - 0.5 * (p->a[k] + p->former_a[k]));
  }
  vsc_culprit_weigh(culprit, name, force);
}

static bool search(const vsc_model *model, vsc_state *state, double until, past *p, vsc_lost *lost)
{
  keep(model, state, p);
  p->dt = 0;
  while (state->time < until * (1 - 1e-12)) {
    const double dt = model->step > 0 ? model->step : state->limit.caution * state->limit.step;
    const vsc_status status = vsc_advance(model, state, fmin(state->time + dt, until), NULL);
    if (vsc_state_find_bad(model, state) < model->node_count) {
      *lost = (vsc_lost){state->time, state->steps, first_of(model, state, p), {0}};
      lost->culprit = vsc_find_culprit(model, p->x, p->v, p->time, &state->scratch, lost->node);
      weigh_restraints(model, p, lost->node, &lost->culprit);
      return true;
    }
    if (status != VSC_OK) return false;
    keep(model, state, p);
  }
  return false;
}

bool vsc_find_lost(const vsc_model *model, vsc_state *state, double until, vsc_lost *lost)
{
  const size_t count = 4 * model->node_count;
  past p = {.time = state->time};
  const bool found = VSC_NEW(p.x, count) && VSC_NEW(p.v, count) && VSC_NEW(p.a, count) && VSC_NEW(p.former_v, count) &&
                     VSC_NEW(p.former_a, count) && search(model, state, until, &p, lost);
  release(&p);
  return found;
}
