// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/linear.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "model/small_strain.h"
#include "solve/cholmod.h"

enum { MOST_ITERATIONS = 1000, LEAST_BUDGET = 100, MOST_PLAIN = 5000 };
// One iteration with a factor takes as long as 16 operations of a factorisation for each number of it; what goes
// before and after a factorisation takes as long as LEAST_WORTH iterations.
#define WORTH 16.0
#define LEAST_WORTH 5.0
// A factorisation of n unknowns of a compact body costs about as much as n/BUDGET iterations.
#define BUDGET 12.0
#define MOST_MEMORY 0.7  // of the machine's that a factor may take
// Volume over shear modulus from which diagonal blocks are not worth trying.
#define STIFF_RATIO 60.0

struct vsc_linear {
  const vsc_model *model;
  vsc_linear_kind kind;
  const vsc_cholmod *cholmod;
  cholmod_common common;
  cholmod_sparse view;     // of the preconditioner's numbers
  int *column, *row;       // its pattern as CHOLMOD reads it
  cholmod_factor *factor;  // analysed when first needed
  bool too_large;          // the factor, for this machine
  bool made;               // the factor holds its numbers; else they are to be made of `kept` again
  double *kept;            // implicit steps: the matrix that the factor was made of
  size_t kept_count;
  vsc_linear_past past;
  cholmod_dense *right, *solution, *y, *e;  // memory of CHOLMOD's solution
  double *blocks;          // node_count x 9: inverses of the diagonal blocks
  double *r, *z, *p, *q;   // node_count x 4
  vsc_linear_counts counts;
};

void vsc_linear_free(vsc_linear *linear)
{
  if (linear == NULL) return;
  linear->cholmod->free_factor(&linear->factor, &linear->common);
  linear->cholmod->free_dense(&linear->right, &linear->common);
  linear->cholmod->free_dense(&linear->solution, &linear->common);
  linear->cholmod->free_dense(&linear->y, &linear->common);
  linear->cholmod->free_dense(&linear->e, &linear->common);
  linear->cholmod->finish(&linear->common);
  vsc_free(linear->column);
  vsc_free(linear->row);
  vsc_free(linear->kept);
  vsc_free(linear->blocks);
  vsc_free(linear->r);
  vsc_free(linear->z);
  vsc_free(linear->p);
  vsc_free(linear->q);
  vsc_free(linear);
}

// The largest ratio of volume to shear stiffness among the materials.
static double stiffest_ratio(const vsc_model *model)
{
  double most = 0;
  for (size_t m = 0; m < model->material_count; m++) {
    const vsc_material *material = &model->materials[m];
    const double shear = vsc_material_shear(model, material);
    if (shear > 0) most = fmax(most, material->volume_modulus / shear);
  }
  return most;
}

vsc_status vsc_linear_create(const vsc_model *model, const vsc_tangent *tangent, vsc_linear_kind kind,
                             vsc_linear **linear, vsc_error *error)
{
  vsc_linear *made;
  const vsc_cholmod *cholmod;
  *linear = NULL;
  const vsc_status status = vsc_cholmod_load(&cholmod, error);
  if (status != VSC_OK) return status;
  if (!VSC_NEW(made, 1)) return vsc_fail_memory(error, "the linear solver");
  const size_t nodes = model->node_count;
  made->cholmod = cholmod;
  cholmod->start(&made->common);
  made->common.print = 0;
  made->model = model;
  made->kind = kind;
  double *budget = &made->past.budget;
  *budget = fmax(3 * (double)nodes / BUDGET, LEAST_BUDGET);
  if (stiffest_ratio(model) > STIFF_RATIO || kind == VSC_LINEAR_DIRECT) *budget = 0;
  if (kind == VSC_LINEAR_ITERATIVE) *budget = INFINITY;
  made->past.plain_left = *budget;
  if (model->solve.kind == VSC_SOLVE_IMPLICIT) made->kept_count = 9 * tangent->matrix.start[nodes];
  if (!VSC_NEW(made->kept, made->kept_count) || !VSC_NEW(made->blocks, 9 * nodes) || !VSC_NEW(made->r, 4 * nodes) ||
      !VSC_NEW(made->z, 4 * nodes) || !VSC_NEW(made->p, 4 * nodes) || !VSC_NEW(made->q, 4 * nodes)) {
    vsc_linear_free(made);
    return vsc_fail_memory(error, "the linear solver");
  }
  *linear = made;
  return VSC_OK;
}

void vsc_linear_forget(vsc_linear *linear)
{
  linear->made = false;
  linear->past = (vsc_linear_past){.budget = linear->past.budget, .plain_left = linear->past.budget};
}

vsc_linear_past *vsc_linear_past_of(vsc_linear *linear)
{
  return &linear->past;
}

double *vsc_linear_factorized(vsc_linear *linear, size_t *count)
{
  *count = linear->kept_count;
  return linear->kept_count > 0 ? linear->kept : NULL;
}

void vsc_linear_resume(vsc_linear *linear)
{
  linear->made = false;
}

bool vsc_linear_is_plain(const vsc_linear *linear)
{
  return linear->past.factorized == 0 && linear->past.plain_left > 0;
}

vsc_linear_counts vsc_linear_counted(const vsc_linear *linear)
{
  return linear->counts;
}

// ---- the factor

// A fill-reducing order of the nodes (METIS), each node's three unknowns together.
static int *order_unknowns(vsc_linear *linear, const vsc_block_matrix *matrix)
{
  const size_t nodes = matrix->node_count, blocks = matrix->start[nodes];
  cholmod_common *common = &linear->common;
  int *order, *start = NULL, *row = NULL, *of_nodes = NULL;
  bool good = VSC_NEW(order, 3 * nodes) && VSC_NEW(start, nodes + 1) && VSC_NEW(row, blocks) &&
              VSC_NEW(of_nodes, nodes);
  if (good) {
    for (size_t n = 0; n <= nodes; n++) start[n] = (int)matrix->start[n];
    for (size_t k = 0; k < blocks; k++) row[k] = (int)matrix->row[k];
    cholmod_sparse graph = {.nrow = nodes, .ncol = nodes, .nzmax = blocks, .p = start, .i = row,
                            .stype = -1, .itype = CHOLMOD_INT, .xtype = CHOLMOD_PATTERN,
                            .dtype = CHOLMOD_DOUBLE, .sorted = 1, .packed = 1};
    good = linear->cholmod->metis(&graph, NULL, 0, 1, of_nodes, common);
    for (size_t k = 0; good && k < nodes; k++)
      for (int c = 0; c < 3; c++) order[3 * k + (size_t)c] = 3 * of_nodes[k] + c;
  }
  vsc_free(start);
  vsc_free(row);
  vsc_free(of_nodes);
  if (good) return order;
  vsc_free(order);
  return NULL;
}

// The matrix as CHOLMOD sees it: lower triangle by columns; what the whole diagonal blocks have
// above the diagonal is not read.
static bool make_view(vsc_linear *linear, const vsc_block_matrix *matrix)
{
  const size_t nodes = matrix->node_count, blocks = matrix->start[nodes];
  if (9 * blocks > INT32_MAX) return false;
  if (!VSC_NEW(linear->column, 3 * nodes + 1) || !VSC_NEW(linear->row, 9 * blocks)) return false;
  size_t at = 0;
  for (size_t j = 0; j < nodes; j++)
    for (int c = 0; c < 3; c++) {
      linear->column[3 * j + (size_t)c] = (int)at;
      for (size_t k = matrix->start[j]; k < matrix->start[j + 1]; k++)
        for (int r = 0; r < 3; r++) linear->row[at++] = (int)(3 * matrix->row[k]) + r;
    }
  linear->column[3 * nodes] = (int)at;
  linear->view = (cholmod_sparse){.nrow = 3 * nodes, .ncol = 3 * nodes, .nzmax = at,
                                  .p = linear->column, .i = linear->row, .stype = -1,
                                  .itype = CHOLMOD_INT, .xtype = CHOLMOD_REAL,
                                  .dtype = CHOLMOD_DOUBLE, .sorted = 1, .packed = 1};
  return true;
}

static vsc_status fail_size(vsc_linear *linear, vsc_error *error)
{
  char size[40] = "";
  linear->too_large = true;
  if (linear->counts.factor_entries > 0)
    snprintf(size, sizeof size, ", %.3g GB,", 8e-9 * linear->counts.factor_entries);
  return vsc_fail(error, VSC_SYSTEM, "the factor of the tangent%s does not fit into memory; take solver.linear: "
                  "iterative, or auto", size);
}

static vsc_status analyze(vsc_linear *linear, const vsc_block_matrix *matrix, vsc_error *error)
{
  if (linear->factor != NULL) return VSC_OK;
  cholmod_common *common = &linear->common;
  int *order = NULL;
  bool good = make_view(linear, matrix) && (order = order_unknowns(linear, matrix)) != NULL;
  if (good) {
    common->supernodal = CHOLMOD_SUPERNODAL;
    common->nmethods = 1;
    common->method[0].ordering = CHOLMOD_GIVEN;
    common->postorder = 1;
    linear->view.x = matrix->values;
    linear->factor = linear->cholmod->analyze_p(&linear->view, order, NULL, 0, common);
    linear->counts.factor_entries = common->lnz;
    linear->counts.factor_flops = common->fl;
    linear->right = linear->cholmod->zeros(3 * matrix->node_count, 1, CHOLMOD_REAL, common);
    good = linear->factor != NULL && linear->right != NULL;
  }
  vsc_free(order);
  if (good) return VSC_OK;
  // with status CHOLMOD_OK memory was short outside of CHOLMOD
  const int why = common->status;
  if (why == CHOLMOD_OK || why == CHOLMOD_OUT_OF_MEMORY || why == CHOLMOD_TOO_LARGE) return fail_size(linear, error);
  return vsc_fail(error, VSC_SYSTEM, "no order was found for the factor of the tangent (status %d of CHOLMOD); take "
                  "solver.linear: iterative", why);
}

// Whether the factor would take most of the machine's memory.
static bool is_too_large(const vsc_linear *linear)
{
  const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGE_SIZE);
  return linear->counts.factor_entries * sizeof(double) > MOST_MEMORY * memory;
}

// The factor of `values`, which have the pattern's places, with the diagonal raised by past.shift.
static vsc_status make_factor(vsc_linear *linear, double *values, vsc_error *error)
{
  cholmod_common *common = &linear->common;
  double shift[2] = {linear->past.shift, 0};
  linear->view.x = values;
  linear->counts.factorizations++;
  const bool done = linear->cholmod->factorize_p(&linear->view, shift, NULL, 0, linear->factor, common);
  if (!done && common->status == CHOLMOD_OUT_OF_MEMORY) return fail_size(linear, error);
  linear->made = done && common->status == CHOLMOD_OK;
  return linear->made ? VSC_OK
                      : vsc_fail(error, VSC_NUMERICAL,
                                 "the tangent has lost its stiffness (buckling, or too large an increment)");
}

// The factor of the tangent's preconditioner; as much is added to the diagonal as it takes.
static vsc_status factorize(vsc_linear *linear, vsc_tangent *tangent, const double *free,
                            const double *x, vsc_error *error)
{
  enum { MOST_SHIFTS = 4 };
  vsc_block_matrix *matrix = &tangent->preconditioner;
  vsc_tangent_precondition(linear->model, tangent, x);
  const double largest = vsc_block_matrix_largest(matrix, free);
  vsc_block_matrix_hold(matrix, free, largest);
  vsc_status status = analyze(linear, matrix, error);
  if (status == VSC_OK && is_too_large(linear)) status = fail_size(linear, error);
  if (status != VSC_OK) return status;
  if (linear->kept_count > 0) memcpy(linear->kept, matrix->values, linear->kept_count * sizeof *linear->kept);
  vsc_linear_past *past = &linear->past;
  past->factorized = past->shift = past->spent = 0;
  status = VSC_NUMERICAL;
  for (int k = 0; k <= MOST_SHIFTS && status == VSC_NUMERICAL; k++) {
    status = make_factor(linear, matrix->values, error);
    past->factorized = status == VSC_OK;
    if (status == VSC_NUMERICAL) past->shift = k == 0 ? 1e-4 * largest : 10 * past->shift;
  }
  return status;
}

// The factor that the past tells of, where only its matrix is there.
static vsc_status make_again(vsc_linear *linear, const vsc_tangent *tangent, vsc_error *error)
{
  if (linear->past.factorized == 0 || linear->made) return VSC_OK;
  const vsc_status status = analyze(linear, &tangent->preconditioner, error);
  return status != VSC_OK ? status : make_factor(linear, linear->kept, error);
}

// ---- preconditioners: z = P^-1 r

static void invert_block(const double *block, size_t stride, double inverse[9])
{
  const double a = block[0], b = block[1], c = block[2], d = block[stride + 1],
               e = block[stride + 2], f = block[2 * stride + 2];
  const double A = d * f - e * e, B = c * e - b * f, C = b * e - c * d;
  const double determinant = a * A + b * B + c * C;
  const double part = determinant > 0 ? 1 / determinant : 0;
  const double rows[9] = {A, B, C, B, a * f - c * c, b * c - a * e, C, b * c - a * e, a * d - b * b};
  for (int k = 0; k < 9; k++) inverse[k] = part * rows[k];
}

static void invert_blocks(vsc_linear *linear, const vsc_block_matrix *matrix)
{
  for (size_t n = 0; n < matrix->node_count; n++) {
    size_t stride;
    const double *block = vsc_block_at(matrix, n, matrix->start[n], &stride);
    invert_block(block, stride, linear->blocks + 9 * n);
  }
}

static void apply_blocks(const vsc_linear *linear)
{
  for (size_t n = 0; n < linear->model->node_count; n++) {
    const double *inverse = linear->blocks + 9 * n, *r = linear->r + 4 * n;
    for (size_t i = 0; i < 3; i++)
      linear->z[4 * n + i] =
          inverse[3 * i] * r[0] + inverse[3 * i + 1] * r[1] + inverse[3 * i + 2] * r[2];
  }
}

// False when memory is short.
static bool apply_factor(vsc_linear *linear)
{
  double *right = linear->right->x;
  for (size_t n = 0; n < linear->model->node_count; n++)
    memcpy(right + 3 * n, linear->r + 4 * n, 3 * sizeof *right);
  if (!linear->cholmod->solve2(CHOLMOD_A, linear->factor, linear->right, NULL, &linear->solution, NULL, &linear->y,
                               &linear->e, &linear->common))
    return false;
  const double *solution = linear->solution->x;
  for (size_t n = 0; n < linear->model->node_count; n++)
    memcpy(linear->z + 4 * n, solution + 3 * n, 3 * sizeof *solution);
  return true;
}

// ---- conjugate gradients

static double product(const vsc_linear *linear, const double *a, const double *b)
{
  double sum = 0;
  for (size_t n = 0; n < linear->model->node_count; n++)
    sum += a[4 * n] * b[4 * n] + a[4 * n + 1] * b[4 * n + 1] + a[4 * n + 2] * b[4 * n + 2];
  return sum;
}

typedef enum outcome { CONVERGED, SLOW, NEGATIVE, NO_MEMORY } outcome;

// Up to `most` iterations from d = 0. With negative curvature at once d is the first direction.
static outcome iterate(vsc_linear *linear, const vsc_tangent *tangent, const double *free,
                       const double *b, double tolerance, double most, double *d)
{
  const size_t count = 4 * linear->model->node_count;
  double *r = linear->r, *z = linear->z, *p = linear->p, *q = linear->q;
  memset(d, 0, count * sizeof *d);
  memset(q, 0, count * sizeof *q);
  for (size_t i = 0; i < count; i++) r[i] = free[i] == 0 ? 0 : b[i];
  const double goal = tolerance * tolerance * product(linear, r, r);
  double before = 0;
  for (double k = 0; k < most; k++) {
    if (linear->past.factorized == 0)
      apply_blocks(linear);
    else if (!apply_factor(linear))
      return NO_MEMORY;
    const double now = product(linear, r, z);
    const double beta = k > 0 ? now / before : 0;
    for (size_t i = 0; i < count; i++) p[i] = (free[i] == 0 ? 0 : z[i]) + beta * p[i];
    vsc_tangent_times(tangent, free, p, q);
    linear->counts.iterations++;
    const double curvature = product(linear, p, q);
    if (!(curvature > 0)) {
      if (k == 0) memcpy(d, p, count * sizeof *d);
      return NEGATIVE;
    }
    const double alpha = now / curvature;
    for (size_t i = 0; i < count; i++) {
      d[i] += alpha * p[i];
      r[i] -= alpha * q[i];
    }
    if (product(linear, r, r) <= goal) return CONVERGED;
    before = now;
  }
  return SLOW;
}

// With diagonal blocks, as long as their budget lasts; false: not solved.
static bool solve_plainly(vsc_linear *linear, vsc_tangent *tangent, const double *free,
                          const double *x, const double *b, double tolerance, double *d,
                          bool *indefinite)
{
  const double before = linear->counts.iterations;
  // the matrix itself lacks the laws of smoothed tets
  const bool smoothed = linear->model->terms.smoothed;
  if (smoothed) vsc_tangent_precondition(linear->model, tangent, x);
  invert_blocks(linear, smoothed ? &tangent->preconditioner : &tangent->matrix);
  const outcome end =
      iterate(linear, tangent, free, b, tolerance, fmin(linear->past.plain_left, MOST_PLAIN), d);
  linear->past.plain_left -= linear->counts.iterations - before;
  *indefinite = end == NEGATIVE;
  const bool last = linear->past.plain_left == INFINITY;
  linear->counts.unfinished += last && end != CONVERGED;
  return last || end == CONVERGED;
}

// What a factorisation costs, in iterations.
static double worth(const vsc_linear *linear)
{
  return LEAST_WORTH + linear->counts.factor_flops / (WORTH * linear->counts.factor_entries);
}

// With a factor that may be of an older matrix: false when it is not solved with as many iterations more than with a
// fresh factor as a factorisation costs. Once they are spent, in one solution or in several, the factor is too old.
static bool solve_with_old_factor(vsc_linear *linear, const vsc_tangent *tangent, const double *free, const double *b,
                                  double tolerance, double *d)
{
  vsc_linear_past *past = &linear->past;
  if (past->factorized == 0) return false;
  const double usual = -past->rate * log10(tolerance), left = worth(linear) - past->spent;
  if (left <= 0) return false;
  const double before = linear->counts.iterations;
  const outcome end = iterate(linear, tangent, free, b, tolerance, ceil(usual + left), d);
  past->spent += fmax(linear->counts.iterations - before - usual, 0);
  return end == CONVERGED;
}

vsc_status vsc_linear_solve(vsc_linear *linear, vsc_tangent *tangent, const double *free,
                            const double *x, const double *b, double tolerance, double *d,
                            bool *indefinite, vsc_error *error)
{
  *indefinite = false;
  vsc_block_matrix_hold(&tangent->matrix, free, vsc_block_matrix_largest(&tangent->matrix, free));
  memset(linear->p, 0, 4 * linear->model->node_count * sizeof *linear->p);
  if (vsc_linear_is_plain(linear) && solve_plainly(linear, tangent, free, x, b, tolerance, d, indefinite))
    return VSC_OK;
  vsc_status status = make_again(linear, tangent, error);
  if (status != VSC_OK) return status;
  if (solve_with_old_factor(linear, tangent, free, b, tolerance, d)) return VSC_OK;
  status = factorize(linear, tangent, free, x, error);
  if (status != VSC_OK && linear->too_large && linear->kind == VSC_LINEAR_AUTO) {
    linear->past.budget = linear->past.plain_left = INFINITY;
    solve_plainly(linear, tangent, free, x, b, tolerance, d, indefinite);
    return VSC_OK;
  }
  if (status != VSC_OK) return status;
  const double before = linear->counts.iterations;
  const outcome end = iterate(linear, tangent, free, b, tolerance, MOST_ITERATIONS, d);
  if (end == NO_MEMORY) return vsc_fail_memory(error, "the linear solver");
  *indefinite = end == NEGATIVE;
  linear->counts.unfinished += end != CONVERGED;
  linear->past.rate = (linear->counts.iterations - before) / -log10(tolerance);
  return VSC_OK;
}
