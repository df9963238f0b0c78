// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method by itself: where it starts, and what it says where it cannot end: numbers that are lost, pressures
// that keep no volume, supports that go too far.
#include "solve/newton.h"

#include "base/mem.h"
#include "small_body.h"
#include "solve/solve.h"
#include "trap.h"

static void open_hanging(small_body *body, vsc_solve_kind kind)
{
  body_open(body, block_of(4, 2, 2, 1, 0.1), 20);
  body_hold(body, "x0", 1, 1, 1);
  body->definition.gravity[2] = -0.01;
  body->definition.solve.kind = kind;
  body_build(body);
}

// A position that is no number is never in balance.
static void lost_positions_are_told(void **state)
{
  (void)state;
  static const vsc_solve_kind kinds[] = {VSC_SOLVE_IMPLICIT, VSC_SOLVE_EQUILIBRIUM};
  for (int k = 0; k < 2; k++) {
    small_body body;
    vsc_error error = {.text = ""};
    open_hanging(&body, kinds[k]);
    assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
    body.state->x[4 * body_node(&body, 22) + 2] = NAN;
    trap_off();
    const vsc_status status = vsc_solve_to(body.model, body.state, 1, &error);
    trap_on();
    assert_int_equal(status, VSC_NUMERICAL);
    assert_non_null(strstr(error.text, "the position of node 22, at rest at ("));
    assert_non_null(strstr(error.text, "is no longer a finite number; take a smaller load"));
    assert_true(body.state->time == 0);
    body_close(&body);
  }
}

// Forces that are infinite at the context's node; the tangent is never asked for.
static void infinite_residual(void *context, const double *x, double *r)
{
  (void)x;
  const small_body *body = context;
  memset(r, 0, 4 * body->model->node_count * sizeof *r);
  r[4 * body_node(body, 22) + 1] = INFINITY;
}

static void no_tangent(void *context, const double *x, const double *before, vsc_tangent *tangent)
{
  (void)context;
  (void)x;
  (void)before;
  (void)tangent;
  fail_msg("a tangent of what is no number");
}

// Told with and without memory for the table of iterations.
static void infinite_forces_are_told(void **state)
{
  (void)state;
  for (int memory = 0; memory < 2; memory++) {
    small_body body;
    vsc_error error = {.text = ""};
    vsc_newton *newton;
    int iterations;
    open_hanging(&body, VSC_SOLVE_EQUILIBRIUM);
    assert_int_equal(vsc_newton_create(body.model, &newton, &error), VSC_OK);
    vsc_newton_begin(newton, body.model->weight);
    const vsc_balance balance = {&body, infinite_residual, no_tangent, NULL, NULL};
    vsc_alloc_fail_after(memory == 0 ? 0 : -1);
    trap_off();
    const vsc_status status = vsc_newton_solve(newton, &balance, 1, 1, body.state->x, &iterations, &error);
    trap_on();
    vsc_alloc_fail_after(-1);
    assert_int_equal(status, VSC_NUMERICAL);
    assert_non_null(strstr(error.text, "the force on node 22, at rest at ("));
    assert_int_equal(newton->row_count, memory);
    vsc_newton_free(newton);
    body_close(&body);
  }
}

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
    const vsc_balance balance = {&p, pulled_residual, pulled_tangent, pulled_stay, NULL};
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

// Nodes that can only slide along the body's surface: that is the reason, not the tangent.
static void pressures_that_keep_nothing_are_told(void **state)
{
  (void)state;
  small_body body;
  vsc_error error = {.text = ""};
  body_open(&body, block_of(2, 2, 2, 1, 0), 20);
  body_hold(&body, "z0", 0, 0, 1);
  body_hold(&body, "z1", 0, 0, 1);
  body_hold(&body, "x0", 1, 1, 0);
  body.sets[2].kind = VSC_SELECT_BOX;  // all
  for (int a = 0; a < 3; a++) {
    body.sets[2].box_low[a] = -9;
    body.sets[2].box_high[a] = 9;
  }
  body.definition.kept_volume = VSC_KEEP_TOTAL;
  body.definition.gravity[2] = -0.01;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(&body);
  assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
  assert_int_equal(vsc_solve_to(body.model, body.state, 1, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "no equilibrium was found: no pressures can keep all 1 volumes: nothing that"));
  assert_null(strstr(error.text, "buckling"));
  body_close(&body);
}

// The second support goes too far, and no node of the first is blamed.
static void supports_that_go_too_far_are_told(void **state)
{
  (void)state;
  small_body body;
  vsc_error error = {.text = ""};
  body_open(&body, block_of(2, 1, 1, 1, 0), 20);
  body_hold(&body, "x0", 1, 1, 1);
  body_hold(&body, "x1", 1, 1, 1);
  for (int s = 0; s < 2; s++) {
    body.supports[s].motion[0] = s == 0 ? 1e-3 : -1e9;  // less than comes up with the loads at once
    body.supports[s].curve = vsc_default_curve(VSC_CURVE_RAMP);
    body.supports[s].curve.duration = 10;
  }
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(&body);
  assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
  assert_int_equal(vsc_solve_to(body.model, body.state, 10, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "supports move so far that elements turn inside out, element "));
  assert_non_null(strstr(error.text, ", at rest at ("));
  assert_null(strstr(error.text, "out of balance"));
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(lost_positions_are_told),
      cmocka_unit_test(infinite_forces_are_told),
      cmocka_unit_test(pressures_that_keep_nothing_are_told),
      cmocka_unit_test(supports_that_go_too_far_are_told),
      cmocka_unit_test(a_far_start_gives_way),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
