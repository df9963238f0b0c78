// SPDX-License-Identifier: GPL-3.0-or-later
// Vessels in elements that do not resolve them: fractions and directions.
#include "base/mem.h"
#include "base/vec3.h"
#include <unistd.h>

#include "fibers/vessels.h"
#include "io/vtk.h"
#include "io/vtk_polydata.h"
#include "kinds_body.h"
#include "tools/shapes_liver.h"

// A tube along `axis` (unit) through `middle`: its wall as triangles, or its centre line.
static vsc_polydata *tube(const double middle[3], const double axis[3], double radius, double length,
                          bool line)
{
  enum { ROUND = 48 };
  double u[3] = {axis[1], axis[2], axis[0]}, w[3];
  const double along = vsc_dot(u, axis);
  for (int i = 0; i < 3; i++) u[i] -= along * axis[i];
  vsc_normalize(u);
  vsc_cross(axis, u, w);
  vsc_polydata *p = line ? vsc_polydata_create(2, 0, 1)
                         : vsc_polydata_create(2 * ROUND + 2, 4 * ROUND, 0);
  for (int end = 0; end < 2; end++) {
    double centre[3];
    for (int i = 0; i < 3; i++) centre[i] = middle[i] + (end - 0.5) * length * axis[i];
    memcpy(p->points + 3 * (line ? end : 2 * ROUND + end), centre, sizeof centre);
    for (int k = 0; k < ROUND && !line; k++)
      for (int i = 0; i < 3; i++)
        p->points[3 * (end * ROUND + k) + i] = centre[i] + radius * (cos(2 * M_PI * k / ROUND) * u[i] +
                                                                     sin(2 * M_PI * k / ROUND) * w[i]);
  }
  if (line) {
    p->segments[1] = 1;
    return p;
  }
  for (uint32_t k = 0; k < ROUND; k++) {
    const uint32_t next = (k + 1) % ROUND;
    const uint32_t around[4][3] = {{k, next, ROUND + k}, {next, ROUND + next, ROUND + k},
                                   {2 * ROUND, next, k}, {2 * ROUND + 1, ROUND + k, ROUND + next}};
    memcpy(p->triangles + 12 * k, around, sizeof around);
  }
  return p;
}

// A straight vessel through a block, as surface and as line: the volume found comes to the vessel's own
// (pi r^2 l; of the surface's 48-gon 0.3 % less), the direction is the axis, on meshes of any kind.
static void a_straight_vessel(void **state)
{
  (void)state;
  uint64_t seed = 6;
  for (int kind = 0; kind < 2; kind++)
    for (int line = 0; line < 2; line++) {
      vsc_mesh *mesh = mesh_of(kind ? ALL_KINDS : ALL_TETS, 8, 4);
      double R[9], *fraction = numbers(mesh->element_count);
      double *direction = numbers(3 * mesh->element_count), volume = 0;
      const double middle[3] = {4.1, 3.9, 4.05}, radius = 0.9, length = 5;
      vsc_vessel_def def = {.radius = line ? radius : 0};
      vsc_vessel_report report;
      vsc_error error;
      random_rotation(&seed, R);
      vsc_polydata *p = tube(middle, R, radius, length, line);
      if (vsc_vessel_sample(mesh, p, &def, fraction, direction, &report, &error) != VSC_OK)
        fail_msg("%s", error.text);
      size_t full = 0, directed = 0;
      for (size_t e = 0; e < mesh->element_count; e++) {
        assert_true(fraction[e] >= 0 && fraction[e] <= 1);
        full += fraction[e] > 0.99;
        volume += fraction[e] * vsc_mesh_element_volume(mesh, e);
        const double *d = direction + 3 * e;
        if (fraction[e] < 0.2 || vsc_norm(d) == 0) continue;
        // away from the ends, whose caps lie across
        double centre[3], way[3];
        vsc_mesh_element_centre(mesh, e, centre);
        vsc_subtract(centre, middle, way);
        if (fabs(vsc_dot(way, R)) >= 1) continue;
        directed++;
        assert_true(fabs(vsc_dot(d, R)) > 0.97);
      }
      assert_true(full > 3);
      assert_true(directed > 10);
      assert_close(volume, M_PI * radius * radius * length, 0.03, 0);
      assert_close(report.own_volume, M_PI * radius * radius * length, 0.004, 0);
      assert_close(report.volume, volume, 1e-12, 0);
      vsc_polydata_free(p);
      vsc_free(fraction);
      vsc_free(direction);
      vsc_mesh_free(mesh);
    }
}

// Of a line that turns at a right angle, ends are cut flat and the joint is a ball: two cylinders, less a quarter of what
// crossing ones share, 16 r^3/3, and a quarter of the ball, 5 % of the whole.
static void a_bent_vessel(void **state)
{
  (void)state;
  enum { JOINT = 1, ENDS = 3 };
  vsc_mesh *mesh = mesh_of(ALL_TETS, 8, 4);
  double *fraction = numbers(mesh->element_count), *direction = numbers(3 * mesh->element_count);
  const double radius = 0.9, length = 3;
  const double points[ENDS][3] = {{2.6 + length, 2.7, 4.05}, {2.6, 2.7, 4.05}, {2.6, 2.7 + length, 4.05}};
  const uint32_t segments[2][2] = {{0, JOINT}, {JOINT, 2}};
  const vsc_vessel_def def = {.radius = radius};
  vsc_vessel_report report;
  vsc_error error;
  vsc_polydata *p = vsc_polydata_create(ENDS, 0, 2);
  memcpy(p->points, points, sizeof points);
  memcpy(p->segments, segments, sizeof segments);
  if (vsc_vessel_sample(mesh, p, &def, fraction, direction, &report, &error) != VSC_OK) fail_msg("%s", error.text);
  const double r3 = radius * radius * radius;
  assert_close(report.volume, 2 * M_PI * radius * radius * length - 4 * r3 / 3 + M_PI * r3 / 3, 0.015, 0);
  vsc_polydata_free(p);
  vsc_free(fraction);
  vsc_free(direction);
  vsc_mesh_free(mesh);
}

// What one vessel has taken another does not get, and elements take the direction of the larger part.
static void vessels_share_elements(void **state)
{
  (void)state;
  vsc_mesh *mesh = random_block(6, 8);
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_vessel_def defs[2] = {{.name = "a", .radius = 1, .threshold = 0.05},
                            {.name = "b", .radius = 1.4, .threshold = 0.05}};
  vsc_vessel_report reports[2];
  vsc_error error;
  char files[2][32];
  // a runs along x, b crosses it along y
  for (int v = 0; v < 2; v++) {
    vsc_polydata *p = tube((double[]){3, 3, 3}, (double[]){v == 0, v == 1, 0}, 1, 8, true);
    strcpy(files[v], "/tmp/vessel-XXXXXX.vtp");
    const int handle = mkstemps(files[v], 4);
    assert_true(handle >= 0);
    close(handle);
    if (vsc_vtk_write_polydata(files[v], p, &error) != VSC_OK) fail_msg("%s", error.text);
    snprintf(defs[v].file, sizeof defs[v].file, "%s", files[v]);
    defs[v].unit = 1;
    vsc_polydata_free(p);
  }
  if (vsc_vessels_make(mesh, defs, 2, axes, reports, &error) != VSC_OK) fail_msg("%s", error.text);
  for (int v = 0; v < 2; v++) unlink(files[v]);
  const double *a = vsc_arrays_find(&mesh->element_data, "a_fraction")->values;
  const double *b = vsc_arrays_find(&mesh->element_data, "b_fraction")->values;
  size_t directed[2] = {0};
  double volume[2] = {0};
  for (size_t e = 0; e < mesh->element_count; e++) {
    assert_true(a[e] >= 0 && b[e] >= 0 && a[e] + b[e] <= 1 + 1e-12);
    volume[0] += a[e] * vsc_mesh_element_volume(mesh, e);
    volume[1] += b[e] * vsc_mesh_element_volume(mesh, e);
    assert_int_equal(axes->known[e], fmax(a[e], b[e]) >= 0.05);
    if (!axes->known[e]) continue;
    const int owner = b[e] > a[e];
    directed[owner]++;
    // away from the other the direction is the vessel's own
    if (fmin(a[e], b[e]) == 0) assert_true(fabs(axes->frames[9 * e + owner]) > 0.99);
  }
  for (int v = 0; v < 2; v++) {
    assert_true(directed[v] > 50);
    assert_int_equal(reports[v].directed, directed[v]);
    assert_close(reports[v].volume, volume[v], 1e-12, 0);
  }
  // 6 mm of the 8 lie in the block; where both are, a's radius counts: 16 r^3/3 of crossing tubes at
  // least
  assert_close(reports[0].volume, M_PI * 6, 0.03, 0);
  assert_true(reports[1].shared > 16 / 3. && reports[1].shared < 2 * 1.4 * M_PI);
  assert_close(reports[1].volume + reports[1].shared, M_PI * 1.4 * 1.4 * 6, 0.03, 0);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

// The shipped liver: right-handed, sound, of human size, and its vessels lie within it but for their
// trunks' ends.
static void the_liver_and_its_vessels(void **state)
{
  (void)state;
  vsc_mesh *mesh;
  vsc_error error;
  double volume = 0;
  if (vsc_liver_mesh(10, &mesh, &error) != VSC_OK || vsc_mesh_clean(mesh, "liver", &error) != VSC_OK)
    fail_msg("%s", error.text);
  assert_int_equal(mesh->report.turned_elements, 0);
  for (size_t e = 0; e < mesh->element_count; e++) volume += vsc_mesh_element_volume(mesh, e);
  assert_true(volume > 1.4e6 && volume < 1.8e6);
  for (int tree = 0; tree < 2; tree++) {
    vsc_polydata *p;
    vsc_vessel_report report;
    const vsc_vessel_def def = {.radius_array = "radius", .unit = 1};
    double *fraction = numbers(mesh->element_count), *direction = numbers(3 * mesh->element_count);
    if (vsc_liver_vessels((vsc_liver_tree)tree, &p, &error) != VSC_OK ||
        vsc_vessel_sample(mesh, p, &def, fraction, direction, &report, &error) != VSC_OK)
      fail_msg("%s", error.text);
    assert_int_equal(p->segment_count, 31 * 4);
    // Murray: the cubes of the radii of all ends add up to the trunk's
    const double *radius = vsc_arrays_find(&p->point_data, "radius")->values;
    assert_close(16 * pow(radius[p->point_count - 1], 3), pow(radius[0], 3), 1e-12, 0);
    // forks overlap, so a little less than the segments' own sum
    print_message("tree %d: %.1f of %.1f ml\n", tree, 1e-3 * report.volume, 1e-3 * report.own_volume);
    assert_true(report.volume > 0.85 * report.own_volume);
    vsc_polydata_free(p);
    vsc_free(fraction);
    vsc_free(direction);
  }
  vsc_mesh_free(mesh);
}

// A patient's liver with its portal vein, where the files are: elements that the mesh labels as portal
// vein (region 3) hold far more of it than others.
static void a_patients_portal_vein(void **state)
{
  (void)state;
  static const char folder[] = VSC_SOURCE_DIR "/../shared/data/";
  char name[256];
  vsc_mesh *mesh;
  vsc_error error;
  snprintf(name, sizeof name, "%sliver_human.vtu", folder);
  if (access(name, R_OK) != 0) {
    print_message("skipped: %s is not there\n", name);
    skip();
  }
  if (vsc_vtk_read_mesh(name, 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_vessel_def def = {.name = "portal", .unit = 1, .threshold = 0.05};
  vsc_vessel_report report;
  snprintf(def.file, sizeof def.file, "%sliver_human_portal_vein.vtk", folder);
  if (vsc_vessels_make(mesh, &def, 1, axes, &report, &error) != VSC_OK) fail_msg("%s", error.text);
  const double *fraction = vsc_arrays_find(&mesh->element_data, "portal_fraction")->values;
  const double *region = vsc_arrays_find(&mesh->element_data, "region")->values;
  double mean[2] = {0};
  size_t count[2] = {0};
  for (size_t e = 0; e < mesh->element_count; e++) {
    mean[region[e] == 3] += fraction[e];
    count[region[e] == 3]++;
  }
  print_message("portal vein: %.1f ml, %.1f of them in the mesh; mean fraction %.3f in its region, %.4f "
                "elsewhere\n",
                1e-3 * report.own_volume, 1e-3 * report.volume, mean[1] / (double)count[1],
                mean[0] / (double)count[0]);
  assert_true(mean[1] / (double)count[1] > 10 * mean[0] / (double)count[0]);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_straight_vessel),
      cmocka_unit_test(a_bent_vessel),
      cmocka_unit_test(vessels_share_elements),
      cmocka_unit_test(the_liver_and_its_vessels),
      cmocka_unit_test(a_patients_portal_vein),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
