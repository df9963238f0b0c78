// SPDX-License-Identifier: GPL-3.0-or-later
// How few elements lie through walls: of boxes of one to four layers, of a thin wall on a thick block.
#include "mesh/layers.h"

#include "box_mesh.h"
#include "close.h"
#include "hybrid_mesh.h"

static vsc_mesh *clean_box(int x, int y, int z, double h, int (*solid)(int, int, int))
{
  const int cells[3] = {x, y, z};
  vsc_mesh *mesh = box_mesh_raw(cells, h, solid);
  assert_int_equal(vsc_mesh_clean(mesh, "box", NULL), VSC_OK);
  return mesh;
}

// The part of the elements that have the flag.
static double part_with(const vsc_mesh *mesh, int flag)
{
  size_t count = 0;
  uint8_t *flags = calloc(mesh->element_count, 1);
  assert_int_equal(vsc_mesh_layers(mesh, flags, NULL), VSC_OK);
  for (size_t e = 0; e < mesh->element_count; e++) count += (flags[e] & flag) != 0;
  free(flags);
  return (double)count / (double)mesh->element_count;
}

static void layers_of_a_plate(void **state)
{
  (void)state;
  const struct {
    int layers;
    double one, few;  // but for elements in the plate's corners
  } plates[] = {{1, 1, 1}, {2, 0, 1}, {3, 0, 0}, {4, 0, 0}};
  for (size_t k = 0; k < sizeof plates / sizeof plates[0]; k++) {
    vsc_mesh *mesh = clean_box(10, 10, plates[k].layers, 1, NULL);
    print_message("%d layers: on the surface %.2f, one %.2f, few %.2f\n", plates[k].layers, part_with(mesh, VSC_ON_SURFACE),
                  part_with(mesh, VSC_ONE_LAYER), part_with(mesh, VSC_FEW_LAYERS));
    assert_close(part_with(mesh, VSC_ONE_LAYER), plates[k].one, 0, 0.02);
    assert_close(part_with(mesh, VSC_FEW_LAYERS), plates[k].few, 0, 0.1);
    vsc_mesh_free(mesh);
  }
}

static int block_with_a_wall(int i, int j, int k)
{
  (void)j;
  return i < 6 || k == 0;
}

// A wall of 14 x 6 cells, one thick, on a block of 6 x 6 x 6; but for its first row, which is beside nodes inside the block.
static void a_wall_on_a_block(void **state)
{
  (void)state;
  vsc_mesh *mesh = clean_box(20, 6, 6, 1, block_with_a_wall);
  const double cells = 6 * 6 * 6 + 14 * 6, found = part_with(mesh, VSC_ONE_LAYER) * cells;
  print_message("%.1f cells have one layer\n", found);
  assert_true(found > 13 * 6 - 1 && found < 14 * 6 + 1);
  vsc_mesh_free(mesh);
}

static void slenderness_by_hand(void **state)
{
  (void)state;
  vsc_mesh *cube = clean_box(2, 2, 2, 0.5, NULL), *beam = clean_box(10, 1, 1, 3, NULL);
  assert_close(vsc_mesh_slenderness(cube), 3 * sqrt(3), 1e-12, 0);
  assert_close(vsc_mesh_slenderness(beam), 0.5 * sqrt(102) * 42 / 10, 1e-12, 0);
  vsc_mesh_free(cube);
  vsc_mesh_free(beam);
  vsc_mesh *mixed = hybrid_block(3, 0, 5);
  assert_close(vsc_mesh_slenderness(mixed), 3 * sqrt(3), 1e-9, 0);
  assert_close(part_with(mixed, VSC_ONE_LAYER), 0, 0, 0.1);
  vsc_mesh_free(mixed);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(layers_of_a_plate),
      cmocka_unit_test(a_wall_on_a_block),
      cmocka_unit_test(slenderness_by_hand),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
