// SPDX-License-Identifier: GPL-3.0-or-later
// Mass added at slivers: the wanted step is stable, little is added, weights stay, and too much is refused.
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

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(slivers_do_not_set_the_step),
      cmocka_unit_test(too_much_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
