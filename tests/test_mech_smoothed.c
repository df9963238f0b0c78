// SPDX-License-Identifier: GPL-3.0-or-later
// Edge-smoothed tets: the edges' frames, their energies, the ledger with activity, the bound of the
// step. Gradients, balances, patch tests and tangents are in test_mech_kinds.c and test_mech_tangent.c.
#include "base/hash.h"
#include "base/parallel.h"
#include "mech/step_limit.h"
#include "random_body.h"
#include "solve/explicit.h"

static void open_smoothed(random_body *body, size_t n, vsc_active_kind active, uint64_t seed)
{
  vsc_mesh *mesh = random_block(n, seed);
  body_define(body, mesh, random_axes(mesh->element_count, seed + 1), active, VSC_VOLUME_NODAL);
  body->definition.tets = VSC_TETS_SMOOTHED;
  body_build(body);
}

// ---- the model

// The edges of each tissue share its volume, each tet has six of them, and each edge's weights sum to 1.
static void edges_share_the_volume_of_their_tissue(void **state)
{
  (void)state;
  random_body body;
  open_smoothed(&body, 4, VSC_ACTIVE_TENSION, 10);
  const vsc_model *model = body.model;
  const vsc_smoothing *edges = &model->smoothing;
  double volume[2] = {0}, sixths = 0;
  size_t full = 0;
  for (size_t b = 0; b < edges->block_count; b++) {
    const vsc_edge_block *block = &edges->blocks[b];
    for (size_t k = block->first_pack; k < block->first_pack + block->pack_count; k++)
      for (int l = 0; l < VSC_WIDTH; l++) {
        const size_t e = VSC_WIDTH * k + (size_t)l;
        double weight = 0;
        for (size_t t = edges->start[e]; t < edges->start[e + 1]; t++) weight += edges->weight[t];
        assert_close(weight, 1, 0, 1e-15 * 40);  // as many tets at most round an edge
        volume[block->material] += edges->frames[k].V[l];
        if (edges->frames[k].V[l] == 0) continue;
        full++;
        sixths += edges->start[e + 1] - edges->start[e];
      }
  }
  assert_int_equal(full, edges->edge_count);
  assert_true(sixths == 6.0 * (double)body.mesh->element_count);
  for (int m = 0; m < 2; m++) assert_close(volume[m], model->materials[m].volume, 1e-13, 0);
  body_close(&body);
}

// Frames are orthonormal; where all tets have one fibre, with either sign, so have the edges; and an
// edge whose fibres are f and f turned by an angle has the axis half way between them.
static void edges_have_the_mean_axes_of_their_tets(void **state)
{
  (void)state;
  random_body body;
  vsc_mesh *mesh = random_block(2, 20);
  body_define(&body, mesh, vsc_axes_create(mesh->element_count), VSC_ACTIVE_NONE, VSC_VOLUME_NODAL);
  const double frame[9] = {0.6, 0.8, 0, -0.8, 0.6, 0, 0, 0, 1};
  for (size_t t = 0; t < mesh->element_count; t++) {
    double *to = body.axes->frames + 9 * t;
    memcpy(to, frame, sizeof frame);
    // the same axes with other signs, right-handed again
    for (int i = 0; t % 2 && i < 6; i++) to[i] = -to[i];
    body.axes->known[t] = 1;
  }
  body.definition.tets = VSC_TETS_SMOOTHED;
  body_build(&body);
  const vsc_smoothing *edges = &body.model->smoothing;
  for (size_t k = 0; k < edges->pack_count; k++)
    for (int l = 0; l < VSC_WIDTH; l++)
      for (int a = 0; a < 3; a++) {
        double dot = 0;
        for (int i = 0; i < 3; i++) dot += edges->frames[k].axes[a][i][l] * frame[3 * a + i];
        assert_close(fabs(dot), 1, 0, 1e-14);
      }
  body_close(&body);
}

// Three tets of a tissue each, one edge of the middle one being the first's, the opposite one the last's: the tissues
// have six edges each, though in the order of nodes the first's last edge is the second's first.
static void tissues_have_edges_of_their_own(void **state)
{
  (void)state;
  static const double nodes[24] = {-1, 0, 1, -1, 1, -1, 0, 0, 0, 0, 1, 0, 1, 0, 1, 1, 1, -1, 3, 0, 0, 3, 1, 0};
  static const uint32_t tets[12] = {0, 1, 2, 3, 2, 3, 4, 5, 4, 5, 6, 7};
  vsc_mesh *mesh = NULL;
  vsc_material_def materials[3];
  random_body body;
  assert_int_equal(vsc_mesh_from_arrays(8, nodes, 3, tets, &mesh, NULL), VSC_OK);
  vsc_array *region = vsc_arrays_add(&mesh->element_data, "region", 1, 3);
  body_define(&body, mesh, NULL, VSC_ACTIVE_NONE, VSC_VOLUME_ELEMENT);
  for (int m = 0; m < 3; m++) {
    region->values[m] = m + 1;
    materials[m] = body.materials[0];
    materials[m].regions[0] = m + 1;
    vsc_copy_name(materials[m].name, (const char *[]){"first", "second", "third"}[m]);
  }
  body.definition.materials = materials;
  body.definition.material_count = 3;
  body.definition.tets = VSC_TETS_SMOOTHED;
  body_build(&body);
  assert_int_equal(body.model->smoothing.edge_count, 18);
  body_close(&body);
}

// Everything of the model's edges, whose frames several threads make.
static void edges_have_the_same_bits_on_any_number_of_threads(void **state)
{
  (void)state;
  uint64_t alone = 0;
  for (int threads = 1; threads <= 3; threads++) {
    random_body body;
    vsc_parallel_set_threads(threads);
    open_smoothed(&body, 8, VSC_ACTIVE_TENSION, 10);
    const vsc_smoothing *edges = &body.model->smoothing;
    const size_t places = VSC_WIDTH * edges->pack_count, entries = edges->start[places];
    assert_true(places > 3000);
    uint64_t hash = vsc_hash(body.model->hash, edges->frames, edges->pack_count * sizeof *edges->frames);
    hash = vsc_hash(hash, edges->start, (places + 1) * sizeof *edges->start);
    hash = vsc_hash(hash, edges->slot, entries * sizeof *edges->slot);
    hash = vsc_hash(hash, edges->weight, entries * sizeof *edges->weight);
    for (size_t e = 0; e < places; e++) assert_true(edges->start[e + 1] > edges->start[e]);
    if (threads == 1) alone = hash;
    assert_true(hash == alone);
    body_close(&body);
  }
  vsc_parallel_set_threads(0);
}

// ---- energies

static double axial_and_angular(random_body *body, const double *x, vsc_totals *totals)
{
  to_model(body->model, x, body->state->x);
  vsc_observe(body->model, body->state, body->ledger, true, totals);
  return totals->axial + totals->angular;
}

// With one frame and an affine deformation every edge and every tet is strained alike: the plain tets'
// energy. Smoothing never stores more than the tets alone (the law is convex enough here).
static void smoothed_energy_is_the_plain_one_where_strain_is_constant(void **state)
{
  (void)state;
  for (int noisy = 0; noisy < 2; noisy++) {
    double energy[2];
    vsc_totals totals;
    for (int tets = VSC_TETS_PLAIN; tets <= VSC_TETS_SMOOTHED; tets++) {
      random_body body;
      vsc_mesh *mesh = random_block(4, 30);
      body_define(&body, mesh, NULL, VSC_ACTIVE_NONE, VSC_VOLUME_NODAL);
      body.definition.tets = (vsc_tets_kind)tets;
      body_build(&body);
      double *x = deformed(mesh, 0.1, noisy ? 0.1 : 0, 31);
      energy[tets] = axial_and_angular(&body, x, &totals);
      vsc_free(x);
      body_close(&body);
    }
    if (noisy)
      assert_true(energy[1] < 0.8 * energy[0] && energy[1] > 0.1 * energy[0]);
    else
      assert_close(energy[1], energy[0], 1e-13, 0);
  }
}

// Explicit steps of active, damped tissue: works, heat and stored energy balance to the trapezoidal
// rule's error, which falls with the square of the distance between looks.
static void the_ledger_balances_while_tissue_contracts(void **state)
{
  (void)state;
  double error[2];
  for (int fine = 0; fine < 2; fine++) {
    random_body body;
    vsc_error message;
    vsc_totals totals;
    vsc_mesh *mesh = random_block(3, 40);
    body_define(&body, mesh, random_axes(mesh->element_count, 41), VSC_ACTIVE_TENSION,
                VSC_VOLUME_NODAL);
    body.definition.tets = VSC_TETS_SMOOTHED;
    body.definition.pressure_count = 0;
    body.materials[0].active.curve.duration = 4;
    body.materials[0].active.delay = body.materials[0].active.delay_unit = 0.01;
    body_build(&body);
    if (vsc_start(body.model, body.state, &message) != VSC_OK) fail_msg("%s", message.text);
    const double dt = body.state->limit.step / (fine ? 4 : 2), count = ceil(4 / dt);
    vsc_observe(body.model, body.state, body.ledger, false, &totals);
    for (int k = 0; k < (int)count; k++) {
      if (vsc_steps(body.model, body.state, dt, 1, &message) != VSC_OK) fail_msg("%s", message.text);
      vsc_observe(body.model, body.state, body.ledger, false, &totals);
    }
    assert_true(body.ledger->active > 1 && body.ledger->dissipated > 0);
    assert_true(totals.tension_high > 0);
    error[fine] = fabs(vsc_balance_error(body.ledger, &totals)) / fabs(body.ledger->active);
    body_close(&body);
  }
  assert_true(error[0] < 1e-2);
  assert_true(error[1] < error[0] / 3);
}

// The bound at rest holds for smoothed tets too: they are softer than the plain ones.
static void the_step_bound_holds(void **state)
{
  (void)state;
  random_body body;
  size_t slot;
  open_smoothed(&body, 4, VSC_ACTIVE_NONE, 50);
  vsc_limit_refresh(body.model, body.state, 0, 60);
  assert_true(body.state->limit.eigenvalue < vsc_limit_bound(body.model, &body.state->scratch, &slot));
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(edges_share_the_volume_of_their_tissue),
      cmocka_unit_test(edges_have_the_mean_axes_of_their_tets),
      cmocka_unit_test(tissues_have_edges_of_their_own),
      cmocka_unit_test(edges_have_the_same_bits_on_any_number_of_threads),
      cmocka_unit_test(smoothed_energy_is_the_plain_one_where_strain_is_constant),
      cmocka_unit_test(the_ledger_balances_while_tissue_contracts),
      cmocka_unit_test(the_step_bound_holds),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
