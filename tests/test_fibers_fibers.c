// SPDX-License-Identifier: GPL-3.0-or-later
// Every source of fibres through vsc_fibers_make.
#include "close.h"
#include "mesh/quadratic.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "base/vec3.h"
#include "fibers/fibers.h"
#include "fibers/synthetic.h"
#include "io/vtk.h"
#include "tools/shapes.h"
#include "trap.h"

static const double degree = M_PI / 180;

// A block in (0, 0, 0) to (8, 4, 6).
static vsc_mesh *block(void)
{
  vsc_mesh *mesh = NULL;
  const vsc_block_shape shape = {
      .cells = {8, 4, 6}, .size = {8, 4, 6}, .tets_per_cell = 5, .jitter = 0.1};
  assert_int_equal(vsc_block_mesh(&shape, &mesh, NULL), VSC_OK);
  return mesh;
}

static vsc_axes *make(const vsc_mesh *mesh, const vsc_fiber_def *definition,
                      vsc_fiber_report *report)
{
  vsc_axes *axes = NULL;
  vsc_error error = {.text = ""};
  const vsc_status status = vsc_fibers_make(mesh, definition, NULL, 0, &axes, report, &error);
  if (status != VSC_OK) print_error("%s\n", error.text);
  assert_int_equal(status, VSC_OK);
  assert_true(vsc_axes_valid(axes));
  assert_int_equal(report->elements, mesh->element_count);
  assert_int_equal(report->with_data + report->filled + report->passive, mesh->element_count);
  return axes;
}

static void refuse(const vsc_mesh *mesh, const vsc_fiber_def *definition, const char *word)
{
  vsc_axes *axes = NULL;
  vsc_fiber_report report;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_fibers_make(mesh, definition, NULL, 0, &axes, &report, &error), VSC_INPUT);
  assert_null(axes);
  if (strstr(error.text, word) == NULL) print_error("no '%s' in: %s\n", word, error.text);
  assert_non_null(strstr(error.text, word));
}

static vsc_fiber_def from(vsc_fiber_source source)
{
  vsc_fiber_def definition = vsc_default_fiber();
  definition.source = source;
  return definition;
}

static void none_is_passive(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  const vsc_fiber_def definition = from(VSC_FIBER_NONE);
  vsc_fiber_report report;
  vsc_axes *axes = make(mesh, &definition, &report);
  assert_int_equal(report.passive, mesh->element_count);
  assert_int_equal(axes->known[3], 0);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

static void a_source_must_be_one(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  const vsc_fiber_def none = from((vsc_fiber_source)99), map = from(VSC_FIBER_MAP);
  refuse(mesh, &none, "unknown is not a formula");
  vsc_axes *axes = vsc_axes_create(mesh->element_count);
  vsc_error error;
  assert_int_equal(vsc_fibers_synthetic(mesh, &map, axes, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "map is not a formula"));
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

static void one_direction(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = from(VSC_FIBER_CONSTANT);
  refuse(mesh, &definition, "(0, 0, 0)");
  definition.direction[0] = NAN;
  trap_off();
  refuse(mesh, &definition, "nan");
  trap_on();
  const double direction[3] = {0, 3, 4}, sheet[3] = {5, 1, 0};
  memcpy(definition.direction, direction, sizeof direction);
  memcpy(definition.sheet_direction, sheet, sizeof sheet);
  vsc_fiber_report report;
  vsc_axes *axes = make(mesh, &definition, &report);
  const double expected[3] = {0, 0.6, 0.8};
  double s[3] = {5, 1 - 0.36, -0.48};
  vsc_normalize(s);
  for (size_t e = 0; e < mesh->element_count; e++)
    for (int a = 0; a < 3; a++) {
      assert_close(axes->frames[9 * e + (size_t)a], expected[a], 0, 1e-12);
      assert_close(axes->frames[9 * e + 3 + (size_t)a], s[a], 0, 1e-12);
    }
  assert_int_equal(report.with_data, mesh->element_count);
  assert_close(report.azimuth[0], 90, 0, 1e-9);
  assert_close(report.elevation[2], asin(0.8) / degree, 0, 1e-9);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

// Horizontal, diagonal, half circles round (4, ., 0), helices round (4, 2, .).
static void figure_six(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_report report;
  for (int source = VSC_FIBER_HORIZONTAL; source <= VSC_FIBER_HELICOIDAL; source++) {
    vsc_fiber_def definition = from((vsc_fiber_source)source);
    definition.pitch = 35 * degree;
    vsc_axes *axes = make(mesh, &definition, &report);
    assert_int_equal(report.with_data, mesh->element_count);
    for (size_t e = 0; e < mesh->element_count; e++) {
      double at[3];
      const double *f = &axes->frames[9 * e];
      vsc_mesh_element_centre(mesh, e, at);
      const double x = at[0] - 4, y = at[1] - 2, z = at[2], r = hypot(x, y),
                   turn = cos(35 * degree);
      const double expected[4][3] = {{1, 0, 0},
                                     {sqrt(0.5), 0, sqrt(0.5)},
                                     {z / hypot(x, z), 0, -x / hypot(x, z)},
                                     {-turn * y / r, turn * x / r, sin(35 * degree)}};
      for (int a = 0; a < 3; a++)
        assert_close(f[a], expected[source - VSC_FIBER_HORIZONTAL][a], 0, 1e-12);
      if (source == VSC_FIBER_HELICOIDAL)
        assert_close(vsc_dot(f + 3, (double[3]){x, y, 0}), r, 1e-12, 0);
    }
    vsc_axes_free(axes);
  }
  vsc_mesh_free(mesh);
}

static void random_fibers_fill_the_sphere(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = from(VSC_FIBER_RANDOM);
  vsc_fiber_report report;
  vsc_axes *axes = make(mesh, &definition, &report), *again = make(mesh, &definition, &report);
  definition.seed = 2;
  vsc_axes *other = make(mesh, &definition, &report);
  const size_t bytes = 9 * mesh->element_count * sizeof(double);
  assert_memory_equal(axes->frames, again->frames, bytes);
  assert_memory_not_equal(axes->frames, other->frames, bytes);
  double mean[3] = {0}, square[3] = {0}, fourth = 0;
  const double n = (double)mesh->element_count;
  for (size_t e = 0; e < mesh->element_count; e++) {
    for (int a = 0; a < 3; a++) mean[a] += axes->frames[9 * e + (size_t)a] / n;
    for (int a = 0; a < 3; a++) square[a] += pow(axes->frames[9 * e + (size_t)a], 2) / n;
    fourth += pow(axes->frames[9 * e + 2], 4) / n;
  }
  for (int a = 0; a < 3; a++) {
    assert_close(mean[a], 0, 0, 4 / sqrt(3 * n));
    assert_close(square[a], 1.0 / 3, 0, 4 * 0.3 / sqrt(n));
  }
  assert_close(fourth, 0.2, 0, 4 * 0.27 / sqrt(n));
  vsc_axes_free(axes);
  vsc_axes_free(again);
  vsc_axes_free(other);
  vsc_mesh_free(mesh);
}

static double *add_vectors(vsc_mesh *mesh, const char *name, double x, double y, double z)
{
  double *v = vsc_arrays_add(&mesh->element_data, name, 3, mesh->element_count)->values;
  const double vector[3] = {x, y, z};
  for (size_t i = 0; i < 3 * mesh->element_count; i++) v[i] = vector[i % 3];
  return v;
}

static void arrays_of_the_mesh(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = from(VSC_FIBER_ARRAYS);
  refuse(mesh, &definition, "no array 'fiber'");
  double *fibers = add_vectors(mesh, "fiber", 0, 0, -2);
  vsc_fiber_report report;
  vsc_axes *axes = make(mesh, &definition, &report);
  assert_true(report.constant);
  assert_close(axes->frames[2], -1, 0, 1e-12);
  vsc_axes_free(axes);
  vsc_copy_name(definition.sheet_array, "blatt");
  refuse(mesh, &definition, "'blatt'");
  vsc_copy_name(definition.sheet_array, "region");
  refuse(mesh, &definition, "expected a vector");
  vsc_copy_name(definition.sheet_array, "sheet");
  double *sheets = add_vectors(mesh, "sheet", 0, 3, 0);
  fibers[0] = 1;                           // 10 others stay: not constant
  fibers[3 + 2] = 0;                       // no fibre
  fibers[6] = NAN;                         // no fibre
  sheets[9 + 2] = 3;                       // at 45 degrees
  sheets[12 + 1] = 0;                      // no sheet
  sheets[15] = INFINITY;                   // no sheet
  sheets[18 + 1] = 0, sheets[18 + 2] = 1;  // along the fibre
  trap_off();
  axes = make(mesh, &definition, &report);
  trap_on();
  assert_false(report.constant);
  assert_int_equal(report.invalid, 2);
  assert_int_equal(report.passive, 2);
  assert_int_equal(report.invalid_sheets, 3);
  assert_close(report.worst_sheet_angle, 90, 0, 1e-6);
  assert_close(axes->frames[9 * 3 + 4], 1, 0, 1e-12);
  assert_int_equal(axes->known[1] + axes->known[2], 0);
  vsc_axes_free(axes);
  definition.fill = true;
  trap_off();
  axes = make(mesh, &definition, &report);
  trap_on();
  assert_int_equal(report.filled, 2);
  assert_int_equal(report.passive, 0);
  assert_int_equal(axes->known[1] + axes->known[2], 2);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

// The mean axis of the corners' vectors in the plane of x and z: by the double of their angles.
static double mean_angle(const vsc_mesh *mesh, size_t element, const double *vectors)
{
  double cosine = 0, sine = 0;
  for (int c = 0; c < 4; c++) {
    const double *v = vectors + 3 * (size_t)vsc_mesh_corners(mesh, element)[c], angle = atan2(v[0], v[2]);
    cosine += cos(2 * angle);
    sine += sin(2 * angle);
  }
  return atan2(sine, cosine) / 2;
}

// Vectors on the nodes of linear tets, whose signs and lengths mean nothing: an element takes the mean axis.
static void arrays_of_the_nodes(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = from(VSC_FIBER_ARRAYS);
  double *fibers = vsc_arrays_add(&mesh->node_data, "fiber", 3, mesh->node_count)->values;
  for (size_t i = 0; i < mesh->node_count; i++) {
    const double sign = i % 2 == 0 ? 1 : -1, lean = mesh->nodes[3 * i];
    fibers[3 * i] = sign * lean;
    fibers[3 * i + 2] = sign;
  }
  vsc_fiber_report report;
  vsc_axes *axes = make(mesh, &definition, &report);
  assert_int_equal(report.invalid, 0);
  assert_true(report.opposed > 0);  // the first layers turn by more than 10 degrees
  for (size_t e = 0; e < mesh->element_count; e++) {
    const double angle = mean_angle(mesh, e, vsc_arrays_find(&mesh->node_data, "fiber")->values);
    assert_close(axes->frames[9 * e] * cos(angle), axes->frames[9 * e + 2] * sin(angle), 0, 1e-12);
  }
  vsc_axes_free(axes);
  vsc_copy_name(definition.sheet_array, "blatt");
  refuse(mesh, &definition, "no vectors 'blatt' on its nodes");
  double *sheets = vsc_arrays_add(&mesh->node_data, "blatt", 3, mesh->node_count)->values;
  for (size_t i = 0; i < mesh->node_count; i++) sheets[3 * i + 1] = 2;
  axes = make(mesh, &definition, &report);
  for (size_t e = 0; e < mesh->element_count; e++)
    assert_close(fabs(axes->frames[9 * e + 4]), 1, 0, 1e-12);
  vsc_axes_free(axes);
  vsc_mesh_free(mesh);
}

static vsc_mesh *one_tet(const int order[4])
{
  static const double x[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  vsc_mesh *mesh = vsc_mesh_create(4, 1, 0);
  assert_non_null(mesh);
  memcpy(mesh->nodes, x, sizeof x);
  for (int c = 0; c < 4; c++) mesh->corners[c] = (uint32_t)order[c];
  return mesh;
}

// Axes that turn by 130 degrees across a tet: whichever corner is named first, however long vectors are and wherever they
// point to along their axis, its axis is the same, and so is the sheet's. By vectors turned to the side of the first they
// would differ by tens of degrees. Likewise at each point of a quadratic tet, told by the corner that it is nearest to.
static void no_corner_comes_first(void **state)
{
  (void)state;
  static const int orders[6][4] = {{0, 1, 2, 3}, {1, 2, 0, 3}, {2, 0, 1, 3}, {3, 1, 0, 2}, {1, 3, 2, 0}, {2, 3, 0, 1}};
  static const double angles[4] = {0, 50, 100, 130}, lengths[4] = {1, 3, 0.2, 1};
  double first[2][4][9];
  for (int k = 0; k < 24; k++) {
    const int raised = k % 2, order = k / 2 % 6, longer = k / 12;
    vsc_mesh *mesh = one_tet(orders[order]);
    vsc_fiber_def definition = from(VSC_FIBER_ARRAYS);
    vsc_error error;
    double *fibers = vsc_arrays_add(&mesh->node_data, "fiber", 3, 4)->values;
    double *sheets = vsc_arrays_add(&mesh->node_data, "sheet", 3, 4)->values;
    for (int c = 0; c < 4; c++) {
      const double angle = angles[c] * degree, length = ((order + c) % 2 ? -1 : 1) * (longer ? lengths[c] : 1);
      fibers[3 * c] = length * cos(angle);
      fibers[3 * c + 2] = length * sin(angle);
      sheets[3 * c] = -sin(angle) / length;
      sheets[3 * c + 2] = cos(angle) / length;
    }
    if (raised && vsc_mesh_raise(&mesh, "tet", &error) != VSC_OK) fail_msg("%s", error.text);
    vsc_fiber_report report;
    vsc_axes *axes = make(mesh, &definition, &report);
    for (int q = 0; q < axes->points; q++) {
      double *known = first[raised][orders[order][q]], *frame = vsc_axes_frame(axes, 0, q);
      if (!raised) known = first[0][0];
      if (k < 2) memcpy(known, frame, 9 * sizeof *frame);
      for (int a = 0; a < 2; a++) assert_close(fabs(vsc_dot(frame + 3 * a, known + 3 * a)), 1, 0, 1e-12);
    }
    assert_int_equal(report.opposed, 1);
    vsc_axes_free(axes);
    vsc_mesh_free(mesh);
  }
}

// From -60 to +60 degrees across one layer of elements: as axes through 90 degrees, with their sense kept through 0; the
// same at the points of quadratic tets, where those on the middles of edges are no help to axes.
static void senses_that_are_meant(void **state)
{
  (void)state;
  for (int order = 1; order <= 2; order++)
    for (int kept = 0; kept < 2; kept++) {
      vsc_mesh *mesh = block();
      vsc_fiber_def definition = from(VSC_FIBER_ARRAYS);
      vsc_error error;
      double low = INFINITY, high = -INFINITY;
      for (size_t i = 0; i < mesh->node_count; i++) {
        low = fmin(low, mesh->nodes[3 * i + 2]);
        high = fmax(high, mesh->nodes[3 * i + 2]);
      }
      double *fibers = vsc_arrays_add(&mesh->node_data, "fiber", 3, mesh->node_count)->values;
      for (size_t i = 0; i < mesh->node_count; i++) {
        const double side = 2 * (mesh->nodes[3 * i + 2] - low) / (high - low) - 1;
        fibers[3 * i] = 0.5;
        fibers[3 * i + 1] = side > 0 ? sqrt(0.75) : -sqrt(0.75);
      }
      if (order == 2 && vsc_mesh_raise(&mesh, "block", &error) != VSC_OK) fail_msg("%s", error.text);
      definition.sense_kept = kept;
      vsc_fiber_report report;
      vsc_axes *axes = make(mesh, &definition, &report);
      size_t opposed = 0;
      for (size_t e = 0; e < mesh->element_count; e++) {
        const uint32_t *corner = vsc_mesh_corners(mesh, e);
        bool mixed = false;
        for (int i = 1; i < 4; i++)
          mixed |= vsc_arrays_find(&mesh->node_data, "fiber")->values[3 * corner[i] + 1] !=
                   vsc_arrays_find(&mesh->node_data, "fiber")->values[3 * corner[0] + 1];
        opposed += mixed;
        for (int q = 0; q < axes->points; q++) {
          const double *f = vsc_axes_frame(axes, e, q);
          // within the cone of the two that are mixed, about x or about y; sides of 60 degrees are both
          assert_true(kept ? fabs(f[0]) > 0.5 - 1e-12 : fabs(f[1]) > sqrt(0.75) - 1e-12);
          if (mixed) assert_true(fabs(fabs(f[0]) - 0.5) > 1e-3);
        }
      }
      assert_true(opposed > 0);
      assert_int_equal(report.opposed, opposed);
      vsc_axes_free(axes);
      vsc_mesh_free(mesh);
    }
}

// Signs by chance, of axes that hardly turn: none of them is opposed to another, and sheets do not count.
static void signs_by_chance_are_no_opposition(void **state)
{
  (void)state;
  for (int order = 1; order <= 2; order++) {
    vsc_mesh *mesh = block();
    vsc_fiber_def definition = from(VSC_FIBER_ARRAYS);
    vsc_fiber_report report;
    vsc_error error;
    double *fibers = vsc_arrays_add(&mesh->node_data, "fiber", 3, mesh->node_count)->values;
    for (size_t i = 0; i < mesh->node_count; i++) {
      const double sign = i * 2654435761u >> 7 & 1 ? 1 : -1, angle = 4 * degree * mesh->nodes[3 * i];
      fibers[3 * i] = sign * cos(angle);
      fibers[3 * i + 1] = sign * sin(angle);
    }
    if (order == 2 && vsc_mesh_raise(&mesh, "block", &error) != VSC_OK) fail_msg("%s", error.text);
    vsc_axes *axes = make(mesh, &definition, &report);
    assert_int_equal(report.opposed, 0);
    vsc_axes_free(axes);
    vsc_mesh_free(mesh);
  }
}

// A map whose angles lie on the cells, beside another array on the points; and one that is here and there.
static void map_on_cells_beside_points(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  vsc_fiber_def definition = from(VSC_FIBER_MAP);
  snprintf(definition.map.file, VSC_PATH, "/tmp/viscera_test_cells_%ld.vti", (long)getpid());
  for (int mixed = 0; mixed < 2; mixed++) {
    FILE *file = fopen(definition.map.file, "w");
    if (file == NULL) fail_msg("%s", definition.map.file);
    static const char array[] = "<DataArray type=\"Float64\" Name=\"%s\" format=\"ascii\">%s</DataArray>";
    fputs("<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">"
          "<ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"0 0 0\" Spacing=\"4 4 6\"><Piece Extent=\"0 2 0 1 0 1\">"
          "<PointData>", file);
    fprintf(file, array, mixed ? "elevation" : "other", "0 0 0 0 0 0 0 0 0 0 0 0");
    fputs("</PointData><CellData>", file);
    fprintf(file, array, "azimuth", "20 20");
    fprintf(file, array, mixed ? "more" : "elevation", "0 0");
    fputs("</CellData></Piece></ImageData></VTKFile>", file);
    fclose(file);
    if (mixed) {
      refuse(mesh, &definition, "array 'azimuth' for the map's azimuth lies on the cells");
      break;
    }
    vsc_fiber_report report;
    vsc_axes *axes = make(mesh, &definition, &report);
    assert_int_equal(report.with_data, mesh->element_count);
    for (size_t e = 0; e < mesh->element_count; e++)
      assert_close(fabs(axes->frames[9 * e]), cos(20 * degree), 0, 1e-12);
    vsc_axes_free(axes);
  }
  unlink(definition.map.file);
  vsc_mesh_free(mesh);
}

static void map_from_a_file(void **state)
{
  (void)state;
  vsc_mesh *mesh = block();
  const size_t size[3] = {5, 5, 5};
  vsc_image *image = vsc_image_create(size);
  for (int a = 0; a < 3; a++) image->spacing[a] = 0.25;  // cm
  for (int a = 0; a < 2; a++) {
    vsc_array *array = vsc_arrays_add(&image->data, a == 0 ? "azimuth" : "elevation", 1, 125);
    for (size_t v = 0; v < 125; v++) array->values[v] = a == 0 ? 30 : 45;
  }
  vsc_fiber_def definition = from(VSC_FIBER_MAP);
  snprintf(definition.map.file, VSC_PATH, "/tmp/viscera_test_%ld.vti", (long)getpid());
  refuse(mesh, &definition, definition.map.file);
  assert_int_equal(vsc_vtk_write_image(definition.map.file, image, NULL), VSC_OK);
  definition.map.length_unit = 10;
  vsc_fiber_report report;
  vsc_axes *axes = make(mesh, &definition, &report);
  assert_int_equal(report.with_data, mesh->element_count);
  for (size_t e = 0; e < mesh->element_count; e++) {
    const double f[3] = {cos(30 * degree) * sqrt(0.5), sin(30 * degree) * sqrt(0.5), sqrt(0.5)};
    assert_close(fabs(vsc_dot(f, &axes->frames[9 * e])), 1, 0, 1e-6);
  }
  definition.map.length_unit = 1000;
  snprintf(definition.map.azimuth, VSC_NAME, "azimut");
  refuse(mesh, &definition, definition.map.file);
  unlink(definition.map.file);
  vsc_axes_free(axes);
  vsc_image_free(image);
  vsc_mesh_free(mesh);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(none_is_passive),    cmocka_unit_test(one_direction),
      cmocka_unit_test(a_source_must_be_one),
      cmocka_unit_test(figure_six),         cmocka_unit_test(random_fibers_fill_the_sphere),
      cmocka_unit_test(arrays_of_the_mesh), cmocka_unit_test(arrays_of_the_nodes),
      cmocka_unit_test(no_corner_comes_first),
      cmocka_unit_test(senses_that_are_meant),
      cmocka_unit_test(signs_by_chance_are_no_opposition),
      cmocka_unit_test(map_on_cells_beside_points),
      cmocka_unit_test(map_from_a_file),
  };
  return cmocka_run_group_tests_name("fibers/fibers", tests, NULL, NULL);
}
