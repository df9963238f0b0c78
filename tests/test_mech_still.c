// SPDX-License-Identifier: GPL-3.0-or-later
// Elements none of whose nodes can move are not evaluated, nor pressures that rest, and nobody can tell.
#include <math.h>

#include "mech/step_limit.h"
#include "small_body.h"
#include "trap.h"

typedef struct still_case {
  const char *name;
  vsc_volume_kind volume;
  bool smoothed, damped, active;
  vsc_law law;
} still_case;

// A jittered block of `across` x `across` x 8 bricks of 3 mm whose lower half is held; `skipped`: by a support that lets the
// program know that it never moves, else by one that moves it by nothing that counts.
static void open_held(small_body *body, const still_case *c, size_t across, bool skipped)
{
  body_open(body, block_of(across, across, 8, 3, 0.2), 50);
  body_hold(body, "lower", 1, 1, 1);
  body->sets[0] = (vsc_selector){.kind = VSC_SELECT_BOX, .box_low = {-9, -9, -9}, .box_high = {99, 99, 12.9}};
  vsc_copy_name(body->sets[0].name, "lower");
  body->definition.volume = c->volume;
  body->definition.tets = c->smoothed ? VSC_TETS_SMOOTHED : VSC_TETS_PLAIN;
  body->material.law = c->law;
  body->material.guccione = (vsc_guccione_def){2, 8, 2, 4};
  if (c->volume == VSC_VOLUME_NODAL) body->material.stabilization = 10;
  for (int a = 0; a < 3; a++) body->material.damping[a] = c->damped && c->law == VSC_LAW_SPRINGS ? 5 : 0;
  if (c->damped && c->law != VSC_LAW_SPRINGS) body->material.viscosity = 5;
  if (c->active) {
    body_fibers(body, (const double[]){1, 1, 1});
    body->material.active.kind = VSC_ACTIVE_TENSION;
    body->material.active.tension = 20;
    body->material.active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
    body->material.active.curve.duration = 20;
  }
  if (!skipped) {
    body->supports[0].motion[2] = 1e-200;
    body->supports[0].curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
    body->supports[0].curve.duration = 20;
  }
  body_build(body);
}

static size_t still_elements(const vsc_model *model)
{
  size_t count = 0;
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; patch->still && k < patch->first_pack + patch->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) count += model->mesh_element[VSC_WIDTH * k + (size_t)l] != VSC_NO_ELEMENT;
  }
  return count;
}

// Not a number in all that makes forces of elements that are still.
static void spoil(vsc_model *model)
{
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; patch->still && k < patch->first_pack + patch->pack_count; k++) {
      vsc_frame *frame = (vsc_frame *)vsc_pack_frames(model, patch, k);
      frame->V = frame->T[0][0] = frame->T[1][1] = frame->T[2][2] = vsc_splat(NAN);
    }
  }
}

// Positions after 200 steps of 0.02 ms, in the mesh's order.
static double *positions(const still_case *c, bool skipped, vsc_limit *limit)
{
  small_body body;
  open_held(&body, c, 4, skipped);
  // bricks below 12.9 mm, jittered by less: the four lower layers, of six tets each brick
  assert_int_equal(still_elements(body.model), skipped ? 4 * 4 * 4 * 6 : 0);
  double *x = malloc(3 * body.model->node_count * sizeof *x);
  uint64_t seed = 5;
  double *speed = malloc(3 * body.model->node_count * sizeof *speed);
  for (size_t i = 0; i < 3 * body.model->node_count; i++) speed[i] = 0.1 * any_number(&seed);
  for (size_t n = 0; n < body.model->node_count; n++)
    for (size_t i = 0; i < 3; i++)
      if (body.model->inverse_mass[4 * n + i] > 0) body.state->v[4 * n + i] = speed[3 * body.model->mesh_node[n] + i];
  body_start(&body);
  *limit = body.state->limit;
  if (skipped && !c->smoothed) spoil(body.model);
  body_steps(&body, 0.02, 200);
  for (size_t n = 0; n < body.model->node_count; n++)
    memcpy(x + 3 * body.model->mesh_node[n], body.state->x + 4 * n, 3 * sizeof *x);
  free(speed);
  body_close(&body);
  return x;
}

static void nobody_can_tell(void **state)
{
  (void)state;
  static const still_case cases[] = {
      {"springs, volume of each", VSC_VOLUME_ELEMENT, false, false, false, VSC_LAW_SPRINGS},
      {"damped, active, node-averaged volume", VSC_VOLUME_NODAL, false, true, true, VSC_LAW_SPRINGS},
      {"Guccione, node-averaged volume", VSC_VOLUME_NODAL, false, true, false, VSC_LAW_GUCCIONE},
      {"smoothed", VSC_VOLUME_NODAL, true, false, false, VSC_LAW_SPRINGS},
  };
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    vsc_limit limits[2];
    double *x = positions(&cases[k], true, &limits[0]), *y = positions(&cases[k], false, &limits[1]), most = 0;
    const size_t count = 3 * 5 * 5 * 9;
    for (size_t i = 0; i < count; i++) most = fmax(most, fabs(x[i] - y[i]));
    print_message("%s: off by %.2g mm\n", cases[k].name, most);
    // patches are cut elsewhere, so sums are rounded differently: 200 steps of 1e-16 of 24 mm
    assert_true(most < 1e-12);
    assert_true(isfinite(x[0]));
    // noise of another order: the estimate's own error
    assert_close(limits[0].step, limits[1].step, 0.02, 0);
    free(x);
    free(y);
  }
}

// All nodes that move have a place in the sweeps: each falls freely where nothing else pulls.
static void all_others_are_stepped(void **state)
{
  (void)state;
  const still_case c = {"", VSC_VOLUME_ELEMENT, false, false, false, VSC_LAW_SPRINGS};
  small_body body;
  open_held(&body, &c, 14, true);  // several pieces of 256 nodes on both sides
  assert_true(body.model->still_count > 0);
  body_start(&body);
  for (size_t n = 0; n < body.model->node_count; n++) body.state->v[4 * n] = body.model->inverse_mass[4 * n] > 0;
  body_steps(&body, 1e-9, 1);
  for (size_t n = 0; n < body.model->node_count; n++) {
    const bool held = body.model->inverse_mass[4 * n] == 0;
    const double moved = body.state->x[4 * n] - body.model->rest[4 * n];
    // positions of some mm are rounded to 1e-15
    assert_close(moved, held ? 0 : 1e-9, 0, 1e-14);
  }
  body_close(&body);
}

// A block whose boundary is pressed from 1 ms on, or not at all, after some steps.
static void step_pressed(small_body *body, bool pressed, size_t steps)
{
  body_open(body, block_of(3, 3, 3, 2, 0.2), 50);
  body_hold(body, "x0", 1, 1, 1);
  body->definition.pressures = &body->pressure;
  body->definition.pressure_count = pressed;
  body->pressure = (vsc_pressure_def){.surface = "boundary", .peak = 1, .curve = vsc_default_curve(VSC_CURVE_HALF_SINE)};
  body->pressure.curve.start = 1;
  body_build(body);
  body_start(body);
  body_shake(body, 0.01);
  body_steps(body, 0.01, steps);
}

// A pressure that is 0 at the time costs nothing: where it acts is not looked at, and the body moves to the bit as one
// without. From when it acts on it does not.
static void a_pressure_that_rests_is_passed_over(void **state)
{
  (void)state;
  small_body pressed, free;
  for (int later = 0; later < 2; later++) {
    step_pressed(&pressed, true, later ? 150 : 50);
    step_pressed(&free, false, later ? 150 : 50);
    assert_true(pressed.state->scratch.outside != NULL);
    assert_true(pressed.state->scratch.pushed == (later == 1));
    assert_false(free.state->scratch.pushed);
    const size_t bytes = 4 * free.model->node_count * sizeof(double);
    assert_true((memcmp(pressed.state->x, free.state->x, bytes) == 0) == (later == 0));
    body_close(&pressed);
    body_close(&free);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(nobody_can_tell), cmocka_unit_test(all_others_are_stepped),
                                     cmocka_unit_test(a_pressure_that_rests_is_passed_over)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
