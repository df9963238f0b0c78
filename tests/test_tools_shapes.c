// SPDX-License-Identifier: GPL-3.0-or-later
// The generated ventricle, its map and the block.
#include "close.h"

#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/sample.h"
#include "io/vtk.h"
#include "tools/shapes.h"
#include "tools/verbs.h"
#include "ventricle_volume.h"

static const double degree = M_PI / 180;
static const int faces[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};

static int by_nodes(const void *a, const void *b)
{
  return memcmp(a, b, 3 * sizeof(uint32_t));
}

static void sort_nodes(uint32_t *node, int count)
{
  for (int i = 1; i < count; i++)
    for (int j = i; j > 0 && node[j] < node[j - 1]; j--) {
      const uint32_t kept = node[j];
      node[j] = node[j - 1];
      node[j - 1] = kept;
    }
}

// All faces of all tets, sorted: 4 element_count x 3.
static uint32_t *sorted_faces(const vsc_mesh *mesh)
{
  uint32_t *list = test_malloc(12 * mesh->element_count * sizeof *list);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int f = 0; f < 4; f++) {
      uint32_t *face = &list[3 * (4 * e + (size_t)f)];
      for (int i = 0; i < 3; i++) face[i] = mesh->corners[4 * e + (size_t)faces[f][i]];
      sort_nodes(face, 3);
    }
  qsort(list, 4 * mesh->element_count, 3 * sizeof *list, by_nodes);
  return list;
}

// Every face belongs to one or two tets; every edge of the boundary to two boundary faces; and the
// boundary is a sphere: nodes - edges + faces = 2. Returns its number of faces.
static size_t check_conforming(const vsc_mesh *mesh)
{
  const size_t total = 4 * mesh->element_count;
  uint32_t *list = sorted_faces(mesh), *edges = test_calloc(9 * total, sizeof *edges);
  uint8_t *used = test_calloc(mesh->node_count, 1);
  size_t boundary = 0, nodes = 0;
  for (size_t k = 0, run; k < total; k += run) {
    for (run = 1; k + run < total && by_nodes(&list[3 * k], &list[3 * (k + run)]) == 0;) run++;
    assert_in_range(run, 1, 2);
    if (run == 2) continue;
    for (size_t i = 0; i < 3; i++) {
      uint32_t *edge = &edges[3 * (3 * boundary + i)];
      edge[0] = list[3 * k + i];
      edge[1] = list[3 * k + (i + 1) % 3];
      sort_nodes(edge, 2);
      nodes += !used[edge[0]];
      used[edge[0]] = 1;
      nodes += !used[edge[1]];
      used[edge[1]] = 1;
    }
    boundary++;
  }
  qsort(edges, 3 * boundary, 3 * sizeof *edges, by_nodes);
  for (size_t k = 0; k < 3 * boundary; k += 2) {
    assert_int_equal(by_nodes(&edges[3 * k], &edges[3 * (k + 1)]), 0);
    if (k > 0) assert_int_not_equal(by_nodes(&edges[3 * k], &edges[3 * (k - 1)]), 0);
  }
  assert_int_equal(2 * nodes + 2 * boundary, 3 * boundary + 4);
  test_free(used);
  test_free(edges);
  test_free(list);
  return boundary;
}

static double volume_of(const vsc_mesh *mesh)
{
  double volume = 0;
  for (size_t e = 0; e < mesh->element_count; e++) {
    const double part = vsc_mesh_element_volume(mesh, e);
    assert_true(part > 0);
    volume += part;
  }
  return volume;
}

// The mean ratio 12 (3 V)^(2/3) / sum of squared edges of the worst tet: 1 for a regular one.
static double worst_quality(const vsc_mesh *mesh)
{
  double worst = 1;
  for (size_t e = 0; e < mesh->element_count; e++) {
    double squares = 0;
    for (int i = 0; i < 4; i++)
      for (int j = i + 1; j < 4; j++) {
        double edge[3];
        vsc_subtract(&mesh->nodes[3 * (size_t)mesh->corners[4 * e + (size_t)i]],
                     &mesh->nodes[3 * (size_t)mesh->corners[4 * e + (size_t)j]], edge);
        squares += vsc_dot(edge, edge);
      }
    worst = fmin(worst, 12 * pow(3 * vsc_mesh_element_volume(mesh, e), 2.0 / 3) / squares);
  }
  return worst;
}

static const double *node_array(const vsc_mesh *mesh, const char *name)
{
  const vsc_array *array = vsc_arrays_find(&mesh->node_data, name);
  assert_non_null(array);
  return array->values;
}

static double wall_volume(const vsc_lv_shape *lv)
{
  return ventricle_volume(lv, 1) - ventricle_volume(lv, 0);
}

static void ventricle_is_human_sized_and_sound(void **state)
{
  (void)state;
  const vsc_lv_shape lv = vsc_lv_default();
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_lv_mesh(&lv, &mesh, NULL), VSC_OK);
  assert_in_range(mesh->element_count, 6000, 10000);
  check_conforming(mesh);
  assert_in_range(ventricle_volume(&lv, 0), 130000, 150000);
  assert_close(volume_of(mesh), wall_volume(&lv), 0.012, 0);
  assert_true(worst_quality(mesh) > 0.5);
  const double *endo = node_array(mesh, "endo"), *epi = node_array(mesh, "epi");
  const double *base = node_array(mesh, "base"), *rim = node_array(mesh, "rim");
  double lowest = 0;
  for (size_t i = 0; i < mesh->node_count; i++) {
    const double *x = &mesh->nodes[3 * i], depth = vsc_lv_depth(&lv, x);
    assert_true(depth > -1e-9 && depth < 1 + 1e-9 && x[2] <= lv.base);
    assert_int_equal(endo[i] == 1, fabs(depth) < 1e-9);
    assert_int_equal(epi[i] == 1, fabs(depth - 1) < 1e-9);
    assert_int_equal(base[i] == 1, x[2] == lv.base);
    assert_int_equal(rim[i] == 1, epi[i] == 1 && base[i] == 1);
    lowest = fmin(lowest, x[2]);
  }
  assert_close(lowest, -lv.epi_length, 0, 1e-9);
  assert_close(vsc_arrays_find(&mesh->element_data, "region")->values[17], 1, 0, 0);
  vsc_mesh_free(mesh);
}

// Twice as many bricks: a quarter of the error of the volume.
static void ventricle_converges(void **state)
{
  (void)state;
  double error[3];
  for (int k = 0; k < 3; k++) {
    vsc_lv_shape lv = vsc_lv_default();
    lv.around = (size_t)16 << k;
    lv.along = (size_t)7 << k;
    lv.layers = (size_t)1 << k;
    lv.base = -5;
    vsc_mesh *mesh = NULL;
    assert_int_equal(vsc_lv_mesh(&lv, &mesh, NULL), VSC_OK);
    check_conforming(mesh);
    error[k] = fabs(volume_of(mesh) / wall_volume(&lv) - 1);
    vsc_mesh_free(mesh);
  }
  assert_close(log2(error[0] / error[1]), 2, 0, 0.2);
  assert_close(log2(error[1] / error[2]), 2, 0, 0.1);
}

static void depth_and_volume(void **state)
{
  (void)state;
  const vsc_lv_shape lv = vsc_lv_default();
  const double middle[3] = {0, (26 + 35.5) / 2, 0}, apex[3] = {0, 0, -66 - 0.25 * 7};
  assert_close(vsc_lv_depth(&lv, middle), 0.5, 0, 1e-12);
  assert_close(vsc_lv_depth(&lv, apex), 0.25, 0, 1e-12);
  const double inside[3] = {26, 0, 0}, outside[3] = {0, 35.5, 0};
  double frame[9];
  vsc_lv_frame(&lv, inside, 50 * degree, -40 * degree, frame);
  assert_close(frame[1], cos(50 * degree), 0, 1e-12);
  assert_close(frame[2], sin(50 * degree), 0, 1e-12);
  vsc_lv_frame(&lv, outside, 50 * degree, -40 * degree, frame);
  assert_close(frame[0], -cos(40 * degree), 0, 1e-12);
  assert_close(frame[2], -sin(40 * degree), 0, 1e-12);
  double volume = 0;
  for (int i = 0; i < 100000; i++) {
    const double z = -66 + 86 * (i + 0.5) / 100000;
    volume += M_PI * 26 * 26 * (1 - z * z / (66 * 66)) * 86 / 100000;
  }
  assert_close(ventricle_volume(&lv, 0), volume, 1e-8, 0);
}

static void map_holds_the_helix(void **state)
{
  (void)state;
  const vsc_lv_shape lv = vsc_lv_default();
  vsc_image *image = NULL;
  assert_int_equal(vsc_lv_map(&lv, 50 * degree, -40 * degree, 1.5, &image, NULL), VSC_OK);
  const double *azimuth = vsc_arrays_find(&image->data, "azimuth")->values;
  const double *elevation = vsc_arrays_find(&image->data, "elevation")->values;
  const double *tissue = vsc_arrays_find(&image->data, "tissue")->values;
  double count = 0;
  const size_t *size = image->size;
  for (size_t v = 0; v < size[0] * size[1] * size[2]; v++) {
    if (tissue[v] == 0) {
      assert_true(azimuth[v] == 0 && elevation[v] == 0);
      continue;
    }
    count++;
    const double index[3] = {(double)(v % size[0]), (double)(v / size[0] % size[1]),
                             (double)(v / size[0] / size[1])};
    double at[3], frame[9];
    for (int a = 0; a < 3; a++) assert_true(index[a] >= 1 && index[a] <= (double)size[a] - 2);
    vsc_image_position(image, index, at);
    vsc_lv_frame(&lv, at, 50 * degree, -40 * degree, frame);
    const double level = cos(elevation[v] * degree);
    const double f[3] = {level * cos(azimuth[v] * degree), level * sin(azimuth[v] * degree),
                         sin(elevation[v] * degree)};
    assert_true(azimuth[v] >= 0 && azimuth[v] < 180 && fabs(elevation[v]) <= 90);
    assert_close(fabs(vsc_dot(f, frame)), 1, 0, 1e-12);
  }
  assert_close(count * 1.5 * 1.5 * 1.5, wall_volume(&lv), 0.02, 0);
  vsc_image_free(image);
}

static void block_fills_its_box(void **state)
{
  (void)state;
  for (int tets = 5; tets <= 6; tets++)
    for (int jitter = 0; jitter < 2; jitter++) {
      const vsc_block_shape shape = {.cells = {5, 3, 4},
                                     .size = {10, 7, 3},
                                     .tets_per_cell = tets,
                                     .jitter = 0.25 * jitter,
                                     .seed = 9};
      vsc_mesh *mesh = NULL;
      assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
      assert_int_equal(mesh->node_count, 6 * 4 * 5);
      assert_int_equal(mesh->element_count, 60 * tets);
      assert_close(volume_of(mesh), 210, 1e-13, 0);
      assert_int_equal(check_conforming(mesh), 4 * (5 * 3 + 3 * 4 + 4 * 5));
      const char *names[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
      size_t moved = 0;
      for (size_t i = 0; i < mesh->node_count; i++) {
        for (int f = 0; f < 6; f++) {
          const double at = f % 2 == 0 ? 0 : shape.size[f / 2];
          assert_int_equal(node_array(mesh, names[f])[i] == 1,
                           mesh->nodes[3 * i + (size_t)f / 2] == at);
        }
        const double cells = mesh->nodes[3 * i] / 2;
        moved += fabs(cells - round(cells)) > 1e-6;
      }
      assert_int_equal(moved, jitter * 4 * 2 * 3);
      vsc_mesh_free(mesh);
    }
}

static void seeds_make_different_blocks(void **state)
{
  (void)state;
  vsc_mesh *mesh[3];
  vsc_block_shape shape = vsc_block_default();
  shape.jitter = 0.2;
  for (int k = 0; k < 3; k++) {
    shape.seed = k < 2 ? 4 : 5;
    assert_int_equal(vsc_block_mesh(&shape, &mesh[k], NULL), VSC_OK);
  }
  const size_t bytes = 3 * mesh[0]->node_count * sizeof(double);
  assert_memory_equal(mesh[0]->nodes, mesh[1]->nodes, bytes);
  assert_memory_not_equal(mesh[0]->nodes, mesh[2]->nodes, bytes);
  for (int k = 0; k < 3; k++) vsc_mesh_free(mesh[k]);
}

static void bad_shapes_are_refused(void **state)
{
  (void)state;
  vsc_mesh *mesh = NULL;
  vsc_image *image = NULL;
  vsc_error error = {.text = ""};
  for (int k = 0; k < 7; k++) {
    vsc_lv_shape lv = vsc_lv_default();
    if (k == 0) lv.endo_radius = 40;
    if (k == 1) lv.epi_length = NAN;
    if (k == 2) lv.base = 66;
    if (k == 3) lv.around = 30;
    if (k == 4) lv.along = 0;
    if (k == 5) lv.layers = 0;
    if (k == 6) lv.endo_radius = -1;
    const char *words[7] = {"below",      "below",      "base plane", "multiple of 4",
                            "at least 1", "at least 1", "above 0"};
    assert_int_equal(vsc_lv_mesh(&lv, &mesh, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, words[k]));
  }
  const vsc_lv_shape lv = vsc_lv_default();
  assert_int_equal(vsc_lv_map(&lv, 1, -1, 0, &image, &error), VSC_INPUT);
  assert_int_equal(vsc_lv_map(&lv, 1, -1, 1e-3, &image, &error), VSC_INPUT);
  for (int k = 0; k < 5; k++) {
    vsc_block_shape block = vsc_block_default();
    if (k == 0) block.cells[2] = 0;
    if (k == 1) block.size[1] = 0;
    if (k == 2) block.tets_per_cell = 7;
    if (k == 3) block.jitter = 0.4;
    if (k == 4) block.size[0] = INFINITY;
    assert_int_equal(vsc_block_mesh(&block, &mesh, &error), VSC_INPUT);
  }
}

static void little_memory_is_reported(void **state)
{
  (void)state;
  const vsc_lv_shape lv = {.endo_radius = 5,
                           .endo_length = 10,
                           .epi_radius = 8,
                           .epi_length = 12,
                           .base = 2,
                           .around = 8,
                           .along = 3,
                           .layers = 1};
  const vsc_block_shape block = vsc_block_default();
  for (int what = 0; what < 3; what++) {
    vsc_status status = VSC_SYSTEM;
    long allowed = 0;
    for (; status != VSC_OK; allowed++) {
      vsc_mesh *mesh = NULL;
      vsc_image *image = NULL;
      vsc_alloc_fail_after(allowed);
      if (what == 0) status = vsc_lv_mesh(&lv, &mesh, NULL);
      if (what == 1) status = vsc_lv_map(&lv, 1, -1, 1, &image, NULL);
      if (what == 2) status = vsc_block_mesh(&block, &mesh, NULL);
      assert_true(status == VSC_OK || status == VSC_SYSTEM);
      vsc_mesh_free(mesh);
      vsc_image_free(image);
    }
    vsc_alloc_fail_after(-1);
    assert_true(allowed > 4);
  }
}

// Runs the verb with stdout and stderr thrown away.
static int generate(int argc, const char *const *words)
{
  char *argv[12] = {(char[]){"generate"}};
  for (int i = 0; i < argc; i++) argv[i + 1] = strdup(words[i]);
  fflush(stdout);
  const int out = dup(1), err = dup(2), sink = open("/dev/null", O_WRONLY);
  dup2(sink, 1);
  dup2(sink, 2);
  const int code = vsc_verb_generate(argc + 1, argv);
  fflush(stdout);
  dup2(out, 1);
  dup2(err, 2);
  close(out);
  close(err);
  close(sink);
  for (int i = 0; i < argc; i++) free(argv[i + 1]);
  return code;
}

static void the_verb_writes_files(void **state)
{
  (void)state;
  char file[64], angles[64];
  snprintf(file, sizeof file, "/tmp/viscera_test_%ld.vtu", (long)getpid());
  snprintf(angles, sizeof angles, "/tmp/viscera_test_%ld.vti", (long)getpid());
  const char *block[] = {"block", "--cells", "2,3,4", "--size=4,3,8", "--tets", "6", "-o", file};
  assert_int_equal(generate(8, block), 0);
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_vtk_read_mesh(file, 1, &mesh, NULL), VSC_OK);
  assert_int_equal(mesh->element_count, 144);
  assert_close(volume_of(mesh), 96, 1e-6, 0);
  assert_non_null(vsc_arrays_find(&mesh->node_data, "y1"));
  vsc_mesh_free(mesh);
  const char *lv[] = {"lv", "--layers=1", "--around", "8", "--along", "4", "-o", file};
  assert_int_equal(generate(8, lv), 0);
  assert_int_equal(vsc_vtk_read_mesh(file, 1, &mesh, NULL), VSC_OK);
  assert_int_equal(mesh->element_count, 5 * (4 + 32));
  vsc_mesh_free(mesh);
  vsc_image *image = NULL;
  const char *map[] = {"map", "--spacing", "5", "-o", angles};
  assert_int_equal(generate(5, map), 0);
  assert_int_equal(vsc_vtk_read_image(angles, 1, &image, NULL), VSC_OK);
  assert_close(image->spacing[1], 5, 0, 0);
  vsc_image_free(image);
  unlink(file);
  unlink(angles);
  const char *help[] = {"--help"}, *none[] = {"-o"}, *cube[] = {"cube"},
             *odd[] = {"lv", "--layers=3x"};
  const char *two[] = {"lv", "map"}, *folder[] = {"lv", "-o", "/nowhere/lv.vtu"};
  assert_int_equal(generate(1, help), 0);
  assert_int_equal(generate(1, none), 2);
  assert_int_equal(generate(0, none), 2);
  assert_int_equal(generate(1, cube), 2);
  assert_int_equal(generate(2, odd), 2);
  assert_int_equal(generate(2, two), 2);
  assert_int_not_equal(generate(3, folder), 0);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(ventricle_is_human_sized_and_sound),
      cmocka_unit_test(ventricle_converges),
      cmocka_unit_test(depth_and_volume),
      cmocka_unit_test(map_holds_the_helix),
      cmocka_unit_test(block_fills_its_box),
      cmocka_unit_test(seeds_make_different_blocks),
      cmocka_unit_test(bad_shapes_are_refused),
      cmocka_unit_test(little_memory_is_reported),
      cmocka_unit_test(the_verb_writes_files),
  };
  return cmocka_run_group_tests_name("tools/shapes", tests, NULL, NULL);
}
