// SPDX-License-Identifier: GPL-3.0-or-later
// Broken input through the whole program: one clear line on stderr, the right exit code, nothing
// written.
#include "write_tets.h"
#include "block_scene.h"
#include "trap.h"
#include "io/scene.h"
#include "mesh/image.h"

// A broken scene: the options that break it, what the line must hold.
typedef struct broken {
  const char *options;
  const char *part;
} broken;

// The last command failed with `code` and one line that begins with the program's name and holds
// `part`.
static void assert_one_line(const char *command, int found, int code, const char *part)
{
  if (found != code)
    fail_msg("%s: exit code %d, expected %d: %s", command, found, code, complained);
  if (line_count(complained) != 1 || strncmp(complained, "viscera", 7) != 0 ||
      strlen(complained) < 30)
    fail_msg("%s: not one line: '%s'", command, complained);
  if (strstr(complained, part) == NULL) fail_msg("%s: no '%s' in '%s'", command, part, complained);
}

// By check and by run; the latter leaves no folder.
static void refused(const char *scene, const broken *b)
{
  char command[1024];
  snprintf(command, sizeof command, "$V check %s %s", scene, b->options);
  assert_one_line(command, shell(command), 2, b->part);
  snprintf(command, sizeof command, "$V run %s -o results %s", scene, b->options);
  assert_one_line(command, shell(command), 2, b->part);
  assert_string_equal(said, "");
  assert_true(access(in_folder("results"), F_OK) != 0);
}

static void all_refused(const char *scene, const broken *cases, size_t count)
{
  for (size_t k = 0; k < count; k++) refused(scene, &cases[k]);
}

#define ALL_REFUSED(scene, cases) all_refused((scene), (cases), sizeof(cases) / sizeof(cases)[0])

static void test_settings(void **state)
{
  (void)state;
  static const broken cases[] = {
      {"--set 'materials[0].axail.f=1 kPa'", "axial"},     // unknown key, with the nearest
      {"--set 'materials[0].axial.f=1'", "unit"},          // a bare number
      {"--set 'materials[0].axial.f=1 s'", "axial.f"},     // seconds are no pressure
      {"--set 'materials[0].axial.f=1 kpa'", "axial.f"},   // no such unit
      {"--set 'materials[0].axial.f=-1 kPa'", "axial.f"},  // below zero
      {"--set 'materials[0].axial.f=nan kPa'", "axial.f"},
      {"--set 'materials[0].volume_modulus=0 kPa'", "volume_modulus"},
      {"--set 'materials[0].active.curve.kind=sine'", "half_sine"},
      {"--set 'materials[0].active.amplitude_array=strength'", "strength"},
      {"--set 'time.end=0 s'", "time.end"},
      {"--set 'time.end=-1 s'", "time.end"},
      {"--set 'output.frames=0 ms'", "output.frames"},
      {"--set 'output.frames=1e-308 ms'", "output.frames: 1e-308 ms; expected 2e-08 ms at least"},
      {"--set 'output.signals=1e-9 ms'", "output.signals: 1e-09 ms; expected 2e-08 ms at least"},
      {"--set 'output.checkpoint=1e-9 ms'", "output.checkpoint: 1e-09 ms; expected 2e-08 ms at least"},
      {"--set 'output.cavities=[hole]'", "hole"},
      {"--set 'output.arrays=[displacment]'", "displacement"},
      {"--set 'output.arrays=[helix_angle]'", "output.axis"},
      {"--set 'supports[0].set=lefft'", "left"},
      {"--set 'supports[0].held=[w]'", "held"},
      {"--set 'pressures[0].surface=nd'", "end"},
      {"--set 'node_sets[0].value=7'", "left"},  // an empty set
      {"--set 'node_sets[0].node_array=nothing'", "nothing"},
      {"--set mesh.file=none.vtu", "none.vtu"},
      {"--set mesh.region_array=regoin", "region"},
      {"--set mesh.unit=kg", "mesh.unit"},
      {"--set 'fibers.arrays.fiber=region'", "region"},  // one number an element is no direction
      {"--set fibers.arrays.fiber=nothing", "nothing"},
      {"--set fibers.source=none", "no element has a fibre"},
      {"--set 'materials[0].regions=[5]'", "region 1"},
      {"--set nonsense", "nonsense"},
      {"--set =", "--set"},
      {"--set 'time.end='", "time.end"},
      {"--set 'time.step=1 s'", "block.yaml: time.step: "},  // above the stable step
  };
  ALL_REFUSED("block.yaml", cases);
}

// Every pressure has a column of signals.csv, and those are counted.
static void test_too_many_pressures(void **state)
{
  (void)state;
  char command[4096] = "$V check block.yaml --set 'pressures=[";
  for (int k = 0; k < VSC_MOST_PRESSURES + 1; k++) strcat(command, "{surface: end, peak: 0 kPa},");
  strcat(command, "]'");
  assert_one_line("53 pressures", shell(command), 2, "pressures: 53 of them");
}

static void test_options(void **state)
{
  (void)state;
  static const broken cases[] = {
      {"--threads 0", "--threads 0"},
      {"--threads many", "--threads many"},
      {"--threads -3", "--threads -3"},
      {"--threads 99999999999999999999", "--threads"},
      {"--threads ''", "--threads"},
      {"--thread=x", "--threads x"},
      {"--nonsense", "nonsense"},
      {"extra.yaml", "one scene file"},
      {"--set", "argument"},
  };
  ALL_REFUSED("block.yaml", cases);
  static const broken none = {"", "one scene file"};
  refused("", &none);
  assert_one_line("stop", shell("$V run block.yaml --stop 1"), 2, "--stop");
  assert_one_line("stop", shell("$V run block.yaml --stop '0 s'"), 2, "above zero");
  assert_one_line("stop", shell("$V run block.yaml --stop '-1 s'"), 2, "above zero");
  assert_one_line("verb", shell("$V runn block.yaml"), 2, "did you mean 'run'");
  assert_int_equal(shell("$V"), 2);
  assert_holds(complained, "Usage");
}

static void test_scene_files(void **state)
{
  (void)state;
  static const char *const texts[][2] = {
      {"", "bad.yaml"},  // empty
      {"\n\n# nothing\n", "bad.yaml"},
      {"mesh: {file: block.vtu, unit: mm\n", "bad.yaml:"},  // never closed
      {"mesh:\n\tfile: block.vtu\n", "bad.yaml:"},          // a tab
      {"- 1\n- 2\n", "bad.yaml"},                           // a list
      {"mesh: {file: block.vtu, unit: mm}\n", "bad.yaml"},  // materials and time are missing
      {"mesh: {file: block.vtu, unit: mm}\nmsh: 3\n", "bad.yaml:2"},
      {"\x01\x02\x7f\xff\xfe garbage \x80", "bad.yaml"},
      {"mesh: &a [*a]\n", "bad.yaml"},
  };
  static const broken nothing = {"", "none.yaml"}, folder = {"", "."};
  for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
    const broken bad = {"", texts[k][1]};
    save_text("bad.yaml", texts[k][0]);
    refused("bad.yaml", &bad);
  }
  refused("none.yaml", &nothing);
  refused(".", &folder);
}

// The scene file itself is broken at one place; the line says which.
static void test_line_numbers(void **state)
{
  (void)state;
  char text[sizeof block_scene + 64];
  const char *cut = strstr(block_scene, "    angular:");
  snprintf(text, sizeof text, "%.*s    agnular: {fs: 10 kPa, sn: 10 kPa, nf: 10 kPa}\n%s",
           (int)(cut - block_scene), block_scene, strstr(cut, "    damping"));
  save_text("line.yaml", text);
  static const broken bad = {"", "line.yaml:11"};
  refused("line.yaml", &bad);
  assert_holds(complained, "angular");
}

// Writes the first `part` of the block's file, or other bytes.
static void test_mesh_files(void **state)
{
  (void)state;
  static const char *const names[] = {"empty.vtu", "garbage.vtu", "words.vtk",
                                      "cut.vtu",   "half.vtu",    "folder.vtu"};
  must(
      ": >empty.vtu; head -c 5000 /dev/urandom >garbage.vtu; echo 'no mesh' >words.vtk; mkdir -p "
      "folder.vtu");
  must(
      "n=$(wc -c <block.vtu); head -c $((n / 2)) block.vtu >half.vtu; head -c $((n - 30)) "
      "block.vtu >cut.vtu");
  for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
    char option[64];
    snprintf(option, sizeof option, "--set mesh.file=%s", names[k]);
    const broken bad = {option, names[k]};
    refused("block.yaml", &bad);
  }
}

// Two tets with the arrays that the scene wants; the first node lies at x = `first`, all fibres are
// (f, 0, 0).
static void write_two(double first, double f)
{
  static const uint32_t tets[8] = {0, 1, 2, 3, 1, 2, 3, 4};
  const double nodes[15] = {first, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10, 9, 9, 9};
  const double x0[5] = {1, 0, 1, 1, 0}, x1[5] = {0, 1, 1, 1, 1}, region[2] = {1, 1},
               fiber[6] = {f, 0, 0, f, 0, 0};
  const vsc_vtk_array arrays[] = {{"x0", 1, x0, VSC_ON_NODES, false},
                                  {"x1", 1, x1, VSC_ON_NODES, false},
                                  {"region", 1, region, VSC_ON_ELEMENTS, true},
                                  {"direction", 3, fiber, VSC_ON_ELEMENTS, false}};
  assert_int_equal(
      write_tets(in_folder("two.vtu"), 5, nodes, 2, tets, 0, NULL, 4, arrays, true, NULL),
      VSC_OK);
}

static void test_bad_numbers(void **state)
{
  (void)state;
  static const struct {
    double first, fiber;
    const char *part;
  } cases[] = {{NAN, 1, "(points 0)"},
               {-INFINITY, 1, "(points 0)"},
               {10, 1, "two.vtu: "},  // two nodes at one place: no volume
               {0, NAN, "no element has a fibre"},
               {0, INFINITY, "no element has a fibre"},
               {0, 0, "no element has a fibre"}};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    const broken bad = {"--set mesh.file=two.vtu", cases[k].part};
    trap_off();  // VTK compares NaN for their range
    write_two(cases[k].first, cases[k].fiber);
    trap_on();
    refused("block.yaml", &bad);
  }
  write_two(0, 1);  // and without a mistake it runs
  must("$V run block.yaml -q -o fine --set mesh.file=two.vtu --set 'time.end=1 ms' && rm -r fine");
}

// Cells that name nodes which are not there, or one twice, or that are cut short.
static void test_bad_cells(void **state)
{
  (void)state;
  static const char *const cells[] = {"4 0 1 2 9", "4 0 1 2 -1", "4 0 1 2 2",
                                      "4 0 1 2",   "3 0 1 2 3",  ""};
  static const broken bad = {"--set mesh.file=m.vtk", "m.vtk"};
  for (size_t k = 0; k < sizeof cells / sizeof cells[0]; k++) {
    char text[512];
    snprintf(
        text, sizeof text,
        "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n"
        "0 0 0\n10 0 0\n0 10 0\n0 0 10\n9 9 9\nCELLS 2 10\n%s\n4 1 2 3 4\nCELL_TYPES 2\n10\n10\n"
        "CELL_DATA 2\nSCALARS region int\nLOOKUP_TABLE default\n1\n1\n",
        cells[k]);
    save_text("m.vtk", text);
    refused("block.yaml", &bad);
  }
}

static void write_map(const char *name, double angle, double tissue, double origin)
{
  vsc_image *image = vsc_image_create((const size_t[]){4, 4, 4});
  assert_non_null(image);
  static const char *const names[] = {"azimuth", "elevation", "tissue"};
  for (int a = 0; a < 3; a++) {
    vsc_array *array = vsc_arrays_add(&image->data, names[a], 1, 64);
    assert_non_null(array);
    for (int k = 0; k < 64; k++) array->values[k] = a < 2 ? angle : tissue;
  }
  for (int i = 0; i < 3; i++) {
    image->spacing[i] = 8;
    image->origin[i] = origin;
  }
  assert_int_equal(vsc_vtk_write_image(in_folder(name), image, NULL), VSC_OK);
  vsc_image_free(image);
}

static void test_maps(void **state)
{
  (void)state;
#define MAP "--set fibers.source=map --set 'fibers.map="
  static const broken cases[] = {
      {MAP "{file: none.vti}'", "none.vti"},
      {MAP "{file: map.vti, azimuth: azimut}'", "azimuth"},
      {MAP "{file: map.vti, mask: tissues}'", "tissue"},
      {MAP "{file: map.vti, angle_unit: 1 mm}'", "angle_unit"},
      {MAP "{file: nan.vti}'", "nan.vti"},
      {MAP "{file: bare.vti, mask: tissue}'", "bare.vti"},  // no voxel of tissue
      {MAP "{file: far.vti}'", "far.vti"},                  // beside the mesh
      {MAP "{file: cut.vti}'", "cut.vti"},
      {MAP "{file: empty.vti}'", "empty.vti"},
      {MAP "{file: block.vtu}'", "block.vtu"},  // no image
  };
#undef MAP
  write_map("map.vti", 30, 1, -2);
  trap_off();
  write_map("nan.vti", NAN, 1, -2);
  trap_on();
  write_map("bare.vti", 30, 0, -2);
  write_map("far.vti", 30, 1, 500);
  must(": >empty.vti; head -c 300 map.vti >cut.vti");
  ALL_REFUSED("block.yaml", cases);
  must("$V check block.yaml --set fibers.source=map --set fibers.map.file=map.vti");
}

// Curves come from files too.
// A curve that has no finite values is refused under its key, wherever it is.
static void test_extreme_curves(void **state)
{
  (void)state;
  static const char *const keys[][2] = {{"materials[0].active.curve", ""},
                                        {"pressures[0].curve", ""},
                                        {"supports[0].curve", "--set 'supports[0].motion=[1 mm, 0 mm, 0 mm]'"},
                                        {"obstacles[0].curve", "--set 'obstacles=[{kind: plane, point: [0 mm, 0 mm, -20 mm], "
                                                               "normal: [0, 0, 1], motion: [0 mm, 0 mm, 1 mm]}]'"}};
  for (size_t k = 0; k < sizeof keys / sizeof keys[0]; k++) {
    char options[400], part[80];
    snprintf(options, sizeof options, "%s --set '%s={kind: double_hill, start: 1e30 ms, rise: 1e308 ms, fall: 1e-308 ms, "
             "rise_power: 1e30}'", keys[k][1], keys[k][0]);
    snprintf(part, sizeof part, "block.yaml: %s: its value at 0 ms is not a finite number", keys[k][0]);
    refused("block.yaml", &(broken){options, part});
  }
  assert_int_equal(shell("$V check block.yaml --set 'materials[0].active.curve={kind: bestel, start: 0 ms, stop: 10 ms, "
                         "width: 1e-300 ms, rate_up: 1e300 1/s, rate_down: -1e300 1/s}'"), 3);
  assert_holds(complained, "block.yaml: materials[0].active.curve: its equation cannot be followed at ");
  assert_null(strstr(complained, "success"));
}

static void test_curve_files(void **state)
{
  (void)state;
  static const char *const texts[] = {"",           "time,value\n", "0,0\n", "0,0\n2,1\n1,0\n",
                                      "0,0\n1,x\n", "0,nan\n1,1\n", "0\n1\n"};
  static const broken bad = {
      "--set 'materials[0].active.curve={kind: table, file: c.csv, time_unit: ms}'", "c.csv"};
  static const broken missing = {
      "--set 'materials[0].active.curve={kind: table, file: no.csv, time_unit: ms}'", "no.csv"};
  for (size_t k = 0; k < sizeof texts / sizeof texts[0]; k++) {
    save_text("c.csv", texts[k]);
    refused("block.yaml", &bad);
  }
  refused("block.yaml", &missing);
}

// Where results cannot be written: exit code 4, and no half of anything.
static void test_unwritable_output(void **state)
{
  (void)state;
  must("echo file >taken; rm -rf results");
  assert_one_line("taken", shell("$V run block.yaml -q -o taken"), 4, "taken");
  assert_one_line("deep", shell("$V run block.yaml -q -o no/such/folder"), 4,
                  "no/such/folder: the folder cannot be made");
  assert_one_line("proc", shell("$V run block.yaml -q -o /proc/viscera"), 4, "/proc/viscera");
  must("mkdir -p blocked/frames/block_00000.vtu/x");
  assert_one_line("frame", shell("$V run block.yaml -q -o blocked"), 4, "block_00000.vtu");
  must("mkdir -p closed/signals.csv");
  assert_one_line("signals", shell("$V run block.yaml -q -o closed"), 4, "signals.csv");
  must("ls closed");
  assert_null(strstr(said, "tmp"));
}

// A disk that fills up while the rows are written.
static void test_full_disk(void **state)
{
  (void)state;
  must("mkdir -p full && ln -sf /dev/full full/signals.csv");
  assert_one_line("full", shell("$V run block.yaml -q -o full"), 4, "signals.csv");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_settings),    cmocka_unit_test(test_options),
      cmocka_unit_test(test_scene_files), cmocka_unit_test(test_line_numbers),
      cmocka_unit_test(test_mesh_files),  cmocka_unit_test(test_bad_numbers),
      cmocka_unit_test(test_bad_cells),   cmocka_unit_test(test_maps),
      cmocka_unit_test(test_extreme_curves),
      cmocka_unit_test(test_curve_files), cmocka_unit_test(test_unwritable_output),
      cmocka_unit_test(test_full_disk),   cmocka_unit_test(test_too_many_pressures),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
