// SPDX-License-Identifier: GPL-3.0-or-later
// The kernel of any law against the springs' own, the work of active tension, viscosity in closed form,
// the bound of the stable step, and what is counted beyond the largest exponent.
#include "base/vec3.h"
#include "kinds_body.h"
#include "mech/step_limit.h"
#include "tissue_laws.h"

// Both kernels on springs of all sorts: the general one because of a viscosity, or of a part of the
// tension across the fibre, too small to count.
static void general_kernel_is_the_springs(void **state)
{
  (void)state;
  vsc_axis_def axes[2];
  vsc_pair_def pairs[2];
  for (int volume = VSC_VOLUME_NODAL; volume <= VSC_VOLUME_ELEMENT; volume++)
    for (int active = VSC_ACTIVE_NONE; active <= VSC_ACTIVE_TENSION; active++) {
      vsc_material_def material = springs_material(axes, pairs);
      random_body body[2];
      double *force[2];
      material.active.kind = (vsc_active_kind)active;
      material.active.stiffness = 60;
      material.active.rest_stretch = 0.85;
      material.active.tension = 25;
      for (int k = 0; k < 2; k++) {
        if (k == 1) material.viscosity = 1e-300;
        kinds_open(&body[k], mesh_of(ALL_KINDS, 3, 5), &material, (vsc_volume_kind)volume, 6);
        const size_t count = 3 * body[k].mesh->node_count;
        double *x = deformed(body[k].mesh, 0.12, 0.05, 7), *w = random_array(count, 1, 8);
        force[k] = numbers(count);
        body_force(&body[k], x, w, 0, force[k]);
        vsc_free(x);
        vsc_free(w);
      }
      assert_false(body[0].model->materials[0].general);
      assert_true(body[1].model->materials[0].general);
      const size_t count = 3 * body[0].mesh->node_count;
      const double most = largest_of(force[0], count);
      // the same sums in another order
      for (size_t i = 0; i < count; i++) assert_close(force[0][i], force[1][i], 0, 1e-13 * most);
      for (int k = 0; k < 2; k++) {
        vsc_free(force[k]);
        body_close(&body[k]);
      }
    }
}

// A block sheared and stretched evenly at rate L resists with S = eta (L + L^T)/2: power
// -eta |sym L|^2 V, at rest.
static void viscosity_is_of_the_whole_strain_rate(void **state)
{
  (void)state;
  vsc_material_def material = tissue_law(0);
  random_body body;
  uint64_t seed = 9;
  double L[9];
  material.viscosity = 0.7;
  kinds_open(&body, mesh_of(ALL_KINDS, 3, 5), &material, VSC_VOLUME_NODAL, 6);
  const size_t nodes = body.mesh->node_count;
  double *w = numbers(3 * nodes), *force = numbers(3 * nodes), square = 0;
  random_fill(&seed, 1, L, 9);
  for (size_t n = 0; n < nodes; n++) rotate_vector(L, body.mesh->nodes + 3 * n, w + 3 * n);
  for (int i = 0; i < 9; i++) square += 0.25 * pow(L[i] + L[3 * (i % 3) + i / 3], 2);
  body_force(&body, body.mesh->nodes, w, 0, force);
  const double volume = body.model->total_volume;
  // at rest there is no other force
  assert_close(dot_of(force, w, 3 * nodes), -0.7 * square * volume, 1e-12, 0);
  vsc_free(w);
  vsc_free(force);
  body_close(&body);
}

// Moves the nodes in `steps` from rest to `end` and returns the ledger's work of tension less the work
// of the active forces (both by the trapezoidal rule: the difference falls with the square of the step).
static double work_difference(random_body *active, random_body *passive, const double *end, int steps)
{
  const size_t count = 3 * active->mesh->node_count;
  const double *rest = active->mesh->nodes;
  double *x = numbers(count), *pull = numbers(count), *other = numbers(count);
  double *before = numbers(count), work = 0;
  vsc_totals totals;
  vsc_ledger_free(active->ledger);
  vsc_error error;
  if (vsc_ledger_create(active->model, &active->ledger, &error) != VSC_OK) fail_msg("%s", error.text);
  for (int s = 0; s <= steps; s++) {
    for (size_t i = 0; i < count; i++) x[i] = rest[i] + (end[i] - rest[i]) * s / steps;
    body_force(active, x, NULL, 0, pull);
    body_force(passive, x, NULL, 0, other);
    for (size_t i = 0; i < count; i++) {
      pull[i] -= other[i];
      if (s > 0) work += 0.5 * (pull[i] + before[i]) * (end[i] - rest[i]) / steps;
      before[i] = pull[i];
    }
    to_model(active->model, x, active->state->x);
    vsc_observe(active->model, active->state, active->ledger, false, &totals);
  }
  assert_true(fabs(work) > 1);
  const double difference = active->ledger->active - work;
  vsc_free(x);
  vsc_free(pull);
  vsc_free(other);
  vsc_free(before);
  return difference;
}

static void work_of_tension_is_that_of_its_forces(void **state)
{
  (void)state;
  random_body active, passive;
  vsc_material_def material = tissue_law(2);
  kinds_open(&passive, mesh_of(ALL_KINDS, 2, 5), &material, VSC_VOLUME_NODAL, 6);
  material.active.kind = VSC_ACTIVE_TENSION;
  material.active.tension = 40;
  material.active.length_factor = 1.5;
  material.active.sheet_fraction = 0.4;
  material.active.normal_fraction = 0.1;
  kinds_open(&active, mesh_of(ALL_KINDS, 2, 5), &material, VSC_VOLUME_NODAL, 6);
  double *end = deformed(active.mesh, 0.2, 0.02, 7);
  const double coarse = work_difference(&active, &passive, end, 8);
  const double fine = work_difference(&active, &passive, end, 16);
  assert_close(log2(coarse / fine), 2, 0, 0.05);
  vsc_free(end);
  body_close(&active);
  body_close(&passive);
}

// Power iteration from below, the bound from above.
static void bound_of_the_step_holds_for_every_law(void **state)
{
  (void)state;
  for (int k = 0; k < TISSUE_LAWS; k++)
    for (int active = 0; active < 2; active++) {
      random_body body;
      vsc_material_def material = tissue_law(k);
      size_t slot;
      material.compression = VSC_FIBRES_ALWAYS;
      if (active) {
        material.active.kind = VSC_ACTIVE_TENSION;
        material.active.tension = 80;
        material.active.length_factor = 2;
        material.active.sheet_fraction = 0.5;
      }
      material.volume_modulus = 5;
      material.stabilization = 0;
      kinds_open(&body, mesh_of(ALL_KINDS, 3, 5), &material, (vsc_volume_kind)(k % 2), 6);
      to_model(body.model, body.mesh->nodes, body.state->x);
      vsc_limit_refresh(body.model, body.state, 0, 60);
      const double bound = vsc_limit_bound(body.model, &body.state->scratch, &slot);
      assert_true(body.state->limit.eigenvalue <= bound * (1 + 1e-9));
      // and it says something
      assert_true(body.state->limit.eigenvalue >= 0.05 * bound);
      body_close(&body);
    }
}

static void frames_beyond_the_largest_exponent_are_counted(void **state)
{
  (void)state;
  random_body body;
  const vsc_material_def material = tissue_law(2);
  kinds_open(&body, mesh_of(ALL_KINDS, 2, 5), &material, VSC_VOLUME_NODAL, 6);
  const size_t count = 3 * body.mesh->node_count;
  double *x = numbers(count);
  vsc_totals totals;
  size_t frames = 0;
  for (size_t e = 0; e < body.mesh->element_count; e++)
    frames += (size_t)vsc_family_frames(body.model, body.mesh->kinds[e]);
  for (size_t i = 0; i < count; i++) x[i] = 1.2 * body.mesh->nodes[i];
  kinds_energy(&body, x, &totals);
  assert_true(totals.continued == 0);
  // Q = 8 + 4 times (9 - 1)^2/4
  for (size_t i = 0; i < count; i++) x[i] = 3 * body.mesh->nodes[i];
  kinds_energy(&body, x, &totals);
  assert_true(totals.continued == (double)frames);
  vsc_free(x);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(general_kernel_is_the_springs),
      cmocka_unit_test(viscosity_is_of_the_whole_strain_rate),
      cmocka_unit_test(work_of_tension_is_that_of_its_forces),
      cmocka_unit_test(bound_of_the_step_holds_for_every_law),
      cmocka_unit_test(frames_beyond_the_largest_exponent_are_counted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
