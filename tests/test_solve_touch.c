// SPDX-License-Identifier: GPL-3.0-or-later
// Contact where forces balance: its force and tangent, closed forms of pressed bodies, equilibria against explicit
// steps, and implicit steps that neither gain energy nor chatter.
#include <stdio.h>
#include "base/vec3.h"
#include "mech/tangent.h"
#include "small_body.h"
#include "solve/implicit.h"
#include "solve/solve.h"
#include "solve/touch.h"



static vsc_obstacle_def plane(double z, double up)
{
  vsc_obstacle_def def = vsc_default_obstacle();
  def.kind = VSC_OBSTACLE_PLANE;
  def.point[2] = z;
  def.normal[2] = up;
  return def;
}

static vsc_obstacle_def ball(double x, double y, double z, double radius)
{
  vsc_obstacle_def def = vsc_default_obstacle();
  def.kind = VSC_OBSTACLE_SPHERE;
  memcpy(def.point, (double[]){x, y, z}, sizeof def.point);
  def.radius = radius;
  return def;
}

// It moves by `way` along z in `duration`.
static void move(vsc_obstacle_def *def, double way, double duration)
{
  def->motion[2] = way;
  def->curve = vsc_default_curve(VSC_CURVE_RAMP);
  def->curve.duration = duration;
}

// An elastic block of n x n x n cells of 1 mm on the planes of symmetry x = 0 and y = 0.
static void open_block(small_body *body, size_t n, double jitter, vsc_solve_kind kind, vsc_obstacle_def *obstacles,
                       size_t count)
{
  body_open(body, block_of(n, n, n, 1, jitter), 50);
  body_hold(body, "x0", 1, 0, 0);
  body_hold(body, "y0", 0, 1, 0);
  body->definition.obstacles = obstacles;
  body->definition.obstacle_count = count;
  body->definition.end_time = 1000;
  body->definition.solve.kind = kind;
  body->definition.solve.tolerance = 1e-10;
}

static void advance(small_body *body, double until)
{
  vsc_error error;
  if (body->state->solver == NULL && body->state->steps == 0 &&
      vsc_solve_start(body->model, body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
  if (vsc_solve_to(body->model, body->state, until, &error) != VSC_OK) fail_msg("%s", error.text);
}

static void pressed(void **state)
{
  (void)state;
  for (int k = 0; k < 2; k++) {
  small_body body;
  vsc_obstacle_def things[2] = {plane(0, 1), k ? ball(0,0,8,3):plane(5, -1)};
  move(&things[1], -1, 100);
  open_block(&body, 5, 0.2, VSC_SOLVE_EQUILIBRIUM, things, 2);
  body_build(&body);
  advance(&body, 100);
  vsc_newton *n = body.state->solver;
  for (size_t r = 0; r < n->row_count; r++)
    printf("%g %g %g %g lin %g fac %g\n", n->rows[r].time, n->rows[r].load, n->rows[r].iteration, n->rows[r].residual, n->rows[r].linear, n->rows[r].factorized);
  printf("%.10g %.10g\n", body.state->contact[0].force[2], body.state->contact[1].force[2]);
  body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(pressed),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
