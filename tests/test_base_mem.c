// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays, and what happens when memory is short at every single allocation of a model and its
// state.
#include "base/mem.h"

#include <string.h>

#include "close.h"
#include "io/scene.h"
#include "mech/observe.h"
#include "model/model.h"
#include "tools/shapes.h"

static void test_arrays_are_zeroed_and_aligned(void **state)
{
  (void)state;
  for (size_t count = 0; count < 200; count += 7) {
    double *array;
    assert_true(VSC_NEW(array, count));
    assert_int_equal((uintptr_t)array % VSC_ALIGNMENT, 0);
    for (size_t i = 0; i < count; i++) assert_true(array[i] == 0);
    memset(array, 0xff, count * sizeof *array);  // the next one must not see this
    vsc_free(array);
  }
  vsc_free(NULL);
}

static void test_overflow_is_no_memory(void **state)
{
  (void)state;
  assert_null(vsc_alloc(SIZE_MAX, 2));
  assert_null(vsc_alloc(SIZE_MAX / 8 + 1, 8));
  assert_null(vsc_alloc(SIZE_MAX, 1));
}

static void test_growing_keeps_the_content(void **state)
{
  (void)state;
  void *array = NULL;
  assert_true(vsc_grow(&array, 0, 3, sizeof(int)));
  memcpy(array, (const int[]){1, 2, 3}, 3 * sizeof(int));
  assert_true(vsc_grow(&array, 3, 40, sizeof(int)));
  const int *values = array;
  for (int i = 0; i < 40; i++) assert_int_equal(values[i], i < 3 ? i + 1 : 0);
  void *const before = array;
  vsc_alloc_fail_after(0);
  assert_false(vsc_grow(&array, 40, 80, sizeof(int)));
  assert_ptr_equal(array, before);
  assert_int_equal(values[2], 3);
  vsc_free(array);
}

static void test_failing_comes_once_and_after_its_count(void **state)
{
  (void)state;
  void *made[4];
  vsc_alloc_fail_after(2);
  for (int i = 0; i < 4; i++) made[i] = vsc_alloc(1, 1);
  for (int i = 0; i < 4; i++) assert_true((made[i] == NULL) == (i == 2));
  vsc_alloc_fail_after(0);
  vsc_alloc_fail_after(-1);
  void *other = vsc_alloc(1, 1);
  assert_non_null(other);
  vsc_free(other);
  for (int i = 0; i < 4; i++) vsc_free(made[i]);
}

// Everything that allocates: an active material, arrays of amplitude and delay, node-averaged
// volume, a surface under pressure and on springs, a support that moves, weight.
static vsc_definition full_definition(vsc_material_def *material, vsc_selector *face,
                                      vsc_selector *set, vsc_support_def *support,
                                      vsc_pressure_def *pressure, vsc_robin_def *robin)
{
  *material = vsc_default_material();
  for (int a = 0; a < 3; a++) material->axial[a] = material->angular[a] = material->damping[a] = 10;
  material->volume_modulus = 100;
  material->stabilization = 10;
  material->active.kind = VSC_ACTIVE_TENSION;
  material->active.tension = 10;
  material->active.curve = vsc_default_curve(VSC_CURVE_HALF_SINE);
  vsc_copy_name(material->active.amplitude_array, "region");
  vsc_copy_name(material->active.delay_array, "region");
  *face = (vsc_selector){
      .name = "top", .kind = VSC_SELECT_NODE_ARRAY, .array = "z1", .low = 1, .high = 1};
  *set = (vsc_selector){
      .name = "bottom", .kind = VSC_SELECT_NODE_ARRAY, .array = "z0", .low = 1, .high = 1};
  *support = (vsc_support_def){.set = "bottom", .held = {1, 1, 1}, .motion = {0, 0, 1}};
  *robin = (vsc_robin_def){.surface = "top", .stiffness = 1, .damping = 1};
  *pressure =
      (vsc_pressure_def){.surface = "top", .peak = 1, .curve = vsc_default_curve(VSC_CURVE_RAMP)};
  vsc_definition definition = vsc_default_definition();
  definition.material_count = definition.surface_count = definition.set_count = 1;
  definition.support_count = definition.pressure_count = definition.robin_count = 1;
  definition.materials = material;
  definition.surfaces = face;
  definition.sets = set;
  definition.supports = support;
  definition.pressures = pressure;
  definition.robins = robin;
  definition.gravity[2] = -0.00981;
  definition.end_time = 100;
  return definition;
}

// Model, state and ledger; what was made is released again.
static vsc_status make_all(const vsc_mesh *mesh, const vsc_axes *axes,
                           const vsc_definition *definition, vsc_error *error)
{
  vsc_model *model = NULL;
  vsc_state *state = NULL;
  vsc_ledger *ledger = NULL;
  vsc_status status = vsc_model_build(mesh, axes, definition, &model, error);
  if (status == VSC_OK) status = vsc_state_create(model, &state, error);
  if (status == VSC_OK) status = vsc_ledger_create(model, &ledger, error);
  vsc_ledger_free(ledger);
  vsc_state_free(state);
  vsc_model_free(model);
  return status;
}

// The address sanitizer's build of this test sees to the leaks.
static void test_every_allocation_may_fail(void **state)
{
  (void)state;
  vsc_material_def material;
  vsc_selector face, set;
  vsc_support_def support;
  vsc_pressure_def pressure;
  vsc_robin_def robin;
  const vsc_definition definition =
      full_definition(&material, &face, &set, &support, &pressure, &robin);
  const vsc_block_shape shape = {.cells = {3, 3, 3}, .size = {9, 9, 9}, .tets_per_cell = 5};
  vsc_mesh *mesh;
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  assert_non_null(axes);
  memset(axes->known, 1, axes->count);
  long failures = 0;
  for (vsc_status status = VSC_SYSTEM; status != VSC_OK; failures++) {
    vsc_error error = {.status = VSC_OK};
    vsc_alloc_fail_after(failures);
    status = make_all(mesh, axes, &definition, &error);
    vsc_alloc_fail_after(-1);
    if (status == VSC_OK) break;
    assert_int_equal(status, VSC_SYSTEM);
    assert_int_equal(error.status, VSC_SYSTEM);
    assert_non_null(strstr(error.text, "memory"));
    assert_true(failures < 1000);
  }
  assert_true(failures > 40);  // the model alone has more arrays than that
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_arrays_are_zeroed_and_aligned),
      cmocka_unit_test(test_overflow_is_no_memory),
      cmocka_unit_test(test_growing_keeps_the_content),
      cmocka_unit_test(test_failing_comes_once_and_after_its_count),
      cmocka_unit_test(test_every_allocation_may_fail),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
