// SPDX-License-Identifier: GPL-3.0-or-later
// The estimated stable step against the true one: all eigenvalues of M^-1 (K + 2/dt C) of small
// bodies, K and C by differences of the force, and stepping just below and above.
#include <gsl/gsl_blas.h>
#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>

#include "base/vec3.h"
#include "close.h"
#include "mech/coupled_mass.h"
#include "mech/step_limit.h"
#include "random_body.h"
#include "trap.h"
#include "solve/explicit.h"

// What a case is made of; the fields it doesn't name are 0.
typedef struct scene {
  vsc_active_kind active;
  vsc_volume_kind volume;
  bool sliver, held;
  double damping;         // kPa ms
  double volume_modulus;  // kPa, of the second region; the first has a tenth
  double stiffness;       // of the active fibre, kPa
  double time;            // of the activation, ms
  int passes;             // of coupled masses
} scene;

static const scene scenes[] = {
    {.volume = VSC_VOLUME_ELEMENT, .volume_modulus = 100},
    {.volume = VSC_VOLUME_NODAL, .volume_modulus = 1000},
    {.volume = VSC_VOLUME_ELEMENT, .volume_modulus = 10, .sliver = true},
    {.volume = VSC_VOLUME_NODAL, .volume_modulus = 100, .sliver = true, .held = true},
    {.volume = VSC_VOLUME_NODAL, .volume_modulus = 100, .damping = 0.5},
    {.volume = VSC_VOLUME_ELEMENT, .volume_modulus = 100, .damping = 20, .held = true},
    {.volume = VSC_VOLUME_NODAL, .volume_modulus = 100, .damping = 2, .sliver = true},
    {.active = VSC_ACTIVE_SPRING, .volume_modulus = 6, .stiffness = 400, .time = 2 * RAMP_TIME},
    {.active = VSC_ACTIVE_SPRING,
     .volume_modulus = 60,
     .stiffness = 60,
     .time = 40,
     .damping = 1,
     .sliver = true},
    {.active = VSC_ACTIVE_TENSION, .volume_modulus = 60, .time = 2 * RAMP_TIME},
    {.active = VSC_ACTIVE_TENSION,
     .volume = VSC_VOLUME_ELEMENT,
     .volume_modulus = 6,
     .sliver = true,
     .time = 2 * RAMP_TIME},
    // with coupled masses
    {.volume = VSC_VOLUME_ELEMENT, .volume_modulus = 100, .passes = 2},
    {.volume = VSC_VOLUME_NODAL, .volume_modulus = 100, .damping = 2, .held = true, .passes = 5},
    {.volume = VSC_VOLUME_ELEMENT, .volume_modulus = 10, .sliver = true, .damping = 20, .passes = 3},
    {.active = VSC_ACTIVE_TENSION, .volume_modulus = 60, .time = 2 * RAMP_TIME, .passes = 7},
};
enum { SCENES = sizeof scenes / sizeof scenes[0], LUMPED = SCENES - 4, PASSIVE = 7 };

static double smallest_volume(const vsc_mesh *mesh)
{
  double smallest = INFINITY;
  for (size_t t = 0; t < mesh->element_count; t++)
    smallest = fmin(smallest, vsc_mesh_element_volume(mesh, t));
  return smallest;
}

// Moves a node of a tet towards the opposite face, so that a fiftieth of its height is left, and no
// other tet is worse; takes the first tet of region 2 where that can be done.
static void make_sliver(vsc_mesh *mesh)
{
  const double *region = vsc_arrays_find(&mesh->element_data, "region")->values;
  for (size_t t = 0; t < mesh->element_count; t++) {
    if (region[t] != 2) continue;
    const uint32_t *node = mesh->corners + 4 * t;
    double *top = mesh->nodes + 3 * (size_t)node[0], before[3];
    memcpy(before, top, sizeof before);
    const double wanted = 0.02 * vsc_mesh_element_volume(mesh, t);
    for (int i = 0; i < 3; i++) {
      double centre = 0;
      for (int c = 1; c < 4; c++) centre += mesh->nodes[3 * (size_t)node[c] + (size_t)i] / 3;
      top[i] = 0.02 * before[i] + 0.98 * centre;
    }
    if (smallest_volume(mesh) > 0.99 * wanted) return;
    memcpy(top, before, sizeof before);
  }
  fail_msg("no tet can be made a sliver");
}

static void scene_open(random_body *body, const scene *s)
{
  static const vsc_selector face = {
      .name = "foot", .kind = VSC_SELECT_NODE_ARRAY, .array = "x0", .low = 1, .high = 1};
  static const vsc_support_def support = {.set = "foot", .held = {1, 1, 1}};
  vsc_mesh *mesh = random_block(3, 401);
  if (s->sliver) make_sliver(mesh);
  body_define(body, mesh, random_axes(mesh->element_count, 402), s->active, s->volume);
  for (int m = 0; m < 2; m++) {
    for (int a = 0; a < 3; a++) body->materials[m].damping[a] = m == 0 ? s->damping : 0;
    body->materials[m].volume_modulus = s->volume_modulus * (m == 0 ? 0.1 : 1);
    body->materials[m].stabilization = 2;
  }
  body->materials[0].active.rest_stretch = 0.5;
  body->materials[0].active.tension = 80;
  body->materials[0].active.stiffness = s->stiffness;
  body->definition.pressure_count = 0;
  memset(body->definition.gravity, 0, sizeof body->definition.gravity);
  body->definition.safety = 1;
  if (s->held) {
    body->definition.sets = (vsc_selector *)&face;
    body->definition.supports = (vsc_support_def *)&support;
    body->definition.set_count = body->definition.support_count = 1;
  }
  body_build(body);
  if (s->passes == 0) return;
  vsc_error error;
  vsc_state_free(body->state);
  if (vsc_coupled_mass_create(body->model, 0.1, &error) != VSC_OK ||
      vsc_coupled_mass_set_degree(body->model, s->passes, &error) != VSC_OK ||
      vsc_state_create(body->model, &body->state, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

// Columns of M^-1/2 D M^-1/2 with D = dF/dx (or dF/dw): minus differences of the force at x moved
// by
// +-h. Directions that are held stay 0.
static void add_matrix(random_body *body, const double *x, bool rates, double time, double factor,
                       gsl_matrix *sum)
{
  const vsc_model *model = body->model;
  const size_t count = 4 * model->node_count;
  const double h = rates ? 1 : 1e-5;
  double *at = numbers(count), *w = numbers(count), *force[2] = {numbers(count), numbers(count)};
  for (size_t j = 0; j < count; j++) {
    for (int side = 0; side < 2; side++) {
      memcpy(at, x, count * sizeof *at);
      memset(w, 0, count * sizeof *w);
      (rates ? w : at)[j] += side ? -h : h;
      vsc_force(model, at, w, time, &body->state->scratch, force[side]);
    }
    for (size_t i = 0; i < count; i++) {
      const double scale = sqrt(model->inverse_mass[i] * model->inverse_mass[j]);
      double *entry = gsl_matrix_ptr(sum, i, j);
      *entry += factor * scale * (force[1][i] - force[0][i]) / (2 * h);
    }
  }
  vsc_free(at);
  vsc_free(w);
  vsc_free(force[0]);
  vsc_free(force[1]);
}

static double largest_eigenvalue(const gsl_matrix *stiffness, const gsl_matrix *damping,
                                 double factor)
{
  const size_t count = stiffness->size1;
  gsl_matrix *A = gsl_matrix_alloc(count, count);
  gsl_vector *values = gsl_vector_alloc(count);
  gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(count);
  for (size_t i = 0; i < count; i++)
    for (size_t j = 0; j < count; j++) {
      const double k = gsl_matrix_get(stiffness, i, j) + gsl_matrix_get(stiffness, j, i);
      const double c = gsl_matrix_get(damping, i, j) + gsl_matrix_get(damping, j, i);
      gsl_matrix_set(A, i, j, 0.5 * (k + factor * c));
    }
  gsl_eigen_symm(A, values, work);
  const double largest = gsl_vector_max(values);
  gsl_eigen_symm_free(work);
  gsl_vector_free(values);
  gsl_matrix_free(A);
  return largest;
}

// R with R R^T = M^1/2 P M^-1/2 of coupled masses.
static gsl_matrix *root_of_spread(random_body *body)
{
  const vsc_model *model = body->model;
  const size_t count = 4 * model->node_count;
  gsl_matrix *root = gsl_matrix_alloc(count, count);
  double *a = numbers(count);
  for (size_t j = 0; j < count; j++) {
    memset(a, 0, count * sizeof *a);
    a[j] = 1 / sqrt(model->mass[j / 4]);
    const double *spread = vsc_coupled_mass_spread(model, &body->state->scratch, a);
    for (size_t i = 0; i < count; i++) gsl_matrix_set(root, i, j, sqrt(model->mass[i / 4]) * spread[i]);
  }
  gsl_linalg_cholesky_decomp1(root);
  for (size_t i = 0; i < count; i++)
    for (size_t j = i + 1; j < count; j++) gsl_matrix_set(root, i, j, 0);
  vsc_free(a);
  return root;
}

// D <- R^T D R: M^-1 D P has the eigenvalues of that.
static void couple(const gsl_matrix *root, gsl_matrix *D)
{
  gsl_blas_dtrmm(CblasRight, CblasLower, CblasNoTrans, CblasNonUnit, 1, root, D);
  gsl_blas_dtrmm(CblasLeft, CblasLower, CblasTrans, CblasNonUnit, 1, root, D);
}

// The system at the state's positions.
typedef struct dense {
  gsl_matrix *stiffness, *damping;
} dense;

static dense dense_of(random_body *body, double time)
{
  const size_t count = 4 * body->model->node_count;
  const dense d = {gsl_matrix_calloc(count, count), gsl_matrix_calloc(count, count)};
  add_matrix(body, body->state->x, false, time, 1, d.stiffness);
  if (body->model->terms.damping) add_matrix(body, body->state->x, true, time, 1, d.damping);
  if (body->model->coupled.degree == 0) return d;
  gsl_matrix *root = root_of_spread(body);
  couple(root, d.stiffness);
  couple(root, d.damping);
  gsl_matrix_free(root);
  return d;
}

static void dense_free(dense d)
{
  gsl_matrix_free(d.stiffness);
  gsl_matrix_free(d.damping);
}

static double true_eigenvalue(dense d, double dt)
{
  return largest_eigenvalue(d.stiffness, d.damping, dt > 0 ? 2 / dt : 0);
}

// The dt with dt^2 lambda(dt) = 4; with damping by bisection.
static double true_limit(const random_body *body, dense d)
{
  if (!body->model->terms.damping) return 2 / sqrt(true_eigenvalue(d, 0));
  double low = 1e-4, high = 2 / sqrt(true_eigenvalue(d, 0));
  for (int k = 0; k < 20; k++) {
    const double middle = sqrt(low * high);
    if (middle * middle * true_eigenvalue(d, middle) < 4)
      low = middle;
    else
      high = middle;
  }
  return low;
}

// A moment in the middle of a motion: deformed, so that stresses stiffen it too.
static void deform_state(random_body *body, double noise)
{
  double *x = deformed(body->mesh, noise, noise / 4, 403);
  to_model(body->model, x, body->state->x);
  for (size_t i = 0; i < 4 * body->model->node_count; i++)
    if (body->model->inverse_mass[i] == 0) body->state->x[i] = body->model->rest[i];
  vsc_free(x);
}

// An estimate from 40 iterations: from below, and not by more than the 10 % that the step allows
// for; so the step is stable, and not below 0.9 of the stable one (1/1.1 where damping rules,
// 1/sqrt 1.1 else).
static void the_estimate_is_the_largest_eigenvalue(void **state)
{
  (void)state;
  for (int s = 0; s < SCENES; s++)
    for (int strained = 0; strained < 2; strained++) {
      random_body body;
      scene_open(&body, &scenes[s]);
      if (strained) deform_state(&body, 0.2);
      vsc_limit_refresh(body.model, body.state, scenes[s].time, 40);
      const vsc_limit *limit = &body.state->limit;
      const dense d = dense_of(&body, scenes[s].time);
      const double truth = true_eigenvalue(d, limit->step);
      // 1e-4: the damping's part is that of the step before, and differences are good to 1e-6
      assert_true(limit->eigenvalue <= truth * (1 + 1e-4));
      assert_true(1.1 * limit->eigenvalue >= truth);
      assert_close(limit->step, 2 / sqrt(1.1 * limit->eigenvalue), 1e-14, 0);
      const double stable = true_limit(&body, d);
      assert_true(limit->step <= stable && limit->step >= 0.9 * stable);
      dense_free(d);
      body_close(&body);
    }
}

// Four more iterations follow a system whose stiffest place changes: at first the passive tissue,
// then the muscle, element by element as they become active, eight times as stiff in the end.
static void a_warm_estimate_follows_the_activation(void **state)
{
  (void)state;
  random_body body;
  scene_open(&body, &scenes[7]);
  vsc_limit_refresh(body.model, body.state, 0, 40);
  const double first = body.state->limit.eigenvalue;
  for (double time = 5; time <= 150; time += 5) {
    vsc_limit_refresh(body.model, body.state, time, 4);
    const dense d = dense_of(&body, time);
    const double truth = true_eigenvalue(d, 0);
    assert_true(body.state->limit.eigenvalue <= truth * (1 + 1e-4));
    assert_true(1.1 * body.state->limit.eigenvalue >= truth);
    dense_free(d);
  }
  assert_true(body.state->limit.eigenvalue > 5 * first);
  body_close(&body);
}

// A held node does not count: neither in the mode nor in the eigenvalue.
static void held_directions_have_no_mode(void **state)
{
  (void)state;
  random_body body;
  scene_open(&body, &scenes[3]);
  vsc_limit_refresh(body.model, body.state, 0, 10);
  for (size_t i = 0; i < 4 * body.model->node_count; i++)
    assert_true((body.model->inverse_mass[i] > 0) == (body.state->limit.mode[i] != 0));
  body_close(&body);
}

static double largest_displacement(const random_body *body)
{
  double most = 0;
  for (size_t i = 0; i < 4 * body->model->node_count; i++) {
    const double moved = fabs(body->state->x[i] - body->model->rest[i]);
    if (isnan(moved)) return INFINITY;
    most = fmax(most, moved);
  }
  return most;
}

// A tiny shake at rest, then `count` steps of `dt`.
static void shake_and_step(random_body *body, double dt, size_t count)
{
  const vsc_model *model = body->model;
  uint64_t seed = 404;
  for (size_t i = 0; i < 4 * model->node_count; i++)
    body->state->v[i] = model->inverse_mass[i] > 0 ? random_between(&seed, -1e-8, 1e-8) : 0;
  vsc_steps(model, body->state, dt, (double)count, NULL);
}

// Passive scenes at rest. Above the limit the fastest mode grows: with (omega dt)^2 = 4.84 by 2.43
// a step, with pure damping (c dt = 1.1) by 1.135; below it nothing does: 1e-8 mm/ms make some 1e-7
// mm.
static void stepping_is_stable_below_and_unstable_above(void **state)
{
  (void)state;
  for (int s = 0; s < SCENES; s++) {
    random_body body;
    if (s == PASSIVE) s = LUMPED;
    if (scenes[s].active != VSC_ACTIVE_NONE) continue;
    scene_open(&body, &scenes[s]);
    vsc_limit_refresh(body.model, body.state, 0, 40);
    const dense d = dense_of(&body, 0);
    const double stable = true_limit(&body, d);
    shake_and_step(&body, 0.98 * body.state->limit.step, 10000);
    assert_true(largest_displacement(&body) < 1e-5);
    shake_and_step(&body, 0.98 * stable, 10000);
    assert_true(largest_displacement(&body) < 1e-5);
    trap_off();
    shake_and_step(&body, 1.1 * stable, 300);
    trap_on();
    assert_true(largest_displacement(&body) > 1e-2);
    dense_free(d);
    body_close(&body);
  }
}

// The bound without iteration holds at rest, without damping, for every scene; numerics.md measured
// factors of 2.7 to 13 above the truth.
static void the_bound_is_a_bound(void **state)
{
  (void)state;
  for (int s = 0; s < LUMPED; s++) {
    random_body body;
    size_t slot = SIZE_MAX;
    scene_open(&body, &scenes[s]);
    dense d = dense_of(&body, scenes[s].time);
    const double bound = vsc_limit_bound(body.model, &body.state->scratch, &slot);
    const double truth = true_eigenvalue(d, 0);
    assert_true(slot < VSC_WIDTH * body.model->pack_count &&
                body.model->mesh_element[slot] != VSC_NO_ELEMENT);
    assert_true(bound >= truth && bound < 13 * truth);
    dense_free(d);
    body_close(&body);
  }
}

// Two tets (0, x, y, z) and (0, y, x, -z) of unit edges: V = 1/6, |B_i|^2 = 3 at the origin,
// else 1. With k the K + A of each tet: D_0 = 3V (k_1 + k_2), D_x = D_y = V (k_1 + k_2), D_z = V k;
// masses rho V/2 of the three shared nodes and rho V/4: the bound is (10 (k_1 + k_2) + 4 k)/rho of
// the stiffer.
static double bound_of_two(const vsc_material_def materials[2], vsc_volume_kind volume)
{
  static const double nodes[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1};
  static const uint32_t tets[8] = {0, 1, 2, 3, 0, 2, 1, 4};
  vsc_mesh *mesh;
  vsc_error error;
  random_body body;
  size_t slot = SIZE_MAX;
  if (vsc_mesh_from_arrays(5, nodes, 2, tets, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_array *region = vsc_arrays_add(&mesh->element_data, "region", 1, 2);
  region->values[0] = 1;
  region->values[1] = 2;
  vsc_axes *axes = vsc_axes_create(2);
  axes->known[0] = axes->known[1] = 1;
  body_define(&body, mesh, axes, materials[0].active.kind, volume);
  memcpy(body.materials, materials, sizeof body.materials);
  body.definition.pressure_count = 0;
  body_build(&body);
  const double bound = vsc_limit_bound(body.model, &body.state->scratch, &slot);
  dense d = dense_of(&body, 2 * RAMP_TIME);
  assert_true(true_eigenvalue(d, 0) <= bound);
  assert_int_equal(body.model->mesh_element[slot], 1);
  dense_free(d);
  body_close(&body);
  return bound;
}

static double expected_bound(double first, double second)
{
  return (10 * (first + second) + 4 * second) / 1.06;
}

static void the_bound_by_hand(void **state)
{
  (void)state;
  vsc_material_def materials[2];
  define_materials(materials, VSC_ACTIVE_NONE);
  // muscle: E = 9, 6, 4, G = 3, 2, 5: A = max(9, 10), K = 50, Ks = 4;
  // scar: E = 19, 16, 14, G = 5, 4, 7: A = 19, K = 150, Ks = 5
  assert_close(bound_of_two(materials, VSC_VOLUME_ELEMENT), expected_bound(60, 169), 1e-13, 0);
  // nodes: 2/(1/50 + 1/150) = 75 for the shared three, own for the fourth: (225 + 50)/4, (225 + 150)/4
  assert_close(bound_of_two(materials, VSC_VOLUME_NODAL),
               expected_bound(10 + 68.75 + 4, 19 + 93.75 + 5), 1e-13, 0);
  define_materials(materials, VSC_ACTIVE_TENSION);
  materials[0].active.amplitude_array[0] = materials[0].active.delay_array[0] = '\0';
  // a tension of 25 stands on everything
  assert_close(bound_of_two(materials, VSC_VOLUME_ELEMENT), expected_bound(85, 169), 1e-13, 0);
  materials[0].active.kind = VSC_ACTIVE_SPRING;
  materials[0].active.rest_stretch = 0.5;
  materials[0].angular[0] = 30;
  // E_f = 60 pulls with 30 beside 2 G = 60
  assert_close(bound_of_two(materials, VSC_VOLUME_ELEMENT), expected_bound(140, 169), 1e-13, 0);
}

// The element that limits the step is a sliver, or touches one.
static void the_bound_points_at_the_sliver(void **state)
{
  (void)state;
  random_body body;
  size_t slot;
  scene_open(&body, &scenes[2]);
  vsc_limit_bound(body.model, &body.state->scratch, &slot);
  size_t worst = 0;
  for (size_t t = 0; t < body.mesh->element_count; t++)
    if (vsc_mesh_element_volume(body.mesh, t) < vsc_mesh_element_volume(body.mesh, worst)) worst = t;
  int common = 0;
  for (int i = 0; i < 16; i++)
    common += body.mesh->corners[4 * worst + (size_t)i % 4] ==
              body.mesh->corners[4 * body.model->mesh_element[slot] + (size_t)i / 4];
  assert_true(common >= 3);
  body_close(&body);
}

int main(void)
{
  vsc_parallel_set_threads(1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_estimate_is_the_largest_eigenvalue),
      cmocka_unit_test(a_warm_estimate_follows_the_activation),
      cmocka_unit_test(held_directions_have_no_mode),
      cmocka_unit_test(stepping_is_stable_below_and_unstable_above),
      cmocka_unit_test(the_bound_is_a_bound),
      cmocka_unit_test(the_bound_by_hand),
      cmocka_unit_test(the_bound_points_at_the_sliver),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
