// SPDX-License-Identifier: GPL-3.0-or-later
// Membranes in the whole model: forces are the gradient of the stored energy and neither push nor
// turn, tangents are their derivatives, threads do not matter, a capsule stiffens its block by
// modulus x thickness x perimeter, masses, the step's bound, and what is refused.
#include "close.h"

#include "base/mem.h"
#include "mech/force.h"
#include "mech/step_limit.h"
#include "mech/tangent.h"
#include "random.h"
#include "sheet_mesh.h"
#include "small_body.h"

static vsc_membrane_def capsule(const char *surface)
{
  vsc_membrane_def def = vsc_default_membrane();
  vsc_copy_name(def.name, "capsule");
  vsc_copy_name(def.surface, surface);
  def.thickness = 0.2;
  def.density = 2;
  def.axial[0] = 90;
  def.axial[1] = 60;
  def.angular = 30;
  def.area_modulus = 20;
  def.damping[0] = 4;
  def.damping[1] = 3;
  def.bending = 5;
  return def;
}

// A curved sheet alone.
static void open_sheet(small_body *body, vsc_membrane_def *membrane)
{
  vsc_mesh *mesh = sheet_mesh(13, 11, 1, 1.2, CUT_BY_TURNS, 0.25, 7);
  for (size_t n = 0; n < mesh->node_count; n++) {
    double *x = mesh->nodes + 3 * n;
    x[2] = 0.05 * x[0] * x[0] - 0.03 * x[0] * x[1];
  }
  body_open(body, mesh, 0);
  body->definition.material_count = 0;
  *membrane = capsule("triangles");
  body->definition.membranes = membrane;
  body->definition.membrane_count = 1;
}

// A block of tissue in a capsule.
static void open_block(small_body *body, vsc_membrane_def *membrane)
{
  body_open(body, block_of(5, 4, 3, 1, 0.2), 100);
  *membrane = capsule("boundary");
  body->definition.membranes = membrane;
  body->definition.membrane_count = 1;
}

static void (*const openers[])(small_body *, vsc_membrane_def *) = {open_sheet, open_block};

static void open_built(int o, small_body *body)
{
  vsc_membrane_def membrane;
  openers[o](body, &membrane);
  body_build(body);
}

static void deform(small_body *body, uint64_t seed, double size)
{
  for (size_t n = 0; n < body->model->node_count; n++)
    for (int i = 0; i < 3; i++) {
      body->state->x[4 * n + i] += random_between(&seed, -size, size);
      body->state->v[4 * n + i] = random_between(&seed, -1, 1);
    }
}

static double stored(small_body *body, vsc_totals *totals)
{
  vsc_ledger *ledger;
  assert_int_equal(vsc_ledger_create(body->model, &ledger, NULL), VSC_OK);
  vsc_observe(body->model, body->state, ledger, false, totals);
  vsc_ledger_free(ledger);
  return totals->axial + totals->angular + totals->volume_energy + totals->membrane +
         totals->bending;
}

static double energy_at(small_body *body, const double *x0, const double *d, double h)
{
  vsc_totals totals;
  for (size_t i = 0; i < 4 * body->model->node_count; i++) body->state->x[i] = x0[i] + h * d[i];
  return stored(body, &totals);
}

// Halving the difference divides its error by 4.
static void forces_are_the_gradient(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    small_body body;
    open_built(o, &body);
    deform(&body, 11, 0.15);
    const size_t count = 4 * body.model->node_count;
    double *x = vsc_alloc(count, sizeof *x), *d = vsc_alloc(count, sizeof *d);
    double *force = vsc_alloc(count, sizeof *force);
    memcpy(x, body.state->x, count * sizeof *x);
    vsc_force(body.model, x, NULL, 0, &body.state->scratch, force);
    uint64_t seed = 12;
    double errors[4] = {0};
    for (int round = 0; round < 10; round++) {
      double slope = 0;
      for (size_t i = 0; i < count; i++) {
        d[i] = i % 4 == 3 ? 0 : random_between(&seed, -1, 1);
        slope -= force[i] * d[i];
      }
      for (int s = 0; s < 4; s++) {
        const double h = ldexp(1, -8 - s);
        errors[s] +=
            fabs((energy_at(&body, x, d, h) - energy_at(&body, x, d, -h)) / (2 * h) - slope);
      }
    }
    for (int s = 0; s < 3; s++) assert_close(log2(errors[s] / errors[s + 1]), 2, 0, 0.1);
    vsc_free(x);
    vsc_free(d);
    vsc_free(force);
    body_close(&body);
  }
}

static void forces_neither_push_nor_turn(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    small_body body;
    open_built(o, &body);
    deform(&body, 13, 0.2);
    double *force = vsc_alloc(4 * body.model->node_count, sizeof *force);
    vsc_force(body.model, body.state->x, body.state->v, 0, &body.state->scratch, force);
    double sum[3] = {0}, torque[3] = {0}, size = 0;
    for (size_t n = 0; n < body.model->node_count; n++) {
      const double *x = body.state->x + 4 * n, *f = force + 4 * n;
      for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        sum[i] += f[i];
        torque[i] += x[j] * f[k] - x[k] * f[j];
        size = fmax(size, fabs(f[i]));
      }
    }
    // some hundred nodes, lengths of 13 mm
    for (int i = 0; i < 3; i++) {
      assert_close(sum[i], 0, 0, 1e-13 * size);
      assert_close(torque[i], 0, 0, 2e-12 * size);
    }
    vsc_free(force);
    body_close(&body);
  }
}

// The power that damping takes is force times velocity.
static void damping_takes_what_it_says(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    small_body body;
    open_built(o, &body);
    deform(&body, 17, 0.1);
    const size_t count = 4 * body.model->node_count;
    double *with = vsc_alloc(count, sizeof *with), *without = vsc_alloc(count, sizeof *without);
    vsc_force(body.model, body.state->x, body.state->v, 0, &body.state->scratch, with);
    vsc_force(body.model, body.state->x, NULL, 0, &body.state->scratch, without);
    double power = 0;
    for (size_t i = 0; i < count; i++) power += (without[i] - with[i]) * body.state->v[i];
    vsc_totals totals;
    stored(&body, &totals);
    assert_true(totals.dissipation > 0);
    assert_close(power, totals.dissipation, 1e-12, 0);
    vsc_free(with);
    vsc_free(without);
    body_close(&body);
  }
}

// y = A d at x, w, `before` with A = a K + b C; all node_count x 4.
static void tangent_product(small_body *body, const double *w, const double *before, double a, double b,
                            const double *d, double *y)
{
  vsc_tangent *tangent;
  vsc_error error;
  if (vsc_tangent_create(body->model, &tangent, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_tangent_assemble(body->model, tangent, body->state->x, w, before, 0, a, b, &body->state->scratch);
  vsc_tangent_times(tangent, body->model->inverse_mass, d, y);
  vsc_tangent_free(tangent);
}

// (f(x - h d, w - h e) - f(x + h d, w + h e))/2h, d and e NULL: 0.
static void force_difference(small_body *body, const double *w, const double *d, const double *e, double h, double *y)
{
  const size_t count = 4 * body->model->node_count;
  double *x = vsc_alloc(count, sizeof *x), *speed = vsc_alloc(count, sizeof *x), *f = vsc_alloc(count, sizeof *f);
  for (int side = -1; side <= 1; side += 2) {
    for (size_t i = 0; i < count; i++) {
      x[i] = body->state->x[i] + (d != NULL ? side * h * d[i] : 0);
      speed[i] = w != NULL ? w[i] + (e != NULL ? side * h * e[i] : 0) : 0;
    }
    vsc_force(body->model, x, w != NULL ? speed : NULL, 0, &body->state->scratch, f);
    for (size_t i = 0; i < count; i++) y[i] = (side > 0 ? y[i] : 0) - side * f[i] / (2 * h);
  }
  vsc_free(x);
  vsc_free(speed);
  vsc_free(f);
}

static double *any_numbers(size_t count, uint64_t seed)
{
  double *array = vsc_alloc(count, sizeof *array);
  for (size_t i = 0; i < count; i++) array[i] = i % 4 == 3 ? 0 : random_between(&seed, -1, 1);
  return array;
}

static double size_of(const double *a, size_t count)
{
  double most = 0;
  for (size_t i = 0; i < count; i++) most = fmax(most, fabs(a[i]));
  return most;
}

// Differences of steps 2^-11 and 2^-12 mm are extrapolated; what is left is the fourth power of the step and
// rounding, some 1e-12/h of it. Velocities act linearly: one difference is exact but for rounding. What an iterate
// foretells of its own place is what is there.
static void tangents_are_derivatives(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    small_body body;
    open_built(o, &body);
    deform(&body, 19, 0.15);
    const size_t count = 4 * body.model->node_count;
    double *d = any_numbers(count, 20), *y = any_numbers(count, 0), *z = any_numbers(count, 0);
    double *coarse = any_numbers(count, 0), *fine = any_numbers(count, 0);
    tangent_product(&body, NULL, NULL, 1, 0, d, y);
    force_difference(&body, NULL, d, NULL, ldexp(1, -11), coarse);
    force_difference(&body, NULL, d, NULL, ldexp(1, -12), fine);
    const double size = size_of(y, count);
    for (size_t i = 0; i < count; i++)
      if (i % 4 < 3) assert_close(y[i], (4 * fine[i] - coarse[i]) / 3, 0, 2e-9 * size);
    tangent_product(&body, NULL, body.state->x, 1, 0, d, z);
    for (size_t i = 0; i < count; i++) assert_close(z[i], y[i], 0, 1e-13 * size);
    tangent_product(&body, body.state->v, NULL, 0, 1, d, y);
    force_difference(&body, body.state->v, NULL, d, 1, z);
    assert_true(size_of(y, count) > 1);
    for (size_t i = 0; i < count; i++)
      if (i % 4 < 3) assert_close(y[i], z[i], 0, 1e-12 * size_of(y, count));
    vsc_free(d);
    vsc_free(y);
    vsc_free(z);
    vsc_free(coarse);
    vsc_free(fine);
    body_close(&body);
  }
}

// A body at rest resists no motion as one rigid thing; bent sheets neither.
static void tangents_let_rigid_motions_free(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    small_body body;
    open_built(o, &body);
    const size_t count = 4 * body.model->node_count;
    double *d = any_numbers(count, 21), *y = any_numbers(count, 0);
    tangent_product(&body, NULL, NULL, 1, 0, d, y);
    const double size = size_of(y, count);
    for (int motion = 0; motion < 6; motion++) {
      const int a = motion % 3, b = (a + 1) % 3, c = (a + 2) % 3;
      memset(d, 0, count * sizeof *d);
      for (size_t n = 0; n < count; n += 4) {
        if (motion < 3) d[n + (size_t)a] = 1;
        if (motion >= 3) d[n + (size_t)b] = -body.state->x[n + (size_t)c];
        if (motion >= 3) d[n + (size_t)c] = body.state->x[n + (size_t)b];
      }
      tangent_product(&body, NULL, NULL, 1, 0, d, y);
      // motions of 13 mm
      for (size_t i = 0; i < count; i++) assert_close(y[i], 0, 0, 1e-13 * size);
    }
    vsc_free(d);
    vsc_free(y);
    body_close(&body);
  }
}

// Rows of the consistent mass matrix sum to the masses of nodes.
static void consistent_masses_sum_up(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    small_body body;
    vsc_membrane_def membrane;
    vsc_tangent *tangent;
    openers[o](&body, &membrane);
    body.definition.masses = VSC_MASS_CONSISTENT;
    body.definition.solve.kind = VSC_SOLVE_IMPLICIT;
    body_build(&body);
    const size_t count = 4 * body.model->node_count;
    double *one = any_numbers(count, 0), *y = vsc_alloc(count, sizeof *y);
    memset(y, 0, count * sizeof *y);
    for (size_t i = 0; i < count; i++) one[i] = 1;
    assert_int_equal(vsc_tangent_create(body.model, &tangent, NULL), VSC_OK);
    vsc_tangent_masses_times(body.model, tangent, 1, one, y);
    for (size_t i = 0; i < count; i++)
      if (i % 4 < 3) assert_close(y[i], body.model->mass[i / 4], 1e-13, 0);
    vsc_tangent_free(tangent);
    vsc_free(one);
    vsc_free(y);
    body_close(&body);
  }
}

static void nothing_at_rest(void **state)
{
  (void)state;
  small_body body;
  vsc_membrane_def membrane;
  open_sheet(&body, &membrane);
  body_build(&body);
  vsc_totals totals;
  stored(&body, &totals);
  assert_close(totals.membrane, 0, 0, 1e-24);
  assert_close(totals.bending, 0, 0, 1e-24);
  body_close(&body);
}

// The same bits for any number of threads, after a hundred steps.
static void threads_do_not_matter(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++) {
    uint64_t first = 0;
    for (int threads = 1; threads <= 4; threads++) {
      vsc_parallel_set_threads(threads);
      small_body body;
      open_built(o, &body);
      assert_true(body.model->patch_count > 2);  // else there is nothing to share
      body_start(&body);
      body_shake(&body, 0.2);
      body_steps(&body, 0.5 * body.state->limit.step, 100);
      const uint64_t hash = vsc_state_hash(body.model, body.state);
      if (threads == 1) first = hash;
      assert_true(hash == first);
      body_close(&body);
    }
    vsc_parallel_set_threads(1);
  }
}

// A free sheet without damping that swings keeps its energy to what the step makes of it, and its
// momenta to rounding.
static void energy_and_momenta_are_kept(void **state)
{
  (void)state;
  small_body body;
  vsc_membrane_def membrane;
  open_sheet(&body, &membrane);
  membrane.damping[0] = membrane.damping[1] = 0;
  body_build(&body);
  body_start(&body);
  body_shake(&body, 0.3);
  vsc_totals before, after;
  vsc_ledger *ledger;
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  vsc_observe(body.model, body.state, ledger, false, &before);
  body_start(&body);
  body_steps(&body, 0.1 * body.state->limit.step, 5000);
  vsc_observe(body.model, body.state, ledger, false, &after);
  assert_true(after.membrane > 0.05 * before.kinetic && after.bending > 0.05 * before.kinetic);
  // the step's error is its square, 1/100 of what is stable at most, over 16
  assert_close(vsc_balance_error(ledger, &after), 0, 0, 1e-3 * before.kinetic);
  for (int i = 0; i < 3; i++) {
    assert_close(after.momentum[i], before.momentum[i], 0, 1e-10);
    assert_close(after.angular_momentum[i], before.angular_momentum[i], 0, 1e-9);
  }
  vsc_ledger_free(ledger);
  body_close(&body);
}

// Force on the nodes of the face x = x_1 of a block stretched along x by a hundredth.
static double pull(double thickness, double lambda)
{
  small_body body;
  vsc_membrane_def membrane;
  open_block(&body, &membrane);
  membrane.thickness = thickness;
  membrane.bending = 0;
  body_build(&body);
  for (size_t n = 0; n < body.model->node_count; n++) body.state->x[4 * n] *= lambda;
  double *force = vsc_alloc(4 * body.model->node_count, sizeof *force), sum = 0;
  vsc_force(body.model, body.state->x, NULL, 0, &body.state->scratch, force);
  for (size_t n = 0; n < body.model->node_count; n++)
    if (body.model->rest[4 * n] > 5 - 1e-9) sum -= force[4 * n];
  vsc_free(force);
  body_close(&body);
  return sum;
}

// E_a (lambda - 1) + K (lambda - 1) of each sheet along x, on the perimeter of 4 x 3 mm.
static void a_capsule_stiffens_its_block(void **state)
{
  (void)state;
  const double lambda = 1.01, thin = pull(1e-9, lambda), thick = pull(0.2, lambda);
  assert_close(thick - thin, 0.2 * 14 * (90 + 20) * (lambda - 1), 1e-7, 0);
}

static void masses_are_thickness_times_area(void **state)
{
  (void)state;
  small_body body;
  vsc_membrane_def membrane;
  open_block(&body, &membrane);
  body_build(&body);
  // the block's density is 1; its surface 2 (5 4 + 5 3 + 4 3) mm2
  assert_close(body.model->total_mass, 60 + 2 * 0.2 * 94, 1e-13, 0);
  assert_close(body.model->membranes[0].area, 94, 1e-13, 0);
  assert_close(body.model->total_volume, 60, 1e-13, 0);
  body_close(&body);
}

// The bound holds and is not far off, and points at a place.
static void the_bound_is_a_bound(void **state)
{
  (void)state;
  for (int o = 0; o < 2; o++)
    for (int bends = 0; bends < 2; bends++) {
      small_body body;
      vsc_membrane_def membrane;
      openers[o](&body, &membrane);
      membrane.damping[0] = membrane.damping[1] = 0;
      membrane.bending = bends ? 50 : 0;
      body_build(&body);
      vsc_limit_refresh(body.model, body.state, 0, 300);
      size_t slot = SIZE_MAX;
      const double bound = vsc_limit_bound(body.model, &body.state->scratch, &slot);
      assert_true(slot < VSC_WIDTH * body.model->pack_count);
      assert_true(bound >= body.state->limit.eigenvalue);
      assert_true(bound < 10 * body.state->limit.eigenvalue);
      body_close(&body);
    }
}

static void what_nothing_holds_is_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_membrane_def membrane;
  vsc_error error;
  open_sheet(&body, &membrane);
  body.sets[0] =
      (vsc_selector){.kind = VSC_SELECT_BOX, .box_low = {-1, -1, -9}, .box_high = {5, 99, 9}};
  vsc_copy_name(body.sets[0].name, "half");
  body.definition.surfaces = body.sets;
  body.definition.surface_count = 1;
  vsc_copy_name(membrane.surface, "half");
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &body.model, &error),
                   VSC_INPUT);
  assert_non_null(strstr(error.text, "belongs to no membrane"));
  body_close(&body);
  open_block(&body, &membrane);
  vsc_copy_name(membrane.surface, "triangles");
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &body.model, &error),
                   VSC_INPUT);
  assert_non_null(strstr(error.text, "has no triangles"));
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_are_the_gradient),
      cmocka_unit_test(forces_neither_push_nor_turn),
      cmocka_unit_test(damping_takes_what_it_says),
      cmocka_unit_test(tangents_are_derivatives),
      cmocka_unit_test(tangents_let_rigid_motions_free),
      cmocka_unit_test(consistent_masses_sum_up),
      cmocka_unit_test(nothing_at_rest),
      cmocka_unit_test(threads_do_not_matter),
      cmocka_unit_test(energy_and_momenta_are_kept),
      cmocka_unit_test(a_capsule_stiffens_its_block),
      cmocka_unit_test(masses_are_thickness_times_area),
      cmocka_unit_test(the_bound_is_a_bound),
      cmocka_unit_test(what_nothing_holds_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
