// SPDX-License-Identifier: GPL-3.0-or-later
#include "mech/coupled_mass.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "base/random.h"
#include "base/sort.h"
#include "mech/step_limit.h"

#define DAMPING 1.0     // nu
#define ALLOWANCE 1.02  // what the largest eigenvalue of M^-1 L may be too small by
enum { NODES_PER_PIECE = 256, LANCZOS_STEPS = 40 };
enum { CHAINS = 4 };  // sums that do not wait for one another

// ---- L

typedef struct coupling {
  uint32_t row, column;
  double k;
} coupling;

typedef struct couplings {
  coupling *list;
  size_t count, room;
  bool failed;  // memory was short
} couplings;

static void add_coupling(void *context, uint32_t a, uint32_t b, double k)
{
  couplings *all = context;
  if (all->count == all->room) {
    const size_t longer = all->room > 0 ? 2 * all->room : 1 << 16;
    all->failed = all->failed || !vsc_grow((void **)&all->list, all->room, longer, sizeof *all->list);
    if (all->failed) return;
    all->room = longer;
  }
  all->list[all->count++] = (coupling){a, b, k};
}

// Adds up numbers of the same place, of a sorted list.
static void add_up(couplings *all)
{
  size_t count = 0;
  for (size_t k = 0; k < all->count; k++) {
    coupling *c = &all->list[k], *to = &all->list[count - (count > 0)];
    if (count > 0 && to->row == c->row && to->column == c->column)
      to->k += c->k;
    else
      all->list[count++] = *c;
  }
  all->count = count;
}

// Rows of what is sorted and added up, filled to a whole number of CHAINS with zeros.
static bool take_rows(const vsc_model *model, const couplings *all, vsc_coupled_mass *mass)
{
  const size_t room = all->count + (CHAINS - 1) * model->node_count;
  if (!VSC_NEW(mass->start, model->node_count + 1) || !VSC_NEW(mass->columns, room) || !VSC_NEW(mass->entries, room))
    return false;
  uint32_t count = 0;
  for (size_t n = 0, k = 0; n < model->node_count; n++) {
    for (; k < all->count && all->list[k].row == n; k++, count++) {
      mass->columns[count] = all->list[k].column;
      mass->entries[count] = all->list[k].k;
    }
    for (; count % CHAINS != 0; count++) mass->columns[count] = (uint32_t)n;
    mass->start[n + 1] = count;
  }
  return true;
}

// ---- passes over the nodes

typedef struct rows {
  const vsc_model *model;
  vsc_spread_pass pass;
  const vsc_wide *a, *now, *last;
  vsc_wide *next;
} rows;

// sum_j L_nj e_j
VSC_INLINE vsc_wide row_times(const vsc_coupled_mass *mass, size_t n, const vsc_wide *e)
{
  vsc_wide sum[CHAINS] = {0};
  for (uint32_t k = mass->start[n], end = mass->start[n + 1]; k < end; k += CHAINS)
    for (uint32_t c = 0; c < CHAINS; c++) sum[c] += mass->entries[k + c] * e[mass->columns[k + c]];
  return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

VSC_CLONED static void spread_rows(void *context, size_t piece, int thread)
{
  (void)thread;
  const rows *r = context;
  const vsc_model *model = r->model;
  const vsc_wide *inverse_mass = (const vsc_wide *)model->inverse_mass;
  const size_t first = piece * NODES_PER_PIECE, end = first + NODES_PER_PIECE;
  for (size_t n = first; n < end && n < model->node_count; n++) {
    const vsc_wide image = inverse_mass[n] * row_times(&model->coupled, n, r->now);
    r->next[n] = r->pass.now * r->now[n] - r->pass.image * image - r->pass.last * r->last[n] + r->pass.source * r->a[n];
  }
}

static void pass_over(rows *r)
{
  vsc_parallel_for((r->model->node_count + NODES_PER_PIECE - 1) / NODES_PER_PIECE, spread_rows, r);
}

const double *vsc_coupled_mass_spread(const vsc_model *model, vsc_scratch *scratch, const double *a)
{
  vsc_wide *const next[2] = {(vsc_wide *)scratch->spread, (vsc_wide *)scratch->spread + model->node_count};
  rows r = {.model = model, .a = (const vsc_wide *)a, .now = (const vsc_wide *)a, .last = (const vsc_wide *)a};
  for (int k = 0; k < model->coupled.degree; k++) {
    r.pass = model->coupled.passes[k];
    r.next = next[k % 2];
    pass_over(&r);
    r.last = r.now;
    r.now = r.next;
  }
  return (const double *)r.now;
}

// ---- the polynomial

vsc_status vsc_coupled_mass_set_degree(vsc_model *model, int degree, vsc_error *error)
{
  vsc_coupled_mass *mass = &model->coupled;
  const double m = degree + 1, w0 = 1 + DAMPING * DAMPING / (2 * m * m), w1 = 1 + w0;
  vsc_free(mass->passes);
  mass->degree = 0;
  if (!VSC_NEW(mass->passes, (size_t)degree)) return vsc_fail_memory(error, "selective mass scaling");
  mass->degree = degree;
  // T_k(w0) and D_k(0) = T_k'(w0) of k - 1 and k
  double T[2] = {1, w0}, D[2] = {0, 1};
  for (int k = 0; k < degree; k++) {
    const double D_next = 2 * w0 * D[1] - D[0] + 2 * T[1], T_next = 2 * w0 * T[1] - T[0];
    mass->passes[k] = (vsc_spread_pass){.now = 2 * w0 * D[1] / D_next,
                                        .image = 2 * w1 / mass->largest * D[1] / D_next,
                                        .last = D[0] / D_next,
                                        .source = 2 * T[1] / D_next};
    D[0] = D[1], D[1] = D_next;
    T[0] = T[1], T[1] = T_next;
  }
  return VSC_OK;
}

// ---- the largest eigenvalue

static double product(const vsc_model *model, const vsc_wide *a, const vsc_wide *b)
{
  double sum = 0;
  for (size_t n = 0; n < model->node_count; n++) {
    const vsc_wide ab = a[n] * b[n];
    sum += model->mass[n] * (ab[0] + ab[1] + ab[2]);
  }
  return sum;
}

// 0 in held directions.
static void fill_random(const vsc_model *model, vsc_wide *v)
{
  uint64_t seed = 1;
  for (size_t n = 0; n < model->node_count; n++)
    for (size_t i = 0; i < 3; i++) {
      const double random = vsc_next_random(&seed);
      v[n][i] = model->inverse_mass[4 * n + i] > 0 ? random : 0;
    }
}

// The largest eigenvalue of the first rows and columns of T, and what it may be off by, its residual: beta times the last
// number of its eigenvector. NAN when memory is short.
static double largest_of(double *T, size_t steps, double beta)
{
  gsl_error_handler_t *handler = gsl_set_error_handler_off();
  gsl_matrix_view part = gsl_matrix_view_array_with_tda(T, steps, steps, LANCZOS_STEPS);
  gsl_vector *values = gsl_vector_alloc(steps);
  gsl_matrix *vectors = gsl_matrix_alloc(steps, steps);
  gsl_eigen_symmv_workspace *work = gsl_eigen_symmv_alloc(steps);
  double largest = NAN;
  if (values != NULL && vectors != NULL && work != NULL) {
    gsl_eigen_symmv(&part.matrix, values, vectors, work);
    const size_t last = gsl_vector_max_index(values);
    largest = gsl_vector_get(values, last) + beta * fabs(gsl_matrix_get(vectors, steps - 1, last));
  }
  if (work != NULL) gsl_eigen_symmv_free(work);
  if (vectors != NULL) gsl_matrix_free(vectors);
  if (values != NULL) gsl_vector_free(values);
  gsl_set_error_handler(handler);
  return largest;
}

// Gershgorin's bound.
static double bound_of(const vsc_model *model)
{
  double most = 0;
  for (size_t n = 0; n < model->node_count; n++) {
    double sum = 0;
    for (uint32_t k = model->coupled.start[n]; k < model->coupled.start[n + 1]; k++) sum += fabs(model->coupled.entries[k]);
    most = fmax(most, sum / model->mass[n]);
  }
  return most;
}

// The largest eigenvalue of M^-1 L, by Lanczos's method in the mass norm; of three vectors of the nodes.
static double largest_eigenvalue(const vsc_model *model, vsc_wide *v, vsc_wide *last, vsc_wide *next)
{
  double T[LANCZOS_STEPS * LANCZOS_STEPS] = {0};
  const size_t bytes = model->node_count * sizeof *v;
  rows r = {.model = model, .pass = {.image = -1}, .a = v, .now = v, .last = v, .next = next};
  double beta = 0;
  size_t steps = 0;
  fill_random(model, v);
  const double length = sqrt(product(model, v, v));
  if (!(length > 0)) return 0;
  for (size_t n = 0; n < model->node_count; n++) v[n] /= length;
  while (steps < LANCZOS_STEPS) {
    pass_over(&r);  // next = M^-1 L v
    const double alpha = product(model, v, next);
    T[(LANCZOS_STEPS + 1) * steps] = alpha;
    for (size_t n = 0; n < model->node_count; n++) next[n] -= alpha * v[n] + beta * last[n];
    beta = sqrt(product(model, next, next));
    if (++steps == LANCZOS_STEPS || !(beta > 1e-9 * alpha)) break;
    T[(LANCZOS_STEPS + 1) * steps - 1] = beta;  // GSL reads the lower half
    memcpy(last, v, bytes);
    for (size_t n = 0; n < model->node_count; n++) v[n] = next[n] / beta;
  }
  return largest_of(T, steps, beta);
}

static vsc_status find_largest(vsc_model *model, vsc_error *error)
{
  double *memory;
  if (!VSC_NEW(memory, 3 * 4 * model->node_count)) return vsc_fail_memory(error, "selective mass scaling");
  vsc_wide *v = (vsc_wide *)memory;
  const double found = largest_eigenvalue(model, v, v + model->node_count, v + 2 * model->node_count);
  model->coupled.largest = fmin(ALLOWANCE * found, bound_of(model));
  vsc_free(memory);
  if (model->coupled.largest > 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "time.selective_mass_scaling: nothing is stiff, or every node is held: leave it out");
}

vsc_status vsc_coupled_mass_create(vsc_model *model, double rate, vsc_error *error)
{
  couplings all = {0};
  vsc_coupled_mass_free(&model->coupled);
  vsc_limit_couplings(model, rate, add_coupling, &all);
  bool made = !all.failed && vsc_sort(all.list, all.count, sizeof *all.list / sizeof(uint32_t), 2);
  if (made) add_up(&all);
  made = made && take_rows(model, &all, &model->coupled);
  vsc_free(all.list);
  return made ? find_largest(model, error) : vsc_fail_memory(error, "selective mass scaling");
}
