// SPDX-License-Identifier: GPL-3.0-or-later
// Where the first number is lost: against the same steps, one by one.
#include "solve/lost.h"

#include "base/mem.h"
#include "small_body.h"
#include "trap.h"

// A shaken block in forced steps, `longer` times the stable one.
static void open_forced(small_body *body, double longer)
{
  for (int turn = 0; turn < 2; turn++) {
    const double step = turn == 0 ? 0 : longer * body->state->limit.step / body->model->safety;
    if (turn == 1) body_close(body);
    body_open(body, block_of(3, 2, 2, 1, 0.1), 500);
    body_hold(body, "x0", 1, 1, 1);
    body->definition.step = step;
    body->definition.force_step = true;
    body_build(body);
    body_start(body);
  }
  body_shake(body, 0.01);
}

// Steps a like body until a number is lost, and what pulled at that node before.
static vsc_culprit expected(small_body *body, size_t node)
{
  const size_t bytes = 4 * body->model->node_count * sizeof(double);
  double *x = malloc(bytes), *v = malloc(bytes), time = 0;
  while (vsc_state_find_bad(body->model, body->state) == body->model->node_count) {
    memcpy(x, body->state->x, bytes);
    memcpy(v, body->state->v, bytes);
    time = body->state->time;
    body_steps(body, body->model->step, 1);
  }
  const double *lost = body->state->x + 4 * node, *speed = body->state->v + 4 * node;
  assert_false(isfinite(lost[0] + lost[1] + lost[2] + speed[0] + speed[1] + speed[2]));
  double *aligned_x = body->state->a, *aligned_v = body->state->force;
  memcpy(aligned_x, x, bytes);
  memcpy(aligned_v, v, bytes);
  const vsc_culprit culprit = vsc_find_culprit(body->model, aligned_x, aligned_v, time, &body->state->scratch, node);
  free(x);
  free(v);
  return culprit;
}

// Steps three times too long: long after the first number all are lost, which vsc_advance sees.
static void the_first_is_found(void **nothing)
{
  (void)nothing;
  small_body body, other, third;
  vsc_error error;
  vsc_lost lost;
  open_forced(&body, 3);
  open_forced(&other, 3);
  open_forced(&third, 3);
  trap_off();
  assert_true(vsc_find_lost(body.model, body.state, 90, &lost));
  const vsc_culprit culprit = expected(&other, lost.node);
  assert_int_equal(vsc_advance(third.model, third.state, 90, &error), VSC_NUMERICAL);
  trap_on();
  assert_true(lost.steps == other.state->steps);
  assert_close(lost.time, other.state->time, 1e-12, 0);
  assert_true(lost.steps < third.state->steps);
  assert_non_null(lost.culprit.term);
  assert_string_equal(lost.culprit.term, culprit.term);
  assert_close(lost.culprit.force, culprit.force, 1e-12, 0);
  assert_true(isfinite(lost.culprit.force));
  assert_int_equal(lost.culprit.element, culprit.element);
  assert_true(body.model->inverse_mass[4 * lost.node] > 0);
  body_close(&body);
  body_close(&other);
  body_close(&third);
}

// Where nothing is lost, or memory is short, nothing is told.
static void what_is_not_lost(void **nothing)
{
  (void)nothing;
  vsc_lost lost;
  for (int k = 0; k < 7; k++) {
    small_body body;
    open_forced(&body, k == 0 ? 0.5 : 3);
    if (k > 0) trap_off();
    vsc_alloc_fail_after(k - 1);
    const bool found = vsc_find_lost(body.model, body.state, 5, &lost);
    vsc_alloc_fail_after(-1);
    if (k > 0) trap_on();
    if (k == 0) assert_close(body.state->time, 5, 1e-2, 0);
    assert_true(found == (k == 6));
    body_close(&body);
  }
}

// A wall meets a block at rest, and in the next step goes beyond all numbers: that it does so is no force of the model.
static void obstacles_are_named(void **nothing)
{
  (void)nothing;
  small_body body;
  vsc_lost lost;
  double times[] = {0, 0.101, 0.109, 0.111, 0.119, 1}, values[] = {0, 0, 1e-302, 1e-302, 1, 1};
  vsc_obstacle_def wall = {.kind = VSC_OBSTACLE_PLANE, .point = {1, 0, 0}, .normal = {-1, 0, 0}, .motion = {-1e300, 0, 0}};
  wall.curve = vsc_default_curve(VSC_CURVE_TABLE);
  wall.curve.times = times;
  wall.curve.values = values;
  wall.curve.point_count = 6;
  body_open(&body, block_of(1, 2, 2, 1, 0.1), 500);
  body_hold(&body, "x0", 1, 1, 1);
  body.definition.step = 0.01;
  body.definition.obstacles = &wall;
  body.definition.obstacle_count = 1;
  body_build(&body);
  body_start(&body);
  trap_off();
  const bool found = vsc_find_lost(body.model, body.state, 1, &lost);
  trap_on();
  assert_true(found);
  assert_close(lost.time, 0.12, 1e-9, 0);
  assert_string_equal(lost.culprit.term, "an obstacle");
  assert_close(lost.culprit.force, body.model->mass[lost.node] * 0.01 / (0.01 * 0.01), 0.15, 0);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_first_is_found),
      cmocka_unit_test(what_is_not_lost),
      cmocka_unit_test(obstacles_are_named),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
