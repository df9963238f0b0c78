// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera plot` over the results of a simulation that never was.
#include "close.h"
#include "hybrid_mesh.h"

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "io/pvd.h"
#include "io/vtk.h"
#include "write_tets.h"
#include "mesh/mesh.h"
#include "tools/plot/raster.h"
#include "tools/plot/signals.h"
#include "tools/plot/view.h"

enum { ROUND = 32, DOWN = 12, THICK = 3, FRAMES = 5 };

static char folder[] = "/tmp/viscera-plot-XXXXXX";

static const char *in_folder(const char *name)
{
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static int run(const char *format, const char *argument)
{
  char arguments[512], command[1024];
  snprintf(arguments, sizeof arguments, format, argument);
  snprintf(command, sizeof command, "%s %s 2>%s/messages", VSC_PROGRAM, arguments, folder);
  const int status = system(command);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

// Whether the messages of the last run hold a text.
static int said(const char *text)
{
  char messages[4096] = "";
  FILE *stream = fopen(in_folder("messages"), "r");
  assert_non_null(stream);
  const size_t length = fread(messages, 1, sizeof messages - 1, stream);
  messages[length] = '\0';
  fclose(stream);
  return strstr(messages, text) != NULL;
}

// ---- the results

static uint32_t node_at(int i, int j, int k)
{
  return (uint32_t)((i % ROUND * (DOWN + 1) + j) * (THICK + 1) + k);
}

// A cup: half an ellipsoid's wall with a small hole at its apex, the axis along z.
static vsc_mesh *make_cup(void)
{
  static const int split[6][4] = {{0, 1, 3, 7}, {0, 1, 7, 5}, {0, 5, 7, 4},
                                  {0, 3, 2, 7}, {0, 6, 7, 2}, {0, 4, 7, 6}};
  double *nodes;
  uint32_t *tets;
  vsc_mesh *mesh = NULL;
  const size_t node_count = ROUND * (DOWN + 1) * (THICK + 1), element_count = 6 * ROUND * DOWN * THICK;
  assert_true(VSC_NEW(nodes, 3 * node_count) && VSC_NEW(tets, 4 * element_count));
  for (int i = 0; i < ROUND; i++)
    for (int j = 0; j <= DOWN; j++)
      for (int k = 0; k <= THICK; k++) {
        const double azimuth = 2 * M_PI * i / ROUND, polar = 0.05 + 1.75 * j / DOWN;
        const double depth = (double)k / THICK, radius = 17 + 9 * depth, height = 50 + 7 * depth;
        double *x = nodes + 3 * node_at(i, j, k);
        x[0] = radius * sin(polar) * cos(azimuth);
        x[1] = radius * sin(polar) * sin(azimuth);
        x[2] = -height * cos(polar);
      }
  size_t t = 0;
  for (int i = 0; i < ROUND; i++)
    for (int j = 0; j < DOWN; j++)
      for (int k = 0; k < THICK; k++)
        for (int s = 0; s < 6; s++, t++)
          for (int c = 0; c < 4; c++) {
            const int corner = split[s][c];
            tets[4 * t + (size_t)c] =
                node_at(i + (corner & 1), j + (corner >> 1 & 1), k + (corner >> 2));
          }
  assert_int_equal(vsc_mesh_from_arrays(node_count, nodes, element_count, tets, &mesh, NULL), VSC_OK);
  vsc_free(nodes);
  vsc_free(tets);
  return mesh;
}

// The cup contracted by `share`: thicker, shorter, twisted.
static void write_frame(const vsc_mesh *mesh, const char *file, double share)
{
  double *displacement, *tension;
  assert_true(VSC_NEW(displacement, 3 * mesh->node_count) && VSC_NEW(tension, mesh->element_count));
  for (size_t i = 0; i < mesh->node_count; i++) {
    const double *x = mesh->nodes + 3 * i;
    const double height = 9 - x[2], turn = -share * 0.005 * height;
    const double radius = hypot(x[0], x[1]), angle = atan2(x[1], x[0]) + turn;
    const double smaller = radius * (1 - share * 6 / (4 + radius));
    displacement[3 * i] = smaller * cos(angle) - x[0];
    displacement[3 * i + 1] = smaller * sin(angle) - x[1];
    displacement[3 * i + 2] = share * 0.14 * height;
  }
  for (size_t t = 0; t < mesh->element_count; t++) {
    double centre[3];
    vsc_mesh_element_centre(mesh, t, centre);
    tension[t] = share * (60 + 0.4 * centre[2]);
  }
  const vsc_vtk_array arrays[] = {{"displacement", 3, displacement, VSC_ON_NODES, false},
                                  {"active_tension", 1, tension, VSC_ON_ELEMENTS, false}};
  assert_int_equal(write_tets(in_folder(file), mesh->node_count, mesh->nodes,
                                      mesh->element_count, mesh->corners, 0, NULL, 2, arrays, false, NULL),
                   VSC_OK);
  vsc_free(displacement);
  vsc_free(tension);
}

static void write_signals(const char *header, int columns)
{
  FILE *stream = fopen(in_folder("signals.csv"), "w");
  assert_non_null(stream);
  fprintf(stream, "%s\n", header);
  for (int r = 0; r <= 160; r++) {
    const double t = 0.01 * r, phase = fmod(t, 0.8),
                 a = phase < 0.4 ? pow(sin(M_PI * phase / 0.4), 2) : 0;
    const double values[] = {t, 0.05, 95 - 52 * a, 110 * (1 + 0.0021 * a), 41 * a, 63 * a};
    for (int c = 0; c < columns; c++) fprintf(stream, "%s%.9g", c > 0 ? "," : "", values[c]);
    fputc('\n', stream);
  }
  fputs("1.61,0.0", stream);  // a simulation that still writes
  fclose(stream);
}

static const char *const header =
    "time [s],step [ms],cavity_lv [ml],wall_volume [ml],active_tension_mean "
    "[kPa],active_tension_max [kPa]";

static int make_results(void **state)
{
  (void)state;
  if (mkdtemp(folder) == NULL) return -1;
  vsc_mesh *mesh = make_cup();
  vsc_pvd *series = NULL;
  assert_int_equal(vsc_pvd_open(in_folder("beat.pvd"), -1, &series, NULL), VSC_OK);
  for (int f = 0; f < FRAMES; f++) {
    char name[32];
    snprintf(name, sizeof name, "beat_%04d.vtu", f);
    write_frame(mesh, name, pow(sin(M_PI * f / (FRAMES - 1)), 2));
    assert_int_equal(vsc_pvd_add(series, 0.1 * f, name, NULL), VSC_OK);
  }
  vsc_pvd_free(series);
  vsc_mesh_free(mesh);
  write_signals(header, 6);
  return 0;
}

static int remove_results(void **state)
{
  (void)state;
  char command[256];
  if (getenv("VSC_KEEP") != NULL) return 0;
  snprintf(command, sizeof command, "rm -rf %s", folder);
  return system(command);
}

// Width and height of a PNG from its first chunk; the size of the file.
static long read_png(const char *file, unsigned size[2])
{
  unsigned char head[24] = {0};
  FILE *stream = fopen(file, "rb");
  assert_non_null(stream);
  assert_int_equal(fread(head, 1, sizeof head, stream), sizeof head);
  assert_memory_equal(head, "\x89PNG\r\n\x1a\n", 8);
  for (int k = 0; k < 2; k++) size[k] = (unsigned)head[18 + 4 * k] << 8 | head[19 + 4 * k];
  assert_int_equal(fseek(stream, 0, SEEK_END), 0);
  const long bytes = ftell(stream);
  fclose(stream);
  return bytes;
}

// ---- tests

static void test_draws_one_picture(void **state)
{
  (void)state;
  unsigned size[2];
  write_signals(header, 6);
  assert_int_equal(run("plot %s", folder), 0);
  assert_false(said("viscera"));
  const long bytes = read_png(in_folder("beat.png"), size);
  assert_int_equal(size[0], 1760);
  assert_int_equal(size[1], 1040);
  assert_true(bytes > 100000);  // more than white paper
}

static void test_leaves_out_what_is_missing(void **state)
{
  (void)state;
  write_signals("time [s],step [ms],cavity_lv [ml]", 3);
  assert_int_equal(run("plot %s", folder), 0);
  assert_true(said("wall_volume"));
  assert_true(said("active_tension_mean"));
}

static void test_says_what_is_wrong(void **state)
{
  (void)state;
  assert_int_equal(run("plot %s", "/nonexistent"), 2);
  assert_true(said("/nonexistent"));
  assert_int_equal(run("plot%s", ""), 2);
  assert_int_equal(run("plot --axis 0,0,0 %s", folder), 2);
  assert_true(said("--axis"));
  assert_int_equal(run("plot --at soon %s", folder), 2);
  assert_int_equal(run("plot -o beat.jpg %s", folder), 2);
  assert_true(said("ends in .png"));
  assert_int_equal(run("plot --view -o view %s", folder), 2);
  assert_true(said("ends in .png"));
  write_signals("time [s],step [ms]", 3);
  assert_int_equal(run("plot %s", folder), 2);
  assert_true(said("signals.csv:2"));
  remove(in_folder("signals.csv"));
  assert_int_equal(run("plot %s", folder), 2);
  assert_true(said("signals.csv"));
  write_signals(header, 6);
}

static void test_signals_have_names_units_and_rows(void **state)
{
  (void)state;
  vsc_signals *signals = NULL;
  write_signals(header, 6);
  assert_int_equal(vsc_signals_read(in_folder("signals.csv"), &signals, NULL), VSC_OK);
  assert_int_equal(signals->columns, 6);
  assert_int_equal(signals->rows, 161);  // the unfinished one is left out
  assert_string_equal(signals->names[2], "cavity_lv");
  assert_string_equal(signals->units[2], "ml");
  const double *volume = vsc_signals_find(signals, "cavity_lv");
  assert_non_null(volume);
  assert_close(volume[0], 95, 1e-12, 0);
  assert_close(volume[20], 43, 1e-6, 0);
  assert_null(vsc_signals_find(signals, "cavity"));
  assert_int_equal(vsc_signals_next(signals, "active_", 0), 4);
  assert_int_equal(vsc_signals_next(signals, "active_", 5), 5);
  assert_int_equal(vsc_signals_next(signals, "energy_", 0), 6);
  vsc_signals_free(signals);
}

static void take_value(const vsc_vertex *vertex, int kind, const void *context, float colour[3])
{
  (void)kind;
  (void)context;
  colour[0] = (float)vertex->value;
}

static void test_near_triangles_hide_far_ones(void **state)
{
  (void)state;
  vsc_raster *raster = vsc_raster_create(40, 40);
  assert_non_null(raster);
  vsc_vertex corners[3] = {
      {.place = {-10, -10, 5}}, {.place = {90, -10, 5}}, {.place = {-10, 90, 5}}};
  for (int c = 0; c < 3; c++) corners[c].value = corners[c].place[0] / 100;
  vsc_raster_triangle(raster, corners, 1, take_value, NULL);
  // The value is interpolated over the triangle: at pixel x it is (x + 1/2) / 100.
  assert_close(raster->colour[3 * (20 * 40 + 30)], 0.305, 1e-5, 0);
  assert_close(raster->colour[3 * (35 * 40 + 2)], 0.025, 1e-5, 0);
  for (int c = 0; c < 3; c++) corners[c].place[2] = 9, corners[c].value = 1;
  vsc_raster_triangle(raster, corners, 2, take_value, NULL);
  assert_int_equal(raster->kind[20 * 40 + 30], 1);
  for (int c = 0; c < 3; c++) corners[c].place[2] = 1;
  vsc_raster_triangle(raster, corners, 2, take_value, NULL);
  assert_int_equal(raster->kind[20 * 40 + 30], 2);
  vsc_raster_free(raster);
}

// The cup cut open: tissue at the sides, its inner wall in the middle; uncut the outer wall.
static void test_the_cut_shows_the_cavity(void **state)
{
  (void)state;
  vsc_mesh *mesh = make_cup();
  for (int whole = 0; whole < 2; whole++) {
    const double up[3] = {0, 0, 1}, from[3] = {0, -1, 0};
    const vsc_camera camera = vsc_camera_make(mesh, up, from, whole);
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    vsc_camera_extend(&camera, mesh, NULL, low, high);
    assert_close(high[0] - low[0], 52, 0.02, 0);  // twice the outer radius
    assert_close(vsc_dot(camera.right, (double[]){1, 0, 0}), 1, 1e-12, 0);
    vsc_raster *raster = vsc_raster_create(104, 160);
    assert_non_null(raster);
    assert_int_equal(vsc_view_draw(&camera, mesh, NULL, NULL, 1, low, 2, raster, NULL), VSC_OK);
    const size_t middle = 90 * 104 + 52, wall = 75 * 104 + 6, corner = 159 * 104 + 2;
    assert_int_equal(raster->kind[middle], VSC_KIND_SURFACE);
    assert_int_equal(raster->kind[wall], whole ? VSC_KIND_SURFACE : VSC_KIND_CUT);
    assert_int_equal(raster->kind[corner], 0);
    // The inner wall lies behind the axis, the outer wall before it.
    assert_int_equal(raster->depth[middle] > 0, !whole);
    vsc_raster_free(raster);
  }
  vsc_mesh_free(mesh);
}

// How deep in the cup's wall a point lies: 0 on the inner ellipsoid, 1 on the outer one.
static double depth_in_wall(double radius, double z)
{
  double low = -1.8, high = 3;
  for (int k = 0; k < 50; k++) {
    const double d = (low + high) / 2;
    if (pow(radius / (17 + 9 * d), 2) + pow(z / (50 + 7 * d), 2) > 1)
      low = d;
    else
      high = d;
  }
  return low;
}

// Distance along `into` from a point in the cavity to the inner ellipsoid.
static double distance_to_wall(const double point[3], const double into[3])
{
  const double w[3] = {1.0 / 17, 1.0 / 17, 1.0 / 50};
  double a = 0, b = 0, c = -1;
  for (int k = 0; k < 3; k++) {
    a += pow(w[k] * into[k], 2);
    b += w[k] * w[k] * into[k] * point[k];
    c += pow(w[k] * point[k], 2);
  }
  return (-b + sqrt(b * b - a * c)) / a;
}

// Checks a pixel whose ray passes the cutting plane `x` to the right of the centre and `y` above
// it.
static int check_pixel(const vsc_camera *camera, double x, double y, int kind, double depth)
{
  double point[3], hit[3];
  const double height = y / vsc_dot(camera->up, camera->axis);
  for (int k = 0; k < 3; k++)
    point[k] = camera->centre[k] + x * camera->right[k] + height * camera->axis[k];
  const double at = height * vsc_dot(camera->into, camera->axis);
  const double wall = depth_in_wall(fabs(x), point[2]);
  if (point[2] > 10 || point[2] < -48.5) return 0;
  if (wall > 0.1 && wall < 0.9) {
    assert_int_equal(kind, VSC_KIND_CUT);
    assert_close(depth, at, 0, 1e-3);
    return 1;
  }
  if (wall > -0.03) return 0;
  const double distance = distance_to_wall(point, camera->into);
  for (int k = 0; k < 3; k++) hit[k] = point[k] + distance * camera->into[k];
  if (hit[2] > 9 || hit[2] < -49.5) return 0;
  assert_int_equal(kind, VSC_KIND_SURFACE);
  assert_close(depth, at + distance, 0, 1);
  return 1;
}

// A plane that passes between the nodes cuts triangles and tets in all ways: every pixel shows what
// the ellipsoids say, the face of the cut or the inner wall behind it.
static void test_the_cut_leaves_no_holes(void **state)
{
  (void)state;
  vsc_mesh *mesh = make_cup();
  for (int turn = 0; turn < 5; turn++) {
    const double up[3] = {0, 0, 1}, from[3] = {sin(0.07 * turn), -cos(0.07 * turn), 0};
    const vsc_camera camera = vsc_camera_make(mesh, up, from, false);
    const double low[2] = {-27, -40};
    vsc_raster *raster = vsc_raster_create(216, 240);
    int checked = 0;
    assert_non_null(raster);
    assert_int_equal(vsc_view_draw(&camera, mesh, NULL, NULL, 1, low, 4, raster, NULL), VSC_OK);
    for (int row = 0; row < 240; row++)
      for (int column = 0; column < 216; column++) {
        const int p = row * 216 + column;
        checked += check_pixel(&camera, low[0] + (column + 0.5) / 4, low[1] + (239.5 - row) / 4,
                               raster->kind[p], raster->depth[p]);
      }
    assert_true(checked > 15000);
    vsc_raster_free(raster);
  }
  vsc_mesh_free(mesh);
}

// Where the plane cuts a block of all kinds of elements, every pixel shows the cut.
static void test_all_kinds_are_cut_without_holes(void **state)
{
  (void)state;
  vsc_mesh *mesh = hybrid_block(3, 0.2, 11);
  double *values;
  assert_true(VSC_NEW(values, mesh->element_count));
  for (int turn = 0; turn < 5; turn++) {
    const double up[3] = {0, 0, 1}, from[3] = {sin(0.13 * turn), -cos(0.13 * turn), 0};
    const vsc_camera camera = vsc_camera_make(mesh, up, from, false);
    const double low[2] = {-2, -2};
    vsc_raster *raster = vsc_raster_create(100, 100);
    int checked = 0;
    assert_non_null(raster);
    assert_int_equal(vsc_view_draw(&camera, mesh, NULL, values, 1, low, 25, raster, NULL), VSC_OK);
    for (int p = 0; p < 100 * 100; p++) {
      const double x = low[0] + (p % 100 + 0.5) / 25, y = low[1] + (99.5 - p / 100) / 25;
      const double height = y / vsc_dot(camera.up, camera.axis);
      bool inside = true;
      for (int k = 0; k < 3; k++)
        inside &= fabs(x * camera.right[k] + height * camera.axis[k]) < 1.45;
      if (!inside) continue;
      assert_int_equal(raster->kind[p], VSC_KIND_CUT);
      assert_close(raster->depth[p], height * vsc_dot(camera.into, camera.axis), 0, 1e-6);
      checked++;
    }
    assert_true(checked > 4500);
    vsc_raster_free(raster);
  }
  vsc_free(values);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_draws_one_picture),
      cmocka_unit_test(test_leaves_out_what_is_missing),
      cmocka_unit_test(test_says_what_is_wrong),
      cmocka_unit_test(test_signals_have_names_units_and_rows),
      cmocka_unit_test(test_near_triangles_hide_far_ones),
      cmocka_unit_test(test_the_cut_shows_the_cavity),
      cmocka_unit_test(test_the_cut_leaves_no_holes),
      cmocka_unit_test(test_all_kinds_are_cut_without_holes),
  };
  return cmocka_run_group_tests(tests, make_results, remove_results);
}
