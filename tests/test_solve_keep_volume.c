// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes kept by multipliers: to rounding, without a change of energy or momenta, second order in
// time, also beside contact.
#include "kept_body.h"
#include "pressed_body.h"
#include "sheet_mesh.h"
#include "solve/keep_volume.h"

static void sums_of(const small_body *body, double momentum[3], double turning[3])
{
  memset(momentum, 0, 3 * sizeof *momentum);
  memset(turning, 0, 3 * sizeof *turning);
  for (size_t n = 0; n < body->model->node_count; n++) {
    double moment[3];
    vsc_cross(body->state->x + 4 * n, body->state->v + 4 * n, moment);
    for (int i = 0; i < 3; i++) {
      momentum[i] += body->model->mass[n] * body->state->v[4 * n + i];
      turning[i] += body->model->mass[n] * moment[i];
    }
  }
}

static double energy_of(small_body *body, vsc_ledger *ledger)
{
  vsc_totals t;
  vsc_observe(body->model, body->state, ledger, true, &t);
  return t.kinetic + t.axial + t.angular + t.volume_energy;
}

// A shaken free block of each kind of kept volume, 3000 steps: volumes to 1e-12, momenta to the
// rounding of so many steps, energy within Verlet's swing and without drift.
static void volumes_momenta_and_energy_stay(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    small_body body;
    vsc_ledger *ledger;
    vsc_error error;
    double before[3], turning[3], after[3], turned[3];
    vsc_material_def tissues[2];
    open_soft(&body, kinds[k], tissues);
    body_build(&body);
    assert_int_equal(body.model->kept.count, kinds[k] == VSC_KEEP_TOTAL    ? 1
                                             : kinds[k] == VSC_KEEP_REGION ? 2
                                             : kinds[k] == VSC_KEEP_NODE
                                                 ? body.mesh->node_count
                                                 : body.mesh->element_count);
    body_start(&body);
    body_shake(&body, 0.3);
    assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
    // the first row of steps takes from the shaking what volumes do not allow
    const double dt = 0.4 * body.state->limit.step;
    body_steps(&body, dt, 1);
    sums_of(&body, before, turning);
    double early = 0, late = 0;
    for (int look = 0; look < 60; look++) {
      if (vsc_steps(body.model, body.state, dt, 50, &error) != VSC_OK) fail_msg("%s", error.text);
      assert_true(worst(&body) <= 2e-12);
      *(look < 30 ? &early : &late) += energy_of(&body, ledger) / 30;
    }
    sums_of(&body, after, turned);
    for (int i = 0; i < 3; i++) {
      assert_close(after[i], before[i], 0, 1e-9 * body.model->total_mass * 0.3);
      assert_close(turned[i], turning[i], 0, 1e-9 * body.model->total_mass * 0.3);
    }
    assert_close(late, early, 5e-3, 0);
    vsc_ledger_free(ledger);
    body_close(&body);
  }
}

// What bodies are set in motion with loses what would change volumes before the first step: from there on energy
// stays within Verlet's swing.
static void an_initial_velocity_obeys_the_volumes(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    small_body body;
    vsc_ledger *ledger;
    vsc_material_def tissues[2];
    open_soft(&body, kinds[k], tissues);
    vsc_array *speed = vsc_arrays_add(&body.mesh->node_data, "speed", 3, body.mesh->node_count);
    uint64_t seed = 9;
    double given = 0;
    for (size_t i = 0; i < 3 * body.mesh->node_count; i++) speed->values[i] = random_between(&seed, -0.3, 0.3);
    body.definition.velocity = (vsc_velocity_def){.array = "speed", .unit = 1};
    body_build(&body);
    for (size_t i = 0; i < 4 * body.model->node_count; i++)
      given += 0.5 * body.model->mass[i / 4] * body.state->v[i] * body.state->v[i];
    body_start(&body);
    assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
    const double before = energy_of(&body, ledger);
    assert_true(before < given);
    body_steps(&body, 0.1 * body.state->limit.step, 1);
    assert_close(energy_of(&body, ledger), before, 1e-3, 0);
    vsc_ledger_free(ledger);
    body_close(&body);
  }
}

// Positions after 3 ms from a given motion.
static double *positions_after(vsc_kept_volume kind, size_t steps, size_t *count)
{
  small_body body;
  vsc_material_def tissues[2];
  open_soft(&body, kind, tissues);
  body_build(&body);
  body_start(&body);
  // smooth: a bending and twisting motion, whose part that changes volume goes at once
  for (size_t n = 0; n < body.model->node_count; n++) {
    const double *x = body.model->rest + 4 * n;
    double *v = body.state->v + 4 * n;
    v[0] = 0.05 * sin(x[1]);
    v[1] = 0.1 * sin(x[0]) - 0.03 * x[2];
    v[2] = 0.06 * cos(x[0]) + 0.03 * x[1];
  }
  vsc_error error;
  assert_int_equal(vsc_steps(body.model, body.state, 1e-7, 1, &error), VSC_OK);
  body_steps(&body, 3.0 / (double)steps, steps);
  *count = 4 * body.model->node_count;
  double *x;
  if (!VSC_NEW(x, *count)) fail_msg("no memory");
  memcpy(x, body.state->x, *count * sizeof *x);
  body_close(&body);
  return x;
}

static void order_in_time_is_two(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    enum { LEVELS = 4 };
    double *x[LEVELS], error[LEVELS - 1] = {0};
    size_t count;
    for (int l = 0; l < LEVELS; l++) x[l] = positions_after(kinds[k], (size_t)200 << l, &count);
    for (int l = 0; l + 1 < LEVELS; l++)
      for (size_t i = 0; i < count; i++) error[l] = fmax(error[l], fabs(x[l][i] - x[l + 1][i]));
    assert_close(log2(error[1] / error[2]), 2, 0, 0.1);
    for (int l = 0; l < LEVELS; l++) vsc_free(x[l]);
  }
}

// A block held at one end contracts along its fibres and lies on a table: the volume stays to 1e-10
// through the whole beat, no node enters the table, and the table bears the weight of what is free.
static void a_beat_on_a_table(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k += 2) {
    small_body body;
    vsc_error error;
    vsc_obstacle_def table = vsc_default_obstacle();
    table.normal[2] = 1;
    table.friction = 0.3;
    vsc_material_def tissues[2];
    open_soft(&body, kinds[k], tissues);
    for (int a = 0; a < 3; a++) body.material.damping[a] = 5;
    body.definition.obstacles = &table;
    body.definition.obstacle_count = 1;
    body.definition.gravity[2] = -9.81e-3;
    body.material.active = vsc_default_active();
    body.material.active.kind = VSC_ACTIVE_TENSION;
    body.material.active.tension = 15;
    body.material.active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
    body.material.active.curve.duration = 40;
    body_fibers(&body, (double[]){1, 0, 0});
    body_build(&body);
    body_start(&body);
    double shortest = INFINITY;
    for (double time = 1; time <= 100; time++) {
      if (vsc_advance(body.model, body.state, time, &error) != VSC_OK) fail_msg("%s", error.text);
      assert_true(worst(&body) <= 1e-10);
      double low = INFINITY, high = -INFINITY;
      for (size_t n = 0; n < body.model->node_count; n++) {
        assert_true(body.state->x[4 * n + 2] >= -1e-12);
        low = fmin(low, body.state->x[4 * n]);
        high = fmax(high, body.state->x[4 * n]);
      }
      shortest = fmin(shortest, high - low);
    }
    assert_true(shortest < 2.6);
    const double before = body.state->contact[0].impulse[2];
    assert_int_equal(vsc_advance(body.model, body.state, 120, &error), VSC_OK);
    assert_close((body.state->contact[0].impulse[2] - before) / 20,
                 body.model->total_mass * 9.81e-3, 2e-3, 0);
    body_close(&body);
  }
}

// A damped block whose volume is kept is pressed by a ball, some nodes of which come to it and leave again at the rim of
// the touch: what the ball works is stored and dissipated, but for what a ledger of 1 ms leaves out, and longer steps
// dissipate no more than short ones.
static void a_ball_works_on_a_kept_volume(void **state)
{
  (void)state;
  double dissipated[2];
  for (int fine = 0; fine < 2; fine++) {
    small_body body;
    vsc_ledger *ledger;
    vsc_totals t;
    vsc_error error;
    vsc_obstacle_def thing = ball(1.5, 1.5, 4.05, 2);
    move(&thing, -0.4, 15);
    body_open(&body, block_of(6, 6, 4, 0.5, 0.2), 4);
    body.definition.kept_volume = VSC_KEEP_TOTAL;
    for (int a = 0; a < 3; a++) body.material.damping[a] = 5;
    body_hold(&body, "z0", 1, 1, 1);
    body.definition.obstacles = &thing;
    body.definition.obstacle_count = 1;
    body.definition.safety = fine ? 0.2 : 0.8;
    body_build(&body);
    body_start(&body);
    if (vsc_ledger_create(body.model, &ledger, NULL) != VSC_OK) fail_msg("no memory");
    for (double time = 0; time <= 20; time++) {
      if (time > 0 && vsc_advance(body.model, body.state, time, &error) != VSC_OK) fail_msg("%s", error.text);
      vsc_observe(body.model, body.state, ledger, false, &t);
    }
    assert_true(t.contact_work > 0.1);
    assert_close(vsc_balance_error(ledger, &t) / t.contact_work, 0, 0, 2e-3);
    dissipated[fine] = ledger->dissipated;
    vsc_ledger_free(ledger);
    body_close(&body);
  }
  assert_close(dissipated[0], dissipated[1], 0.01, 0);
}

static void what_cannot_be_kept_is_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  vsc_model *model;
  body_open(&body, block_of(4, 4, 4, 1, 0.2), 4);  // 384 tets, 125 nodes: 375 ways to move
  body.definition.kept_volume = VSC_KEEP_ELEMENT;
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "384 volumes"));
  assert_non_null(strstr(error.text, "375 ways"));
  // a body that is held all over has nothing to keep
  body.definition.kept_volume = VSC_KEEP_TOTAL;
  body.sets[0] = (vsc_selector){.name = "all", .kind = VSC_SELECT_BOX, .box_high = {9, 9, 9}};
  body.supports[0] = (vsc_support_def){.set = "all", .held = {1, 1, 1}};
  body.definition.set_count = body.definition.support_count = 1;
  body_build(&body);
  assert_int_equal(body.model->kept.count, 0);
  body_close(&body);
  // triangles alone
  vsc_membrane_def membrane = vsc_default_membrane();
  body_open(&body, sheet_mesh(2, 2, 1, 1, CUT_BY_TURNS, 0, 1), 0);
  vsc_copy_name(membrane.surface, "triangles");
  membrane.thickness = membrane.axial[0] = membrane.axial[1] = 1;
  body.definition.material_count = 0;
  body.definition.membranes = &membrane;
  body.definition.membrane_count = 1;
  body.definition.kept_volume = VSC_KEEP_TOTAL;
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "keep_volume: volumes of elements are kept, and the mesh has none"));
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(volumes_momenta_and_energy_stay),
      cmocka_unit_test(an_initial_velocity_obeys_the_volumes),
      cmocka_unit_test(order_in_time_is_two),
      cmocka_unit_test(a_beat_on_a_table),
      cmocka_unit_test(a_ball_works_on_a_kept_volume),
      cmocka_unit_test(what_cannot_be_kept_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
