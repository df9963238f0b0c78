// SPDX-License-Identifier: GPL-3.0-or-later
// Quadratic tetrahedra: made from linear ones, cleaned, bent onto ellipsoids, their surfaces.
#include <stdlib.h>

#include "base/vec3.h"
#include "box_mesh.h"
#include "close.h"
#include "hybrid_mesh.h"
#include "mesh/edges.h"
#include "mesh/quadratic.h"
#include "mesh/quality.h"
#include "mesh/split.h"
#include "mesh/surface.h"
#include "tools/shapes.h"

static void raise_mesh(vsc_mesh **mesh)
{
  vsc_error error;
  if (vsc_mesh_raise(mesh, "m.vtu", &error) != VSC_OK) fail_msg("%s", error.text);
}

static const int BOX[3] = {2, 2, 2};

// A box of tets with arrays: nodes 0 or 1 on the side x = 0 and their places, elements numbered, and two
// triangles on x = 0.
static vsc_mesh *box_with_arrays(void)
{
  vsc_mesh *box = box_mesh(BOX, 1, NULL), *mesh;
  mesh = vsc_mesh_create(box->node_count, box->element_count, 2);
  memcpy(mesh->nodes, box->nodes, 3 * box->node_count * sizeof *mesh->nodes);
  memcpy(mesh->corners, box->corners, 4 * box->element_count * sizeof *mesh->corners);
  const int at[2][3][2] = {{{0, 0}, {1, 1}, {1, 0}}, {{0, 0}, {0, 1}, {1, 1}}};
  for (int t = 0; t < 2; t++)
    for (int i = 0; i < 3; i++)
      mesh->triangles[3 * t + i] = box_node(BOX, 0, at[t][i][0], at[t][i][1]);
  vsc_mesh_free(box);
  double *side = vsc_arrays_add(&mesh->node_data, "side", 1, mesh->node_count)->values;
  double *place = vsc_arrays_add(&mesh->node_data, "place", 3, mesh->node_count)->values;
  for (size_t n = 0; n < mesh->node_count; n++) side[n] = mesh->nodes[3 * n] == 0;
  memcpy(place, mesh->nodes, 3 * mesh->node_count * sizeof *place);
  double *number = vsc_arrays_add(&mesh->element_data, "number", 1, mesh->element_count)->values;
  for (size_t e = 0; e < mesh->element_count; e++) number[e] = (double)e;
  double *label = vsc_arrays_add(&mesh->triangle_data, "label", 1, 2)->values;
  label[0] = 5;
  label[1] = 6;
  if (vsc_mesh_clean(mesh, "box", NULL) != VSC_OK) fail_msg("the box");
  assert_null(mesh->triangle_mid);
  return mesh;
}

// The 2 x 2 x 2 box has 27 nodes and 98 edges: Euler's formula with 48 tets, 120 faces.
static void tets_become_quadratic(void **state)
{
  (void)state;
  vsc_mesh *linear = box_with_arrays(), *mesh = box_with_arrays();
  mesh->element_source[7] = 1000;
  mesh->node_data.items[0].single = mesh->triangle_data.items[0].single = true;
  raise_mesh(&mesh);
  assert_true(mesh->node_data.items[0].single && mesh->triangle_data.items[0].single);
  assert_false(mesh->node_data.items[1].single);
  assert_int_equal(mesh->node_count, 27 + 98);
  assert_int_equal(mesh->element_count, 48);
  assert_int_equal(mesh->element_source[7], 1000);
  assert_int_equal(mesh->node_source[26], 26);
  assert_int_equal(mesh->node_source[27], 27);
  assert_int_equal(mesh->node_source[124], 124);
  const double *side = vsc_arrays_find(&mesh->node_data, "side")->values;
  const double *place = vsc_arrays_find(&mesh->node_data, "place")->values;
  assert_memory_equal(place, mesh->nodes, 3 * mesh->node_count * sizeof *place);
  for (size_t n = 0; n < mesh->node_count; n++)
    assert_int_equal(side[n] == 1, mesh->nodes[3 * n] == 0);
  for (size_t e = 0; e < 48; e++) {
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    assert_int_equal(mesh->kinds[e], VSC_TET10);
    assert_memory_equal(corner, vsc_mesh_corners(linear, e), 4 * sizeof *corner);
    assert_close(vsc_arrays_find(&mesh->element_data, "number")->values[e], (double)e, 0, 0);
    assert_close(vsc_mesh_element_volume(mesh, e), 1. / 6, 1e-14, 0);
    for (int k = 0; k < 6; k++) {
      const int *ends = vsc_cells[VSC_TET10].edges[k];
      for (size_t a = 0; a < 3; a++)
        assert_close(mesh->nodes[3 * corner[4 + k] + a],
                     0.5 * (mesh->nodes[3 * corner[ends[0]] + a] + mesh->nodes[3 * corner[ends[1]] + a]),
                     0, 0);
    }
  }
  assert_int_equal(mesh->triangle_count, 2);
  assert_memory_equal(mesh->triangles, linear->triangles, 6 * sizeof *mesh->triangles);
  assert_close(vsc_arrays_find(&mesh->triangle_data, "label")->values[1], 6, 0, 0);
  for (int k = 0; k < 6; k++)
    for (size_t a = 0; a < 3; a++)
      assert_close(mesh->nodes[3 * mesh->triangle_mid[k] + a],
                   0.5 * (mesh->nodes[3 * mesh->triangles[k] + a] +
                          mesh->nodes[3 * mesh->triangles[k % 3 == 2 ? k - 2 : k + 1] + a]),
                   0, 0);
  const vsc_mesh *before = mesh;
  raise_mesh(&mesh);
  assert_ptr_equal(mesh, before);
  vsc_mesh_free(linear);
  vsc_mesh_free(mesh);
}

// Bricks, wedges, pyramids and tets: what becomes of them fills the same cube, fits, and has its element's data and source.
static void other_elements_are_cut(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(2, 0, 3);
  size_t expected = 0, at = 0;
  double volumes[128] = {0}, sums[128] = {0};
  uint32_t tets[VSC_MOST_TETS][4];
  const size_t elements = mesh->element_count, nodes = mesh->node_count;
  assert_true(elements < 128);
  double *number = vsc_arrays_add(&mesh->element_data, "number", 1, elements)->values;
  for (size_t e = 0; e < elements; e++) {
    number[e] = (double)e;
    mesh->element_source[e] = 1000 + (uint32_t)e;
    volumes[e] = vsc_mesh_element_volume(mesh, e);
    expected += (size_t)vsc_mesh_split(mesh, e, tets);
  }
  double *place = vsc_arrays_add(&mesh->node_data, "place", 3, nodes)->values;
  memcpy(place, mesh->nodes, 3 * nodes * sizeof *place);
  raise_mesh(&mesh);
  assert_int_equal(mesh->element_count, expected);
  const double *owner = vsc_arrays_find(&mesh->element_data, "number")->values;
  for (size_t e = 0; e < mesh->element_count; e++) {
    assert_int_equal(mesh->kinds[e], VSC_TET10);
    assert_int_equal(mesh->element_source[e], 1000 + (uint32_t)owner[e]);
    assert_true(owner[e] >= (double)at);
    at = (size_t)owner[e];
    sums[at] += vsc_mesh_element_volume(mesh, e);
  }
  for (size_t e = 0; e < elements; e++) assert_close(sums[e], volumes[e], 1e-12, 0);
  const double *places = vsc_arrays_find(&mesh->node_data, "place")->values;
  for (size_t i = 0; i < 3 * mesh->node_count; i++) assert_close(places[i], mesh->nodes[i], 0, 1e-14);
  // faces that did not fit would be on the boundary: the cube's is 6 x 2 x 2 mm2
  vsc_surface boundary = {0};
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_close(vsc_surface_area(&boundary, mesh->nodes, 3), 24, 1e-12, 0);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
}

static vsc_mesh *brick_with_triangle(double lift, const uint32_t triangle[3])
{
  static const double corners[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  vsc_mesh *mesh = vsc_mesh_create_cells(8, 1, (const uint8_t[]){VSC_HEX}, 1);
  memcpy(mesh->nodes, corners, sizeof corners);
  mesh->nodes[3 * 6 + 2] += lift;
  for (uint32_t c = 0; c < 8; c++) mesh->corners[c] = c;
  memcpy(mesh->triangles, triangle, 3 * sizeof *triangle);
  return mesh;
}

static void what_cannot_be_raised_is_refused(void **state)
{
  (void)state;
  vsc_error error;
  vsc_mesh *mesh = brick_with_triangle(0, (const uint32_t[]){0, 2, 1});
  raise_mesh(&mesh);
  assert_int_equal(mesh->element_count, 6);
  vsc_mesh_free(mesh);
  mesh = brick_with_triangle(0, (const uint32_t[]){1, 3, 0});
  assert_int_equal(vsc_mesh_raise(&mesh, "m.vtu", &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "m.vtu: 1 of its triangles lie across the cuts of its elements"));
  vsc_mesh_free(mesh);
  mesh = brick_with_triangle(-1.5, (const uint32_t[]){0, 2, 1});
  mesh->element_source[0] = 7;
  assert_int_equal(vsc_mesh_raise(&mesh, "m.vtu", &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "m.vtu: element 7, a hexahedron, is bent so much that it cannot be cut"));
  assert_int_equal(mesh->kinds[0], VSC_HEX);
  vsc_mesh_free(mesh);
  mesh = vsc_mesh_create(3, 0, 1);
  mesh->nodes[3] = mesh->nodes[7] = 1;
  mesh->triangles[1] = 1;
  mesh->triangles[2] = 2;
  assert_int_equal(vsc_mesh_raise(&mesh, "m.vtu", &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "the mesh is a surface"));
  vsc_mesh_free(mesh);
}

static vsc_mesh *quadratic_box(void)
{
  vsc_mesh *mesh = box_with_arrays();
  raise_mesh(&mesh);
  return mesh;
}

static void assert_refused(vsc_mesh *mesh, const char *words)
{
  vsc_error error = {0};
  assert_int_equal(vsc_mesh_clean(mesh, "organ.vtu", &error), VSC_INPUT);
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
  vsc_mesh_free(mesh);
}

static void what_does_not_fit_is_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = quadratic_box();
  double *middle = mesh->nodes + 3 * (size_t)vsc_mesh_corners(mesh, 5)[9];
  const double *far = mesh->nodes + 3 * (size_t)vsc_mesh_corners(mesh, 5)[0];
  for (int a = 0; a < 3; a++) middle[a] = 0.9 * far[a] + 0.1 * middle[a];
  assert_refused(mesh, "folded, with a Jacobian that is not positive at an integration point: ");

  // a middle of its own for one element: a copy of the node
  mesh = quadratic_box();
  vsc_mesh *apart = vsc_mesh_create_cells(mesh->node_count + 1, mesh->element_count, mesh->kinds, 0);
  memcpy(apart->nodes, mesh->nodes, 3 * mesh->node_count * sizeof *mesh->nodes);
  memcpy(apart->corners, mesh->corners, 10 * mesh->element_count * sizeof *mesh->corners);
  memcpy(apart->nodes + 3 * mesh->node_count, mesh->nodes + 3 * (size_t)mesh->corners[14],
         3 * sizeof *mesh->nodes);
  apart->corners[14] = (uint32_t)mesh->node_count;
  vsc_mesh_free(mesh);
  assert_refused(apart, "not conforming, with a node in the middle of an edge that is not its "
                        "neighbours': 1 quadratic tetrahedron (cells 1): ");

  // a linear tet beside a quadratic one
  const uint8_t kinds[2] = {VSC_TET10, VSC_TET};
  mesh = vsc_mesh_create_cells(14, 2, kinds, 0);
  for (uint32_t i = 0; i < 14; i++) mesh->corners[i] = i;
  static const double tet[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  memcpy(mesh->nodes, tet, sizeof tet);
  memcpy(mesh->nodes + 30, tet, sizeof tet);
  for (int k = 0; k < 6; k++)
    for (int a = 0; a < 3; a++)
      mesh->nodes[12 + 3 * k + a] = 0.5 * (tet[vsc_cells[VSC_TET10].edges[k][0]][a] +
                                           tet[vsc_cells[VSC_TET10].edges[k][1]][a]);
  assert_refused(mesh, "beside quadratic tetrahedra there are 1 tetrahedron (cells 1): ");
}

// Mirrored elements are turned: what was the middle of an edge stays that.
static void left_handed_ones_are_turned(void **state)
{
  (void)state;
  vsc_mesh *mesh = quadratic_box();
  for (size_t n = 0; n < mesh->node_count; n++) mesh->nodes[3 * n] *= -1;
  assert_int_equal(vsc_mesh_clean(mesh, "mirrored", NULL), VSC_OK);
  assert_int_equal(mesh->report.turned_elements, 48);
  for (size_t e = 0; e < 48; e++) {
    const uint32_t *corner = vsc_mesh_corners(mesh, e);
    assert_close(vsc_mesh_element_volume(mesh, e), 1. / 6, 1e-14, 0);
    for (int k = 0; k < 6; k++)
      for (size_t a = 0; a < 3; a++) {
        const int *ends = vsc_cells[VSC_TET10].edges[k];
        assert_close(mesh->nodes[3 * corner[4 + k] + a],
                     0.5 * (mesh->nodes[3 * corner[ends[0]] + a] + mesh->nodes[3 * corner[ends[1]] + a]),
                     0, 0);
      }
  }
  vsc_mesh_free(mesh);
}

// Eight tets fill each, right-handed, also where it is bent a little.
static void it_is_split_in_eight(void **state)
{
  (void)state;
  vsc_mesh *mesh = quadratic_box();
  for (size_t e = 0; e < 48; e++) {
    uint32_t tets[VSC_MOST_TETS][4];
    double volume = 0;
    assert_int_equal(vsc_mesh_split(mesh, e, tets), 8);
    for (int t = 0; t < 8; t++) {
      const double *x[4];
      for (int i = 0; i < 4; i++) x[i] = mesh->nodes + 3 * (size_t)tets[t][i];
      const double part = vsc_tet_volume(x[0], x[1], x[2], x[3]);
      assert_close(part, 1. / 48, 1e-13, 0);
      volume += part;
    }
    assert_close(volume, 1. / 6, 1e-14, 0);
  }
  vsc_mesh_free(mesh);
}

static void select_named(const vsc_mesh *mesh, const vsc_surface *boundary, const char *name,
                         vsc_surface *surface)
{
  const vsc_selector selector = {.kind = VSC_SELECT_NODE_ARRAY, .low = 1, .high = 1};
  vsc_selector wanted = selector;
  vsc_error error;
  vsc_copy_name(wanted.name, name);
  vsc_copy_name(wanted.array, name);
  if (vsc_select_surface(mesh, boundary, &wanted, surface, &error) != VSC_OK)
    fail_msg("%s", error.text);
}

// A surface is the linear mesh's, with the middles of its edges; a set of its nodes has both.
static void surfaces_have_middles(void **state)
{
  (void)state;
  vsc_mesh *linear = box_with_arrays(), *mesh = quadratic_box();
  vsc_surface plain, boundary, side;
  assert_int_equal(vsc_boundary(linear, &plain, NULL), VSC_OK);
  assert_null(plain.mid);
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(boundary.count, plain.count);
  assert_memory_equal(boundary.triangles, plain.triangles, 3 * plain.count * sizeof(uint32_t));
  for (size_t k = 0; k < 3 * boundary.count; k++)
    for (size_t a = 0; a < 3; a++)
      assert_close(mesh->nodes[3 * boundary.mid[k] + a],
                   0.5 * (mesh->nodes[3 * boundary.triangles[k] + a] +
                          mesh->nodes[3 * boundary.triangles[k % 3 == 2 ? k - 2 : k + 1] + a]),
                   0, 0);
  assert_close(vsc_surface_area(&boundary, mesh->nodes, 3), 24, 1e-14, 0);
  select_named(mesh, &boundary, "side", &side);
  assert_int_equal(side.count, 8);
  vsc_node_set set;
  const vsc_selector of_side = {.name = "s", .kind = VSC_SELECT_SURFACE, .array = "side"};
  assert_int_equal(vsc_select_nodes(mesh, &of_side, &side, 1, &set, NULL), VSC_OK);
  assert_int_equal(set.count, 25);  // 5 x 5 places on the side
  vsc_node_set_free(&set);
  // a triangle array's nodes: of 2 triangles with one common edge 4 corners and 5 middles
  const vsc_selector listed = {
      .name = "t", .kind = VSC_SELECT_TRIANGLE_ARRAY, .array = "label", .low = 5, .high = 6};
  assert_int_equal(vsc_select_nodes(mesh, &listed, NULL, 0, &set, NULL), VSC_OK);
  assert_int_equal(set.count, 9);
  vsc_node_set_free(&set);
  vsc_surface_free(&plain);
  vsc_surface_free(&boundary);
  vsc_surface_free(&side);
  vsc_mesh_free(linear);
  vsc_mesh_free(mesh);
}

static size_t nodes_with(const vsc_mesh *mesh, const char *array, double low, double high)
{
  vsc_selector selector = {.kind = VSC_SELECT_NODE_ARRAY, .low = low, .high = high};
  vsc_node_set set;
  vsc_copy_name(selector.name, "set");
  vsc_copy_name(selector.array, array);
  if (vsc_select_nodes(mesh, &selector, NULL, 0, &set, NULL) != VSC_OK) return 0;
  const size_t count = set.count;
  vsc_node_set_free(&set);
  return count;
}

// A range that holds means, and a label that is one: 25 places on the side, none between labels 1 and 3.
static void sets_by_arrays_hold_no_means(void **state)
{
  (void)state;
  vsc_mesh *mesh = box_with_arrays();
  double *label = vsc_arrays_add(&mesh->node_data, "label", 1, mesh->node_count)->values;
  for (size_t n = 0; n < mesh->node_count; n++) label[n] = mesh->nodes[3 * n] == 0 ? 1 : 3;
  raise_mesh(&mesh);
  assert_int_equal(nodes_with(mesh, "side", 1, 1), 25);
  assert_int_equal(nodes_with(mesh, "side", 0.5, 1.5), 25);
  assert_int_equal(nodes_with(mesh, "label", 2, 2), 0);
  // 5 x 5 places on each of the planes x = 1, 1.5, 2
  assert_int_equal(nodes_with(mesh, "label", 3, 3), 5 * 5 * 3);
  assert_int_equal(nodes_with(mesh, "label", 1, 3), 125);
  // as in a file: values of its own
  mesh->report.file_nodes = mesh->node_count;
  assert_int_equal(nodes_with(mesh, "side", 0.5, 1.5), 50);
  assert_int_equal(nodes_with(mesh, "label", 2, 2), 25);
  vsc_mesh_free(mesh);
}

// Errors of volumes of a wall between two half ellipsoids, mm^3.
typedef struct wall_errors {
  double tissue, cavity;
} wall_errors;

static vsc_curved_def ellipsoid(const char *surface, double radius, double length)
{
  vsc_curved_def curved = {.radii = {radius, radius, length}};
  vsc_copy_name(curved.surface, surface);
  return curved;
}

// pi a^2 (z - z^3/3 b^2) between the apex -b and z
static double cap_of(double a, double b, double z)
{
  return M_PI * a * a * (z - z * z * z / (3 * b * b) + 2 * b / 3);
}

// The wall of Land et al. 2015 with `size` bricks through it; bent when `curved`.
static wall_errors wall_of(size_t size, bool curved)
{
  const vsc_lv_shape shape = {.endo_radius = 7, .endo_length = 17, .epi_radius = 10, .epi_length = 20,
                              .base = 5, .around = 12 * size, .along = 5 * size, .layers = size};
  vsc_mesh *mesh;
  vsc_error error;
  if (vsc_lv_mesh(&shape, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  mesh->report.file_nodes = mesh->node_count;
  raise_mesh(&mesh);
  vsc_surface boundary, wall[2], base;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  select_named(mesh, &boundary, "endo", &wall[0]);
  select_named(mesh, &boundary, "epi", &wall[1]);
  select_named(mesh, &boundary, "base", &base);
  const vsc_curved_def forms[2] = {ellipsoid("endo", 7, 17), ellipsoid("epi", 10, 20)};
  for (int s = 0; s < 2 && curved; s++) {
    if (vsc_mesh_bend(mesh, &boundary, &wall[s], &forms[s], &error) != VSC_OK)
      fail_msg("%s", error.text);
    for (size_t k = 0; k < 3 * wall[s].count; k++) {
      double level = -1;
      for (size_t a = 0; a < 3; a++)
        level += pow(mesh->nodes[3 * wall[s].mid[k] + a] / forms[s].radii[a], 2);
      assert_close(level, 0, 0, 4e-15);
    }
  }
  for (size_t k = 0; k < 3 * base.count; k++)
    assert_close(mesh->nodes[3 * base.mid[k] + 2], 5, 0, 2e-15);
  vsc_cavity cavity;
  assert_int_equal(vsc_cavity_make(&wall[0], mesh->node_count, &cavity, NULL), VSC_OK);
  assert_int_equal(cavity.rim_count, 1);
  const double inner = cap_of(7, 17, 5), tissue = cap_of(10, 20, 5) - inner;
  wall_errors errors = {-tissue, fabs(vsc_cavity_volume(&cavity, mesh->nodes, 3) - inner)};
  for (size_t e = 0; e < mesh->element_count; e++) errors.tissue += vsc_mesh_element_volume(mesh, e);
  errors.tissue = fabs(errors.tissue);
  vsc_cavity_free(&cavity);
  vsc_surface_free(&boundary);
  vsc_surface_free(&base);
  for (int s = 0; s < 2; s++) vsc_surface_free(&wall[s]);
  vsc_mesh_free(mesh);
  return errors;
}

// Straight edges miss an ellipsoid's volume by the square of their length, bent ones by the fourth power.
static void bent_walls_have_the_right_volume(void **state)
{
  (void)state;
  const wall_errors straight[2] = {wall_of(2, false), wall_of(4, false)};
  const wall_errors bent[2] = {wall_of(2, true), wall_of(4, true)};
  assert_close(log2(straight[0].tissue / straight[1].tissue), 2, 0, 0.15);
  assert_close(log2(straight[0].cavity / straight[1].cavity), 2, 0, 0.15);
  print_message("volumes: order %.2f, %.2f; errors %.3g, %.3g mm3 of 3235, 2492\n",
                log2(bent[0].tissue / bent[1].tissue), log2(bent[0].cavity / bent[1].cavity),
                bent[1].tissue, bent[1].cavity);
  assert_true(log2(bent[0].tissue / bent[1].tissue) > 3.5);
  assert_true(log2(bent[0].cavity / bent[1].cavity) > 3.5);
  assert_true(bent[1].tissue < 1e-5 * 3235 && bent[1].cavity < 1e-5 * 2492);
}

static void wrong_ellipsoids_are_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = quadratic_box(), *linear = box_with_arrays();
  vsc_surface boundary, side, plain;
  vsc_error error;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  assert_int_equal(vsc_boundary(linear, &plain, NULL), VSC_OK);
  select_named(mesh, &boundary, "side", &side);
  vsc_curved_def curved = ellipsoid("side", 7, 17);
  assert_int_equal(vsc_mesh_bend(mesh, &boundary, &side, &curved, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "mesh.curved: node "));
  assert_non_null(strstr(error.text, "of surface side at (0, "));
  assert_int_equal(vsc_mesh_bend(linear, &plain, &plain, &curved, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "use mesh.order: 2"));
  vsc_surface_free(&boundary);
  vsc_surface_free(&side);
  vsc_surface_free(&plain);
  vsc_mesh_free(mesh);
  vsc_mesh_free(linear);
}

// Nodes of a moved element of equal edges: the quality is that of its corners.
static void quality_is_that_of_the_corners(void **state)
{
  (void)state;
  vsc_mesh *linear = box_with_arrays(), *mesh = quadratic_box();
  for (size_t e = 0; e < 48; e++) {
    const vsc_element_quality one = vsc_mesh_element_quality(linear, e);
    const vsc_element_quality other = vsc_mesh_element_quality(mesh, e);
    assert_close(other.shape, one.shape, 0, 0);
    assert_close(other.min_dihedral, one.min_dihedral, 1e-15, 0);
    assert_close(other.edge_ratio, one.edge_ratio, 1e-15, 0);
    assert_close(other.volume, one.volume, 1e-14, 0);
  }
  vsc_mesh_free(linear);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(tets_become_quadratic),
      cmocka_unit_test(other_elements_are_cut),
      cmocka_unit_test(what_cannot_be_raised_is_refused),
      cmocka_unit_test(what_does_not_fit_is_refused),
      cmocka_unit_test(left_handed_ones_are_turned),
      cmocka_unit_test(it_is_split_in_eight),
      cmocka_unit_test(surfaces_have_middles),
      cmocka_unit_test(sets_by_arrays_hold_no_means),
      cmocka_unit_test(bent_walls_have_the_right_volume),
      cmocka_unit_test(wrong_ellipsoids_are_refused),
      cmocka_unit_test(quality_is_that_of_the_corners),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
