// SPDX-License-Identifier: GPL-3.0-or-later
// Which materials elements take by the numbers of their regions; volumes that the tets round a node share.
#include <math.h>
#include <string.h>

#include "small_body.h"
#include "solve/solve.h"
#include "trap.h"

// Builds a body of two materials, region 2 and the rest, whose element 5 has region `region`.
static vsc_status build_with(double region, size_t count[2], vsc_error *error)
{
  small_body body;
  vsc_material_def materials[2];
  body_open(&body, block_of(2, 2, 2, 1, 0), 50);
  materials[0] = materials[1] = body.material;
  materials[1].region_count = 1;
  materials[1].regions[0] = 2;
  vsc_copy_name(materials[1].name, "other");
  body.definition.materials = materials;
  body.definition.material_count = 2;
  vsc_copy_name(body.definition.region_array, "region");
  body.mesh->element_data.items[0].values[5] = region;
  const vsc_status status = vsc_model_build(body.mesh, NULL, &body.definition, &body.model, error);
  for (int m = 0; m < 2 && status == VSC_OK; m++) count[m] = body.model->materials[m].element_count;
  body_close(&body);
  return status;
}

static void regions_are_whole_numbers(void **state)
{
  (void)state;
  size_t count[2];
  vsc_error error;
  assert_int_equal(build_with(1, count, &error), VSC_OK);
  assert_int_equal(count[0], 48);
  assert_int_equal(build_with(2, count, &error), VSC_OK);
  assert_int_equal(count[0], 47);
  assert_int_equal(count[1], 1);
  assert_int_equal(build_with(-2147483648.0, count, &error), VSC_OK);
  const struct {
    double region;
    const char *words;
  } wrong[] = {{1.5, "element 5 has 1.5 in array 'region'"}, {3e9, "has 3000000000 in"}, {NAN, "nan in"}, {-INFINITY, "inf in"}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
    assert_int_equal(build_with(wrong[k].region, count, &error), VSC_INPUT);
    if (strstr(error.text, wrong[k].words) == NULL || strstr(error.text, "mesh.region_array: ") == NULL)
      fail_msg("%s", error.text);
  }
}

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
      cmocka_unit_test(regions_are_whole_numbers),
      cmocka_unit_test(tissues_that_meet_have_one_pressure),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
