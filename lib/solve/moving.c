// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/moving.h"

#include <math.h>

#include "mech/force.h"

#define JUMP 0.1  // of the curve's greatest speed

double vsc_moving_rate(const vsc_model *model, const vsc_curve *curve, double time, double dt)
{
  const double before = vsc_curve_value(curve, time - dt);
  if (curve->period > 0 || time + dt <= model->end_time)
    return (vsc_curve_value(curve, time + dt) - before) / (2 * dt);
  return (3 * vsc_curve_value(curve, time) - 4 * before + vsc_curve_value(curve, time - 2 * dt)) /
         (2 * dt);
}

static bool curve_jumps(const vsc_curve *curve, double from, double to)
{
  const double spacing = curve->spacing;
  double most = 0;
  for (size_t k = 0; k < curve->intervals; k++) most = fmax(most, fabs(curve->values[k + 1] - curve->values[k]));
  for (double k = floor(from / spacing) - 1; k <= ceil(to / spacing) + 1; k++) {
    const double here = vsc_curve_value(curve, k * spacing), before = vsc_curve_value(curve, (k - 1) * spacing);
    if (fabs(vsc_curve_value(curve, (k + 1) * spacing) - 2 * here + before) > JUMP * most) return true;
  }
  return false;
}

bool vsc_moving_jumps(const vsc_model *model, double from, double to)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_curve *curve = &model->moved[s].curve;
    const double known = curve->period > 0 ? to : fmin(to, model->end_time - 3 * curve->spacing);
    if (curve_jumps(curve, from, known)) return true;
  }
  return false;
}

static void give_rate(const vsc_moved *moved, double rate, double *v)
{
  for (size_t k = 0; k < moved->node_count; k++)
    for (size_t i = 0; i < 3; i++)
      if (moved->motion[i] != 0) v[4 * (size_t)moved->nodes[k] + i] = rate * moved->motion[i];
}

// d2c/dt2, 1/ms^2, like the rate.
static double acceleration_of(const vsc_model *model, const vsc_curve *curve, double time, double dt)
{
  const double at = curve->period > 0 || time + dt <= model->end_time ? time : time - dt;
  return (vsc_curve_value(curve, at + dt) - 2 * vsc_curve_value(curve, at) + vsc_curve_value(curve, at - dt)) / (dt * dt);
}

static void add_forces(const vsc_moved *moved, const double *force, double sum[3])
{
  for (int i = 0; i < 3; i++) sum[i] = 0;
  for (size_t k = 0; k < moved->node_count; k++)
    for (size_t i = 0; i < 3; i++) sum[i] += force[4 * (size_t)moved->nodes[k] + i];
}

void vsc_moving_start(const vsc_model *model, vsc_state *state)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    vsc_moved_sums *sums = &state->moved[s];
    *sums = (vsc_moved_sums){.part = vsc_curve_value(&model->moved[s].curve, state->time),
                             .row_time = state->time};
    add_forces(&model->moved[s], state->force, sums->force);
  }
}

void vsc_moving_begin_rates(const vsc_model *model, vsc_state *state, double dt)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_curve *curve = &model->moved[s].curve;
    const double now = vsc_curve_value(curve, state->time);
    give_rate(&model->moved[s], (vsc_curve_value(curve, state->time + dt) - now) / dt, state->v);
  }
}

void vsc_moving_end_rates(const vsc_model *model, vsc_state *state, double dt)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_curve *curve = &model->moved[s].curve;
    give_rate(&model->moved[s], vsc_moving_rate(model, curve, state->time, dt), state->v);
    give_rate(&model->moved[s], acceleration_of(model, curve, state->time, dt), state->a);
  }
}

void vsc_moving_begin_loaded(const vsc_model *model, vsc_state *state)
{
  if (model->moved_count == 0) return;
  vsc_force(model, state->x, NULL, state->time, &state->scratch, state->force);
  vsc_moving_start(model, state);
}

void vsc_moving_place(const vsc_model *model, vsc_state *state, double dt)
{
  vsc_supports_place(model, state->time, 1, state->x);
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_moved *moved = &model->moved[s];
    const double part = vsc_curve_value(&moved->curve, state->time);
    give_rate(moved, (part - state->moved[s].part) / dt, state->v);
    if (model->terms.damping)
      give_rate(moved, vsc_moving_rate(model, &moved->curve, state->time, dt), state->scratch.predicted);
  }
}

void vsc_moving_account(const vsc_model *model, vsc_state *state, double dt, bool last)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_moved *moved = &model->moved[s];
    vsc_moved_sums *sums = &state->moved[s];
    const double part = vsc_curve_value(&moved->curve, state->time);
    const double rate = vsc_moving_rate(model, &moved->curve, state->time, dt);
    double force[3];
    add_forces(moved, state->force, force);
    for (int i = 0; i < 3; i++) {
      const double motion = moved->motion[i], mean = 0.5 * (force[i] + sums->force[i]);
      // of the kinetic energy's and the momentum's change, what the other forces have not done
      sums->work += 0.5 * moved->mass * motion * motion * (rate * rate - sums->rate * sums->rate) -
                    mean * motion * (part - sums->part);
      if (moved->held[i])
        sums->impulse[i] += moved->mass * motion * (rate - sums->rate) - mean * dt;
      sums->force[i] = force[i];
    }
    sums->part = part;
    sums->rate = rate;
    if (last) give_rate(moved, rate, state->v);
  }
}

void vsc_moving_reckon(const vsc_model *model, vsc_state *state, const double *force, double load,
                       double dt)
{
  for (size_t s = 0; s < model->moved_count; s++) {
    const vsc_moved *moved = &model->moved[s];
    vsc_moved_sums *sums = &state->moved[s];
    const double part = load * vsc_curve_value(&moved->curve, state->time);
    double now[3];
    add_forces(moved, force, now);
    for (int i = 0; i < 3; i++) {
      const double mean = 0.5 * (now[i] + sums->force[i]);
      sums->work -= mean * moved->motion[i] * (part - sums->part);
      if (moved->held[i]) sums->impulse[i] -= mean * dt;
      sums->force[i] = now[i];
    }
    sums->part = part;
  }
}
