// SPDX-License-Identifier: GPL-3.0-or-later
// Angle maps that must be refused, each with a message that names what is wrong.
#include "close.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "fibers/sample.h"
#include "tools/shapes.h"
#include "trap.h"

static vsc_mesh *slab(void)
{
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {.cells = {4, 2, 4}, .size = {24, 9, 24}, .tets_per_cell = 5};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  return mesh;
}

// 11 x 11 x 11 voxels of 4 mm round the slab, one fibre direction, mask and weight 1.
static vsc_image *map_of_slab(void)
{
  const char *names[] = {"azimuth", "elevation", "mask", "weight"};
  const double values[] = {63, 40, 1, 1};
  const size_t size[3] = {11, 11, 11};
  vsc_image *image = vsc_image_create(size);
  assert_non_null(image);
  for (int a = 0; a < 3; a++) {
    image->spacing[a] = 4;
    image->origin[a] = a == 1 ? -15 : -8;
  }
  for (int a = 0; a < 4; a++) {
    vsc_array *array = vsc_arrays_add(&image->data, names[a], 1, 1331);
    assert_non_null(array);
    for (size_t v = 0; v < 1331; v++) array->values[v] = values[a];
  }
  return image;
}

static size_t voxels_of(const vsc_image *image)
{
  return image->size[0] * image->size[1] * image->size[2];
}

static void accept(const vsc_mesh *mesh, const vsc_image *image, const vsc_angle_map_def *map)
{
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_fiber_report report;
  assert_int_equal(vsc_fibers_sample(mesh, image, map, axes, &report, NULL), VSC_OK);
  assert_int_equal(report.with_data, mesh->element_count);
  vsc_axes_free(axes);
}

// Sampling must fail, naming `word`.
static void refuse(const vsc_mesh *mesh, const vsc_image *image, const vsc_angle_map_def *map,
                   const char *word)
{
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_fiber_report report;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_fibers_sample(mesh, image, map, axes, &report, &error), VSC_INPUT);
  if (strstr(error.text, word) == NULL) print_error("no '%s' in: %s\n", word, error.text);
  assert_non_null(strstr(error.text, word));
  vsc_axes_free(axes);
}

static void broken_maps_are_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = slab();
  vsc_image *image = map_of_slab();
  vsc_angle_map_def map = vsc_default_fiber().map;
  vsc_copy_name(map.azimuth, "azimut");
  refuse(mesh, image, &map, "azimuth");
  map = vsc_default_fiber().map;
  vsc_copy_name(map.mask, "tissue");
  refuse(mesh, image, &map, "tissue");
  map = vsc_default_fiber().map;
  vsc_copy_name(map.mask, "mask");
  vsc_copy_name(map.weight, "weight");
  double *azimuth = image->data.items[0].values, *mask = image->data.items[2].values;
  double *weight = image->data.items[3].values;
  trap_off();
  azimuth[12] = NAN;
  refuse(mesh, image, &map, "(1, 1, 0)");
  mask[12] = NAN;
  accept(mesh, image, &map);
  weight[13] = -2;
  refuse(mesh, image, &map, "-2");
  weight[13] = INFINITY;
  refuse(mesh, image, &map, "inf");
  weight[13] = 0;
  azimuth[13] = NAN;
  accept(mesh, image, &map);
  image->origin[0] += 1000;
  refuse(mesh, image, &map, "units");
  image->origin[0] -= 1000;
  image->direction[8] = 0;
  refuse(mesh, image, &map, "determinant");
  image->direction[8] = 1;
  image->spacing[1] = 0;
  refuse(mesh, image, &map, "spacing");
  image->spacing[1] = 4;
  for (size_t v = 0; v < voxels_of(image); v++) mask[v] = 0;
  refuse(mesh, image, &map, "none of");
  image->data.items[1].tuples--;
  refuse(mesh, image, &map, "elevation");
  trap_on();
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

static void little_memory_is_reported(void **state)
{
  (void)state;
  vsc_mesh *mesh = slab();
  vsc_image *image = map_of_slab();
  const vsc_angle_map_def map = vsc_default_fiber().map;
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_fiber_report report;
  vsc_status status = VSC_SYSTEM;
  long allowed = 0;
  for (; status != VSC_OK; allowed++) {
    vsc_alloc_fail_after(allowed);
    status = vsc_fibers_sample(mesh, image, &map, axes, &report, NULL);
    assert_true(status == VSC_OK || status == VSC_SYSTEM);
  }
  vsc_alloc_fail_after(-1);
  assert_true(allowed > 3);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(broken_maps_are_refused),
      cmocka_unit_test(little_memory_is_reported),
  };
  return cmocka_run_group_tests_name("fibers/map errors", tests, NULL, NULL);
}
