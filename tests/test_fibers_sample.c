// SPDX-License-Identifier: GPL-3.0-or-later
// Angle maps written from known fibres and sampled back.
#include "close.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/sample.h"
#include "tools/shapes.h"

static const double degree = M_PI / 180;
static const double wall = 9.5;  // mm

static uint64_t dice = 1;

// In [0, 1).
static double chance(void)
{
  dice = dice * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return ldexp((double)(dice >> 11), -53);
}

static double axis_angle(const double a[3], const double b[3])
{
  double across[3];
  vsc_cross(a, b, across);
  return atan2(vsc_norm(across), fabs(vsc_dot(a, b))) / degree;
}

static int by_value(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

// A fibre field of the world: turns from +60 to -60 degrees from x towards z over the wall along y,
// or one direction when `wall_helix` is false.
typedef struct field {
  bool wall_helix;
  double direction[3];
} field;

static void fiber_at(const field *field, const double at[3], double f[3])
{
  const double angle = (60 - 120 * at[1] / wall) * degree;
  const double helix[3] = {cos(angle), 0, sin(angle)};
  memcpy(f, field->wall_helix ? helix : field->direction, 3 * sizeof *f);
  vsc_normalize(f);
}

static vsc_mesh *slab(double jitter)
{
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {
      .cells = {6, 3, 6}, .size = {24, wall, 24}, .tets_per_cell = 5, .jitter = jitter, .seed = 3};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  return mesh;
}

static const double upright[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

// An image with that direction matrix whose middle is the middle of the slab.
static vsc_image *image_round_slab(double spacing, const double direction[9])
{
  const size_t n = (size_t)ceil(40 / spacing) | 1, size[3] = {n, n, n};
  vsc_image *image = vsc_image_create(size);
  assert_non_null(image);
  const double middle[3] = {(double)(n / 2), (double)(n / 2), (double)(n / 2)};
  const double target[3] = {12.1, wall / 2 + 0.2, 11.7};
  memcpy(image->direction, direction, sizeof image->direction);
  for (int a = 0; a < 3; a++) image->spacing[a] = spacing;
  double at[3];
  vsc_image_position(image, middle, at);
  vsc_subtract(target, at, image->origin);
  const char *names[] = {"azimuth", "elevation", "mask", "weight"};
  for (int a = 0; a < 4; a++) assert_non_null(vsc_arrays_add(&image->data, names[a], 1, n * n * n));
  return image;
}

static size_t voxels_of(const vsc_image *image)
{
  return image->size[0] * image->size[1] * image->size[2];
}

static void place_of(const vsc_image *image, size_t voxel, double at[3])
{
  const size_t *size = image->size;
  const double index[3] = {(double)(voxel % size[0]), (double)(voxel / size[0] % size[1]),
                           (double)(voxel / size[0] / size[1])};
  vsc_image_position(image, index, at);
}

// Writes the field as angles in degrees, each fibre with a random sign; mask and weight are 1.
static void write_field(vsc_image *image, const field *field, bool image_axes)
{
  vsc_array *array = image->data.items;
  for (size_t v = 0; v < voxels_of(image); v++) {
    double at[3], world[3], f[3];
    place_of(image, v, at);
    fiber_at(field, at, world);
    memcpy(f, world, sizeof f);
    for (int c = 0; c < 3 && image_axes; c++)
      f[c] = image->direction[c] * world[0] + image->direction[3 + c] * world[1] +
             image->direction[6 + c] * world[2];
    const double sign = chance() < 0.5 ? -1 : 1;
    array[0].values[v] = atan2(sign * f[1], sign * f[0]) / degree;
    array[1].values[v] = asin(fmax(-1, fmin(1, sign * f[2]))) / degree;
    array[2].values[v] = array[3].values[v] = 1;
  }
}

static vsc_axes *sample(const vsc_mesh *mesh, const vsc_image *image, const vsc_angle_map_def *map,
                        vsc_fiber_report *report)
{
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  assert_non_null(axes);
  vsc_error error = {.text = ""};
  const vsc_status status = vsc_fibers_sample(mesh, image, map, axes, report, &error);
  if (status != VSC_OK) print_error("%s\n", error.text);
  assert_int_equal(status, VSC_OK);
  assert_true(vsc_axes_valid(axes));
  return axes;
}

// The part `part` of the errors over known elements, degrees.
static double error_at(const vsc_mesh *mesh, const vsc_axes *axes, const field *field, double part)
{
  double *errors = test_malloc(mesh->element_count * sizeof *errors);
  size_t known = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    if (!axes->known[e]) continue;
    double centre[3], f[3];
    vsc_mesh_element_centre(mesh, e, centre);
    fiber_at(field, centre, f);
    errors[known++] = axis_angle(f, &axes->frames[9 * e]);
  }
  assert_true(known > 0);
  qsort(errors, known, sizeof *errors, by_value);
  const double error = errors[(size_t)(part * (double)(known - 1))];
  test_free(errors);
  return error;
}

static vsc_angle_map_def default_map(void)
{
  return vsc_default_fiber().map;
}

static void sampled_field_is(const field *field, const double direction[9], bool image_axes,
                             double spacing, double part, double limit)
{
  vsc_mesh *mesh = slab(0.15);
  vsc_image *image = image_round_slab(spacing, direction);
  write_field(image, field, image_axes);
  vsc_angle_map_def map = default_map();
  map.image_axes = image_axes;
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  assert_int_equal(report.with_data, mesh->element_count);
  const double error = error_at(mesh, axes, field, part);
  if (!(error <= limit)) print_error("error %g degrees, allowed %g\n", error, limit);
  assert_true(error <= limit);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

static void turned(double angle, bool mirrored, double direction[9])
{
  const double c = cos(angle), s = sin(angle), z = mirrored ? -1 : 1;
  const double about_x[9] = {1, 0, 0, 0, 0.8, -0.6, 0, 0.6, 0.8};
  const double about_z[9] = {c, -s, 0, s, c, 0, 0, 0, z};
  for (int i = 0; i < 3; i++)
    for (int j = 0; j < 3; j++) {
      direction[3 * i + j] = 0;
      for (int k = 0; k < 3; k++) direction[3 * i + j] += about_x[3 * i + k] * about_z[3 * k + j];
    }
}

static void helix_at_a_quarter_of_the_wall(void **state)
{
  (void)state;
  const field helix = {.wall_helix = true};
  sampled_field_is(&helix, upright, true, wall / 4, 0.5, 1);
  sampled_field_is(&helix, upright, true, wall / 4, 1, 5);
  sampled_field_is(&helix, upright, true, wall / 16, 0.5, 0.4);
}

static void direction_matrix_is_honoured(void **state)
{
  (void)state;
  const field helix = {.wall_helix = true};
  double direction[9];
  for (int mirrored = 0; mirrored < 2; mirrored++) {
    turned(0.7, mirrored, direction);
    sampled_field_is(&helix, direction, true, wall / 4, 0.5, 1);
    sampled_field_is(&helix, direction, false, wall / 4, 0.5, 1);
  }
  const double left[9] = {1, 0, 0, 0, 1, 0, 0, 0, -1};
  sampled_field_is(&helix, left, true, wall / 4, 0.5, 1);
  const double swapped[9] = {0, 1, 0, 1, 0, 0, 0, 0, 1};
  sampled_field_is(&helix, swapped, true, wall / 4, 0.5, 1);
}

static void uniform_fields_come_back_exactly(void **state)
{
  (void)state;
  const double special[][3] = {{1, 0, 0}, {1, 1e-9, 0}, {-1, 1e-9, 0.3}, {0, 1, 0},
                               {0, 0, 1}, {1e-9, 0, 1}, {1, 0, -1}};
  double direction[9];
  turned(2.5, true, direction);
  for (size_t k = 0; k < 12; k++) {
    field uniform = {.direction = {chance() - 0.5, chance() - 0.5, chance() - 0.5}};
    if (k < 7) memcpy(uniform.direction, special[k], sizeof uniform.direction);
    // asin loses digits near 90 degrees of elevation
    sampled_field_is(&uniform, k % 2 == 0 ? upright : direction, true, k < 6 ? 3 : 1.1, 1, 3e-6);
  }
}

static void sign_of_a_fibre_does_not_matter(void **state)
{
  (void)state;
  vsc_mesh *mesh = slab(0.1);
  vsc_image *image = image_round_slab(wall / 4, upright);
  const field helix = {.wall_helix = true};
  write_field(image, &helix, true);
  const vsc_angle_map_def map = default_map();
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  for (size_t v = 0; v < voxels_of(image); v++) {
    image->data.items[0].values[v] += 180;
    image->data.items[1].values[v] *= -1;
  }
  vsc_axes *flipped = sample(mesh, image, &map, &report);
  for (size_t e = 0; e < mesh->element_count; e++)
    assert_close(axis_angle(&axes->frames[9 * e], &flipped->frames[9 * e]), 0, 0, 1e-11);
  vsc_axes_free(axes);
  vsc_axes_free(flipped);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

// Degrees from zero at +y, clockwise, elevation downwards, in tenths: the same fibres.
static void units_zero_and_senses(void **state)
{
  (void)state;
  vsc_mesh *mesh = slab(0.1);
  vsc_image *image = image_round_slab(2, upright);
  const field uniform = {.direction = {1, 2, 3}};
  write_field(image, &uniform, true);
  for (size_t v = 0; v < voxels_of(image); v++) {
    double *azimuth = &image->data.items[0].values[v], *elevation = &image->data.items[1].values[v];
    *azimuth = 10 * (25 - *azimuth);
    *elevation = -10 * *elevation;
  }
  vsc_angle_map_def map = default_map();
  map.scale = degree / 10;
  map.azimuth_zero = 25 * degree;
  map.azimuth_sense = -1;
  map.elevation_sense = -1;
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  assert_true(error_at(mesh, axes, &uniform, 1) < 1e-6);
  double azimuth, elevation;
  const double f[3] = {1 / sqrt(14), 2 / sqrt(14), 3 / sqrt(14)};
  vsc_fiber_angles(f, &azimuth, &elevation);
  for (int i = 0; i < 3; i++) {
    assert_close(report.azimuth[i], azimuth, 0, 1e-6);
    assert_close(report.elevation[i], elevation, 0, 1e-6);
    assert_close(report.coherence[i], 1, 0, 1e-12);
  }
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

// Every second voxel points elsewhere: masked, without weight, or outweighed.
static void masks_and_weights(void **state)
{
  (void)state;
  vsc_mesh *mesh = slab(0);
  vsc_image *image = image_round_slab(0.7, upright);
  const field uniform = {.direction = {3, 0, 4}};
  write_field(image, &uniform, true);
  vsc_array *array = image->data.items;
  for (size_t v = 0; v < voxels_of(image); v += 2) {
    array[0].values[v] = 90;
    array[1].values[v] = 0;
    array[2].values[v] = -1;
    array[3].values[v] = 0;
  }
  vsc_angle_map_def map = default_map();
  vsc_fiber_report report;
  vsc_copy_name(map.mask, "mask");
  vsc_axes *masked = sample(mesh, image, &map, &report);
  assert_true(error_at(mesh, masked, &uniform, 1) < 1e-6);
  map.mask[0] = '\0';
  vsc_copy_name(map.weight, "weight");
  vsc_axes *weighted = sample(mesh, image, &map, &report);
  assert_true(error_at(mesh, weighted, &uniform, 1) < 1e-6);
  for (size_t v = 0; v < voxels_of(image); v += 2) array[3].values[v] = 3;
  vsc_axes *outweighed = sample(mesh, image, &map, &report);
  const field other = {.direction = {0, 1, 0}};
  assert_true(error_at(mesh, outweighed, &other, 1) < 15);
  assert_close(report.coherence[1], 2.0 / 3, 0, 0.05);
  vsc_axes_free(masked);
  vsc_axes_free(weighted);
  vsc_axes_free(outweighed);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

// The wall's own mask cuts the neighbourhood of most elements of the ventricle.
static void ventricle_map_comes_back(void **state)
{
  (void)state;
  const vsc_lv_shape lv = vsc_lv_default();
  vsc_mesh *mesh = NULL;
  vsc_image *image = NULL;
  assert_int_equal(vsc_lv_mesh(&lv, &mesh, NULL), VSC_OK);
  assert_int_equal(vsc_lv_map(&lv, 60 * degree, -60 * degree, wall / 4, &image, NULL), VSC_OK);
  vsc_angle_map_def map = default_map();
  vsc_copy_name(map.mask, "tissue");
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  double *errors = test_malloc(mesh->element_count * sizeof *errors);
  for (size_t e = 0; e < mesh->element_count; e++) {
    double centre[3], frame[9];
    assert_true(axes->known[e]);
    vsc_mesh_element_centre(mesh, e, centre);
    vsc_lv_frame(&lv, centre, 60 * degree, -60 * degree, frame);
    errors[e] = axis_angle(frame, &axes->frames[9 * e]);
  }
  qsort(errors, mesh->element_count, sizeof *errors, by_value);
  print_message("ventricle: median error %.2f, 90th percentile %.2f degrees\n",
                errors[mesh->element_count / 2], errors[mesh->element_count * 9 / 10]);
  assert_true(errors[mesh->element_count / 2] < 0.9);
  assert_true(errors[mesh->element_count * 9 / 10] < 3);
  test_free(errors);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

// Only voxels beyond y = 7 hold data: elements below stay unknown until they are filled.
static void elements_without_data_are_unknown(void **state)
{
  (void)state;
  vsc_mesh *mesh = slab(0);
  vsc_image *image = image_round_slab(0.5, upright);
  const field uniform = {.direction = {1, 2, 3}};
  write_field(image, &uniform, true);
  for (size_t v = 0; v < voxels_of(image); v++) {
    double at[3];
    place_of(image, v, at);
    if (at[1] < 7) image->data.items[2].values[v] = 0;
  }
  vsc_angle_map_def map = default_map();
  vsc_copy_name(map.mask, "mask");
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  assert_int_equal(report.with_data + report.passive, mesh->element_count);
  assert_in_range(report.with_data, mesh->element_count / 4, mesh->element_count / 2);
  for (size_t e = 0; e < mesh->element_count; e++)
    if (!axes->known[e]) assert_close(axes->frames[9 * e], 1, 0, 0);
  size_t filled;
  assert_int_equal(vsc_fibers_fill(mesh, axes, &filled, NULL), VSC_OK);
  assert_int_equal(filled, report.passive);
  assert_true(error_at(mesh, axes, &uniform, 1) < 1e-6);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

// Random fibres: the mean over exactly the voxel centres in the tet, counted by brute force.
static void voxels_in_a_tet_are_all_found(void **state)
{
  (void)state;
  const double nodes[4][3] = {{1, 2, 3}, {9, 3, 2}, {4, 10, 1}, {3, 4, 12}};
  const uint32_t tet[4] = {0, 1, 2, 3};
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_mesh_from_arrays(4, &nodes[0][0], 1, tet, &mesh, NULL), VSC_OK);
  double direction[9], sum[6] = {0}, axis[3], values[3];
  turned(1.2, true, direction);
  vsc_image *image = image_round_slab(0.8, direction);
  size_t inside = 0;
  for (size_t v = 0; v < voxels_of(image); v++) {
    double at[3], f[3] = {chance() + 1, chance() - 0.5, chance() - 0.5};
    vsc_normalize(f);
    place_of(image, v, at);
    image->data.items[0].values[v] = atan2(f[1], f[0]);
    image->data.items[1].values[v] = asin(f[2]);
    if (vsc_tet_volume(at, nodes[1], nodes[2], nodes[3]) < 0 ||
        vsc_tet_volume(nodes[0], at, nodes[2], nodes[3]) < 0 ||
        vsc_tet_volume(nodes[0], nodes[1], at, nodes[3]) < 0 ||
        vsc_tet_volume(nodes[0], nodes[1], nodes[2], at) < 0)
      continue;
    inside++;
    const double square[6] = {f[0] * f[0], f[0] * f[1], f[0] * f[2],
                              f[1] * f[1], f[1] * f[2], f[2] * f[2]};
    for (int c = 0; c < 6; c++) sum[c] += square[c];
  }
  assert_in_range(inside, 100, 1000);
  assert_int_equal(vsc_top_axis(sum, axis, values), 1);
  vsc_angle_map_def map = default_map();
  map.scale = 1;
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  assert_int_equal(report.fallback, 0);
  assert_close(report.coherence[1], (values[0] - values[1]) / values[0], 1e-10, 0);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

// A hexahedron on the grid of voxels: those on the planes between its tets, and on its faces, count once.
static void voxels_between_tets_count_once(void **state)
{
  (void)state;
  enum { SIDE = 7 };
  static const double corners[8][3] = {{1, 1, 1}, {5, 1, 1}, {5, 5, 1}, {1, 5, 1},
                                       {1, 1, 5}, {5, 1, 5}, {5, 5, 5}, {1, 5, 5}};
  const uint8_t kind = VSC_HEX;
  vsc_mesh *mesh = vsc_mesh_create_cells(8, 1, &kind, 0);
  memcpy(mesh->nodes, corners, sizeof corners);
  for (uint32_t c = 0; c < 8; c++) mesh->corners[c] = c;
  vsc_image *image = vsc_image_create((size_t[3]){SIDE, SIDE, SIDE});
  vsc_array *azimuth = vsc_arrays_add(&image->data, "azimuth", 1, SIDE * SIDE * SIDE);
  assert_non_null(azimuth);
  assert_non_null(vsc_arrays_add(&image->data, "elevation", 1, SIDE * SIDE * SIDE));
  double sum[6] = {0}, axis[3], values[3];
  for (size_t v = 0; v < SIDE * SIDE * SIDE; v++) {
    const double angle = 2 * chance();
    image->data.items[0].values[v] = angle;
    const size_t at[3] = {v % SIDE, v / SIDE % SIDE, v / SIDE / SIDE};
    bool in = true;
    for (int a = 0; a < 3; a++) in = in && at[a] >= 1 && at[a] <= 5;
    if (!in) continue;
    sum[0] += cos(angle) * cos(angle);
    sum[1] += cos(angle) * sin(angle);
    sum[3] += sin(angle) * sin(angle);
  }
  assert_int_equal(vsc_top_axis(sum, axis, values), 1);
  vsc_angle_map_def map = default_map();
  map.scale = 1;
  vsc_fiber_report report;
  vsc_axes *axes = sample(mesh, image, &map, &report);
  assert_int_equal(report.fallback, 0);
  assert_close(report.coherence[1], (values[0] - values[1]) / values[0], 1e-12, 0);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(helix_at_a_quarter_of_the_wall),
      cmocka_unit_test(direction_matrix_is_honoured),
      cmocka_unit_test(uniform_fields_come_back_exactly),
      cmocka_unit_test(sign_of_a_fibre_does_not_matter),
      cmocka_unit_test(units_zero_and_senses),
      cmocka_unit_test(masks_and_weights),
      cmocka_unit_test(ventricle_map_comes_back),
      cmocka_unit_test(elements_without_data_are_unknown),
      cmocka_unit_test(voxels_in_a_tet_are_all_found),
      cmocka_unit_test(voxels_between_tets_count_once),
  };
  return cmocka_run_group_tests_name("fibers/sample", tests, NULL, NULL);
}
