// SPDX-License-Identifier: GPL-3.0-or-later
// Few kept volumes in equilibria and implicit steps: closed forms, what explicit steps come to, second order in time, the
// same bits after a stop and with any number of threads.
#include "copy_factor.h"
#include "kept_body.h"
#include "solve/solve.h"

static void solve_to(small_body *body, double time)
{
  vsc_error error;
  if (body->state->solver == NULL && vsc_solve_start(body->model, body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
  if (vsc_solve_to(body->model, body->state, time, &error) != VSC_OK) fail_msg("%s", error.text);
}

// A free block that contracts by a tension T along x, of springs E: with stretches l and m = l^-1/2 the pressure
// p = E (m - 1)/(m l) leaves its sides free, and E (l - 1)/l + T - p m^2/l = 0, by halving.
static void a_free_block_takes_the_stretches_of_the_closed_form(void **state)
{
  (void)state;
  const double E = 20, tension = 15;
  double low = 0.3, high = 1, l = 1, m = 1, pressure = 0;
  for (int k = 0; k < 100; k++) {
    l = (low + high) / 2;
    m = 1 / sqrt(l);
    pressure = E * (m - 1) / (m * l);
    *(E * (l - 1) / l + tension - pressure * m * m / l > 0 ? &high : &low) = l;
  }
  small_body body;
  body_open(&body, block_of(3, 2, 2, 2, 0.2), 4);
  body_hold_planes(&body);
  body_fibers(&body, (const double[]){1, 0, 0});
  body.material.active = vsc_default_active();
  body.material.active.kind = VSC_ACTIVE_TENSION;
  body.material.active.tension = tension;
  body.definition.kept_volume = VSC_KEEP_TOTAL;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body.definition.solve.tolerance = 1e-11;
  body_build(&body);
  solve_to(&body, 100);
  // some 1e-11 of rounding and what is left out of balance
  body_must_be_stretched(&body, (const double[]){l, m, m}, 1e-9);
  assert_close(body.state->kept_pressure[0], pressure, 1e-9, 0);
  body_close(&body);
}

// A soft block bent and pressed by its weight and a pressure.
static void open_bent(small_body *body, vsc_kept_volume kind, vsc_material_def tissues[2])
{
  open_soft(body, kind, tissues);
  body_hold(body, "x0", 1, 1, 1);
  body->pressure = (vsc_pressure_def){.peak = 6, .curve = vsc_default_curve(VSC_CURVE_CONSTANT)};
  vsc_copy_name(body->pressure.surface, "boundary");
  body->definition.pressures = &body->pressure;
  body->definition.pressure_count = 1;
  body->definition.gravity[2] = -0.4;
}

// By Newton's method, by each kind of linear solver, and by explicit steps whose velocities are damped: the same
// shape and pressures, the volumes kept.
static void equilibria_are_what_damped_steps_come_to(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    small_body slow;
    vsc_material_def tissues[2];
    open_bent(&slow, kinds[k], tissues);
    body_build(&slow);
    body_start(&slow);
    for (double t = 0, dt = slow.state->limit.step; t < 80; t += dt) {
      body_steps(&slow, dt, 1);
      for (size_t i = 0; i < 4 * slow.model->node_count; i++) slow.state->v[i] *= 1 - 0.7 * dt;
    }
    for (int linear = VSC_LINEAR_AUTO; linear <= VSC_LINEAR_ITERATIVE; linear++) {
      small_body body;
      double most = 0, bent = 0;
      open_bent(&body, kinds[k], tissues);
      body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
      body.definition.solve.linear = (vsc_linear_kind)linear;
      body.definition.solve.tolerance = 1e-10;
      body_build(&body);
      solve_to(&body, 1);
      assert_true(worst(&body) <= 1e-10);
      for (size_t i = 0; i < 4 * body.model->node_count; i++) {
        most = fmax(most, fabs(body.state->x[i] - slow.state->x[i]));
        bent = fmax(bent, fabs(body.state->x[i] - body.model->rest[i]));
      }
      // Newton's convergence; without the pressures' own tangent it takes hundreds
      assert_true(vsc_solve_newton(body.model, body.state)->iterations <= 8);
      assert_true(bent > 0.3);
      assert_true(most < 1e-8);
      for (size_t v = 0; v < body.model->kept.count; v++) {
        assert_true(fabs(slow.state->kept_pressure[v]) > 0.1);
        assert_close(body.state->kept_pressure[v], slow.state->kept_pressure[v], 1e-6, 0);
      }
      body_close(&body);
    }
    body_close(&slow);
  }
}

// The beginning of a beat, without anything to damp it.
static void open_beat(small_body *body, vsc_kept_volume kind, vsc_material_def tissues[2])
{
  open_soft(body, kind, tissues);
  body_hold(body, "x0", 1, 1, 1);
  for (size_t m = 0; m < body->definition.material_count; m++) {
    vsc_active_def *active = &body->definition.materials[m].active;
    *active = vsc_default_active();
    active->kind = VSC_ACTIVE_TENSION;
    active->tension = 15;
    active->curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
    active->curve.duration = 20;
  }
  body_fibers(body, (double[]){1, 0, 0});
  body->definition.end_time = 4;
}

static void make_implicit(small_body *body, int scheme, double step)
{
  body->definition.solve.kind = VSC_SOLVE_IMPLICIT;
  body->definition.solve.scheme = (vsc_scheme)scheme;
  body->definition.solve.tolerance = 1e-10;
  body->definition.step = step;
}

// The largest difference of positions, and of pressures.
static void compare(const small_body *one, const small_body *two, double *position, double *pressure)
{
  *position = *pressure = 0;
  for (size_t i = 0; i < 4 * one->model->node_count; i++)
    *position = fmax(*position, fabs(one->state->x[i] - two->state->x[i]));
  for (size_t k = 0; k < one->model->kept.count; k++)
    *pressure = fmax(*pressure, fabs(one->state->kept_pressure[k] - two->state->kept_pressure[k]));
}

// Halving implicit steps takes their error, against fine explicit ones, to a quarter: order 1.7 at least where the next
// terms are still seen. Pressures, which swing with the fastest motions, are those of explicit steps to 1 %.
static void implicit_steps_are_of_second_order(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
    small_body reference;
    vsc_material_def tissues[2];
    open_beat(&reference, kinds[k], tissues);
    reference.definition.safety = 0.05;
    body_build(&reference);
    solve_to(&reference, 4);
    assert_true(fabs(reference.state->kept_pressure[0]) > 2);
    for (int scheme = VSC_SCHEME_GENERALIZED_ALPHA; scheme <= VSC_SCHEME_BDF2; scheme++) {
      double error[2], off;
      for (int level = 0; level < 2; level++) {
        small_body body;
        open_beat(&body, kinds[k], tissues);
        make_implicit(&body, scheme, level == 0 ? 0.02 : 0.01);
        body_build(&body);
        solve_to(&body, 4);
        assert_true(worst(&body) <= 1e-10);
        compare(&body, &reference, &error[level], &off);
        body_close(&body);
      }
      assert_close(log2(error[0] / error[1]), 2, 0, 0.3);
      assert_true(error[1] < 1e-3);
      assert_true(off <= 1e-2 * fabs(reference.state->kept_pressure[0]));
    }
    body_close(&reference);
  }
}

// Without damping of its own the trapezoid would let velocities swing about what keeps the volume, more with every step,
// and pressures with them, by 0.007 kPa after 400 steps; what is left is rounding over dt^2 and what Newton's tolerance
// leaves.
static void pressures_do_not_swing_from_step_to_step(void **state)
{
  (void)state;
  small_body body;
  double pressure[3] = {0};
  vsc_material_def tissues[2];
  open_beat(&body, VSC_KEEP_TOTAL, tissues);
  for (int a = 0; a < 3; a++) body.material.damping[a] = 5;
  make_implicit(&body, VSC_SCHEME_TRAPEZOID, 0.1);
  body.definition.solve.tolerance = 1e-6;
  body_build(&body);
  for (int n = 1; n <= 400; n++) {
    solve_to(&body, 0.1 * n);
    memmove(pressure, pressure + 1, 2 * sizeof *pressure);
    pressure[2] = body.state->kept_pressure[0];
  }
  assert_true(pressure[2] > 3);
  assert_close(0.5 * (pressure[0] + pressure[2]), pressure[1], 0, 5e-4);
  body_close(&body);
}

// With one thread or three, and from a copy of what a checkpoint holds: the same bits; with consistent masses, of a
// body that moves at the start.
static void threads_and_stops_do_not_change_the_bits(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++)
    for (int scheme = VSC_SCHEME_GENERALIZED_ALPHA; scheme <= VSC_SCHEME_BDF2; scheme++) {
      small_body one, two;
      vsc_material_def tissues[2];
      vsc_error error;
      small_body *const both[2] = {&one, &two};
      for (int b = 0; b < 2; b++) {
        open_beat(both[b], kinds[k], tissues);
        make_implicit(both[b], scheme, 0);
        both[b]->definition.masses = VSC_MASS_CONSISTENT;
        vsc_parallel_set_threads(b == 0 ? 1 : 3);
        body_build(both[b]);
      }
      const size_t bytes = 4 * one.model->node_count * sizeof(double);
      body_shake(&one, 0.1);
      vsc_parallel_set_threads(1);
      solve_to(&one, 1);
      assert_true(worst(&one) <= 1e-10);
      vsc_parallel_set_threads(3);
      assert_int_equal(vsc_solve_start(two.model, two.state, &error), VSC_OK);
      two.state->time = one.state->time;
      two.state->steps = one.state->steps;
      two.state->limit.step = one.state->limit.step;
      two.state->former_step = one.state->former_step;
      memcpy(two.state->x, one.state->x, bytes);
      memcpy(two.state->v, one.state->v, bytes);
      memcpy(two.state->a, one.state->a, bytes);
      memcpy(two.state->kept_pressure, one.state->kept_pressure, one.model->kept.count * sizeof(double));
      if (scheme == VSC_SCHEME_BDF2) memcpy(two.state->former_x, one.state->former_x, bytes);
      if (scheme == VSC_SCHEME_BDF2) memcpy(two.state->former_v, one.state->former_v, bytes);
      copy_factor(&one, &two);
      solve_to(&two, 2);
      vsc_parallel_set_threads(1);
      solve_to(&one, 2);
      assert_true(vsc_state_hash(one.model, one.state) == vsc_state_hash(two.model, two.state));
      double position, pressure;
      compare(&one, &two, &position, &pressure);
      assert_true(position == 0 && pressure == 0);
      body_close(&one);
      body_close(&two);
    }
  vsc_parallel_set_threads(0);
}

// Many volumes, and relaxation, which keeps none.
// Each multiplier pushes the elements of its volume apart, those of nodes a part of each.
static void stress_includes_what_keeps_volumes(void **state)
{
  (void)state;
  for (size_t kind = 0; kind < 3; kind++) {
    small_body body;
    vsc_material_def tissues[2];
    open_soft(&body, kinds[kind], tissues);
    body_hold(&body, "x0", 1, 1, 1);
    body_build(&body);
    const size_t elements = body.mesh->element_count;
    double *without = vsc_alloc(6 * elements, sizeof *without), *with = vsc_alloc(6 * elements, sizeof *with);
    uint64_t seed = 9;
    for (size_t n = 0; n < 4 * body.model->node_count; n++)
      if (n % 4 < 3) body.state->x[n] += 0.05 * any_number(&seed);
    vsc_read_field(body.model, body.state, VSC_FIELD_STRESS, without);
    for (size_t k = 0; k < body.model->kept.count; k++) body.state->kept_pressure[k] = 10 * any_number(&seed);
    vsc_read_field(body.model, body.state, VSC_FIELD_STRESS, with);
    for (size_t e = 0; e < elements; e++) {
      double pressure = 0;
      for (size_t k = 0; k < body.model->kept.count; k++) pressure += share_of(&body, k, e) * body.state->kept_pressure[k];
      for (size_t i = 0; i < 6; i++)
        assert_close(with[6 * e + i] - without[6 * e + i], i < 3 ? -pressure : 0, 0, 1e-12);  // of some 10 kPa
    }
    vsc_free(without);
    vsc_free(with);
    body_close(&body);
  }
}

// A state that a method has not started is not moved, and explicit steps do not start another method's.
static void methods_out_of_order_are_refused(void **state)
{
  (void)state;
  for (int kind = VSC_SOLVE_EXPLICIT; kind <= VSC_SOLVE_EQUILIBRIUM; kind++) {
    small_body body;
    vsc_error error;
    body_open(&body, block_of(1, 1, 1, 1, 0), 50);
    body.material.damping[0] = 1;
    body.definition.solve.kind = (vsc_solve_kind)kind;
    body_hold(&body, "x0", 1, 1, 1);
    body_build(&body);
    if (kind != VSC_SOLVE_EXPLICIT) {
      assert_int_equal(vsc_start(body.model, body.state, &error), VSC_INPUT);
      assert_int_equal(vsc_solve_to(body.model, body.state, 1, &error), VSC_INPUT);
      assert_non_null(strstr(error.text, "call vsc_solve_start"));
    }
    assert_null(vsc_solve_newton(body.model, body.state));
    body_close(&body);
  }
}

static void what_newton_cannot_keep_is_refused(void **state)
{
  (void)state;
  for (int k = 1; k < 4; k++) {
    small_body body;
    vsc_error error;
    vsc_material_def tissues[2];
    open_soft(&body, kinds[k == 1 ? 0 : k], tissues);
    body.definition.solve.kind = k == 3 ? VSC_SOLVE_IMPLICIT : VSC_SOLVE_EQUILIBRIUM;
    if (k == 1) body.definition.solve.method = VSC_STATICS_RELAXATION;
    assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &body.model, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, k == 1 ? "solver.method: newton" : "solver.incompressible"));
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_free_block_takes_the_stretches_of_the_closed_form),
      cmocka_unit_test(equilibria_are_what_damped_steps_come_to),
      cmocka_unit_test(implicit_steps_are_of_second_order),
      cmocka_unit_test(pressures_do_not_swing_from_step_to_step),
      cmocka_unit_test(threads_and_stops_do_not_change_the_bits),
      cmocka_unit_test(stress_includes_what_keeps_volumes),
      cmocka_unit_test(methods_out_of_order_are_refused),
      cmocka_unit_test(what_newton_cannot_keep_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
