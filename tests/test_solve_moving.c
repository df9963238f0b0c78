// SPDX-License-Identifier: GPL-3.0-or-later
// Supports that move and surfaces on springs and dashpots, stepped: where nodes go, order of
// convergence, work, momentum, and what is refused.
#include "solve/moving.h"

#include "base/mem.h"
#include "mech/step_limit.h"
#include "small_body.h"
#include "solve/solve.h"

// A bar of 40 x 8 x 8 mm of elements of 4 mm: its end x0 is held, its end x1 moved by (2, 0, 1) mm along
// `curve`; x1's other directions stay held. Stable up to about 0.2 ms.
static void open_bar(small_body *body, const vsc_curve_def *curve, double damping)
{
  body_open(body, block_of(10, 2, 2, 4, 0), 50);
  for (int a = 0; a < 3; a++) body->material.damping[a] = damping;
  body_hold(body, "x0", 1, 1, 1);
  body_hold(body, "x1", 1, 1, 1);
  body->supports[1].motion[0] = 2;
  body->supports[1].motion[2] = 1;
  body->supports[1].curve = *curve;
}

static vsc_curve_def half_sine(double duration)
{
  vsc_curve_def curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  curve.duration = duration;
  return curve;
}

static bool is_of(const small_body *body, size_t n, const char *array)
{
  return vsc_arrays_find(&body->mesh->node_data, array)->values[body->model->mesh_node[n]] == 1;
}

// Nodes of the support are on its curve to the bit, their velocities near its derivative, and no others
// are moved with them.
static void nodes_follow_the_curve(void **state)
{
  (void)state;
  const vsc_curve_def curve = half_sine(20);
  small_body body;
  open_bar(&body, &curve, 3);
  body_build(&body);
  assert_true(vsc_supports_move(body.model));
  body_start(&body);
  for (int row = 0; row < 5; row++) {
    body_steps(&body, 1.0 / 32, 48);
    const double part = vsc_curve_value(&body.model->moved[0].curve, body.state->time);
    const double rate = M_PI / 20 * cos(M_PI * body.state->time / 20);
    assert_close(part, sin(M_PI * 1.5 * (row + 1) / 20), 1e-12, 0);  // a point of the table
    for (size_t n = 0; n < body.model->node_count; n++) {
      const double *x = body.state->x + 4 * n, *rest = body.model->rest + 4 * n;
      const double *v = body.state->v + 4 * n;
      if (!is_of(&body, n, "x1")) continue;
      assert_true(x[0] == rest[0] + part * 2 && x[1] == rest[1] && x[2] == rest[2] + part);
      // (pi/20)^3 dt^2/6 of a central difference
      assert_close(v[0], 2 * rate, 0, 2e-6);
      assert_close(v[2], rate, 0, 1e-6);
      assert_true(v[1] == 0);
    }
  }
  body_close(&body);
}

// Where a half sine starts and ends its speed jumps, not at its top, nor at the end of the run; a pair of tanh has no jump.
static void jumps_of_speed_are_seen(void **state)
{
  (void)state;
  vsc_curve_def curve = half_sine(20);
  for (int periodic = 0; periodic < 3; periodic++) {
    small_body body;
    if (periodic == 2) curve = vsc_default_curve(VSC_CURVE_TANH_PAIR);
    curve.start = periodic == 2 ? 60 : 30;
    curve.period = periodic == 1 ? 75 : 0;
    open_bar(&body, &curve, 3);
    body.definition.end_time = 120;
    body_build(&body);
    const bool kinks = periodic < 2;
    assert_false(vsc_moving_jumps(body.model, 0, 29.9));
    assert_int_equal(vsc_moving_jumps(body.model, 29, 30), kinks);
    assert_int_equal(vsc_moving_jumps(body.model, 30, 31), kinks);
    assert_false(vsc_moving_jumps(body.model, 30.1, 49.9));
    assert_int_equal(vsc_moving_jumps(body.model, 49.5, 50.5), kinks);
    assert_false(vsc_moving_jumps(body.model, 50.1, 99.9));
    assert_int_equal(vsc_moving_jumps(body.model, 104.9, 105.1), periodic == 1);
    assert_false(vsc_moving_jumps(body.model, 119, 120));
    body_close(&body);
  }
  // a run that ends on the way
  small_body body;
  curve = half_sine(20);
  curve.start = 10;
  open_bar(&body, &curve, 3);
  body.definition.end_time = 25;
  body_build(&body);
  assert_false(vsc_moving_jumps(body.model, 20, 25));
  body_close(&body);
}

// Positions after 10 ms, mesh order; `jump` is how far the energy balance is off then, over the support's
// work.
static double *pull(const vsc_curve_def *curve, double dt, double damping, double *jump)
{
  small_body body;
  vsc_ledger *ledger;
  vsc_totals totals;
  open_bar(&body, curve, damping);
  body_build(&body);
  body_start(&body);
  if (vsc_ledger_create(body.model, &ledger, NULL) != VSC_OK) fail_msg("no memory");
  vsc_observe(body.model, body.state, ledger, false, &totals);
  for (int row = 0; row < 40; row++) {
    body_steps(&body, dt, round(0.25 / dt));
    vsc_observe(body.model, body.state, ledger, false, &totals);
  }
  assert_true(totals.support_work > 10);
  *jump = fabs(vsc_balance_error(ledger, &totals)) / totals.support_work;
  double *x;
  if (!VSC_NEW(x, 3 * body.mesh->node_count)) fail_msg("no memory");
  for (size_t n = 0; n < body.model->node_count; n++)
    memcpy(x + 3 * (size_t)body.model->mesh_node[n], body.state->x + 4 * n, 3 * sizeof *x);
  vsc_ledger_free(ledger);
  body_close(&body);
  return x;
}

static double distance(const double *a, const double *b)
{
  const size_t count = (size_t)3 * 11 * 3 * 3;
  double sum = 0;
  for (size_t i = 0; i < count; i++) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum);
}

// Half the step, a quarter of the error, in positions and in the energy balance; the curve begins with a
// kick, and the end is still moving. Steps are multiples of the curve's spacing, 1/64 ms.
static void pulling_converges_with_order_two(void **state)
{
  (void)state;
  const vsc_curve_def curve = half_sine(25);
  double jump[3], *x[3];
  for (int k = 0; k < 3; k++) x[k] = pull(&curve, 1.0 / (16 << k), 0, &jump[k]);
  const double coarse = distance(x[0], x[1]), fine = distance(x[1], x[2]);
  assert_true(coarse / fine > 3.6 && coarse / fine < 4.4);
  assert_true(jump[1] < 1e-3);
  assert_true(jump[0] / jump[1] > 3 && jump[1] / jump[2] > 3);
  for (int k = 0; k < 3; k++) vsc_free(x[k]);
}

// What is dissipated is in the balance too, but for the ledger's trapezoids of 0.25 ms; the curve begins
// gently.
static void damped_pulling_balances(void **state)
{
  (void)state;
  vsc_curve_def curve = vsc_default_curve(VSC_CURVE_TANH_PAIR);
  curve.start = 5;
  curve.rise = 1.5;
  double jump;
  double *x = pull(&curve, 1.0 / 64, 20, &jump);
  assert_true(jump < 1e-3);
  vsc_free(x);
}

// The energy balance after 30 ms of a gentle pull, over the support's work; looks are as far apart as steps.
static double solved_jump(vsc_solve_kind kind, vsc_scheme scheme, double dt)
{
  vsc_curve_def curve = vsc_default_curve(VSC_CURVE_TANH_PAIR);
  curve.start = 12;
  curve.rise = 4;
  small_body body;
  vsc_ledger *ledger;
  vsc_totals totals;
  vsc_error error;
  open_bar(&body, &curve, 0);
  body.definition.solve.kind = kind;
  body.definition.solve.scheme = scheme;
  body.definition.solve.tolerance = 1e-10;
  body.definition.step = kind == VSC_SOLVE_IMPLICIT ? dt : 0;
  body_build(&body);
  assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  vsc_observe(body.model, body.state, ledger, false, &totals);
  for (int row = 1; row <= round(30 / dt); row++) {
    assert_int_equal(vsc_solve_to(body.model, body.state, row * dt, &error), VSC_OK);
    vsc_observe(body.model, body.state, ledger, false, &totals);
    if (kind == VSC_SOLVE_EQUILIBRIUM)
      assert_true(totals.kinetic == 0 && totals.dissipation == 0 && totals.momentum[0] == 0);
  }
  assert_true(totals.support_work > 10);
  const double jump = fabs(vsc_balance_error(ledger, &totals)) / totals.support_work;
  vsc_ledger_free(ledger);
  body_close(&body);
  return jump;
}

// The work is that of the reactions by trapezoids, which the trapezoid scheme keeps energy by: what is left
// there is the law's curvature, of second order in the step. Generalised alpha takes away what is fast
// besides. Equilibria balance by trapezoids of their rows.
static void other_methods_balance_too(void **state)
{
  (void)state;
  for (int way = 0; way < 4; way++) {
    const vsc_solve_kind kind = way < 3 ? VSC_SOLVE_IMPLICIT : VSC_SOLVE_EQUILIBRIUM;
    static const vsc_scheme schemes[] = {VSC_SCHEME_TRAPEZOID, VSC_SCHEME_GENERALIZED_ALPHA,
                                         VSC_SCHEME_BDF2, VSC_SCHEME_TRAPEZOID};
    const double coarse = solved_jump(kind, schemes[way], way < 3 ? 0.25 : 2);
    const double fine = solved_jump(kind, schemes[way], way < 3 ? 0.125 : 1);
    assert_true(coarse < 5e-3 && fine < coarse / (way == 1 ? 2 : 3.5));
    if (way == 0) assert_true(coarse < 2e-5);
  }
}

// A support that moves steadily does so in implicit steps too, whether from the start on or from 0.5 ms: by the
// trapezoidal rule its velocity would swing between 0 and twice its rate for ever. At the kink itself it is the mean.
// To the rounding of positions over a step.
static void a_steady_motion_is_steady_once_it_has_begun(void **state)
{
  (void)state;
  for (int variant = 0; variant < 4; variant++) {
    small_body body;
    vsc_error error;
    vsc_curve_def curve = vsc_default_curve(VSC_CURVE_RAMP);
    curve.duration = 64;
    curve.start = variant / 2 * 0.5;
    open_bar(&body, &curve, 3);
    body.definition.solve.kind = VSC_SOLVE_IMPLICIT;
    body.definition.solve.scheme = variant % 2 == 0 ? VSC_SCHEME_TRAPEZOID : VSC_SCHEME_GENERALIZED_ALPHA;
    body.definition.step = 0.25;
    body_build(&body);
    assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
    for (int row = 1; row <= 6; row++) {
      const double time = row * 0.25, begun = time > curve.start ? 1 : time < curve.start ? 0 : 0.5;
      assert_int_equal(vsc_solve_to(body.model, body.state, time, &error), VSC_OK);
      for (size_t n = 0; n < body.model->node_count; n++)
        if (is_of(&body, n, "x1")) assert_close(body.state->v[4 * n], begun * 2.0 / 64, 0, 1e-11);
    }
    body_close(&body);
  }
}

// Whichever way equilibrium is found, 1 % of strain is held by Young's modulus (as in the_reaction_is_youngs)
// to some parts of that strain, and the curve's value is where the nodes are.
static void reactions_of_equilibria_are_youngs(void **state)
{
  (void)state;
  for (int method = VSC_STATICS_NEWTON; method <= VSC_STATICS_RELAXATION; method++) {
    small_body body;
    vsc_error error;
    body_open(&body, block_of(5, 2, 2, 4, 0), 50);
    body_hold(&body, "x0", 1, 0, 0);
    body_hold(&body, "x1", 1, 0, 0);
    body_hold(&body, "y0", 0, 1, 0);
    body_hold(&body, "z0", 0, 0, 1);
    body.supports[1].motion[0] = 0.2;  // of 20 mm
    body.supports[1].curve = vsc_default_curve(VSC_CURVE_CONSTANT);
    body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
    body.definition.solve.method = (vsc_statics)method;
    body_build(&body);
    assert_int_equal(vsc_solve_start(body.model, body.state, &error), VSC_OK);
    assert_int_equal(vsc_solve_to(body.model, body.state, 10, &error), VSC_OK);
    const double Y = 1 / (1.0 / 20 - 50 / (1 + 150.0 / 20) / 400), force = Y * 64 * 0.01;
    const vsc_moved_sums *sums = &body.state->moved[0];
    assert_close(-sums->force[0], force, 0.02, 0);
    assert_close(sums->work, 0.5 * force * 0.2, 0.02, 0);
    assert_true(sums->part == 1);
    for (size_t i = 0; i < 4 * body.model->node_count; i++) assert_true(body.state->v[i] == 0);
    body_close(&body);
  }
}

// The momentum of a body that nothing else holds is the support's impulse.
static void momentum_is_the_impulse(void **state)
{
  (void)state;
  const vsc_curve_def curve = half_sine(20);
  small_body body;
  vsc_ledger *ledger;
  vsc_totals totals;
  open_bar(&body, &curve, 0);
  body.definition.support_count = 1;
  body.supports[0] = body.supports[1];
  body_build(&body);
  body_start(&body);
  if (vsc_ledger_create(body.model, &ledger, NULL) != VSC_OK) fail_msg("no memory");
  for (int row = 0; row < 6; row++) {
    body_steps(&body, 1.0 / (31 + row), 40);
    vsc_observe(body.model, body.state, ledger, false, &totals);
    for (int i = 0; i < 3; i++)
      assert_close(totals.momentum[i], body.state->moved[0].impulse[i], 1e-12, 1e-9);  // rounding
  }
  assert_true(fabs(totals.momentum[0]) > 10);
  vsc_ledger_free(ledger);
  body_close(&body);
}

// A slow pull is held by Young's modulus: Y = 19.3 kPa of E = 20, K = 50 (1/Y = 1/E - K/(1 + 3 K/E)/E^2) on
// 64 mm^2.
static void the_reaction_is_youngs(void **state)
{
  (void)state;
  vsc_curve_def curve = vsc_default_curve(VSC_CURVE_RAMP);
  curve.duration = 300;
  small_body body;
  body_open(&body, block_of(5, 2, 2, 4, 0), 50);
  for (int a = 0; a < 3; a++) body.material.damping[a] = 40;
  body_hold(&body, "x0", 1, 0, 0);
  body_hold(&body, "x1", 1, 0, 0);
  body_hold(&body, "y0", 0, 1, 0);
  body_hold(&body, "z0", 0, 0, 1);
  body.supports[1].motion[0] = 0.02;  // of 20 mm
  body.supports[1].curve = curve;
  body.definition.end_time = 400;
  body_build(&body);
  body_start(&body);
  body_steps(&body, 1.0 / 16, 16 * 400);
  const vsc_moved_sums *sums = &body.state->moved[0];
  const double before = sums->impulse[0], Y = 1 / (1.0 / 20 - 50 / (1 + 150.0 / 20) / 400);
  body_steps(&body, 1.0 / 16, 16 * 10);
  // strain 1e-3: the law is straight to about that
  assert_close((sums->impulse[0] - before) / 10, Y * 64 * 1e-3, 2e-3, 0);
  assert_close(sums->work, 0.5 * Y * 64 * 1e-3 * 0.02, 0.05, 0);  // and a little for damping
  body_close(&body);
}

// A curve that is 1 from the start has its nodes there from the start, and does no work.
static void a_constant_motion_is_there_at_once(void **state)
{
  (void)state;
  const vsc_curve_def curve = vsc_default_curve(VSC_CURVE_CONSTANT);
  small_body body;
  open_bar(&body, &curve, 0);
  body_build(&body);
  body_start(&body);
  for (size_t n = 0; n < body.model->node_count; n++)
    if (is_of(&body, n, "x1"))
      assert_close(body.state->x[4 * n], body.model->rest[4 * n] + 2, 0, 0);
  body_steps(&body, 1.0 / 32, 10);
  assert_close(body.state->moved[0].work, 0, 0, 0);
  body_close(&body);
}

// Two supports may hold the same node, unless one of them moves it.
static void a_node_is_moved_by_one_support(void **state)
{
  (void)state;
  const vsc_curve_def curve = half_sine(20);
  vsc_error error = {.text = ""};
  small_body body;
  vsc_model *model = NULL;
  open_bar(&body, &curve, 0);
  body_hold(&body, "z0", 0, 1, 0);  // shares an edge with x1, and y, which x1 does not move
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &model, &error), VSC_OK);
  vsc_model_free(model);
  body.supports[2].held[2] = 1;
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "supports[1].motion: the node at (40"));
  assert_non_null(strstr(error.text, "is held in z by supports[2] too"));
  vsc_mesh_free(body.mesh);
}

// ---- surfaces on springs and dashpots

static void lay_bed(small_body *body, vsc_robin_def *bed, const char *array)
{
  static vsc_selector surface;
  surface = (vsc_selector){.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
  vsc_copy_name(surface.name, array);
  vsc_copy_name(surface.array, array);
  vsc_copy_name(bed->surface, array);
  body->definition.surface_count = 1;
  body->definition.surfaces = &surface;
  body->definition.robin_count = 1;
  body->definition.robins = bed;
}

// A block of tissue 100 times stiffer than its bed hangs from it: omega^2 = stiffness A/m as a whole.
static void a_stiff_block_swings_on_its_bed(void **state)
{
  (void)state;
  vsc_robin_def bed = {.stiffness = 0.02};
  small_body body;
  body_open(&body, block_of(2, 2, 2, 4, 0), 200);
  lay_bed(&body, &bed, "z0");
  body_build(&body);
  assert_close(body.model->robins[0].area, 64, 1e-13, 0);
  assert_false(body.model->terms.damping);
  const double omega = sqrt(0.02 * 64 / 512);
  for (size_t n = 0; n < body.model->node_count; n++) body.state->v[4 * n + 2] = 0.1;
  body_start(&body);
  const double quarter = M_PI / 2 / omega;
  body_steps(&body, quarter / 1000, 1000);
  double mean = 0;
  for (size_t n = 0; n < body.model->node_count; n++)
    mean += body.model->mass[n] * (body.state->x[4 * n + 2] - body.model->rest[4 * n + 2]) / 512;
  // the block gives way a little: stiffness . height / (3 modulus), about 1/1000
  assert_close(mean, 0.1 / omega, 3e-3, 0);
  body_close(&body);
}

// Springs' energy and dashpots' dissipation are in the balance, whose error falls with the square of the
// step and of the ledger's distance (here two steps).
static void beds_are_in_the_balance(void **state)
{
  (void)state;
  for (int normal = 0; normal < 2; normal++) {
    double jump[2];
    for (int k = 0; k < 2; k++) {
      vsc_robin_def bed = {.stiffness = 5, .damping = 20, .normal = normal};
      small_body body;
      vsc_ledger *ledger;
      vsc_totals totals;
      body_open(&body, block_of(3, 3, 3, 4, 0.2), 50);
      lay_bed(&body, &bed, "z0");
      body_build(&body);
      assert_true(body.model->terms.damping);
      for (size_t n = 0; n < body.model->node_count; n++) {
        body.state->v[4 * n] = 0.3;
        body.state->v[4 * n + 2] = 0.2;
      }
      body_start(&body);
      if (vsc_ledger_create(body.model, &ledger, NULL) != VSC_OK) fail_msg("no memory");
      vsc_observe(body.model, body.state, ledger, false, &totals);
      const double first = totals.kinetic;
      for (int row = 0; row < 200 << k; row++) {
        body_steps(&body, 0.025 / (1 << k), 2);
        vsc_observe(body.model, body.state, ledger, false, &totals);
      }
      assert_true(ledger->dissipated > 0.2 * first && totals.springs > 1e-3 * first);
      jump[k] = fabs(vsc_balance_error(ledger, &totals)) / first;
      vsc_ledger_free(ledger);
      body_close(&body);
    }
    assert_true(jump[0] < 0.03 && jump[1] < 0.3 * jump[0]);
  }
}

// A bed stiffer than the tissue sets the step: the bound knows it, and a run at the estimate stays sound.
static void stiff_beds_set_the_step(void **state)
{
  (void)state;
  vsc_robin_def bed = {.stiffness = 1000, .damping = 1};
  double step[2];
  for (int k = 0; k < 2; k++) {
    small_body body;
    size_t slot;
    body_open(&body, block_of(3, 3, 3, 4, 0.2), 50);
    if (k == 1) lay_bed(&body, &bed, "z0");
    body_build(&body);
    body_shake(&body, 0.1);
    body_start(&body);
    step[k] = body.state->limit.first;
    // the bound leaves damping out, which makes the estimate's eigenvalue larger
    const double bound = vsc_limit_bound(body.model, &body.state->scratch, &slot);
    assert_true(2 / sqrt(bound) < 1.3 * step[k] && 2 / sqrt(bound) > step[k] / 5);
    vsc_error error;
    assert_int_equal(vsc_advance(body.model, body.state, 20, &error), VSC_OK);
    for (size_t i = 0; i < 4 * body.model->node_count; i++)
      assert_true(fabs(body.state->v[i]) < 1);
    body_close(&body);
  }
  assert_true(step[1] < 0.3 * step[0]);
}

int main(void)
{
  vsc_parallel_set_threads(1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nodes_follow_the_curve),
      cmocka_unit_test(jumps_of_speed_are_seen),
      cmocka_unit_test(pulling_converges_with_order_two),
      cmocka_unit_test(damped_pulling_balances),
      cmocka_unit_test(other_methods_balance_too),
      cmocka_unit_test(a_steady_motion_is_steady_once_it_has_begun),
      cmocka_unit_test(reactions_of_equilibria_are_youngs),
      cmocka_unit_test(momentum_is_the_impulse),
      cmocka_unit_test(the_reaction_is_youngs),
      cmocka_unit_test(a_constant_motion_is_there_at_once),
      cmocka_unit_test(a_node_is_moved_by_one_support),
      cmocka_unit_test(a_stiff_block_swings_on_its_bed),
      cmocka_unit_test(beds_are_in_the_balance),
      cmocka_unit_test(stiff_beds_set_the_step),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
