// SPDX-License-Identifier: GPL-3.0-or-later
// The whole force: against a plain oracle, as the gradient of the energy, and its symmetries.
#include "base/vec3.h"
#include "close.h"
#include "mech/element.h"
#include "oracle_force.h"
#include "random_body.h"

enum { BRICKS = 5 };  // 750 tets: at least 6 patches

static const vsc_active_kind kinds[] = {VSC_ACTIVE_NONE, VSC_ACTIVE_SPRING, VSC_ACTIVE_TENSION};
static const vsc_volume_kind volumes[] = {VSC_VOLUME_NODAL, VSC_VOLUME_ELEMENT};

static void without_loads(random_body *body)
{
  body->definition.pressure_count = 0;
  memset(body->definition.gravity, 0, sizeof body->definition.gravity);
}

// All forces together, with tets squeezed below J0 and turned inside out among them.
static void compare_with_oracle(random_body *body, double noise, uint64_t seed)
{
  const size_t count = 3 * body->mesh->node_count;
  double *x = deformed(body->mesh, 0.15, noise, seed), *w = random_array(count, 0.5, seed + 1);
  double *force = numbers(count), *expected = numbers(count);
  const double times[] = {0, 12.5, 70, 500};
  for (int k = 0; k < 4; k++) {
    body_force(body, x, k == 3 ? NULL : w, times[k], force);
    oracle_force(body, x, k == 3 ? NULL : w, times[k], expected);
    const double size = largest_of(expected, count);
    assert_true(size > 0.1);
    // a node's force is the sum of some 24 tets' forces of that size
    for (size_t i = 0; i < count; i++) assert_close(force[i], expected[i], 0, 1e-14 * size);
  }
  vsc_free(x);
  vsc_free(w);
  vsc_free(force);
  vsc_free(expected);
}

static void the_force_is_the_plain_sum_over_tets(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 2; v++) {
      random_body body;
      random_body_open(&body, BRICKS, kinds[k], volumes[v], 100 + 10 * (uint64_t)k + (uint64_t)v);
      assert_true(body.model->patch_count >= 6);
      compare_with_oracle(&body, 0.1, 7);
      compare_with_oracle(&body, 0.6, 8);
      body_close(&body);
    }
}

// Amplitude alone, delay alone, neither: each has its own path through the loop.
static void activation_arrays_may_be_absent(void **state)
{
  (void)state;
  for (int arrays = 0; arrays < 4; arrays++)
    for (int known = 0; known < 2; known++) {
      random_body body;
      vsc_mesh *mesh = random_block(4, 3);
      body_define(&body, mesh, random_axes(mesh->element_count, 4), VSC_ACTIVE_SPRING,
                  VSC_VOLUME_NODAL);
      if (!(arrays & 1)) body.materials[0].active.amplitude_array[0] = '\0';
      if (!(arrays & 2)) body.materials[0].active.delay_array[0] = '\0';
      if (known) memset(body.axes->known, 1, mesh->element_count);
      body_build(&body);
      compare_with_oracle(&body, 0.1, 9);
      body_close(&body);
    }
}

// Any of them, or all.
static void angular_springs_may_be_absent(void **state)
{
  (void)state;
  for (int absent = 0; absent < 8; absent++) {
    random_body body;
    vsc_mesh *mesh = random_block(3, 3);
    body_define(&body, mesh, random_axes(mesh->element_count, 4), VSC_ACTIVE_NONE, VSC_VOLUME_NODAL);
    for (size_t m = 0; m < body.definition.material_count; m++)
      for (int a = 0; a < 3; a++)
        if (absent & 1 << a) body.materials[m].angular[a] = 0;
    body_build(&body);
    compare_with_oracle(&body, 0.1, 9);
    body_close(&body);
  }
}

// What active tissue stores while its activation is frozen: springs E(a) (n - r(a))^2/2 in place of
// the passive fibre spring, tension T a (n^2 - 1)/2. From the fields, in the mesh's order.
static double active_energy(random_body *body, double time)
{
  const vsc_material_def *muscle = &body->materials[0];
  const double E = muscle->axial[0];
  double *stretch = numbers(body->mesh->element_count), sum = 0;
  vsc_read_field(body->model, body->state, VSC_FIELD_STRETCH, stretch);
  for (size_t t = 0; t < body->mesh->element_count; t++) {
    const double a = oracle_activation(body, t, time), n = stretch[t];
    const double V = vsc_mesh_element_volume(body->mesh, t);
    const double E_now = E + a * (muscle->active.stiffness - E),
                 r = 1 - a * (1 - muscle->active.rest_stretch);
    if (muscle->active.kind == VSC_ACTIVE_TENSION)
      sum += V * a * muscle->active.tension * (n * n - 1) / 2;
    else if (a > 0)
      sum += V * (E_now * (n - r) * (n - r) - E * (n - 1) * (n - 1)) / 2;
  }
  vsc_free(stretch);
  return sum;
}

static double total_energy(random_body *body, const double *x, double time)
{
  vsc_totals totals;
  to_model(body->model, x, body->state->x);
  vsc_observe(body->model, body->state, body->ledger, false, &totals);
  return totals.axial + totals.angular + totals.volume_energy + totals.gravity_energy +
         active_energy(body, time) + body->pressure.peak * oracle_ramp(time) * totals.volume;
}

// |(E(x + h d) - E(x - h d))/2h + f . d| of one direction
static double gradient_error(random_body *body, const double *x, const double *d,
                             const double *force, double h, double time)
{
  const size_t count = 3 * body->mesh->node_count;
  double *moved = numbers(count), energy[2];
  for (int side = 0; side < 2; side++) {
    for (size_t i = 0; i < count; i++) moved[i] = x[i] + (side ? -h : h) * d[i];
    energy[side] = total_energy(body, moved, time);
  }
  vsc_free(moved);
  return fabs((energy[0] - energy[1]) / (2 * h) + dot_of(force, d, count));
}

// The error falls as h^2; summed over directions, since in one its coefficient may be small by
// chance. Nodes move by up to 1/64 of a brick, so that the next term changes the order by little.
static void check_gradient(random_body *body, double time)
{
  enum { DIRECTIONS = 8, STEPS = 3 };
  const size_t count = 3 * body->mesh->node_count;
  double *x = deformed(body->mesh, 0.12, 0.05, 21), *force = numbers(count), errors[STEPS] = {0};
  body_force(body, x, NULL, time, force);
  for (int k = 0; k < DIRECTIONS; k++) {
    double *d = random_array(count, 1, 22 + (uint64_t)k);
    for (int h = 0; h < STEPS; h++)
      errors[h] += gradient_error(body, x, d, force, ldexp(1, -6 - h), time);
    vsc_free(d);
  }
  for (int h = 0; h + 1 < STEPS; h++) assert_close(log2(errors[h] / errors[h + 1]), 2, 0, 0.03);
  vsc_free(x);
  vsc_free(force);
}

static void force_is_minus_the_gradient_of_energy(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 2; v++) {
      random_body body;
      random_body_open(&body, 4, kinds[k], volumes[v], 40);
      check_gradient(&body, 0);
      check_gradient(&body, 60);
      body_close(&body);
    }
}

// Sum of forces and of moments, relative to the sums of |f| and |f| |x|.
static void check_balance(const double *x, const double *force, size_t nodes, double tolerance)
{
  double sum[3] = {0}, moment[3] = {0}, forces = 0, moments = 0;
  for (size_t n = 0; n < nodes; n++) {
    double product[3];
    vsc_cross(x + 3 * n, force + 3 * n, product);
    for (int i = 0; i < 3; i++) {
      sum[i] += force[3 * n + i];
      moment[i] += product[i];
    }
    forces += vsc_norm(force + 3 * n);
    moments += vsc_norm(force + 3 * n) * vsc_norm(x + 3 * n);
  }
  assert_true(forces > 0);
  for (int i = 0; i < 3; i++) {
    assert_close(sum[i], 0, 0, tolerance * forces);
    assert_close(moment[i], 0, 0, tolerance * moments);
  }
}

// Internal forces, active ones, damping, and pressure on the closed boundary: each balances.
static void forces_and_moments_sum_to_zero(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++)
    for (int v = 0; v < 2; v++) {
      random_body body;
      vsc_mesh *mesh = random_block(BRICKS, 50);
      body_define(&body, mesh, random_axes(mesh->element_count, 51), kinds[k], volumes[v]);
      memset(body.definition.gravity, 0, sizeof body.definition.gravity);
      body_build(&body);
      const size_t count = 3 * mesh->node_count;
      double *x = deformed(mesh, 0.2, 0.3, 52), *w = random_array(count, 1, 53),
             *force = numbers(count);
      body_force(&body, x, w, 80, force);
      // nodes' forces are sums over their tets, rounded at the size of the tets' forces
      check_balance(x, force, mesh->node_count, 1e-15);
      vsc_free(x);
      vsc_free(w);
      vsc_free(force);
      body_close(&body);
    }
}

// A body moved as a whole is not strained: x = R X + c. Positions of some 20 mm are rounded to
// 4e-15, strains to 1e-14, times moduli of 250 kPa and faces of 1 mm^2; 25 tets round a node.
static void rigid_motion_gives_no_force(void **state)
{
  (void)state;
  uint64_t seed = 60;
  for (int round = 0; round < 10; round++) {
    random_body body;
    vsc_mesh *mesh = random_block(4, 61);
    body_define(&body, mesh, random_axes(mesh->element_count, 62), VSC_ACTIVE_SPRING,
                volumes[round % 2]);
    without_loads(&body);
    body_build(&body);
    double R[9], shift[3], *x = numbers(3 * mesh->node_count),
                           *force = numbers(3 * mesh->node_count);
    random_rotation(&seed, R);
    random_fill(&seed, 20, shift, 3);
    for (size_t n = 0; n < mesh->node_count; n++) {
      rotate_vector(R, mesh->nodes + 3 * n, x + 3 * n);
      for (int i = 0; i < 3; i++) x[3 * n + i] += shift[i];
    }
    body_force(&body, x, NULL, 0, force);
    assert_close(largest_of(force, 3 * mesh->node_count), 0, 0, 1e-11);
    vsc_free(x);
    vsc_free(force);
    body_close(&body);
  }
}

// f(R x + c) = R f(x), active and under pressure.
static void forces_turn_with_the_body(void **state)
{
  (void)state;
  random_body body;
  vsc_mesh *mesh = random_block(4, 63);
  body_define(&body, mesh, random_axes(mesh->element_count, 64), VSC_ACTIVE_TENSION, VSC_VOLUME_NODAL);
  memset(body.definition.gravity, 0, sizeof body.definition.gravity);
  body_build(&body);
  const size_t nodes = mesh->node_count;
  double R[9], *x = deformed(mesh, 0.15, 0.1, 65), *w = random_array(3 * nodes, 1, 66);
  double *turned_x = numbers(3 * nodes), *turned_w = numbers(3 * nodes);
  double *force = numbers(3 * nodes), *turned = numbers(3 * nodes);
  uint64_t seed = 67;
  random_rotation(&seed, R);
  for (size_t n = 0; n < nodes; n++) {
    rotate_vector(R, x + 3 * n, turned_x + 3 * n);
    rotate_vector(R, w + 3 * n, turned_w + 3 * n);
    for (int i = 0; i < 3; i++) turned_x[3 * n + i] += 5;
  }
  body_force(&body, x, w, 80, force);
  body_force(&body, turned_x, turned_w, 80, turned);
  const double size = largest_of(force, 3 * nodes);
  for (size_t n = 0; n < nodes; n++) {
    double expected[3];
    rotate_vector(R, force + 3 * n, expected);
    for (int i = 0; i < 3; i++) assert_close(turned[3 * n + i], expected[i], 0, 1e-14 * size);
  }
  double *arrays[] = {x, w, turned_x, turned_w, force, turned};
  for (int i = 0; i < 6; i++) vsc_free(arrays[i]);
  body_close(&body);
}

// The damping part of the force: balances, takes energy from every motion that stretches an axis,
// and takes exactly what the totals call dissipation.
static void damping_dissipates_and_keeps_momenta(void **state)
{
  (void)state;
  random_body body;
  random_body_open(&body, BRICKS, VSC_ACTIVE_NONE, VSC_VOLUME_ELEMENT, 70);
  const size_t count = 3 * body.mesh->node_count;
  double *x = deformed(body.mesh, 0.2, 0.1, 71), *still = numbers(count), *force = numbers(count);
  body_force(&body, x, NULL, 0, still);
  for (int round = 0; round < 20; round++) {
    double *w = random_array(count, 1, 72 + (uint64_t)round);
    body_force(&body, x, w, 0, force);
    for (size_t i = 0; i < count; i++) force[i] -= still[i];
    check_balance(x, force, body.mesh->node_count,
                  1e-13);  // a difference of forces ten times as large
    vsc_totals totals;
    to_model(body.model, x, body.state->x);
    to_model(body.model, w, body.state->v);
    vsc_observe(body.model, body.state, body.ledger, false, &totals);
    assert_true(totals.dissipation > 0);
    assert_close(dot_of(force, w, count), -totals.dissipation, 1e-13, 0);
    vsc_free(w);
  }
  vsc_free(x);
  vsc_free(still);
  vsc_free(force);
  body_close(&body);
}

// Turning as a whole (w = omega x x) stretches nothing and is not damped.
static void rotation_is_not_damped(void **state)
{
  (void)state;
  random_body body;
  random_body_open(&body, 4, VSC_ACTIVE_NONE, VSC_VOLUME_NODAL, 73);
  const size_t count = 3 * body.mesh->node_count;
  const double omega[3] = {0.3, -0.2, 0.5};
  double *x = deformed(body.mesh, 0.2, 0.1, 74), *w = numbers(count);
  double *still = numbers(count), *force = numbers(count);
  for (size_t n = 0; n < body.mesh->node_count; n++) {
    vsc_cross(omega, x + 3 * n, w + 3 * n);
    w[3 * n] += 7;
  }
  body_force(&body, x, NULL, 0, still);
  body_force(&body, x, w, 0, force);
  const double size = largest_of(still, count);
  for (size_t i = 0; i < count; i++) assert_close(force[i], still[i], 0, 1e-15 * size);
  vsc_free(x);
  vsc_free(w);
  vsc_free(still);
  vsc_free(force);
  body_close(&body);
}

// V P : (B u) of one tet, with the oracle's stress; the sum of the terms' sizes goes to `size`.
static double virtual_work(const oracle_tet *tet, const vsc_wide3 rate[3], int lane, double *size)
{
  double P[9], g[3][3], cofactor[3], work = 0;
  oracle_springs(tet, VSC_ACTIVE_NONE, P);
  const double pressure = oracle_pressure(tet->material->volume_modulus, tet->J);
  for (int a = 0; a < 3; a++) rotate_vector(tet->F, tet->frame + 3 * a, g[a]);
  for (int a = 0; a < 3; a++) {
    const double r[3] = {rate[a].x[lane], rate[a].y[lane], rate[a].z[lane]};
    vsc_cross(g[(a + 1) % 3], g[(a + 2) % 3], cofactor);
    for (int i = 0; i < 3; i++) {
      const double term = tet->V * (P[3 * a + i] + pressure * cofactor[i]) * r[i];
      work += term;
      *size += fabs(term);
    }
  }
  return work;
}

// Scatter is the transpose of gather: f . u = -sum_e V_e P : (B u).
static void scatter_is_the_transpose_of_gather(void **state)
{
  (void)state;
  random_body body;
  vsc_mesh *mesh = random_block(4, 80);
  body_define(&body, mesh, random_axes(mesh->element_count, 81), VSC_ACTIVE_NONE, VSC_VOLUME_ELEMENT);
  without_loads(&body);
  body_build(&body);
  const vsc_model *model = body.model;
  const size_t count = 3 * mesh->node_count;
  double *x = deformed(mesh, 0.15, 0.05, 82), *u = random_array(count, 1, 83),
         *force = numbers(count);
  double *u_model = numbers(4 * mesh->node_count), work = 0, size = 0;
  body_force(&body, x, NULL, 0, force);
  to_model(model, u, u_model);
  for (size_t p = 0; p < model->patch_count; p++) {
    const vsc_patch *patch = &model->patches[p];
    for (size_t k = patch->first_pack; k < patch->first_pack + patch->pack_count; k++) {
      vsc_wide3 rate[3];
      vsc_pack_axes(model, patch, k, 0, u_model, rate);
      for (int l = 0; l < VSC_WIDTH; l++) {
        const uint32_t t = model->mesh_element[VSC_WIDTH * k + (size_t)l];
        if (t == VSC_NO_ELEMENT) continue;
        const oracle_tet tet = oracle_read(&body, t, x, NULL, 0);
        work += virtual_work(&tet, rate, l, &size);
      }
    }
  }
  assert_close(dot_of(force, u, count), -work, 0, 1e-14 * size);
  vsc_free(x);
  vsc_free(u);
  vsc_free(force);
  vsc_free(u_model);
  body_close(&body);
}

// Gravity is m g, together the total mass times g; at rest nothing else pulls.
static void weight_is_mass_times_gravity(void **state)
{
  (void)state;
  random_body body;
  random_body_open(&body, 4, VSC_ACTIVE_NONE, VSC_VOLUME_NODAL, 90);
  const size_t nodes = body.mesh->node_count;
  double *force = numbers(3 * nodes), sum[3] = {0};
  body_force(&body, body.mesh->nodes, NULL, 0, force);
  for (size_t n = 0; n < nodes; n++)
    for (int i = 0; i < 3; i++) sum[i] += force[3 * n + i];
  // 64 mm^3 of 1.06 mg/mm^3
  for (int i = 0; i < 3; i++)
    assert_close(sum[i], 64 * 1.06 * body.definition.gravity[i], 1e-14, 0);
  for (size_t n = 0; n < nodes; n++)
    for (int i = 0; i < 3; i++)
      assert_close(force[3 * (size_t)body.model->mesh_node[n] + i],
                   body.model->mass[n] * body.definition.gravity[i], 0, 1e-13);
  vsc_free(force);
  body_close(&body);
}

int main(void)
{
  vsc_parallel_set_threads(1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_force_is_the_plain_sum_over_tets),
      cmocka_unit_test(activation_arrays_may_be_absent),
      cmocka_unit_test(angular_springs_may_be_absent),
      cmocka_unit_test(force_is_minus_the_gradient_of_energy),
      cmocka_unit_test(forces_and_moments_sum_to_zero),
      cmocka_unit_test(rigid_motion_gives_no_force),
      cmocka_unit_test(forces_turn_with_the_body),
      cmocka_unit_test(damping_dissipates_and_keeps_momenta),
      cmocka_unit_test(rotation_is_not_damped),
      cmocka_unit_test(scatter_is_the_transpose_of_gather),
      cmocka_unit_test(weight_is_mass_times_gravity),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
