// SPDX-License-Identifier: GPL-3.0-or-later
// Walls of bricks in elements of several kinds: the benchmarks' ventricles, Cook's membrane, cylinders and
// spheres.
#include "close.h"

#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/ellipsoid.h"
#include "fibers/helix.h"
#include "mesh/quality.h"
#include "mesh/select.h"
#include "mesh/surface.h"
#include "mesh/topology.h"
#include "tools/shapes.h"
#include "tools/shapes_shells.h"
#include "ventricle_volume.h"

static const vsc_block_kind kinds[3] = {VSC_BLOCK_TETS, VSC_BLOCK_HEXES, VSC_BLOCK_WEDGES};
static const size_t pieces[3] = {5, 1, 2};

// A sound mesh: elements are right-handed, neighbours fit, and the surface is that of a ball. Returns its
// volume, mm^3.
static double volume_of(const vsc_mesh *mesh)
{
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    assert_true(vsc_mesh_element_volume(mesh, e) > 0);
    volume += vsc_mesh_element_volume(mesh, e);
  }
  vsc_topology topology = {0};
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 0);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int f = 0; f < VSC_MOST_FACES; f++)
      assert_int_not_equal(topology.neighbours[e][f], VSC_SPLIT);
  vsc_topology_free(&topology);
  vsc_surface boundary = {.count = 0};
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  uint8_t *outside = test_calloc(mesh->node_count, 1);
  size_t nodes = 0;
  for (size_t i = 0; i < 3 * boundary.count; i++) {
    nodes += !outside[boundary.triangles[i]];
    outside[boundary.triangles[i]] = 1;
  }
  assert_int_equal(boundary.count, 2 * nodes - 4);
  test_free(outside);
  vsc_surface_free(&boundary);
  return volume;
}

static const double *marks(const vsc_mesh *mesh, const char *name)
{
  const vsc_array *array = vsc_arrays_find(&mesh->node_data, name);
  assert_non_null(array);
  return array->values;
}

static vsc_mesh *ventricle(const vsc_lv_shape *shape)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {.text = ""};
  if (vsc_lv_mesh(shape, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

// Volumes of the benchmark's own figures, mm^3; the mesh is within 5 % of the wall's.
static void the_ventricle_of_land(void **state)
{
  (void)state;
  vsc_lv_shape shape = vsc_lv_land();
  assert_close(ventricle_volume(&shape, 0), 2492.127, 0, 1e-3);
  assert_close(ventricle_volume(&shape, 1) - ventricle_volume(&shape, 0), 3234.734, 0, 1e-3);
  vsc_mesh *mesh = ventricle(&shape);
  assert_int_equal(mesh->element_count, 2080);
  assert_close(volume_of(mesh), 3234.734, 0.05, 0);
  double lowest = 0;
  for (size_t i = 0; i < mesh->node_count; i++) {
    const double z = mesh->nodes[3 * i + 2];
    assert_int_equal(marks(mesh, "base")[i] == 1, z == 5);
    lowest = fmin(lowest, z);
  }
  assert_close(lowest, -20, 1e-15, 0);
  vsc_mesh_free(mesh);
  shape.around = 24;
  shape.along = 24;
  shape.layers = 3;
  mesh = ventricle(&shape);
  assert_in_range(mesh->element_count, 9000, 10000);
  assert_close(volume_of(mesh), 3234.734, 0.02, 0);
  vsc_mesh_free(mesh);
}

// Rings at cos u = 5/17 and 5/20 and straight lines between them, apexes at x = -90 and -97.
static void the_ventricle_of_arostica(void **state)
{
  (void)state;
  const vsc_lv_shape shape = vsc_lv_arostica();
  vsc_mesh *mesh = ventricle(&shape);
  volume_of(mesh);
  const double x_0 = 90 * 5. / 17, x_1 = 97 * 5. / 20;
  const double r_0 = 25 * sqrt(1 - 25. / 289), r_1 = 35 * sqrt(1 - 25. / 400);
  double first[2] = {0};
  size_t on_base = 0;
  for (size_t i = 0; i < mesh->node_count; i++) {
    const double *x = &mesh->nodes[3 * i], r = hypot(x[1], x[2]), depth = vsc_lv_depth(&shape, x);
    assert_int_equal(marks(mesh, "endo")[i] == 1, fabs(depth) < 1e-9);
    assert_int_equal(marks(mesh, "epi")[i] == 1, fabs(depth - 1) < 1e-9);
    if (fabs(depth) < 1e-9) first[0] = fmin(first[0], x[0]);
    first[1] = fmin(first[1], x[0]);
    const double part = (r - r_0) / (r_1 - r_0), line = x_0 + part * (x_1 - x_0);
    if (marks(mesh, "base")[i] == 0) {
      assert_true(x[0] < line - 1);
      continue;
    }
    on_base++;
    assert_true(part > -1e-12 && part < 1 + 1e-12);
    assert_close(x[0], line, 0, 1e-12);
    if (marks(mesh, "endo")[i] == 1) assert_close(x[0], x_0, 1e-14, 0);
    if (marks(mesh, "rim")[i] == 1) assert_close(x[0], x_1, 1e-14, 0);
  }
  assert_int_equal(on_base, shape.around * (shape.layers + 1));
  assert_close(first[0], -90, 1e-14, 0);
  assert_close(first[1], -97, 1e-14, 0);
  vsc_mesh_free(mesh);
}

// Of the published mesh: areas 155.26, 228.51 and 18.577 cm^2, wall 177.69 ml, at edges of 4.5 mm; of this
// finer one within 0.3 % of what the published mesh and the round shape leave open.
static void surfaces_of_arostica(void **state)
{
  (void)state;
  vsc_lv_shape shape = vsc_lv_arostica();
  shape.around = 64;
  shape.along = 40;
  for (int k = 0; k < 3; k++) {
    shape.element = kinds[k];
    vsc_mesh *mesh = ventricle(&shape);
    vsc_surface boundary = {.count = 0};
    assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
    assert_int_equal(mesh->triangle_count, boundary.count);
    vsc_surface_free(&boundary);
    const vsc_array *part = vsc_arrays_find(&mesh->triangle_data, "surface");
    const char *const names[3] = {"endo", "epi", "base"};
    double area[3] = {0};
    for (size_t t = 0; t < mesh->triangle_count; t++) {
      const int which = (int)part->values[t] - 1;
      assert_in_range(which, 0, 2);
      for (size_t i = 3 * t; i < 3 * t + 3; i++)
        assert_true(marks(mesh, names[which])[mesh->triangles[i]] == 1);
      const vsc_surface one = {.count = 1, .triangles = &mesh->triangles[3 * t]};
      area[which] += vsc_surface_area(&one, mesh->nodes, 3) / 100;
    }
    const double wall = volume_of(mesh) / 1000;
    print_message("areas %.2f %.2f %.3f cm2, wall %.2f ml\n", area[0], area[1], area[2], wall);
    assert_close(area[0], 155.26, 0.003, 0);
    assert_close(area[1], 228.51, 0.003, 0);
    assert_close(area[2], 18.577, 0.003, 0);
    assert_close(wall, 177.69, 0.003, 0);
    vsc_mesh_free(mesh);
  }
}

static void ventricles_of_other_elements(void **state)
{
  (void)state;
  for (int k = 0; k < 3; k++) {
    vsc_lv_shape shape = vsc_lv_land();
    shape.element = kinds[k];
    vsc_mesh *mesh = ventricle(&shape);
    assert_int_equal(mesh->element_count, pieces[k] * 2 * (4 * 4 + 16 * 12));
    assert_close(volume_of(mesh), 3234.734, 0.05, 0);
    vsc_mesh_free(mesh);
  }
}

// The printed fibre of Arostica et al. 2025 at a point with the depth t of Laplace's equation.
static void printed_fiber(const double x[3], double t, double f[3])
{
  const double rs = 25 + 10 * t, rl = 90 + 7 * t;
  const double u = atan2(hypot(x[1], x[2]) / rs, x[0] / rl), v = atan2(x[2], x[1]);
  double e_u[3] = {-rl * sin(u), rs * cos(u) * cos(v), rs * cos(u) * sin(v)};
  const double e_v[3] = {0, -sin(v), cos(v)}, alpha = (-60 + 120 * t) * M_PI / 180;
  vsc_normalize(e_u);
  for (int a = 0; a < 3; a++) f[a] = sin(alpha) * e_u[a] + cos(alpha) * e_v[a];
}

// The benchmark takes its depth from Laplace's equation: the ellipsoid with surfaces gives its fibres to
// rounding, the helix nearly so. The depth between ellipsoids is another one, most at the apex, which is bent as sharply as it is thick. (On a
// shell of radii 7 and 14 mm the two are 0.67 and 0.5 in the middle.)
static void fibres_by_laplace_and_by_depth(void **state)
{
  (void)state;
  vsc_lv_shape shape = vsc_lv_arostica();
  shape.layers = 4;
  vsc_mesh *mesh = ventricle(&shape);
  vsc_surface surfaces[2] = {{.count = 0}};
  for (int k = 0; k < 2; k++) {
    vsc_selector selector = {.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
    vsc_copy_name(selector.array, k == 0 ? "endo" : "epi");
    vsc_surface boundary = {.count = 0};
    assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
    assert_int_equal(vsc_select_surface(mesh, &boundary, &selector, &surfaces[k], NULL), VSC_OK);
    vsc_surface_free(&boundary);
  }
  double *depth = vsc_alloc(mesh->node_count, sizeof *depth);
  assert_int_equal(vsc_helix_depth(mesh, &surfaces[0], &surfaces[1], depth, NULL), VSC_OK);
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_fiber_def helix = vsc_default_fiber(), exact = helix;
  helix.long_axis[0] = exact.long_axis[0] = 1;
  helix.long_axis[2] = exact.long_axis[2] = 0;
  exact.ellipsoid = (vsc_ellipsoid_def){
      .endo_radius = 25, .endo_length = 90, .epi_radius = 35, .epi_length = 97};
  vsc_axes *mixed = vsc_axes_create(mesh->element_count);
  assert_int_equal(vsc_fibers_helix(mesh, &helix, &surfaces[0], &surfaces[1], axes, NULL), VSC_OK);
  exact.source = VSC_FIBER_ELLIPSOID;
  assert_int_equal(vsc_fibers_helix(mesh, &exact, &surfaces[0], &surfaces[1], mixed, NULL), VSC_OK);
  double worst[2] = {0}, mean[2] = {0}, deepest = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    double at[3], t = 0, f[3], frame[9];
    for (size_t c = mesh->start[e]; c < mesh->start[e + 1]; c++) t += depth[mesh->corners[c]] / 4;
    vsc_mesh_element_centre(mesh, e, at);
    printed_fiber(at, t, f);
    for (int a = 0; a < 3; a++) assert_close(mixed->frames[9 * e + (size_t)a], f[a], 0, 1e-9);
    vsc_ellipsoid_frame(&exact, at, frame);
    deepest = fmax(deepest, fabs(t - vsc_lv_depth(&shape, at)));
    const double cosines[2] = {vsc_dot(f, &axes->frames[9 * e]), vsc_dot(f, frame)};
    for (int k = 0; k < 2; k++) {
      const double off = acos(fmin(fabs(cosines[k]), 1)) * 180 / M_PI;
      mean[k] += off / (double)mesh->element_count;
      if (at[0] > -70) worst[k] = fmax(worst[k], off);
    }
  }
  print_message("off the benchmark's fibres: helix %.2f degrees on average, %.1f at most above the apex; "
                "ellipsoid %.2f and %.1f; depths by %.3f at most\n",
                mean[0], worst[0], mean[1], worst[1], deepest);
  // layers of 2.5 mm on linear tets: normals off by a degree or two
  assert_true(mean[0] < 2.5);
  assert_close(mean[1], 5, 0, 0.5);
  assert_close(deepest, 0.2, 0, 0.03);
  vsc_axes_free(axes);
  vsc_axes_free(mixed);
  vsc_free(depth);
  for (int k = 0; k < 2; k++) vsc_surface_free(&surfaces[k]);
  vsc_mesh_free(mesh);
}

// Bricks of a quadrilateral are cut along straight lines: the panel's volume is exact.
static void cook_s_membrane(void **state)
{
  (void)state;
  for (int k = 0; k < 4; k++) {
    vsc_panel_shape panel = vsc_panel_default();
    panel.thickness = 2.5;
    panel.element = (vsc_block_kind)k;
    vsc_mesh *mesh = NULL;
    assert_int_equal(vsc_panel_mesh(&panel, &mesh, NULL), VSC_OK);
    assert_close(volume_of(mesh), 2.5 * 48 * (44 + 16) / 2, 1e-13, 0);
    for (size_t i = 0; i < mesh->node_count; i++) {
      const double *x = &mesh->nodes[3 * i], low = 44 * x[0] / 48, high = 44 + 16 * x[0] / 48;
      assert_int_equal(marks(mesh, "left")[i] == 1, x[0] == 0);
      assert_int_equal(marks(mesh, "right")[i] == 1, x[0] == 48);
      assert_int_equal(marks(mesh, "bottom")[i] == 1, fabs(x[1] - low) < 1e-12);
      assert_int_equal(marks(mesh, "top")[i] == 1, fabs(x[1] - high) < 1e-12);
      assert_int_equal(marks(mesh, "back")[i] == 1, x[2] == 0);
      assert_int_equal(marks(mesh, "front")[i] == 1, x[2] == 2.5);
    }
    vsc_mesh_free(mesh);
  }
}

// Twice the bricks round the axis: a quarter of the error of the volume; nodes on the cuts and radii.
static void shells_fill_their_volumes(void **state)
{
  (void)state;
  for (int sphere = 0; sphere < 2; sphere++)
    for (int k = 0; k < 3; k++) {
      const double exact = sphere ? M_PI / 6 * 7 : M_PI / 4 * 3 * 1.5;
      double error[2];
      for (int fine = 0; fine < 2; fine++) {
        vsc_shell_shape shell = vsc_shell_default();
        shell.length = 1.5;
        shell.around = (size_t)8 << fine;
        shell.layers = 8;
        shell.element = kinds[k];
        vsc_mesh *mesh = NULL;
        assert_int_equal((sphere ? vsc_octant_mesh : vsc_cylinder_mesh)(&shell, &mesh, NULL), VSC_OK);
        const size_t n = shell.around;
        assert_int_equal(mesh->element_count, pieces[k] * 8 * (sphere ? 3 * n * n : n));
        error[fine] = 1 - volume_of(mesh) / exact;
        for (size_t i = 0; i < mesh->node_count; i++) {
          const double *x = &mesh->nodes[3 * i], r = sphere ? vsc_norm(x) : hypot(x[0], x[1]);
          assert_int_equal(marks(mesh, "inner")[i] == 1, fabs(r - 1) < 1e-12);
          assert_int_equal(marks(mesh, "outer")[i] == 1, fabs(r - 2) < 1e-12);
          assert_int_equal(marks(mesh, "x0")[i] == 1, x[0] == 0);
          assert_int_equal(marks(mesh, "y0")[i] == 1, x[1] == 0);
          assert_int_equal(marks(mesh, "z0")[i] == 1, x[2] == 0);
          if (!sphere) assert_int_equal(marks(mesh, "z1")[i] == 1, x[2] == 1.5);
        }
        vsc_mesh_free(mesh);
      }
      assert_true(error[1] > 0);
      assert_close(log2(error[0] / error[1]), 2, 0, 0.1);
    }
}

static void bad_shapes_are_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  vsc_error error = {.text = ""};
  vsc_lv_shape lv = vsc_lv_arostica();
  lv.base_rise = 70;
  assert_int_equal(vsc_lv_mesh(&lv, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "must cut the wall"));
  lv.base_rise = 60;
  assert_int_equal(vsc_lv_mesh(&lv, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "smaller rise"));
  lv = vsc_lv_land();
  lv.element = VSC_BLOCK_MIXED;
  assert_int_equal(vsc_lv_mesh(&lv, &mesh, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "no mixed"));
  vsc_image *image = NULL;
  lv = vsc_lv_arostica();
  assert_int_equal(vsc_lv_map(&lv, 1, -1, 3, &image, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "flat base"));
  vsc_panel_shape panel = vsc_panel_default();
  panel.thickness = 0;
  assert_int_equal(vsc_panel_mesh(&panel, &mesh, &error), VSC_INPUT);
  vsc_shell_shape shell = vsc_shell_default();
  shell.outer = 1;
  assert_int_equal(vsc_cylinder_mesh(&shell, &mesh, &error), VSC_INPUT);
  assert_int_equal(vsc_octant_mesh(&shell, &mesh, &error), VSC_INPUT);
  shell = vsc_shell_default();
  shell.around = 0;
  assert_int_equal(vsc_octant_mesh(&shell, &mesh, &error), VSC_INPUT);
  shell = vsc_shell_default();
  shell.element = VSC_BLOCK_MIXED;
  assert_int_equal(vsc_octant_mesh(&shell, &mesh, &error), VSC_INPUT);
  assert_null(mesh);
}

static void little_memory_is_reported(void **state)
{
  (void)state;
  vsc_lv_shape lv = vsc_lv_arostica();
  lv.around = lv.along = 8;
  lv.element = VSC_BLOCK_HEXES;
  const vsc_panel_shape panel = vsc_panel_default();
  const vsc_shell_shape shell = vsc_shell_default();
  for (int what = 0; what < 4; what++) {
    vsc_status status = VSC_SYSTEM;
    long allowed = 0;
    for (; status != VSC_OK; allowed++) {
      vsc_mesh *mesh = NULL;
      vsc_alloc_fail_after(allowed);
      if (what == 0) status = vsc_lv_mesh(&lv, &mesh, NULL);
      if (what == 1) status = vsc_panel_mesh(&panel, &mesh, NULL);
      if (what == 2) status = vsc_cylinder_mesh(&shell, &mesh, NULL);
      if (what == 3) status = vsc_octant_mesh(&shell, &mesh, NULL);
      assert_true(status == VSC_OK || status == VSC_SYSTEM);
      vsc_mesh_free(mesh);
    }
    vsc_alloc_fail_after(-1);
    assert_true(allowed > 4);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_ventricle_of_land),
      cmocka_unit_test(the_ventricle_of_arostica),
      cmocka_unit_test(surfaces_of_arostica),
      cmocka_unit_test(ventricles_of_other_elements),
      cmocka_unit_test(fibres_by_laplace_and_by_depth),
      cmocka_unit_test(cook_s_membrane),
      cmocka_unit_test(shells_fill_their_volumes),
      cmocka_unit_test(bad_shapes_are_refused),
      cmocka_unit_test(little_memory_is_reported),
  };
  return cmocka_run_group_tests_name("tools/shapes_walls", tests, NULL, NULL);
}
