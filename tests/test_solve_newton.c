// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method by itself, on forces that are made up: where it starts.
#include "small_body.h"
#include "solve/newton.h"
#include "tools/shapes_block.h"

// The masses are springs that pull every node back to where it was; `other` is where else Newton's method may start.
typedef struct pulled {
  const vsc_model *model;
  double other;  // mm along every axis from there
  int asked;
} pulled;

static void pulled_residual(void *context, const double *x, double *r)
{
  const pulled *p = context;
  for (size_t i = 0; i < 4 * p->model->node_count; i++) r[i] = p->model->mass[i / 4] * (p->model->rest[i] - x[i]);
}

static void pulled_tangent(void *context, const double *x, const double *before, vsc_tangent *tangent)
{
  (void)x;
  (void)before;
  const pulled *p = context;
  vsc_block_matrix_clear(&tangent->matrix);
  vsc_tangent_add_masses(p->model, tangent, 1);
}

static void pulled_stay(void *context, double *x)
{
  pulled *p = context;
  p->asked++;
  for (size_t i = 0; i < 4 * p->model->node_count; i++) x[i] = p->model->rest[i] + (i % 4 < 3 ? p->other : 0);
}

// A start that is far out of balance gives way to another one, if that is nearer; one that is near does not.
static void a_far_start_gives_way(void **state)
{
  (void)state;
  static const struct {
    double start, other;  // mm
    int iterations, asked;
  } cases[] = {{100, 0, 0, 1}, {100, 200, 1, 1}, {10, 0, 1, 0}};
  for (int k = 0; k < 3; k++) {
    small_body body;
    vsc_error error;
    vsc_newton *newton;
    int iterations;
    body_open(&body, block_of(2, 2, 2, 1, 0), 200);
    body.definition.solve.kind = VSC_SOLVE_IMPLICIT;
    body_build(&body);
    for (size_t i = 0; i < 4 * body.model->node_count; i++)
      if (i % 4 < 3) body.model->inverse_mass[i] = 1 / body.model->mass[i / 4];
    assert_int_equal(vsc_newton_create(body.model, &newton, &error), VSC_OK);
    pulled p = {body.model, cases[k].other, 0};
    const vsc_balance balance = {&p, pulled_residual, pulled_tangent, pulled_stay};
    // the forces at work: those of a millimetre
    for (size_t i = 0; i < 4 * body.model->node_count; i++) {
      body.state->force[i] = i % 4 < 3 ? body.model->mass[i / 4] : 0;
      if (i % 4 < 3) body.state->x[i] = body.model->rest[i] + cases[k].start;
    }
    vsc_newton_begin(newton, body.state->force);
    assert_int_equal(vsc_newton_solve(newton, &balance, 1, 1, body.state->x, &iterations, &error), VSC_OK);
    assert_int_equal(iterations, cases[k].iterations);
    assert_int_equal(p.asked, cases[k].asked);
    for (size_t i = 0; i < 4 * body.model->node_count; i++) assert_close(body.state->x[i], body.model->rest[i], 0, 1e-9);
    vsc_newton_free(newton);
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_far_start_gives_way),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
