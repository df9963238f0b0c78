// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes that the tets round a node share.
#include "small_body.h"
#include "solve/solve.h"

// The elastic energy of a bar that is confined and pulled, whose second half is 100 times as incompressible.
static double energy_of_two(vsc_volume_kind volume)
{
  small_body body;
  body_open(&body, block_of(8, 2, 2, 1, 0), 20);
  vsc_material_def tissues[2] = {body.material, body.material};
  vsc_array *region = vsc_arrays_add(&body.mesh->element_data, "half", 1, body.mesh->element_count);
  for (size_t e = 0; e < body.mesh->element_count; e++)
    for (int c = 0; c < 4; c++)
      if (body.mesh->nodes[3 * body.mesh->corners[4 * e + (size_t)c]] > 4) region->values[e] = 1;
  for (int m = 0; m < 2; m++) {
    for (int a = 0; a < 3; a++) tissues[m].axial[a] = 2, tissues[m].angular[a] = 1;
    snprintf(tissues[m].name, sizeof tissues[m].name, "half %d", m);
    tissues[m].region_count = 1;
    tissues[m].regions[0] = m;
    tissues[m].stabilization = 2;
    // each tet alone has what a tet beside its nodes' volumes has in all
    tissues[m].volume_modulus = (m == 0 ? 20 : 2000) + (volume == VSC_VOLUME_ELEMENT ? 2 : 0);
  }
  vsc_copy_name(body.definition.region_array, "half");
  body.definition.materials = tissues;
  body.definition.material_count = 2;
  body.definition.volume = volume;
  body.definition.solve.kind = VSC_SOLVE_EQUILIBRIUM;
  body_hold(&body, "all", 0, 1, 1);
  body.sets[0] = (vsc_selector){.name = "all", .kind = VSC_SELECT_BOX, 
                                .box_low = {-1, -1, -1}, .box_high = {9, 9, 9}};
  body_hold(&body, "x0", 1, 0, 0);
  body_hold(&body, "x1", 1, 0, 0);
  body.supports[2].motion[0] = 0.8;
  body.supports[2].curve = vsc_default_curve(VSC_CURVE_RAMP);
  body.supports[2].curve.duration = 100;
  body_build(&body);
  vsc_error error;
  if (vsc_solve_start(body.model, body.state, &error) != VSC_OK ||
      vsc_solve_to(body.model, body.state, 100, &error) != VSC_OK)
    fail_msg("%s", error.text);
  vsc_ledger *ledger;
  vsc_totals totals;
  assert_int_equal(vsc_ledger_create(body.model, &ledger, NULL), VSC_OK);
  vsc_observe(body.model, body.state, ledger, false, &totals);
  vsc_ledger_free(ledger);
  body_close(&body);
  return totals.axial + totals.volume_energy;
}

// Where tissues meet their nodes' volumes give way as each tissue's own would, one behind the other.
static void tissues_that_meet_have_one_pressure(void **state)
{
  (void)state;
  const double alone = energy_of_two(VSC_VOLUME_ELEMENT);  // exact: the stretch of each half is uniform
  assert_true(alone > 5);
  assert_close(energy_of_two(VSC_VOLUME_NODAL), alone, 0.01, 0);  // by the mean modulus 19 % above
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tissues_that_meet_have_one_pressure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
