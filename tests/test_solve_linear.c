// SPDX-License-Identifier: GPL-3.0-or-later
// Linear systems: what is solved, and how, where the tangent is not positive definite.
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>

#include "base/mem.h"
#include "small_body.h"
#include "solve/cholmod.h"
#include "solve/linear.h"

typedef struct system_of {
  small_body body;
  vsc_tangent *tangent;
  vsc_linear *linear;
  double *b, *d, *product;
} system_of;

// The tangent of a bar that is squeezed to `part` of its length, and a right side of random numbers.
static void open_system(system_of *s, vsc_linear_kind kind, double part)
{
  vsc_error error;
  body_open(&s->body, block_of(6, 1, 1, 1, 0.1), 60);
  body_hold(&s->body, "x0", 1, 1, 1);
  body_hold(&s->body, "x1", 1, 1, 1);
  s->body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(&s->body);
  const vsc_model *model = s->body.model;
  const size_t count = 4 * model->node_count;
  uint64_t seed = 8;
  if (vsc_tangent_create(model, &s->tangent, &error) != VSC_OK ||
      vsc_linear_create(model, s->tangent, kind, &s->linear, &error) != VSC_OK)
    fail_msg("%s", error.text);
  s->b = vsc_alloc(count, sizeof *s->b);
  s->d = vsc_alloc(count, sizeof *s->d);
  s->product = vsc_alloc(count, sizeof *s->product);
  for (size_t n = 0; n < model->node_count; n++) {
    s->body.state->x[4 * n] *= part;
    for (size_t i = 4 * n; i < 4 * n + 3; i++) s->b[i] = model->inverse_mass[i] != 0 ? any_number(&seed) : 0;
  }
  vsc_tangent_assemble(model, s->tangent, s->body.state->x, NULL, NULL, 0, 1, 0, &s->body.state->scratch);
}

static void close_system(system_of *s)
{
  vsc_free(s->b);
  vsc_free(s->d);
  vsc_free(s->product);
  vsc_linear_free(s->linear);
  vsc_tangent_free(s->tangent);
  body_close(&s->body);
}

static vsc_status solve(system_of *s, double tolerance, bool *indefinite, vsc_error *error)
{
  return vsc_linear_solve(s->linear, s->tangent, s->body.model->inverse_mass, s->body.state->x, s->b, tolerance, s->d,
                          indefinite, error);
}

// |b - A d| / |b|
static double what_is_left(system_of *s)
{
  double left = 0, all = 0;
  vsc_tangent_times(s->tangent, s->body.model->inverse_mass, s->d, s->product);
  for (size_t i = 0; i < 4 * s->body.model->node_count; i++) {
    left += pow(s->b[i] - s->product[i], 2);
    all += pow(s->b[i], 2);
  }
  return sqrt(left / all);
}

static void every_way_solves_to_the_tolerance(void **state)
{
  (void)state;
  for (int kind = VSC_LINEAR_AUTO; kind <= VSC_LINEAR_ITERATIVE; kind++) {
    system_of s;
    bool indefinite;
    vsc_error error;
    open_system(&s, (vsc_linear_kind)kind, 1);
    assert_int_equal(solve(&s, 1e-9, &indefinite, &error), VSC_OK);
    assert_false(indefinite);
    assert_true(what_is_left(&s) <= 1.01e-9);
    assert_true((vsc_linear_counted(s.linear).factorizations > 0) == (kind == VSC_LINEAR_DIRECT));
    assert_close(vsc_linear_past_of(s.linear)->shift, 0, 0, 0);
    assert_close(vsc_linear_counted(s.linear).unfinished, 0, 0, 0);
    close_system(&s);
  }
}

// A bar squeezed to its middle buckles: its tangent has negative eigenvalues. The factor is that of the tangent with a
// raised diagonal, and what it leads to tells of the negative curvature.
static void a_raised_diagonal_factorizes_what_buckles(void **state)
{
  (void)state;
  system_of s;
  bool indefinite;
  vsc_error error;
  open_system(&s, VSC_LINEAR_DIRECT, 0.85);
  if (solve(&s, 1e-9, &indefinite, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_true(indefinite);
  assert_true(vsc_linear_past_of(s.linear)->shift > 0);
  assert_true(vsc_linear_counted(s.linear).factorizations >= 2);
  assert_close(vsc_linear_counted(s.linear).unfinished, 1, 0, 0);
  close_system(&s);
}

// Negative curvature ends iterations with diagonal blocks too, and that is counted.
static void what_is_not_solved_is_counted(void **state)
{
  (void)state;
  system_of s;
  bool indefinite;
  vsc_error error;
  open_system(&s, VSC_LINEAR_ITERATIVE, 0.85);
  assert_int_equal(solve(&s, 1e-9, &indefinite, &error), VSC_OK);
  assert_true(indefinite);
  assert_true(what_is_left(&s) > 1e-9);
  assert_close(vsc_linear_counted(s.linear).unfinished, 1, 0, 0);
  close_system(&s);
}

static pthread_t first_thread;
static atomic_bool over;
static volatile sig_atomic_t heard;

static void hear(int number)
{
  (void)number;
  heard = 1;
}

static void *terminate(void *nothing)
{
  while (!over) pthread_kill(first_thread, SIGTERM);
  return nothing;
}

// METIS would have a handler of its own for SIGTERM while it works: it must not take signals for its failure, and
// the program hears them.
static void termination_does_not_stop_the_ordering(void **state)
{
  (void)state;
  enum { NODES = 3000, NEAR = 8 };
  static int start[NODES + 1], row[NODES * (NEAR + 1)], order[NODES];
  cholmod_common common;
  const vsc_cholmod *cholmod;
  pthread_t other;
  struct sigaction usual, heeded = {.sa_handler = hear, .sa_flags = SA_RESTART};
  assert_int_equal(vsc_cholmod_load(&cholmod, NULL), VSC_OK);
  cholmod->start(&common);
  common.print = 0;
  for (int n = 0; n < NODES; n++) {
    start[n + 1] = start[n];
    for (int k = 0; k <= NEAR && n + k * k < NODES; k++) row[start[n + 1]++] = n + k * k;
  }
  cholmod_sparse graph = {.nrow = NODES, .ncol = NODES, .nzmax = (size_t)start[NODES], .p = start, .i = row, .stype = -1,
                          .itype = CHOLMOD_INT, .xtype = CHOLMOD_PATTERN, .dtype = CHOLMOD_DOUBLE, .sorted = 1, .packed = 1};
  sigaction(SIGTERM, &heeded, &usual);
  first_thread = pthread_self();
  assert_int_equal(pthread_create(&other, NULL, terminate, NULL), 0);
  int done = 0;
  for (int k = 0; k < 20; k++) done += cholmod->metis(&graph, NULL, 0, 1, order, &common);
  over = true;
  assert_int_equal(pthread_join(other, NULL), 0);
  sigaction(SIGTERM, &usual, NULL);
  cholmod->finish(&common);
  assert_int_equal(done, 20);
  assert_true(heard);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_way_solves_to_the_tolerance),
      cmocka_unit_test(a_raised_diagonal_factorizes_what_buckles),
      cmocka_unit_test(what_is_not_solved_is_counted),
      cmocka_unit_test(termination_does_not_stop_the_ordering),
  };
  vsc_parallel_set_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
