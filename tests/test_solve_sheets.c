// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes in equilibrium and in implicit steps, alone and round a block: closed forms, and what explicit steps come to.
#include "base/mem.h"
#include "sheet_body.h"

// Positions of a damped strip that falls, after 10 ms.
static double *fallen(double step, size_t *count)
{
  small_body body;
  vsc_membrane_def membrane;
  open_strip(&body, &membrane, 8, 20);
  membrane.damping[0] = membrane.damping[1] = 50;
  body.definition.end_time = 10;
  if (step > 0) {
    body.definition.solve.kind = VSC_SOLVE_IMPLICIT;
    body.definition.solve.scheme = VSC_SCHEME_TRAPEZOID;
    body.definition.solve.tolerance = 1e-10;
    body.definition.step = step;
  } else {
    body.definition.safety = 0.2;
  }
  body_build(&body);
  solve_to(&body, 10);
  *count = 4 * body.model->node_count;
  double *x = vsc_alloc(*count, sizeof *x);
  memcpy(x, body.state->x, *count * sizeof *x);
  body_close(&body);
  return x;
}

// Halving implicit steps takes their error, against fine explicit ones, to a quarter.
static void implicit_steps_are_of_second_order(void **state)
{
  (void)state;
  size_t count;
  double *reference = fallen(0, &count), error[2] = {0};
  for (int k = 0; k < 2; k++) {
    double *x = fallen(k == 0 ? 0.1 : 0.05, &count);
    for (size_t i = 0; i < count; i++) error[k] = fmax(error[k], fabs(x[i] - reference[i]));
    vsc_free(x);
  }
  assert_close(log2(error[0] / error[1]), 2, 0, 0.2);
  vsc_free(reference);
}

// ---- a block in a capsule

static void open_capsule(small_body *body, vsc_membrane_def *membrane, double K)
{
  body_open(body, block_of(5, 4, 3, 1, 0.2), K);
  *membrane = vsc_default_membrane();
  vsc_copy_name(membrane->name, "capsule");
  vsc_copy_name(membrane->surface, "boundary");
  membrane->thickness = 0.2;
  membrane->axial[0] = 90;
  membrane->axial[1] = 60;
  membrane->angular = 30;
  membrane->bending = 0.1;
  body->definition.membranes = membrane;
  body->definition.membrane_count = 1;
}

// Stretched by 1.4 between plates that slide: (E A + t E_a P)(lambda - 1), A = 4 x 3 mm^2, P = 14 mm.
static void a_capsule_pulls_along(void **state)
{
  (void)state;
  small_body body;
  vsc_membrane_def membrane;
  open_capsule(&body, &membrane, NO_VOLUME);
  body_hold_planes(&body);
  body_hold(&body, "x1", 1, 0, 0);
  body.supports[3].motion[0] = 2;
  body.supports[3].curve = vsc_default_curve(VSC_CURVE_RAMP);
  body.supports[3].curve.duration = 1;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body.definition.solve.tolerance = 1e-12;
  body_build(&body);
  solve_to(&body, 1);
  body_must_be_stretched(&body, (const double[]){1.4, 1, 1}, 1e-9);
  assert_close(-body.state->moved[0].force[0], (20 * 12 + 0.2 * 90 * 14) * 0.4, 1e-9, 0);
  body_close(&body);
}

// How far a block bends under its weight, with or without a capsule that weighs nothing, mm.
static double sunk(bool covered)
{
  small_body body;
  vsc_membrane_def membrane;
  double most = 0;
  open_capsule(&body, &membrane, 60);
  membrane.density = 1e-9;
  if (!covered) body.definition.membrane_count = 0;
  body_hold(&body, "x0", 1, 1, 1);
  body.definition.gravity[2] = -0.05;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(&body);
  solve_to(&body, 1);
  for (size_t i = 2; i < 4 * body.model->node_count; i += 4)
    most = fmax(most, body.model->rest[i] - body.state->x[i]);
  body_close(&body);
  return most;
}

// A Timoshenko beam of length 5 mm that bears 0.6 mN/mm sinks by q L^4/(8 E I) + q L^2/(2 G A), mm.
static double beam(double EI, double GA)
{
  return 0.6 * (pow(5, 4) / (8 * EI) + pow(5, 2) / (2 * GA));
}

// By what the capsule adds to the stiffness under the weight: to E I (28.6 kPa, 4 x 3^3/12 mm^4) t E_a int z^2 ds, to
// 5/6 G A (10 kPa, 12 mm^2) that of two walls; E_a is the mean of both axes. Coarse tets are too stiff, but with and
// without it.
static void a_capsule_stiffens_its_block(void **state)
{
  (void)state;
  const double round = 2 * (4 * 1.5 * 1.5 + 27 / 12.);
  const double added = 1 / beam(28.6 * 9 + 0.2 * 75 * round, 100 + 5 / 6. * 0.2 * 30 * 6) - 1 / beam(28.6 * 9, 100);
  assert_close(1 / sunk(true) - 1 / sunk(false), added, 0.15, 0);
}

// Bent by its weight, by Newton's method and by relaxation: the end of a run whose velocities are damped. The block
// bends some 1e2 times more easily than its elements, of which the tolerance of 1e-10 is meant.
static void a_capsule_bends_with_its_block(void **state)
{
  (void)state;
  enum { NEWTON, RELAXATION, DAMPED, WAYS };
  small_body body[WAYS];
  vsc_membrane_def membrane;
  for (int k = 0; k < WAYS; k++) {
    vsc_solve_def *solve = &body[k].definition.solve;
    open_capsule(&body[k], &membrane, 60);
    body_hold(&body[k], "x0", 1, 1, 1);
    body[k].definition.gravity[2] = -0.5;
    if (k != DAMPED) solve->kind = VSC_SOLVE_EQUILIBRIUM;
    if (k == RELAXATION) solve->method = VSC_STATICS_RELAXATION;
    solve->tolerance = 1e-10;
    body_build(&body[k]);
    if (k != DAMPED) solve_to(&body[k], 1);
    if (k == DAMPED) body_start(&body[k]);
    if (k == DAMPED) settle(&body[k], 0.7, 60);
  }
  double most = 0, sunk = 0;
  for (size_t i = 0; i < 4 * body[0].model->node_count; i++) {
    for (int k = 1; k < WAYS; k++) most = fmax(most, fabs(body[0].state->x[i] - body[k].state->x[i]));
    sunk = fmax(sunk, fabs(body[0].state->x[i] - body[0].model->rest[i]));
  }
  assert_true(sunk > 0.5);
  assert_true(most < 1e-8);
  for (int k = 0; k < WAYS; k++) body_close(&body[k]);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(implicit_steps_are_of_second_order),
      cmocka_unit_test(a_capsule_pulls_along),
      cmocka_unit_test(a_capsule_stiffens_its_block),
      cmocka_unit_test(a_capsule_bends_with_its_block),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
