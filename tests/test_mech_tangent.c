// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent is the derivative of the force, for every kind of element and volume, by positions and by
// velocities; it is the same on any number of threads; and the block matrix multiplies as its full
// counterpart does.
#include "mech/tangent.h"

#include "kinds_body.h"
#include "mech/prony.h"
#include "tissue_laws.h"

#define TIME 60.0  // ms: in the middle of the ramps

// y = A d for d in the model's order, by the tangent assembled at x, w.
static void tangent_product(random_body *body, const double *x, const double *w, double a, double b,
                            const double *d, double *y)
{
  vsc_tangent *tangent;
  vsc_error error;
  const size_t count = 4 * body->model->node_count;
  if (vsc_tangent_create(body->model, &tangent, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_tangent_assemble(body->model, tangent, x, w, NULL, TIME, a, b, &body->state->scratch);
  memset(y, 0, count * sizeof *y);
  vsc_tangent_times(tangent, body->model->inverse_mass, d, y);
  vsc_tangent_free(tangent);
}

// (f(x - h d, w - h e) - f(x + h d, w + h e))/2h
static void difference(random_body *body, const double *x, const double *w, const double *d,
                       const double *e, double h, double *y)
{
  const size_t count = 4 * body->model->node_count;
  double *at = numbers(count), *speed = numbers(count), *force = numbers(count);
  for (int side = 0; side < 2; side++) {
    const double way = side ? -h : h;
    for (size_t i = 0; i < count; i++) {
      at[i] = x[i] + (d ? way * d[i] : 0);
      if (w) speed[i] = w[i] + (e ? way * e[i] : 0);
    }
    vsc_force(body->model, at, w ? speed : NULL, TIME, &body->state->scratch, force);
    for (size_t i = 0; i < count; i++) y[i] = (side ? y[i] : 0) + (side ? 1 : -1) * force[i] / (2 * h);
  }
  for (size_t n = 0; n < count; n += 4) y[n + 3] = 0;
  vsc_free(at);
  vsc_free(speed);
  vsc_free(force);
}

// Differences of steps 2^-10 and 2^-11 mm are extrapolated; what is left of their error is the fourth
// power of the step, some 1e-11 of the derivative of springs and more of exponentials, and rounding by
// 1e-16/h, some 1e-12.
static void check_by_positions(random_body *body, double tolerance)
{
  const size_t count = 4 * body->model->node_count;
  double *bent = deformed(body->mesh, 0.12, 0.05, 5), *x = numbers(count), *d = numbers(count);
  double *y = numbers(count), *coarse = numbers(count), *fine = numbers(count);
  double *random = random_array(3 * body->mesh->node_count, 1, 6);
  to_model(body->model, bent, x);
  to_model(body->model, random, d);
  tangent_product(body, x, NULL, 1, 0, d, y);
  difference(body, x, NULL, d, NULL, ldexp(1, -10), coarse);
  difference(body, x, NULL, d, NULL, ldexp(1, -11), fine);
  const double size = largest_of(y, count);
  for (size_t i = 0; i < count; i++)
    assert_close(y[i], (4 * fine[i] - coarse[i]) / 3, 0, tolerance * size);
  vsc_free(bent);
  vsc_free(random);
  vsc_free(x);
  vsc_free(d);
  vsc_free(y);
  vsc_free(coarse);
  vsc_free(fine);
}

// Forces are linear in velocities, so one difference is exact but for rounding.
static void check_by_velocities(random_body *body)
{
  const size_t count = 4 * body->model->node_count;
  double *bent = deformed(body->mesh, 0.12, 0.05, 5), *x = numbers(count), *d = numbers(count);
  double *w = numbers(count), *y = numbers(count), *expected = numbers(count);
  double *random = random_array(3 * body->mesh->node_count, 1, 6);
  to_model(body->model, bent, x);
  to_model(body->model, random, d);
  tangent_product(body, x, w, 0, 1, d, y);
  difference(body, x, w, NULL, d, 1, expected);
  const double size = largest_of(y, count);
  assert_true(size > 0);
  for (size_t i = 0; i < count; i++) assert_close(y[i], expected[i], 0, 1e-12 * size);
  vsc_free(bent);
  vsc_free(random);
  vsc_free(x);
  vsc_free(d);
  vsc_free(w);
  vsc_free(y);
  vsc_free(expected);
}

static void tangents_are_derivatives_for_every_kind(void **state)
{
  (void)state;
  static vsc_axis_def axes[2];
  static vsc_pair_def pairs[2];
  const vsc_material_def material = springs_material(axes, pairs);
  for (int mesh = ALL_HEXES; mesh <= ALL_TETS; mesh++)
    for (int way = 0; way < 4; way++) {
      random_body body;
      const vsc_volume_kind volume = way % 2 ? VSC_VOLUME_ELEMENT : VSC_VOLUME_NODAL;
      const vsc_tets_kind tets = way < 2 ? VSC_TETS_PLAIN : VSC_TETS_SMOOTHED;
      if (mesh == ALL_HEXES && tets == VSC_TETS_SMOOTHED) continue;
      kinds_open_tets(&body, mesh_of((kinds_mesh)mesh, 3, 31), &material, volume, tets, 32);
      check_by_positions(&body, 2e-9);
      check_by_velocities(&body);
      body_close(&body);
    }
}

static void tangents_are_derivatives_for_every_law(void **state)
{
  (void)state;
  for (int k = 0; k < TISSUE_LAWS; k++) {
    random_body body;
    vsc_material_def material = tissue_law(k);
    material.viscosity = 0.4;
    // a difference must not step over the kink of the stress
    if (material.compression == VSC_FIBRES_SHARP) material.compression = VSC_FIBRES_ALWAYS;
    kinds_open(&body, mesh_of(ALL_KINDS, 2, 31), &material, (vsc_volume_kind)(k % 2), 32);
    check_by_positions(&body, 2e-8);
    check_by_velocities(&body);
    body_close(&body);
  }
}

static void tangents_are_derivatives_when_active(void **state)
{
  (void)state;
  for (int way = 0; way < 4; way++) {
    random_body body;
    vsc_mesh *mesh = random_block(3, 41);
    body_define(&body, mesh, random_axes(mesh->element_count, 42),
                way % 2 ? VSC_ACTIVE_SPRING : VSC_ACTIVE_TENSION, VSC_VOLUME_NODAL);
    if (way >= 2) body.definition.tets = VSC_TETS_SMOOTHED;
    body.definition.pressure_count = 0;
    body_build(&body);
    check_by_positions(&body, 2e-9);
    check_by_velocities(&body);
    body_close(&body);
  }
}

// Branches that have come over two steps, and make a third, or one in which all relaxes.
static void check_relaxing(random_body *body)
{
  static const double steps[] = {2, 3};  // ms
  for (int k = 0; k < 2; k++) {
    double *x = deformed(body->mesh, 0.1, 0.05, 71 + (uint64_t)k);
    to_model(body->model, x, body->state->x);
    vsc_prony_step(body->model, body->state, steps[k]);
    vsc_free(x);
  }
  body->state->scratch.prony_step = 5;
  check_by_positions(body, 2e-9);
  body->state->scratch.prony_step = INFINITY;
  check_by_positions(body, 2e-9);
}

static void tangents_are_derivatives_where_stress_relaxes(void **state)
{
  (void)state;
  vsc_prony_def prony[2] = {{0.4, 4}, {0.3, 30}};
  static vsc_axis_def axes[2];
  static vsc_pair_def pairs[2];
  for (int mesh = ALL_HEXES; mesh <= ALL_TETS10; mesh++)
    for (int law = 0; law < 2; law++) {
      random_body body;
      vsc_material_def material = springs_material(axes, pairs);
      if (law == 1) material.axis_count = material.pair_count = 0, material.law = VSC_LAW_NEO_HOOKEAN;
      material.shear = 8;
      material.prony = prony;
      material.prony_count = 2;
      kinds_open(&body, mesh_of((kinds_mesh)mesh, 2, 31), &material, VSC_VOLUME_NODAL, 32);
      check_relaxing(&body);
      body_close(&body);
    }
}

// Neither activity nor inclusions relax.
static void tangents_of_muscle_that_relaxes_are_derivatives(void **state)
{
  (void)state;
  vsc_prony_def prony[2] = {{0.4, 4}, {0.3, 30}};
  static const vsc_active_kind kinds[2] = {VSC_ACTIVE_TENSION, VSC_ACTIVE_SPRING};
  for (int k = 0; k < 2; k++) {
    random_body body;
    vsc_mesh *mesh = random_block(3, 41);
    vsc_inclusion_def inclusion = {.material = "scar", .fraction_array = "strength"};
    body_define(&body, mesh, random_axes(mesh->element_count, 42), kinds[k], VSC_VOLUME_NODAL);
    body.definition.pressure_count = 0;
    body.materials[0].prony = prony;
    body.materials[0].prony_count = 2;
    body.materials[0].inclusions = &inclusion;
    body.materials[0].inclusion_count = 1;
    body_build(&body);
    check_relaxing(&body);
    body_close(&body);
  }
}

// A law that is not free of stress at rest by itself, with viscosity, on the edges of smoothed tets.
static void tangents_of_smoothed_tissue_are_derivatives(void **state)
{
  (void)state;
  random_body body;
  vsc_material_def material = vsc_default_material();
  material.law = VSC_LAW_NEO_HOOKEAN;
  material.shear = 7;
  material.viscosity = 0.4;
  material.volume_modulus = 60;
  material.stabilization = 4;
  kinds_open_tets(&body, mesh_of(ALL_TETS, 3, 31), &material, VSC_VOLUME_NODAL, VSC_TETS_SMOOTHED, 32);
  check_by_positions(&body, 2e-9);
  check_by_velocities(&body);
  body_close(&body);
}

// A pressure all round and springs and dashpots on a surface.
static void tangents_have_the_loads_in_them(void **state)
{
  (void)state;
  random_body body;
  vsc_mesh *mesh = random_block(3, 41);
  vsc_robin_def robin = {.surface = "boundary", .stiffness = 30, .damping = 20, .normal = true};
  body_define(&body, mesh, random_axes(mesh->element_count, 42), VSC_ACTIVE_TENSION,
              VSC_VOLUME_NODAL);
  body.pressure.peak = 50;
  body.definition.robin_count = 1;
  body.definition.robins = &robin;
  body_build(&body);
  check_by_positions(&body, 2e-9);
  check_by_velocities(&body);
  body_close(&body);
}

static void check_bits_of_threads(vsc_tets_kind tets)
{
  random_body body;
  double *y[2], *d = NULL;
  for (int k = 0; k < 2; k++) {
    vsc_parallel_set_threads(k == 0 ? 1 : 3);
    vsc_mesh *mesh = random_block(9, 51);
    body_define(&body, mesh, random_axes(mesh->element_count, 52), VSC_ACTIVE_TENSION,
                VSC_VOLUME_NODAL);
    body.definition.tets = tets;
    body_build(&body);
    assert_true(body.model->patch_count > 3);
    const size_t count = 4 * body.model->node_count;
    double *bent = deformed(body.mesh, 0.1, 0.05, 52), *x = numbers(count);
    to_model(body.model, bent, x);
    if (k == 0) d = random_array(count, 1, 53);
    for (size_t n = 0; n < count; n += 4) d[n + 3] = 0;
    y[k] = numbers(count);
    tangent_product(&body, x, NULL, 1, 0, d, y[k]);
    vsc_free(bent);
    vsc_free(x);
    if (k == 1) assert_memory_equal(y[0], y[1], count * sizeof *d);
    body_close(&body);
  }
  vsc_parallel_set_threads(0);
  vsc_free(y[0]);
  vsc_free(y[1]);
  vsc_free(d);
}

static void tangents_have_the_same_bits_on_any_number_of_threads(void **state)
{
  (void)state;
  check_bits_of_threads(VSC_TETS_PLAIN);
  check_bits_of_threads(VSC_TETS_SMOOTHED);
}

// Groups {0, 1, 3} and {2, 3}: blocks where they join, and a product that a full matrix confirms.
static void block_matrices_multiply(void **state)
{
  (void)state;
  const size_t group[] = {0, 3, 5};
  const uint32_t nodes[] = {3, 0, 1, 2, 3};
  vsc_block_matrix matrix;
  double full[12][12] = {{0}}, K[9], x[16], y[16] = {0};
  uint64_t seed = 61;
  assert_true(vsc_block_matrix_create(4, 2, group, nodes, &matrix));
  const size_t starts[] = {0, 3, 5, 7, 8};
  assert_memory_equal(matrix.start, starts, sizeof starts);
  const uint32_t rows[] = {0, 1, 3, 1, 3, 2, 3, 3};
  assert_memory_equal(matrix.row, rows, sizeof rows);
  for (uint32_t j = 0; j < 4; j++)
    for (size_t k = matrix.start[j]; k < matrix.start[j + 1]; k++) {
      const uint32_t i = matrix.row[k];
      random_fill(&seed, 1, K, 9);
      if (i == j) K[3] = K[1], K[6] = K[2], K[7] = K[5];
      vsc_block_matrix_add(&matrix, i, j, 2, K);
      vsc_block_matrix_add(&matrix, j, i, i == j ? 0 : 100, K);  // the mirror image does not count
      for (int r = 0; r < 3; r++)
        for (int c = 0; c < 3; c++) full[3 * i + r][3 * j + c] = full[3 * j + c][3 * i + r] = 2 * K[3 * r + c];
    }
  random_fill(&seed, 1, x, 16);
  double free_all[16];
  for (int i = 0; i < 16; i++) free_all[i] = i != 5;
  for (int round = 0; round < 2; round++) {
    vsc_block_matrix_times(&matrix, x, y);
    for (int i = 0; i < 12; i++) {
      double sum = 0;
      for (int j = 0; j < 12; j++) sum += full[i][j] * x[4 * (j / 3) + j % 3];
      assert_close(y[4 * (i / 3) + i % 3], sum, 0, 1e-14);  // twelve products of size 2
    }
    // node 1 held in y
    vsc_block_matrix_hold(&matrix, free_all, 7);
    for (int i = 0; i < 12; i++) full[i][4] = full[4][i] = i == 4 ? 7 : 0;
  }
  vsc_block_matrix_free(&matrix);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tangents_are_derivatives_for_every_kind),
      cmocka_unit_test(tangents_are_derivatives_for_every_law),
      cmocka_unit_test(tangents_are_derivatives_when_active),
      cmocka_unit_test(tangents_are_derivatives_where_stress_relaxes),
      cmocka_unit_test(tangents_of_muscle_that_relaxes_are_derivatives),
      cmocka_unit_test(tangents_of_smoothed_tissue_are_derivatives),
      cmocka_unit_test(tangents_have_the_loads_in_them),
      cmocka_unit_test(tangents_have_the_same_bits_on_any_number_of_threads),
      cmocka_unit_test(block_matrices_multiply),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
