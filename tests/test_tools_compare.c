// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera compare` between different meshes, of series of runs, of curves.
#include "box_mesh.h"
#include "hybrid_mesh.h"
#include "io/pvd.h"
#include "io/vtk.h"
#include "mesh/quadratic.h"
#include "program.h"
#include "tools/compare_signals.h"

enum { SIDE = 4 };  // mm, of the blocks

typedef double field(const double x[3], int component);

static double linear(const double x[3], int c)
{
  return 0.3 + (c + 1) * x[0] - 2 * x[1] + 0.5 * (c - 1) * x[2];
}

static double quadratic(const double x[3], int c)
{
  return 1 + x[0] * x[1] - (c + 1) * x[2] * x[2] + x[1] + 0.25 * x[0] * x[0];
}

// Writes a mesh with node array `displacement` (the field, plus `shift`), element arrays `region` (1
// where x < 2, else 2) and `fiber` (`sense` times the x axis), and frees it.
static void write_field(const char *file, vsc_mesh *mesh, field *of, double shift, double sense)
{
  double *u = NULL, *region = NULL, *fiber = NULL;
  if (!VSC_NEW(u, 3 * mesh->node_count) || !VSC_NEW(region, mesh->element_count) ||
      !VSC_NEW(fiber, 3 * mesh->element_count))
    fail_msg("no memory");
  for (size_t n = 0; n < mesh->node_count; n++)
    for (int c = 0; c < 3; c++) u[3 * n + (size_t)c] = of(mesh->nodes + 3 * n, c) + shift;
  for (size_t e = 0; e < mesh->element_count; e++) {
    double centre[3];
    vsc_mesh_element_centre(mesh, e, centre);
    region[e] = centre[0] < 2 ? 1 : 2;
    fiber[3 * e] = sense;
  }
  const vsc_vtk_array arrays[] = {{"displacement", 3, u, VSC_ON_NODES, false},
                                  {"region", 1, region, VSC_ON_ELEMENTS, true},
                                  {"fiber", 3, fiber, VSC_ON_ELEMENTS, false}};
  if (vsc_vtk_write_mesh(in_folder(file), mesh, 3, arrays, true, NULL) != VSC_OK)
    fail_msg("%s", file);
  vsc_free(u);
  vsc_free(region);
  vsc_free(fiber);
  vsc_mesh_free(mesh);
}

static vsc_mesh *tets(int n)
{
  return box_mesh((const int[3]){n, n, n}, (double)SIDE / n, NULL);
}

static vsc_mesh *quadratic_tets(int n)
{
  vsc_mesh *mesh = tets(n);
  if (vsc_mesh_raise(&mesh, "box", NULL) != VSC_OK) fail_msg("no quadratic mesh");
  return mesh;
}

// The numbers of an array's row: max abs, RMS, relative L2, RMS and relative L2 by volume.
static void norms_of(const char *array, double n[5])
{
  char name[64], where[16];
  for (const char *line = said; line != NULL && *line != '\0'; line = strchr(line, '\n')) {
    line += *line == '\n';
    if (sscanf(line, "%63s %15s %lf %lf %lf %lf %lf", name, where, n, n + 1, n + 2, n + 3, n + 4) ==
            7 &&
        strcmp(name, array) == 0)
      return;
  }
  fail_msg("no row of '%s' in '%s'", array, said);
}

// Linear fields go from tets to all kinds and back without loss; regions that meshes resolve and axes
// of either sense too.
static void linear_fields_are_interpolated_exactly(void **state)
{
  (void)state;
  double n[5];
  write_field("tets.vtu", tets(6), linear, 0, 1);
  write_field("kinds.vtu", hybrid_block(SIDE, 0, 5), linear, 0, -1);
  write_field("shifted.vtu", hybrid_block(SIDE, 0.15, 5), linear, 0.5, 1);
  must("$V compare -t 1e-13 tets.vtu kinds.vtu");
  assert_holds(said, "0 of 343 outside B");
  norms_of("fiber", n);
  assert_true(n[0] == 0);
  must("$V compare -t 1e-13 kinds.vtu tets.vtu");
  must("$V compare tets.vtu shifted.vtu");
  norms_of("displacement", n);
  assert_close(n[0], 0.5, 1e-5, 0);  // six digits are printed
  assert_close(n[1], 0.5, 1e-5, 0);
  assert_close(n[3], 0.5, 1e-5, 0);
  assert_int_equal(shell("$V compare -t 1e-3 tets.vtu shifted.vtu"), 1);
}

static void quadratic_fields_on_quadratic_tets(void **state)
{
  (void)state;
  double n[5];
  write_field("fine.vtu", tets(5), quadratic, 0, 1);
  write_field("second.vtu", quadratic_tets(2), quadratic, 0, 1);
  write_field("first.vtu", tets(2), quadratic, 0, 1);
  must("$V compare fine.vtu second.vtu");
  norms_of("displacement", n);
  assert_true(n[0] < 1e-12);
  must("$V compare fine.vtu first.vtu");
  norms_of("displacement", n);
  assert_true(n[0] > 0.1);  // linear ones miss up to h^2/8 times the second derivative
}

// Two tets, of volume 1/6 and 1/2, with a number each.
static void write_two(const char *file, const char *name, const double values[2])
{
  static const double x[15] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, -3};
  static const uint32_t corners[8] = {0, 1, 2, 3, 0, 2, 1, 4};
  vsc_mesh *mesh = NULL;
  if (vsc_mesh_from_arrays(5, x, 2, corners, &mesh, NULL) != VSC_OK) fail_msg("no mesh");
  const vsc_vtk_array array = {name, 1, values, VSC_ON_ELEMENTS, false};
  if (vsc_vtk_write_mesh(in_folder(file), mesh, 1, &array, true, NULL) != VSC_OK) fail_msg("not written");
  vsc_mesh_free(mesh);
}

// Angles of axes, of which 89.5 and -89 degrees are 1.5 apart, and -30 and 50 as far as they look.
static void angles_of_axes(void **state)
{
  (void)state;
  double n[5];
  write_two("turned_a.vtu", "helix_angle", (const double[]){89.5, -30});
  write_two("turned_b.vtu", "helix_angle", (const double[]){-89, -30});
  write_two("turned_c.vtu", "helix_angle", (const double[]){89.5, 50});
  must("$V compare turned_a.vtu turned_b.vtu");
  norms_of("helix_angle", n);
  assert_close(n[0], 1.5, 1e-5, 0);
  must("$V compare turned_a.vtu turned_c.vtu");
  norms_of("helix_angle", n);
  assert_close(n[0], 80, 1e-5, 0);
}

// Two tets of volume 1/6 and 1/2: a difference of 1 in the small one, of the value 1 in both.
static void norms_by_volume(void **state)
{
  (void)state;
  write_two("two_a.vtu", "c", (const double[]){2, 1});
  write_two("two_b.vtu", "c", (const double[]){1, 1});
  for (int way = 0; way < 2; way++) {
    double n[5];
    must(way == 0 ? "$V compare two_a.vtu two_b.vtu" : "$V compare --interpolate two_a.vtu two_b.vtu");
    norms_of("c", n);
    assert_close(n[1], sqrt(0.5), 1e-5, 0);
    assert_close(n[2], sqrt(0.5), 1e-5, 0);
    assert_close(n[3], 0.5, 1e-5, 0);
    assert_close(n[4], 0.5, 1e-5, 0);
  }
}

// A reaches 2 mm beyond B: at 4.8 the nearest place is within reach, at 6 it is not.
static void places_outside(void **state)
{
  (void)state;
  write_field("wide.vtu", box_mesh((const int[3]){5, 1, 1}, 1.2, NULL), linear, 0, 1);
  write_field("tets.vtu", tets(4), linear, 0, 1);
  must("$V compare --reach 1 wide.vtu tets.vtu");
  assert_holds(said, "4 of 24 outside B");
  assert_holds(said, "4 further than 1 mm left out");
  assert_holds(said, "by 2 mm, at (6, ");
  double n[5];
  norms_of("displacement", n);
  assert_close(n[0], 3 * 0.8, 1e-5, 0);  // the slope of the steepest component over 0.8 mm
  must("$V compare --reach 3 wide.vtu tets.vtu");
  assert_holds(said, "0 further than 3 mm");
}

// Reports success only for what was compared.
static void nothing_compared_is_no_success(void **state)
{
  (void)state;
  static const double one[216] = {1};
  write_field("tets.vtu", tets(4), linear, 0, 1);
  write_field("wide.vtu", box_mesh((const int[3]){5, 1, 1}, 1.2, NULL), linear, 0, 1);
  assert_int_equal(shell("$V compare -t 9 --reach 1 wide.vtu tets.vtu"), 1);
  assert_holds(said, "places of A were left out");
  must("$V compare -t 9 --reach 3 wide.vtu tets.vtu");
  vsc_mesh *mesh = tets(4);
  for (size_t n = 0; n < mesh->node_count; n++) mesh->nodes[3 * n] += 300;
  write_field("far.vtu", mesh, linear, 0, 1);
  assert_int_equal(shell("$V compare -t 9 --interpolate far.vtu tets.vtu"), 1);
  assert_holds(said, "no value was compared: A lies outside B");
  must("$V compare --interpolate far.vtu tets.vtu");
  for (int n = 2; n <= 4; n += 2) {
    mesh = tets(n);
    const vsc_vtk_array other = {"other", 1, one, VSC_ON_NODES, false};
    if (vsc_vtk_write_mesh(in_folder("other.vtu"), mesh, 1, &other, true, NULL) != VSC_OK) fail_msg("other.vtu");
    vsc_mesh_free(mesh);
    assert_int_equal(shell("$V compare -t 9 other.vtu tets.vtu"), 1);
    assert_holds(said, "no value was compared: no array is in both");
  }
}

// The same tets from the last to the first.
static vsc_mesh *backwards(vsc_mesh *mesh)
{
  vsc_mesh *turned = NULL;
  uint32_t *corners = NULL;
  const size_t count = mesh->element_count;
  if (!VSC_NEW(corners, 4 * count)) fail_msg("no memory");
  for (size_t e = 0; e < count; e++)
    memcpy(corners + 4 * e, mesh->corners + 4 * (count - 1 - e), 4 * sizeof *corners);
  if (vsc_mesh_from_arrays(mesh->node_count, mesh->nodes, count, corners, &turned, NULL) != VSC_OK)
    fail_msg("no mesh");
  vsc_free(corners);
  vsc_mesh_free(mesh);
  return turned;
}

static void elements_in_another_order(void **state)
{
  (void)state;
  write_field("there.vtu", tets(4), linear, 0, 1);
  write_field("back.vtu", backwards(tets(4)), linear, 0, 1);
  must("$V compare -t 0 there.vtu back.vtu");
  assert_holds(said, "(positions)");
  assert_holds(said, "in another order: A's take");
}

static void axes_have_no_sign(void **state)
{
  (void)state;
  write_field("plus.vtu", tets(3), linear, 0, 1);
  write_field("minus.vtu", tets(3), linear, 0, -1);
  must("$V compare -t 0 plus.vtu minus.vtu");
}

static void write_run(const char *folder, int n, double signal, double shift, field *of)
{
  char name[128], text[256];
  snprintf(text, sizeof text, "mkdir -p %s/frames", folder);
  must(text);
  snprintf(name, sizeof name, "%s/frames/f0.vtu", folder);
  write_field(name, tets(n), of, 0, 1);
  snprintf(name, sizeof name, "%s/frames/f1.vtu", folder);
  write_field(name, tets(n), of, shift, 1);
  vsc_pvd *series = NULL;
  snprintf(name, sizeof name, "%s/run.pvd", folder);
  if (vsc_pvd_open(in_folder(name), -1, &series, NULL) != VSC_OK ||
      vsc_pvd_add(series, 0, "frames/f0.vtu", NULL) != VSC_OK ||
      vsc_pvd_add(series, 0.5, "frames/f1.vtu", NULL) != VSC_OK)
    fail_msg("no series");
  vsc_pvd_free(series);
  snprintf(name, sizeof name, "%s/signals.csv", folder);
  snprintf(text, sizeof text, "time [s],step [ms],cavity_lv [ml]\n0,1,9\n0.5,%g,%.12g\n", 1.0 / n,
           signal);
  save_text(name, text);
}

// Folders; each frame by itself, and all.
static void series_on_different_meshes(void **state)
{
  (void)state;
  double n[5];
  write_run("first", 2, 1, 0, linear);
  write_run("second", 3, 1, 0.25, linear);
  must("$V compare --frames first second");
  assert_holds(said, "frame at 0 s");
  assert_holds(said, "frame at 0.5 s");
  assert_holds(said, "frames at equal times: 2");
  const char *last = strstr(said, "frame at 0.5 s");
  memmove(said, last, strlen(last) + 1);
  norms_of("displacement", n);
  assert_close(n[3], 0.25, 1e-5, 0);
  last = strstr(said, "frames at equal times");
  memmove(said, last, strlen(last) + 1);
  norms_of("displacement", n);  // over both frames
  assert_close(n[3], 0.25 / sqrt(2), 1e-5, 0);
}

// The name is no pattern: out1 is another folder.
static void folders_with_brackets(void **state)
{
  (void)state;
  double n[5];
  write_run("out[1]", 2, 1, 0, linear);
  write_run("out1", 2, 1, 0.5, linear);
  must("$V compare 'out[1]' out1");
  norms_of("displacement", n);
  assert_close(n[0], 0.5, 1e-5, 0);
  must("$V measure 'out[1]' >first.txt && $V measure out1 >second.txt && ! cmp -s first.txt second.txt");
  assert_int_equal(shell("mkdir 'out*' && $V measure 'out*'"), 2);
  assert_holds(complained, "there is no series");
}

// Signals and fields with an error of C h^2, where h is 2, 1 and 1/2 mm over the root of six tets.
static void orders_of_runs(void **state)
{
  (void)state;
  static const double h[3] = {2, 1, 0.5};
  for (int k = 0; k < 3; k++) {
    char name[8];
    snprintf(name, sizeof name, "r%d", k);
    write_run(name, 2 << k, 100 + 3 * h[k] * h[k], 0.01 * h[k] * h[k], linear);
  }
  must("$V compare --order r0 r1 r2");
  assert_holds(said, "(volume/elements)^(1/3), mm");
  assert_holds(said, "cavity_lv");
  assert_holds(said, "order 2, extrapolated 100, run 3 uncertain by 0.938");  // 1.25 x 0.75, rounded
  // against the finest: (4 - 1/4)/(1 - 1/4) = 5 = 2^2.32
  assert_holds(said, " 2.32\n");
  must("$V compare --order --signal cavity_lv --exact 100 r0 r1 r2");
  assert_holds(said, "errors: 12 3 0.75; slope 2\n");
  must("$V compare --order --sizes 9,3,1 --signal step r0 r1 r2");
  assert_null(strstr(said, "cavity_lv"));
  assert_holds(said, "as given");
  // steps 1/2, 1/4, 1/8 for sizes 9, 3, 1: order log_3 2
  assert_holds(said, "order 0.6309");
}

static void orders_that_are_none(void **state)
{
  (void)state;
  write_run("s0", 2, 1, 0, linear);
  write_run("s1", 3, 2, 0, linear);
  write_run("s2", 4, 1.5, 0, linear);
  must("$V compare --order s0 s1 s2");
  assert_holds(said, "not monotone");
  static const char *const bad[][2] = {
      {"s2 s1 s0", "from coarse to fine"},     {"s0 s1", "give 3 to"},
      {"--sizes 2,1 s0 s1 s2", "--sizes"},     {"--sizes 2,1,x s0 s1 s2", "as many sizes"},
      {"--signal none s0 s1 s2", "'none'"},    {"s0 s1 nowhere", "nowhere"},
      {"--exact 1 s0 s1 s2", "the one --signal"}, {"--exact x s0 s1 s2", "a number"},
      {"--sizes 1,1,1 s0 s1 s2", "not below"}};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char command[128];
    snprintf(command, sizeof command, "$V compare --order %s", bad[b][0]);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b][1]);
  }
  // on one mesh the steps are the sizes
  for (int k = 0; k < 3; k++) {
    char name[8], text[128];
    snprintf(name, sizeof name, "t%d", k);
    write_run(name, 2, 0, 0, linear);
    snprintf(name, sizeof name, "t%d", k);
    snprintf(text, sizeof text, "time [s],step [ms],point_p_ux [mm]\n0.5,%g,%.12g\n", 4.0 / (1 << k),
             7 - 1.0 / (1 << k));
    char file[32];
    snprintf(file, sizeof file, "%s/signals.csv", name);
    save_text(file, text);
  }
  must("$V compare --order t0 t1 t2");
  assert_holds(said, "time steps, ms");
  assert_holds(said, "order 1, extrapolated 7,");
}

// a = 2 t at rows 0, 1, 2 s against b = 0, 1, 2, 9 at 0, 0.5, 1.5, 3 s: a - b = 0, 0, 1; the integrals
// are 1/2 and 1/4 + 5/2.
static void curves_by_hand(void **state)
{
  (void)state;
  save_text("run.csv", "time [s],a [mm],other [mm]\n0,0,1\n1,2,1\n2,4,1\n");
  save_text("ref.csv", "time_s,b,low,high,floor\n0,0,-1,2,0.5\n0.5,1,-1,2,1\n1.5,2,-1,2,1\n3,9,0,10,0\n");
  vsc_signals *run = NULL, *reference = NULL;
  vsc_curve_pair pair;
  vsc_curve_distance d;
  assert_int_equal(vsc_signals_read(in_folder("run.csv"), &run, NULL), VSC_OK);
  assert_int_equal(vsc_signals_read(in_folder("ref.csv"), &reference, NULL), VSC_OK);
  assert_int_equal(vsc_curve_pair_read("a=b,low,high", &pair, NULL), VSC_OK);
  assert_int_equal(vsc_curve_compare(run, reference, &pair, &d, NULL), VSC_OK);
  assert_close(vsc_curve_relative(&d), sqrt(0.5 / 2.75), 1e-14, 0);
  assert_close(d.largest, 1, 1e-14, 0);
  assert_close(d.when, 1.5, 0, 0);
  assert_int_equal(d.points, 3);
  assert_int_equal(d.missing, 1);
  assert_int_equal(d.banded, 3);
  assert_int_equal(d.within, 2);
  // below the band, on its edge, above it
  assert_int_equal(vsc_curve_pair_read("a=b,floor,high", &pair, NULL), VSC_OK);
  assert_int_equal(vsc_curve_compare(run, reference, &pair, &d, NULL), VSC_OK);
  assert_int_equal(d.within, 1);
  vsc_signals_free(run);
  vsc_signals_free(reference);
  must("$V compare --signals --column a=b,low,high --column other=b run.csv ref.csv");
  assert_holds(said, "0.426401");  // sqrt(0.5/2.75)
  assert_holds(said, "66.7 %");
  assert_holds(said, "together");
  assert_holds(said, "does not reach: 1\n");
  // judged are all times of the reference
  assert_int_equal(shell("$V compare --signals --column a=b -t 0.9 run.csv ref.csv"), 1);
  assert_int_equal(shell("$V compare --signals --column a=b,low,high --within 0.66 run.csv ref.csv"), 1);
  save_text("ref.csv", "time_s,b,low,high\n0,0,-1,2\n0.5,1,-1,2\n1.5,2,-1,2\n");
  must("$V compare --signals --column a=b,low,high -t 0.9 --within 0.66 run.csv ref.csv");
  assert_int_equal(shell("$V compare --signals --column a=b -t 0.4 run.csv ref.csv"), 1);
  assert_int_equal(shell("$V compare --signals --column a=b,low,high --within 0.7 run.csv ref.csv"), 1);
}

// Why a series is not read.
static void series_that_cannot_be_read(void **state)
{
  (void)state;
  assert_int_equal(shell("$V compare none.pvd none.pvd"), 2);
  assert_holds(complained, "none.pvd: cannot be read: No such file or directory");
  // a loop of links is there, but leads nowhere
  assert_int_equal(shell("ln -s loop.pvd loop.pvd && $V compare loop.pvd loop.pvd"), 2);
  assert_holds(complained, "loop.pvd: cannot be read: Too many levels of symbolic links");
}

// A table's last line counts without its end; what a run may still write does not.
static void last_lines_without_their_end(void **state)
{
  (void)state;
  vsc_signals *table = NULL;
  save_text("open.csv", "time,b\n0,1\n1,2\n2,3.5");
  assert_int_equal(vsc_signals_read(in_folder("open.csv"), &table, NULL), VSC_OK);
  assert_int_equal(table->rows, 3);
  assert_close(table->values[5], 3.5, 0, 0);
  vsc_signals_free(table);
  save_text("open.csv", "time,b\n0,1\n1,2\n2");
  vsc_error error;
  assert_int_equal(vsc_signals_read(in_folder("open.csv"), &table, &error), VSC_INPUT);
  assert_holds(error.text, "open.csv:4");
  save_text("signals.csv", "time,b\n0,1\n1,2\n2,3");
  assert_int_equal(vsc_signals_read(in_folder("signals.csv"), &table, NULL), VSC_OK);
  assert_int_equal(table->rows, 2);
  vsc_signals_free(table);
}

static void curves_refused(void **state)
{
  (void)state;
  save_text("run.csv", "time [s],a [mm]\n0,0\n1,2\n");
  save_text("ref.csv", "time_s,b,low\n5,0,1\n6,1,1\n");
  static const char *const bad[][2] = {{"--column a=b run.csv ref.csv", "0 of the reference's 2 times"},
                                       {"--column a=c run.csv ref.csv", "no column 'c'"},
                                       {"--column x=b run.csv ref.csv", "no column 'x'"},
                                       {"--column a=b,low run.csv ref.csv", "expected COLUMN"},
                                       {"--column a run.csv ref.csv", "expected COLUMN"},
                                       {"run.csv ref.csv", "--column"},
                                       {"--column a=b run.csv none.csv", "none.csv"}};
  for (size_t b = 0; b < sizeof bad / sizeof bad[0]; b++) {
    char command[128];
    snprintf(command, sizeof command, "$V compare --signals %s", bad[b][0]);
    assert_int_equal(shell(command), 2);
    assert_int_equal(line_count(complained), 1);
    assert_holds(complained, bad[b][1]);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(linear_fields_are_interpolated_exactly),
      cmocka_unit_test(quadratic_fields_on_quadratic_tets),
      cmocka_unit_test(norms_by_volume),
      cmocka_unit_test(angles_of_axes),
      cmocka_unit_test(places_outside),
      cmocka_unit_test(nothing_compared_is_no_success),
      cmocka_unit_test(elements_in_another_order),
      cmocka_unit_test(axes_have_no_sign),
      cmocka_unit_test(folders_with_brackets),
      cmocka_unit_test(series_on_different_meshes),
      cmocka_unit_test(orders_of_runs),
      cmocka_unit_test(orders_that_are_none),
      cmocka_unit_test(curves_by_hand),
      cmocka_unit_test(series_that_cannot_be_read),
      cmocka_unit_test(last_lines_without_their_end),
      cmocka_unit_test(curves_refused),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
