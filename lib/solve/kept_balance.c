// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/kept_balance.h"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"

// What a pressure does is solved for this well: by so much of its change volumes are off after a step.
#define EXACT 1e-4

vsc_status vsc_kept_create(const vsc_model *model, vsc_kept_balance **kept, vsc_error *error)
{
  const size_t count = model->kept.count, all = 4 * count * model->node_count;
  vsc_kept_balance *made;
  *kept = NULL;
  if (count == 0) return VSC_OK;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "kept volumes");
  made->model = model;
  if (!VSC_NEW(made->pressure, count) || !VSC_NEW(made->change, count) || !VSC_NEW(made->defect, count) ||
      !VSC_NEW(made->push, all) || !VSC_NEW(made->flux, all) || !VSC_NEW(made->answer, all) ||
      !VSC_NEW(made->rest, 8 * model->node_count) || !VSC_NEW(made->small, count * count)) {
    vsc_kept_free(made);
    return vsc_fail_memory(error, "kept volumes");
  }
  *kept = made;
  return VSC_OK;
}

void vsc_kept_free(vsc_kept_balance *kept)
{
  if (kept == NULL) return;
  vsc_free(kept->pressure);
  vsc_free(kept->change);
  vsc_free(kept->defect);
  vsc_free(kept->push);
  vsc_free(kept->flux);
  vsc_free(kept->answer);
  vsc_free(kept->rest);
  vsc_free(kept->small);
  vsc_free(kept);
}

void vsc_kept_forget(vsc_kept_balance *kept)
{
  if (kept != NULL)
    memset(kept->answer, 0, 4 * kept->model->kept.count * kept->model->node_count * sizeof *kept->answer);
}

void vsc_kept_take(vsc_kept_balance *kept, const vsc_state *state)
{
  if (kept != NULL) memcpy(kept->pressure, state->kept_pressure, kept->model->kept.count * sizeof *kept->pressure);
}

void vsc_kept_give(const vsc_kept_balance *kept, vsc_state *state)
{
  if (kept != NULL) memcpy(state->kept_pressure, kept->pressure, kept->model->kept.count * sizeof *kept->pressure);
}

// ---- volumes and their derivatives

// g_k of all volumes, on all nodes.
static void find_gradients(const vsc_model *model, const double *x, double *gradient)
{
  const vsc_kept_volumes *kept = &model->kept;
  memset(gradient, 0, 4 * kept->count * model->node_count * sizeof *gradient);
  for (size_t k = 0; k < kept->count; k++, gradient += 4 * model->node_count)
    for (size_t t = kept->start[k]; t < kept->start[k + 1]; t++) {
      double at[3][3], part[3][3];
      vsc_kept_triangle(model, k, t, x, at, part);
      for (size_t c = 0; c < 3; c++)
        for (size_t i = 0; i < 3; i++) gradient[4 * (size_t)kept->triangles[3 * t + c] + i] += part[c][i];
    }
}

void vsc_kept_add_force(vsc_kept_balance *kept, const double *x, double *r)
{
  if (kept == NULL) return;
  const size_t count = 4 * kept->model->node_count;
  find_gradients(kept->model, x, kept->push);
  for (size_t k = 0; k < kept->model->kept.count; k++)
    for (size_t i = 0; i < count; i++) r[i] += kept->pressure[k] * kept->push[k * count + i];
}

// d(b x c)/db = -[c]x, d(b x c)/dc = [b]x, of each corner's gradient w (b x c)/6.
void vsc_kept_add_tangent(const vsc_kept_balance *kept, const double *x, double factor, vsc_block_matrix *matrix)
{
  if (kept == NULL) return;
  const vsc_kept_volumes *volumes = &kept->model->kept;
  for (size_t k = 0; k < volumes->count; k++)
    for (size_t t = volumes->start[k]; t < volumes->start[k + 1]; t++) {
      const uint32_t *node = volumes->triangles + 3 * t;
      double at[3][3];
      vsc_kept_triangle(kept->model, k, t, x, at, NULL);
      const double part = -factor * kept->pressure[k] * volumes->weights[t] / 6;
      for (int c = 0; c < 3; c++) {
        const int next = (c + 1) % 3, last = (c + 2) % 3;
        const double *w = at[last], *u = at[next];
        vsc_block_matrix_add(matrix, node[c], node[next], -part, (double[]){0, -w[2], w[1], w[2], 0, -w[0], -w[1], w[0], 0});
        vsc_block_matrix_add(matrix, node[c], node[last], part, (double[]){0, -u[2], u[1], u[2], 0, -u[0], -u[1], u[0], 0});
      }
    }
}

double vsc_kept_look(vsc_kept_balance *kept, const double *x)
{
  if (kept == NULL) return 0;
  const vsc_kept_volumes *volumes = &kept->model->kept;
  double most = 0;
  find_gradients(kept->model, x, kept->flux);
  for (size_t k = 0; k < volumes->count; k++) {
    kept->defect[k] = volumes->rest[k] - vsc_kept_volume_of(kept->model, k, x);
    most = fmax(most, fabs(kept->defect[k]) / volumes->rest[k]);
  }
  return most;
}

void vsc_kept_look_moving(vsc_kept_balance *kept, const double *x, const double *v)
{
  if (kept == NULL) return;
  const vsc_kept_volumes *volumes = &kept->model->kept;
  find_gradients(kept->model, x, kept->flux);
  for (size_t k = 0; k < volumes->count; k++) {
    kept->defect[k] = 0;
    for (size_t t = volumes->start[k]; t < volumes->start[k + 1]; t++) {
      const uint32_t *node = volumes->triangles + 3 * t;
      double at[3][3], across[3];
      vsc_kept_triangle(kept->model, k, t, x, at, NULL);
      // d^2 (a x b) . c = 2 (da x db . c + db x dc . a + dc x da . b)
      for (int c = 0; c < 3; c++) {
        vsc_cross(v + 4 * (size_t)node[c], v + 4 * (size_t)node[(c + 1) % 3], across);
        kept->defect[k] -= volumes->weights[t] * vsc_dot(across, at[(c + 2) % 3]) / 3;
      }
    }
  }
}

// ---- solutions

static double product(const vsc_model *model, const double *free, const double *a, const double *b)
{
  double sum = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    if (free[i] != 0) sum += a[i] * b[i];
  return sum;
}

// small answer = right, which becomes the answer.
static vsc_status solve_small(double *small, double *right, size_t count, vsc_error *error)
{
  gsl_matrix_view matrix = gsl_matrix_view_array(small, count, count);
  gsl_vector_view vector = gsl_vector_view_array(right, count);
  bool sound = true;
  for (size_t k = 0; k < count; k++) sound = sound && small[k * count + k] > 0;
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  sound = sound && gsl_linalg_HH_svx(&matrix.matrix, &vector.vector) == GSL_SUCCESS;
  gsl_set_error_handler(handler);
  for (size_t k = 0; k < count; k++) sound = sound && isfinite(right[k]);
  if (sound) return VSC_OK;
  return vsc_fail(error, VSC_NUMERICAL,
                  "no pressures can keep all %zu volumes: nothing that could change one of them can move", count);
}

// z_k = A^-1 g_k, from what it was with a former A: z <- z + A^-1 (g - A z).
static vsc_status answer_push(vsc_kept_balance *kept, size_t k, vsc_linear *linear, vsc_tangent *tangent,
                              const double *free, const double *x, bool *indefinite, vsc_error *error)
{
  const vsc_model *model = kept->model;
  const size_t all = 4 * model->node_count;
  const double *push = kept->push + k * all;
  double *answer = kept->answer + k * all, *rest = kept->rest, *step = kept->rest + all;
  vsc_tangent_times(tangent, free, answer, rest);
  for (size_t i = 0; i < all; i++) rest[i] = free[i] == 0 ? 0 : push[i] - rest[i];
  const double goal = EXACT * EXACT * product(model, free, push, push), square = product(model, free, rest, rest);
  if (square <= goal) return VSC_OK;
  bool negative = false;
  const vsc_status status =
      vsc_linear_solve(linear, tangent, free, x, rest, sqrt(goal / square), step, &negative, error);
  for (size_t i = 0; status == VSC_OK && i < all; i++) answer[i] += step[i];
  *indefinite = *indefinite || negative;
  return status;
}

vsc_status vsc_kept_solve(vsc_kept_balance *kept, vsc_linear *linear, vsc_tangent *tangent, const double *free,
                          const double *x, const double *b, double tolerance, double *d, bool *indefinite,
                          vsc_error *error)
{
  if (kept == NULL) return vsc_linear_solve(linear, tangent, free, x, b, tolerance, d, indefinite, error);
  const vsc_model *model = kept->model;
  const size_t count = model->kept.count, all = 4 * model->node_count;
  vsc_status status = VSC_OK;
  *indefinite = false;
  memset(d, 0, all * sizeof *d);
  if (product(model, free, b, b) > 0)
    status = vsc_linear_solve(linear, tangent, free, x, b, tolerance, d, indefinite, error);
  for (size_t k = 0; status == VSC_OK && k < count; k++)
    status = answer_push(kept, k, linear, tangent, free, x, indefinite, error);
  if (status != VSC_OK) return status;
  for (size_t k = 0; k < count; k++) {
    kept->change[k] = kept->defect[k] - product(model, free, kept->flux + k * all, d);
    for (size_t l = 0; l < count; l++)
      kept->small[k * count + l] = product(model, free, kept->flux + k * all, kept->answer + l * all);
  }
  status = solve_small(kept->small, kept->change, count, error);
  for (size_t k = 0; status == VSC_OK && k < count; k++)
    for (size_t i = 0; i < all; i++) d[i] += kept->change[k] * kept->answer[k * all + i];
  return status;
}

void vsc_kept_advance(vsc_kept_balance *kept, double part)
{
  if (kept == NULL) return;
  for (size_t k = 0; k < kept->model->kept.count; k++) kept->pressure[k] += part * kept->change[k];
}

vsc_status vsc_kept_settle(vsc_kept_balance *kept, double *v, vsc_error *error)
{
  if (kept == NULL) return VSC_OK;
  const vsc_model *model = kept->model;
  const size_t count = model->kept.count, all = 4 * model->node_count;
  for (size_t k = 0; k < count; k++) {
    const double *flux = kept->flux + k * all;
    kept->change[k] = 0;
    for (size_t i = 0; i < all; i++) kept->change[k] += flux[i] * v[i];
    for (size_t l = 0; l < count; l++) {
      double sum = 0;
      for (size_t i = 0; i < all; i++) sum += flux[i] * model->inverse_mass[i] * kept->flux[l * all + i];
      kept->small[k * count + l] = sum;
    }
  }
  const vsc_status status = solve_small(kept->small, kept->change, count, error);
  for (size_t k = 0; status == VSC_OK && k < count; k++)
    for (size_t i = 0; i < all; i++) v[i] -= model->inverse_mass[i] * kept->change[k] * kept->flux[k * all + i];
  return status;
}
