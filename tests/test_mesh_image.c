// SPDX-License-Identifier: GPL-3.0-or-later
#include <stdlib.h>

#include "base/mem.h"
#include "close.h"
#include "mesh/image.h"

static void a_new_image_is_plain(void **state)
{
  (void)state;
  const size_t size[3] = {2, 3, 4};
  vsc_image *image = vsc_image_create(size);
  double position[3];
  vsc_image_position(image, (double[]){1, 2, 3}, position);
  for (int i = 0; i < 3; i++) {
    assert_int_equal(image->size[i], size[i]);
    assert_close(position[i], i + 1, 0, 0);
  }
  vsc_image_free(image);
  vsc_image_free(NULL);
  vsc_alloc_fail_after(0);
  assert_null(vsc_image_create(size));
}

// A known position, with a left-handed direction: i -> y, j -> x, k -> z.
static void position_by_hand(void **state)
{
  (void)state;
  vsc_image *image = vsc_image_create((size_t[]){2, 2, 2});
  const double direction[9] = {0, 1, 0, 1, 0, 0, 0, 0, 1};
  for (int i = 0; i < 9; i++) image->direction[i] = direction[i];
  for (int i = 0; i < 3; i++) {
    image->origin[i] = 10 * (i + 1);
    image->spacing[i] = 0.5 * (i + 1);
  }
  double position[3], index[3];
  vsc_image_position(image, (double[]){4, 6, 8}, position);
  assert_close(position[0], 10 + 6, 1e-15, 0);
  assert_close(position[1], 20 + 2, 1e-15, 0);
  assert_close(position[2], 30 + 12, 1e-15, 0);
  vsc_image_index(image, position, index);
  for (int i = 0; i < 3; i++) assert_close(index[i], 4 + 2 * i, 1e-15, 0);
  vsc_image_free(image);
}

static void index_inverts_position(void **state)
{
  (void)state;
  srand(3);
  vsc_image *image = vsc_image_create((size_t[]){2, 2, 2});
  for (int round = 0; round < 1000; round++) {
    double there[3], position[3], back[3];
    for (int i = 0; i < 3; i++) {
      image->origin[i] = 100.0 * rand() / RAND_MAX - 50;
      image->spacing[i] = 0.1 + 3.0 * rand() / RAND_MAX;
      there[i] = 200.0 * rand() / RAND_MAX - 100;
    }
    for (int i = 0; i < 9; i++)
      image->direction[i] = (i % 4 == 0 ? (round % 2 ? 1 : -1) : 0) + 0.4 * rand() / RAND_MAX - 0.2;
    vsc_image_position(image, there, position);
    vsc_image_index(image, position, back);
    for (int i = 0; i < 3; i++) assert_close(back[i], there[i], 1e-10, 1e-10);
  }
  vsc_image_free(image);
}

// Cells of 2 x 3 points in one slice, turned and moved.
static void cells_take_the_place_of_points(void **state)
{
  (void)state;
  vsc_image *image = vsc_image_create((size_t[]){2, 3, 1});
  const double direction[9] = {0, 1, 0, 1, 0, 0, 0, 0, 1};
  for (int i = 0; i < 9; i++) image->direction[i] = direction[i];
  for (int i = 0; i < 3; i++) {
    image->origin[i] = 10 * (i + 1);
    image->spacing[i] = 0.5 * (i + 1);
  }
  vsc_arrays_add(&image->data, "on points", 1, 6);
  vsc_arrays_add(&image->cell_data, "on cells", 1, 2)->values[1] = 7;
  vsc_image_take_cells(image);
  const size_t size[3] = {1, 2, 1};
  assert_memory_equal(image->size, size, sizeof size);
  assert_null(vsc_arrays_find(&image->data, "on points"));
  assert_close(vsc_arrays_find(&image->data, "on cells")->values[1], 7, 0, 0);
  assert_int_equal(image->cell_data.count, 0);
  assert_close(image->origin[0], 10.5, 1e-15, 0);
  assert_close(image->origin[1], 20.25, 1e-15, 0);
  assert_close(image->origin[2], 30, 1e-15, 0);
  vsc_image_free(image);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(a_new_image_is_plain),
    cmocka_unit_test(position_by_hand),
    cmocka_unit_test(index_inverts_position),
    cmocka_unit_test(cells_take_the_place_of_points),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
