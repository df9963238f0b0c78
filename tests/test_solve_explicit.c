// SPDX-License-Identifier: GPL-3.0-or-later
// Properties of the stepping: order, conservation, reversal, and the refusals of vsc_start and
// vsc_advance.
#include "small_body.h"
#include "trap.h"

// A jittered block of 27 bricks held at one end.
static void open_block(small_body *body)
{
  body_open(body, block_of(3, 3, 3, 3, 0.2), 50);
  body_hold(body, "z0", 1, 1, 1);
}

typedef struct motion_case {
  bool damped, active, nodal;
} motion_case;

// Positions after 4 ms in `steps` steps, from random velocities; the caller frees them.
static double *positions_after(motion_case c, size_t steps, size_t *count)
{
  small_body body;
  open_block(&body);
  for (int a = 0; a < 3; a++) body.material.damping[a] = c.damped ? 5 : 0;
  if (c.nodal) {
    body.definition.volume = VSC_VOLUME_NODAL;
    body.material.stabilization = 10;
  }
  if (c.active) {
    body_fibers(&body, (const double[]){1, 1, 0});
    body.material.active.kind = VSC_ACTIVE_TENSION;
    body.material.active.tension = 30;
    body.material.active.curve = vsc_default_curve(VSC_CURVE_TANH_PAIR);
    body.material.active.curve.start = 2;
    body.material.active.curve.duration = 3;
    body.material.active.curve.rise = body.material.active.curve.fall = 1;
    body.pressure =
        (vsc_pressure_def){.surface = "boundary", .peak = 3, .curve = body.material.active.curve};
    body.definition.pressure_count = 1;
    body.definition.pressures = &body.pressure;
    body.definition.gravity[0] = 0.1;
  }
  body.definition.end_time =
      10;  // the curve's table has 8192 intervals of this, far below the steps
  body_build(&body);
  body_shake(&body, 0.1);
  body_start(&body);
  body_steps(&body, 4.0 / (double)steps, steps);
  *count = 4 * body.model->node_count;
  double *x = malloc(*count * sizeof *x);
  if (x == NULL) fail_msg("no memory");
  memcpy(x, body.state->x, *count * sizeof *x);
  body_close(&body);
  return x;
}

// |x_h - x_h/2| / |x_h/2 - x_h/4| is 4 up to terms of h^2 (omega h is 0.2 for the stiffest mode at
// the first step, which alone would make 1 % of it).
static void check_order(motion_case c)
{
  size_t count;
  double *x[3], change[2] = {0};
  for (int r = 0; r < 3; r++) x[r] = positions_after(c, (size_t)200 << r, &count);
  for (int r = 0; r < 2; r++)
    for (size_t i = 0; i < count; i++) change[r] += pow(x[r][i] - x[r + 1][i], 2);
  print_message("order %.4f, change %.3g mm\n", 0.5 * log2(change[0] / change[1]), sqrt(change[1]));
  assert_true(sqrt(change[1]) > 1e-9);  // far above rounding
  assert_close(sqrt(change[0] / change[1]), 4, 0.03, 0);
  for (int r = 0; r < 3; r++) free(x[r]);
}

static void test_second_order(void **state)
{
  (void)state;
  check_order((motion_case){false, false, false});
  check_order((motion_case){false, false, true});
}

static void test_second_order_with_damping(void **state)
{
  (void)state;
  check_order((motion_case){true, false, false});
}

static void test_second_order_with_activation_and_loads(void **state)
{
  (void)state;
  check_order((motion_case){false, true, false});
  check_order((motion_case){true, true, true});
}

typedef struct invariants {
  double energy, momentum[3], spin[3];
} invariants;

static invariants observe(small_body *body, vsc_ledger *ledger)
{
  vsc_totals t;
  vsc_observe(body->model, body->state, ledger, false, &t);
  invariants found = {.energy = t.kinetic + t.axial + t.angular + t.volume_energy};
  memcpy(found.momentum, t.momentum, sizeof t.momentum);
  memcpy(found.spin, t.angular_momentum, sizeof t.angular_momentum);
  return found;
}

// The mean energy over 200 looks, one every fifth step: Verlet's energy swings with (omega h)^2
// about a mean that stays.
static double mean_energy(small_body *body, vsc_ledger *ledger, double dt)
{
  double sum = 0;
  for (int k = 0; k < 200; k++) {
    body_steps(body, dt, 5);
    sum += observe(body, ledger).energy / 200;
  }
  return sum;
}

// A free block that spins, flies and shakes, for 1e5 steps.
static void check_drift(bool nodal, double part_of_step)
{
  small_body body;
  body_open(&body, block_of(2, 2, 2, 3, 0.2), 50);
  if (nodal) {
    body.definition.volume = VSC_VOLUME_NODAL;
    body.material.stabilization = 10;
  }
  body_build(&body);
  const double *rest = body.model->rest;
  for (size_t k = 0; k < 4 * body.model->node_count; k += 4) {
    double *v = body.state->v + k;
    v[0] = 0.3 - 0.05 * rest[k + 1];
    v[1] = 0.1 + 0.05 * rest[k];
    v[2] = 0.2;
  }
  body_shake(&body, 0.05);
  body_start(&body);
  vsc_ledger *ledger;
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  const double dt = part_of_step * body.state->limit.step;
  const invariants first = observe(&body, ledger);
  const double early = mean_energy(&body, ledger, dt);
  body_steps(&body, dt, 98000);
  const double late = mean_energy(&body, ledger, dt);
  const invariants last = observe(&body, ledger);
  print_message("drift of energy %.2g of the whole, of the angular momentum %.2g\n",
                late / early - 1, last.spin[2] / first.spin[2] - 1);
  assert_close(late, early, 1e-4, 0);
  double momentum = 0, spin = 0, way = 0;
  for (int i = 0; i < 3; i++) {
    momentum = fmax(momentum, fabs(first.momentum[i]));
    spin = fmax(spin, fabs(first.spin[i]));
    way = fmax(way, fabs(body.state->x[i]));
  }
  // Verlet keeps both but for rounding: 1e5 random errors of 1e-16 of the forces' sums; about the
  // origin, from which the body has gone `way`, what momentum has lost counts for the angular
  // momentum too
  for (int i = 0; i < 3; i++)
    assert_close(last.momentum[i], first.momentum[i], 0, 1e-12 * momentum);
  for (int i = 0; i < 3; i++)
    assert_close(last.spin[i], first.spin[i], 0, 1e-11 * spin + 1e-12 * way * momentum);
  vsc_ledger_free(ledger);
  body_close(&body);
}

static void test_energy_and_momentum_stay(void **state)
{
  (void)state;
  check_drift(false, 0.5);
  check_drift(true, 0.5);
}

// Back with reversed velocities to where it began. Rounding, 1e-16 a step, is amplified by the
// motion's own instability: 1e-10 after 4000 steps leaves three digits for that.
static void test_time_reversal(void **state)
{
  (void)state;
  small_body body;
  open_block(&body);
  body_build(&body);
  body_shake(&body, 0.1);
  body_start(&body);
  const size_t count = 4 * body.model->node_count;
  double *v = malloc(count * sizeof *v);
  assert_non_null(v);
  memcpy(v, body.state->v, count * sizeof *v);
  const double dt = 0.5 * body.state->limit.step;
  body_steps(&body, dt, 2000);
  double way = 0;
  for (size_t i = 0; i < count; i++) {
    way = fmax(way, fabs(body.state->x[i] - body.model->rest[i]));
    body.state->v[i] = -body.state->v[i];
  }
  print_message("way %g\n", way);
  assert_true(way > 0.05);
  body_steps(&body, dt, 2000);
  for (size_t i = 0; i < count; i++) {
    assert_close(body.state->x[i], body.model->rest[i], 0, 1e-10);
    assert_close(body.state->v[i], -v[i], 0, 1e-10);
  }
  free(v);
  body_close(&body);
}

// Verlet is exact for constant acceleration. Each position then is wrong by the rounding of its own
// size, 100 mm, and strains of rounding (1e-15) are pushed back by the springs, not summed up.
static void test_free_fall(void **state)
{
  (void)state;
  small_body body;
  body_open(&body, block_of(3, 3, 3, 3, 0.2), 50);
  const double g[3] = {0.002, 0.001, -0.00981};
  memcpy(body.definition.gravity, g, sizeof g);
  body_build(&body);
  body_start(&body);
  const double dt = body.state->limit.step;
  body_steps(&body, dt, 1000);
  const double t = 1000 * dt;
  assert_close(body.state->time, t, 1e-13, 0);
  for (size_t k = 0; k < 4 * body.model->node_count; k++) {
    const double fall = k % 4 < 3 ? g[k % 4] : 0;
    assert_close(body.state->x[k] - body.model->rest[k], 0.5 * fall * t * t, 1e-12, 1e-11);
    assert_close(body.state->v[k], fall * t, 1e-12, 1e-12);
  }
  body_close(&body);
}

// A step above the stable one is refused with both numbers; one just below is taken, though a step of its own
// length would be shorter by the safety.
static void test_large_step_is_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  char number[32];
  open_block(&body);
  body_build(&body);
  body_start(&body);
  const double stable = body.state->limit.step / body.model->safety;
  assert_true(body.model->safety < 1);
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body.definition.step = 1.001 * stable;
  body_build(&body);
  assert_int_equal(vsc_start(body.model, body.state, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "time.step"));
  snprintf(number, sizeof number, "%.6g", stable);
  assert_non_null(strstr(error.text, number));
  snprintf(number, sizeof number, "%.6g", 1.001 * stable);
  assert_non_null(strstr(error.text, number));
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body.definition.step = 0.999 * stable;
  body_build(&body);
  assert_int_equal(vsc_start(body.model, body.state, &error), VSC_OK);
  const double steps = ceil(1 / (0.999 * stable));
  assert_int_equal(vsc_advance(body.model, body.state, 1, &error), VSC_OK);
  assert_true(body.state->steps >= steps &&
              body.state->steps <= steps + 4);  // rounded up between estimates
  body_close(&body);
}

// Steps of the user's length are just that long, wherever the looks are, and lead past them; the same
// as so many steps at once.
static void test_steps_of_the_users_length(void **state)
{
  (void)state;
  small_body body, other;
  vsc_error error;
  open_block(&body);
  body_build(&body);
  body_start(&body);
  const double step = 0.7 * body.state->limit.step;
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body.definition.step = step;
  body_build(&body);
  body_start(&body);
  body_shake(&body, 0.5);
  for (double until = 0.31; until < 5; until += 0.31) {
    assert_int_equal(vsc_advance(body.model, body.state, until, &error), VSC_OK);
    assert_close(body.state->time, step * ceil(until / step), 1e-14, 0);
    assert_close(body.state->steps, ceil(until / step), 0, 0);
  }
  open_block(&other);
  other.definition.step = step;
  body_build(&other);
  body_start(&other);
  body_shake(&other, 0.5);
  body_steps(&other, step, (size_t)body.state->steps);
  assert_int_equal(memcmp(other.state->x, body.state->x, 32 * body.model->node_count), 0);
  body_close(&other);
  body_close(&body);
}

// Forced, a step above the stable one is taken, and the body flies apart: that is the user's wish,
// and the message still says when.
static void test_forced_step(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  open_block(&body);
  body_build(&body);
  body_start(&body);
  const double stable = body.state->limit.step / body.model->safety;
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body.definition.step = 1.5 * stable;
  body.definition.force_step = true;
  body_build(&body);
  body_start(&body);
  body_shake(&body, 0.1);
  assert_int_equal(vsc_advance(body.model, body.state, 10000 * stable, &error), VSC_NUMERICAL);
  assert_true(body.state->steps > 1);
  assert_non_null(strstr(error.text, "ms"));
  body_close(&body);
}

// A spring that will be stiff at the peak counts before the first step.
static void test_activation_counts_for_the_step(void **state)
{
  (void)state;
  double step[2];
  for (int active = 0; active < 2; active++) {
    small_body body;
    vsc_error error;
    open_block(&body);
    body_fibers(&body, (const double[]){0, 0, 1});
    if (active) {
      body.material.active.kind = VSC_ACTIVE_SPRING;
      body.material.active.stiffness = 2000;
      body.material.active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
      body.material.active.curve.duration = 50;
      body.definition.step = step[0];
    }
    body_build(&body);
    assert_int_equal(vsc_start(body.model, body.state, &error), active ? VSC_INPUT : VSC_OK);
    if (active) assert_non_null(strstr(error.text, "at full activation"));
    step[active] = body.state->limit.step;
    body_close(&body);
  }
}

static void test_nothing_to_step(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  open_block(&body);
  body.sets[0].kind = VSC_SELECT_BOX;
  for (int i = 0; i < 3; i++) body.sets[0].box_high[i] = 9;
  body_build(&body);
  assert_int_equal(vsc_start(body.model, body.state, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "every node is held"));
  body_close(&body);
}

// One node is shot away: the message names it, its place and the time.
static void test_blow_up_is_reported(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  char place[64];
  open_block(&body);
  body_build(&body);
  body_start(&body);
  const size_t node = body.model->node_count / 2;
  body.state->v[4 * node] = 1e308;
  trap_off();
  assert_int_equal(vsc_advance(body.model, body.state, 20, &error), VSC_NUMERICAL);
  trap_on();
  const double *rest = body.model->rest + 4 * vsc_state_find_bad(body.model, body.state);
  snprintf(place, sizeof place, "(%.4g, %.4g, %.4g) mm", rest[0], rest[1], rest[2]);
  assert_non_null(strstr(error.text, place));
  assert_non_null(strstr(error.text, "node "));
  assert_non_null(strstr(error.text, " ms (step "));
  assert_true(body.state->time <= 1);
  body_close(&body);
}

// A finite but absurd state must not make the stepping stand still, whatever its stable step would
// be.
static void test_absurd_state_ends(void **state)
{
  (void)state;
  for (int power = 3; power < 200; power += 20) {
    small_body body;
    vsc_error error;
    open_block(&body);
    body_build(&body);
    body_start(&body);
    body.state->v[4 * (body.model->node_count / 2) + 1] = pow(10, power);
    trap_off();
    const vsc_status status = vsc_advance(body.model, body.state, 5, &error);
    trap_on();
    assert_true(status == VSC_NUMERICAL || (status == VSC_OK && power == 3));
    body_close(&body);
  }
}

// Under compression the volume term stiffens; a user's step that was stable at rest is then
// refused.
static void test_step_that_becomes_unstable(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  body_open(&body, block_of(1, 1, 1, 20, 0), 50);
  body_hold(&body, "z0", 1, 1, 1);
  body_hold(&body, "z1", 1, 1, 0);
  body.definition.safety = 1;
  body_build(&body);
  body_start(&body);
  const double stable = body.state->limit.step;
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body.definition.step = 0.99 * stable;
  body_build(&body);
  for (size_t n = 0; n < body.model->node_count; n++)
    if (body.model->inverse_mass[4 * n + 2] > 0) body.state->v[4 * n + 2] = -8;
  body_start(&body);
  assert_int_equal(vsc_advance(body.model, body.state, 50, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "too stiff for time.step"));
  body_close(&body);
}

// Squeezed slowly by its support, tissue is too stiff for a step soon after it has become so.
static void test_a_step_is_refused_in_time(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  open_block(&body);
  body_hold(&body, "z1", 1, 1, 1);
  body.supports[1].motion[2] = -6;
  body.supports[1].curve = vsc_default_curve(VSC_CURVE_RAMP);
  body.supports[1].curve.duration = 100;
  body.definition.safety = 1;
  body_build(&body);
  body_start(&body);
  body.definition.step = 0.99 * body.state->limit.step;
  vsc_state_free(body.state);
  vsc_model_free(body.model);
  body_build(&body);
  body_start(&body);
  assert_int_equal(vsc_advance(body.model, body.state, 100, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "too stiff for time.step"));
  const double stable = body.state->limit.step;
  assert_true(stable < body.definition.step && stable > 0.95 * body.definition.step);
  body_close(&body);
}

// Steps are cut so that each stop is met to the bit, and the estimate follows at least every 128 steps where those take more
// than 4 ms.
static void test_advance_meets_its_stops(void **state)
{
  (void)state;
  small_body body;
  open_block(&body);
  body_build(&body);
  body_shake(&body, 0.01);
  body_start(&body);
  static const double stops[] = {0.1, 0.1, 0.7, 1.0 / 3 + 1, 7, 600};
  for (size_t k = 0; k < sizeof stops / sizeof stops[0]; k++) {
    assert_int_equal(vsc_advance(body.model, body.state, stops[k], NULL), VSC_OK);
    assert_true(body.state->time == stops[k]);
  }
  assert_int_equal(vsc_advance(body.model, body.state, 3, NULL), VSC_OK);  // the past is done
  assert_true(body.state->time == 600);
  assert_true(128 * body.state->limit.first > 4);
  assert_true(body.state->limit.refreshes >= 1 + body.state->steps / 128);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_second_order),
      cmocka_unit_test(test_second_order_with_damping),
      cmocka_unit_test(test_second_order_with_activation_and_loads),
      cmocka_unit_test(test_energy_and_momentum_stay),
      cmocka_unit_test(test_time_reversal),
      cmocka_unit_test(test_free_fall),
      cmocka_unit_test(test_large_step_is_refused),
      cmocka_unit_test(test_steps_of_the_users_length),
      cmocka_unit_test(test_forced_step),
      cmocka_unit_test(test_activation_counts_for_the_step),
      cmocka_unit_test(test_nothing_to_step),
      cmocka_unit_test(test_blow_up_is_reported),
      cmocka_unit_test(test_absurd_state_ends),
      cmocka_unit_test(test_step_that_becomes_unstable),
      cmocka_unit_test(test_a_step_is_refused_in_time),
      cmocka_unit_test(test_advance_meets_its_stops),
  };
  vsc_parallel_set_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
