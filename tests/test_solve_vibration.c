// SPDX-License-Identifier: GPL-3.0-or-later
// Stepping against closed forms: one spring, one damped spring, a clamped bar.
#include "small_body.h"

// A tet with three corners in z = 0, held, and the fourth at height L above the origin, free along
// z: one spring of stiffness V C/L^2 under a mass of rho V/4, so that omega^2 = 4 C/(rho L^2).
#define HEIGHT 2.0

static vsc_mesh *one_tet(void)
{
  static const double nodes[12] = {0, 0, 0, 3, 0, 0, 0, 3, 0, 0, 0, HEIGHT};
  static const uint32_t tet[4] = {0, 1, 2, 3};
  vsc_mesh *mesh;
  assert_int_equal(vsc_mesh_from_arrays(4, nodes, 1, tet, &mesh, NULL), VSC_OK);
  static const char *const names[] = {"foot", "top"};
  for (int a = 0; a < 2; a++) {
    vsc_array *array = vsc_arrays_add(&mesh->node_data, names[a], 1, 4);
    assert_non_null(array);
    for (int n = 0; n < 4; n++) array->values[n] = (n == 3) == a;
  }
  return mesh;
}

static void open_spring(small_body *body, double K)
{
  body_open(body, one_tet(), K);
  body_hold(body, "foot", 1, 1, 1);
  body_hold(body, "top", 1, 1, 0);
}

static double *height(small_body *body)
{
  return body->state->x + 4 * body_node(body, 3) + 2;
}

// Verlet on x'' = -omega^2 x from rest gives exactly x_n = x_0 cos(n theta), sin(theta/2) = omega
// dt/2. Compares 40 periods; `tolerance` in parts of the amplitude.
static void check_spring(small_body *body, double modulus, double amplitude, double tolerance)
{
  body_build(body);
  *height(body) += amplitude;
  body_start(body);
  const double omega = sqrt(4 * modulus / (body->material.density * HEIGHT * HEIGHT));
  const double dt = 0.3 / omega, theta = 2 * asin(omega * dt / 2);
  for (int n = 1; n < 40 * 21; n++) {
    body_steps(body, dt, 1);
    assert_close((*height(body) - HEIGHT) / amplitude, cos(n * theta), 0, tolerance);
  }
  body_close(body);
}

// Without volume energy the uniaxial spring is linear at any amplitude, so only rounding is left:
// 1e-16 a step, growing with the square of the steps at most.
static void test_one_spring(void **state)
{
  (void)state;
  small_body body;
  open_spring(&body, NO_VOLUME);
  check_spring(&body, 20, 0.3, 1e-11);
}

// With volume energy: U''(1) = K adds to E, and the cubic term shifts the middle by a part of about
// the strain, 1e-6. Rounding of a strain of 1e-6 is 1e-10.
static void test_one_spring_with_volume(void **state)
{
  (void)state;
  small_body body;
  open_spring(&body, 70);
  check_spring(&body, 20 + 70, 1e-6 * HEIGHT, 1e-6);
}

// A frame at an angle: C = sum E_a a_z^4 + 4 sum G_ab a_z^2 b_z^2 + K for small strain.
static void test_one_spring_with_oblique_fibre(void **state)
{
  (void)state;
  small_body body;
  open_spring(&body, 30);
  const double E[3] = {50, 20, 8}, G[3] = {12, 7, 5};
  memcpy(body.material.axial, E, sizeof E);
  memcpy(body.material.angular, G, sizeof G);
  body_fibers(&body, (const double[]){1, 2, 3});
  const double *frame = body.axes->frames;
  double modulus = 30;
  for (int a = 0; a < 3; a++) {
    const double az = frame[3 * a + 2], bz = frame[3 * ((a + 1) % 3) + 2];
    modulus += E[a] * pow(az, 4) + 4 * G[a] * az * az * bz * bz;
  }
  check_spring(&body, modulus, 1e-6 * HEIGHT, 3e-6);
}

// The estimate of the stable step is the closed form's with its margin: safety . 2/sqrt(1.1
// omega^2). And the closed form itself divides what is stable from what is not.
static void test_stable_step_of_one_spring(void **state)
{
  (void)state;
  for (int above = 0; above < 2; above++) {
    small_body body;
    open_spring(&body, NO_VOLUME);
    body.definition.safety = 0.7;
    body_build(&body);
    *height(&body) += 0.01;
    body_start(&body);
    const double omega = sqrt(4 * 20 / (HEIGHT * HEIGHT));
    // the probe moves by 1e-6 of an element: its forces carry rounding of about 1e-9 of themselves
    assert_close(body.state->limit.step, 0.7 * 2 / (sqrt(1.1) * omega), 1e-8, 0);
    body_steps(&body, (above ? 1.01 : 0.99) * 2 / omega, 300);
    const double swing = fabs(*height(&body) - HEIGHT);
    assert_true(above ? swing > 1 : swing < 0.2);
    body_close(&body);
  }
}

// The damped spring at time `until` in `steps` steps: m x'' + c x' + k x = 0 with c = V eta/L^2.
static double damped_height(double eta, double until, size_t steps)
{
  small_body body;
  open_spring(&body, NO_VOLUME);
  for (int a = 0; a < 3; a++) body.material.damping[a] = eta;
  body_build(&body);
  *height(&body) += 0.1;
  body_start(&body);
  body_steps(&body, until / (double)steps, steps);
  const double found = (*height(&body) - HEIGHT) / 0.1;
  body_close(&body);
  return found;
}

// Decay rate 2 eta/(rho L^2); errors fall by four with the step, so that two runs extrapolate to
// the closed form up to the next power: (omega dt)^3 of the coarser one.
static void test_damped_spring(void **state)
{
  (void)state;
  const double omega = sqrt(4 * 20 / (HEIGHT * HEIGHT)), until = 5;
  for (double eta = 0.5; eta < 3; eta *= 2) {
    const double rate = 2 * eta / (HEIGHT * HEIGHT), shaken = sqrt(omega * omega - rate * rate);
    const double exact =
        exp(-rate * until) * (cos(shaken * until) + rate / shaken * sin(shaken * until));
    const double coarse = damped_height(eta, until, 1000), fine = damped_height(eta, until, 2000);
    assert_close((coarse - exact) / (fine - exact), 4, 0.02, 0);
    assert_close(fine + (fine - coarse) / 3, exact, 0, pow(omega * until / 1000, 3));
  }
}

// The frequency of a clamped-free bar of n x m x m bricks (40 mm long), relative to
// (pi/2L) sqrt(E/rho); springs have no Poisson coupling, so that the bar is one-dimensional.
static double bar_frequency(size_t n, size_t m, double jitter)
{
  const double length = 40, E = 20;
  small_body body;
  body_open(&body, block_of(n, m, m, length / (double)n, jitter), NO_VOLUME);
  body_hold(&body, "x0", 1, 0, 0);
  // only along the axis: the second bending mode of such a bar is too near
  body_hold(&body, "all", 0, 1, 1);
  body.sets[1].kind = VSC_SELECT_BOX;
  for (int i = 0; i < 3; i++) body.sets[1].box_high[i] = length;
  body_build(&body);
  const double exact = M_PI / (2 * length) * sqrt(E);
  double *x = body.state->x;
  const double *rest = body.model->rest;
  for (size_t k = 0; k < 4 * body.model->node_count; k += 4)
    x[k] += 1e-4 * sin(M_PI * rest[k] / (2 * length));
  body_start(&body);
  const double dt = body.state->limit.step;
  // times at which the part of the first mode changes its sign; other modes disturb single ones, so
  // a line is fitted through them
  enum { CROSSINGS = 30 };
  double sum = 0, moment = 0, before = 1;
  for (int found = 0; found < CROSSINGS;) {
    body_steps(&body, dt, 1);
    double part = 0;
    for (size_t k = 0; k < body.model->node_count; k++)
      part +=
          body.model->mass[k] * (x[4 * k] - rest[4 * k]) * sin(M_PI * rest[4 * k] / (2 * length));
    if (part * before < 0) {
      const double place = found++ - 0.5 * (CROSSINGS - 1);
      sum += place * place;
      moment += place * (body.state->time - dt * part / (part - before));
    }
    before = part;
  }
  const double stepped = M_PI * sum / moment;
  body_close(&body);
  return 2 / dt * sin(stepped * dt / 2) / exact;  // without the stepping's own error
}

// A chain of lumped masses is too slow by (pi h/4L)^2/6, and planes of nodes that move as one make
// the tets such a chain. They do not quite: the masses within a plane differ, a matter of the next
// power of h.
static double bar_error(size_t n, size_t m, double jitter)
{
  const double error = bar_frequency(n, m, jitter) - 1;
  print_message("frequency of a bar of %zu bricks: relative error %.3g\n", n, error);
  assert_close(error, -pow(M_PI / 4 / (double)n, 2) / 6, 1.2 / (double)n, 0);
  return error;
}

static void test_clamped_bar(void **state)
{
  (void)state;
  double error[3];
  for (int r = 0; r < 3; r++) error[r] = bar_error((size_t)8 << r, (size_t)1 << r, 0);
  assert_close(log2(error[0] / error[1]), 2, 0, 0.15);
  assert_close(log2(error[1] / error[2]), 2, 0, 0.1);
}

static void test_clamped_bar_of_irregular_tets(void **state)
{
  (void)state;
  const double coarse = bar_error(8, 2, 0.2), fine = bar_error(16, 4, 0.2);
  assert_close(log2(coarse / fine), 2, 0, 0.15);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_one_spring),
      cmocka_unit_test(test_one_spring_with_volume),
      cmocka_unit_test(test_one_spring_with_oblique_fibre),
      cmocka_unit_test(test_stable_step_of_one_spring),
      cmocka_unit_test(test_damped_spring),
      cmocka_unit_test(test_clamped_bar),
      cmocka_unit_test(test_clamped_bar_of_irregular_tets),
  };
  vsc_parallel_set_threads(1);
  return cmocka_run_group_tests(tests, NULL, NULL);
}
