// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/true_step.h"

#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "mech/force.h"
#include "solve/explicit.h"
#include "tools/shapes.h"

// Far below an element, far above the rounding of positions.
#define PROBE 1e-6
#define SAME 1e-9
// mm/ms: strains stay far below what a law would answer in another way.
#define SPEED 1e-7
enum { MOST_TURNS = 8 };

typedef struct matrices {
  const vsc_model *model;
  vsc_state *state;
  size_t count;            // coordinates
  double *x, *w, *force[2];  // node_count x 4
  double *K, *C;           // count x count, of unit masses; C NULL without damping
  double *sum;             // K + 2/dt C, which the eigenvalues take apart
} matrices;

static void close_system(matrices *s)
{
  vsc_free(s->x);
  vsc_free(s->w);
  vsc_free(s->force[0]);
  vsc_free(s->force[1]);
  vsc_free(s->K);
  vsc_free(s->C);
  vsc_free(s->sum);
}

static bool open_system(matrices *s)
{
  const size_t room = 4 * s->model->node_count, square = s->count * s->count;
  return VSC_NEW(s->x, room) && VSC_NEW(s->w, room) && VSC_NEW(s->force[0], room) && VSC_NEW(s->force[1], room) &&
         VSC_NEW(s->K, square) && VSC_NEW(s->sum, square) && (!s->model->terms.damping || VSC_NEW(s->C, square));
}

// Column j of M^-1/2 K M^-1/2, or with `moves` of C: coordinate j % 3 of node j / 3 is moved, or moves.
static void fill_column(const matrices *s, size_t j, bool moves, double *matrix)
{
  const vsc_model *model = s->model;
  const size_t at = 4 * (j / 3) + j % 3;
  const double size = moves ? 1 : PROBE * model->element_size;
  double *moved = moves ? s->w : s->x;
  for (int side = 0; side < 2; side++) {
    const double kept = moved[at];
    moved[at] += side ? size : -size;
    vsc_force(model, s->x, moves ? s->w : NULL, s->state->time, &s->state->scratch, s->force[side]);
    moved[at] = kept;
  }
  for (size_t i = 0; i < s->count; i++) {
    const size_t row = 4 * (i / 3) + i % 3;
    matrix[i * s->count + j] = (s->force[0][row] - s->force[1][row]) / (2 * size) *
                               sqrt(model->inverse_mass[row] * model->inverse_mass[at]);
  }
}

// 2/sqrt(lambda(dt))
static double step_of(const matrices *s, gsl_eigen_symm_workspace *work, gsl_vector *values, double dt)
{
  for (size_t i = 0; i < s->count; i++)
    for (size_t j = 0; j < s->count; j++) {
      const size_t a = i * s->count + j, b = j * s->count + i;
      s->sum[a] = 0.5 * (s->K[a] + s->K[b]) + (s->C != NULL ? (s->C[a] + s->C[b]) / dt : 0);
    }
  gsl_matrix_view matrix = gsl_matrix_view_array(s->sum, s->count, s->count);
  gsl_eigen_symm(&matrix.matrix, values, work);
  const double largest = gsl_vector_max(values);
  return largest > 0 ? 2 / sqrt(largest) : INFINITY;
}

// dt = step_of(dt): its logarithm comes nearer by a factor of one half at most, which Aitken's rule foretells.
static double find_step(const matrices *s, double dt)
{
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(s->count);
  gsl_vector *values = gsl_vector_alloc(s->count);
  for (int turn = 0; work != NULL && values != NULL && turn < MOST_TURNS; turn++) {
    const double first = step_of(s, work, values, dt);
    if (s->C == NULL || !isfinite(first) || fabs(log(first / dt)) < SAME) {
      dt = first;
      break;
    }
    const double second = step_of(s, work, values, first);
    const double now = log(second / first), before = log(first / dt);
    dt = fabs(now - before) > 0 ? second * exp(-now * now / (now - before)) : second;
  }
  if (work == NULL || values == NULL) dt = NAN;
  gsl_eigen_symm_free(work);
  gsl_vector_free(values);
  return dt;
}

vsc_status vsc_true_step(const vsc_model *model, vsc_state *state, double *step, vsc_error *error)
{
  matrices s = {.model = model, .state = state, .count = 3 * model->node_count};
  *step = NAN;
  if (open_system(&s)) {
    memcpy(s.x, state->x, 4 * model->node_count * sizeof *s.x);
    for (size_t j = 0; j < s.count; j++) fill_column(&s, j, false, s.K);
    for (size_t j = 0; j < s.count && s.C != NULL; j++) fill_column(&s, j, true, s.C);
    *step = find_step(&s, state->limit.step);
  }
  close_system(&s);
  return isnan(*step) ? vsc_fail_memory(error, "the true step") : VSC_OK;
}

// sum m v^2: velocities of light nodes alone may grow a lot, at the cost of heavy ones.
static double motion_of(const vsc_model *model, const double *v)
{
  double sum = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    if (model->inverse_mass[i] > 0) sum += v[i] * v[i] / model->inverse_mass[i];
  return sum;
}

vsc_status vsc_step_growth(const vsc_model *model, vsc_state *state, double dt, double count, double *growth,
                           vsc_error *error)
{
  const size_t numbers = 4 * model->node_count;
  memcpy(state->x, model->rest, numbers * sizeof *state->x);
  for (size_t i = 0; i < numbers; i++) state->v[i] = model->inverse_mass[i] > 0 ? SPEED * vsc_scatter(3, i) : 0;
  vsc_force(model, state->x, model->terms.damping ? state->v : NULL, state->time, &state->scratch, state->force);
  for (size_t i = 0; i < numbers; i++) state->a[i] = model->inverse_mass[i] * state->force[i];
  const double before = motion_of(model, state->v);
  const vsc_status status = vsc_steps(model, state, dt, count, error);
  const double after = motion_of(model, state->v);
  *growth = isfinite(after) ? sqrt(after / before) : INFINITY;
  return status;
}
