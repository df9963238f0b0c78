// SPDX-License-Identifier: GPL-3.0-or-later
#include <string.h>

#include "base/mem.h"
#include "box_mesh.h"
#include "close.h"
#include "mesh/select.h"

static const int SIZE[3] = {2, 2, 2};

typedef struct fixture {
  vsc_mesh *mesh;  // 2 x 2 x 2 unit cubes; node array `height` = z; triangles: see set_up
  vsc_surface boundary;
} fixture;

// Lists the boundary triangles on z = 0 as triangles of the file, turned the other way round, value
// 1; then those at z = 2, value 3; then an inner face, value 2.
static void list_triangles(fixture *f)
{
  vsc_mesh *mesh = f->mesh;
  vsc_free(mesh->triangles);
  assert_true(VSC_NEW(mesh->triangles, 3 * f->boundary.count));
  vsc_array *mark = vsc_arrays_add(&mesh->triangle_data, "mark", 1, f->boundary.count);
  size_t count = 0;
  for (size_t t = 0; t < f->boundary.count; t++) {
    const uint32_t *node = f->boundary.triangles + 3 * t;
    double height = 0;
    for (int i = 0; i < 3; i++) height += mesh->nodes[3 * (size_t)node[i] + 2];
    if (height > 0 && height < 6) continue;
    for (int i = 0; i < 3; i++) mesh->triangles[3 * count + (size_t)i] = node[2 - i];
    mark->values[count++] = height > 0 ? 3 : 1;
  }
  const uint32_t inner[3] = {box_node(SIZE, 0, 0, 0), box_node(SIZE, 1, 0, 0),
                             box_node(SIZE, 1, 1, 1)};
  memcpy(mesh->triangles + 3 * count, inner, sizeof inner);
  mark->values[count++] = 2;
  mark->tuples = mesh->triangle_count = count;
}

static int set_up(void **state)
{
  static fixture f;
  f.mesh = box_mesh(SIZE, 1, NULL);
  vsc_array *height = vsc_arrays_add(&f.mesh->node_data, "height", 1, f.mesh->node_count);
  for (size_t i = 0; i < f.mesh->node_count; i++) height->values[i] = f.mesh->nodes[3 * i + 2];
  vsc_arrays_add(&f.mesh->node_data, "vector", 3, f.mesh->node_count);
  if (vsc_boundary(f.mesh, &f.boundary, NULL) != VSC_OK) return 1;
  list_triangles(&f);
  *state = &f;
  return 0;
}

static int tear_down(void **state)
{
  fixture *f = *state;
  vsc_surface_free(&f->boundary);
  vsc_mesh_free(f->mesh);
  return 0;
}

static const vsc_selector BOX = {.name = "corner", .kind = VSC_SELECT_BOX, .box_low = {-1, -1, -1},
                                 .box_high = {1, 1, 0}};
static const vsc_selector PLANE = {.name = "top", .kind = VSC_SELECT_PLANE, .point = {0, 0, 2},
                                   .normal = {0, 0, -7}, .tolerance = 0.1};
static const vsc_selector HEIGHT = {.name = "low", .kind = VSC_SELECT_NODE_ARRAY,
                                    .array = "height", .low = 0, .high = 1};
static const vsc_selector MARK = {.name = "base", .kind = VSC_SELECT_TRIANGLE_ARRAY,
                                  .array = "mark", .low = 1, .high = 1};

static size_t count_nodes(const fixture *f, const vsc_selector *selector,
                          const vsc_surface *surfaces, size_t surface_count)
{
  vsc_node_set set;
  assert_int_equal(vsc_select_nodes(f->mesh, selector, surfaces, surface_count, &set, NULL),
                   VSC_OK);
  assert_string_equal(set.name, selector->name);
  for (size_t i = 1; i < set.count; i++) assert_true(set.nodes[i] > set.nodes[i - 1]);
  const size_t count = set.count;
  vsc_node_set_free(&set);
  return count;
}

static void nodes_of_each_kind(void **state)
{
  const fixture *f = *state;
  const vsc_selector all = {.name = "all", .kind = VSC_SELECT_BOUNDARY};
  const vsc_selector named = {.name = "held", .kind = VSC_SELECT_SURFACE, .array = "base"};
  assert_int_equal(count_nodes(f, &BOX, NULL, 0), 4);
  assert_int_equal(count_nodes(f, &PLANE, NULL, 0), 9);
  vsc_selector flipped = PLANE;
  flipped.normal[2] = 1;
  assert_int_equal(count_nodes(f, &flipped, NULL, 0), 9);
  assert_int_equal(count_nodes(f, &HEIGHT, NULL, 0), 18);
  assert_int_equal(count_nodes(f, &MARK, NULL, 0), 9);
  assert_int_equal(count_nodes(f, &all, NULL, 0), 26);
  vsc_surface surfaces[2] = {{.name = "other"}};
  assert_int_equal(vsc_select_surface(f->mesh, &f->boundary, &MARK, &surfaces[1], NULL), VSC_OK);
  assert_int_equal(count_nodes(f, &named, surfaces, 2), 9);
  vsc_surface_free(&surfaces[1]);
}

static size_t count_triangles(const fixture *f, const vsc_selector *selector)
{
  vsc_surface surface;
  assert_int_equal(vsc_select_surface(f->mesh, &f->boundary, selector, &surface, NULL), VSC_OK);
  assert_string_equal(surface.name, selector->name);
  // Each triangle is one of the boundary's as it stands there, so it faces outwards.
  for (size_t t = 0; t < surface.count; t++) {
    size_t same = 0;
    for (size_t b = 0; b < f->boundary.count; b++)
      same += memcmp(surface.triangles + 3 * t, f->boundary.triangles + 3 * b,
                     3 * sizeof *surface.triangles) == 0;
    assert_int_equal(same, 1);
  }
  const size_t count = surface.count;
  vsc_surface_free(&surface);
  return count;
}

static void surfaces_of_each_kind(void **state)
{
  const fixture *f = *state;
  const vsc_selector all = {.name = "all", .kind = VSC_SELECT_BOUNDARY};
  assert_int_equal(count_triangles(f, &all), f->boundary.count);
  assert_int_equal(count_triangles(f, &BOX), 2);
  assert_int_equal(count_triangles(f, &PLANE), 8);
  assert_int_equal(count_triangles(f, &HEIGHT), 8 + 4 * 4);
  assert_int_equal(count_triangles(f, &MARK), 8);
}

static void assert_no_nodes(const fixture *f, const vsc_selector *selector, const char *words)
{
  vsc_node_set set;
  vsc_error error = {0};
  const vsc_surface surfaces[2] = {{.name = "endocardium"}, {.name = "epicardium"}};
  assert_int_equal(vsc_select_nodes(f->mesh, selector, surfaces, 2, &set, &error), VSC_INPUT);
  assert_ptr_equal(strstr(error.text, selector->name), error.text);
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
  assert_int_equal(set.count, 0);
  assert_null(set.nodes);
}

static void empty_sets_say_what_was_near(void **state)
{
  const fixture *f = *state;
  vsc_selector box = BOX, plane = PLANE, array = HEIGHT, mark = MARK;
  box.box_low[2] = box.box_high[2] = -5;
  assert_no_nodes(f, &box, "the mesh reaches from (0 0 0) to (2 2 2) mm");
  plane.point[2] = 3.5;
  assert_no_nodes(f, &plane, "the nearest one is 1.5 mm away");
  plane.normal[2] = 0;
  assert_no_nodes(f, &plane, "no direction");
  array.low = array.high = 7;
  assert_no_nodes(f, &array, "the array runs from 0 to 2");
  mark.low = mark.high = 5;
  assert_no_nodes(f, &mark, "the array runs from 1 to 3");
}

static void unknown_names_are_refused_with_the_nearest(void **state)
{
  const fixture *f = *state;
  vsc_selector array = HEIGHT, mark = MARK;
  vsc_copy_name(array.array, "hieght");
  assert_no_nodes(f, &array, "known arrays: height, vector; did you mean height?");
  vsc_copy_name(array.array, "vector");
  assert_no_nodes(f, &array, "3 components");
  vsc_copy_name(mark.array, "height");
  assert_no_nodes(f, &mark, "known arrays: mark");
  vsc_selector surface = {.name = "held", .kind = VSC_SELECT_SURFACE, .array = "epicard"};
  assert_no_nodes(f, &surface, "did you mean epicardium?");
  vsc_copy_name(surface.array, "zz");
  assert_no_nodes(f, &surface, "there is no surface zz among the 2");
  vsc_selector odd = {.name = "odd", .kind = (vsc_select_kind)99};
  assert_no_nodes(f, &odd, "unknown");
}

static void empty_surfaces_are_refused(void **state)
{
  const fixture *f = *state;
  vsc_surface surface;
  vsc_error error;
  vsc_selector inside = {.name = "inside", .kind = VSC_SELECT_BOX, .box_low = {1, 1, 1},
                         .box_high = {1, 1, 1}};
  assert_int_equal(vsc_select_surface(f->mesh, &f->boundary, &inside, &surface, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "selects 1 nodes"));
  vsc_selector inner = MARK;
  inner.low = inner.high = 2;
  assert_int_equal(vsc_select_surface(f->mesh, &f->boundary, &inner, &surface, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "base: of the file's 1 triangles with mark from 2 to 2, 1 are no faces"));
  inner.low = 1;  // beside faces of the boundary it is refused too
  assert_int_equal(vsc_select_surface(f->mesh, &f->boundary, &inner, &surface, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "base: of the file's 9 triangles with mark from 1 to 2, 1 are no faces"));
  const vsc_selector named = {.name = "s", .kind = VSC_SELECT_SURFACE, .array = "base"};
  assert_int_equal(vsc_select_surface(f->mesh, &f->boundary, &named, &surface, &error), VSC_INPUT);
  assert_null(surface.triangles);
}

// Of an array in single precision the bounds are rounded as its values are: 0.7 takes what a file calls 0.7.
static void single_precision_is_compared_as_such(void **state)
{
  fixture *f = *state;
  vsc_array *depth = vsc_arrays_add(&f->mesh->node_data, "depth", 1, f->mesh->node_count);
  for (size_t i = 0; i < f->mesh->node_count; i++)
    depth->values[i] = f->mesh->nodes[3 * i + 2] == 2 ? 0.7f : 0.1f;
  vsc_selector some = {.name = "some", .kind = VSC_SELECT_NODE_ARRAY, .array = "depth", .low = 0.7, .high = 1e300};
  assert_no_nodes(f, &some, "the array runs from 0.1");
  depth->single = true;
  assert_int_equal(count_nodes(f, &some, NULL, 0), 9);
  some.low = some.high = 0.1;
  assert_int_equal(count_nodes(f, &some, NULL, 0), 18);
  some.low = -1e300;
  some.high = 0.0999999;
  assert_no_nodes(f, &some, "the array runs from 0.100000001 to 0.69999998");
  vsc_array *mark = &f->mesh->triangle_data.items[0];
  vsc_selector base = MARK;
  for (size_t t = 0; t < mark->tuples; t++) mark->values[t] = (float)(0.1 * mark->values[t]);
  base.low = base.high = 0.1;
  assert_no_nodes(f, &base, "no value of array mark");
  mark->single = true;
  assert_int_equal(count_triangles(f, &base), 8);
}

// Two bricks, one on the other, with `count` triangles (corners by x, y and z) marked 1.
static vsc_mesh *two_bricks(size_t count, const uint32_t (*triangles)[3])
{
  const uint8_t kinds[2] = {VSC_HEX, VSC_HEX};
  vsc_mesh *mesh = vsc_mesh_create_cells(12, 2, kinds, count);
  for (uint32_t i = 0; i < 12; i++)
    for (uint32_t a = 0; a < 3; a++) mesh->nodes[3 * i + a] = (a == 0 ? i % 2 : a == 1 ? i / 2 % 2 : i / 4);
  for (uint32_t c = 0; c < 16; c++)
    mesh->corners[c] = (const uint32_t[8]){0, 1, 3, 2, 4, 5, 7, 6}[c % 8] + 4 * (c / 8);
  vsc_array *mark = vsc_arrays_add(&mesh->triangle_data, "mark", 1, count);
  for (size_t t = 0; t < count; t++) {
    memcpy(mesh->triangles + 3 * t, triangles[t], sizeof triangles[t]);
    mark->values[t] = 1;
  }
  vsc_error error;
  if (vsc_mesh_clean(mesh, "bricks", &error) != VSC_OK) fail_msg("%s", error.text);
  return mesh;
}

static vsc_status select_on_bricks(size_t count, const uint32_t (*triangles)[3], size_t *found, vsc_error *error)
{
  vsc_mesh *mesh = two_bricks(count, triangles);
  vsc_surface boundary, surface;
  assert_int_equal(vsc_boundary(mesh, &boundary, NULL), VSC_OK);
  const vsc_status status = vsc_select_surface(mesh, &boundary, &MARK, &surface, error);
  *found = surface.count;
  vsc_surface_free(&surface);
  vsc_surface_free(&boundary);
  vsc_mesh_free(mesh);
  return status;
}

// The top (8 to 11) is cut from 8 to 11 here, and a side (0, 1, 4, 5) from 0 to 5.
static void quadrilaterals_may_be_cut_either_way(void **state)
{
  (void)state;
  static const uint32_t same[2][3] = {{8, 9, 11}, {8, 11, 10}}, other[2][3] = {{9, 11, 10}, {8, 9, 10}};
  static const uint32_t mixed[4][3] = {{9, 11, 10}, {4, 0, 1}, {8, 9, 10}, {1, 5, 4}};
  static const uint32_t inside[3][3] = {{4, 5, 6}, {6, 5, 7}, {8, 9, 11}}, across[2][3] = {{8, 9, 11}, {0, 3, 11}};
  size_t found;
  vsc_error error;
  assert_int_equal(select_on_bricks(2, same, &found, &error), VSC_OK);
  assert_int_equal(found, 2);
  assert_int_equal(select_on_bricks(1, same, &found, &error), VSC_OK);
  assert_int_equal(found, 1);
  assert_int_equal(select_on_bricks(2, other, &found, &error), VSC_OK);
  assert_int_equal(found, 2);
  assert_int_equal(select_on_bricks(4, mixed, &found, &error), VSC_OK);
  assert_int_equal(found, 4);
  // half of a face cut the other way, the face between the bricks, and no face at all
  assert_int_equal(select_on_bricks(1, other, &found, &error), VSC_INPUT);
  assert_int_equal(select_on_bricks(3, mixed, &found, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "the file's 3 triangles with mark from 1 to 1, 1 are no faces"));
  assert_non_null(strstr(error.text, "between points 4, 0, 1:"));
  assert_int_equal(select_on_bricks(3, inside, &found, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "3 triangles with mark from 1 to 1, 2 are no faces"));
  assert_int_equal(select_on_bricks(2, across, &found, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "between points 0, 3, 11:"));
}

static void short_memory_is_reported(void **state)
{
  const fixture *f = *state;
  const vsc_selector *selectors[] = {&MARK, &HEIGHT};
  for (int s = 0; s < 2; s++)
    for (long after = 0; after < 5; after++) {
      vsc_surface surface;
      vsc_alloc_fail_after(after);
      const vsc_status status =
        vsc_select_surface(f->mesh, &f->boundary, selectors[s], &surface, NULL);
      vsc_alloc_fail_after(-1);
      assert_int_equal(status, VSC_SYSTEM);
      assert_null(surface.triangles);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test_setup_teardown(nodes_of_each_kind, set_up, tear_down),
    cmocka_unit_test_setup_teardown(surfaces_of_each_kind, set_up, tear_down),
    cmocka_unit_test_setup_teardown(empty_sets_say_what_was_near, set_up, tear_down),
    cmocka_unit_test_setup_teardown(unknown_names_are_refused_with_the_nearest, set_up, tear_down),
    cmocka_unit_test_setup_teardown(empty_surfaces_are_refused, set_up, tear_down),
    cmocka_unit_test_setup_teardown(single_precision_is_compared_as_such, set_up, tear_down),
    cmocka_unit_test(quadrilaterals_may_be_cut_either_way),
    cmocka_unit_test_setup_teardown(short_memory_is_reported, set_up, tear_down),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
