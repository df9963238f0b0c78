// SPDX-License-Identifier: GPL-3.0-or-later
// Which materials elements take by the numbers of their regions.
#include <math.h>
#include <string.h>

#include "small_body.h"
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

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(regions_are_whole_numbers)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
