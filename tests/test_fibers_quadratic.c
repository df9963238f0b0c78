// SPDX-License-Identifier: GPL-3.0-or-later
// Axes at the four points of quadratic tets, from every source.
#include "close.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/fibers.h"
#include "mesh/quadratic.h"
#include "tools/shapes.h"

static const double degree = M_PI / 180;

// A block of quadratic tets in (0, 0, 0) to (6, 4, 2); its inner middles moved off their edges a little.
static vsc_mesh *block(void)
{
  const vsc_block_shape shape = {
      .cells = {6, 4, 2}, .size = {6, 4, 2}, .tets_per_cell = 5, .jitter = 0.1, .seed = 2};
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  const size_t corners = mesh->node_count;
  assert_int_equal(vsc_mesh_raise(&mesh, "block", NULL), VSC_OK);
  for (size_t n = corners; n < mesh->node_count; n++) {
    double *x = mesh->nodes + 3 * n;
    if (x[0] > 0.1 && x[0] < 5.9 && x[1] > 0.1 && x[1] < 3.9 && x[2] > 0.1 && x[2] < 1.9)
      x[n % 3] += 0.03;
  }
  assert_int_equal(vsc_mesh_check_folds(mesh, "block", NULL), VSC_OK);
  return mesh;
}

static vsc_axes *make(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                      const vsc_surface *surfaces, size_t count, vsc_fiber_report *report)
{
  vsc_axes *axes = NULL;
  vsc_error error = {.text = ""};
  if (vsc_fibers_make(mesh, definition, surfaces, count, &axes, report, &error) != VSC_OK)
    fail_msg("%s", error.text);
  assert_true(vsc_axes_valid(axes));
  assert_int_equal(axes->points, 4);
  assert_int_equal(report->elements, mesh->element_count);
  return axes;
}

// The place of a point: the mapped one, not the element's centre.
static void place_of(const vsc_mesh *mesh, size_t e, int q, double at[3])
{
  const vsc_cell_rule rule = vsc_cell_rule_of(VSC_TET10);
  memset(at, 0, 3 * sizeof *at);
  for (int i = 0; i < 10; i++)
    for (size_t a = 0; a < 3; a++)
      at[a] += rule.N[q][i] * mesh->nodes[3 * (size_t)vsc_mesh_corners(mesh, e)[i] + a];
}

typedef void fiber_of(const double at[3], double f[3]);

// The fibres' largest distance from those wanted, and its root mean square, radians.
static double worst_fibre(const vsc_mesh *mesh, const vsc_axes *axes, fiber_of *wanted, double *mean)
{
  double worst = 0;
  *mean = 0;
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int q = 0; q < 4; q++) {
      double at[3], f[3], across[3];
      place_of(mesh, e, q, at);
      wanted(at, f);
      vsc_normalize(f);
      vsc_cross(f, vsc_axes_frame(axes, e, q), across);
      assert_int_equal(axes->known[e], 1);
      worst = fmax(worst, vsc_norm(across));
      *mean += vsc_dot(across, across);
    }
  *mean = sqrt(*mean / (4 * (double)mesh->element_count));
  return worst;
}

static void assert_fibers(const vsc_mesh *mesh, const vsc_axes *axes, fiber_of *wanted,
                          double tolerance)
{
  double mean;
  const double worst = worst_fibre(mesh, axes, wanted, &mean);
  if (worst > tolerance) fail_msg("fibres are off by %g radians", worst);
}

static void round_the_middle(const double at[3], double f[3])
{
  const double r[2] = {at[0] - 3, at[1] - 2}, length = hypot(r[0], r[1]);
  f[0] = -cos(0.5) * r[1] / length;
  f[1] = cos(0.5) * r[0] / length;
  f[2] = sin(0.5);
}

static void formulas_are_evaluated_at_the_points(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = vsc_default_fiber();
  vsc_fiber_report report;
  definition.source = VSC_FIBER_HELICOIDAL;
  definition.pitch = 0.5;
  vsc_axes *axes = make(mesh, &definition, NULL, 0, &report);
  assert_int_equal(report.with_data, mesh->element_count);
  assert_fibers(mesh, axes, round_the_middle, 1e-13);
  vsc_axes_free(axes);
  // a random fibre is that of its element
  definition.source = VSC_FIBER_RANDOM;
  axes = make(mesh, &definition, NULL, 0, &report);
  for (size_t e = 0; e < mesh->element_count; e++)
    assert_memory_equal(vsc_axes_frame(axes, e, 3), vsc_axes_frame(axes, e, 0), 9 * sizeof(double));
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

static void select_side(const vsc_mesh *mesh, const char *array, vsc_surface *surface)
{
  vsc_surface boundary;
  vsc_selector selector = {.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
  vsc_copy_name(selector.name, array);
  vsc_copy_name(selector.array, array);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_select_surface(mesh, &boundary, &selector, surface, NULL), VSC_OK);
  vsc_surface_free(&boundary);
}

// From +60 degrees at x = 0 to -60 at x = 6; z leads to the base.
static void through_the_wall(const double at[3], double f[3])
{
  const double angle = (60 - 20 * at[0]) * degree;
  f[0] = 0;
  f[1] = cos(angle);
  f[2] = sin(angle);
}

// Depth is linear, which quadratic elements meet exactly but where edges are bent: there the four points
// leave a remainder, of the third power of the bend in the depth.
static void a_helix_turns_within_elements(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_surface sides[2];
  vsc_fiber_report report;
  vsc_fiber_def definition = vsc_default_fiber();
  definition.source = VSC_FIBER_HELIX;
  definition.endo_angle = 60 * degree;
  definition.epi_angle = -60 * degree;
  vsc_copy_name(definition.endo, "x0");
  vsc_copy_name(definition.epi, "x1");
  select_side(mesh, "x0", &sides[0]);
  select_side(mesh, "x1", &sides[1]);
  vsc_axes *axes = make(mesh, &definition, sides, 2, &report);
  assert_fibers(mesh, axes, through_the_wall, 2e-3);
  vsc_axes_free(axes);
  // straight edges
  vsc_mesh *straight = NULL;
  const vsc_block_shape shape = {
      .cells = {6, 4, 2}, .size = {6, 4, 2}, .tets_per_cell = 5, .jitter = 0.1, .seed = 2};
  assert_int_equal(vsc_block_mesh(&shape, &straight, NULL), VSC_OK);
  assert_int_equal(vsc_mesh_raise(&straight, "block", NULL), VSC_OK);
  axes = make(straight, &definition, sides, 2, &report);
  assert_fibers(straight, axes, through_the_wall, 1e-11);
  vsc_axes_free(axes);
  for (int s = 0; s < 2; s++) vsc_surface_free(&sides[s]);
  vsc_mesh_free(straight);
  vsc_mesh_free(mesh);
}

static void linear_field(const double at[3], double f[3])
{
  f[0] = 1 + 0.1 * at[1];
  f[1] = 0.2 * at[0] - 0.3 * at[2];
  f[2] = 0.4 * at[1];
}

// Vectors on nodes are interpolated, whatever the sign of each: f f^T, which leaves the third power of their turn of up
// to 0.5 radians from node to node; vectors on elements are the same at all points.
static void arrays_on_nodes_and_elements(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_report report;
  vsc_fiber_def definition = vsc_default_fiber();
  definition.source = VSC_FIBER_ARRAYS;
  double *on_nodes = vsc_arrays_add(&mesh->node_data, "fiber", 3, mesh->node_count)->values;
  for (size_t n = 0; n < mesh->node_count; n++) {
    linear_field(mesh->nodes + 3 * n, on_nodes + 3 * n);
    for (size_t a = 0; a < 3 && n % 5 == 0; a++) on_nodes[3 * n + a] *= -1;
  }
  vsc_axes *axes = make(mesh, &definition, NULL, 0, &report);
  assert_fibers(mesh, axes, linear_field, 0.02);
  assert_false(report.constant);
  vsc_axes_free(axes);
  double *on_elements = vsc_arrays_add(&mesh->element_data, "fiber", 3, mesh->element_count)->values;
  for (size_t e = 0; e < mesh->element_count; e++) on_elements[3 * e + e % 3] = e == 4 ? 0 : 1;
  axes = make(mesh, &definition, NULL, 0, &report);
  assert_int_equal(report.invalid, 1);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int q = 0; q < 4; q++) {
      assert_int_equal(axes->known[e], e != 4);
      assert_close(vsc_axes_frame(axes, e, q)[e == 4 ? 0 : e % 3], 1, 0, 0);
    }
  vsc_axes_free(axes);
  // filled from its neighbours, at all points
  definition.fill = true;
  axes = make(mesh, &definition, NULL, 0, &report);
  assert_int_equal(report.filled, 1);
  assert_int_equal(axes->known[4], 1);
  for (int q = 1; q < 4; q++)
    assert_memory_equal(vsc_axes_frame(axes, 4, q), vsc_axes_frame(axes, 4, 0), 9 * sizeof(double));
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

// Azimuth 30 degrees and 8 more for each mm along x.
static void turning_map(const double at[3], double f[3])
{
  const double azimuth = (30 + 8 * at[0]) * degree;
  f[0] = cos(azimuth);
  f[1] = sin(azimuth);
  f[2] = 0;
}

// Within an element the map's linear fit goes through its points: it turns by 8 degrees over 1 mm, so that
// one axis for all points is wrong by 2 in the mean. Where a point lies further from the mean of the
// element's voxels than these are followed, up to a degree remains.
static void maps_are_followed_within_elements(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = vsc_default_fiber();
  vsc_fiber_report report;
  const size_t size[3] = {36, 26, 16};
  vsc_image *image = vsc_image_create(size);
  for (int a = 0; a < 3; a++) {
    image->spacing[a] = 0.2;
    image->origin[a] = -0.5;
    image->direction[4 * a] = 1;
  }
  const size_t voxels = size[0] * size[1] * size[2];
  double *azimuth = vsc_arrays_add(&image->data, "azimuth", 1, voxels)->values;
  vsc_arrays_add(&image->data, "elevation", 1, voxels);
  azimuth = image->data.items[0].values;
  for (size_t v = 0; v < voxels; v++) azimuth[v] = 30 + 8 * (0.2 * (double)(v % size[0]) - 0.5);
  vsc_axes *axes = vsc_axes_create_for(mesh);
  vsc_error error;
  if (vsc_fibers_sample(mesh, image, &definition.map, axes, &report, &error) != VSC_OK)
    fail_msg("%s", error.text);
  double mean;
  assert_true(worst_fibre(mesh, axes, turning_map, &mean) < degree);
  assert_true(mean < 0.1 * degree);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(formulas_are_evaluated_at_the_points),
      cmocka_unit_test(a_helix_turns_within_elements),
      cmocka_unit_test(arrays_on_nodes_and_elements),
      cmocka_unit_test(maps_are_followed_within_elements),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
