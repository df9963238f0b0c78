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

// The deepest node, below 0 inside, and the largest gap of a node that an obstacle pushes.
static double deepest(const small_body *body, double *furthest)
{
  double least = INFINITY;
  size_t pair = 0;
  *furthest = 0;
  for (size_t o = 0; o < body->model->obstacle_count; o++) {
    double point[3], normal[3];
    vsc_obstacle_place(&body->model->obstacles[o], body->state->time, point);
    for (size_t k = 0; k < body->model->node_count; k++, pair++) {
      const double *x = body->state->x + 4 * (size_t)body->model->obstacles[o].nodes[k];
      const double gap = vsc_obstacle_gap(&body->model->obstacles[o], point, x, normal);
      least = fmin(least, gap);
      if (body->state->touch[pair] > 0) *furthest = fmax(*furthest, gap);
    }
  }
  return least;
}

// ---- the force itself

// A free block's nodes put as near as `spread` (mm) to the surface of a plane and, every other one, of a ball; they have
// multipliers from -20 to 40 mN, below 0: none.
static vsc_touch *scatter(small_body *body, vsc_obstacle_def things[2], double spread)
{
  vsc_touch *touch;
  vsc_error error;
  uint64_t seed = 9;
  things[0] = plane(-1, 2);
  things[0].normal[0] = 1;
  things[1] = ball(-8, 1, 1, 6);
  body_open(body, block_of(2, 2, 2, 1, 0.2), 50);
  body->definition.obstacles = things;
  body->definition.obstacle_count = 2;
  body->definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_build(body);
  if (vsc_touch_create(body->model, 3, &touch, &error) != VSC_OK) fail_msg("%s", error.text);
  const size_t nodes = body->model->node_count;
  assert_int_equal(vsc_state_contacts(body->model), 2 * nodes);
  for (size_t n = 0; n < nodes; n++) {
    const size_t o = n % 2;
    double normal[3], *x = body->state->x + 4 * n;
    const double way = spread * any_number(&seed) -
                       vsc_obstacle_gap(&body->model->obstacles[o], things[o].point, x, normal);
    for (int i = 0; i < 3; i++) x[i] += way * normal[i];
    body->state->touch[o * nodes + n] = fmax(10 + 30 * any_number(&seed), 0);
  }
  vsc_touch_begin(touch, body->state, 0, 1, 0);
  return touch;
}

// E = sum (t^2 - l^2)/(2 k), k = factor . stiffness; r becomes the forces.
static double energy_of(vsc_touch *touch, double factor, const double *x, double *r)
{
  const size_t nodes = touch->model->node_count;
  double energy = 0;
  memset(r, 0, 4 * nodes * sizeof *r);
  vsc_touch_push(touch, x, r);
  for (size_t k = 0; k < 2 * nodes; k++) {
    const double t = touch->force[k], l = touch->multiplier[k];
    energy += (t * t - l * l) / (2 * factor * touch->stiffness[touch->model->obstacles[k / nodes].nodes[k % nodes]]);
  }
  return energy;
}

// What k is of a node's own stiffness, from the force on the deepest.
static double find_factor(vsc_touch *touch, const small_body *body, double *r)
{
  double factor = 0;
  const size_t nodes = body->model->node_count;
  energy_of(touch, 1, body->state->x, r);
  for (size_t n = 0; n < nodes; n++) {
    const size_t k = n % 2 * nodes + n;
    double normal[3];
    const double gap = vsc_obstacle_gap(&body->model->obstacles[n % 2], body->definition.obstacles[n % 2].point,
                                        body->state->x + 4 * n, normal);
    if (gap < -0.1) factor = (touch->multiplier[k] - touch->force[k]) / (gap * touch->stiffness[n]);
  }
  assert_true(factor > 1);
  return factor;
}

// -dE/dx is the force; -df/dx is the tangent on the surface, where multipliers are the forces. Central differences of
// 1e-5 mm are off by 1e-10 of what is curved, and by 1e-16 of E or f over 1e-5.
static void check_slopes(double spread, bool tangents)
{
  small_body body;
  vsc_obstacle_def things[2];
  vsc_tangent *tangent;
  vsc_error error;
  vsc_touch *touch = scatter(&body, things, spread);
  const size_t nodes = body.model->node_count, bytes = 4 * nodes * sizeof(double);
  double *r = malloc(bytes), *moved = malloc(bytes), *low = malloc(bytes), *high = malloc(bytes);
  const double step = 1e-5, factor = tangents ? 1 : find_factor(touch, &body, r);
  size_t pushed = 0;
  if (vsc_tangent_create(body.model, &tangent, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_touch_tangent(touch, body.state->x, tangent);
  energy_of(touch, factor, body.state->x, r);
  memcpy(moved, body.state->x, bytes);
  for (size_t n = 0; n < nodes; n++)
    for (size_t i = 0; i < 3; i++) {
      size_t stride;
      const double *block = vsc_block_at(&tangent->matrix, n, tangent->matrix.start[n], &stride);
      moved[4 * n + i] = body.state->x[4 * n + i] + step;
      const double more = energy_of(touch, factor, moved, high);
      moved[4 * n + i] = body.state->x[4 * n + i] - step;
      const double less = energy_of(touch, factor, moved, low);
      moved[4 * n + i] = body.state->x[4 * n + i];
      pushed += r[4 * n + i] != 0;
      if (!tangents) assert_close(-(more - less) / (2 * step), r[4 * n + i], 1e-7, 1e-5);
      for (size_t j = 0; j < 3 && tangents && body.state->touch[n % 2 * nodes + n] > 1; j++)
        assert_close(-(high[4 * n + j] - low[4 * n + j]) / (2 * step), block[stride * i + j], 1e-7, 1e-4);
    }
  assert_true(pushed > 20);
  free(r);
  free(moved);
  free(low);
  free(high);
  vsc_tangent_free(tangent);
  vsc_touch_free(touch);
  body_close(&body);
}

static void force_is_the_slope_of_an_energy_and_the_tangent_of_the_force(void **state)
{
  (void)state;
  check_slopes(0.3, false);
  check_slopes(0, true);
}

// ---- equilibria

// Lateral stretch and force of a block of 5 x 5 x 5 mm (E = 20 kPa, K = 50 kPa) pressed to the height `l` of itself:
// E (m-1)/m + U'(J) l = 0 across, force -(E (l-1) + U'(J) m^2) A, J = l m^2.
static double press_force(double l, double *lateral)
{
  double low = 1, high = 2, m = 0, U = 0;
  for (int k = 0; k < 60; k++) {
    m = 0.5 * (low + high);
    U = 25 * (l * m * m - 1 / (l * m * m));
    if (20 * (m - 1) / m + U * l > 0) high = m;
    else low = m;
  }
  *lateral = m;
  return -25 * (20 * (l - 1) + U * m * m);
}

// Between two planes a body with all nodes on them stays homogeneous, and nothing keeps it along z but them. From the
// first increment to 20 % of its height; depths of 1e-8 of its size are 1e-7 of the strain, and so of the force.
static void a_block_between_planes_has_its_closed_form(void **state)
{
  (void)state;
  small_body body;
  vsc_obstacle_def things[2] = {plane(0, 1), plane(5, -1)};
  move(&things[1], -1, 100);
  open_block(&body, 5, 0, VSC_SOLVE_EQUILIBRIUM, things, 2);
  body_build(&body);
  for (int part = 1; part <= 2; part++) {
    double m, furthest;
    const double l = 1 - 0.1 * part;
    advance(&body, 50 * part);
    const double force = press_force(l, &m);
    assert_close(body.state->contact[0].force[2], force, 1e-6, 0);
    assert_close(body.state->contact[1].force[2], -force, 1e-6, 0);
    for (size_t n = 0; n < body.model->node_count; n++)
      for (int i = 0; i < 3; i++)
        assert_close(body.state->x[4 * n + i], (i < 2 ? m : l) * body.model->rest[4 * n + i], 0, 1e-6);
    assert_true(deepest(&body, &furthest) > -1e-7);
    assert_true(furthest < 1e-7);
  }
  body_close(&body);
}

// A ball of 3 mm comes down by `way` on a damped block of 4 x 4 x 4 mm that lies on a table.
static void open_palpation(small_body *body, vsc_obstacle_def things[2], double way, vsc_solve_kind kind)
{
  things[0] = plane(0, 1);
  things[1] = ball(0.3, 0.2, 7, 3);
  move(&things[1], -way, 100);
  open_block(body, 4, 0.2, kind, things, 2);
  for (int a = 0; a < 3; a++) body->material.damping[a] = 20;
}

void settles(void **state);
void settles(void **state)
{
  (void)state;
  static double x[3][4 * 200], force[3];
  const vsc_solve_kind kinds[3] = {VSC_SOLVE_EQUILIBRIUM, VSC_SOLVE_IMPLICIT, VSC_SOLVE_EXPLICIT};
  for (int k = 0; k < 3; k++) {
    small_body body;
    vsc_obstacle_def things[2];
    open_palpation(&body, things, 0.8, kinds[k]);
    body_build(&body);
    advance(&body, 100);
    printf("steps %g\n", body.state->steps);
    advance(&body, 350);
    const double before = body.state->contact[1].impulse[2];
    printf("steps %g\n", body.state->steps);
    advance(&body, 400);
    printf("steps %g table %g ball %g work %g lost %g\n", body.state->steps, body.state->contact[0].impulse[2], body.state->contact[1].impulse[2], body.state->contact[1].work, body.state->contact[0].lost + body.state->contact[1].lost);
    force[k] = (body.state->contact[1].impulse[2] - before) / 50;
    memcpy(x[k], body.state->x, body.model->node_count * 32);
    double most = 0;
    for (size_t i = 0; i < 4 * body.model->node_count; i++) most = fmax(most, fabs(x[k][i] - x[0][i]));
    printf("%d: force %.10g off %g\n", k, force[k], most);
    body_close(&body);
  }
}

static void rests(void **state)
{
  (void)state;
  for (int b = 0; b < 2; b++)
  for (int d = 0; d < 3; d++) for (int k = 0; k < 5; k++) {
    small_body body;
    vsc_obstacle_def things[2];
    vsc_ledger *ledger;
    vsc_totals t;
    open_palpation(&body, things, 0.8, VSC_SOLVE_IMPLICIT);
    if (b == 0) { things[1] = plane(4, -1); move(&things[1], -0.8, 100); }
    for (int a = 0; a < 3; a++) body.material.damping[a] = d == 0 ? 0 : d == 1 ? 2 : 20;
    body.definition.step = (double[]){0.5, 2, 0, 0.5, 2}[k];
    if (k >= 3) body.definition.solve.scheme = VSC_SCHEME_TRAPEZOID;
    body_build(&body);
    assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
    vsc_observe(body.model, body.state, ledger, false, &t);
    double before = 0, vmax = 0, bal = 0, lostmin = 0;
    for (int row = 1; row <= 100; row++) {
      advance(&body, 2 * row);
      vsc_observe(body.model, body.state, ledger, false, &t);
      bal = fmax(bal, fabs(vsc_balance_error(ledger, &t)));
      lostmin = fmin(lostmin, t.contact_lost);
      if (row % 10 == 0) { printf(" %.6g", -(body.state->contact[1].impulse[2] - before) / 20);
      before = body.state->contact[1].impulse[2]; }
      vmax = 0; for (size_t i = 0; i < 4*body.model->node_count; i++) vmax = fmax(vmax, fabs(body.state->v[i]));
    }
    printf("\n%s damp %d step %d: steps %g lost %g min %g vmax %g work %g diss %g balance %g ",b?"ball":"plane", d, k, body.state->steps, t.contact_lost, lostmin, vmax, t.contact_work, ledger->dissipated, bal);
    printf("rej %g fail %g its/step %g\n", vsc_implicit_counted(body.state).rejected,  vsc_implicit_counted(body.state).failed, vsc_implicit_newton(body.state)->iterations / body.state->steps);
    vsc_ledger_free(ledger);
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(force_is_the_slope_of_an_energy_and_the_tangent_of_the_force),
      cmocka_unit_test(a_block_between_planes_has_its_closed_form),
      cmocka_unit_test(rests),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
