// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/explicit.h"

#include <math.h>
#include <string.h>

#include "base/parallel.h"
#include "mech/coupled_mass.h"
#include "mech/culprit.h"
#include "mech/force.h"
#include "mech/prony.h"
#include "mech/step_limit.h"
#include "model/law_constants.h"
#include "model/small_strain.h"
#include "solve/contact.h"
#include "solve/keep_volume.h"
#include "solve/moving.h"

// The step is re-estimated at intervals between these, ms: twice as late while the eigenvalue stays
// within 2 %, twice as soon when it moved by more than 10 %.
#define SHORTEST_TRUST 0.25
#define LONGEST_TRUST 4.0
enum { TRUSTED_STEPS = 128 };  // or as long as these take: an estimate costs as much as five
// An estimate is not trusted for longer than a material's stiffness changes by less than this part with its activity, found
// among so many equal parts of the interval.
#define TRUSTED_CHANGE 0.04
enum { LOOKS_AHEAD = 16 };
// A stable step below this part of the first one, or of that at rest, belongs to a body that is torn or crushed.
#define COLLAPSE 1e-3
// A start is given the time until its first estimate to come back: not below this, where that would take for ever.
#define COLLAPSE_AT_START 1e-4
enum { WARM_ITERATIONS = 4, NODES_PER_PIECE = 256, MOST_TURNS = 20 };

typedef struct motion {
  const vsc_model *model;
  vsc_state *state;
  double dt;
  bool whole;  // whether the forces are added up already
  const vsc_wide *a;  // accelerations where masses are coupled; else NULL
} motion;

// Nodes go in pieces. Each has a slice of the nodes before those that are still, or before those that patches share,
// and one of those behind, so that who does a thread's part of the patches finds what it has just written.
static size_t piece_count(const vsc_model *model)
{
  return (model->node_count - model->still_count + NODES_PER_PIECE - 1) / NODES_PER_PIECE;
}

typedef struct slice {
  size_t first, end;
} slice;

static slice slice_of(const vsc_model *model, size_t piece, bool behind)
{
  const size_t pieces = piece_count(model), before = model->still_count > 0 ? model->still_first : model->own_node_count;
  const size_t first = behind ? before + model->still_count : 0;
  const size_t count = behind ? model->node_count - first : before;
  return (slice){first + count * piece / pieces, first + count * (piece + 1) / pieces};
}

// The three sweeps over the nodes are made of these two.
VSC_INLINE void drift_node(const motion *m, size_t n, vsc_wide a)
{
  vsc_wide *x = (vsc_wide *)m->state->x, *v = (vsc_wide *)m->state->v;
  // v <- v + dt/2 a;  x <- x + dt v
  v[n] += 0.5 * m->dt * a;
  x[n] += m->dt * v[n];
  if (!m->model->terms.damping) return;
  // the velocity at the end of the step, as far as it is known now: v + dt/4 (a + a')
  vsc_wide *past = (vsc_wide *)m->state->past_a;
  ((vsc_wide *)m->state->scratch.predicted)[n] = v[n] + 0.25 * m->dt * (a + past[n]);
  past[n] = a;
}

VSC_INLINE vsc_wide kick_node(const motion *m, size_t n)
{
  // a <- f / m;  v <- v + dt/2 a
  const double *force = m->state->force;
  if (m->model->obstacle_count > 0) ((vsc_wide *)m->state->former)[n] = ((const vsc_wide *)m->state->v)[n];
  const vsc_wide f = m->whole ? ((const vsc_wide *)force)[n] : vsc_node_force(m->model, &m->state->scratch, force, n);
  const vsc_wide a = m->a != NULL ? m->a[n] : ((const vsc_wide *)m->model->inverse_mass)[n] * f;
  ((vsc_wide *)m->state->v)[n] += 0.5 * m->dt * a;
  return a;
}

VSC_CLONED static void drift(void *context, size_t piece, int thread)
{
  (void)thread;
  const motion *m = context;
  for (int behind = 0; behind < 2; behind++) {
    const slice s = slice_of(m->model, piece, behind);
    for (size_t n = s.first; n < s.end; n++) drift_node(m, n, ((const vsc_wide *)m->state->a)[n]);
  }
}

VSC_CLONED static void kick(void *context, size_t piece, int thread)
{
  (void)thread;
  const motion *m = context;
  for (int behind = 0; behind < 2; behind++) {
    const slice s = slice_of(m->model, piece, behind);
    for (size_t n = s.first; n < s.end; n++) ((vsc_wide *)m->state->a)[n] = kick_node(m, n);
  }
}

// The end of one step and the beginning of the next in one sweep.
VSC_CLONED static void kick_and_drift(void *context, size_t piece, int thread)
{
  (void)thread;
  const motion *m = context;
  for (int behind = 0; behind < 2; behind++) {
    const slice s = slice_of(m->model, piece, behind);
    for (size_t n = s.first; n < s.end; n++) drift_node(m, n, kick_node(m, n));
  }
}

// With the momenta M u and the forces f = M u':  u <- u + dt/2 (u' + f / m)
VSC_CLONED static void push_alone(void *context, size_t piece, int thread)
{
  (void)thread;
  const motion *m = context;
  vsc_wide *u = (vsc_wide *)m->state->lone_v, *rate = (vsc_wide *)m->state->lone_a;
  for (int behind = 0; behind < 2; behind++) {
    const slice s = slice_of(m->model, piece, behind);
    for (size_t n = s.first; n < s.end; n++) {
      const vsc_wide a = ((const vsc_wide *)m->model->inverse_mass)[n] * ((const vsc_wide *)m->state->force)[n];
      u[n] += 0.5 * m->dt * (rate[n] + a);
      rate[n] = a;
    }
  }
}

// Accelerations of coupled masses.
static void accelerate(motion *m)
{
  if (m->model->coupled.degree == 0) return;
  vsc_parallel_for(piece_count(m->model), push_alone, m);
  m->a = (const vsc_wide *)vsc_coupled_mass_spread(m->model, &m->state->scratch, m->state->lone_a);
}

// Puts nodes out of obstacles and volumes back to what they were, in turns, since each may disturb the
// other. `first`: of a row of steps, in which a pressure has moved nodes by dt^2/2 of its acceleration, not dt^2.
static vsc_status restrain_all(const vsc_model *model, vsc_state *state, double dt, bool first, bool *touched,
                               vsc_error *error)
{
  if (model->obstacle_count > 0) *touched |= vsc_contact_resolve(model, state, dt, true) > 0;
  if (model->kept.count == 0) return VSC_OK;
  memset(state->kept_pressure, 0, model->kept.count * sizeof *state->kept_pressure);
  for (int turn = 0; turn < MOST_TURNS; turn++) {
    const vsc_status status = vsc_keep_volume(model, state, dt, first, error);
    if (status != VSC_OK) return status;
    if (model->obstacle_count > 0 && vsc_contact_resolve(model, state, dt, false) > 0) {
      *touched = true;
      continue;
    }
    for (size_t k = 0; first && k < model->kept.count; k++) state->kept_pressure[k] *= 2;
    return VSC_OK;
  }
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms contact and kept volumes do not agree after %d turns; use keep_volume: "
                  "region or total, or a smaller load",
                  state->time, MOST_TURNS);
}

// At the first step obstacles may have given impulses at the end of the row before.
static vsc_status restrain(const vsc_model *model, vsc_state *state, double dt, bool first, vsc_error *error)
{
  bool touched = first;
  const vsc_status status = restrain_all(model, state, dt, first, &touched, error);
  if (status == VSC_OK && model->obstacle_count > 0 && touched) vsc_contact_account(model, state);
  return status;
}

// The same of velocities at the end of a row of steps. What is left after all turns the next step takes up.
static vsc_status settle(const vsc_model *model, vsc_state *state, double dt, vsc_error *error)
{
  if (model->obstacle_count > 0) vsc_contact_settle(model, state, dt);
  for (int turn = 0; model->kept.count > 0 && turn < MOST_TURNS; turn++) {
    const vsc_status status = vsc_keep_volume_settle(model, state, dt, error);
    if (status != VSC_OK || model->obstacle_count == 0) return status;
    if (vsc_contact_settle(model, state, dt) == 0) break;
  }
  return VSC_OK;
}

vsc_status vsc_steps(const vsc_model *model, vsc_state *state, double dt, double count,
                     vsc_error *error)
{
  // supports that move and coupled masses look at whole forces
  motion m = {model, state, dt, model->moved_count > 0 || model->coupled.degree > 0, NULL};
  const size_t pieces = piece_count(model);
  const double *velocity = model->terms.damping ? state->scratch.predicted : NULL;
  vsc_parallel_for(pieces, drift, &m);
  for (double k = 1; k <= count; k++) {
    if (vsc_is_set(state->interrupted)) return vsc_fail(error, VSC_SYSTEM, "interrupted");
    state->time += dt;
    state->steps++;
    if (model->moved_count > 0) vsc_moving_place(model, state, dt);
    const vsc_status status = restrain(model, state, dt, k == 1, error);
    if (status != VSC_OK) return status;
    if (model->branch_count > 0) vsc_prony_step(model, state, dt);
    (m.whole ? vsc_force : vsc_force_parts)(model, state->x, velocity, state->time, &state->scratch, state->force);
    if (model->moved_count > 0) vsc_moving_account(model, state, dt, k == count);
    accelerate(&m);
    vsc_parallel_for(pieces, k < count ? kick_and_drift : kick, &m);
  }
  return settle(model, state, dt, error);
}

// The time at which the most is active, for the estimate before the first step; that of the state where
// nothing ever is.
static double busiest_time(const vsc_model *model, const vsc_state *state)
{
  double busiest = state->time, most = 0;
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_curve *curve = &model->materials[m].curve;
    for (size_t k = 0; curve->values && k <= curve->intervals; k++)
      if (curve->values[k] > most) {
        most = curve->values[k];
        busiest = curve->spacing * (double)k + model->materials[m].delay;
      }
  }
  return busiest;
}

// The estimate is not a number where forces or their products overflow.
static vsc_status fail_no_step(bool finite, vsc_error *error)
{
  if (finite)
    return vsc_fail(error, VSC_NUMERICAL,
                    "no stable time step was found: every node is held or nothing is stiff; check "
                    "supports and moduli");
  return vsc_fail(error, VSC_NUMERICAL, "no stable time step was found: the stiffness over the mass is not a finite number; "
                  "check moduli, damping and densities, and their units");
}

// How long an estimate may be trusted, ms.
static double longest_trust(const vsc_limit *limit)
{
  return fmax(LONGEST_TRUST, TRUSTED_STEPS * limit->step);
}

// For how long the estimate is trusted, ms. Of a law of strain the stiffness is that at rest, volume and all, and what
// activity adds to it. Where each element has a delay of its own some are always about to change: what is stiffest hardly
// does.
static double trusted_span(const vsc_model *model, const vsc_limit *limit)
{
  int looks = LOOKS_AHEAD;
  for (size_t m = 0; m < model->material_count && model->delay == NULL; m++) {
    const vsc_material *material = &model->materials[m];
    const vsc_curve *curve = &material->curve;
    if (curve->values == NULL || !vsc_law_is_of_strain(material->law)) continue;
    const double adds = material->active == VSC_ACTIVE_TENSION ? material->tension : material->active_stiffness;
    const double since = limit->time - material->delay, then = vsc_curve_value(curve, since);
    const double passive = vsc_material_stiffest(model, material) + material->volume_modulus + material->stabilization;
    const double most = TRUSTED_CHANGE * (passive + adds * fabs(then));
    for (int k = 1; k < looks; k++) {
      const double change = vsc_curve_value(curve, since + limit->interval * k / LOOKS_AHEAD) - then;
      if (adds * fabs(change) > most) looks = k > 1 ? k - 1 : 1;
    }
  }
  return limit->interval * looks / LOOKS_AHEAD;
}

// The stable step of the body at rest under the part `load` of what it bears. Leaves no trace in the estimate.
static double step_at_rest(const vsc_model *model, vsc_state *state, double load)
{
  const vsc_limit before = state->limit;
  const double borne = state->scratch.load;
  double *x = state->x;
  state->x = (double *)model->rest;
  state->scratch.load = load;
  vsc_limit_refresh(model, state, state->time, vsc_limit_enough(model));
  state->scratch.load = borne;
  state->x = x;
  const double step = state->limit.step;
  state->limit = before;
  memset(state->limit.mode, 0, 4 * model->node_count * sizeof *state->x);
  state->scratch.still_known = false;
  return isfinite(step) ? step : 0;
}

static bool is_at_rest(const vsc_model *model, const vsc_state *state)
{
  return memcmp(state->x, model->rest, 4 * model->node_count * sizeof *state->x) == 0;
}

// A first step that is far below what tissue alone allows comes of viscosity or of loads: what it is without these is found.
static void doubt_loads(const vsc_model *model, vsc_state *state, double allowed)
{
  size_t slot;
  const double bound = vsc_limit_bound(model, &state->scratch, &slot);
  if (state->limit.rest > 0 || !(bound > 0) || allowed > COLLAPSE_AT_START * 2 / sqrt(bound)) return;
  state->limit.rest = step_at_rest(model, state, 0);
  vsc_limit_refresh(model, state, state->time, vsc_limit_enough(model));
}

// Fails where the stable step is below `part` of that at the start or at rest.
static vsc_status check_collapse(const vsc_model *model, vsc_state *state, double part, vsc_error *error)
{
  const vsc_limit *limit = &state->limit;
  const double usual = fmax(limit->first, limit->rest);
  if (isfinite(limit->eigenvalue) && !(limit->step < part * usual)) return VSC_OK;
  const size_t stiffest = vsc_largest_node(model, limit->mode);
  const vsc_culprit culprit = vsc_find_culprit(model, state->x, state->v, state->time, &state->scratch, stiffest);
  char node[VSC_NODE_TEXT], text[VSC_CULPRIT_TEXT];
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms the stable step has collapsed from %.3g to %.3g ms, stiffest is what pulls at "
                  "%s%s: elements are torn or crushed; take more damping or a smaller load",
                  state->time, usual, limit->step, vsc_name_node(model, stiffest, node, sizeof node),
                  vsc_name_culprit(&culprit, "", text, sizeof text));
}

vsc_status vsc_start(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  if (model->solve.kind != VSC_SOLVE_EXPLICIT)
    return vsc_fail(error, VSC_INPUT, "vsc_start: the model is not to be stepped explicitly: call vsc_solve_start");
  const vsc_status ready = vsc_keep_volume_ready(model, error);
  if (ready != VSC_OK) return ready;
  state->limit.rest = is_at_rest(model, state) ? 0 : step_at_rest(model, state, state->scratch.load);
  vsc_supports_place(model, state->time, 1, state->x);
  const double busiest = busiest_time(model, state);
  vsc_limit_refresh(model, state, busiest, vsc_limit_enough(model));
  const double active_step = state->limit.step, active_eigenvalue = state->limit.eigenvalue;
  if (busiest != state->time) vsc_limit_refresh(model, state, state->time, vsc_limit_enough(model));
  const double allowed = fmin(active_step, state->limit.step);
  if (!(allowed > 0) || isinf(allowed))
    return fail_no_step(isfinite(active_eigenvalue) && isfinite(state->limit.eigenvalue), error);
  if (model->step > allowed / model->safety && !model->force_step)
    return vsc_fail(error, VSC_INPUT,
                    "time.step: %.6g ms is above the stable step of %.6g ms (at rest %.6g, at full "
                    "activation %.6g); "
                    "use `step: auto`, a smaller step, or `force: true` to see what happens",
                    model->step, allowed / model->safety, state->limit.step / model->safety,
                    active_step / model->safety);
  doubt_loads(model, state, allowed);
  // what bodies are set in motion with must not change the volumes that they keep
  if (model->kept.count > 0 && model->velocity != NULL) {
    const vsc_status status = vsc_keep_volume_settle(model, state, allowed, error);
    if (status != VSC_OK) return status;
  }
  if (model->coupled.degree > 0 && model->velocity != NULL) {
    // what bodies are set in motion with is momentum
    const size_t bytes = 4 * model->node_count * sizeof *state->v;
    memcpy(state->lone_v, model->velocity, bytes);
    memcpy(state->v, vsc_coupled_mass_spread(model, &state->scratch, state->lone_v), bytes);
  }
  state->limit.time = state->time;
  state->limit.interval = SHORTEST_TRUST;
  state->limit.first = state->limit.least = allowed;
  const vsc_status moves = check_collapse(model, state, COLLAPSE_AT_START, error);
  if (moves != VSC_OK) return moves;
  // on its way back a crushed body, which may be slack now, becomes as stiff as at rest
  if (state->limit.rest > 0) state->limit.step = fmin(state->limit.step, state->limit.rest);
  vsc_force(model, state->x, model->terms.damping ? state->v : NULL, state->time, &state->scratch,
            state->force);
  motion m = {.model = model, .state = state, .whole = true};
  accelerate(&m);
  for (size_t piece = 0; piece < piece_count(model); piece++) kick(&m, piece, 0);
  if (model->terms.damping) memcpy(state->past_a, state->a, 4 * model->node_count * sizeof *state->a);
  if (model->moved_count > 0) vsc_moving_start(model, state);
  return VSC_OK;
}

static vsc_status refresh_limit(const vsc_model *model, vsc_state *state, vsc_error *error)
{
  vsc_limit *limit = &state->limit;
  const double before = limit->eigenvalue;
  const bool whole = state->time - limit->time >= limit->interval * (1 - 1e-9);
  vsc_limit_refresh(model, state, state->time, WARM_ITERATIONS);
  const double rise = (limit->eigenvalue - before) / before;
  if (whole && fabs(rise) < 0.02) limit->interval = fmin(2 * limit->interval, longest_trust(limit));
  if (fabs(rise) > 0.10) limit->interval = fmax(0.5 * limit->interval, SHORTEST_TRUST);
  limit->time = state->time;
  const vsc_status status = check_collapse(model, state, COLLAPSE, error);
  if (status != VSC_OK) return status;
  if (model->step > limit->step / model->safety && !model->force_step)
    return vsc_fail(error, VSC_NUMERICAL,
                    "at %.6g ms the tissue has become too stiff for time.step %.6g ms: the stable "
                    "step is now %.6g ms; "
                    "use `step: auto` or a smaller step",
                    state->time, model->step, limit->step / model->safety);
  limit->least = fmin(limit->least, limit->step);
  return VSC_OK;
}

static vsc_status check_finite(const vsc_model *model, const vsc_state *state, vsc_error *error)
{
  const size_t bad = vsc_state_find_bad(model, state);
  if (bad == model->node_count) return VSC_OK;
  char node[VSC_NODE_TEXT];
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms (step %.0f) the position of %s, is no longer a finite number: the simulation has "
                  "blown up; take a smaller %s, more damping, or a smaller load",
                  state->time, state->steps, vsc_name_node(model, bad, node, sizeof node),
                  model->step > 0 ? "time.step" : "time.safety");
}

// Steps on to `stop` or not quite as far, by what divides the way to `until` into equal steps not longer than
// the stable one. So steps keep their length for as long as the stable one does: steps that change their length
// to and fro, even far below it, feed energy to vibrations (parametric resonance).
static vsc_status step_to(const vsc_model *model, vsc_state *state, double stop, double until,
                          vsc_error *error)
{
  const double start = state->time;
  const double longest = state->limit.caution * state->limit.step;
  const double all = fmax(ceil((until - start) / longest * (1 - 1e-12)), 1), dt = (until - start) / all;
  const double steps = fmin(fmax(floor((stop - start) / dt * (1 + 1e-12)), 1), all);
  const vsc_status status = vsc_steps(model, state, dt, steps, error);
  if (status == VSC_OK) state->time = steps == all ? until : start + steps * dt;
  if (status == VSC_OK) state->limit.span += state->time - start;
  return status;
}

// Steps of the user's length, counted from time 0, to the first that is not before `stop`.
static vsc_status fixed_steps_to(const vsc_model *model, vsc_state *state, double stop,
                                 vsc_error *error)
{
  const double done = round(state->time / model->step);
  const double steps = fmax(ceil(stop / model->step * (1 - 1e-12)) - done, 1);
  const vsc_status status = vsc_steps(model, state, model->step, steps, error);
  if (status == VSC_OK) state->time = (done + steps) * model->step;
  return status;
}

vsc_status vsc_advance(const vsc_model *model, vsc_state *state, double until, vsc_error *error)
{
  while (state->time < until * (1 - 1e-12)) {
    double span = trusted_span(model, &state->limit);
    if (state->time - state->limit.time >= span * (1 - 1e-9)) {
      const vsc_status status = refresh_limit(model, state, error);
      if (status != VSC_OK) return status;
      span = trusted_span(model, &state->limit);
    }
    const double stop = fmin(until, state->limit.time + span);
    vsc_status status = model->step > 0 ? fixed_steps_to(model, state, stop, error)
                                        : step_to(model, state, stop, until, error);
    if (status == VSC_OK) status = check_finite(model, state, error);
    if (status != VSC_OK) return status;
  }
  return VSC_OK;
}
