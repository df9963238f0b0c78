// SPDX-License-Identifier: GPL-3.0-or-later
// Which materials depend on direction, and how many of their elements have none.
#include "small_body.h"
#include "model/small_strain.h"

static void must_depend(const vsc_material_def *material, bool depends)
{
  small_body body;
  body_open(&body, block_of(2, 2, 2, 1, 0), 50);
  body.material = *material;
  body_build(&body);
  assert_int_equal(vsc_depends_on_direction(body.model, body.model->materials), depends);
  assert_int_equal(vsc_undirected_elements(body.model), depends ? 48 : 0);
  body_close(&body);
}

static vsc_material_def springs(double f, double s, double n, double angular)
{
  vsc_material_def material = vsc_default_material();
  const double axial[3] = {f, s, n};
  for (int a = 0; a < 3; a++) {
    material.axial[a] = axial[a];
    material.angular[a] = angular;
  }
  material.volume_modulus = 50;
  material.density = 1;
  vsc_copy_name(material.name, "tissue");
  return material;
}

static void springs_depend_unless_they_are_isotropic(void **state)
{
  (void)state;
  vsc_material_def material = springs(20, 20, 20, 10);
  must_depend(&material, false);
  material = springs(20.1, 20, 20, 10);  // rounded
  must_depend(&material, false);
  material = springs(24, 20, 20, 10);
  must_depend(&material, true);
  material = springs(20, 20, 20, 5);  // alike along the axes, not between them
  must_depend(&material, true);
  material = springs(20, 20, 20, 10);
  for (int a = 0; a < 3; a++) material.damping[a] = 5;
  must_depend(&material, false);
  material.damping[1] = 6;
  must_depend(&material, true);
}

static void laws_depend_by_their_tangent(void **state)
{
  (void)state;
  vsc_material_def material = springs(20, 20, 20, 10);
  material.law = VSC_LAW_NEO_HOOKEAN;
  material.shear = 10;
  must_depend(&material, false);
  material.law = VSC_LAW_GUCCIONE;
  material.guccione = (vsc_guccione_def){.C = 2, .fibre = 3, .cross = 3, .shear = 3};
  must_depend(&material, false);
  material.guccione.fibre = 8;
  must_depend(&material, true);
  material.law = VSC_LAW_HOLZAPFEL_OGDEN;
  material.holzapfel_ogden = (vsc_holzapfel_ogden_def){.a = 1, .b = 5, .a_f = 2, .b_f = 8};
  must_depend(&material, true);
}

static void known_elements_are_not_counted(void **state)
{
  (void)state;
  small_body body;
  body_open(&body, block_of(2, 2, 2, 1, 0), 50);
  body.material = springs(40, 20, 20, 10);
  body_fibers(&body, (double[3]){1, 0, 0});
  for (int e = 0; e < 7; e++) body.axes->known[5 * e] = 0;
  body_build(&body);
  assert_int_equal(vsc_undirected_elements(body.model), 7);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(springs_depend_unless_they_are_isotropic),
      cmocka_unit_test(laws_depend_by_their_tangent),
      cmocka_unit_test(known_elements_are_not_counted),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
