// SPDX-License-Identifier: GPL-3.0-or-later
// Nodes at one place are found wherever they lie, and only they.
#include "base/mem.h"
#include "box_mesh.h"
#include "close.h"
#include "mesh/coincident.h"

static size_t count_of(const vsc_mesh *mesh)
{
  size_t count;
  assert_int_equal(vsc_mesh_coincident(mesh, &count, NULL), VSC_OK);
  return count;
}

// The nodes of a box `copies` times, each copy moved by `off` from the last; far from the origin.
static vsc_mesh *copies_of(int copies, const double off[3])
{
  const int n[3] = {3, 4, 2};
  vsc_mesh *one = box_mesh(n, 0.7, NULL);
  const size_t nodes = one->node_count, tets = one->element_count;
  vsc_mesh *all = vsc_mesh_create((size_t)copies * nodes, (size_t)copies * tets, 0);
  if (all == NULL) fail_msg("no memory");
  for (size_t i = 0; i < all->node_count; i++)
    for (size_t a = 0; a < 3; a++)
      all->nodes[3 * i + a] = 40 + one->nodes[3 * (i % nodes) + a] + (double)(i / nodes) * off[a];
  for (size_t k = 0; k < 4 * all->element_count; k++)
    all->corners[k] = one->corners[k % (4 * tets)] + (uint32_t)(nodes * (k / (4 * tets)));
  vsc_mesh_free(one);
  return all;
}

static void copies_are_found(void **state)
{
  (void)state;
  const struct {
    int copies;
    double off[3];
    size_t count;
  } cases[] = {{1, {0, 0, 0}, 0},
               {2, {0, 0, 0}, 120},
               {5, {0, 0, 0}, 300},
               {2, {2.1, 0, 0}, 30},        // side by side: the common face
               {2, {0, 0, 1e-5}, 120},      // off by rounding, also where a cell of the grid ends
               {2, {-3e-5, 2e-5, -2e-5}, 120},
               {2, {0, 3e-4, 0}, 0}};       // far enough
  for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
    vsc_mesh *mesh = copies_of(cases[k].copies, cases[k].off);
    if (count_of(mesh) != cases[k].count) fail_msg("case %zu: %zu nodes", k, count_of(mesh));
    vsc_mesh_free(mesh);
  }
}

// The grid is shifted against the nodes, by less than they are apart, through more than one of its cells (0.007 mm): pairs
// at sides and corners of cells are found.
static void pairs_across_cells_are_found(void **state)
{
  (void)state;
  for (int k = 0; k < 900; k++) {
    vsc_mesh *mesh = copies_of(2, (double[3]){4e-5, k % 2 == 0 ? 4e-5 : -4e-5, 1.5e-5});
    for (size_t a = 0; a < 3; a++)  // moves the grid
      for (size_t n = 0; n < 2; n++) mesh->nodes[3 * 60 * n + a] -= 1e-5 * k;
    assert_int_equal(count_of(mesh), 120);
    vsc_mesh_free(mesh);
  }
}

// One edge that is very long leaves the others what they are.
static void a_node_far_away(void **state)
{
  (void)state;
  vsc_mesh *mesh = copies_of(1, (double[3]){0, 0, 0});
  mesh->nodes[2] = -1e5;
  assert_int_equal(count_of(mesh), 0);
  vsc_mesh_free(mesh);
}

static void little_memory_is_reported(void **state)
{
  (void)state;
  vsc_mesh *mesh = copies_of(2, (double[3]){0, 0, 0});
  size_t count;
  for (long after = 0; after < 3; after++) {
    vsc_alloc_fail_after(after);
    assert_int_equal(vsc_mesh_coincident(mesh, &count, NULL), VSC_SYSTEM);
    assert_int_equal(count, 0);
  }
  vsc_alloc_fail_after(-1);
  assert_int_equal(count_of(mesh), 120);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(copies_are_found),
      cmocka_unit_test(pairs_across_cells_are_found),
      cmocka_unit_test(a_node_far_away),
      cmocka_unit_test(little_memory_is_reported),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
