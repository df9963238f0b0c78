// SPDX-License-Identifier: GPL-3.0-or-later
// Contact with planes and spheres: no node inside, no energy from nothing, Coulomb's friction.
#include "base/vec3.h"
#include "small_body.h"
#include "solve/contact.h"

static const double GRAVITY = 9.81e-3;  // mm/ms^2

// An elastic block of 3 x 3 x 3 mm, free, with room for obstacles.
static void open_block(small_body *body, vsc_obstacle_def *obstacles, size_t count, double damping)
{
  body_open(body, block_of(3, 3, 3, 1, 0.2), 50);
  for (int a = 0; a < 3; a++) body->material.damping[a] = damping;
  body->definition.obstacles = obstacles;
  body->definition.obstacle_count = count;
  body->definition.end_time = 1000;
}

static vsc_obstacle_def plane(double x, double y, double z, double nx, double ny, double nz,
                              double friction)
{
  vsc_obstacle_def def = vsc_default_obstacle();
  def.kind = VSC_OBSTACLE_PLANE;
  memcpy(def.point, (double[]){x, y, z}, sizeof def.point);
  memcpy(def.normal, (double[]){nx, ny, nz}, sizeof def.normal);
  def.friction = friction;
  return def;
}

static void advance(small_body *body, double until)
{
  vsc_error error;
  if (vsc_advance(body->model, body->state, until, &error) != VSC_OK) fail_msg("%s", error.text);
}

// The least distance of any node from any obstacle, below 0 inside: of what stands still, or moves by
// a ramp.
static double deepest(const small_body *body)
{
  double least = INFINITY;
  for (size_t o = 0; o < body->definition.obstacle_count; o++) {
    const vsc_obstacle_def *def = &body->definition.obstacles[o];
    const double part = fmin(body->state->time / def->curve.duration, 1);
    for (size_t n = 0; n < body->model->node_count; n++) {
      double way[3];
      for (int i = 0; i < 3; i++)
        way[i] = body->state->x[4 * n + i] - def->point[i] -
                 (def->motion[i] != 0 ? part * def->motion[i] : 0);
      const double gap = def->kind == VSC_OBSTACLE_SPHERE
                             ? vsc_norm(way) - def->radius
                             : vsc_dot(way, def->normal) / vsc_norm(def->normal);
      least = fmin(least, gap);
    }
  }
  return least;
}

static double energy(small_body *body, vsc_ledger *ledger, double *balance)
{
  vsc_totals t;
  vsc_observe(body->model, body->state, ledger, false, &t);
  *balance = vsc_balance_error(ledger, &t);
  return t.kinetic + t.axial + t.angular + t.volume_energy + t.gravity_energy;
}

// Dropped from 2 mm without damping: it bounces, never enters the table beyond rounding, and never has
// more energy than at the start but for Verlet's own swing. Returns the largest part of the energy of
// the fall that the ledger cannot explain.
static double drop(double safety)
{
  small_body body;
  vsc_ledger *ledger;
  double balance, unexplained = 0;
  vsc_obstacle_def table = plane(0, 0, -2, 0, 0, 1, 0.4);
  open_block(&body, &table, 1, 0);
  body.definition.gravity[2] = -GRAVITY;
  body.definition.gravity[0] = 0.2 * GRAVITY;
  body.definition.safety = safety;
  body_build(&body);
  body_start(&body);
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  const double start = energy(&body, ledger, &balance);
  const double fall = body.model->total_mass * GRAVITY * 2;
  bool touched = false;
  for (double time = 0.25; time < 60; time += 0.25) {
    advance(&body, time);
    const double now = energy(&body, ledger, &balance);
    assert_true(deepest(&body) >= -1e-12);
    // gravity works along x too while it slides: only what is above the start counts
    assert_true(now <= start + 2e-3 * fall);
    unexplained = fmax(unexplained, fabs(balance));
    touched |= deepest(&body) < 1e-9;
  }
  assert_true(touched);
  assert_true(body.state->contact[0].lost > 0.2 * fall);
  vsc_ledger_free(ledger);
  body_close(&body);
  return unexplained / fall;
}

// What the ledger cannot explain falls with the step: velocities are looked at at full steps, contact
// acts in their middle.
static void a_dropped_block_gains_nothing(void **state)
{
  (void)state;
  const double coarse = drop(0.8), fine = drop(0.1);
  assert_true(coarse < 0.04);
  assert_true(fine < 0.3 * coarse);
}

// Whether an impulse is left whose work is not counted.
static bool is_pending(const small_body *body)
{
  for (size_t i = 0; i < 4 * body->model->node_count; i++)
    if (body->state->pending[i] != 0) return true;
  return false;
}

// Thrown at a table that it touches: what the lowest nodes bring is lost in the first step.
static void what_is_thrown_loses_what_it_brings(void **state)
{
  (void)state;
  const double speed = 0.1;
  small_body body;
  vsc_obstacle_def table = plane(0, 0, 0, 0, 0, 1, 0);
  double lowest = 0;
  open_block(&body, &table, 1, 0);
  vsc_array *given = vsc_arrays_add(&body.mesh->node_data, "given", 3, body.mesh->node_count);
  for (size_t n = 0; n < body.mesh->node_count; n++) given->values[3 * n + 2] = -speed;
  body.definition.velocity = (vsc_velocity_def){.array = "given", .unit = 1};
  body_build(&body);
  body_start(&body);
  for (size_t n = 0; n < body.model->node_count; n++)
    if (body.model->rest[4 * n + 2] == 0) lowest += body.model->mass[n];
  assert_int_equal(vsc_steps(body.model, body.state, 0.5 * body.state->limit.step, 1, NULL), VSC_OK);
  // m v^2/2, to the rounding of the places
  assert_close(body.state->contact[0].lost, 0.5 * lowest * speed * speed, 1e-10, 0);
  // what nodes got at the end of the step is counted in the next, even if nothing touches then
  assert_true(is_pending(&body));
  for (size_t n = 0; n < body.model->node_count; n++) body.state->x[4 * n + 2] += 1;
  assert_int_equal(vsc_steps(body.model, body.state, 0.5 * body.state->limit.step, 1, NULL), VSC_OK);
  assert_false(is_pending(&body));
  body_close(&body);
}

// Steepest descent of the centre of mass after it has settled on a slope.
static double slide(double angle, double friction)
{
  small_body body;
  double v[3] = {0};
  // the slope is the plane z = 0, gravity is tilted
  vsc_obstacle_def slope = plane(0, 0, 0, 0, 0, 1, friction);
  open_block(&body, &slope, 1, 2);
  body.definition.gravity[0] = GRAVITY * sin(angle);
  body.definition.gravity[2] = -GRAVITY * cos(angle);
  body_build(&body);
  body_start(&body);
  advance(&body, 40);
  for (int turn = 0; turn < 2; turn++) {
    v[turn] = 0;
    for (size_t n = 0; n < body.model->node_count; n++)
      v[turn] += body.model->mass[n] * body.state->v[4 * n] / body.model->total_mass;
    if (turn == 0) advance(&body, 90);
  }
  body_close(&body);
  return (v[1] - v[0]) / 50;
}

// Below the angle of friction it stays, above it slides with g (sin a - mu cos a).
static void coulombs_law_on_a_slope(void **state)
{
  (void)state;
  assert_close(slide(atan(0.4), 0.5), 0, 0, 5e-4 * GRAVITY);
  const double angle = atan(0.8);
  assert_close(slide(angle, 0.5), GRAVITY * (sin(angle) - 0.5 * cos(angle)), 2e-3, 0);
  assert_close(slide(angle, 0), GRAVITY * sin(angle), 1e-6, 0);
}

// In a corner of three planes, pulled into it: it comes to rest inside all three, and they bear its
// weight.
static void a_corner_holds_on_all_sides(void **state)
{
  (void)state;
  small_body body;
  vsc_obstacle_def corner[3] = {plane(0, 0, 0, 1, 0, 0, 0.1), plane(0, 0, 0, 0, 1, 0, 0.1),
                                plane(0, 0, 0, 0, 0, 3, 0.1)};
  open_block(&body, corner, 3, 3);
  for (int i = 0; i < 3; i++) body.definition.gravity[i] = -GRAVITY;
  body_build(&body);
  body_start(&body);
  advance(&body, 80);
  double before[3], force[3] = {0};
  for (int o = 0; o < 3; o++) before[o] = body.state->contact[o].impulse[o];
  advance(&body, 100);
  assert_true(deepest(&body) >= -1e-12);
  for (int o = 0; o < 3; o++) {
    force[o] = (body.state->contact[o].impulse[o] - before[o]) / 20;
    // the other two planes' friction bears a little of it
    assert_close(force[o], body.model->total_mass * GRAVITY, 0.3, 0);
  }
  body_close(&body);
}

// A sphere is pressed into a block that lies on a table: no node enters either, what the sphere does the
// table feels, and the work of its way is stored or lost in the ledger's terms.
static void a_sphere_presses(void **state)
{
  (void)state;
  small_body body;
  vsc_ledger *ledger;
  double balance;
  vsc_obstacle_def things[2] = {plane(0, 0, 0, 0, 0, 1, 0.5), vsc_default_obstacle()};
  things[1].kind = VSC_OBSTACLE_SPHERE;
  memcpy(things[1].point, (double[]){1.5, 1.5, 5.0}, sizeof things[1].point);
  things[1].radius = 2;
  things[1].motion[2] = -0.6;
  things[1].curve = vsc_default_curve(VSC_CURVE_RAMP);
  things[1].curve.duration = 100;
  open_block(&body, things, 2, 3);
  body_build(&body);
  body_start(&body);
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  energy(&body, ledger, &balance);
  for (double time = 1; time <= 150; time += 1) {
    advance(&body, time);
    assert_true(deepest(&body) >= -1e-12);
    energy(&body, ledger, &balance);
  }
  const vsc_contact_sums *table = &body.state->contact[0], *sphere = &body.state->contact[1];
  double table_before = table->impulse[2], sphere_before = sphere->impulse[2];
  advance(&body, 160);
  const double from_table = (table->impulse[2] - table_before) / 10;
  const double from_sphere = (sphere->impulse[2] - sphere_before) / 10;
  assert_true(from_sphere < 0);
  assert_close(from_table, -from_sphere, 1e-3, 0);  // still settling a little
  assert_true(sphere->work > 0);
  assert_close(table->work, 0, 0, 0);
  energy(&body, ledger, &balance);
  // the step's own error; measured 9e-4
  assert_true(fabs(balance) < 2e-3 * sphere->work);
  vsc_ledger_free(ledger);
  body_close(&body);
}

// An undamped block that a ball is pressed into and held in is shaken for 300 ms: nodes slide round the ball, which
// makes no energy of that. Pushed along the normal at the end of each step the block has five times as much then.
static void a_ball_makes_no_energy_of_what_slides_round_it(void **state)
{
  (void)state;
  small_body body;
  vsc_ledger *ledger;
  double balance;
  vsc_obstacle_def ball = vsc_default_obstacle();
  ball.kind = VSC_OBSTACLE_SPHERE;
  memcpy(ball.point, (double[]){1.4, 1.6, 5.0}, sizeof ball.point);
  ball.radius = 2;
  ball.motion[2] = -0.6;
  ball.curve = vsc_default_curve(VSC_CURVE_RAMP);
  ball.curve.duration = 20;
  open_block(&body, &ball, 1, 0);
  body_hold(&body, "z0", 1, 1, 1);
  body_build(&body);
  body_start(&body);
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  advance(&body, 20);
  body_shake(&body, 0.1);
  advance(&body, 21);
  const double before = energy(&body, ledger, &balance), lost = body.state->contact[0].lost;
  for (double time = 22; time <= 320; time++) advance(&body, time);
  const double after = energy(&body, ledger, &balance);
  // Verlet's own swing; measured 1e-3
  assert_close(after, before, 3e-3, 0);
  assert_close(body.state->contact[0].lost, lost, 0, 1e-4 * before);
  vsc_ledger_free(ledger);
  body_close(&body);
}

// A slope comes down on nodes that are held along x: it pushes along its normal all the same, and the support bears x.
static void supports_bear_what_an_obstacle_pushes(void **state)
{
  (void)state;
  small_body body;
  vsc_obstacle_def slope = plane(0, 0, 4.3, -0.4, 0, -1, 0);
  slope.motion[2] = -0.5;
  slope.curve = vsc_default_curve(VSC_CURVE_RAMP);
  slope.curve.duration = 20;
  open_block(&body, &slope, 1, 3);
  body_hold(&body, "z0", 1, 1, 1);
  body_hold(&body, "z1", 1, 0, 0);
  body_build(&body);
  body_start(&body);
  advance(&body, 40);
  const vsc_contact_sums *sums = &body.state->contact[0];
  assert_true(sums->impulse[2] < -1);
  assert_close(sums->impulse[0], 0.4 * sums->impulse[2], 1e-12, 0);
  // all of its work goes into the block; measured -0.25 %
  assert_close(sums->lost, 0, 0, 0.01 * sums->work);
  body_close(&body);
}

static void held_nodes_stay_and_bad_starts_are_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  vsc_model *model;
  vsc_obstacle_def table = plane(0, 0, 0.5, 0, 0, 1, 0);
  open_block(&body, &table, 1, 0);
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "obstacles[0]"));
  assert_non_null(strstr(error.text, "0.5 mm inside"));
  // a moving table cannot push nodes that are held
  table = plane(0, 0, 0, 0, 0, 1, 0);
  table.motion[2] = 1;
  table.curve = vsc_default_curve(VSC_CURVE_RAMP);
  table.curve.duration = 10;
  body_hold(&body, "z0", 1, 1, 1);
  body_build(&body);
  body_start(&body);
  advance(&body, 5);
  for (size_t n = 0; n < body.model->node_count; n++)
    if (body.model->inverse_mass[4 * n] == 0)
      for (int i = 0; i < 3; i++)
        assert_close(body.state->x[4 * n + i], body.model->rest[4 * n + i], 0, 0);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_dropped_block_gains_nothing),
      cmocka_unit_test(what_is_thrown_loses_what_it_brings),
      cmocka_unit_test(coulombs_law_on_a_slope),
      cmocka_unit_test(a_corner_holds_on_all_sides),
      cmocka_unit_test(a_sphere_presses),
      cmocka_unit_test(a_ball_makes_no_energy_of_what_slides_round_it),
      cmocka_unit_test(supports_bear_what_an_obstacle_pushes),
      cmocka_unit_test(held_nodes_stay_and_bad_starts_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
