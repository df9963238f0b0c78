// SPDX-License-Identifier: GPL-3.0-or-later
// What a library caller may not put together, and what models have that are.
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

// Ahead of the run by 200 ms, and element k by k ms more: the curve goes on behind the end of the run.
static void elements_may_be_ahead_of_the_run(void **state)
{
  (void)state;
  for (int each = 0; each < 2; each++) {
    small_body body;
    body_open(&body, block_of(8, 1, 1, 1, 0), 60);
    body_fibers(&body, (double[3]){1, 0, 0});
    vsc_active_def *active = &body.material.active;
    active->kind = VSC_ACTIVE_TENSION;
    active->delay = -200;
    active->curve = vsc_default_curve(VSC_CURVE_RAMP);
    active->curve.duration = 400;
    if (each) {
      vsc_copy_name(active->delay_array, "ahead");
      vsc_array *ahead = vsc_arrays_add(&body.mesh->element_data, "ahead", 1, body.mesh->element_count);
      for (size_t t = 0; t < body.mesh->element_count; t++) ahead->values[t] = -(double)t;
    }
    body_build(&body);  // ends at 100 ms
    for (size_t slot = 0; slot < VSC_WIDTH * body.model->pack_count; slot++) {
      const double more = each ? body.model->mesh_element[slot] : 0;
      if (body.model->mesh_element[slot] == VSC_NO_ELEMENT) continue;
      for (double time = 0; time <= 100; time += 12.5)
        assert_close(vsc_model_activation(body.model, body.model->materials, slot, time), (time + 200 + more) / 400, 1e-13, 0);
    }
    body_close(&body);
  }
}

// Masses that are all alike weigh as much where bodies fall; in equilibria a node weighs its part of the elements.
static void equal_masses_weigh_alike_but_at_rest(void **state)
{
  (void)state;
  for (int rests = 0; rests < 2; rests++) {
    small_body body;
    body_open(&body, block_of(2, 2, 2, 1, 0.1), 20);
    body.definition.masses = VSC_MASS_EQUAL;
    body.definition.solve.kind = rests ? VSC_SOLVE_EQUILIBRIUM : VSC_SOLVE_IMPLICIT;
    body.definition.gravity[0] = 2;
    body_build(&body);
    double *lumped = calloc(body.mesh->node_count, sizeof *lumped);
    for (size_t t = 0; t < body.mesh->element_count; t++)
      for (int c = 0; c < 4; c++) lumped[body.mesh->corners[4 * t + (size_t)c]] += vsc_mesh_element_volume(body.mesh, t) / 4;
    for (size_t n = 0; n < body.model->node_count; n++) {
      const double mass = rests ? lumped[body.model->mesh_node[n]] : 8.0 / 27;
      assert_close(body.model->weight[4 * n], 2 * mass, 1e-13, 0);
    }
    free(lumped);
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(frames_must_be_orthonormal),
                                     cmocka_unit_test(every_tet_has_its_frame),
                                     cmocka_unit_test(elements_may_be_ahead_of_the_run),
                                     cmocka_unit_test(equal_masses_weigh_alike_but_at_rest)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
