// SPDX-License-Identifier: GPL-3.0-or-later
// Multipliers of shared volumes: how few rounds keep them, and what is left after an equilibrium that was not found.
#include "small_body.h"
#include "mech/force.h"
#include "solve/incompressible.h"
#include "solve/solve.h"

static vsc_status solve_to(small_body *body, double time, vsc_error *error)
{
  if (body->state->solver == NULL) {
    const vsc_status status = vsc_solve_start(body->model, body->state, error);
    if (status != VSC_OK) return status;
  }
  return vsc_solve_to(body->model, body->state, time, error);
}

// A bar of node-averaged tets that contracts, clamped at one end so that its volumes are harder to change than K is.
static void open_bar(small_body *body, double tension)
{
  body_open(body, block_of(6, 3, 3, 2, 0.2), 200);
  body_hold(body, "x0", 1, 1, 1);
  body_fibers(body, (const double[]){1, 0.3, 0.1});
  body->material.stabilization = 10;
  body->material.active = vsc_default_active();
  body->material.active.kind = VSC_ACTIVE_TENSION;
  body->material.active.tension = tension;
  body->definition.volume = VSC_VOLUME_NODAL;
  body->definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body->definition.solve.incompressible = 1e-4;
}

// Where the bar's end is, mm; J within [1 - off, 1 + off].
static double end_of(const small_body *body, double off)
{
  double *ratio = body->state->scratch.trial + 4 * body->model->node_count;
  vsc_group_ratios(body->model, body->state->x, &body->state->scratch, ratio);
  for (size_t n = 0; n < body->model->node_count; n++)
    if (body->model->group_modulus[n] > 0) assert_close(ratio[n], 1, 0, off);
  return body->state->x[4 * body_node(body, body->mesh->node_count - 1)];
}

// 39 and 53 iterations; updates without extrapolation take 451 here, and 31,740.
static void rounds_are_few(void **state)
{
  (void)state;
  vsc_error error;
  double end[2], iterations[2];
  for (int k = 0; k < 2; k++) {
    small_body body;
    open_bar(&body, 8);
    body.definition.solve.incompressible = k == 0 ? 1e-4 : 1e-6;
    body_build(&body);
    for (int time = 25; time <= 50; time += 25)
      if (solve_to(&body, time, &error) != VSC_OK) fail_msg("%s", error.text);
    const vsc_newton *newton = vsc_solve_newton(body.model, body.state);
    iterations[k] = newton->iterations;
    end[k] = end_of(&body, 1.01 * body.definition.solve.incompressible);
    body_close(&body);
  }
  assert_true(iterations[0] < 60);
  assert_true(iterations[1] < 90);
  assert_close(end[0], end[1], 0, 2e-3);
}

// Multipliers of the last equilibrium stay where a next one is not found.
static void what_fails_leaves_no_trace(void **state)
{
  (void)state;
  vsc_error error;
  small_body body;
  open_bar(&body, 8);
  body_build(&body);
  if (solve_to(&body, 25, &error) != VSC_OK) fail_msg("%s", error.text);
  const vsc_newton *newton = vsc_solve_newton(body.model, body.state);
  vsc_scratch *scratch = &body.state->scratch;
  const size_t bytes = body.model->node_count * sizeof(double);
  double *kept = malloc(bytes), *x = malloc(4 * bytes);
  if (kept == NULL || x == NULL) fail_msg("no memory");
  memcpy(kept, scratch->node_multiplier, bytes);
  memcpy(x, body.state->x, 4 * bytes);
  vsc_multipliers_begin(newton->multipliers, scratch);
  for (size_t n = 0; n < body.model->node_count; n++) x[4 * n] *= 1.1;
  assert_true(vsc_multipliers_update(newton->multipliers, x, scratch) > 0.05);
  assert_true(memcmp(kept, scratch->node_multiplier, bytes) != 0);
  vsc_multipliers_restore(newton->multipliers, scratch);
  assert_memory_equal(kept, scratch->node_multiplier, bytes);
  // what is good enough is not changed
  assert_true(vsc_multipliers_update(newton->multipliers, body.state->x, scratch) <= 1e-4);
  assert_memory_equal(kept, scratch->node_multiplier, bytes);
  free(kept);
  free(x);
  body_close(&body);
}

// Volumes that no number of rounds keeps: the bar is at rest as it was, and so are the multipliers.
static void an_equilibrium_that_is_not_found(void **state)
{
  (void)state;
  vsc_error error;
  small_body body;
  open_bar(&body, 8);
  body.definition.solve.incompressible = 1e-17;
  body_build(&body);
  assert_int_equal(solve_to(&body, 25, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "a volume is still off by"));
  for (size_t n = 0; n < body.model->node_count; n++) assert_true(body.state->scratch.node_multiplier[n] == 0);
  body_must_be_stretched(&body, (const double[]){1, 1, 1}, 0);
  body_close(&body);
}

// Without solver.incompressible there are none, with which these do nothing.
static void nothing_without(void **state)
{
  (void)state;
  small_body body;
  vsc_multipliers *multipliers;
  open_bar(&body, 8);
  body.definition.solve.incompressible = 0;
  body_build(&body);
  assert_int_equal(vsc_multipliers_create(body.model, &multipliers, NULL), VSC_OK);
  assert_null(multipliers);
  vsc_multipliers_begin(multipliers, &body.state->scratch);
  vsc_multipliers_restore(multipliers, &body.state->scratch);
  vsc_multipliers_free(multipliers);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(rounds_are_few),
      cmocka_unit_test(what_fails_leaves_no_trace),
      cmocka_unit_test(an_equilibrium_that_is_not_found),
      cmocka_unit_test(nothing_without),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
