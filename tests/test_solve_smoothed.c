// SPDX-License-Identifier: GPL-3.0-or-later
// Edge-smoothed tets: the axes of an edge, equilibrium of a bending bar, and what is refused.
#include "mech/observe.h"
#include "mesh/quadratic.h"
#include "small_body.h"
#include "solve/solve.h"

// One edge of two tets of equal volume whose fibres are an angle apart: half way between.
static void a_shared_edge_has_the_axis_half_way(void **state)
{
  (void)state;
  static const double nodes[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -1};
  static const uint32_t tets[8] = {0, 1, 2, 3, 0, 2, 1, 4};
  small_body body;
  vsc_error error;
  vsc_mesh *mesh;
  assert_int_equal(vsc_mesh_from_arrays(5, nodes, 2, tets, &mesh, &error), VSC_OK);
  body_open(&body, mesh, 50);
  const double flat[3] = {1, 0, 0};
  body_fibers(&body, flat);
  const double angle = 0.7, turned[3] = {-cos(angle), -sin(angle), 0}, up[3] = {0, 0, 1};
  vsc_axes_complete(flat, up, body.axes->frames);
  vsc_axes_complete(turned, up, body.axes->frames + 9);
  body.definition.tets = VSC_TETS_SMOOTHED;
  body_build(&body);
  const vsc_smoothing *edges = &body.model->smoothing;
  assert_int_equal(edges->edge_count, 9);
  int shared = 0;
  for (size_t e = 0; e < VSC_WIDTH * edges->pack_count; e++) {
    if (edges->frames[e / VSC_WIDTH].V[e % VSC_WIDTH] == 0 || edges->start[e + 1] - edges->start[e] != 2)
      continue;
    double f[3], s[3];
    for (int i = 0; i < 3; i++) {
      f[i] = edges->frames[e / VSC_WIDTH].axes[0][i][e % VSC_WIDTH];
      s[i] = edges->frames[e / VSC_WIDTH].axes[1][i][e % VSC_WIDTH];
    }
    assert_close(fabs(f[0] * cos(angle / 2) + f[1] * sin(angle / 2)), 1, 0, 1e-14);
    assert_close(fabs(s[2]), 1, 0, 1e-14);
    shared++;
  }
  assert_int_equal(shared, 3);
  body_close(&body);
}

// A bar of 10 x 1 x 1 mm held at one end sinks under its weight.
static double sinking(vsc_mesh *mesh, vsc_tets_kind tets, vsc_linear_kind linear)
{
  small_body body;
  vsc_error error;
  double sunk = 0;
  body_open(&body, mesh, 1000);
  body_hold(&body, "x0", 1, 1, 1);
  body.material.stabilization = 10;
  body.definition.volume = VSC_VOLUME_NODAL;
  body.definition.tets = tets;
  body.definition.gravity[2] = -0.01;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body.definition.solve.linear = linear;
  body.definition.solve.tolerance = 1e-9;
  body_build(&body);
  if (vsc_solve_start(body.model, body.state, &error) != VSC_OK ||
      vsc_solve_to(body.model, body.state, 1, &error) != VSC_OK)
    fail_msg("%s", error.text);
  for (size_t n = 0; n < body.model->node_count; n++)
    sunk = fmax(sunk, body.model->rest[4 * n + 2] - body.state->x[4 * n + 2]);
  body_close(&body);
  return sunk;
}

// Of what two layers of plain tets, their volumes averaged, lack of four layers of smoothed ones, two layers
// of smoothed ones lack less than two thirds.
static void smoothed_tets_bend_more_easily(void **state)
{
  (void)state;
  const double plain = sinking(block_of(20, 2, 2, 0.5, 0.1), VSC_TETS_PLAIN, VSC_LINEAR_AUTO);
  const double smoothed = sinking(block_of(20, 2, 2, 0.5, 0.1), VSC_TETS_SMOOTHED, VSC_LINEAR_AUTO);
  const double fine = sinking(block_of(40, 4, 4, 0.25, 0.1), VSC_TETS_SMOOTHED, VSC_LINEAR_AUTO);
  assert_true(smoothed < fine && fine - smoothed < 0.65 * (fine - plain));
}

// Diagonal blocks or a factor: the same equilibrium, to the tolerance.
static void smoothed_equilibrium_does_not_depend_on_the_linear_solver(void **state)
{
  (void)state;
  double sunk[2];
  for (int way = 0; way < 2; way++)
    sunk[way] = sinking(block_of(6, 2, 2, 0.5, 0.1), VSC_TETS_SMOOTHED,
                        way ? VSC_LINEAR_ITERATIVE : VSC_LINEAR_DIRECT);
  assert_true(sunk[0] > 0);
  // residuals of 1e-9 leave some 1e-7 of a soft bar's way
  assert_close(sunk[1], sunk[0], 1e-6, 0);
}

// Explicit steps of a bar that falls into vibration, without any damping: what it loses in height is motion
// and strain. (Under the address sanitizer: nothing is kept for rates that nobody asks for.)
static void smoothed_tets_without_damping_keep_their_energy(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  vsc_totals start, end;
  vsc_ledger *ledger;
  body_open(&body, block_of(6, 2, 2, 0.5, 0.1), 50);
  body_hold(&body, "x0", 1, 1, 1);
  body.definition.tets = VSC_TETS_SMOOTHED;
  body.definition.gravity[2] = -0.01;
  body_build(&body);
  assert_int_equal(vsc_ledger_create(body.model, &ledger, &error), VSC_OK);
  if (vsc_solve_start(body.model, body.state, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_observe(body.model, body.state, ledger, false, &start);
  if (vsc_solve_to(body.model, body.state, 20, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_observe(body.model, body.state, ledger, false, &end);
  assert_true(end.kinetic > 0 && end.gravity_energy < 0);
  // the energy of a Stoermer-Verlet step waves by some 1e-3 of what is exchanged
  const double sum = end.kinetic + end.axial + end.angular + end.volume_energy + end.gravity_energy;
  assert_close(sum, 0, 0, 5e-3 * fabs(end.gravity_energy));
  vsc_ledger_free(ledger);
  body_close(&body);
}

static void what_cannot_be_smoothed_is_refused(void **state)
{
  (void)state;
  for (int way = 0; way < 3; way++) {
    small_body body;
    vsc_error error;
    vsc_inclusion_def inclusion = {.material = "other", .fraction_array = "part"};
    body_open(&body, block_of(2, 2, 2, 1, 0), 20);
    body.definition.tets = VSC_TETS_SMOOTHED;
    if (way < 2) body.material.law = way == 0 ? VSC_LAW_PAPER : VSC_LAW_CLASSICAL;
    body.material.classical.stiffness = 1;
    if (way == 2) {
      body.material.inclusion_count = 1;
      body.material.inclusions = &inclusion;
    }
    assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &body.model, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, way < 2 ? "materials[0].law" : "materials[0].inclusions"));
    assert_non_null(strstr(error.text, "tets: plain"));
    body_close(&body);
  }
}

// Quadratic tets alone leave nothing to smooth.
static void a_mesh_without_linear_tets_is_refused(void **state)
{
  (void)state;
  small_body body;
  vsc_error error;
  vsc_mesh *mesh = block_of(2, 2, 2, 1, 0);
  assert_int_equal(vsc_mesh_raise(&mesh, "block", NULL), VSC_OK);
  body_open(&body, mesh, 20);
  body.definition.tets = VSC_TETS_SMOOTHED;
  assert_int_equal(vsc_model_build(body.mesh, NULL, &body.definition, &body.model, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "tets: smoothed smooths linear tetrahedra, and the mesh has none"));
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_shared_edge_has_the_axis_half_way),
      cmocka_unit_test(smoothed_tets_bend_more_easily),
      cmocka_unit_test(smoothed_equilibrium_does_not_depend_on_the_linear_solver),
      cmocka_unit_test(smoothed_tets_without_damping_keep_their_energy),
      cmocka_unit_test(what_cannot_be_smoothed_is_refused),
      cmocka_unit_test(a_mesh_without_linear_tets_is_refused),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
