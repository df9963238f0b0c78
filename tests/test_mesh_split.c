// SPDX-License-Identifier: GPL-3.0-or-later
// Elements as tets: they fill them, fit together, and fibres on them are those of tets.
#include "close.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/helix.h"
#include "fibers/sample.h"
#include "hybrid_mesh.h"
#include "mesh/select.h"
#include "mesh/split.h"

static const double degree = M_PI / 180;

// All elements of `mesh` as tets.
static vsc_mesh *as_tets(const vsc_mesh *mesh)
{
  size_t count = 0;
  uint32_t(*tets)[4] = vsc_alloc(VSC_MOST_TETS * mesh->element_count, sizeof *tets);
  assert_non_null(tets);
  for (size_t e = 0; e < mesh->element_count; e++)
    count += (size_t)vsc_mesh_split(mesh, e, &tets[count]);
  vsc_mesh *result = NULL;
  assert_int_equal(
      vsc_mesh_from_arrays(mesh->node_count, mesh->nodes, count, tets[0], &result, NULL), VSC_OK);
  vsc_free(tets);
  return result;
}

// Numbers the nodes by chance.
static void shuffle_nodes(vsc_mesh *mesh, uint64_t seed)
{
  uint32_t *number = vsc_alloc(mesh->node_count, sizeof *number);
  for (size_t i = 0; i < mesh->node_count; i++) {
    const size_t other = (size_t)((double)(i + 1) * random_part(&seed));
    number[i] = number[other];
    number[other] = (uint32_t)i;
  }
  double *nodes = vsc_alloc(3 * mesh->node_count, sizeof *nodes);
  memcpy(nodes, mesh->nodes, 3 * mesh->node_count * sizeof *nodes);
  for (size_t i = 0; i < mesh->node_count; i++)
    memcpy(mesh->nodes + 3 * (size_t)number[i], nodes + 3 * i, 3 * sizeof *nodes);
  for (size_t c = 0; c < mesh->start[mesh->element_count]; c++)
    mesh->corners[c] = number[mesh->corners[c]];
  vsc_free(nodes);
  vsc_free(number);
}

static void tets_fill_and_fit(void **state)
{
  (void)state;
  static const int expected[VSC_CELLS] = {
      [VSC_TET] = 1, [VSC_HEX] = 6, [VSC_WEDGE] = 3, [VSC_PYRAMID] = 2};
  size_t seen[VSC_CELLS] = {0};
  vsc_mesh *mesh = hybrid_block(4, 0, 5);
  shuffle_nodes(mesh, 3);
  vsc_mesh *tets = as_tets(mesh);
  size_t at = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    uint32_t own[VSC_MOST_TETS][4];
    const int count = vsc_mesh_split(mesh, e, own);
    double volume = 0;
    assert_int_equal(count, expected[mesh->kinds[e]]);
    seen[mesh->kinds[e]]++;
    for (int t = 0; t < count; t++, at++) volume += vsc_mesh_element_volume(tets, at);
    assert_close(volume, vsc_mesh_element_volume(mesh, e), 1e-13, 0);
  }
  for (int k = 0; k <= VSC_PYRAMID; k++) assert_true(seen[k] > 0);
  assert_int_equal(tets->report.turned_elements, 0);
  // A conforming mesh of the cube shows 6 x 4 x 4 squares of two triangles outside.
  vsc_surface boundary;
  assert_int_equal(vsc_boundary(tets, &boundary, NULL), VSC_OK);
  assert_int_equal(boundary.count, 6 * 16 * 2);
  vsc_surface_free(&boundary);
  vsc_mesh_free(tets);
  vsc_mesh_free(mesh);
}

// A hexahedron with three corners of its bottom in line: flat tets are left out, the others fill it.
static void flat_tets_are_left_out(void **state)
{
  (void)state;
  static const double corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {0, 2, 0},
                                       {0, 0, 1}, {1, 0, 1}, {2, 0, 1}, {0, 2, 1}};
  const uint8_t kind = VSC_HEX;
  vsc_mesh *mesh = vsc_mesh_create_cells(8, 1, &kind, 0);
  memcpy(mesh->nodes, corners, sizeof corners);
  for (uint32_t c = 0; c < 8; c++) mesh->corners[c] = c;
  uint32_t tets[VSC_MOST_TETS][4];
  const int count = vsc_mesh_split(mesh, 0, tets);
  double volume = 0;
  assert_true(count < 6);
  for (int t = 0; t < count; t++) {
    const double *x[4];
    for (int i = 0; i < 4; i++) x[i] = mesh->nodes + 3 * (size_t)tets[t][i];
    const double part = vsc_tet_volume(x[0], x[1], x[2], x[3]);
    assert_true(part > 0.1);
    volume += part;
  }
  assert_close(volume, 2, 1e-14, 0);
  vsc_mesh_free(mesh);
}

static void select_plane(const vsc_mesh *mesh, double height, vsc_surface *surface)
{
  vsc_surface boundary;
  const vsc_selector plane = {.kind = VSC_SELECT_PLANE,
                              .name = "wall",
                              .point = {0, 0, height},
                              .normal = {0, 0, 1},
                              .tolerance = 1e-9};
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_select_surface(mesh, &boundary, &plane, surface, NULL), VSC_OK);
  vsc_surface_free(&boundary);
}

// The depth of a slab is linear, whatever the elements, and its gradient points up in each.
static void depth_of_a_hybrid_slab_is_linear(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(5, 0.2, 3);
  vsc_surface endo, epi;
  select_plane(mesh, 0, &endo);
  select_plane(mesh, 5, &epi);
  double *depth = vsc_alloc(mesh->node_count, sizeof *depth);
  assert_int_equal(vsc_helix_depth(mesh, &endo, &epi, depth, NULL), VSC_OK);
  for (size_t i = 0; i < mesh->node_count; i++)
    assert_close(depth[i], mesh->nodes[3 * i + 2] / 5, 0, 1e-12);
  vsc_fiber_def definition = vsc_default_fiber();
  memcpy(definition.long_axis, (double[3]){1, 0, 0}, sizeof definition.long_axis);
  definition.endo_angle = 60 * degree;
  definition.epi_angle = -60 * degree;
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  assert_int_equal(vsc_fibers_helix(mesh, &definition, &endo, &epi, axes, NULL), VSC_OK);
  for (size_t e = 0; e < mesh->element_count; e++) {
    double centre[3];
    vsc_mesh_element_centre(mesh, e, centre);
    const double angle = (60 - 120 * centre[2] / 5) * degree;
    assert_true(axes->known[e]);
    // e_l = x, e_t = z, e_c = e_l x e_t = -y
    assert_close(fabs(sin(angle) * axes->frames[9 * e] - cos(angle) * axes->frames[9 * e + 1]), 1,
                 0, 1e-10);
    assert_close(axes->frames[9 * e + 5], 1, 0, 1e-10);
  }
  vsc_axes_free(axes);
  vsc_free(depth);
  vsc_surface_free(&endo);
  vsc_surface_free(&epi);
  vsc_mesh_free(mesh);
}

// Voxels of edge `spacing` whose fibre turns by 20 degrees per mm of height.
static vsc_image *turning_map(double spacing)
{
  const size_t n = (size_t)ceil(7 / spacing), size[3] = {n, n, n};
  vsc_image *image = vsc_image_create(size);
  assert_non_null(image);
  for (int a = 0; a < 3; a++) {
    image->spacing[a] = spacing;
    image->origin[a] = -1;
  }
  const char *names[2] = {"azimuth", "elevation"};
  for (int a = 0; a < 2; a++) assert_non_null(vsc_arrays_add(&image->data, names[a], 1, n * n * n));
  for (size_t v = 0; v < n * n * n; v++)
    image->data.items[0].values[v] = 20 * (-1 + spacing * (double)(v / n / n));
  return image;
}

// Elements of all kinds get the fibre at their centroid, from many voxels or from few.
static void maps_are_sampled_on_all_kinds(void **state)
{
  (void)state;
  const double spacings[2] = {0.12, 0.8};
  for (int k = 0; k < 2; k++) {
    vsc_mesh *mesh = hybrid_block(5, 0.15, 7);
    vsc_image *image = turning_map(spacings[k]);
    vsc_axes *axes = vsc_axes_create(mesh->element_count);
    const vsc_angle_map_def map = vsc_default_fiber().map;
    vsc_fiber_report report;
    assert_int_equal(vsc_fibers_sample(mesh, image, &map, axes, &report, NULL), VSC_OK);
    assert_int_equal(report.with_data, mesh->element_count);
    if (k == 0) assert_true(report.fallback < mesh->element_count / 2);
    if (k == 1) assert_int_equal(report.fallback, mesh->element_count);
    for (size_t e = 0; e < mesh->element_count; e++) {
      uint32_t tets[VSC_MOST_TETS][4];
      const int count = vsc_mesh_split(mesh, e, tets);
      double height = 0, total = 0;
      for (int t = 0; t < count; t++) {
        const double *x[4];
        double edge[3][3], across[3];
        for (int i = 0; i < 4; i++) x[i] = &mesh->nodes[3 * (size_t)tets[t][i]];
        for (int i = 0; i < 3; i++) vsc_subtract(x[i + 1], x[0], edge[i]);
        vsc_cross(edge[0], edge[1], across);
        const double volume = fabs(vsc_dot(across, edge[2]));
        height += volume * (x[0][2] + x[1][2] + x[2][2] + x[3][2]) / 4;
        total += volume;
      }
      const double angle = 20 * height / total * degree, *f = &axes->frames[9 * e];
      // 1 degree: f f^T is not linear over an element; voxels of 0.8 mm blur it
      assert_close(fabs(sin(angle) * f[0] - cos(angle) * f[1]), 0, 0, sin(1 * degree));
    }
    vsc_axes_free(axes);
    vsc_image_free(image);
    vsc_mesh_free(mesh);
  }
}

// One element with a fibre gives it to all, across faces of every kind.
static void filling_crosses_all_faces(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(4, 0.1, 9);
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  const double fiber[3] = {0.6, 0, 0.8};
  size_t filled;
  axes->known[0] = vsc_axes_complete(fiber, NULL, axes->frames) != 0;
  assert_int_equal(vsc_fibers_fill(mesh, axes, &filled, NULL), VSC_OK);
  assert_int_equal(filled, mesh->element_count - 1);
  for (size_t e = 0; e < mesh->element_count; e++)
    assert_close(fabs(vsc_dot(fiber, &axes->frames[9 * e])), 1, 0, 1e-12);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tets_fill_and_fit),
      cmocka_unit_test(flat_tets_are_left_out),
      cmocka_unit_test(depth_of_a_hybrid_slab_is_linear),
      cmocka_unit_test(maps_are_sampled_on_all_kinds),
      cmocka_unit_test(filling_crosses_all_faces),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
