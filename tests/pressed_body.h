// SPDX-License-Identifier: GPL-3.0-or-later
// A block between a table and things that press it: for tests of contact where forces balance.
#ifndef VSC_TESTS_PRESSED_BODY_H
#define VSC_TESTS_PRESSED_BODY_H

#include "small_body.h"
#include "solve/solve.h"

static const double GRAVITY = 9.81e-3;  // mm/ms^2

static inline vsc_obstacle_def plane(double z, double up)
{
  vsc_obstacle_def def = vsc_default_obstacle();
  def.kind = VSC_OBSTACLE_PLANE;
  def.point[2] = z;
  def.normal[2] = up;
  return def;
}

static inline vsc_obstacle_def ball(double x, double y, double z, double radius)
{
  vsc_obstacle_def def = vsc_default_obstacle();
  def.kind = VSC_OBSTACLE_SPHERE;
  memcpy(def.point, (double[]){x, y, z}, sizeof def.point);
  def.radius = radius;
  return def;
}

// It moves by `way` along z in `duration`.
static inline void move(vsc_obstacle_def *def, double way, double duration)
{
  def->motion[2] = way;
  def->curve = vsc_default_curve(VSC_CURVE_RAMP);
  def->curve.duration = duration;
}

// An elastic block of n x n x n cells of 1 mm on the planes of symmetry x = 0 and y = 0.
static inline void open_block(small_body *body, size_t n, double jitter, vsc_solve_kind kind,
                              vsc_obstacle_def *obstacles, size_t count)
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

static inline void advance(small_body *body, double until)
{
  vsc_error error;
  if (body->state->solver == NULL && body->state->steps == 0 &&
      vsc_solve_start(body->model, body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
  if (vsc_solve_to(body->model, body->state, until, &error) != VSC_OK) fail_msg("%s", error.text);
}

// A ball of 3 mm comes down by `way` on a damped block of 4 x 4 x 4 mm that lies on a table.
static inline void open_palpation(small_body *body, vsc_obstacle_def things[2], double way, vsc_solve_kind kind)
{
  things[0] = plane(0, 1);
  things[1] = ball(0.3, 0.2, 7, 3);
  move(&things[1], -way, 100);
  open_block(body, 4, 0.2, kind, things, 2);
  for (int a = 0; a < 3; a++) body->material.damping[a] = 20;
}

#endif
