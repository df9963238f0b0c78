// SPDX-License-Identifier: GPL-3.0-or-later
// Single axes: angles, top eigenvectors, and filling from neighbours.
#include "close.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/sample.h"
#include "tools/shapes.h"

static const double degree = M_PI / 180;

static uint64_t dice = 7;

static double chance(void)
{
  dice = dice * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return ldexp((double)(dice >> 11), -53);
}

static void random_axis(double f[3])
{
  do {
    for (int a = 0; a < 3; a++) f[a] = 2 * chance() - 1;
  } while (vsc_norm(f) < 0.1);
  vsc_normalize(f);
}

static void angles_give_the_axis_back(void **state)
{
  (void)state;
  for (int k = 0; k < 2000; k++) {
    double f[3], azimuth, elevation, other_azimuth, other_elevation;
    random_axis(f);
    if (k % 10 < 3) f[k % 10] = 0;
    if (k % 50 == 4) f[1] = (k % 100 == 4 ? 1e-20 : -1e-20) * f[0];
    if (k % 50 == 14) f[0] = f[1] = 0;
    if (k % 50 == 24) f[0] = -1, f[1] = f[2] = 0;
    vsc_normalize(f);
    const double opposite[3] = {-f[0], -f[1], -f[2]};
    vsc_fiber_angles(f, &azimuth, &elevation);
    vsc_fiber_angles(opposite, &other_azimuth, &other_elevation);
    assert_true(azimuth == other_azimuth && elevation == other_elevation);
    assert_true(azimuth >= 0 && azimuth < 180 && fabs(elevation) <= 90);
    const double level = cos(elevation * degree);
    const double back[3] = {level * cos(azimuth * degree), level * sin(azimuth * degree),
                            sin(elevation * degree)};
    assert_close(fabs(vsc_dot(back, f)), 1, 0, 1e-14);
  }
  double azimuth, elevation;
  const double f[3] = {-1, -1, sqrt(2)};
  vsc_fiber_angles(f, &azimuth, &elevation);
  assert_close(azimuth, 45, 0, 1e-12);
  assert_close(elevation, -45, 0, 1e-12);
}

// f f^T + a g g^T + b h h^T with orthonormal f, g, h and b < a < 1.
static void top_axis_of_a_known_matrix(void **state)
{
  (void)state;
  for (int k = 0; k < 500; k++) {
    double f[3], hint[3], frame[9], m[6], axis[3], values[3];
    random_axis(f);
    random_axis(hint);
    assert_int_equal(vsc_axes_complete(f, hint, frame), 1);
    const double a = 0.9 * chance(), b = a * chance(), scale = pow(10, 40 * (chance() - 0.5));
    const int row[6] = {0, 0, 0, 1, 1, 2}, column[6] = {0, 1, 2, 1, 2, 2};
    for (int c = 0; c < 6; c++)
      m[c] =
          scale * (frame[row[c]] * frame[column[c]] + a * frame[3 + row[c]] * frame[3 + column[c]] +
                   b * frame[6 + row[c]] * frame[6 + column[c]]);
    assert_int_equal(vsc_top_axis(m, axis, values), 1);
    assert_close(fabs(vsc_dot(axis, frame)), 1, 0, 1e-12);
    assert_close(values[0], scale, 1e-12, 0);
    assert_close(values[1], scale * a, 0, scale * 1e-12);
    assert_close(values[2], scale * b, 0, scale * 1e-12);
  }
  double axis[3];
  const double zero[6] = {0}, strange[6] = {1, 0, NAN, 1, 0, 1}, endless[6] = {INFINITY};
  assert_int_equal(vsc_top_axis(zero, axis, NULL), 0);
  assert_int_equal(vsc_top_axis(strange, axis, NULL), 0);
  assert_int_equal(vsc_top_axis(endless, axis, NULL), 0);
}

static vsc_mesh *bar(void)
{
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {.cells = {10, 2, 2}, .size = {10, 2, 2}, .tets_per_cell = 6};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  return mesh;
}

// Two known ends, z with its sheet along y, and (1, 0, 0.1) seen through both signs.
static vsc_axes *axes_with_known_ends(const vsc_mesh *mesh)
{
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  for (size_t e = 0; e < mesh->element_count; e++) {
    double centre[3];
    const double sign = e % 2 == 0 ? 1 : -1, low[3] = {0, 0, sign}, high[3] = {sign, 0, 0.1 * sign};
    const double sheet[3] = {0, sign, 0.2};
    vsc_mesh_element_centre(mesh, e, centre);
    if (centre[0] > 1 && centre[0] < 9) continue;
    vsc_axes_complete(centre[0] < 5 ? low : high, sheet, &axes->frames[9 * e]);
    axes->known[e] = 1;
  }
  return axes;
}

static void filling_spreads_from_both_ends(void **state)
{
  (void)state;
  vsc_mesh *mesh = bar();
  vsc_axes *axes = axes_with_known_ends(mesh), *again = axes_with_known_ends(mesh);
  size_t filled, filled_again;
  assert_int_equal(vsc_fibers_fill(mesh, axes, &filled, NULL), VSC_OK);
  assert_int_equal(vsc_fibers_fill(mesh, again, &filled_again, NULL), VSC_OK);
  assert_int_equal(filled, mesh->element_count * 8 / 10);
  assert_memory_equal(axes->frames, again->frames, 9 * mesh->element_count * sizeof(double));
  assert_true(vsc_axes_valid(axes));
  for (size_t e = 0; e < mesh->element_count; e++) {
    double centre[3];
    const double *f = &axes->frames[9 * e];
    assert_int_equal(axes->known[e], 1);
    vsc_mesh_element_centre(mesh, e, centre);
    if (centre[0] < 4) assert_close(fabs(f[2]), 1, 0, 1e-12);
    if (centre[0] < 4) assert_close(fabs(f[4]), 1, 0, 1e-12);
    if (centre[0] > 6) assert_close(fabs(f[0]), 1 / sqrt(1.01), 0, 1e-12);
  }
  assert_int_equal(vsc_fibers_fill(mesh, axes, &filled, NULL), VSC_OK);
  assert_int_equal(filled, 0);
  vsc_axes_free(axes);
  vsc_axes_free(again);
  vsc_mesh_free(mesh);
}

static void a_part_without_fibres_stays_without(void **state)
{
  (void)state;
  const double nodes[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                              {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
  const uint32_t tets[2][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_mesh_from_arrays(8, &nodes[0][0], 2, &tets[0][0], &mesh, NULL), VSC_OK);
  vsc_axes *axes = vsc_axes_create(2);
  axes->known[0] = 1;
  size_t filled;
  assert_int_equal(vsc_fibers_fill(mesh, axes, &filled, NULL), VSC_OK);
  assert_int_equal(filled, 0);
  assert_int_equal(axes->known[1], 0);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

static void little_memory_is_reported(void **state)
{
  (void)state;
  vsc_mesh *mesh = bar();
  vsc_axes *axes = axes_with_known_ends(mesh);
  size_t filled;
  vsc_status status = VSC_SYSTEM;
  long allowed = 0;
  for (; status != VSC_OK; allowed++) {
    vsc_alloc_fail_after(allowed);
    status = vsc_fibers_fill(mesh, axes, &filled, NULL);
    assert_true(status == VSC_OK || status == VSC_SYSTEM);
  }
  vsc_alloc_fail_after(-1);
  assert_true(allowed > 2);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(angles_give_the_axis_back),
      cmocka_unit_test(top_axis_of_a_known_matrix),
      cmocka_unit_test(filling_spreads_from_both_ends),
      cmocka_unit_test(a_part_without_fibres_stays_without),
      cmocka_unit_test(little_memory_is_reported),
  };
  return cmocka_run_group_tests_name("fibers/axis", tests, NULL, NULL);
}
