// SPDX-License-Identifier: GPL-3.0-or-later
// Relaxation that fails: what it says, and what it leaves.
#include "solve/relax.h"

#include "small_body.h"
#include "solve/solve.h"
#include "trap.h"

// A block under a ramp to `peak` kPa at 10 ms on all of its surface.
static void open_loaded(small_body *body, vsc_selector *surface, double peak)
{
  body_open(body, block_of(4, 2, 2, 1, 0.1), 200);
  body_hold(body, "x0", 1, 1, 1);
  *surface = (vsc_selector){.kind = VSC_SELECT_BOUNDARY};
  vsc_copy_name(surface->name, "skin");
  body->pressure = (vsc_pressure_def){.peak = peak, .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  body->pressure.curve.duration = 10;
  vsc_copy_name(body->pressure.surface, "skin");
  body->definition.surfaces = surface;
  body->definition.surface_count = 1;
  body->definition.pressures = &body->pressure;
  body->definition.pressure_count = 1;
  body->definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body->definition.solve.method = VSC_STATICS_RELAXATION;
  body_build(body);
}

// The body is torn at once: the last equilibrium is left, from which it goes on.
static void a_torn_body_is_told_and_left_as_it_was(void **state)
{
  (void)state;
  small_body body;
  vsc_selector surface;
  vsc_error error = {.text = ""};
  open_loaded(&body, &surface, -1e6);
  const size_t count = 4 * body.model->node_count;
  assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
  assert_int_equal(vsc_solve_to(body.model, body.state, 1e-6, &error), VSC_OK);
  double *before = malloc(count * sizeof *before);
  memcpy(before, body.state->x, count * sizeof *before);
  trap_off();
  const vsc_status status = vsc_solve_to(body.model, body.state, 10, &error);
  trap_on();
  assert_int_equal(status, VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "at 10 ms no equilibrium was found: in step "));
  assert_non_null(strstr(error.text, " is no longer a finite number; it is of element "));
  assert_non_null(strstr(error.text, " mN, is that of volume; take a smaller load"));
  assert_null(strstr(error.text, "tolerance"));
  assert_memory_equal(body.state->x, before, count * sizeof *before);
  for (size_t i = 0; i < count; i++) assert_true(body.state->v[i] == 0);
  assert_true(body.state->time == 1e-6);
  assert_int_equal(vsc_solve_to(body.model, body.state, 2e-6, &error), VSC_OK);
  free(before);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(a_torn_body_is_told_and_left_as_it_was)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
