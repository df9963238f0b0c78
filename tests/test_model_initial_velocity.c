// SPDX-License-Identifier: GPL-3.0-or-later
// Initial velocities from a node array: what arrives at the nodes, what is refused, free flight.
#include "base/vec3.h"
#include "mesh/quadratic.h"
#include "small_body.h"

// rad/ms and mm/ms: strains by centrifugal forces are some 1e-6
static const double turn[3] = {1e-3, -2e-3, 0.5e-3}, flight[3] = {0.1, 0.2, -0.3};

static void velocity_at(const double x[3], double v[3])
{
  vsc_cross(turn, x, v);
  for (int k = 0; k < 3; k++) v[k] += flight[k];
}

// A block of 27 bricks with an array of velocities in units of 0.5 mm/ms; quadratic or not.
static void open_flight(small_body *body, bool quadratic)
{
  vsc_mesh *mesh = block_of(3, 3, 3, 1, 0.2);
  vsc_error error;
  vsc_array *array = vsc_arrays_add(&mesh->node_data, "speed", 3, mesh->node_count);
  if (array == NULL) fail_msg("no memory");
  for (size_t n = 0; n < mesh->node_count; n++) {
    velocity_at(mesh->nodes + 3 * n, array->values + 3 * n);
    for (size_t k = 0; k < 3; k++) array->values[3 * n + k] *= 2;
  }
  if (quadratic && vsc_mesh_raise(&mesh, "block", &error) != VSC_OK) fail_msg("%s", error.text);
  body_open(body, mesh, 50);
  vsc_copy_name(body->definition.velocity.array, "speed");
  body->definition.velocity.unit = 0.5;
}

// Nodes in the middle of edges have the mean of the ends': exact for what is linear in space.
static void nodes_get_theirs(void **state)
{
  (void)state;
  for (int quadratic = 0; quadratic < 2; quadratic++) {
    small_body body;
    open_flight(&body, quadratic);
    body_build(&body);
    for (size_t n = 0; n < body.model->node_count; n++) {
      double v[3];
      velocity_at(body.model->rest + 4 * n, v);
      for (size_t k = 0; k < 3; k++) assert_close(body.state->v[4 * n + k], v[k], 0, 1e-16);
    }
    assert_int_equal(body.model->stopped_count, 0);
    body_close(&body);
  }
}

// Both in free flight: momenta stay, and distances, to the strain of centrifugal forces; the block has turned by
// the angle of its rate. A turn about no principal axis is none of a cube's: all its axes are.
static void a_free_body_flies_and_turns(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  vsc_ledger *ledger;
  vsc_totals before, after;
  open_flight(&body, false);
  body_build(&body);
  body_start(&body);
  if (vsc_ledger_create(body.model, &ledger, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_observe(body.model, body.state, ledger, false, &before);
  for (int k = 0; k < 3; k++) assert_true(fabs(before.momentum[k]) > 1);
  assert_int_equal(vsc_advance(body.model, body.state, 50, &error), VSC_OK);
  vsc_observe(body.model, body.state, ledger, false, &after);
  const double rate = vsc_norm(turn), angle = 50 * rate;
  for (int k = 0; k < 3; k++) {
    assert_close(after.momentum[k], before.momentum[k], 1e-12, 0);
    assert_close(after.angular_momentum[k], before.angular_momentum[k], 1e-12, 1e-10);
  }
  assert_close(vsc_balance_error(ledger, &after), 0, 0, 1e-9 * after.kinetic);
  const double *x = body.state->x, *X = body.model->rest;
  for (size_t n = 1; n < body.model->node_count; n++) {
    double was[3], is[3], axis[3], across[3], c[3];
    vsc_subtract(X + 4 * n, X, was);
    vsc_subtract(x + 4 * n, x, is);
    assert_close(vsc_norm(is), vsc_norm(was), 1e-4, 0);
    for (int k = 0; k < 3; k++) axis[k] = turn[k] / rate;
    vsc_cross(axis, was, across);
    const double along = vsc_dot(axis, was);
    // Rodrigues
    for (int k = 0; k < 3; k++) {
      c[k] = was[k] * cos(angle) + across[k] * sin(angle) + axis[k] * along * (1 - cos(angle));
      assert_close(is[k], c[k], 0, 1e-3 * angle * vsc_norm(was));
    }
  }
  vsc_ledger_free(ledger);
  body_close(&body);
}

// A support takes what it holds, and the rest stays.
static void supports_hold(void **state)
{
  (void)state;
  small_body body;
  open_flight(&body, false);
  body_hold(&body, "z0", 0, 0, 1);
  body_build(&body);
  size_t held = 0;
  for (size_t n = 0; n < body.model->node_count; n++) {
    double v[3];
    const bool is_held = body.model->inverse_mass[4 * n + 2] == 0;
    velocity_at(body.model->rest + 4 * n, v);
    held += is_held;
    if (is_held) v[2] = 0;
    for (size_t k = 0; k < 3; k++) assert_close(body.state->v[4 * n + k], v[k], 0, 1e-16);
  }
  assert_int_equal(held, 16);
  assert_int_equal(body.model->stopped_count, 16);
  body_close(&body);
}

static void assert_refused(small_body *body, const char *said)
{
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_model_build(body->mesh, NULL, &body->definition, &body->model, &error), VSC_INPUT);
  if (strncmp(error.text, "initial_velocity.node_array: ", 29) != 0 || strstr(error.text, said) == NULL)
    fail_msg("\"%s\" lacks \"%s\"", error.text, said);
}

static void what_is_no_velocity_is_refused(void **state)
{
  (void)state;
  small_body body;
  open_flight(&body, false);
  vsc_copy_name(body.definition.velocity.array, "sped");
  assert_refused(&body, "no node array 'sped', known arrays: x0, x1, y0, y1, z0, z1, speed; did you mean speed?");
  vsc_copy_name(body.definition.velocity.array, "x0");
  assert_refused(&body, "'x0' has 1 number a node");
  vsc_copy_name(body.definition.velocity.array, "speed");
  body.mesh->node_data.items[6].values[3 * 7 + 1] = NAN;
  assert_refused(&body, "nan, ");
  assert_refused(&body, "at node 7 of the mesh's file");
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(nodes_get_theirs),
      cmocka_unit_test(a_free_body_flies_and_turns),
      cmocka_unit_test(supports_hold),
      cmocka_unit_test(what_is_no_velocity_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
