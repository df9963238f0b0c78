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

// sin(pi t/T) is 1/6 at T asin(1/6)/pi; it is 1 % off its chord after h where it bends, by h^2 (pi/T)^2/8, or h pi/T behind
// the corner. A place of the table is 1/64 ms.
static void a_load_may_change_by_a_sixth_of_its_range(void **state)
{
  (void)state;
  small_body body;
  open_bar(&body, 0);
  const double sixth = LASTING * asin(1.0 / 6) / acos(-1), place = 1.0 / 64;
  assert_close(vsc_model_calm(body.model, body.state->x, 0, 400), START + 0.01 * LASTING / acos(-1), 0, place);
  assert_close(vsc_model_calm(body.model, body.state->x, START, 400), sixth, 0, place);
  assert_true(vsc_model_calm(body.model, body.state->x, 0, 50) == 50);
  assert_true(vsc_model_calm(body.model, body.state->x, START + LASTING, 200) == 200);
  assert_close(vsc_model_calm(body.model, body.state->x, START + LASTING / 2, 400), sqrt(0.08) * LASTING / acos(-1), 0.02, 0);
  body_close(&body);
}

// The first element is late by nothing, the last by 7 x 20 ms: when the first has done, others have not.
static void elements_that_are_late_count(void **state)
{
  (void)state;
  small_body body;
  open_bar(&body, 20);
  const double sixth = LASTING * asin(1.0 / 6) / acos(-1), place = 1.0 / 64, between = 140.0 / 63;
  assert_close(vsc_model_calm(body.model, body.state->x, 0, 400), START + 0.01 * LASTING / acos(-1), 0, place);
  for (int k = 0; k < 8; k++)
    assert_true(vsc_model_calm(body.model, body.state->x, START + 20 * k, 400) <= between + sixth);
  assert_true(vsc_model_calm(body.model, body.state->x, START + 140 + LASTING, 200) == 200);
  body_close(&body);
}

// A body whose support moves by 1 mm times a table of `count` points.
static void open_table(small_body *body, double *times, double *values, size_t count)
{
  body_open(body, block_of(1, 1, 1, 1, 0), 60);
  body_hold(body, "x0", 1, 1, 1);
  body->supports[0].motion[0] = 1;
  body->supports[0].curve = vsc_default_curve(VSC_CURVE_TABLE);
  body->supports[0].curve.point_count = count;
  body->supports[0].curve.times = times;
  body->supports[0].curve.values = values;
  body->definition.end_time = 1000;
  body_build(body);
}

// From step to step through a wave of a tenth of the range: all places are within a hundredth of the straight line between
// the ends, so that these see the wave.
static void a_small_wave_is_seen(void **state)
{
  (void)state;
  double times[] = {0, 490, 495, 500, 900, 1000}, values[] = {0, 0, 0.1, 0, 0, 1}, highest = 0;
  int steps = 0;
  small_body body;
  open_table(&body, times, values, 6);
  const vsc_curve *curve = &body.model->moved[0].curve;
  for (double time = 0; time < 800; steps++) {
    const double dt = vsc_model_calm(body.model, body.state->x, time, 400);
    const double from = vsc_curve_value(curve, time), to = vsc_curve_value(curve, time + dt);
    for (int k = 0; k <= 1000; k++)
      assert_close(vsc_curve_value(curve, time + dt * k / 1000), from + (to - from) * k / 1000, 0, 0.01 + 1e-3);
    highest = fmax(highest, to);
    time += dt;
  }
  assert_true(highest > 0.08);
  assert_true(steps < 20);
  body_close(&body);
}

// What ripples within a hundredth of the range goes on.
static void ripples_are_passed(void **state)
{
  (void)state;
  double times[102], values[102];
  for (int k = 0; k < 101; k++) {
    times[k] = 5 * k;
    values[k] = k % 2 == 0 ? 0 : 0.009;
  }
  times[101] = 1000;
  values[101] = 1;
  small_body body;
  open_table(&body, times, values, 102);
  assert_true(vsc_model_calm(body.model, body.state->x, 0, 400) == 400);
  body_close(&body);
}

// From 10 ms before the end of a ramp of 1/100 each ms it may go on by b: 0.01 x 10 b/(10 + b) = 0.01.
static void a_ramp_ends_near_a_step(void **state)
{
  (void)state;
  double times[] = {0, 100}, values[] = {0, 1};
  small_body body;
  open_table(&body, times, values, 2);
  assert_close(vsc_model_calm(body.model, body.state->x, 90, 400), 10 + 10.0 / 9, 0, 1.0 / 32);
  assert_close(vsc_model_calm(body.model, body.state->x, 20, 400), 100.0 / 6, 0, 1.0 / 64);
  assert_true(vsc_model_calm(body.model, body.state->x, 101, 400) == 400);
  body_close(&body);
}

// A ball or a plane 60 mm above a cube of 1 mm, that moves as `curve` says by `way` downwards.
static void open_obstacle(small_body *body, vsc_obstacle_def *thing, vsc_obstacle_kind kind, double way,
                          vsc_curve_def curve)
{
  const bool ball = kind == VSC_OBSTACLE_SPHERE;
  *thing = vsc_default_obstacle();
  thing->kind = kind;
  thing->radius = 0.5;
  thing->point[2] = ball ? 61.5 : 61;
  thing->normal[2] = -1;
  thing->motion[2] = -way;
  thing->curve = curve;
  body_open(body, block_of(1, 1, 1, 1, 0), 60);
  body->definition.obstacles = thing;
  body->definition.obstacle_count = 1;
  body->definition.end_time = 1000;
  body_build(body);
}

// It may come as near as it is away; from there on it is watched, a ball by half its radius.
static void an_obstacle_reaches_the_body_at_a_step(void **state)
{
  (void)state;
  vsc_curve_def ramp = vsc_default_curve(VSC_CURVE_RAMP), dip = vsc_default_curve(VSC_CURVE_HALF_SINE);
  const double place = 1.0 / 64;
  ramp.duration = 120;
  dip.duration = 700;
  small_body body;
  vsc_obstacle_def thing;
  for (int k = 0; k < 2; k++) {
    open_obstacle(&body, &thing, k == 0 ? VSC_OBSTACLE_SPHERE : VSC_OBSTACLE_PLANE, 60.5, dip);
    const double reached = vsc_model_calm(body.model, body.state->x, 0, 700);
    // the ball is 60 mm above the cube's middle and a little farther from its corners
    assert_close(reached, 700 * asin(60 / 60.5) / acos(-1), 0, k == 0 ? 10 : place);
    const double next = vsc_model_calm(body.model, body.state->x, reached, 700);
    assert_true(next > 1 && next < 25);
    body_close(&body);
  }
  open_obstacle(&body, &thing, VSC_OBSTACLE_SPHERE, 120, ramp);
  assert_close(vsc_model_calm(body.model, body.state->x, 61, 700), 0.25, 0, place);
  body_close(&body);
  open_obstacle(&body, &thing, VSC_OBSTACLE_PLANE, 120, ramp);
  assert_close(vsc_model_calm(body.model, body.state->x, 61, 700), 20, 0, place);
  body_close(&body);
}

// A jump is passed by two places of the table; a period is seen 16 times.
static void jumps_are_passed_and_periods_are_seen(void **state)
{
  (void)state;
  small_body body;
  double times[] = {0, 200, 200.001, 400}, values[] = {0, 0, 1, 1};
  open_table(&body, times, values, 4);
  assert_close(vsc_model_calm(body.model, body.state->x, 0, 400), 200, 0, 1.0 / 64);
  assert_true(vsc_model_calm(body.model, body.state->x, 200 - 1.0 / 128, 400) == 2.0 / 64);
  assert_true(vsc_model_calm(body.model, body.state->x, 200 - 1.0 / 128, 0.001) == 0.001);
  body_close(&body);
  body_open(&body, block_of(1, 1, 1, 1, 0), 60);
  body_hold(&body, "x0", 1, 1, 1);
  body.supports[0].motion[0] = 1;
  body.supports[0].curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  body.supports[0].curve.period = 800;
  body.supports[0].curve.duration = 800;
  body_build(&body);
  assert_true(vsc_model_calm(body.model, body.state->x, 400, 100) == 50);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_load_may_change_by_a_sixth_of_its_range),
      cmocka_unit_test(elements_that_are_late_count),
      cmocka_unit_test(a_small_wave_is_seen),
      cmocka_unit_test(ripples_are_passed),
      cmocka_unit_test(a_ramp_ends_near_a_step),
      cmocka_unit_test(an_obstacle_reaches_the_body_at_a_step),
      cmocka_unit_test(jumps_are_passed_and_periods_are_seen),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
