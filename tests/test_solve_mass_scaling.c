// SPDX-License-Identifier: GPL-3.0-or-later
// Mass added at slivers: the wanted step is stable, little is added, weights stay, and too much is refused. Masses coupled
// between neighbours: the wanted step is stable, energy and momentum are kept, and whole bodies fall as they would.
#include "small_body.h"
#include "solve/mass_scaling.h"

// A bar of 6 x 3 x 3 bricks, the node in its middle pushed to within 5 % of its neighbour: the tets between
// are slivers.
static void open_slivers(small_body *body)
{
  vsc_mesh *mesh = block_of(6, 3, 3, 1, 0);
  const size_t node = 3 + 7 * (1 + 4 * 1);
  mesh->nodes[3 * node] += 0.95;
  body_open(body, mesh, 50);
  for (int a = 0; a < 3; a++) body->material.damping[a] = 2;
  body_hold(body, "x0", 1, 1, 1);
  body->definition.gravity[2] = -0.01;
}

static double stable_step(small_body *body)
{
  vsc_error error;
  if (vsc_start(body->model, body->state, &error) != VSC_OK) fail_msg("%s", error.text);
  return body->state->limit.first;
}

static void slivers_do_not_set_the_step(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  open_slivers(&body);
  body_build(&body);
  const double before = stable_step(&body), wanted = 3 * before, mass = body.model->total_mass;
  double weight = 0, light = 0, now = 0, heavy = 0;
  for (size_t n = 0; n < body.model->node_count; n++) {
    weight += body.model->weight[4 * n + 2];
    light += body.model->mass[n];
  }
  const uint64_t hash = body.model->hash;
  assert_int_equal(vsc_scale_masses(body.model, &body.definition, &error), VSC_OK);
  assert_true(body.model->hash == hash && body.model->scaled.step == 0);  // nothing asked for, nothing done
  body.definition.mass_scaling = wanted;
  body.definition.most_added_mass = 0.5;
  assert_int_equal(vsc_scale_masses(body.model, &body.definition, &error), VSC_OK);
  for (size_t n = 0; n < body.model->node_count; n++) {
    now += body.model->weight[4 * n + 2];
    heavy += body.model->mass[n];
  }
  const vsc_scaled_mass *scaled = &body.model->scaled;
  assert_true(now == weight && body.model->total_mass == mass && body.model->hash != hash);
  assert_close(heavy - light, scaled->added, 1e-9, 0);  // sums of some hundred masses
  assert_true(scaled->nodes > 0 && scaled->nodes < 40 && scaled->added < 0.3 * mass);
  // the estimate anew, to the closeness that is promised
  assert_true(stable_step(&body) >= wanted * (1 - 2e-3));
  vsc_totals totals;
  vsc_ledger *ledger;
  assert_int_equal(vsc_ledger_create(body.model, &ledger, &error), VSC_OK);
  vsc_observe(body.model, body.state, ledger, false, &totals);
  assert_int_equal(vsc_advance(body.model, body.state, 2000 * wanted, &error), VSC_OK);
  vsc_observe(body.model, body.state, ledger, false, &totals);
  // what falls gains no more than it loses in height
  assert_true(totals.kinetic + totals.axial + totals.angular + totals.volume_energy < -totals.gravity_energy);
  vsc_ledger_free(ledger);
  body_close(&body);
}

static void too_much_is_refused(void **state)
{
  (void)state;
  for (int way = 0; way < 3; way++) {
    small_body body;
    vsc_error error;
    open_slivers(&body);
    body_build(&body);
    body.definition.mass_scaling = way == 1 ? -1 : 10 * stable_step(&body);
    if (way == 2) body.definition.step = 0.001;
    assert_int_equal(vsc_scale_masses(body.model, &body.definition, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, "time.mass_scaling: "));
    assert_non_null(strstr(error.text, way == 0 ? "most_added_mass" : way == 1 ? "above zero" : "time.step"));
    body_close(&body);
  }
}

// A bar of 64 tets that flies, or hangs from its face x = 0, with masses coupled for steps of `wanted` ms.
static void open_coupled(small_body *body, bool held, double wanted)
{
  vsc_error error;
  body_open(body, block_of(4, 2, 2, 1, 0.2), 100);
  if (held) body_hold(body, "x0", 1, 1, 1);
  body->definition.safety = 0.9;
  body->definition.selective_mass_scaling = wanted;
  body_build(body);
  if (vsc_scale_masses(body->model, &body->definition, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_state_free(body->state);
  if (vsc_state_create(body->model, &body->state, &error) != VSC_OK) fail_msg("%s", error.text);
}

static void open_lumped(small_body *body, bool held, double *step)
{
  open_coupled(body, held, 0);
  *step = stable_step(body);
}

static vsc_totals totals_of(const small_body *body)
{
  vsc_totals totals;
  vsc_ledger *ledger;
  vsc_error error;
  if (vsc_ledger_create(body->model, &ledger, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_observe(body->model, body->state, ledger, false, &totals);
  vsc_ledger_free(ledger);
  return totals;
}

static double energy_of(const vsc_totals *totals)
{
  return totals->kinetic + totals->axial + totals->angular + totals->volume_energy;
}

// A body pulled out of shape flies on: energy within what leapfrog steps let it swing, momentum to rounding.
static void coupled_masses_keep_energy_and_momentum(void **state)
{
  (void)state;
  double stable, swing[2];
  small_body body;
  open_lumped(&body, false, &stable);
  body_close(&body);
  for (int fine = 0; fine < 2; fine++) {
    open_coupled(&body, false, 5 * stable);
    assert_true(body.model->coupled.degree >= 4 && body.model->coupled.step >= 5 * stable * (1 - 1e-3));
    // as in the model's search
    assert_close(stable_step(&body), body.model->coupled.step, 1e-12, 0);
    for (size_t n = 0; n < body.model->node_count; n++) {
      body.state->x[4 * n] *= 1.1;
      body.state->lone_v[4 * n + 1] = body.state->v[4 * n + 1] = 0.2;
    }
    // the acceleration there
    body_steps(&body, 1e-9, 1);
    const vsc_totals before = totals_of(&body);
    const double dt = body.model->coupled.step / (fine ? 8 : 4);
    double least = INFINITY, most = -INFINITY;
    for (int k = 0; k < (fine ? 400 : 200); k++) {
      body_steps(&body, dt, 10);
      const vsc_totals now = totals_of(&body);
      least = fmin(least, energy_of(&now));
      most = fmax(most, energy_of(&now));
      for (int i = 0; i < 3; i++) assert_close(now.momentum[i], before.momentum[i], 0, 1e-11 * before.momentum[1]);
    }
    swing[fine] = (most - least) / energy_of(&before);
    body_close(&body);
  }
  // steps half as long: a quarter (of order 2)
  assert_true(swing[0] < 0.1 && swing[1] < swing[0] / 3.5);
}

// Free fall of a body that is set in motion, for 20 steps: x = X + v t + g t^2 / 2, whatever the masses are.
static void whole_bodies_fall_as_they_would(void **state)
{
  (void)state;
  double stable;
  small_body body;
  open_lumped(&body, false, &stable);
  body_close(&body);
  body_open(&body, block_of(4, 2, 2, 1, 0.2), 100);
  vsc_array *speed = vsc_arrays_add(&body.mesh->node_data, "speed", 3, body.mesh->node_count);
  for (size_t n = 0; n < body.mesh->node_count; n++) speed->values[3 * n] = 0.3;
  vsc_copy_name(body.definition.velocity.array, "speed");
  body.definition.selective_mass_scaling = 4 * stable;
  body.definition.gravity[2] = -0.01;
  body_build(&body);
  vsc_error error;
  assert_int_equal(vsc_scale_masses(body.model, &body.definition, &error), VSC_OK);
  vsc_state_free(body.state);
  assert_int_equal(vsc_state_create(body.model, &body.state, &error), VSC_OK);
  body_start(&body);
  const double dt = body.model->coupled.step, t = 20 * dt;
  body_steps(&body, dt, 20);
  for (size_t n = 0; n < body.model->node_count; n++) {
    // rounding of positions of 4 mm in 20 steps, which stiffness makes accelerations of
    assert_close(body.state->x[4 * n], body.model->rest[4 * n] + 0.3 * t, 0, 1e-10);
    assert_close(body.state->x[4 * n + 2], body.model->rest[4 * n + 2] - 0.005 * t * t, 0, 1e-10);
  }
  const vsc_totals totals = totals_of(&body);
  assert_close(totals.kinetic, 0.5 * body.model->total_mass * (0.09 + 1e-4 * t * t), 1e-9, 0);
  body_close(&body);
}

static void coupling_is_refused(void **state)
{
  (void)state;
  static const char *const says[] = {"above zero", "time.step", "too far above the stable step", "obstacles", "keep_volume"};
  for (int way = 0; way < 5; way++) {
    small_body body;
    vsc_error error;
    vsc_obstacle_def obstacle = vsc_default_obstacle();
    open_slivers(&body);
    obstacle.normal[2] = 1;
    obstacle.point[2] = -5;
    if (way == 3) body.definition.obstacle_count = 1, body.definition.obstacles = &obstacle;
    if (way == 4) body.definition.kept_volume = VSC_KEEP_TOTAL;
    body_build(&body);
    body.definition.selective_mass_scaling = way == 0 ? -1 : way == 2 ? 500 : 0.01;
    if (way == 1) body.definition.step = 0.001;
    assert_int_equal(vsc_scale_masses(body.model, &body.definition, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, "time.selective_mass_scaling: "));
    assert_non_null(strstr(error.text, says[way]));
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slivers_do_not_set_the_step),
      cmocka_unit_test(too_much_is_refused),
      cmocka_unit_test(coupled_masses_keep_energy_and_momentum),
      cmocka_unit_test(whole_bodies_fall_as_they_would),
      cmocka_unit_test(coupling_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
