// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/newton.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "mech/element.h"
#include "mech/loads.h"
#include "model/free_motions.h"

enum { MOST_HALVINGS = 4, WHY = 160 };
// Full steps of a stiffening body overshoot, and come back from far away; not from here.
#define DIVERGED 1e10
// A start that is out of balance by so many times the forces at work is compared with the other one.
#define FAR 30.0
// Systems with a factor are solved at least this well: what bends forgives little.
#define FACTORIZED 1e-4
// Positions are rounded to this part of the body's size, and forces with them.
#define ROUNDING 4e-16
#define STILL 1e-14
// A step of nothing is an end only where forces balance to this part of those at work: 0.1 % of a load
// still to be borne is told as a failure, while the rounding that keeps steps from more is far smaller.
#define STILL_RESIDUAL 1e-3
// Sums of rounded forces of the elements round a node are off by some times what one of them is.
#define ROUNDED_SUMS 4

vsc_status vsc_newton_create(const vsc_model *model, vsc_newton **newton, vsc_error *error)
{
  vsc_newton *made;
  const size_t count = 4 * model->node_count;
  *newton = NULL;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "Newton's method");
  made->model = model;
  made->size = vsc_body_size(model);
  vsc_status status = vsc_tangent_create(model, &made->tangent, error);
  if (status == VSC_OK)
    status = vsc_linear_create(model, made->tangent, model->solve.linear, &made->linear, error);
  if (status == VSC_OK) status = vsc_kept_create(model, &made->kept, error);
  if (status == VSC_OK) status = vsc_touch_create(model, made->size, &made->touch, error);
  if (status == VSC_OK) status = vsc_multipliers_create(model, &made->multipliers, error);
  if (status == VSC_OK && (!VSC_NEW(made->r, count) || !VSC_NEW(made->d, count) ||
                           !VSC_NEW(made->trial, count) || !VSC_NEW(made->before, count)))
    status = vsc_fail_memory(error, "Newton's method");
  if (status != VSC_OK) {
    vsc_newton_free(made);
    return status;
  }
  *newton = made;
  return VSC_OK;
}

void vsc_newton_free(vsc_newton *newton)
{
  if (newton == NULL) return;
  vsc_tangent_free(newton->tangent);
  vsc_linear_free(newton->linear);
  vsc_kept_free(newton->kept);
  vsc_touch_free(newton->touch);
  vsc_multipliers_free(newton->multipliers);
  vsc_free(newton->r);
  vsc_free(newton->d);
  vsc_free(newton->trial);
  vsc_free(newton->before);
  vsc_free(newton->rows);
  vsc_free(newton);
}

double vsc_body_size(const vsc_model *model)
{
  double square = 0;
  for (int i = 0; i < 3; i++) {
    double low = INFINITY, high = -INFINITY;
    for (size_t n = 0; n < model->node_count; n++) {
      low = fmin(low, model->rest[4 * n + (size_t)i]);
      high = fmax(high, model->rest[4 * n + (size_t)i]);
    }
    square += (high - low) * (high - low);
  }
  return sqrt(square);
}

double vsc_smallest_ratio(const vsc_model *model, const double *x, uint32_t *element)
{
  double least = INFINITY;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    if (!vsc_patch_is_solid(patch)) continue;
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++)
      for (int q = 0; q < vsc_family_frames(model, patch->family); q++) {
        vsc_wide3 g[3];
        vsc_pack_axes(model, patch, k, q, x, g);
        const vsc_wide J = vsc_pack_ratio(g);
        for (int l = 0; l < VSC_WIDTH; l++) {
          const uint32_t e = model->mesh_element[VSC_WIDTH * k + (size_t)l];
          if (e == VSC_NO_ELEMENT || (isfinite(J[l]) && J[l] >= least)) continue;
          *element = e;
          if (!isfinite(J[l])) return -INFINITY;
          least = J[l];
        }
      }
  }
  return least;
}

// |r| over unknowns that are not held.
static double free_norm(const vsc_model *model, const double *r)
{
  double sum = 0;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    if (model->inverse_mass[i] != 0) sum += r[i] * r[i];
  return sqrt(sum);
}

static double whole_norm(const vsc_model *model, const double *r)
{
  double sum = 0;
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 0; i < 3; i++) sum += r[4 * n + i] * r[4 * n + i];
  return sqrt(sum);
}

void vsc_newton_begin(vsc_newton *newton, const double *force)
{
  vsc_kept_forget(newton->kept);
  newton->scale = whole_norm(newton->model, force);
  newton->floor = 0;
}

void vsc_newton_scale_by_loads(vsc_newton *newton, const double *x, double time)
{
  const vsc_model *model = newton->model;
  double *force = newton->trial;
  if (model->robin_count == 0) return;
  memset(force, 0, 4 * model->node_count * sizeof *force);
  vsc_loads_push(model, x, time, 1, force);
  for (size_t i = 0; model->terms.gravity && i < 4 * model->node_count; i++) force[i] += model->weight[i];
  newton->scale = fmax(newton->scale, whole_norm(model, force));
  memset(force, 0, 4 * model->node_count * sizeof *force);
  vsc_loads_hold(model, x, NULL, newton->d, force);
  newton->scale = fmax(newton->scale, whole_norm(model, force));
}

// Rounding alone in |r|: positions are rounded by ROUNDING of the body's size, and the stiffest of the
// tangent turns that into forces. What the matrix lacks of laws of smoothed tets and of shared volumes is in
// the preconditioner.
static double rounding_of(const vsc_newton *newton)
{
  const vsc_model *model = newton->model;
  const double stiffest =
      fmax(vsc_block_matrix_largest(&newton->tangent->matrix, model->inverse_mass),
           vsc_block_matrix_largest(&newton->tangent->preconditioner, model->inverse_mass));
  return ROUNDING * newton->size * sqrt((double)model->node_count) * stiffest;
}

static void write_row(vsc_newton *newton, const vsc_newton_row *row)
{
  if (newton->row_count == newton->row_room) {
    const size_t room = 2 * newton->row_room + 64;
    // a table that finds no memory lacks this row and goes on: it is only looked at
    if (!vsc_grow((void **)&newton->rows, newton->row_room, room, sizeof *newton->rows)) return;
    newton->row_room = room;
  }
  newton->rows[newton->row_count++] = *row;
}

// x <- x + d, or half of it, a quarter ... where an element would turn inside out or a node go through an obstacle;
// `why`, when that does not help.
static bool step(vsc_newton *newton, double *x, char why[WHY])
{
  const size_t count = 4 * newton->model->node_count;
  double part = 1;
  uint32_t element = 0;
  for (int k = 0; k <= MOST_HALVINGS; k++, part /= 2) {
    for (size_t i = 0; i < count; i++) newton->trial[i] = x[i] + part * newton->d[i];
    if (vsc_smallest_ratio(newton->model, newton->trial, &element) <= 0) {
      snprintf(why, WHY, "element %u would turn inside out",
               vsc_source_number(newton->model->element_source, element));
      continue;
    }
    if (vsc_touch_goes_through(newton->touch, x, newton->trial, why, WHY)) continue;
    memcpy(x, newton->trial, count * sizeof *x);
    vsc_kept_advance(newton->kept, part);
    return true;
  }
  return false;
}

// Whether the last step moved nothing by more than positions are rounded, with hardly a force left.
static bool stands_still(const vsc_newton *newton, double norm)
{
  double most = 0;
  for (size_t i = 0; i < 4 * newton->model->node_count; i++) most = fmax(most, fabs(newton->d[i]));
  return most <= STILL * newton->size &&
         norm <= fmax(STILL_RESIDUAL * newton->scale, ROUNDED_SUMS * newton->floor);
}

// What else the scene could be solved by.
static const char *other_ways(const vsc_model *model)
{
  if (model->solve.kind == VSC_SOLVE_IMPLICIT) return "or solve: explicit";
  // relaxation has no multipliers
  if (model->obstacle_count > 0 || model->kept.count > 0 || model->solve.incompressible > 0)
    return "or solve: implicit or explicit";
  return "solver.method: relaxation, or solve: implicit or explicit";
}

// What pulls most at the node at x, with what pushes there beside the balance's own forces.
static const char *blame(vsc_newton *newton, const vsc_balance *balance, const double *x, size_t node,
                         char text[VSC_CULPRIT_TEXT])
{
  *text = '\0';
  if (balance->blame == NULL) return text;
  double *beside = newton->trial;
  const size_t bytes = 4 * newton->model->node_count * sizeof *beside;
  balance->residual(balance->context, x, newton->d);
  vsc_culprit culprit = balance->blame(balance->context, x, node);
  memset(beside, 0, bytes);
  vsc_touch_push(newton->touch, x, NULL, beside);
  vsc_culprit_weigh(&culprit, "an obstacle", beside + 4 * node);
  memset(beside, 0, bytes);
  vsc_kept_add_force(newton->kept, x, beside);
  vsc_culprit_weigh(&culprit, "a kept volume", beside + 4 * node);
  return vsc_name_culprit(&culprit, "", text, VSC_CULPRIT_TEXT);
}

static vsc_status fail(vsc_newton *newton, const vsc_balance *balance, const double *x, vsc_error *error, double time,
                       const char *why)
{
  const vsc_model *model = newton->model;
  double *out = newton->trial, size = 0;
  // reactions of supports are no residual
  for (size_t i = 0; i < 4 * model->node_count; i++) out[i] = model->inverse_mass[i] != 0 ? newton->r[i] : 0;
  const size_t worst = vsc_largest_node(model, out);
  for (size_t i = 4 * worst; i < 4 * worst + 3; i++) size += out[i] * out[i];
  char node[VSC_NODE_TEXT], culprit[VSC_CULPRIT_TEXT], ways[VSC_FREE_TEXT], loose[VSC_FREE_TEXT + 140] = "";
  if (vsc_free_motions(model, ways, sizeof ways) > 0)
    snprintf(loose, sizeof loose,
             "; nothing%s keeps the body from moving as a whole, it is free to %s: hold it by supports or robin",
             model->obstacle_count > 0 ? " but obstacles that it touches" : "", ways);
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms no equilibrium was found: %s%s; furthest out of balance, by %.2g mN, is %s%s; take a smaller "
                  "load or a better mesh there, %s", time, why, loose, sqrt(size),
                  vsc_name_node(model, worst, node, sizeof node), blame(newton, balance, x, worst, culprit), other_ways(model));
}

// r at x, and its norm.
static double look(vsc_newton *newton, const vsc_balance *balance, const double *x, const double *before)
{
  balance->residual(balance->context, x, newton->r);
  vsc_touch_push(newton->touch, x, before, newton->r);
  return free_norm(newton->model, newton->r);
}

// The norm of r at x, which becomes the other start where that is nearer.
static double start(vsc_newton *newton, const vsc_balance *balance, double *x)
{
  const double norm = look(newton, balance, x, NULL);
  if (balance->stay == NULL || norm <= FAR * newton->scale) return norm;
  balance->stay(balance->context, newton->before);
  if (!(look(newton, balance, newton->before, NULL) >= norm))
    memcpy(x, newton->before, 4 * newton->model->node_count * sizeof *x);
  return look(newton, balance, x, NULL);
}

// A position is no longer finite, or else a force; what pulls there does so at the iterate before, where there is one.
static vsc_status fail_infinite(vsc_newton *newton, const vsc_balance *balance, const double *x, bool first, double time,
                                vsc_error *error)
{
  const vsc_model *model = newton->model;
  size_t node = vsc_largest_node(model, x);
  const bool lost = !isfinite(x[4 * node] + x[4 * node + 1] + x[4 * node + 2]);
  if (!lost) node = vsc_largest_node(model, newton->r);
  char name[VSC_NODE_TEXT], culprit[VSC_CULPRIT_TEXT] = "";
  if (!first || !lost) blame(newton, balance, first ? x : newton->before, node, culprit);
  return vsc_fail(error, VSC_NUMERICAL,
                  "at %.6g ms no equilibrium was found: the %s %s, is no longer a finite number%s; take a smaller load or a "
                  "better mesh there, %s", time, lost ? "position of" : "force on",
                  vsc_name_node(model, node, name, sizeof name), culprit, other_ways(model));
}

static vsc_status solve(vsc_newton *newton, const vsc_balance *balance, double time, double load, double *x,
                        int *iterations, vsc_error *error)
{
  const vsc_model *model = newton->model;
  const double tolerance = model->solve.tolerance;
  double first = 0, before = 0, forcing = 1, off = 0, relative = 0;
  bool finite = true;
  newton->solutions++;
  newton->indefinite = false;
  for (int k = 0; k <= VSC_MOST_NEWTON; k++) {
    if (vsc_is_set(newton->interrupted)) return vsc_fail(error, VSC_SYSTEM, "interrupted");
    const double norm = k > 0 ? look(newton, balance, x, newton->before) : start(newton, balance, x);
    off = vsc_kept_look(newton->kept, x);
    if (!(first > 0)) first = norm;
    // without loads at rest, a support that moves or a volume that is off is all that is at work
    if (newton->scale == 0) newton->scale = whole_norm(model, newton->r);
    const vsc_linear_counts counts = vsc_linear_counted(newton->linear);
    finite = isfinite(norm) && isfinite(newton->scale);
    relative = newton->scale == 0 ? 0 : norm / newton->scale;
    vsc_newton_row row = {time, load, k, relative, 0, 0};
    *iterations = k;
    const bool balanced = relative <= tolerance || norm <= newton->floor || (k > 0 && stands_still(newton, norm));
    if (finite && balanced && off <= VSC_KEPT_BALANCE) {
      write_row(newton, &row);
      newton->scale = fmax(newton->scale, whole_norm(model, newton->r));
      return VSC_OK;
    }
    if (!finite || norm > DIVERGED * fmax(first, tolerance * newton->scale) || k == VSC_MOST_NEWTON) {
      write_row(newton, &row);
      break;
    }
    if (k > 0 && before > 0) forcing = 0.9 * (norm / before) * (norm / before);
    forcing = fmax(fmin(forcing, vsc_linear_is_plain(newton->linear) ? 0.1 : FACTORIZED),
                   fmax(0.3 * tolerance / fmax(relative, tolerance), 1e-8));
    before = norm;
    balance->assemble(balance->context, x, k > 0 ? newton->before : NULL, newton->tangent);
    vsc_touch_tangent(newton->touch, x, newton->tangent);
    memcpy(newton->before, x, 4 * model->node_count * sizeof *x);
    vsc_error reason;
    const vsc_status status = vsc_kept_solve(newton->kept, newton->linear, newton->tangent, model->inverse_mass, x,
                                             newton->r, forcing, newton->d, &newton->indefinite, &reason);
    newton->floor = rounding_of(newton);
    const vsc_linear_counts after = vsc_linear_counted(newton->linear);
    row.linear = after.iterations - counts.iterations;
    row.factorized = after.factorizations - counts.factorizations;
    write_row(newton, &row);
    newton->iterations++;
    if (status != VSC_OK) {
      newton->failures++;
      return status == VSC_NUMERICAL ? fail(newton, balance, x, error, time, reason.text)
                                     : vsc_fail(error, status, "%s", reason.text);
    }
    char why[WHY];
    if (!step(newton, x, why)) {
      newton->failures++;
      return fail(newton, balance, x, error, time, why);
    }
  }
  newton->failures++;
  if (!finite) return fail_infinite(newton, balance, x, *iterations == 0, time, error);
  char why[WHY];
  snprintf(why, WHY, "the residual is %.2g of the forces after %d iterations, not below %.2g", relative, *iterations,
           tolerance);
  if (relative <= tolerance) snprintf(why, sizeof why, "a kept volume is off by %.2g of itself", off);
  return fail(newton, balance, x, error, time, why);
}

vsc_status vsc_newton_solve(vsc_newton *newton, const vsc_balance *balance, double time, double load, double *x,
                            int *iterations, vsc_error *error)
{
  vsc_touch *touch = newton->touch;
  if (touch == NULL) return solve(newton, balance, time, load, x, iterations, error);
  const bool unknown = newton->scale == 0;
  for (int round = 0; round < VSC_MOST_ROUNDS; round++) {
    int more;
    const vsc_status status = solve(newton, balance, time, load, x, &more, error);
    *iterations = round == 0 ? more : *iterations;
    if (status != VSC_OK) return status;
    if (vsc_touch_update(touch, x) && !(unknown && round == 0)) return VSC_OK;
    // how hard nodes far inside were pushed at first tells nothing of the forces in the end
    if (unknown && round == 0) newton->scale = whole_norm(newton->model, newton->r);
    newton->scale = fmax(newton->scale, vsc_touch_norm(touch));
  }
  return vsc_touch_fail(touch, x, error);
}
