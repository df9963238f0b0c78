// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/implicit.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "mech/force.h"
#include "mech/prony.h"
#include "model/calm.h"
#include "solve/moving.h"

#define FIRST_STEP 1.0      // ms, unless the way is shorter
#define SHORTEST_STEP 1e-6  // part of the way to the next stop
#define LONGER 2.0
#define SHORTER 0.4

// Numbers of a scheme for one step.
typedef struct scheme {
  double mass_past, force_past;  // m, f
  double A, V;                   // 1/ms^2, 1/ms
  double error;                  // c
  double push;                   // of contact (touch.h): F/R, and what accelerations and velocities get of R/M
  double kick[2];                // beside A x_1 + h_a and V x_1 + h_v; 1, ms
  double lag;                    // of v_1 = V (x_1 - x_0 - dt v_0) + v_0 + lag a_0, ms
} scheme;

typedef struct stepper {
  vsc_newton *newton;
  vsc_implicit_counts counts;
  double *h_a, *h_v;          // node_count x 4
  double *middle, *velocity, *middle_a;  // where forces balance
  double *next;               // x_1
  double push;                // F/R of contact in the last step (touch.h)
  double *stopped;            // what of a_0 obstacles stop
} stepper;

static void release(void *solver)
{
  stepper *s = solver;
  vsc_newton_free(s->newton);
  vsc_free(s->h_a);
  vsc_free(s->h_v);
  vsc_free(s->middle);
  vsc_free(s->velocity);
  vsc_free(s->middle_a);
  vsc_free(s->next);
  vsc_free(s->stopped);
  vsc_free(s);
}

vsc_newton *vsc_implicit_newton(vsc_state *state)
{
  return ((stepper *)state->solver)->newton;
}

vsc_implicit_counts vsc_implicit_counted(const vsc_state *state)
{
  return ((const stepper *)state->solver)->counts;
}

// M a = f, with the pressures of kept volumes
static vsc_status first_acceleration(const vsc_model *model, vsc_state *state, vsc_newton *newton,
                                     vsc_error *error)
{
  bool indefinite;
  vsc_kept_look(newton->kept, state->x);
  vsc_status status = vsc_kept_settle(newton->kept, state->v, error);
  if (status != VSC_OK) return status;
  vsc_force(model, state->x, state->v, state->time, &state->scratch, state->force);
  for (size_t i = 0; i < 4 * model->node_count; i++)
    state->a[i] = model->inverse_mass[i] * state->force[i];
  if (model->masses != VSC_MASS_CONSISTENT && newton->kept == NULL) return VSC_OK;
  vsc_tangent_assemble(model, newton->tangent, state->x, NULL, NULL, state->time, 0, 0, &state->scratch);
  vsc_tangent_add_masses(model, newton->tangent, 1);
  // pressures are 0 so far
  vsc_kept_add_force(newton->kept, state->x, state->force);
  vsc_kept_look_moving(newton->kept, state->x, state->v);
  status = vsc_kept_solve(newton->kept, newton->linear, newton->tangent, model->inverse_mass, state->x, state->force,
                          1e-12, state->a, &indefinite, error);
  vsc_kept_advance(newton->kept, 1);
  vsc_kept_give(newton->kept, state);
  vsc_linear_forget(newton->linear);
  if (status == VSC_OK && vsc_linear_counted(newton->linear).unfinished > 0)
    return vsc_fail(error, VSC_NUMERICAL, "the accelerations at the start were not found: masses are too unequal; use masses: "
                    "lumped, or a better mesh");
  return status;
}

vsc_status vsc_implicit_start(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  const size_t count = 4 * model->node_count;
  stepper *s;
  if (!VSC_NEW(s, 1)) return vsc_fail_memory(error, "implicit steps");
  vsc_status status = vsc_newton_create(model, &s->newton, error);
  if (status == VSC_OK &&
      (!VSC_NEW(s->h_a, count) || !VSC_NEW(s->h_v, count) || !VSC_NEW(s->middle, count) ||
       !VSC_NEW(s->velocity, count) || !VSC_NEW(s->middle_a, count) || !VSC_NEW(s->next, count) ||
       !VSC_NEW(s->stopped, model->obstacle_count > 0 ? count : 0)))
    status = vsc_fail_memory(error, "implicit steps");
  if (status != VSC_OK) {
    release(s);
    return status;
  }
  state->solver = s;
  state->release_solver = release;
  state->limit.step = model->step > 0 ? model->step : fmin(FIRST_STEP, model->end_time);
  vsc_supports_place(model, state->time, 1, state->x);
  vsc_moving_begin_rates(model, state, state->limit.step);
  if (model->branch_count > 0) vsc_prony_step(model, state, 0);
  status = first_acceleration(model, state, s->newton, error);
  if (status == VSC_OK && model->moved_count > 0) {
    vsc_tangent_masses_times(model, s->newton->tangent, -1, state->a, state->force);
    vsc_moving_start(model, state);
  }
  return status;
}

// ---- one step

typedef struct step {
  const vsc_model *model;
  vsc_state *state;
  stepper *s;
  scheme scheme;
  double time;  // at which forces balance, ms
  double end;   // ms
} step;

// The scheme's numbers, and into h_a and h_v what it takes from the past.
static scheme prepare(const vsc_model *model, const vsc_state *state, stepper *s, double dt)
{
  const vsc_solve_def *def = &model->solve;
  const size_t count = 4 * model->node_count;
  if (def->scheme == VSC_SCHEME_BDF2) {
    // y' = (c_1 y_1 - c_0 y_0 + c y_-1)/dt; a first step has no past: backward Euler
    const double ratio = state->former_step > 0 ? dt / state->former_step : 0;
    const double first = (1 + 2 * ratio) / (1 + ratio), second = 1 + ratio;
    const double third = ratio * ratio / (1 + ratio);
    const scheme bdf = {.A = first * first / (dt * dt), .V = first / dt, .error = 2.0 / 9};
    for (size_t i = 0; i < count; i++) {
      s->h_v[i] = (third * state->former_x[i] - second * state->x[i]) / dt;
      const double past = (third * state->former_v[i] - second * state->v[i]) / dt;
      s->h_a[i] = bdf.V * s->h_v[i] + past;
    }
    return bdf;
  }
  const bool damped = def->scheme == VSC_SCHEME_GENERALIZED_ALPHA;
  const double m = damped ? (2 * def->rho - 1) / (def->rho + 1) : 0;
  const double f = damped ? def->rho / (def->rho + 1) : 0;
  const double gamma = 0.5 - m + f, beta = 0.25 * (1 - m + f) * (1 - m + f);
  const scheme newmark = {.mass_past = m, .force_past = f, .A = 1 / (beta * dt * dt),
                          .V = gamma / (beta * dt), .error = fabs(beta - 1.0 / 6), .push = 2 * beta / (1 - m),
                          .kick = {-1 / (1 - m), dt * (2 * beta - gamma) / (1 - m)},
                          .lag = dt * (1 - gamma / (2 * beta))};
  for (size_t i = 0; i < count; i++) {
    const double a0 = state->a[i], v0 = state->v[i];
    s->h_a[i] = -newmark.A * (state->x[i] + dt * v0) - (0.5 / beta - 1) * a0;
    s->h_v[i] = v0 + dt * ((1 - gamma) * a0 + gamma * s->h_a[i]);
  }
  return newmark;
}

// r = f - M [(1 - m) a_1 + m a_0]
static void residual(void *context, const double *x, double *r)
{
  const step *p = context;
  const vsc_state *state = p->state;
  const scheme *c = &p->scheme;
  const double part = 1 - c->force_past;
  for (size_t i = 0; i < 4 * p->model->node_count; i++) {
    p->s->middle[i] = part * x[i] + c->force_past * state->x[i];
    p->s->velocity[i] = part * (c->V * x[i] + p->s->h_v[i]) + c->force_past * state->v[i];
  }
  // what rests on an obstacle has a_0, of which viscosity must not see the way
  for (size_t i = 0; p->model->obstacle_count > 0 && i < 4 * p->model->node_count; i++)
    p->s->velocity[i] -= part * c->lag * p->s->stopped[i];
  vsc_force(p->model, p->s->middle, p->s->velocity, p->time, &p->state->scratch, r);
  vsc_kept_add_force(p->s->newton->kept, p->s->middle, r);
  double *a = p->s->middle_a;
  for (size_t i = 0; i < 4 * p->model->node_count; i++)
    a[i] = (1 - c->mass_past) * (c->A * x[i] + p->s->h_a[i]) + c->mass_past * state->a[i];
  vsc_tangent_masses_times(p->model, p->s->newton->tangent, -1, a, r);
}

// (1 - f) (K + V C) + (1 - m) A M
static void assemble(void *context, const double *x, const double *before, vsc_tangent *tangent)
{
  (void)x;
  const step *p = context;
  const scheme *c = &p->scheme;
  const double part = 1 - c->force_past;
  double *middle = p->s->middle_a;  // of the iterate before
  for (size_t i = 0; before != NULL && i < 4 * p->model->node_count; i++)
    middle[i] = part * before[i] + c->force_past * p->state->x[i];
  vsc_tangent_assemble(p->model, tangent, p->s->middle,
                       p->model->terms.damping ? p->s->velocity : NULL,
                       before != NULL ? middle : NULL, p->time, part, part * c->V,
                       &p->state->scratch);
  vsc_kept_add_tangent(p->s->newton->kept, p->s->middle, part, &tangent->matrix);
  vsc_tangent_add_masses(p->model, tangent, (1 - c->mass_past) * c->A);
}

static vsc_culprit blame(void *context, const double *x, size_t node)
{
  (void)x;
  const step *p = context;
  double force[3];
  vsc_culprit culprit =
      vsc_find_culprit(p->model, p->s->middle, p->s->velocity, p->time, &p->state->scratch, node);
  for (size_t i = 0; i < 3; i++) force[i] = p->model->mass[node] * p->s->middle_a[4 * node + i];
  vsc_culprit_weigh(&culprit, "inertia", force);
  return culprit;
}

// Where the state is, as far as supports and obstacles let it.
static void stay(void *context, double *x)
{
  const step *p = context;
  memcpy(x, p->state->x, 4 * p->model->node_count * sizeof *x);
  vsc_touch_put_out(p->s->newton->touch, x);
  vsc_supports_place(p->model, p->end, 1, x);
}

// Where the state leads, unless that turns an element inside out.
static void predict(const vsc_model *model, const vsc_state *state, double dt, stepper *s)
{
  double *x = s->next;
  uint32_t element;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    x[i] = state->x[i] +
           (model->inverse_mass[i] != 0 ? dt * (state->v[i] + 0.5 * dt * state->a[i]) : 0);
  for (size_t i = 0; model->obstacle_count > 0 && i < 4 * model->node_count; i++)
    x[i] -= 0.5 * dt * dt * s->stopped[i];
  vsc_touch_put_out(s->newton->touch, x);
  if (vsc_smallest_ratio(model, x, &element) <= 0)
    memcpy(x, state->x, 4 * model->node_count * sizeof *x);
  vsc_supports_place(model, state->time + dt, 1, x);
}

// Into middle_a: a_1.
static void end_acceleration(const step *p)
{
  for (size_t i = 0; i < 4 * p->model->node_count; i++)
    p->s->middle_a[i] = p->scheme.A * p->s->next[i] + p->s->h_a[i];
  vsc_touch_kick(p->s->newton->touch, p->s->next, p->scheme.kick[0], p->s->middle_a);
}

// c dt^2 rms |a_1 - a_0|, mm; without what goes into obstacles, which is not free to be off. Overwrites `velocity`.
static double step_error(const step *p, double dt)
{
  const vsc_model *model = p->model;
  double *change = p->s->velocity, sum = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    change[i] = model->inverse_mass[i] == 0 ? 0 : p->s->middle_a[i] - p->state->a[i];
  vsc_touch_strike(p->s->newton->touch, p->s->next, change);
  for (size_t i = 0; i < 4 * model->node_count; i++) sum += change[i] * change[i];
  return p->scheme.error * dt * dt * sqrt(sum / (double)model->node_count);
}

static vsc_status accept(const step *p, double dt, vsc_error *error)
{
  vsc_state *state = p->state;
  p->s->push = p->scheme.push;
  vsc_touch_reckon_step(p->s->newton->touch, state, p->s->next, dt, p->scheme.push);
  const bool remembers = p->model->solve.scheme == VSC_SCHEME_BDF2;
  for (size_t i = 0; i < 4 * p->model->node_count; i++) {
    const bool rests = p->model->inverse_mass[i] == 0 && p->s->next[i] == state->x[i] && state->v[i] == 0;
    if (remembers) {
      state->former_x[i] = state->x[i];
      state->former_v[i] = state->v[i];
    }
    state->v[i] = rests ? 0 : p->scheme.V * p->s->next[i] + p->s->h_v[i];
    state->a[i] = rests ? 0 : p->s->middle_a[i];
  }
  vsc_touch_kick(p->s->newton->touch, p->s->next, p->scheme.kick[1], state->v);
  memcpy(state->x, p->s->next, 4 * p->model->node_count * sizeof *state->x);
  if (remembers) state->former_step = dt;
  if (p->model->branch_count > 0) vsc_prony_step(p->model, state, dt);
  vsc_touch_stop(p->s->newton->touch, state, dt);
  vsc_kept_give(p->s->newton->kept, state);
  // Newmark's velocities would swing about what keeps volumes; backward differences do not
  return remembers ? VSC_OK : vsc_kept_settle(p->s->newton->kept, state->v, error);
}

// What supports that move have done in the step of dt that has led to the state: f - M a is what their own
// force balances.
static void reckon_supports(const vsc_model *model, vsc_state *state, double dt)
{
  const stepper *s = state->solver;
  if (model->moved_count == 0) return;
  vsc_force(model, state->x, state->v, state->time, &state->scratch, state->force);
  vsc_tangent_masses_times(model, s->newton->tangent, -1, state->a, state->force);
  vsc_touch_add(s->newton->touch, state->x, s->push, state->force);
  vsc_moving_reckon(model, state, state->force, 1, dt);
}

static vsc_status do_step(const vsc_model *model, vsc_state *state, double dt, double *allowed,
                          bool *done, vsc_error *error)
{
  stepper *s = state->solver;
  step p = {model, state, s, prepare(model, state, s, dt), 0, state->time + dt};
  p.time = state->time + (1 - p.scheme.force_past) * dt;
  const vsc_balance balance = {&p, residual, assemble, stay, blame};
  vsc_touch_begin(s->newton->touch, state, state->time + dt, true, 1 - p.scheme.force_past,
                  (1 - p.scheme.mass_past) * p.scheme.A);
  vsc_touch_part(s->newton->touch, state, state->a, s->stopped);
  predict(model, state, dt, s);
  vsc_kept_take(s->newton->kept, state);
  int iterations;
  *done = false;
  state->scratch.prony_step = (1 - p.scheme.force_past) * dt;
  const vsc_status status =
      vsc_newton_solve(s->newton, &balance, p.time, 1, s->next, &iterations, error);
  state->scratch.prony_step = 0;
  if (status != VSC_OK) {
    s->counts.failed += status == VSC_NUMERICAL;
    *allowed = SHORTER * dt;
    return status;
  }
  end_acceleration(&p);
  if (!(model->step > 0)) {
    const double most = model->solve.accuracy * s->newton->size, now = step_error(&p, dt);
    const double factor = now > 0 ? 0.9 * cbrt(most / now) : LONGER;
    *allowed = dt * fmax(fmin(factor, LONGER), SHORTER);
    if (now > most) {
      s->counts.rejected++;
      return VSC_OK;
    }
  }
  s->counts.steps++;
  *done = true;
  return accept(&p, dt, error);
}

vsc_status vsc_implicit_to(const vsc_model *model, vsc_state *state, double until, vsc_error *error)
{
  stepper *s = state->solver;
  const double way = until - state->time;
  vsc_force(model, state->x, state->v, until, &state->scratch, state->force);
  vsc_newton_begin(s->newton, state->force);
  while (state->time < until * (1 - 1e-12)) {
    const double rest = until - state->time;
    double longest = fmin(state->limit.step, rest);
    if (!(model->step > 0)) longest = vsc_model_calm(model, state->x, state->time, longest);
    const double parts = fmax(ceil(rest / longest * (1 - 1e-9)), 1);
    const double dt = rest / parts;
    double allowed = model->step > 0 ? model->step : state->limit.step;
    bool done;
    const vsc_status status = do_step(model, state, dt, &allowed, &done, error);
    if (status != VSC_OK && (status != VSC_NUMERICAL || allowed < SHORTEST_STEP * way)) return status;
    state->limit.step = allowed;
    if (!done) continue;
    state->steps++;
    if (model->step > 0) state->part = dt;
    state->time = parts == 1 ? until : state->time + dt;
    if (model->solve.scheme != VSC_SCHEME_BDF2) vsc_moving_end_rates(model, state, dt);
    reckon_supports(model, state, dt);
  }
  return VSC_OK;
}
