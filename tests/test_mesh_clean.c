// SPDX-License-Identifier: GPL-3.0-or-later
// Cleaning elements of all linear kinds, and surfaces; tets alone are in test_mesh_mesh.c, quadratic
// ones in test_mesh_quadratic.c.
#include "base/vec3.h"
#include "close.h"
#include "hybrid_mesh.h"

// One sound element of each kind, bent a little.
static const double SOUND[VSC_CELLS][8][3] = {
    [VSC_TET] = {{0, 0, 0}, {1, 0, 0.1}, {0.2, 1, 0}, {0, 0.1, 1}},
    [VSC_HEX] = {{0, 0, 0},
                 {1, 0.1, 0},
                 {1.1, 1, 0.1},
                 {0, 1, 0},
                 {0, 0.1, 1},
                 {1, 0, 1.2},
                 {0.9, 1, 1},
                 {0.1, 1, 1.1}},
    [VSC_WEDGE] = {{0, 0, 0}, {1, 0.1, 0}, {0, 1, 0.1}, {0, 0.1, 1}, {1.1, 0, 1}, {0.1, 1, 1.2}},
    [VSC_PYRAMID] = {{0, 0, 0}, {1, 0, 0.1}, {1.1, 1, 0}, {0, 1, 0.1}, {0.4, 0.5, 1}}};

// A raw mesh of a tet (cell 3) and, apart from it, an element of the given kind (cell 77) whose
// corners lie at `at` and whose first node is 4.
static vsc_mesh *tet_and(vsc_cell kind, const double (*at)[3])
{
  const uint8_t kinds[2] = {VSC_TET, (uint8_t)kind};
  const size_t corners = (size_t)vsc_cells[kind].corners;
  vsc_mesh *mesh = vsc_mesh_create_cells(4 + corners, 2, kinds, 0);
  assert_non_null(mesh);
  for (size_t i = 0; i < 4 + corners; i++) mesh->corners[i] = (uint32_t)i;
  memcpy(mesh->nodes, SOUND[VSC_TET], 12 * sizeof(double));
  for (size_t i = 0; i < corners; i++) memcpy(mesh->nodes + 12 + 3 * i, at[i], sizeof at[i]);
  mesh->element_source[0] = 3;
  mesh->element_source[1] = 77;
  return mesh;
}

// Cleans and frees the mesh, which must be refused with these words.
static void assert_refused(vsc_mesh *mesh, const char *words)
{
  vsc_error error = {0};
  assert_int_equal(vsc_mesh_clean(mesh, "organ.vtu", &error), VSC_INPUT);
  assert_ptr_equal(strstr(error.text, "organ.vtu: "), error.text);
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
  vsc_mesh_free(mesh);
}

static void each_kind_is_turned_in_its_way(void **state)
{
  (void)state;
  static const uint32_t turned[VSC_CELLS][8] = {
      {4, 5, 7, 6}, {8, 9, 10, 11, 4, 5, 6, 7}, {7, 8, 9, 4, 5, 6}, {4, 7, 6, 5, 8}};
  for (int kind = 0; kind <= VSC_PYRAMID; kind++) {
    double mirrored[8][3];
    memcpy(mirrored, SOUND[kind], sizeof mirrored);
    for (int i = 0; i < 8; i++) mirrored[i][0] *= -1;
    vsc_mesh *straight = tet_and((vsc_cell)kind, SOUND[kind]);
    vsc_mesh *mesh = tet_and((vsc_cell)kind, (const double(*)[3])mirrored);
    assert_int_equal(vsc_mesh_clean(straight, "m", NULL), VSC_OK);
    assert_int_equal(vsc_mesh_clean(mesh, "m", NULL), VSC_OK);
    assert_int_equal(straight->report.turned_elements, 0);
    assert_int_equal(mesh->report.turned_elements, 1);
    assert_memory_equal(mesh->corners + 4, turned[kind],
                        (size_t)vsc_cells[kind].corners * sizeof(uint32_t));
    // mirroring changes no product, turning only the order of sums
    assert_close(vsc_mesh_element_volume(mesh, 1), vsc_mesh_element_volume(straight, 1), 1e-15, 0);
    vsc_mesh_free(mesh);
    vsc_mesh_free(straight);
  }
}

static void broken_elements_are_named_by_kind(void **state)
{
  (void)state;
  for (int kind = 0; kind <= VSC_PYRAMID; kind++) {
    char words[160];
    const char *name = vsc_cells[kind].name;
    double flat[8][3];
    memcpy(flat, SOUND[kind], sizeof flat);
    for (int i = 0; i < 8; i++) flat[i][2] = 0;
    snprintf(words, sizeof words,
             "degenerate, with a volume below 1e-12 of the longest edge "
             "cubed: 1 %s (cells 77): ",
             name);
    assert_refused(tet_and((vsc_cell)kind, (const double(*)[3])flat), words);

    vsc_mesh *mesh = tet_and((vsc_cell)kind, SOUND[kind]);
    mesh->corners[4 + 3] = mesh->corners[4 + 1];
    snprintf(words, sizeof words, "the same point twice in 1 %s (cells 77): ", name);
    assert_refused(mesh, words);

    mesh = tet_and((vsc_cell)kind, SOUND[kind]);
    mesh->corners[4 + 2] = (uint32_t)mesh->node_count;
    snprintf(words, sizeof words, "not among the %zu of the mesh are named by 1 %s (cells 77)",
             mesh->node_count, name);
    assert_refused(mesh, words);

    mesh = tet_and((vsc_cell)kind, SOUND[kind]);
    mesh->nodes[3 * 6] = NAN;
    assert_refused(mesh, "1 points have coordinates that are not finite numbers (points 6)");
  }
}

// A corner pulled through the element: its volume is still positive, a Jacobian is not.
static void folded_elements_are_refused(void **state)
{
  (void)state;
  static const struct {
    vsc_cell kind;
    int corner;
    double to[3];
  } folds[] = {{VSC_HEX, 6, {0.02, 0.02, 0.02}},
               {VSC_WEDGE, 5, {0.1, -0.6, 1}},
               {VSC_PYRAMID, 2, {0.2, 0.2, 0}}};
  for (size_t f = 0; f < sizeof folds / sizeof folds[0]; f++) {
    double at[8][3];
    char words[100];
    memcpy(at, SOUND[folds[f].kind], sizeof at);
    memcpy(at[folds[f].corner], folds[f].to, sizeof at[0]);
    vsc_mesh *mesh = tet_and(folds[f].kind, (const double(*)[3])at);
    assert_true(vsc_mesh_element_volume(mesh, 1) > 0.04);
    snprintf(words, sizeof words, "point: 1 %s (cells 77)", vsc_cells[folds[f].kind].name);
    assert_refused(mesh, words);
  }
  // a hexahedron whose points are in a voxel's order
  vsc_mesh *mesh = tet_and(VSC_HEX, SOUND[VSC_HEX]);
  static const uint32_t order[8] = {4, 5, 7, 6, 8, 9, 11, 10};
  memcpy(mesh->corners + 4, order, sizeof order);
  assert_refused(mesh, "1 hexahedron");
}

static void several_kinds_are_counted(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0, 1);
  size_t counts[VSC_CELLS] = {0};
  for (size_t e = 0; e < mesh->element_count; e++) {
    counts[mesh->kinds[e]]++;
    if (counts[mesh->kinds[e]] <= 2 || mesh->kinds[e] == VSC_PYRAMID)
      mesh->corners[mesh->start[e] + 1] = mesh->corners[mesh->start[e]];
  }
  char words[160], text[160];
  snprintf(words, sizeof words, "twice in 2 tetrahedra, 2 hexahedra, 2 wedges, %zu pyramids (",
           counts[VSC_PYRAMID]);
  assert_refused(mesh, words);
  mesh = hybrid_block(1, 0, 1);
  assert_string_equal(vsc_mesh_kinds_text(mesh, text, sizeof text), "1 hexahedron");
  mesh->element_count = 0;
  assert_string_equal(vsc_mesh_kinds_text(mesh, text, sizeof text), "no elements");
  const size_t all[VSC_CELLS] = {1000000, 2, 1, 10};
  for (size_t size = 1; size < sizeof text; size++) {
    memset(text, 'x', sizeof text);
    assert_true(strlen(vsc_spell_kinds(all, text, size)) < size);
  }
  assert_string_equal(text, "1000000 tetrahedra, 2 hexahedra, 1 wedge, 10 pyramids");
  vsc_mesh_free(mesh);
}

// A unit cube, cell 10, with a point above it: on its top `tets` tets (cells 11 ..) or a pyramid.
static vsc_mesh *roofed(int tets)
{
  static const double top[3] = {0.5, 0.5, 2};
  static const uint32_t cube[8] = {0, 1, 2, 3, 4, 5, 6, 7}, pyramid[5] = {4, 5, 6, 7, 8};
  static const uint32_t halves[2][4] = {{4, 5, 6, 8}, {4, 6, 7, 8}};
  const uint8_t kinds[3] = {VSC_HEX, tets ? VSC_TET : VSC_PYRAMID, VSC_TET};
  vsc_mesh *mesh = vsc_mesh_create_cells(9, tets == 2 ? 3 : 2, kinds, 0);
  for (int i = 0; i < 8; i++) {
    const double x[3] = {(i + 1) / 2 % 2, i / 2 % 2, i / 4};
    memcpy(mesh->nodes + 3 * i, x, sizeof x);
  }
  memcpy(mesh->nodes + 24, top, sizeof top);
  memcpy(mesh->corners, cube, sizeof cube);
  if (tets == 0) memcpy(mesh->corners + 8, pyramid, sizeof pyramid);
  for (int t = 0; t < tets && t < 2; t++)
    memcpy(mesh->corners + 8 + 4 * t, halves[t], sizeof halves[t]);
  for (size_t e = 0; e < mesh->element_count; e++) mesh->element_source[e] = (uint32_t)(10 + e);
  return mesh;
}

static void triangles_on_a_quadrilateral_do_not_conform(void **state)
{
  (void)state;
  vsc_mesh *mesh = roofed(0);
  assert_int_equal(vsc_mesh_clean(mesh, "m", NULL), VSC_OK);
  vsc_mesh_free(mesh);
  for (int tets = 1; tets <= 2; tets++)
    for (uint32_t turn = 0; turn < 4; turn++) {
      mesh = roofed(tets);
      // whichever corner of the cube is its first
      for (size_t i = 0; i < 8; i++) mesh->corners[i] = (uint32_t)(i / 4 * 4 + (i + turn) % 4);
      assert_refused(mesh,
                     "not conforming, with triangles of other elements on a quadrilateral "
                     "face: 1 hexahedron (cells 10): put pyramids between");
    }
}

// Two triangles on nodes 1, 2, 4, 5 of six; the others are not finite.
static vsc_mesh *sheet(void)
{
  static const uint32_t triangles[6] = {1, 2, 4, 4, 2, 5};
  vsc_mesh *mesh = vsc_mesh_create(6, 0, 2);
  for (int i = 0; i < 6; i++) mesh->nodes[3 * i] = i % 3 == 0 ? NAN : i % 3;
  for (int i = 0; i < 6; i++) mesh->nodes[3 * i + 1] = i / 3;
  memcpy(mesh->triangles, triangles, sizeof triangles);
  vsc_arrays_add(&mesh->node_data, "n", 1, 6)->values[4] = 7;
  vsc_arrays_add(&mesh->triangle_data, "t", 1, 2)->values[1] = 8;
  return mesh;
}

static void a_surface_keeps_its_nodes(void **state)
{
  (void)state;
  static const uint32_t triangles[6] = {0, 1, 2, 2, 1, 3}, sources[4] = {1, 2, 4, 5};
  vsc_mesh *mesh = sheet();
  vsc_error error;
  if (vsc_mesh_clean(mesh, "m", &error) != VSC_OK) fail_msg("%s", error.text);
  assert_int_equal(mesh->node_count, 4);
  assert_int_equal(mesh->triangle_count, 2);
  assert_int_equal(mesh->report.unused_nodes, 2);
  assert_int_equal(mesh->report.loose_triangles, 0);
  assert_memory_equal(mesh->triangles, triangles, sizeof triangles);
  assert_memory_equal(mesh->node_source, sources, sizeof sources);
  assert_close(vsc_arrays_find(&mesh->node_data, "n")->values[2], 7, 0, 0);
  assert_close(vsc_arrays_find(&mesh->triangle_data, "t")->values[1], 8, 0, 0);
  vsc_mesh_free(mesh);
}

static void broken_surfaces_are_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = sheet();
  mesh->triangles[4] = 4;
  assert_refused(mesh, "1 triangles are degenerate");
  mesh = sheet();
  mesh->nodes[3 * 5 + 1] = 0.5;
  mesh->nodes[3 * 5] = 1.5;
  assert_refused(mesh, "(triangles 1, counted among the triangles)");
  mesh = sheet();
  mesh->nodes[3 * 5 + 2] = INFINITY;
  assert_refused(mesh, "points 5");
  mesh = sheet();
  mesh->triangles[0] = 6;
  assert_refused(mesh, "1 triangles name points");
  assert_refused(vsc_mesh_create(6, 0, 0), "neither elements");
}

static void short_memory_is_reported(void **state)
{
  (void)state;
  for (long after = 0;; after++) {
    vsc_mesh *mesh = hybrid_block(2, 0, 1);
    vsc_error error = {0};
    vsc_alloc_fail_after(after);
    const vsc_status status = vsc_mesh_clean(mesh, "m", &error);
    vsc_alloc_fail_after(-1);
    vsc_mesh_free(mesh);
    if (status == VSC_OK) {
      assert_int_equal(after, 10);  // used nodes, topology's seven lists, two of the squeezing
      return;
    }
    assert_int_equal(status, VSC_SYSTEM);
    assert_non_null(strstr(error.text, "memory"));
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(each_kind_is_turned_in_its_way),
      cmocka_unit_test(broken_elements_are_named_by_kind),
      cmocka_unit_test(folded_elements_are_refused),
      cmocka_unit_test(several_kinds_are_counted),
      cmocka_unit_test(triangles_on_a_quadrilateral_do_not_conform),
      cmocka_unit_test(a_surface_keeps_its_nodes),
      cmocka_unit_test(broken_surfaces_are_refused),
      cmocka_unit_test(short_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
