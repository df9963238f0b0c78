// SPDX-License-Identifier: GPL-3.0-or-later
// Real and third-party data, where ../shared/data is there: a human heart's angle map on its mesh,
// and a phantom of another project that knows its helix angles.
#include "close.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/vec3.h"
#include "fibers/fibers.h"
#include "fibers/helix.h"
#include "io/vtk.h"

#define DATA VSC_SOURCE_DIR "/../shared/data/"

static const double degree = M_PI / 180;

static void skip_without(const char *file)
{
  if (access(file, R_OK) == 0) return;
  print_message("skipped: %s is not there\n", file);
  skip();
}

static int by_value(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

static double axis_angle(const double a[3], const double b[3])
{
  double across[3];
  vsc_cross(a, b, across);
  return atan2(vsc_norm(across), fabs(vsc_dot(a, b))) / degree;
}

static void use_human_map(vsc_fiber_def *definition)
{
  *definition = vsc_default_fiber();
  definition->source = VSC_FIBER_MAP;
  definition->fill = true;
  vsc_angle_map_def *map = &definition->map;
  snprintf(map->file, sizeof map->file, "%s", DATA "heart_human_angles.vti");
  vsc_copy_name(map->azimuth, "azimuth_x10");
  vsc_copy_name(map->elevation, "elevation_x10");
  vsc_copy_name(map->mask, "tissue");
  vsc_copy_name(map->weight, "coherence_x100");
  map->scale = degree / 10;
}

// The mesh's own fibre array is the voxel nearest to each element: noisier than the mean, not
// biased.
static void human_heart(void **state)
{
  (void)state;
  skip_without(DATA "heart_human_angles.vti");
  skip_without(DATA "heart_human_biv_tet.vtu");
  vsc_mesh *mesh = NULL;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_vtk_read_mesh(DATA "heart_human_biv_tet.vtu", 1, &mesh, &error), VSC_OK);
  vsc_fiber_def definition;
  use_human_map(&definition);
  vsc_axes *axes = NULL;
  vsc_fiber_report report;
  assert_int_equal(vsc_fibers_make(mesh, &definition, NULL, 0, &axes, &report, &error), VSC_OK);
  assert_true(vsc_axes_valid(axes));
  assert_int_equal(report.passive, 0);
  assert_true(report.coherence[0] > 0.6);
  const double *nearest = vsc_arrays_find(&mesh->element_data, "fiber")->values;
  double *angles = test_malloc(mesh->element_count * sizeof *angles);
  for (size_t e = 0; e < mesh->element_count; e++)
    angles[e] = axis_angle(&nearest[3 * e], &axes->frames[9 * e]);
  qsort(angles, mesh->element_count, sizeof *angles, by_value);
  print_message(
      "human heart: %zu of %zu elements with data, %zu interpolated, %zu filled; from the nearest "
      "voxel by %.1f (median), %.1f (90 %%) degrees\n",
      report.with_data, report.elements, report.fallback, report.filled,
      angles[mesh->element_count / 2], angles[mesh->element_count * 9 / 10]);
  assert_true(angles[mesh->element_count / 2] < 5);
  assert_true(angles[mesh->element_count * 9 / 10] < 15);
  test_free(angles);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

// The same heart as hexahedra has the fibres of its tets: those of each hexahedron are compared
// with the mean of the tets whose centres lie in the ball of its volume.
static void human_heart_of_hexahedra(void **state)
{
  (void)state;
  skip_without(DATA "heart_human_angles.vti");
  skip_without(DATA "heart_human_biv_tet.vtu");
  skip_without(DATA "heart_human_biv_hex.vtu");
  const char *files[2] = {DATA "heart_human_biv_tet.vtu", DATA "heart_human_biv_hex.vtu"};
  vsc_mesh *mesh[2] = {NULL};
  vsc_axes *axes[2] = {NULL};
  vsc_fiber_report report[2];
  vsc_fiber_def definition;
  vsc_error error = {.text = ""};
  use_human_map(&definition);
  for (int k = 0; k < 2; k++) {
    assert_int_equal(vsc_vtk_read_mesh(files[k], 1, &mesh[k], &error), VSC_OK);
    assert_int_equal(vsc_fibers_make(mesh[k], &definition, NULL, 0, &axes[k], &report[k], &error),
                     VSC_OK);
    assert_int_equal(report[k].passive, 0);
  }
  assert_true(vsc_axes_valid(axes[1]));
  double angles[400];
  size_t count = 0;
  for (size_t e = 0; e < mesh[1]->element_count && count < 400; e += 26) {
    double here[3], there[3], apart[3], sum[6] = {0}, mean[3];
    const double radius = cbrt(vsc_mesh_element_volume(mesh[1], e) * 0.75 / M_PI);
    size_t within = 0;
    vsc_mesh_element_centre(mesh[1], e, here);
    for (size_t t = 0; t < mesh[0]->element_count; t++) {
      vsc_mesh_element_centre(mesh[0], t, there);
      vsc_subtract(here, there, apart);
      if (vsc_norm(apart) > radius) continue;
      const double *f = &axes[0]->frames[9 * t], volume = vsc_mesh_element_volume(mesh[0], t);
      static const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
      for (int c = 0; c < 6; c++) sum[c] += volume * f[row[c]] * f[column[c]];
      within++;
    }
    if (within < 3) continue;
    assert_true(vsc_top_axis(sum, mean, NULL));
    angles[count++] = axis_angle(&axes[1]->frames[9 * e], mean);
  }
  qsort(angles, count, sizeof *angles, by_value);
  print_message(
      "human heart of hexahedra: %zu of %zu elements with data, %zu interpolated, %zu "
      "filled; from the tets there by %.1f (median), %.1f (90 %%) degrees\n",
      report[1].with_data, report[1].elements, report[1].fallback, report[1].filled,
      angles[count / 2], angles[count * 9 / 10]);
  assert_true(angles[count / 2] < 5);
  assert_true(angles[count * 9 / 10] < 20);
  for (int k = 0; k < 2; k++) {
    vsc_axes_free(axes[k]);
    vsc_mesh_free(mesh[k]);
  }
}

// The first eigenvector of each pixel is the helix of its stated angle about its stated wall axes.
// Its rows run downwards, so that (x, y, z) is left-handed there and y has to be turned.
static void phantom_of_indi(void **state)
{
  (void)state;
  skip_without(DATA "dti_phantom_slice.vti");
  vsc_image *image = NULL;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_vtk_read_image(DATA "dti_phantom_slice.vti", 1, &image, &error), VSC_OK);
  const double *label = vsc_arrays_find(&image->data, "label")->values;
  const double *angle = vsc_arrays_find(&image->data, "helix_angle_deg")->values;
  const double *fiber = vsc_arrays_find(&image->data, "E1")->values;
  const double *radial = vsc_arrays_find(&image->data, "radial")->values;
  const double *along = vsc_arrays_find(&image->data, "longitudinal")->values;
  size_t pixels = 0;
  double worst = 0;
  for (size_t v = 0; v < image->size[0] * image->size[1] * image->size[2]; v++) {
    if (label[v] != 1) continue;
    pixels++;
    const double outwards[3] = {radial[3 * v], -radial[3 * v + 1], radial[3 * v + 2]};
    const double first[3] = {fiber[3 * v], -fiber[3 * v + 1], fiber[3 * v + 2]};
    double frame[9];
    assert_int_equal(vsc_helix_frame(outwards, &along[3 * v], angle[v] * degree, frame), 1);
    worst = fmax(worst, axis_angle(frame, first));
  }
  print_message("phantom: %zu pixels, worst %.3g degrees\n", pixels, worst);
  assert_int_equal(pixels, 1656);
  assert_true(worst < 0.01);
  vsc_image_free(image);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(human_heart),
      cmocka_unit_test(human_heart_of_hexahedra),
      cmocka_unit_test(phantom_of_indi),
  };
  return cmocka_run_group_tests_name("fibers/real", tests, NULL, NULL);
}
