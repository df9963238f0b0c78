// SPDX-License-Identifier: GPL-3.0-or-later
// Files that nobody should have sent: each ends in VSC_INPUT and one line that names it.
#define _GNU_SOURCE  // memmem
#include <string.h>
#include <sys/stat.h>

#include "base/mem.h"
#include "box_mesh.h"
#include "close.h"
#include "io/vtk.h"
#include "write_tets.h"
#include "scratch.h"
#include "trap.h"

// VTK's reader of legacy files loses memory when a file breaks off.
const char *__lsan_default_suppressions(void);
const char *__lsan_default_suppressions(void)
{
  return "leak:libvtk\n";
}

// Returns the message for more looks; valid until the next call.
static const char *assert_no_mesh(const char *path, const char *words)
{
  static vsc_error error;
  vsc_mesh *mesh = NULL;
  error = (vsc_error){0};
  const vsc_status status = vsc_vtk_read_mesh(path, 1, &mesh, &error);
  if (status != VSC_INPUT) fail_msg("status %d for %s (%s): %s", status, path, words, error.text);
  assert_int_equal(error.status, VSC_INPUT);
  assert_null(mesh);
  assert_ptr_equal(strstr(error.text, path), error.text);
  for (const char *c = error.text; *c != '\0'; c++) assert_true((unsigned char)*c >= ' ');
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
  return error.text;
}

static const char *assert_no_image(const char *path, const char *words)
{
  static vsc_error error;
  vsc_image *image = NULL;
  error = (vsc_error){0};
  const vsc_status status = vsc_vtk_read_image(path, 1, &image, &error);
  if (status != VSC_INPUT) fail_msg("status %d for %s (%s): %s", status, path, words, error.text);
  assert_null(image);
  assert_ptr_equal(strstr(error.text, path), error.text);
  assert_null(strchr(error.text, '\n'));
  if (strstr(error.text, words) == NULL) fail_msg("\"%s\" not in \"%s\"", words, error.text);
  return error.text;
}

// An ASCII grid of five points; what is NULL is as it should be.
typedef struct parts {
  const char *type, *points, *connectivity, *offsets, *types, *point_data, *cell_data;
} parts;

static const char *write_parts(parts p)
{
  char text[4000];
  snprintf(text, sizeof text,
           "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"%s\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
           "<UnstructuredGrid><Piece NumberOfPoints=\"5\" NumberOfCells=\"2\">\n"
           "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">\n"
           "%s</DataArray></Points>\n"
           "<Cells>\n"
           "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">%s</DataArray>\n"
           "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">%s</DataArray>\n"
           "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\">%s</DataArray></Cells>\n"
           "<PointData>%s</PointData><CellData>%s</CellData>\n"
           "</Piece></UnstructuredGrid></VTKFile>\n",
           p.type ? p.type : "UnstructuredGrid",
           p.points ? p.points : "0 0 0 1 0 0 0 1 0 0 0 1 1 1 1",
           p.connectivity ? p.connectivity : "0 1 2 3 1 2 3 4", p.offsets ? p.offsets : "4 8",
           p.types ? p.types : "10 10", p.point_data ? p.point_data : "",
           p.cell_data ? p.cell_data : "");
  return scratch_text("parts.vtu", text);
}

static const char LEGACY[] = "# vtk DataFile Version 3.0\nheart\nASCII\nDATASET UNSTRUCTURED_GRID\n"
                             "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
                             "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n";

static void the_parts_as_they_should_be(void **state)
{
  (void)state;
  vsc_mesh *mesh;
  assert_int_equal(vsc_vtk_read_mesh(write_parts((parts){0}), 1, &mesh, NULL), VSC_OK);
  vsc_mesh_free(mesh);
  assert_int_equal(vsc_vtk_read_mesh(scratch_text("l.vtk", LEGACY), 1, &mesh, NULL), VSC_OK);
  vsc_mesh_free(mesh);
}

static void units_that_are_no_lengths(void **state)
{
  (void)state;
  static const double units[] = {0, -1, NAN, INFINITY};
  vsc_mesh *mesh;
  vsc_image *image;
  vsc_error error;
  for (int k = 0; k < 4; k++) {
    assert_int_equal(vsc_vtk_read_mesh("a.vtu", units[k], &mesh, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, "a.vtu: a unit of "));
    assert_int_equal(vsc_vtk_read_image("a.vti", units[k], &image, &error), VSC_INPUT);
    assert_non_null(strstr(error.text, "a.vti: a unit of "));
  }
}

static void names_that_are_no_files(void **state)
{
  (void)state;
  assert_no_mesh(scratch("missing.vtu"), "No such file");
  assert_no_mesh(scratch("missing.vtk"), "No such file");
  assert_no_mesh("", "No such file");
  assert_no_image(scratch("missing.vti"), "No such file");
  const char *folder = scratch("folder.vtu");
  assert_int_equal(mkdir(folder, 0777), 0);
  assert_no_mesh(folder, "not a regular file");
  assert_int_equal(rmdir(folder), 0);
}

static void files_that_are_not_vtk(void **state)
{
  (void)state;
  static const char garbage[] = "\x7f\x45LF\0\0\1\xff\xfe<<<>>>& garbage \n\n\n\x80";
  const char *meshes[] = {"m.vtu", "m.vtk"};
  for (int i = 0; i < 2; i++) {
    assert_no_mesh(scratch_text(meshes[i], ""), "is empty");
    assert_no_mesh(scratch_text(meshes[i], "\n"), "is not a");
    assert_no_mesh(scratch_bytes(meshes[i], garbage, sizeof garbage), "is not a");
    assert_no_mesh(scratch_text(meshes[i], "<html><body>404 not found</body></html>"), "is not a");
    assert_no_mesh(scratch_text(meshes[i], "<VTKFile"), "is not a");
    assert_no_mesh(scratch_text(meshes[i], "# vtk DataFile Version 9.9"), "is not a");
  }
  assert_no_image(scratch_text("i.vti", ""), "is empty");
  assert_no_image(scratch_bytes("i.vti", garbage, sizeof garbage), "is not a VTK XML file");
  assert_no_image(scratch_text("i.dcm", "DICM"), "only .vti and .vtk files");
  assert_no_mesh(scratch_text("heart.msh", "$MeshFormat\n"), "only .vtu and .vtk files");
  assert_no_mesh(scratch_text("vtu", "x"), "only .vtu and .vtk files");
}

static void files_of_another_kind(void **state)
{
  (void)state;
  assert_no_mesh(write_parts((parts){.type = "PolyData"}), "holds a VTK PolyData");
  assert_no_mesh(write_parts((parts){.type = "Nonsense"}), "holds a VTK Nonsense");
  assert_no_image(scratch_text("i.vti", "<VTKFile type=\"UnstructuredGrid\"></VTKFile>"),
                  "holds a VTK UnstructuredGrid");
  static const char surface[] = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n"
                                "POINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n";
  assert_no_mesh(scratch_text("s.vtk", surface), "holds a VTK PolyData");
  assert_no_image(scratch_text("s.vtk", surface), "holds a VTK PolyData");
  // A legacy file under the XML name.
  assert_no_mesh(scratch_text("s.vtu", surface), "a legacy file's name ends in .vtk");
}

static void grids_without_tets(void **state)
{
  (void)state;
  assert_no_mesh(write_parts((parts){.connectivity = "0 1", .offsets = "1 2", .types = "1 250"}),
                 "or triangles (1 vertices, 1 cells of VTK type 250)");
  assert_no_mesh(scratch_text("none.vtu",
                              "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
                              "byte_order=\"LittleEndian\"><UnstructuredGrid>"
                              "<Piece NumberOfPoints=\"0\" NumberOfCells=\"0\">"
                              "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\" "
                              "format=\"ascii\"/></Points><Cells>"
                              "<DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\"/>"
                              "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\"/>"
                              "<DataArray type=\"UInt8\" Name=\"types\" format=\"ascii\"/></Cells>"
                              "</Piece></UnstructuredGrid></VTKFile>"), "holds 0 points");
}

static void cells_that_lie(void **state)
{
  (void)state;
  const char *numbers[] = {"0 1 2 3 1 2 3 5", "0 1 2 3 1 2 3 -1", "0 1 2 3 1 2 3 4294967296",
                           "0 1 2 3 1 2 3 9223372036854775807"};
  for (size_t i = 0; i < sizeof numbers / sizeof numbers[0]; i++)
    assert_no_mesh(write_parts((parts){.connectivity = numbers[i]}), "cell 1 names point");
  assert_no_mesh(write_parts((parts){.connectivity = "0 1 2 3 0 1 9", .offsets = "4 7",
                                     .types = "10 5"}), "cell 1 names point 9");
  assert_no_mesh(write_parts((parts){.connectivity = "0 1 2 3 1 2 3", .offsets = "4 7"}),
                 "cell 1 has 3 points, its type says 4");
  assert_no_mesh(write_parts((parts){.offsets = "3 8"}), "cell 0 has 3 points");
  const char *offsets[] = {"4 800", "8 4", "-4 8", "4 -9223372036854775807", "4", "4 2"};
  for (size_t i = 0; i < sizeof offsets / sizeof offsets[0]; i++)
    assert_no_mesh(write_parts((parts){.offsets = offsets[i]}), "");
  // A cell that is ignored must not lead the tet behind it out of the list.
  const char *astray[] = {"40000 40004", "-4 0", "40004 40000"};
  for (size_t i = 0; i < sizeof astray / sizeof astray[0]; i++)
    assert_no_mesh(write_parts((parts){.offsets = astray[i], .types = "12 10"}), "");
}

static void geometry_that_means_nothing(void **state)
{
  (void)state;
  assert_no_mesh(write_parts((parts){.points = "0 0 0 1 0 0 0 1 0 0 0 1 1 nan 1"}), "");
  trap_off();  // the volume overflows
  assert_no_mesh(write_parts((parts){.points = "0 0 0 1 0 0 0 1 0 0 0 1 1e200 1 1"}), "cells 1");
  trap_on();
  assert_no_mesh(write_parts((parts){.points = "0 0 0 1 0 0 0 1 0 0 0 0 1 1 1"}), "degenerate");
  assert_no_mesh(write_parts((parts){.points = "0 0 0 1 0 0 0 1 0 1 1 0 1 1 1"}), "cells 0");
  assert_no_mesh(write_parts((parts){.connectivity = "0 1 2 2 1 2 3 4"}), "same point twice");
  vsc_mesh *mesh = NULL;
  assert_int_equal(vsc_vtk_read_mesh(write_parts((parts){0}), 0, &mesh, NULL), VSC_INPUT);
  trap_off();
  assert_int_equal(vsc_vtk_read_mesh(write_parts((parts){0}), INFINITY, &mesh, NULL), VSC_INPUT);
  assert_int_equal(vsc_vtk_read_mesh(write_parts((parts){0}), NAN, &mesh, NULL), VSC_INPUT);
  trap_on();
}

// Not-a-number points in binary, where VTK cannot stumble over the text.
static void points_that_are_not_numbers(void **state)
{
  (void)state;
  const int n[3] = {1, 1, 1};
  vsc_mesh *mesh = box_mesh(n, 1, NULL);
  const double odd[] = {NAN, INFINITY, -INFINITY};
  for (int i = 0; i < 3; i++) {
    mesh->nodes[3 * 5 + i] = odd[i];
    const char *path = scratch("nan.vtu");
    trap_off();  // VTK compares NaN for their range
    assert_int_equal(write_tets(path, mesh->node_count, mesh->nodes, mesh->element_count,
                                        mesh->corners, 0, NULL, 0, NULL, true, NULL), VSC_OK);
    assert_no_mesh(path, "points 5");
    trap_on();
    mesh->nodes[3 * 5 + i] = 1;
  }
  vsc_mesh_free(mesh);
}

static void arrays_that_lie(void **state)
{
  (void)state;
  assert_no_mesh(write_parts((parts){.point_data = "<DataArray type=\"Float32\" Name=\"p\" "
                                                   "format=\"ascii\">1 2 3</DataArray>"}), "");
  assert_no_mesh(write_parts((parts){.cell_data = "<DataArray type=\"Float32\" Name=\"c\" "
                                                  "format=\"ascii\">1</DataArray>"}), "");
  assert_no_mesh(write_parts((parts){.cell_data = "<DataArray type=\"Float99\" Name=\"c\" "
                                                  "format=\"ascii\">1 2</DataArray>"}), "");
  assert_no_mesh(write_parts((parts){.cell_data = "<DataArray type=\"Float32\" Name=\"c\" "
                                                  "format=\"appended\" offset=\"0\"/>"}), "");
  assert_no_mesh(write_parts((parts){.cell_data = "<DataArray type=\"Float32\" Name=\"c\" "
                                                  "format=\"binary\">####</DataArray>"}), "");
}

static const char *write_box(const char *name)
{
  const int n[3] = {2, 2, 2};
  vsc_mesh *mesh = box_mesh(n, 1, NULL);
  const vsc_vtk_array array = {"position", 3, mesh->nodes, VSC_ON_NODES, false};
  const char *path = scratch(name);
  assert_int_equal(write_tets(path, mesh->node_count, mesh->nodes, mesh->element_count,
                                      mesh->corners, 0, NULL, 1, &array, false, NULL), VSC_OK);
  vsc_mesh_free(mesh);
  return path;
}

// Cut at every thirteenth byte; the last few bytes only close the file.
static void truncated_xml(void **state)
{
  (void)state;
  size_t bytes;
  char *whole = scratch_load(write_box("whole.vtu"), &bytes);
  for (size_t cut = 0; cut + 40 < bytes; cut += 13)
    assert_no_mesh(scratch_bytes("cut.vtu", whole, cut), "");
  free(whole);
}

// The numbers of an array that nobody needs for the mesh itself are damaged, its length isn't.
static void damaged_arrays(void **state)
{
  (void)state;
  size_t bytes;
  char *whole = scratch_load(write_box("whole.vtu"), &bytes);
  // Into the middle of the first array's numbers, which are in base64.
  char *data = memmem(whole, bytes, "Name=\"position\"", 15);
  assert_non_null(data);
  data = memchr(data, '>', 1000);
  assert_non_null(data);
  memset(data + 100, 'x', 20);
  assert_no_mesh(scratch_bytes("damaged.vtu", whole, bytes), "(VTK: ");
  free(whole);
}

static void truncated_ascii_xml(void **state)
{
  (void)state;
  size_t bytes;
  char *whole = scratch_load(write_parts((parts){0}), &bytes);
  for (size_t cut = 0; cut + 2 < bytes; cut += 7)
    assert_no_mesh(scratch_bytes("cut.vtu", whole, cut), "");
  free(whole);
}

// Numbers of an array behind the underscore of AppendedData: their size in bytes before them.
static void append_numbers(FILE *file, const void *numbers, uint32_t size)
{
  fwrite(&size, sizeof size, 1, file);
  fwrite(numbers, size, 1, file);
}

// Raw data behind the grid, as other writers than ours leave them, are not missed by VTK.
static void truncated_appended_xml(void **state)
{
  (void)state;
  static const double points[12] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1}, values[4] = {1, 2, 3, 4};
  static const int32_t corners[4] = {0, 1, 2, 3}, end = 4;
  static const uint8_t type = 10;
  const char *path = scratch("appended.vtu");
  FILE *file = fopen(path, "wb");
  fputs("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
        "<UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"1\">\n"
        "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points>\n"
        "<Cells><DataArray type=\"Int32\" Name=\"connectivity\" format=\"appended\" offset=\"100\"/>\n"
        "<DataArray type=\"Int32\" Name=\"offsets\" format=\"appended\" offset=\"120\"/>\n"
        "<DataArray type=\"UInt8\" Name=\"types\" format=\"appended\" offset=\"128\"/></Cells>\n"
        "<PointData><DataArray type=\"Float64\" Name=\"heat\" format=\"appended\" offset=\"133\"/></PointData>\n"
        "</Piece></UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_", file);
  append_numbers(file, points, sizeof points);
  append_numbers(file, corners, sizeof corners);
  append_numbers(file, &end, sizeof end);
  append_numbers(file, &type, sizeof type);
  append_numbers(file, values, sizeof values);
  const long data = ftell(file);
  fputs("\n</AppendedData>\n</VTKFile>\n", file);
  fclose(file);
  vsc_mesh *mesh;
  vsc_error error;
  if (vsc_vtk_read_mesh(path, 1, &mesh, &error) != VSC_OK) fail_msg("%s", error.text);
  assert_true(vsc_arrays_find(&mesh->node_data, "heat")->values[3] == 4);
  vsc_mesh_free(mesh);
  size_t bytes;
  char *whole = scratch_load(path, &bytes);
  for (size_t cut = (size_t)data - 120; cut <= (size_t)data; cut += 8)
    assert_no_mesh(scratch_bytes("cut.vtu", whole, cut), "cut short");
  free(whole);
}

static void truncated_images(void **state)
{
  (void)state;
  vsc_image *image = vsc_image_create((size_t[]){5, 4, 3});
  vsc_arrays_add(&image->data, "a", 2, 60);
  assert_int_equal(vsc_vtk_write_image(scratch("whole.vti"), image, NULL), VSC_OK);
  vsc_image_free(image);
  size_t bytes;
  char *whole = scratch_load(scratch("whole.vti"), &bytes);
  for (size_t cut = 0; cut + 40 < bytes; cut += 13)
    assert_no_image(scratch_bytes("cut.vti", whole, cut), "");
  free(whole);
}

static void truncated_legacy(void **state)
{
  (void)state;
  for (size_t cut = 0; cut + 3 < sizeof LEGACY; cut++)
    assert_no_mesh(scratch_bytes("cut.vtk", LEGACY, cut), "");
}

// An array that breaks off must be noticed, though the mesh itself is complete.
static void truncated_legacy_arrays(void **state)
{
  (void)state;
  const char *arrays[] = {
    "POINT_DATA 4\nSCALARS a float 1\nLOOKUP_TABLE default\n1 2 3 4\n",
    "POINT_DATA 4\nFIELD f 1\nb 2 4 double\n1 2 3 4\n5 6 7 8",
    "CELL_DATA 1\nSCALARS c int 1\nLOOKUP_TABLE default\n5\nPOINT_DATA 4\n"
    "VECTORS d float\n1 2 3 4 5 6 7 8 9 10 11 12\n\n",
  };
  for (size_t a = 0; a < sizeof arrays / sizeof arrays[0]; a++) {
    char text[1000];
    const size_t length = (size_t)sprintf(text, "%s%s", LEGACY, arrays[a]);
    vsc_mesh *mesh = NULL;
    assert_int_equal(vsc_vtk_read_mesh(scratch_text("whole.vtk", text), 1, &mesh, NULL), VSC_OK);
    vsc_mesh_free(mesh);
    size_t end = length;
    while (text[end - 1] == '\n') end--;
    const size_t numbers = (size_t)(strrchr(text, '1') - text);
    for (size_t cut = numbers < end - 20 ? end - 20 : numbers; cut < end; cut++)
      if (text[cut] != ' ' && text[cut] != '\n' && (text[cut - 1] == ' ' || text[cut - 1] == '\n'))
        assert_no_mesh(scratch_bytes("cut.vtk", text, cut), "cut short");
  }
}

// The good file with one text in it replaced.
static const char *write_legacy(const char *from, const char *to)
{
  char text[1000];
  const char *place = strstr(LEGACY, from);
  snprintf(text, sizeof text, "%.*s%s%s", (int)(place - LEGACY), LEGACY, to, place + strlen(from));
  return scratch_text("legacy.vtk", text);
}

static void legacy_files_that_lie(void **state)
{
  (void)state;
  assert_no_mesh(write_legacy("4 0 1 2 3", "4 0 1 2 4"), "names point 4");
  assert_no_mesh(write_legacy("4 0 1 2 3", "4 0 1 2 -3"), "names point -3");
  assert_no_mesh(write_legacy("4 0 1 2 3", "3 0 1 2 3"), "announced");
  assert_no_mesh(write_legacy("4 0 1 2 3", "9 0 1 2 3"), "announced");
  assert_no_mesh(write_legacy("\n10\n", "\n12\n"), "cell 0 has 4 points, its type says 8");
  assert_no_mesh(write_legacy("0 0 1\n", "0 0 x\n"), "(VTK: Unrecognized keyword: x)");
  assert_no_mesh(write_legacy("0 0 1\n", "0 0 nan\n"), "");
  assert_no_mesh(write_legacy("POINTS 4 float", "POINTS 4 flaot"), "");
  assert_no_mesh(write_legacy("POINTS 4", "POINTS 0"), "");
  assert_no_mesh(write_legacy("POINTS 4", "POINTS -4"), "");
  assert_no_mesh(write_legacy("CELLS 1 5", "CELLS 0 0"), "");
  assert_no_mesh(write_legacy("CELLS 1 5", "CELLS 1 4"), "announced by CELLS 1 4");
  assert_no_mesh(write_legacy("CELLS 1 5", "cells 1 6"), "announced by CELLS 1 6");
  assert_no_mesh(write_legacy("CELLS 1 5", "CELLS 2 5"), "announced by CELLS 2 5");
  assert_no_mesh(write_legacy("CELLS 1 5", "CELLS 1 1000000000000"), "announced");
  assert_no_mesh(write_legacy("4 0 1 2 3", "-4 0 1 2 3"), "announced");
  assert_no_mesh(write_legacy("4 0 1 2 3", "4 0 1 2"), "announced");
  assert_no_mesh(write_legacy("CELLS 1 5\n", "CELLS 2 5\n-1 "), "announced");
  assert_no_mesh(write_legacy("ASCII", "BINARY"), "");
  assert_no_mesh(write_legacy("CELLS 1 5", "CELLS\"1 5"), "");
  assert_no_mesh(write_legacy("CELLS 1 5\n4 0 1 2 3\n", ""), "no CELLS before");
  assert_no_mesh(write_legacy("CELLS 1 5\n", "\nCELLS_ \n 1\n 7 "), "announced by CELLS 1 7");
  assert_no_mesh(write_legacy("UNSTRUCTURED_GRID", "UNSTRUCTURED_GRIT"), "");
}

// The format of VTK 9 has offsets, which VTK takes as they are.
static void legacy_offsets_that_lie(void **state)
{
  (void)state;
  const char *offsets[] = {"0 40000 40004", "0 -4 0", "0 40004 40000", "-8 -4 0", "0 2 6"};
  for (size_t i = 0; i < sizeof offsets / sizeof offsets[0]; i++) {
    char text[1000];
    snprintf(text, sizeof text,
             "# vtk DataFile Version 5.1\nheart\nASCII\nDATASET UNSTRUCTURED_GRID\n"
             "POINTS 4 float\n0 0 0 1 0 0 0 1 0 0 0 1\n"
             "CELLS 3 5\nOFFSETS vtktypeint64\n%s\nCONNECTIVITY vtktypeint64\n0 1 2 3 0\n"
             "CELL_TYPES 2\n12\n10\n", offsets[i]);
    assert_no_mesh(scratch_text("offsets.vtk", text), "contradicts itself");
  }
}

static void images_that_mean_nothing(void **state)
{
  (void)state;
  static const char form[] =
    "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">"
    "<ImageData WholeExtent=\"%s\" %s><Piece Extent=\"%s\"><PointData>%s</PointData>"
    "</Piece></ImageData></VTKFile>";
  static const char data[] = "<DataArray type=\"Int8\" Name=\"a\" format=\"ascii\">1 2 3 4 5 6 7 8"
                             "</DataArray>";
  const struct {
    const char *extent, *place, *data, *words;
  } cases[] = {
    {"0 1 0 1 0 1", "Origin=\"0 0 0\" Spacing=\"1 0 1\"", data, "spacing 0"},
    {"0 1 0 1 0 1", "Origin=\"0 0 0\" Spacing=\"1 1 1\" Direction=\"1 1 0 0 0 0 0 0 1\"", data,
     "direction"},
    {"0 1 0 1 0 1", "Origin=\"0 0 0\" Spacing=\"1 1 1\" Direction=\"0 0 0 0 0 0 0 0 0\"", data,
     ""},
    {"0 1 0 1 0 1", "Origin=\"0 0 0\" Spacing=\"1 1 1\"", "", "no numeric arrays"},
    {"0 2 0 1 0 1", "Origin=\"0 0 0\" Spacing=\"1 1 1\"", data, ""},
    {"0 -1 0 -1 0 -1", "Origin=\"0 0 0\" Spacing=\"1 1 1\"", data, ""},
  };
  for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
    char text[1000];
    snprintf(text, sizeof text, form, cases[i].extent, cases[i].place, cases[i].extent,
             cases[i].data);
    assert_no_image(scratch_text("bad.vti", text), cases[i].words);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
    cmocka_unit_test(the_parts_as_they_should_be),
    cmocka_unit_test(units_that_are_no_lengths),
    cmocka_unit_test(names_that_are_no_files),
    cmocka_unit_test(files_that_are_not_vtk),
    cmocka_unit_test(files_of_another_kind),
    cmocka_unit_test(grids_without_tets),
    cmocka_unit_test(cells_that_lie),
    cmocka_unit_test(geometry_that_means_nothing),
    cmocka_unit_test(points_that_are_not_numbers),
    cmocka_unit_test(arrays_that_lie),
    cmocka_unit_test(truncated_xml),
    cmocka_unit_test(damaged_arrays),
    cmocka_unit_test(truncated_ascii_xml),
    cmocka_unit_test(truncated_appended_xml),
    cmocka_unit_test(truncated_images),
    cmocka_unit_test(truncated_legacy),
    cmocka_unit_test(truncated_legacy_arrays),
    cmocka_unit_test(legacy_files_that_lie),
    cmocka_unit_test(legacy_offsets_that_lie),
    cmocka_unit_test(images_that_mean_nothing),
  };
  return cmocka_run_group_tests(tests, scratch_open, scratch_close);
}
