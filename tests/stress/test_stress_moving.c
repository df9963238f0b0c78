// SPDX-License-Identifier: GPL-3.0-or-later
// The stable step of bodies that contract, looked at behind each step, so that it is seen when it is oldest too: against
// the true one of where they are then.
#include "kinds_body.h"
#include "solve/explicit.h"
#include "tissue_laws.h"
#include "tools/bench/true_step.h"
#include "trap.h"

// The most that the estimate (before the safety of 0.8) is of the true step while a half sine of `tension` (kPa)
// lasts `duration` (ms), in tissue of some kPa.
static double most_of_true(int law, kinds_mesh kind, double tension, double duration)
{
  vsc_error error;
  vsc_mesh *mesh = mesh_of(kind, 2, 7);
  vsc_axes *axes = random_axes_for(mesh, 11);
  vsc_material_def material = tissue_law(law);
  material.viscosity = 0.3;
  material.active = vsc_default_active();
  material.active.kind = VSC_ACTIVE_TENSION;
  material.active.tension = tension;
  material.active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  material.active.curve.start = 3;
  material.active.curve.duration = duration;
  vsc_definition definition = vsc_default_definition();
  definition.materials = &material;
  definition.material_count = 1;
  definition.end_time = 1e3;
  vsc_model *model;
  vsc_state *state;
  if (vsc_model_build(mesh, axes, &definition, &model, &error) != VSC_OK ||
      vsc_state_create(model, &state, &error) != VSC_OK || vsc_start(model, state, &error) != VSC_OK)
    fail_msg("%s", error.text);
  double most = 0;
  while (state->time < duration + 4) {
    double step;
    if (vsc_advance(model, state, state->time + state->limit.step, &error) != VSC_OK) fail_msg("law %d: %s", law, error.text);
    assert_int_equal(vsc_true_step(model, state, &step, &error), VSC_OK);
    most = fmax(most, state->limit.step / model->safety / step);
  }
  vsc_state_free(state);
  vsc_model_free(model);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
  return most;
}

// While 20 kPa come and go in 20 ms the estimate is the true step to 1 %. Tension of thirty times the shear modulus within 5 ms
// stiffens tissue more than twofold; hexahedra under an exponential law do so by two fifths from one step to the next, by
// their own strain, which no curve foretells: where estimates fall decides whether the oldest is 1.2 or 1.3 of the true step.
// Steps are 0.8 of an estimate.
static void estimates_age_no_more_than_safety_bears(void **nothing)
{
  (void)nothing;
  static const int laws[4] = {2, 8, 10, 13};
  static const kinds_mesh kinds[2] = {ALL_TETS, ALL_HEXES};
  static const double most_slow[2] = {1, 1.02}, most_sudden[2] = {1.13, 1.32};
  for (int k = 0; k < 8; k++) {
    const int kind = k % 2, law = laws[k / 2];
    const double slow = most_of_true(law, kinds[kind], 20, 20), sudden = most_of_true(law, kinds[kind], 100, 10);
    if (slow > most_slow[kind]) fail_msg("law %d, kind %d: 20 kPa in 20 ms: %g of the true step", law, kind, slow);
    if (sudden > most_sudden[kind]) fail_msg("law %d, kind %d: 100 kPa in 10 ms: %g", law, kind, sudden);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(estimates_age_no_more_than_safety_bears)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
