// SPDX-License-Identifier: GPL-3.0-or-later
// Stress that relaxes: closed forms, order in time, energy, bits.
#include "kinds_body.h"
#include "mech/prony.h"
#include "solve/explicit.h"

static const vsc_prony_def branches[2] = {{0.3, 4}, {0.25, 30}};

// Springs or a neo-Hookean law with two branches; no damping.
static vsc_material_def relaxing(vsc_law law, vsc_prony_def *prony)
{
  vsc_material_def material = springs_material(NULL, NULL);
  memset(material.damping, 0, sizeof material.damping);
  material.law = law;
  material.shear = 8;
  memcpy(prony, branches, sizeof branches);
  material.prony = prony;
  material.prony_count = 2;
  return material;
}

// A block whose fibres lie along x.
static void open_block(random_body *body, const vsc_material_def *material)
{
  vsc_mesh *mesh = mesh_of(ALL_KINDS, 2, 3);
  *body = (random_body){.mesh = mesh, .axes = vsc_axes_create(mesh->element_count)};
  body->materials[0] = *material;
  body->definition = vsc_default_definition();
  body->definition.end_time = 1000;
  body->definition.material_count = 1;
  body->definition.materials = body->materials;
  body_build(body);
}

static void stretch_to(random_body *body, double l)
{
  for (size_t n = 0; n < body->model->node_count; n++)
    body->state->x[4 * n] = l * body->model->rest[4 * n];
}

// All elements' stress along x.
static void check_stress(random_body *body, double expected, double allowed)
{
  double *stress = numbers(6 * body->mesh->element_count);
  vsc_read_field(body->model, body->state, VSC_FIELD_STRESS, stress);
  for (size_t e = 0; e < body->mesh->element_count; e++)
    assert_close(stress[6 * e], expected, 0, allowed);
  vsc_free(stress);
}

// sigma - U'(J) along x of a stretch l, not relaxed.
static double instantaneous(vsc_law law, double l)
{
  return law == VSC_LAW_SPRINGS ? 9 * (l - 1) : 8 * (l * l - 1) / l;
}

// Stretched within one step and held: the part g_i has relaxed by the mean of e^(-t/tau_i) over the
// step, and goes on by e^(-t/tau_i).
static void held_stretch_relaxes(void **state)
{
  (void)state;
  static const vsc_law laws[2] = {VSC_LAW_SPRINGS, VSC_LAW_NEO_HOOKEAN};
  const double l = 1.25, dt = 0.5, volume = 32 * (l - 1 / l);
  for (int k = 0; k < 2; k++) {
    vsc_prony_def prony[2];
    random_body body;
    const vsc_material_def material = relaxing(laws[k], prony);
    open_block(&body, &material);
    // nothing relaxes at rest
    vsc_prony_step(body.model, body.state, dt);
    check_stress(&body, 0, 1e-12);
    stretch_to(&body, l);
    for (int step = 0; step < 80; step++) {
      double part = 1;
      for (int i = 0; i < 2; i++) {
        const double x = dt / branches[i].time;
        part -= branches[i].modulus * (1 - (1 - exp(-x)) / x * exp(-step * x));
      }
      vsc_prony_step(body.model, body.state, dt);
      // rounding of strains through K
      check_stress(&body, part * instantaneous(laws[k], l) + volume, 1e-12);
    }
    body_close(&body);
  }
}

// S_0 = E a sin(w t) along x:
//   h = g E a w [cos(w t)/tau + w sin(w t) - e^(-t/tau)/tau] / (1/tau^2 + w^2)
static void order_two_in_time(void **state)
{
  (void)state;
  enum { HALVINGS = 4 };
  const double E = 9, a = 0.2, w = 0.3, end = 8;
  double S = E * a * sin(w * end), error[HALVINGS];
  const double l = 1 / (1 - a * sin(w * end));
  for (int i = 0; i < 2; i++) {
    const double g = branches[i].modulus, rate = 1 / branches[i].time;
    S += g * E * a * w * (rate * cos(w * end) + w * sin(w * end) - rate * exp(-rate * end)) /
             (rate * rate + w * w) -
         g * E * a * sin(w * end);
  }
  for (int k = 0; k < HALVINGS; k++) {
    vsc_prony_def prony[2];
    random_body body;
    const vsc_material_def material = relaxing(VSC_LAW_SPRINGS, prony);
    open_block(&body, &material);
    const int steps = 8 << k;
    for (int n = 1; n <= steps; n++) {
      stretch_to(&body, 1 / (1 - a * sin(w * end * n / steps)));
      vsc_prony_step(body.model, body.state, end / steps);
    }
    double *stress = numbers(6 * body.mesh->element_count);
    vsc_read_field(body.model, body.state, VSC_FIELD_STRESS, stress);
    error[k] = fabs(stress[0] - (l * S + 32 * (l - 1 / l)));
    vsc_free(stress);
    body_close(&body);
  }
  for (int k = 0; k + 1 < HALVINGS; k++) assert_close(log2(error[k] / error[k + 1]), 2, 0, 0.05);
}

// A body let go and stepped explicitly: what it loses is what has relaxed, to the order of the steps,
// and its momentum stays.
static void vibrations_fade(void **state)
{
  (void)state;
  double balance[2];
  for (int k = 0; k < 2; k++) {
    vsc_prony_def prony[2];
    random_body body;
    vsc_error error;
    vsc_totals first, last;
    const vsc_material_def material = relaxing(VSC_LAW_NEO_HOOKEAN, prony);
    open_block(&body, &material);
    double *w = random_array(4 * body.model->node_count, 0.1, 7);
    for (size_t n = 0; n < body.model->node_count; n++)
      for (size_t i = 0; i < 3; i++) body.state->v[4 * n + i] = w[4 * n + i];
    assert_int_equal(vsc_start(body.model, body.state, &error), VSC_OK);
    vsc_observe(body.model, body.state, body.ledger, false, &first);
    const int steps = 1000 << k;
    assert_int_equal(vsc_steps(body.model, body.state, 4.0 / steps, steps, &error), VSC_OK);
    vsc_observe(body.model, body.state, body.ledger, false, &last);
    balance[k] = vsc_balance_error(body.ledger, &last);
    assert_true(last.prony_work > 0.02 * first.kinetic);
    // a step of 4 us of vibrations of some 100 us
    assert_true(fabs(balance[k]) < 1e-3 * first.kinetic);
    for (int i = 0; i < 3; i++) assert_close(last.momentum[i], first.momentum[i], 0, 1e-13);
    vsc_free(w);
    body_close(&body);
  }
  assert_true(fabs(balance[1]) < 0.35 * fabs(balance[0]));
}

// The own material's share of an element with inclusions relaxes, the rest does not.
static void inclusions_do_not_relax(void **state)
{
  (void)state;
  const double l = 1.25, dt = 0.5, phi = 0.4;
  vsc_prony_def prony[2];
  vsc_inclusion_def inclusion = {.material = "vein", .fraction_array = "part"};
  random_body body = {.mesh = mesh_of(ALL_KINDS, 2, 3)};
  body.axes = vsc_axes_create(body.mesh->element_count);
  vsc_array *part = vsc_arrays_add(&body.mesh->element_data, "part", 1, body.mesh->element_count);
  for (size_t e = 0; e < body.mesh->element_count; e++) part->values[e] = phi;
  body.materials[0] = relaxing(VSC_LAW_SPRINGS, prony);
  body.materials[0].inclusions = &inclusion;
  body.materials[0].inclusion_count = 1;
  body.materials[1] = springs_material(NULL, NULL);
  memset(body.materials[1].damping, 0, sizeof body.materials[1].damping);
  body.materials[1].axial[0] = 50;
  vsc_copy_name(body.materials[1].name, "vein");
  body.definition = vsc_default_definition();
  body.definition.end_time = 1000;
  body.definition.material_count = 2;
  body.definition.materials = body.materials;
  body_build(&body);
  stretch_to(&body, l);
  vsc_prony_step(body.model, body.state, dt);
  double kept = 1;
  for (int i = 0; i < 2; i++) {
    const double x = dt / branches[i].time;
    kept -= branches[i].modulus * (1 - (1 - exp(-x)) / x);
  }
  check_stress(&body, ((1 - phi) * kept * 9 + phi * 50) * (l - 1) + 32 * (l - 1 / l), 1e-12);
  body_close(&body);
}

// The same bits on any number of threads; nothing is kept without a series.
static void threads_change_nothing(void **state)
{
  (void)state;
  uint64_t hash[2];
  for (int k = 0; k < 2; k++) {
    vsc_prony_def prony[2];
    random_body body;
    vsc_error error;
    vsc_parallel_set_threads(k == 0 ? 1 : 4);
    const vsc_material_def material = relaxing(VSC_LAW_SPRINGS, prony);
    kinds_open(&body, mesh_of(ALL_KINDS, 4, 5), &material, VSC_VOLUME_NODAL, 6);
    assert_true(vsc_prony_size(body.model) > 0);
    double *w = random_array(4 * body.model->node_count, 0.3, 7);
    for (size_t n = 0; n < body.model->node_count; n++)
      for (size_t i = 0; i < 3; i++) body.state->v[4 * n + i] = w[4 * n + i];
    assert_int_equal(vsc_start(body.model, body.state, &error), VSC_OK);
    assert_int_equal(vsc_steps(body.model, body.state, 0.004, 20, &error), VSC_OK);
    hash[k] = vsc_state_hash(body.model, body.state);
    vsc_free(w);
    body_close(&body);
  }
  vsc_parallel_set_threads(0);
  assert_true(hash[0] == hash[1]);
  random_body plain;
  const vsc_material_def material = springs_material(NULL, NULL);
  kinds_open(&plain, mesh_of(ALL_KINDS, 2, 5), &material, VSC_VOLUME_NODAL, 6);
  assert_int_equal(vsc_prony_size(plain.model), 0);
  body_close(&plain);
}

static void series_that_are_none(void **state)
{
  (void)state;
  static const struct {
    vsc_prony_def first, second;
    vsc_law law;
    vsc_solve_kind solve;
    vsc_tets_kind tets;
    const char *said;
  } cases[] = {
      {{0.5, 10}, {0.5, 20}, VSC_LAW_SPRINGS, VSC_SOLVE_EXPLICIT, VSC_TETS_PLAIN, "below 1"},
      {{-0.1, 10}, {0.5, 20}, VSC_LAW_SPRINGS, VSC_SOLVE_EXPLICIT, VSC_TETS_PLAIN, "prony[0].modulus"},
      {{0.1, 10}, {0.5, 0}, VSC_LAW_SPRINGS, VSC_SOLVE_EXPLICIT, VSC_TETS_PLAIN, "prony[1].time"},
      {{0.1, 10}, {0.5, NAN}, VSC_LAW_SPRINGS, VSC_SOLVE_EXPLICIT, VSC_TETS_PLAIN, "prony[1].time"},
      {{0.1, 10}, {0.5, 20}, VSC_LAW_PAPER, VSC_SOLVE_EXPLICIT, VSC_TETS_PLAIN, "law: paper"},
      {{0.1, 10}, {0.5, 20}, VSC_LAW_SPRINGS, VSC_SOLVE_EXPLICIT, VSC_TETS_SMOOTHED, "tets: plain"},
      {{0.1, 10}, {0.5, 20}, VSC_LAW_SPRINGS, VSC_SOLVE_IMPLICIT, VSC_TETS_SMOOTHED, "tets: plain"},
      {{0.1, 10}, {0.5, 20}, VSC_LAW_SPRINGS, VSC_SOLVE_EQUILIBRIUM, VSC_TETS_SMOOTHED, "tets: plain"},
  };
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    vsc_prony_def prony[2] = {cases[k].first, cases[k].second};
    vsc_material_def material = cases[k].law == VSC_LAW_PAPER ? paper_material()
                                                              : springs_material(NULL, NULL);
    material.prony = prony;
    material.prony_count = 2;
    vsc_definition definition = vsc_default_definition();
    vsc_error error = {0};
    definition.end_time = 1000;
    definition.material_count = 1;
    definition.materials = &material;
    definition.solve.kind = cases[k].solve;
    definition.tets = cases[k].tets;
    assert_int_equal(vsc_definition_check(&definition, &error), VSC_INPUT);
    if (strstr(error.text, cases[k].said) == NULL) fail_msg("%s", error.text);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(held_stretch_relaxes),    cmocka_unit_test(order_two_in_time),
      cmocka_unit_test(vibrations_fade),         cmocka_unit_test(inclusions_do_not_relax),
      cmocka_unit_test(threads_change_nothing),  cmocka_unit_test(series_that_are_none),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
