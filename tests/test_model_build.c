// SPDX-License-Identifier: GPL-3.0-or-later
// What a library caller may not put together.
#include <string.h>

#include "small_body.h"
#include "trap.h"

static void build_refuses(vsc_axes *axes, const char *part)
{
  const vsc_block_shape shape = {.cells = {1, 1, 1}, .size = {1, 1, 1}, .tets_per_cell = 5};
  vsc_mesh *mesh;
  vsc_model *model;
  vsc_error error;
  vsc_material_def material = vsc_default_material();
  vsc_definition definition = vsc_default_definition();
  material.volume_modulus = 1;
  for (int a = 0; a < 3; a++) material.axial[a] = material.angular[a] = 1;
  definition.materials = &material;
  definition.material_count = 1;
  definition.end_time = 1;
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  const vsc_status status = vsc_model_build(mesh, axes, &definition, &model, &error);
  if (part == NULL) {
    if (status != VSC_OK) fail_msg("%s", error.text);
    vsc_model_free(model);
  } else {
    assert_int_equal(status, VSC_INPUT);
    if (strstr(error.text, part) == NULL) fail_msg("no '%s' in '%s'", part, error.text);
    assert_null(model);
  }
  vsc_mesh_free(mesh);
}

static void frames_must_be_orthonormal(void **state)
{
  (void)state;
  vsc_axes *axes = vsc_axes_create(5);
  build_refuses(axes, NULL);
  axes->frames[9 * 3 + 1] = 0.1;  // f of the fourth tet leans towards s
  build_refuses(axes, "not orthonormal");
  axes->frames[9 * 3 + 1] = NAN;
  trap_off();
  build_refuses(axes, "not orthonormal");
  trap_on();
  vsc_axes_free(axes);
}

static void every_tet_has_its_frame(void **state)
{
  (void)state;
  vsc_axes *axes = vsc_axes_create(4);
  build_refuses(axes, "axes of 4 elements for a mesh of 5");
  vsc_axes_free(axes);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(frames_must_be_orthonormal),
                                     cmocka_unit_test(every_tet_has_its_frame)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
