// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes, settings and curve files that are refused, each in one clear line.
#include "io/scene.h"

#include "base/mem.h"
#include "scene_files.h"
#include "trap.h"

static void assert_refused(const char *const *settings, size_t count, const char *place,
                           const char *key, const char *said)
{
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  trap_off();  // numbers in texts may be nan or beyond all numbers
  const vsc_status status = vsc_scene_read(scene_file, settings, count, &scene, &error);
  trap_on();
  if (status == VSC_OK) fail_msg("accepted, instead of \"%s\" for %s", said, key);
  if (getenv("VSC_SHOW") != NULL) print_message("%s\n", error.text);
  assert_int_equal(status, VSC_INPUT);
  assert_int_equal(error.status, VSC_INPUT);
  assert_null(scene);
  char start[512];
  snprintf(start, sizeof start, "%s:%s", scene_file, place);
  if (strncmp(error.text, start, strlen(start)) != 0)
    fail_msg("\"%s\" does not begin with \"%s\"", error.text, start);
  if (strstr(error.text, key) == NULL) fail_msg("\"%s\" lacks \"%s\"", error.text, key);
  if (strstr(error.text, said) == NULL) fail_msg("\"%s\" lacks \"%s\"", error.text, said);
  assert_null(strchr(error.text, '\n'));
}

// `full` with `old` replaced by `new`.
static void write_changed(const char *old, const char *new)
{
  char text[sizeof full + 2048];
  const char *at = strstr(full, old);
  assert_non_null(at);
  const int head = (int)(at - full);
  snprintf(text, sizeof text, "%.*s%s%s", head, full, new, at + strlen(old));
  scratch_text("scene.yaml", text);
}

// clang-format off
static const struct {
  const char *old, *new;  // in `full`
  const char *line, *key, *said;
} breaks[] = {
    // unknown keys at every level
    {"volume:", "volumes:", "49:", "volumes: unknown key", "did you mean volume?"},
    {"mesh: {file", "mesh: {fil", "1:", "mesh.fil:", "did you mean file?"},
    {"{name: epi,", "{nam: epi,", "4:", "surfaces[1].nam:", "did you mean name?"},
    {"high: [1 cm", "hihg: [1 cm", "7:", "node_sets[0].box.hihg:", "did you mean high?"},
    {"axes: world", "axis: world", "16:", "fibers.map.axis:", "did you mean axes?"},
    {"density:", "denisty:", "23:", "materials[0].denisty:", "did you mean density?"},
    {"nf: 1 kPa", "fn: 1 kPa", "25:", "materials[0].angular.fn:", "known here: fs, sn, nf"},
    {"rest_stretch", "rest_strech", "44:", "materials[1].active.rest_strech:", "rest_stretch?"},
    {"start: 50 ms", "begin: 50 ms", "54:", "pressures[0].curve.begin:", "start"},
    {"cavities:", "cavity:", "62:", "output.cavity:", "known here"},
    {"seed: 7", "<<: {seed: 7}", "19:", "fibers.<<:", "known here"},
    // keys given twice or not at all
    {"  seed: 7\n", "  fill: true\n", "13:", "fibers.fill:", "given twice, again on line 19;"},
    {"step: 0.01 ms", "end: 1 s", "56:", "time.end:", "given twice, again on line 56;"},
    {"volume: element\n", "volume: element\nvolume: nodal\n", "49:", "volume:", "given twice, again on line 50;"},
    {"volume: element\n", "mesh: {}\n", "1:", "mesh:", "given twice, again on line 49;"},
    {"    volume_modulus: 2 MPa\n", "", "37:", "materials[1].volume_modulus:", "missing"},
    {"end: 1.6 s, ", "", "56:", "time.end:", "\"end: 1.6 s\""},
    {"held: [x, z]", "", "51:", "supports[0].held:", "missing"},
    {"kind: tanh_pair, ", "", "54:", "pressures[0].curve.kind:", "missing"},
    {"      stiffness: 200 kPa\n", "", "41:", "materials[1].active.stiffness:", "missing"},
    {"    angular: {fs: 9 kPa, sn: 9 kPa, nf: 9 kPa}\n", "", "37:", "materials[1].angular:",
     "known here: fs, sn, nf"},
    {"unit: 0.1 mm, ", "", "1:", "mesh.unit:", "missing"},
    // shapes
    {"axial:   {f: 10 kPa, s: 5 kPa, n: 4 kPa}", "axial: 10 kPa", "24:", "materials[0].axial:",
     "known here: f, s, n"},
    {"density: 1050 kg/m3", "density: [1, 2]", "23:", "materials[0].density:",
     "a list; expected one value such as 1.06 g/cm3"},
    {"cavities: [endo, skin]", "cavities: endo", "62:", "output.cavities:", "[endo]"},
    {"  - {set: base,", "  {set: base,", "50:", "supports:",
     "dashes"},
    {"regions: [1, 2]", "regions: [1, [2]]", "22:", "materials[0].regions[1]:", "single"},
    {"[0 m/s2, 0 m/s2, -9.81 m/s2]", "[]", "52:", "gravity:", "an empty list"},
    {"-9.81 m/s2]", "]", "52:", "gravity:", "2 values; expected 3"},
    {"normal: [0, 0, 1]", "normal: []", "9:", "node_sets[1].plane.normal:", "[0, 0, 1]"},
    {"range: [1.5, 2.5]", "range: [1.5]", "4:", "surfaces[1].range:", "expected 2"},
    {"  kind: table\n", "  kind:\n", "46:", "materials[1].active.curve.kind:", "ramp"},
    {"end: 1.6 s", "end: \"1.6 s\\0 and more\"", "56:", "a NUL character", "in \"1.6 s\"; leave it out"},
    // units
    {"450 mmHg", "450", "31:", "materials[0].active.tension:", "no unit"},
    {"10 kPa, s: 5 kPa, n: 4", "10 kpa, s: 5 kPa, n: 4", "24:", "materials[0].axial.f:",
     "did you mean kPa?"},
    {"end: 1.6 s", "end: 1.6 mm", "56:", "time.end:", "not a time"},
    {"1 MPa", "nan kPa", "27:", "materials[0].volume_modulus:", "not a finite"},
    {"1 MPa", "1e400 kPa", "27:", "materials[0].volume_modulus:", "not a finite"},
    {"0 m/s2, -9.81", "0, -9.81", "52:", "gravity[1]:", "no unit"},
    {"unit: 0.1 mm", "unit: 0 mm", "1:", "mesh.unit:", "not above zero"},
    {"unit: 0.1 mm", "unit: kg", "1:", "mesh.unit:", "not a length"},
    {"0.1 deg", "0.1", "15:", "fibers.map.angle_unit:", "an angle such as"},
    {"rest_stretch: 0.8", "rest_stretch: 0.8 mm", "44:", "materials[1].active.rest_stretch:",
     "plain number"},
    {"step: 0.01 ms", "step: automatic", "56:", "time.step:", ", or auto"},
    {"step: 0.01 ms", "step: 0 s", "56:", "time.step:", "\"0 s\": not above zero; give more, or leave it out (auto)"},
    {"step: 0.01 ms", "step: -1 ms", "56:", "time.step:", "\"-1 ms\": not above zero"},
    // numbers out of range
    {"f: 10 kPa", "f: -10 kPa", "24:", "materials[0].axial.f:", "zero or more"},
    {"1050 kg/m3", "0 kg/m3", "23:", "materials[0].density:", "above zero"},
    {"rest_stretch: 0.8", "rest_stretch: 1.2", "44:", "materials[1].active.rest_stretch:",
     "up to 1"},
    {"safety: 0.7", "safety: 1.7", "56:", "time.safety:", "up to 1"},
    {"end: 1.6 s", "end: 0 s", "56:", "time.end:", "above zero"},
    {"frames: 20 ms", "frames: 0 ms", "58:", "output.frames:", "above zero"},
    {"checkpoint: 0.1 s", "checkpoint: -1 s", "63:", "output.checkpoint:", "0 ms"},
    {"duration: 300 ms", "duration: 900 ms", "36:", "materials[0].active.curve.period:",
     "shorter than start + duration (1000 ms)"},
    {"[1.5, 2.5]", "[3.5, 2.5]", "4:", "surfaces[1].range:", "must not be above"},
    {"normal: [0, 0, 1]", "normal: [0, 0, 0]", "9:", "node_sets[1].plane.normal:", "not zero"},
    {"seed: 7", "seed: -7", "19:", "fibers.seed:", "whole number"},
    {"regions: [1, 2]", "regions: [1, 2.5]", "22:", "materials[0].regions:", "whole numbers"},
    {"regions: [1, 2]", "regions: [1, 99999999999]", "22:", "materials[0].regions:", "whole"},
    {"  - name: scar\n", "  - name: scar\n    regions: [2]\n", "38:", "materials[1].regions:",
     "belongs to material myocardium"},
    {"    regions: [1, 2]\n", "", "36:", "materials[1].regions:", "takes the unnamed regions"},
    // words and names
    {"kind: half_sine", "kind: halfsine", "36:", "materials[0].active.curve.kind:",
     "did you mean half_sine?"},
    {"volume: element", "volume: elements", "49:", "volume:", "did you mean element?"},
    {"fill: true", "fill: yes", "13:", "fibers.fill:", "expected one of false, true"},
    {"boundary: true", "boundary: false", "5:", "surfaces[2].boundary:", "leave it out"},
    {"held: [x, z]", "held: [x, w]", "51:", "supports[0].held[1]:", "one of x, y, z"},
    {"[displacement, fiber]", "[displacement, fibre]", "60:", "output.arrays[1]:",
     "did you mean fiber?"},
    {"direction: normal", "direction: norml", "65:", "robin[0].direction:", "mean normal?"},
    {"1e8 Pa/m", "1e8 Pa", "65:", "robin[0].stiffness:", "a stiffness per area"},
    {"boundary, stiffness", "bondary, stiffness", "66:", "robin[1].surface:", "boundary"},
    {"1 cm]", "1 s]", "51:", "supports[0].motion[2]:", "a length"},
    {"set: base", "set: bass", "51:", "supports[0].set:", "the nearest is base"},
    {"robin:\n", "initial_velocity: {unit: 1 m/s}\nrobin:\n", "64:", "initial_velocity.node_array: missing", "node_array: velocity"},
    {"robin:\n", "initial_velocity: {node_array: v, unit: 1 m}\nrobin:\n", "64:", "initial_velocity.unit:", "a velocity"},
    {"{surface: endo,", "{surface: edno,", "54:", "pressures[0].surface:", "the nearest is endo"},
    {"inside, surface: endo", "inside, surface: ento", "10:", "node_sets[2].surface:",
     "the nearest is endo"},
    {"cavities: [endo, skin]", "cavities: [endo, skim]", "62:", "output.cavities[1]:",
     "the nearest is skin"},
    {"name: skin", "name: endo", "5:", "surfaces[2].name:", "names surfaces[0] already"},
    {"name: skin", "name: \"\"", "5:", "surfaces[2].name:", "empty"},
    {"name: skin", "name: \"a\\tb\"", "5:", "surfaces[2].name:", "control"},
    {"name: skin",
     "name: abcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyzabcdefghijklmnopqrstuvwxyz",
     "5:", "surfaces[2].name:", "longer than 63"},
    {"boundary: true", "boundary: true, node_array: x, value: 1", "5:", "surfaces[2].boundary:",
     "node_array is given too"},
    {", boundary: true", "", "5:", "surfaces[2]:", "says not where"},
    {"node_array: endo, value: 1", "node_array: endo", "3:", "surfaces[0]:", "value: 1"},
    {"boundary: true", "boundary: true, value: 1", "5:", "surfaces[2].value:", "leave it out"},
    {"boundary: true", "surface: endo", "5:", "surfaces[2].surface:", "unknown key"},
    {"start: 0.1 s", "rise: 0.1 s", "36:", "materials[0].active.curve.rise:",
     "means nothing for kind: half_sine"},
    {"stiffness: 200 kPa", "stiffness: 200 kPa\n      tension: 3 kPa", "44:",
     "materials[1].active.tension:", "means nothing for kind: spring"},
    // files
    {"lv.vtu", "rv.vtu", "1:", "mesh.file:", "rv.vtu: No such file"},
    {"lv.vtu", "/tmp", "1:", "mesh.file:", "not a file"},
    {"angles.vti", "angle.vti", "14:", "fibers.map.file:", "angle.vti: No such file"},
    {"file: angles.vti, ", "", "14:", "fibers.map.file:", "missing"},
    {"file: curve.csv", "file: curves.csv", "47:", "materials[1].active.curve.file:", "No such"},
    {"        time_unit: 0.1 s\n", "", "45:", "materials[1].active.curve.time_unit:", "missing"},
    {"        file: curve.csv\n", "", "45:", "materials[1].active.curve:", "without file"},
    {"time_unit: 0.1 s", "times: [0 ms, 1 ms]", "45:", "materials[1].active.curve:", "both file"},
    {"file: curve.csv\n        time_unit: 0.1 s", "times: [0 ms, 1 ms]", "45:",
     "materials[1].active.curve:", "without values"},
    {"file: curve.csv\n        time_unit: 0.1 s", "times: [0 ms, 1 ms]\n        values: [1]", "48:",
     "materials[1].active.curve.values:", "as many as of times"},
    {"file: curve.csv\n        time_unit: 0.1 s", "times: [0 ms, 0 ms]\n        values: [1, 2]",
     "47:", "materials[1].active.curve.times[1]:", "must rise"},
    // not YAML
    {"  fill: true", "\tfill: true", "13:", "tab", "spaces"},
    {"  checkpoint: 0.1 s\n", "  checkpoint: \"0.1 s\n", "6", "not valid YAML", "schema"},
    {"time: {end: 1.6 s", "time: [end: 1.6 s", "56:", "not valid YAML", "expected"},
    {"volume: element\n", "volume: *whole\n", "49:", "not valid YAML", "alias"},
    {"volume: element\n", "---\nvolume: element\n", "49:", "second", "one document"},
    {"volume: element\n", "? [1, 2]\n: 3\n", "49:", "key", "expected"},
};
// clang-format on

static void broken_scenes_end_in_one_clear_line(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof breaks / sizeof *breaks; i++) {
    write_changed(breaks[i].old, breaks[i].new);
    assert_refused(NULL, 0, breaks[i].line, breaks[i].key, breaks[i].said);
  }
}

static void files_that_are_no_scenes(void **state)
{
  (void)state;
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_scene_read(scratch("none.yaml"), NULL, 0, &scene, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "none.yaml: No such file"));
  assert_int_equal(vsc_scene_read(scratch_folder, NULL, 0, &scene, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, scratch_folder));
  scratch_text("scene.yaml", "");
  assert_refused(NULL, 0, "1:", "empty scene", "schema");
  scratch_text("scene.yaml", "# nothing\n\n");
  assert_refused(NULL, 0, "1:", "empty scene", "schema");
  scratch_text("scene.yaml", "{}");
  assert_refused(NULL, 0, "1:", "mesh:", "missing");
  scratch_text("scene.yaml", "lv.vtu\n");
  assert_refused(NULL, 0, "1:", "expected a group of keys", "mesh, surfaces");
  scratch_text("scene.yaml", "- 1\n- 2\n");
  assert_refused(NULL, 0, "1:", "a list", "mesh, surfaces");
  scratch_text("scene.yaml", "&a [*a]\n");
  assert_refused(NULL, 0, "1:", "", "expected");
  scratch_bytes("scene.yaml", "mesh:\n  file: \0\1\2\377\376", 20);
  assert_refused(NULL, 0, "2:", "not a text file", "YAML scene");
  scratch_bytes("scene.yaml", "\377\376\0", 3);
  assert_refused(NULL, 0, "1:", "not a text file", "YAML scene");
  char *large = calloc(1, 9 << 20);
  assert_non_null(large);
  memset(large, 'a', 9 << 20);
  scratch_bytes("scene.yaml", large, 9 << 20);
  assert_refused(NULL, 0, " ", "more than 8 MB", "expected");
  memset(large, '[', 1 << 16);
  scratch_bytes("scene.yaml", large, 1 << 16);
  assert_refused(NULL, 0, "1:", "33 deep", "expected");
  free(large);
}

// Every prefix of a good scene is a scene or is refused in one line, without a leak or a crash.
static void truncated_scenes(void **state)
{
  (void)state;
  for (size_t size = 0; size < sizeof full - 1; size++) {
    vsc_scene *scene = NULL;
    vsc_error error = {.text = ""};
    scratch_bytes("scene.yaml", full, size);
    const vsc_status status = vsc_scene_read(scene_file, NULL, 0, &scene, &error);
    if (status == VSC_OK) {
      vsc_scene_free(scene);
      continue;
    }
    assert_int_equal(status, VSC_INPUT);
    assert_int_equal(strncmp(error.text, scene_file, strlen(scene_file)), 0);
  }
}

static void wrong_settings(void **state)
{
  (void)state;
  const struct {
    const char *text, *key, *said;
  } cases[] = {
      {"time.ende=0.4 s", "time.ende:", "did you mean end?"},
      {"tiem.end=0.4 s", "tiem:", "did you mean time?"},
      {"time.end=0.4", "time.end:", "no unit"},
      {"time.end=", "time.end:", "no number"},
      {"time.end=-1 s", "time.end:", "above zero"},
      {"time.end.s=4", "time.end.s:", "no keys below"},
      {"time.end", "time.end", "expected key=value"},
      {"=4", "=4", "expected key=value"},
      {"materials.density=1 g/cm3", "materials:", "materials[0].density"},
      {"materials[7].density=1 g/cm3", "materials:", "it has 2"},
      {"materials[x].density=1 g/cm3", "materials:", "a number in brackets"},
      {"materials[0].axail.f=1 kPa", "materials[0].axail:", "did you mean axial?"},
      {"materials[0].axial=3 kPa", "materials[0].axial:", "known here: f, s, n"},
      {"materials[0].axial={f: 3 kPa, t: 1 kPa}", "materials[0].axial.t:", "known here: f, s, n"},
      {"materials[0]=3", "materials[0]:", "one by one"},
      {"time[0].end=3 s", "time:", "leave out [0]"},
      {"gravity[2]=3", "gravity[2]:", "no unit"},
      {"output.cavities[0]=[endo", "output.cavities[0]:", "value"},
      {"output.cavities=endo", "output.cavities:", "a list such as"},
      {"supports[0].held=[w]", "supports[0].held[0]:", "one of x, y, z"},
      {"mesh.file=gone.vtu", "mesh.file:", "No such file"},
      {"supports[0].set=bsae", "supports[0].set:", "the nearest is base"},
  };
  scratch_text("scene.yaml", full);
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    char place[200];
    const char *settings[] = {"time.safety=0.5", cases[i].text};
    snprintf(place, sizeof place, " --set %s:", cases[i].text);
    assert_refused(settings, 2, place, cases[i].key, cases[i].said);
  }
}

static void broken_curve_files(void **state)
{
  (void)state;
  const struct {
    const char *text, *said;
  } cases[] = {
      {"", "0 points"},
      {"time,value\n0,1\n", "1 points; expected"},
      {"time,value\n0,0\n1,1\n1,2\n", "line 4: time 1 does not rise"},
      {"time,value\n0,0\n5,1\n2,2\n", "line 4: time 2 does not rise"},
      {"time,value\n0,0\nten,1\n", "line 3: \"ten,1"},
      {"time,value\n0,0\n1,nan\n", "line 3"},
      {"time,value\n0,0\ninf,1\n", "line 3"},
      {"time,value\n0,0\n1\n", "line 3"},
      {"time,value\n0,0\n1,2,3\n", "two numbers"},
      {"\377\376\1\n\2\3\n", "line 2"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    scratch_text("bad.csv", cases[i].text);
    write_changed("file: curve.csv", "file: bad.csv");
    assert_refused(NULL, 0, "47:", "materials[1].active.curve.file:", cases[i].said);
  }
  char line[600];
  memset(line, '1', sizeof line);
  scratch_bytes("bad.csv", line, sizeof line);
  assert_refused(NULL, 0, "47:", "bad.csv", "too long");
}

static void memory_may_run_out(void **state)
{
  (void)state;
  const char *const settings[] = {"time.end=1 s"};
  scratch_text("scene.yaml", full);
  vsc_status status = VSC_SYSTEM;
  long count = 0;
  for (; status == VSC_SYSTEM; count++) {
    vsc_scene *scene = NULL;
    vsc_error error = {.text = ""};
    vsc_alloc_fail_after(count);
    status = vsc_scene_read(scene_file, settings, 1, &scene, &error);
    if (status == VSC_SYSTEM) assert_non_null(strstr(error.text, "out of memory"));
    vsc_scene_free(scene);
  }
  vsc_alloc_fail_after(-1);
  assert_int_equal(status, VSC_OK);
  assert_true(count > 10);
}

static void names_of_files_have_an_end(void **state)
{
  (void)state;
  char name[600];
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  memset(name, 'a', sizeof name);
  name[sizeof name - 1] = '\0';
  assert_int_equal(vsc_scene_read(name, NULL, 0, &scene, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "shorten it"));
  name[500] = '\0';
  write_changed("lv.vtu", name);
  assert_refused(NULL, 0, "1:", "mesh.file:", "shorten it");
}

static void wrong_walls_of_a_helix(void **state)
{
  (void)state;
  const char *const good[] = {"fibers.source=helix"};
  const char *const wrong[][2] = {{"fibers.source=helix", "fibers.helix.epi=epy"},
                                  {"fibers.source=helix", "fibers.helix.endo_angle=100 deg"},
                                  {"fibers.source=helix", "fibers.helix.long_axis=[0, 0, 0]"}};
  scratch_text("scene.yaml", full);
  vsc_scene_free(read_good("scene.yaml", good, 1));
  assert_refused(wrong[0], 2, " --set", "fibers.helix.epi:", "the nearest is epi");
  assert_refused(wrong[1], 2, " --set", "fibers.helix.endo_angle:", "90 deg");
  assert_refused(wrong[2], 2, " --set", "fibers.helix.long_axis:", "apex to base");
  const char *const constant[] = {"fibers.source=constant"};
  assert_refused(constant, 1, "11:", "fibers.constant.fiber:", "[1, 0, 0]");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(broken_scenes_end_in_one_clear_line),
      cmocka_unit_test(files_that_are_no_scenes),
      cmocka_unit_test(truncated_scenes),
      cmocka_unit_test(wrong_settings),
      cmocka_unit_test(broken_curve_files),
      cmocka_unit_test(memory_may_run_out),
      cmocka_unit_test(names_of_files_have_an_end),
      cmocka_unit_test(wrong_walls_of_a_helix),
  };
  return cmocka_run_group_tests(tests, make_files, scratch_close);
}
