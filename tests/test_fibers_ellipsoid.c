// SPDX-License-Identifier: GPL-3.0-or-later
// Fibres between two ellipsoids against the formulas that the benchmarks print.
#include <string.h>

#include "base/vec3.h"
#include "close.h"
#include "fibers/ellipsoid.h"
#include "fibers/fibers.h"
#include "mesh/quadratic.h"
#include "random.h"
#include "tools/shapes.h"

static const double degree = M_PI / 180;

static vsc_fiber_def land(void)
{
  vsc_fiber_def definition = vsc_default_fiber();
  definition.source = VSC_FIBER_ELLIPSOID;
  definition.ellipsoid = (vsc_ellipsoid_def){
      .endo_radius = 7, .endo_length = 17, .epi_radius = 10, .epi_length = 20};
  definition.endo_angle = 90 * degree;
  definition.epi_angle = -90 * degree;
  return definition;
}

static vsc_fiber_def arostica(void)
{
  vsc_fiber_def definition = vsc_default_fiber();
  definition.source = VSC_FIBER_ELLIPSOID;
  definition.ellipsoid = (vsc_ellipsoid_def){
      .endo_radius = 25, .endo_length = 90, .epi_radius = 35, .epi_length = 97};
  definition.long_axis[0] = 2;
  definition.long_axis[2] = 0;
  return definition;
}

// Land et al. 2015, problem 3: x = (rs sin u cos v, rs sin u sin v, rl cos u), u in [-pi, 0),
// f = n(dx/du) sin alpha + n(dx/dv) cos alpha, alpha = 90 - 180 t degrees. To 1e-9: near the apex the
// azimuth of the point has lost digits, 1e-16 over sin u.
static void the_fibres_of_land(void **state)
{
  (void)state;
  const vsc_fiber_def definition = land();
  uint64_t seed = 5;
  for (int k = 0; k < 1000; k++) {
    const double t = random_between(&seed, 0.001, 0.999), rs = 7 + 3 * t, rl = 17 + 3 * t;
    const double u = random_between(&seed, -M_PI + 1e-2, -acos(5 / rl));
    const double v = random_between(&seed, -M_PI, M_PI), alpha = (90 - 180 * t) * degree;
    const double point[3] = {rs * sin(u) * cos(v), rs * sin(u) * sin(v), rl * cos(u)};
    double x_u[3] = {rs * cos(u) * cos(v), rs * cos(u) * sin(v), -rl * sin(u)};
    double x_v[3] = {-rs * sin(u) * sin(v), rs * sin(u) * cos(v), 0}, frame[9], outwards[3];
    assert_close(vsc_ellipsoid_depth(&definition.ellipsoid, definition.long_axis, point), t, 0, 1e-12);
    vsc_ellipsoid_normal(&definition.ellipsoid, definition.long_axis, point, t, outwards);
    vsc_normalize(x_u);
    vsc_normalize(x_v);
    vsc_normalize(outwards);
    assert_close(vsc_dot(outwards, x_u), 0, 0, 1e-12);
    assert_close(vsc_dot(outwards, x_v), 0, 0, 1e-12);
    assert_int_equal(vsc_ellipsoid_frame(&definition, point, frame), 1);
    for (int a = 0; a < 3; a++) {
      assert_close(frame[a], x_u[a] * sin(alpha) + x_v[a] * cos(alpha), 0, 1e-9);
      assert_close(frame[3 + a], outwards[a], 0, 1e-9);
    }
  }
}

// Arostica et al. 2025: apex at -x, x = (rl cos u, rs sin u cos v, rs sin u sin v),
// f = sin alpha e_u + cos alpha e_v, alpha = -60 + 120 t degrees, n = e_u x e_v, moved off the origin.
static void the_fibres_of_arostica(void **state)
{
  (void)state;
  vsc_fiber_def definition = arostica();
  const double centre[3] = {3, -40, 11};
  memcpy(definition.ellipsoid.centre, centre, sizeof centre);
  uint64_t seed = 6;
  for (int k = 0; k < 1000; k++) {
    const double t = random_between(&seed, 0.001, 0.999), rs = 25 + 10 * t, rl = 90 + 7 * t;
    const double u = random_between(&seed, acos(5 / 17.), M_PI - 1e-2);
    const double v = random_between(&seed, -M_PI, M_PI), alpha = (-60 + 120 * t) * degree;
    const double point[3] = {centre[0] + rl * cos(u), centre[1] + rs * sin(u) * cos(v),
                             centre[2] + rs * sin(u) * sin(v)};
    double e_u[3] = {-rl * sin(u), rs * cos(u) * cos(v), rs * cos(u) * sin(v)}, across[3];
    const double e_v[3] = {0, -sin(v), cos(v)};
    double frame[9];
    vsc_normalize(e_u);
    vsc_cross(e_u, e_v, across);
    assert_int_equal(vsc_ellipsoid_frame(&definition, point, frame), 1);
    for (int a = 0; a < 3; a++)
      assert_close(frame[a], sin(alpha) * e_u[a] + cos(alpha) * e_v[a], 0, 1e-9);
    assert_close(fabs(vsc_dot(across, frame + 3)), 1, 0, 1e-9);
  }
}

// The benchmark's n0 goes through the wall, s0 = f0 x n0 lies within it.
static void sheets_within_the_wall(void **state)
{
  (void)state;
  vsc_fiber_def definition = arostica();
  const double point[3] = {-20, 18, 21};
  double through[9], within[9], s0[3];
  assert_int_equal(vsc_ellipsoid_frame(&definition, point, through), 1);
  definition.ellipsoid.sheet_within = true;
  assert_int_equal(vsc_ellipsoid_frame(&definition, point, within), 1);
  vsc_cross(through, through + 3, s0);
  for (int a = 0; a < 3; a++) {
    assert_close(within[a], through[a], 0, 0);
    assert_close(within[3 + a], s0[a], 0, 1e-15);
    assert_close(within[6 + a], -through[3 + a], 0, 0);
  }
}

// A right-handed helix climbs to the base while it turns anti-clockwise, seen from there.
static void inner_fibres_are_right_handed(void **state)
{
  (void)state;
  const double low[3] = {7.3, 0, 0}, side[3] = {0, 27, 0};
  double frame[9];
  const vsc_fiber_def of_land = land(), of_arostica = arostica();
  assert_int_equal(vsc_ellipsoid_frame(&of_land, low, frame), 1);
  assert_true(frame[1] * frame[2] > 0.1);  // +y there is anti-clockwise about +z, the base
  assert_int_equal(vsc_ellipsoid_frame(&of_arostica, side, frame), 1);
  assert_true(frame[2] * frame[0] > 0.1);  // +z there is anti-clockwise about +x, the base
}

static void points_beside_the_wall_have_its_angles(void **state)
{
  (void)state;
  const vsc_fiber_def definition = arostica();
  const double inside[3] = {0, 24, 0}, outside[3] = {0, 0, 37}, centre[3] = {0};
  double frame[9] = {7};
  assert_int_equal(vsc_ellipsoid_frame(&definition, centre, frame), 0);
  assert_true(frame[0] == 7);
  assert_int_equal(vsc_ellipsoid_frame(&definition, inside, frame), 1);
  assert_close(frame[0], sin(60 * degree), 1e-12, 0);
  assert_int_equal(vsc_ellipsoid_frame(&definition, outside, frame), 1);
  assert_close(frame[0], sin(-60 * degree), 1e-12, 0);
}

// Of linear tets at their centres, of quadratic ones at each of their points.
static void elements_take_the_fibres_of_their_places(void **state)
{
  (void)state;
  const vsc_fiber_def definition = land();
  const vsc_lv_shape shape = {.endo_radius = 7, .endo_length = 17, .epi_radius = 10, .epi_length = 20,
                              .base = 5, .around = 8, .along = 4, .layers = 2};
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_lv_mesh(&shape, &mesh, NULL), VSC_OK);
  for (int order = 1; order <= 2; order++) {
    if (order == 2) assert_int_equal(vsc_mesh_raise(&mesh, "mesh", NULL), VSC_OK);
    vsc_axes *axes;
    vsc_fiber_report report;
    assert_int_equal(vsc_fibers_make(mesh, &definition, NULL, 0, &axes, &report, NULL), VSC_OK);
    assert_int_equal(axes->points, order == 1 ? 1 : 4);
    assert_true(vsc_axes_valid(axes));
    const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);
    for (size_t e = 0; e < mesh->element_count; e++)
      for (int q = 0; q < axes->points; q++) {
        double at[3], frame[9];
        vsc_axes_place(axes, mesh, &rule, e, q, at);
        assert_int_equal(vsc_ellipsoid_frame(&definition, at, frame), 1);
        for (int i = 0; i < 9; i++) assert_close(vsc_axes_frame(axes, e, q)[i], frame[i], 0, 1e-14);
      }
    vsc_axes_free(axes);
  }
  vsc_mesh_free(mesh);
}

static void refuse(const vsc_fiber_def *definition, const char *words)
{
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = vsc_block_default();
  vsc_axes *axes;
  vsc_fiber_report report;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  assert_int_equal(vsc_fibers_make(mesh, definition, NULL, 0, &axes, &report, &error), VSC_INPUT);
  if (strstr(error.text, words) == NULL) fail_msg("%s", error.text);
  vsc_mesh_free(mesh);
}

static void bad_walls_are_refused(void **state)
{
  (void)state;
  vsc_fiber_def definition = land();
  definition.ellipsoid.epi_radius = 6;
  refuse(&definition, "endo_radius 7 and endo_length 17 mm");
  definition = land();
  definition.ellipsoid.endo_length = 0;
  refuse(&definition, "above 0");
  definition = land();
  definition.long_axis[2] = 0;
  refuse(&definition, "long_axis (0, 0, 0)");
  definition = land();
  definition.ellipsoid.centre[1] = NAN;
  refuse(&definition, "centre finite");
  definition = land();
  definition.epi_angle = INFINITY;
  refuse(&definition, "angles");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_fibres_of_land),
      cmocka_unit_test(the_fibres_of_arostica),
      cmocka_unit_test(sheets_within_the_wall),
      cmocka_unit_test(inner_fibres_are_right_handed),
      cmocka_unit_test(points_beside_the_wall_have_its_angles),
      cmocka_unit_test(elements_take_the_fibres_of_their_places),
      cmocka_unit_test(bad_walls_are_refused),
  };
  return cmocka_run_group_tests_name("fibers/ellipsoid", tests, NULL, NULL);
}
