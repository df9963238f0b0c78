// SPDX-License-Identifier: GPL-3.0-or-later
// How far a step may go before a load changes: against formulas.
#include "model/calm.h"
#include "small_body.h"

#define START 100.0
#define LASTING 16.0

// A bar whose tets contract in a half sine, each `late` ms later for every mm along x.
static void open_bar(small_body *body, double late)
{
  body_open(body, block_of(8, 1, 1, 1, 0), 60);
  body_fibers(body, (double[3]){1, 0, 0});
  vsc_active_def *active = &body->material.active;
  active->kind = VSC_ACTIVE_TENSION;
  active->tension = 1;
  active->curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  active->curve.start = START;
  active->curve.duration = LASTING;
  body->definition.end_time = 400;
  if (late > 0) {
    vsc_copy_name(active->delay_array, "x");
    active->delay_unit = late;
    vsc_array *x = vsc_arrays_add(&body->mesh->element_data, "x", 1, body->mesh->element_count);
    for (size_t t = 0; t < body->mesh->element_count; t++) {
      double centre[3];
      vsc_mesh_element_centre(body->mesh, t, centre);
      x->values[t] = floor(centre[0]);
    }
  }
  body_build(body);
}

// sin(pi t/T) is 1/6 at T asin(1/6)/pi; a place of the table is 1/64 ms.
static void a_load_may_change_by_a_sixth_of_its_range(void **state)
{
  (void)state;
  small_body body;
  open_bar(&body, 0);
  const double sixth = LASTING * asin(1.0 / 6) / acos(-1), place = 1.0 / 64;
  assert_close(vsc_model_calm(body.model, 0, 400), START + sixth, 0, place);
  assert_close(vsc_model_calm(body.model, START, 400), sixth, 0, place);
  assert_true(vsc_model_calm(body.model, 0, 50) == 50);
  assert_true(vsc_model_calm(body.model, START + LASTING, 200) == 200);
  // round the top it may go longest: from 5/6 to 1 and back
  assert_close(vsc_model_calm(body.model, START + LASTING / 2, 400), LASTING * (0.5 - asin(5.0 / 6) / acos(-1)), 0, place);
  body_close(&body);
}

// The first element is late by nothing, the last by 7 x 20 ms: when the first has done, others have not.
static void elements_that_are_late_count(void **state)
{
  (void)state;
  small_body body;
  open_bar(&body, 20);
  const double sixth = LASTING * asin(1.0 / 6) / acos(-1), place = 1.0 / 64, between = 140.0 / 63;
  assert_close(vsc_model_calm(body.model, 0, 400), START + sixth, 0, place);
  for (int k = 0; k < 8; k++)
    assert_true(vsc_model_calm(body.model, START + 20 * k, 400) <= between + sixth);
  assert_true(vsc_model_calm(body.model, START + 140 + LASTING, 200) == 200);
  body_close(&body);
}

// A jump is passed by two places of the table; a period is seen 16 times.
static void jumps_are_passed_and_periods_are_seen(void **state)
{
  (void)state;
  small_body body;
  double times[] = {0, 200, 200.001, 400}, values[] = {0, 0, 1, 1};
  open_bar(&body, 0);
  body_close(&body);
  body_open(&body, block_of(1, 1, 1, 1, 0), 60);
  body_hold(&body, "x0", 1, 1, 1);
  body.supports[0].motion[0] = 1;
  body.supports[0].curve = vsc_default_curve(VSC_CURVE_TABLE);
  body.supports[0].curve.point_count = 4;
  body.supports[0].curve.times = times;
  body.supports[0].curve.values = values;
  body.definition.end_time = 400;
  body_build(&body);
  assert_close(vsc_model_calm(body.model, 0, 400), 200, 0, 1.0 / 64);
  assert_true(vsc_model_calm(body.model, 200 - 1.0 / 128, 400) == 2.0 / 64);
  assert_true(vsc_model_calm(body.model, 200 - 1.0 / 128, 0.001) == 0.001);
  body_close(&body);
  body_open(&body, block_of(1, 1, 1, 1, 0), 60);
  body_hold(&body, "x0", 1, 1, 1);
  body.supports[0].motion[0] = 1;
  body.supports[0].curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  body.supports[0].curve.period = 800;
  body.supports[0].curve.duration = 800;
  body_build(&body);
  assert_true(vsc_model_calm(body.model, 400, 100) == 50);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_load_may_change_by_a_sixth_of_its_range),
      cmocka_unit_test(elements_that_are_late_count),
      cmocka_unit_test(jumps_are_passed_and_periods_are_seen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
