// SPDX-License-Identifier: GPL-3.0-or-later
// Real organs, which lie beside the source tree or not at all: each test skips without its file.
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "close.h"
#include "io/vtk.h"
#include "mesh/quality.h"
#include "mesh/surface.h"
#include "mesh/topology.h"

// The path of a data file; skips the test when it is not there.
static const char *data_file(const char *name)
{
  static char path[600];
  snprintf(path, sizeof path, "%s/../shared/data/%s", VSC_SOURCE_DIR, name);
  if (access(path, R_OK) != 0) {
    print_message("skipped: no %s\n", path);
    skip();
  }
  return path;
}

static vsc_mesh *read_mesh(const char *name)
{
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(data_file(name), 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

// What must hold for any organ: its boundary is closed and encloses the tets' volume.
static void check_sound(const vsc_mesh *mesh)
{
  vsc_surface boundary;
  vsc_cavity cavity;
  vsc_quality_summary quality;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_cavity_make(&boundary, mesh->node_count, &cavity, NULL), VSC_OK);
  assert_int_equal(vsc_mesh_quality(mesh, &quality, NULL), VSC_OK);
  assert_int_equal(cavity.rim_count, 0);
  assert_close(vsc_cavity_volume(&cavity, mesh->nodes, 3), -quality.volume, 1e-11, 0);
  assert_true(quality.min_volume > 0);
  assert_true(quality.worst[0].shape > 0 && quality.shape_mean < 1);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&boundary);
}

static void small_liver_with_turned_elements(void **state)
{
  (void)state;
  vsc_mesh *turned = read_mesh("liver_small_mixed_orientation.vtu");
  vsc_mesh *straight = read_mesh("liver_small.vtu");
  assert_int_equal(turned->report.turned_elements, 367);
  assert_int_equal(straight->report.turned_elements, 0);
  assert_int_equal(turned->node_count, 175);
  assert_int_equal(turned->element_count, 733);
  double volumes[2] = {0};
  for (size_t t = 0; t < 733; t++) {
    volumes[0] += vsc_mesh_element_volume(turned, t);
    volumes[1] += vsc_mesh_element_volume(straight, t);
  }
  assert_close(volumes[0], volumes[1], 1e-13, 0);
  check_sound(turned);
  vsc_quality_summary quality;
  assert_int_equal(vsc_mesh_quality(straight, &quality, NULL), VSC_OK);
  assert_true(quality.min_dihedral < 1);
  vsc_mesh_free(turned);
  vsc_mesh_free(straight);
}

// 118 of the 7437 triangles hang on the two points that no tet has.
static void ventricle_with_surface_triangles(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_mesh("heart_lv_human_mixed.vtu");
  assert_int_equal(mesh->element_count, 24206);
  assert_int_equal(mesh->triangle_count + mesh->report.loose_triangles, 7437);
  assert_int_equal(mesh->report.loose_triangles, 118);
  assert_int_equal(mesh->report.unused_nodes, 2);
  assert_int_equal(mesh->report.ignored_cells, 0);
  assert_int_equal(mesh->report.file_cells, 24206 + 7437);
  for (size_t i = 0; i < mesh->triangle_data.count; i++)
    assert_int_equal(mesh->triangle_data.items[i].tuples, mesh->triangle_count);
  assert_non_null(vsc_arrays_find(&mesh->triangle_data, "_surface-id"));
  check_sound(mesh);
  vsc_mesh_free(mesh);
}

static void ventricles_in_base64(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_mesh("heart_biv_plain.vtu");
  assert_int_equal(mesh->node_count, 2926);
  assert_int_equal(mesh->element_count, 13603);
  check_sound(mesh);
  vsc_mesh_free(mesh);
}

// Edges of the boundary that join other than two of its triangles.
static int compare_edges(const void *a, const void *b)
{
  const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

static size_t count_bad_edges(const vsc_surface *surface)
{
  uint64_t *edges = malloc(3 * surface->count * sizeof *edges);
  for (size_t t = 0; t < surface->count; t++)
    for (int i = 0; i < 3; i++) {
      const uint64_t a = surface->triangles[3 * t + i];
      const uint64_t b = surface->triangles[3 * t + (i + 1) % 3];
      edges[3 * t + i] = a < b ? a << 32 | b : b << 32 | a;
    }
  qsort(edges, 3 * surface->count, sizeof *edges, compare_edges);
  size_t bad = 0;
  for (size_t first = 0, last; first < 3 * surface->count; first = last) {
    for (last = first; last < 3 * surface->count && edges[last] == edges[first];) last++;
    bad += last - first != 2;
  }
  free(edges);
  return bad;
}

// Cuts off the boundary's triangles above a plane, as the base of a heart, and caps what is left.
static void cap_below(const vsc_mesh *mesh, const vsc_surface *boundary, double height)
{
  vsc_surface lower = *boundary;
  lower.triangles = malloc(3 * boundary->count * sizeof *lower.triangles);
  lower.count = 0;
  for (size_t t = 0; t < boundary->count; t++) {
    const uint32_t *node = boundary->triangles + 3 * t;
    if (mesh->nodes[3 * (size_t)node[0] + 2] < height)
      memcpy(lower.triangles + 3 * lower.count++, node, 3 * sizeof *node);
  }
  vsc_cavity cavity;
  assert_int_equal(vsc_cavity_make(&lower, mesh->node_count, &cavity, NULL), VSC_OK);
  assert_true(cavity.rim_count > 0);
  double *moved = malloc(3 * mesh->node_count * sizeof *moved);
  for (size_t i = 0; i < 3 * mesh->node_count; i++) moved[i] = mesh->nodes[i] + 1000;
  assert_close(vsc_cavity_volume(&cavity, moved, 3), vsc_cavity_volume(&cavity, mesh->nodes, 3),
               1e-9, 0);
  free(moved);
  free(lower.triangles);
  vsc_cavity_free(&cavity);
}

static void human_ventricles_with_bad_edges(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_mesh("heart_human_biv_tet.vtu");
  vsc_surface boundary;
  vsc_topology topology;
  double low[3], high[3];
  assert_int_equal(mesh->node_count, 9376);
  assert_int_equal(mesh->element_count, 37381);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(count_bad_edges(&boundary), 76);
  check_sound(mesh);
  vsc_mesh_box(mesh, low, high);
  for (int part = 1; part < 10; part++)
    cap_below(mesh, &boundary, low[2] + part * (high[2] - low[2]) / 10);
  assert_int_equal(vsc_topology_make(mesh, &topology, NULL), VSC_OK);
  assert_int_equal(topology.crowded_faces, 0);
  vsc_topology_free(&topology);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

// The cavity of a real left ventricle, from the node array that marks its endocardium.
static void a_ventricle_has_a_cavity(void **state)
{
  (void)state;
  vsc_mesh *mesh = read_mesh("heart_lv_human.vtu");
  const vsc_selector endocardium = {.name = "endo", .kind = VSC_SELECT_NODE_ARRAY,
                                    .array = "endocardium", .low = 0.5, .high = 1.5};
  vsc_surface boundary, wall;
  vsc_cavity cavity;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_select_surface(mesh, &boundary, &endocardium, &wall, NULL), VSC_OK);
  assert_int_equal(vsc_cavity_make(&wall, mesh->node_count, &cavity, NULL), VSC_OK);
  const double volume = vsc_cavity_volume(&cavity, mesh->nodes, 3);
  print_message("cavity %g mL, %zu rims\n", volume / 1000, cavity.rim_count);
  assert_true(volume > 40e3 && volume < 300e3);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&wall);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

static void surfaces_are_refused(void **state)
{
  (void)state;
  const struct {
    const char *name, *words;
  } files[] = {{"liver_human_liver.vtk", "holds a VTK PolyData"},
               {"liver_human_arteries.vtk", "holds a VTK PolyData"},
               {"liver_human_hepatic_veins.vtk", "holds a VTK PolyData"},
               {"liver_human_portal_vein.vtk", "holds a VTK PolyData"}};
  for (size_t i = 0; i < sizeof files / sizeof files[0]; i++) {
    vsc_mesh *mesh = NULL;
    vsc_error error = {0};
    assert_int_equal(vsc_vtk_read_mesh(data_file(files[i].name), 1, &mesh, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, files[i].words));
    assert_non_null(strstr(error.text, files[i].name));
  }
}

// Voxels of one size: 10,481 times the first one's volume.
static void a_heart_of_hexahedra(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  vsc_error error = {0};
  if (vsc_vtk_read_mesh(data_file("heart_human_biv_hex.vtu"), 1, &mesh, &error) != VSC_OK)
    fail_msg("%s", error.text);
  assert_int_equal(mesh->element_count, 10481);
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    assert_int_equal(mesh->kinds[e], VSC_HEX);
    volume += vsc_mesh_element_volume(mesh, e);
  }
  // coordinates are 32-bit floats
  assert_close(volume, 10481 * vsc_mesh_element_volume(mesh, 0), 1e-5, 0);
  vsc_mesh_free(mesh);
}

static void the_angle_map_of_a_heart(void **state)
{
  (void)state;
  vsc_image *image = NULL;
  const char *path = data_file("heart_human_angles.vti");
  assert_int_equal(vsc_vtk_read_image(path, 1, &image, NULL), VSC_OK);
  assert_int_equal(image->size[0], 149);
  assert_int_equal(image->size[1], 157);
  assert_int_equal(image->size[2], 235);
  for (int i = 0; i < 3; i++) assert_close(image->spacing[i], 0.6352, 1e-12, 0);
  const char *names[] = {"tissue", "azimuth_x10", "elevation_x10", "coherence_x100"};
  for (int i = 0; i < 4; i++) assert_non_null(vsc_arrays_find(&image->data, names[i]));
  const vsc_array *tissue = vsc_arrays_find(&image->data, "tissue");
  const vsc_array *azimuth = vsc_arrays_find(&image->data, "azimuth_x10");
  for (size_t i = 0; i < azimuth->tuples; i++)
    if (tissue->values[i] > 0) assert_true(azimuth->values[i] >= 0 && azimuth->values[i] <= 1800);
  vsc_image_free(image);
}

static void the_phantom_slice(void **state)
{
  (void)state;
  vsc_image *image = NULL;
  assert_int_equal(vsc_vtk_read_image(data_file("dti_phantom_slice.vti"), 1, &image, NULL), VSC_OK);
  const vsc_array *label = vsc_arrays_find(&image->data, "label");
  assert_non_null(label);
  size_t tissue = 0;
  for (size_t i = 0; i < label->tuples; i++) tissue += label->values[i] == 1;
  assert_int_equal(tissue, 1656);
  assert_int_equal(vsc_arrays_find(&image->data, "E1")->components, 3);
  vsc_image_free(image);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(small_liver_with_turned_elements),
    cmocka_unit_test(ventricle_with_surface_triangles),
    cmocka_unit_test(ventricles_in_base64),
    cmocka_unit_test(human_ventricles_with_bad_edges),
    cmocka_unit_test(a_ventricle_has_a_cavity),
    cmocka_unit_test(surfaces_are_refused),
    cmocka_unit_test(a_heart_of_hexahedra),
    cmocka_unit_test(the_angle_map_of_a_heart),
    cmocka_unit_test(the_phantom_slice),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
