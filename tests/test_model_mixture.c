// SPDX-License-Identifier: GPL-3.0-or-later
// Elements with inclusions: moduli mixed by volume.
#include "kinds_body.h"
#include "solve/explicit.h"
#include "trap.h"

// Materials `soft` and `stiff` on one mesh: element array `part` holds the fraction of stiff in soft, which
// contracts by active springs. `general`: with couplings, which the kernel of any law has.
static void open_mixed(random_body *body, vsc_mesh *mesh, vsc_inclusion_def *inclusion, bool general,
                       uint64_t seed)
{
  *body = (random_body){.mesh = mesh, .axes = random_axes(mesh->element_count, seed)};
  for (int m = 0; m < 2; m++) {
    body->materials[m] = springs_material(NULL, NULL);
    vsc_copy_name(body->materials[m].name, m == 0 ? "soft" : "stiff");
    body->materials[m].coupling[1] = general ? 1 + m : 0;
  }
  body->materials[0].active = (vsc_active_def){.kind = VSC_ACTIVE_SPRING, .stiffness = 60, .rest_stretch = 0.8,
                                               .delay_unit = 1, .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  body->materials[0].active.curve.duration = RAMP_TIME;
  for (int a = 0; a < 3; a++) {
    body->materials[1].axial[a] *= 20 + a;
    body->materials[1].angular[a] *= 30 + a;
    body->materials[1].damping[a] *= 4 + a;
  }
  body->materials[1].volume_modulus *= 5;
  *inclusion = (vsc_inclusion_def){.material = "stiff", .fraction_array = "part"};
  body->materials[0].inclusions = inclusion;
  body->materials[0].inclusion_count = 1;
  body->definition = vsc_default_definition();
  body->definition.end_time = RAMP_TIME;
  body->definition.volume = VSC_VOLUME_ELEMENT;
  body->definition.material_count = 2;
  body->definition.materials = body->materials;
}

enum { ALL, EVEN, ODD };

// `which` elements have the fraction, the others 0.
static double *force_with(vsc_mesh *mesh, double fraction, bool general, int which)
{
  random_body body;
  vsc_inclusion_def inclusion;
  open_mixed(&body, mesh, &inclusion, general, 21);
  vsc_array *part = (vsc_array *)vsc_arrays_find(&mesh->element_data, "part");
  for (size_t e = 0; e < mesh->element_count; e++)
    part->values[e] = which == ALL || (e % 2 == 0) == (which == EVEN) ? fraction : 0;
  body_build(&body);
  const size_t count = 3 * mesh->node_count;
  double *x = deformed(mesh, 0.1, 0.05, 22), *w = random_array(count, 1, 23), *f = numbers(count);
  body_force(&body, x, w, 0.7 * RAMP_TIME, f);
  vsc_free(x);
  vsc_free(w);
  body.mesh = NULL;
  body_close(&body);
  return f;
}

// Forces are linear in the moduli, so those of a mixture lie between.
static void forces_are_mixed_by_volume(void **state)
{
  (void)state;
  for (int variant = 0; variant < 4; variant++) {
    const bool general = variant > 1;
    vsc_mesh *mesh = mesh_of(variant % 2 == 0 ? ALL_TETS : ALL_KINDS, 3, 20);
    vsc_arrays_add(&mesh->element_data, "part", 1, mesh->element_count);
    double *soft = force_with(mesh, 0, general, ALL), *stiff = force_with(mesh, 1, general, ALL);
    double *mixed = force_with(mesh, 0.3, general, ALL);
    const size_t count = 3 * mesh->node_count;
    const double most = largest_of(stiff, count);
    assert_true(largest_of(stiff, count) > 5 * largest_of(soft, count));
    for (size_t i = 0; i < count; i++)
      assert_close(mixed[i], 0.7 * soft[i] + 0.3 * stiff[i], 0, 1e-14 * most);
    // what only some elements have, only they show: changes by the halves add up to the whole's
    double *even = force_with(mesh, 0.3, general, EVEN), *odd = force_with(mesh, 0.3, general, ODD);
    for (size_t i = 0; i < count; i++)
      assert_close(even[i] + odd[i], mixed[i] + soft[i], 0, 1e-14 * most);
    assert_true(memcmp(even, soft, count * sizeof *even) != 0);
    assert_true(memcmp(odd, soft, count * sizeof *odd) != 0);
    vsc_free(soft);
    vsc_free(stiff);
    vsc_free(mixed);
    vsc_free(even);
    vsc_free(odd);
    vsc_mesh_free(mesh);
  }
}

// Nodes have the modulus of the elements round them, lanes without an element none: 162 tets leave two such lanes.
static void shared_volumes_are_mixed_too(void **state)
{
  (void)state;
  for (int stiff = 0; stiff < 2; stiff++) {
    random_body body;
    vsc_inclusion_def inclusion;
    vsc_mesh *mesh = mesh_of(ALL_TETS, 3, 20);
    assert_int_equal(mesh->element_count % VSC_WIDTH, 2);
    vsc_array *part = vsc_arrays_add(&mesh->element_data, "part", 1, mesh->element_count);
    for (size_t e = 0; e < mesh->element_count; e++) part->values[e] = stiff;
    open_mixed(&body, mesh, &inclusion, false, 21);
    body.definition.volume = VSC_VOLUME_NODAL;
    body_build(&body);
    for (size_t n = 0; n < body.model->node_count; n++)
      assert_close(body.model->group_modulus[n], body.materials[stiff].volume_modulus, 1e-14, 0);
    body_close(&body);
  }
}

// An inclusion that is all of its elements is the other material, and does not contract.
static void an_inclusion_of_everything_is_the_other_material(void **state)
{
  (void)state;
  for (int general = 0; general < 2; general++) {
    vsc_mesh *mesh = random_block(3, 24);
    vsc_arrays_add(&mesh->element_data, "part", 1, mesh->element_count);
    double *mixed = force_with(mesh, 1, general, ALL);
    random_body body;
    vsc_inclusion_def inclusion;
    open_mixed(&body, mesh, &inclusion, general, 21);
    body.materials[0] = body.materials[1];
    body.definition.material_count = 1;
    body_build(&body);
    const size_t count = 3 * mesh->node_count;
    double *x = deformed(mesh, 0.1, 0.05, 22), *w = random_array(count, 1, 23), *f = numbers(count);
    body_force(&body, x, w, 0, f);
    for (size_t i = 0; i < count; i++) assert_close(mixed[i], f[i], 0, 1e-14 * largest_of(f, count));
    vsc_free(x);
    vsc_free(w);
    vsc_free(f);
    vsc_free(mixed);
    body_close(&body);
  }
}

// The ledger's active work is that of the own part of the fibre: what it is off by is the trapezoidal rule's
// error (100 looks; a fourth of it with 200).
static void the_energy_of_mixed_active_springs_balances(void **state)
{
  (void)state;
  random_body body;
  vsc_inclusion_def inclusion;
  vsc_totals totals;
  vsc_error error;
  vsc_mesh *mesh = random_block(2, 27);
  vsc_array *part = vsc_arrays_add(&mesh->element_data, "part", 1, mesh->element_count);
  for (size_t e = 0; e < mesh->element_count; e++) part->values[e] = 0.1 * (double)(e % 8);
  open_mixed(&body, mesh, &inclusion, false, 28);
  body_build(&body);
  assert_int_equal(vsc_start(body.model, body.state, &error), VSC_OK);
  for (int look = 0; look <= 100; look++) {
    assert_int_equal(vsc_advance(body.model, body.state, 0.1 * look, &error), VSC_OK);
    vsc_observe(body.model, body.state, body.ledger, false, &totals);
  }
  assert_true(body.ledger->active > 0);
  assert_close(vsc_balance_error(body.ledger, &totals), 0, 0, 1e-3 * body.ledger->active);
  body_close(&body);
}

// Masses and weights are mixed by volume: those of 0.3 stiff lie between those of none and all.
static void masses_are_mixed_by_volume(void **state)
{
  (void)state;
  for (int kind = 0; kind < 3; kind++) {
    vsc_mesh *mesh = mesh_of((kinds_mesh[]){ALL_TETS, ALL_KINDS, ALL_TETS10}[kind], 2, 20);
    const double fractions[3] = {0, 1, 0.3};
    double *weights[3];
    vsc_array *part = vsc_arrays_add(&mesh->element_data, "part", 1, mesh->element_count);
    for (int f = 0; f < 3; f++) {
      random_body body;
      vsc_inclusion_def inclusion;
      open_mixed(&body, mesh, &inclusion, false, 21);
      body.materials[0].density = 1;
      body.materials[1].density = 20;
      body.definition.gravity[2] = -0.01;
      // with int rho N_i g of quadratic tets
      if (kind == 2) body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
      for (size_t e = 0; e < mesh->element_count; e++) part->values[e] = fractions[f];
      body_build(&body);
      weights[f] = numbers(mesh->node_count);
      for (size_t n = 0; n < mesh->node_count; n++)
        weights[f][body.model->mesh_node[n]] = body.model->weight[4 * n + 2];
      double volume = 0;
      for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
      assert_close(body.model->total_mass, volume * (1 + 19 * fractions[f]), 1e-13, 0);
      body.mesh = NULL;
      body_close(&body);
    }
    for (size_t n = 0; n < mesh->node_count; n++)
      assert_close(weights[2][n], 0.7 * weights[0][n] + 0.3 * weights[1][n], 0,
                   1e-14 * largest_of(weights[1], mesh->node_count));
    for (int f = 0; f < 3; f++) vsc_free(weights[f]);
    vsc_mesh_free(mesh);
  }
}

static void expect_refusal(random_body *body, const char *text)
{
  vsc_error error;
  vsc_model *model;
  assert_int_equal(vsc_model_build(body->mesh, body->axes, &body->definition, &model, &error),
                   VSC_INPUT);
  if (strstr(error.text, text) == NULL) fail_msg("\"%s\" lacks \"%s\"", error.text, text);
}

static void bad_inclusions_are_refused(void **state)
{
  (void)state;
  random_body body;
  vsc_inclusion_def inclusion;
  vsc_mesh *mesh = random_block(2, 25);
  open_mixed(&body, mesh, &inclusion, false, 26);
  expect_refusal(&body, "part");
  vsc_array *part = vsc_arrays_add(&mesh->element_data, "part", 1, mesh->element_count);
  part->values[3] = 1.5;
  expect_refusal(&body, "[0, 1]");
  part->values[3] = -0.1;
  expect_refusal(&body, "element 3");
  part->values[3] = NAN;
  trap_off();
  expect_refusal(&body, "element 3");
  trap_on();
  part->values[3] = 0.5;
  body.materials[1].region_count = 1;
  vsc_copy_name(inclusion.material, "stuff");
  expect_refusal(&body, "no other material is called 'stuff'");
  body.materials[1].region_count = 0;
  vsc_copy_name(inclusion.material, "stiff");
  body.materials[1].active = body.materials[0].active;
  expect_refusal(&body, "passive");
  body.materials[1].active.kind = VSC_ACTIVE_NONE;
  body.definition.masses = VSC_MASS_CONSISTENT;
  body.definition.solve.kind = VSC_SOLVE_IMPLICIT;
  body.materials[1].density = 3;
  expect_refusal(&body, "take masses: lumped, or one density");
  body.definition.masses = VSC_MASS_LUMPED;
  body.materials[0].law = VSC_LAW_NEO_HOOKEAN;
  body.materials[0].active.kind = VSC_ACTIVE_NONE;
  body.materials[0].shear = 1;
  expect_refusal(&body, "make up 0.5 of element 3 of material soft, and only springs are mixed by volume");
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(forces_are_mixed_by_volume),
      cmocka_unit_test(shared_volumes_are_mixed_too),
      cmocka_unit_test(an_inclusion_of_everything_is_the_other_material),
      cmocka_unit_test(the_energy_of_mixed_active_springs_balances),
      cmocka_unit_test(masses_are_mixed_by_volume),
      cmocka_unit_test(bad_inclusions_are_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
