// SPDX-License-Identifier: GPL-3.0-or-later
// The transmural helix: its convention, the depth of the wall, the ventricle.
#include "close.h"

#include <math.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/fibers.h"
#include "fibers/helix.h"
#include "tools/shapes.h"
#include "trap.h"

static const double degree = M_PI / 180;

static void select_surface(const vsc_mesh *mesh, const char *array, vsc_surface *surface)
{
  vsc_surface boundary = {.count = 0};
  vsc_selector selector = {.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
  vsc_copy_name(selector.name, array);
  vsc_copy_name(selector.array, array);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_select_surface(mesh, &boundary, &selector, surface, NULL), VSC_OK);
  vsc_surface_free(&boundary);
}

// On +x of a ventricle about z, +60 degrees climbs to the base while it turns anti-clockwise.
static void positive_angles_are_right_handed(void **state)
{
  (void)state;
  const double outwards[3] = {2, 0, 0.5}, axis[3] = {0, 0, 3};
  double frame[9];
  assert_int_equal(vsc_helix_frame(outwards, axis, 60 * degree, frame), 1);
  const double slope = atan2(0.5, 2);
  assert_close(frame[1], cos(60 * degree), 0, 1e-12);
  assert_close(frame[2], sin(60 * degree) * cos(slope), 0, 1e-12);
  assert_close(frame[3], cos(slope), 0, 1e-12);
  assert_close(frame[5], sin(slope), 0, 1e-12);
  double normal[3];
  vsc_cross(frame, frame + 3, normal);
  for (int a = 0; a < 3; a++) assert_close(frame[6 + a], normal[a], 0, 1e-12);
}

// Arostica et al. 2025: axis x towards the base, alpha = -60 + 120 t about the unit vector e_u that
// points to the apex.
static void agrees_with_the_benchmark_of_arostica(void **state)
{
  (void)state;
  const double axis[3] = {1, 0, 0};
  for (int k = 1; k < 200; k++) {
    const double t = k % 11 / 10.0, rs = 25 + 10 * t, rl = 90 + 7 * t, u = 0.01 * k, v = 0.37 * k;
    double e_u[3] = {-rl * sin(u), rs * cos(u) * cos(v), rs * cos(u) * sin(v)};
    const double e_v[3] = {0, -sin(v), cos(v)}, alpha = (-60 + 120 * t) * degree;
    vsc_normalize(e_u);
    double fiber[3], frame[9];
    for (int a = 0; a < 3; a++) fiber[a] = sin(alpha) * e_u[a] + cos(alpha) * e_v[a];
    const double outwards[3] = {cos(u) / rl, sin(u) * cos(v) / rs, sin(u) * sin(v) / rs};
    assert_int_equal(vsc_helix_frame(outwards, axis, (60 - 120 * t) * degree, frame), 1);
    assert_close(fabs(vsc_dot(fiber, frame)), 1, 0, 1e-12);
  }
}

static void apex_and_nonsense(void **state)
{
  (void)state;
  const double down[3] = {0, 0, -1}, axis[3] = {0, 0, 1}, zero[3] = {0}, strange[3] = {1, NAN, 0};
  double frame[9] = {7};
  assert_int_equal(vsc_helix_frame(zero, axis, 1, frame), 0);
  trap_off();
  assert_int_equal(vsc_helix_frame(strange, axis, 1, frame), 0);
  trap_on();
  assert_int_equal(vsc_helix_frame(down, zero, 1, frame), 0);
  assert_close(frame[0], 7, 0, 0);
  assert_int_equal(vsc_helix_frame(down, axis, 1, frame), 1);
  vsc_axes one = {.count = 1, .frames = frame};
  assert_true(vsc_axes_valid(&one));
  assert_close(fabs(frame[5]), 1, 0, 1e-12);
}

// On a slab the depth is linear, whatever the tets.
static void depth_of_a_slab_is_linear(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {
      .cells = {5, 4, 6}, .size = {10, 8, 9}, .tets_per_cell = 6, .jitter = 0.25, .seed = 5};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  vsc_surface endo, epi;
  select_surface(mesh, "z0", &endo);
  select_surface(mesh, "z1", &epi);
  double *depth = vsc_alloc(mesh->node_count, sizeof *depth);
  assert_int_equal(vsc_helix_depth(mesh, &endo, &epi, depth, NULL), VSC_OK);
  for (size_t i = 0; i < mesh->node_count; i++)
    assert_close(depth[i], mesh->nodes[3 * i + 2] / 9, 0, 1e-12);
  vsc_free(depth);
  vsc_surface_free(&endo);
  vsc_surface_free(&epi);
  vsc_mesh_free(mesh);
}

// The depth is 0.5 on the edge that two touching surfaces share, and stays within 0 and 1.
static void surfaces_may_share_nodes(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {.cells = {3, 3, 3}, .size = {3, 3, 3}, .tets_per_cell = 5};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  vsc_surface endo, epi;
  select_surface(mesh, "x0", &endo);
  select_surface(mesh, "z0", &epi);
  double *depth = vsc_alloc(mesh->node_count, sizeof *depth);
  assert_int_equal(vsc_helix_depth(mesh, &endo, &epi, depth, NULL), VSC_OK);
  for (size_t i = 0; i < mesh->node_count; i++) {
    const bool x0 = mesh->nodes[3 * i] == 0, z0 = mesh->nodes[3 * i + 2] == 0;
    if (x0 || z0) assert_close(depth[i], x0 && z0 ? 0.5 : z0, 0, 0);
    assert_true(depth[i] >= 0 && depth[i] <= 1);
  }
  vsc_free(depth);
  vsc_surface_free(&endo);
  vsc_surface_free(&epi);
  vsc_mesh_free(mesh);
}

static void a_loose_part_is_refused(void **state)
{
  (void)state;
  const double nodes[8][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1},
                              {5, 0, 0}, {6, 0, 0}, {5, 1, 0}, {5, 0, 1}};
  const uint32_t tets[2][4] = {{0, 1, 2, 3}, {4, 5, 6, 7}};
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_mesh_from_arrays(8, &nodes[0][0], 2, &tets[0][0], &mesh, NULL), VSC_OK);
  uint32_t first[3] = {0, 1, 2}, second[3] = {1, 2, 3};
  const vsc_surface endo = {.count = 1, .triangles = first},
                    epi = {.count = 1, .triangles = second};
  double depth[8];
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_helix_depth(mesh, &endo, &epi, depth, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "node 4 "));
  vsc_mesh_free(mesh);
}

// The angle of a fibre about the ellipsoid's own axes at a point of the wall, degrees.
static double helix_angle(const vsc_lv_shape *lv, const double at[3], const double f[3])
{
  double level[9], steep[9];
  vsc_lv_frame(lv, at, 0, 0, level);
  vsc_lv_frame(lv, at, 90 * degree, 90 * degree, steep);
  const double c = vsc_dot(f, level), l = vsc_dot(f, steep);
  return atan(l / c) / degree;
}

static vsc_fiber_def helix_definition(void)
{
  vsc_fiber_def definition = vsc_default_fiber();
  definition.source = VSC_FIBER_HELIX;
  vsc_copy_name(definition.endo, "endo");
  vsc_copy_name(definition.epi, "epi");
  return definition;
}

// With ten layers the outermost tets are within 1/10 of the wall, 12 degrees, of +60 and -60.
static void ventricle_has_its_angles(void **state)
{
  (void)state;
  vsc_lv_shape lv = vsc_lv_default();
  lv.layers = 10;
  vsc_mesh *mesh = NULL;
  vsc_surface surfaces[2];
  assert_int_equal(vsc_lv_mesh(&lv, &mesh, NULL), VSC_OK);
  select_surface(mesh, "endo", &surfaces[0]);
  select_surface(mesh, "epi", &surfaces[1]);
  const vsc_fiber_def definition = helix_definition();
  vsc_axes *axes;
  vsc_fiber_report report;
  assert_int_equal(vsc_fibers_make(mesh, &definition, surfaces, 2, &axes, &report, NULL), VSC_OK);
  assert_true(vsc_axes_valid(axes));
  assert_int_equal(report.with_data, mesh->element_count);
  double sum[2] = {0}, worst = 0, radial = 1;
  size_t count[2] = {0};
  for (size_t e = 0; e < mesh->element_count; e++) {
    double at[3], frame[9];
    vsc_mesh_element_centre(mesh, e, at);
    const double t = vsc_lv_depth(&lv, at), *f = &axes->frames[9 * e];
    if ((t > 0.1 && t < 0.9) || at[2] < -0.9 * lv.endo_length) continue;
    vsc_lv_frame(&lv, at, 0, 0, frame);
    radial = fmin(radial, vsc_dot(frame + 3, f + 3));
    const int side = t > 0.5;
    const double angle = helix_angle(&lv, at, f);
    sum[side] += angle;
    count[side]++;
    worst = fmax(worst, fabs(angle - (side == 0 ? 60 : -60)));
  }
  print_message(
      "helix: %.1f inside, %.1f outside, worst %.1f degrees off; sheet . radius >= %.3f\n",
      sum[0] / (double)count[0], sum[1] / (double)count[1], worst, radial);
  assert_close(sum[0] / (double)count[0], 54, 0, 3);
  assert_close(sum[1] / (double)count[1], -54, 0, 3);
  assert_true(worst < 20);
  assert_true(radial > 0.9);
  vsc_axes_free(axes);
  vsc_surface_free(&surfaces[0]);
  vsc_surface_free(&surfaces[1]);
  vsc_mesh_free(mesh);
}

// The boundary as epicardium is what it has beside the endocardium, here the side z = 0 of a block: below the middle of
// the block the wall begins there, and the 16 nodes round that side are on both. A surface that has nothing else is
// refused.
static void a_boundary_begins_where_the_endocardium_ends(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {.cells = {4, 4, 2}, .size = {40, 40, 3}, .tets_per_cell = 6};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  vsc_surface surfaces[3];
  select_surface(mesh, "z0", &surfaces[0]);
  select_surface(mesh, "z0", &surfaces[1]);
  assert_int_equal(vsc_boundary(mesh, &surfaces[2], NULL), VSC_OK);
  vsc_copy_name(surfaces[1].name, "again");
  vsc_surface rest;
  assert_int_equal(vsc_surface_without(&surfaces[2], &surfaces[0], &rest, NULL), VSC_OK);
  assert_int_equal(surfaces[0].count, 32);
  assert_int_equal(rest.count, surfaces[2].count - 32);
  for (size_t t = 0; t < rest.count; t++) {
    double height = 0;
    for (int i = 0; i < 3; i++) height += mesh->nodes[3 * (size_t)rest.triangles[3 * t + (size_t)i] + 2];
    assert_true(height > 0);
  }
  vsc_fiber_def definition = helix_definition();
  vsc_axes *axes = NULL;
  vsc_fiber_report report;
  vsc_error error = {.text = ""};
  vsc_copy_name(definition.endo, "z0");
  vsc_copy_name(definition.epi, "boundary");
  definition.long_axis[1] = 1;
  assert_int_equal(vsc_fibers_make(mesh, &definition, surfaces, 3, &axes, &report, &error), VSC_OK);
  assert_int_equal(report.meeting, 16);
  for (size_t e = 0; e < mesh->element_count; e++) {
    double at[3];
    vsc_mesh_element_centre(mesh, e, at);
    if (fabs(at[0] - 20) > 10 || fabs(at[1] - 20) > 10 || at[2] > 1.5) continue;
    const double *frame = vsc_axes_frame(axes, e, 0), depth = at[2] / 3;
    assert_true(frame[5] > 0.99);
    assert_close(atan(frame[1] / frame[0]) / degree, 60 - 120 * depth, 0, 2);
  }
  vsc_axes_free(axes);
  vsc_copy_name(definition.epi, "again");
  assert_int_equal(vsc_fibers_make(mesh, &definition, surfaces, 3, &axes, &report, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "every triangle of epi, 'again', is one of endo, 'z0', too"));
  vsc_surface_free(&rest);
  for (int s = 0; s < 3; s++) vsc_surface_free(&surfaces[s]);
  vsc_mesh_free(mesh);
}

static void missing_surfaces_and_memory(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {.cells = {2, 2, 2}, .size = {3, 3, 3}, .tets_per_cell = 5};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  vsc_surface surfaces[2];
  select_surface(mesh, "x0", &surfaces[0]);
  select_surface(mesh, "x1", &surfaces[1]);
  vsc_fiber_def definition = helix_definition();
  vsc_axes *axes;
  vsc_fiber_report report;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_fibers_make(mesh, &definition, surfaces, 2, &axes, &report, &error),
                   VSC_INPUT);
  assert_non_null(strstr(error.text, "'endo' for the endocardium, known surfaces: x0, x1"));
  vsc_copy_name(definition.endo, "x0");
  vsc_copy_name(definition.epi, "x1");
  definition.long_axis[2] = 0;
  assert_int_equal(vsc_fibers_make(mesh, &definition, surfaces, 2, &axes, &report, &error),
                   VSC_INPUT);
  assert_non_null(strstr(error.text, "long axis"));
  definition.long_axis[2] = 1;
  definition.epi_angle = NAN;
  trap_off();
  assert_int_equal(vsc_fibers_make(mesh, &definition, surfaces, 2, &axes, &report, &error),
                   VSC_INPUT);
  trap_on();
  definition.epi_angle = 0;
  vsc_status status = VSC_SYSTEM;
  long allowed = 0;
  for (; status != VSC_OK; allowed++) {
    vsc_alloc_fail_after(allowed);
    status = vsc_fibers_make(mesh, &definition, surfaces, 2, &axes, &report, NULL);
    assert_true(status == VSC_OK || status == VSC_SYSTEM);
  }
  vsc_alloc_fail_after(-1);
  assert_true(allowed > 8);
  vsc_axes_free(axes);
  vsc_surface_free(&surfaces[0]);
  vsc_surface_free(&surfaces[1]);
  vsc_mesh_free(mesh);
}

// All four nodes of the first tet lie on the endocardium: it takes the gradient of its
// surroundings.
static void a_flat_tet_takes_its_neighbours_gradient(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {.cells = {1, 1, 2}, .size = {2, 2, 2}, .tets_per_cell = 6};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  uint32_t lower[12], upper[3] = {8, 9, 11};
  for (int i = 0; i < 4; i++)
    for (int j = 0; j < 3; j++) lower[3 * i + j] = mesh->corners[(i + j) % 4];
  const vsc_surface endo = {.count = 4, .triangles = lower}, epi = {.count = 1, .triangles = upper};
  vsc_fiber_def definition = helix_definition();
  definition.long_axis[0] = 1;
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  assert_int_equal(vsc_fibers_helix(mesh, &definition, &endo, &epi, axes, NULL), VSC_OK);
  assert_int_equal(axes->known[0], 1);
  assert_true(vsc_axes_valid(axes));
  assert_true(axes->frames[5] > 0.5);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(positive_angles_are_right_handed),
      cmocka_unit_test(agrees_with_the_benchmark_of_arostica),
      cmocka_unit_test(apex_and_nonsense),
      cmocka_unit_test(depth_of_a_slab_is_linear),
      cmocka_unit_test(surfaces_may_share_nodes),
      cmocka_unit_test(a_loose_part_is_refused),
      cmocka_unit_test(ventricle_has_its_angles),
      cmocka_unit_test(a_boundary_begins_where_the_endocardium_ends),
      cmocka_unit_test(missing_surfaces_and_memory),
      cmocka_unit_test(a_flat_tet_takes_its_neighbours_gradient),
  };
  return cmocka_run_group_tests_name("fibers/helix", tests, NULL, NULL);
}
