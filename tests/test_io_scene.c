// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scene.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/mem.h"
#include "close.h"

static char folder[] = "/tmp/viscera-scene-XXXXXX";
static char scene_file[64];

static const char *path_of(const char *name)
{
  static char path[512];
  snprintf(path, sizeof path, "%s/%s", folder, name);
  return path;
}

static void write_bytes(const char *name, const char *text, size_t size)
{
  FILE *stream = fopen(path_of(name), "wb");
  assert_non_null(stream);
  assert_int_equal(fwrite(text, 1, size, stream), size);
  assert_int_equal(fclose(stream), 0);
}

static void write_file(const char *name, const char *text)
{
  write_bytes(name, text, strlen(text));
}

static char *slurp(const char *name)
{
  FILE *stream = fopen(path_of(name), "rb");
  assert_non_null(stream);
  char *text = calloc(1, 1 << 16);
  assert_non_null(text);
  assert_true(fread(text, 1, (1 << 16) - 1, stream) > 0);
  fclose(stream);
  return text;
}

static int make_folder(void **state)
{
  (void)state;
  if (mkdtemp(folder) == NULL) return -1;
  snprintf(scene_file, sizeof scene_file, "%s/scene.yaml", folder);
  write_file("lv.vtu", "mesh");
  write_file("angles.vti", "map");
  write_file("curve.csv", "# rest, peak, rest\ntime,value\n0,0\r\n 100 , 1\n\n200;0.25\n300 0\n");
  return 0;
}

static int remove_folder(void **state)
{
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -r %s", folder);
  return system(command);
}

// Lines are counted in the broken scenes below.
static const char full[] =
    "mesh: {file: lv.vtu, unit: 0.1 mm, region_array: region}\n"                        // 1
    "surfaces:\n"                                                                       // 2
    "  - {name: endo, node_array: endo, value: 1}\n"                                    // 3
    "  - {name: epi, triangle_array: surface, range: [1.5, 2.5]}\n"                     // 4
    "  - {name: skin, boundary: true}\n"                                                // 5
    "node_sets:\n"                                                                      // 6
    "  - {name: base, box: {low: [0 mm, 0 mm, 0 mm], high: [1 cm, 2 cm, 3 cm]}}\n"      // 7
    "  - name: top\n"                                                                   // 8
    "    plane: {point: [0 mm, 0 mm, 9 mm], normal: [0, 0, 1], tolerance: 0.1 mm}\n"    // 9
    "  - {name: inside, surface: endo}\n"                                               // 10
    "fibers:\n"                                                                         // 11
    "  source: map\n"                                                                   // 12
    "  fill: true\n"                                                                    // 13
    "  map: {file: angles.vti, length_unit: cm, azimuth: az_x10, elevation: el_x10,\n"  // 14
    "        angle_unit: 0.1 deg, azimuth_zero: 90 deg, azimuth_sense: clockwise,\n"    // 15
    "        elevation_sense: down, axes: world, mask: tissue, weight: coherence}\n"    // 16
    "  helix: {endo: endo, epi: epi, endo_angle: 70 deg, epi_angle: -50 deg}\n"         // 17
    "  pitch: 20 deg\n"                                                                 // 18
    "  seed: 7\n"                                                                       // 19
    "materials:\n"                                                                      // 20
    "  - name: myocardium\n"                                                            // 21
    "    regions: [1, 2]\n"                                                             // 22
    "    density: 1050 kg/m3\n"                                                         // 23
    "    axial:   {f: 10 kPa, s: 5 kPa, n: 4 kPa}\n"                                    // 24
    "    angular: {fs: 3 kPa, sn: 2 kPa, nf: 1 kPa}\n"                                  // 25
    "    damping: {f: 10 Pa s, s: 20 Pa s, n: 30 Pa s}\n"                               // 26
    "    volume_modulus: 1 MPa\n"                                                       // 27
    "    stabilization: 10 kPa\n"                                                       // 28
    "    active:\n"                                                                     // 29
    "      kind: tension\n"                                                             // 30
    "      tension: 450 mmHg\n"                                                         // 31
    "      delay: 5 ms\n"                                                               // 32
    "      amplitude_array: amp\n"                                                      // 33
    "      delay_array: lat\n"                                                          // 34
    "      delay_unit: 1 s\n"                                                           // 35
    "      curve: {kind: half_sine, start: 0.1 s, duration: 300 ms, period: 800 ms}\n"  // 36
    "  - name: scar\n"                                                                  // 37
    "    axial:   {f: 40 kPa, s: 40 kPa, n: 40 kPa}\n"                                  // 38
    "    angular: {fs: 9 kPa, sn: 9 kPa, nf: 9 kPa}\n"                                  // 39
    "    volume_modulus: 2 MPa\n"                                                       // 40
    "    active:\n"                                                                     // 41
    "      kind: spring\n"                                                              // 42
    "      stiffness: 200 kPa\n"                                                        // 43
    "      rest_stretch: 0.8\n"                                                         // 44
    "      curve:\n"                                                                    // 45
    "        kind: table\n"                                                             // 46
    "        file: curve.csv\n"                                                         // 47
    "        time_unit: ms\n"                                                           // 48
    "volume: element\n"                                                                 // 49
    "supports:\n"                                                                       // 50
    "  - {set: base, held: [x, z]}\n"                                                   // 51
    "gravity: [0 m/s2, 0 m/s2, -9.81 m/s2]\n"                                           // 52
    "pressures:\n"                                                                      // 53
    "  - {surface: endo, peak: 120 mmHg, curve: {kind: tanh_pair, start: 50 ms}}\n"     // 54
    "  - {surface: boundary, peak: 1 kPa}\n"                                            // 55
    "time: {end: 1.6 s, step: 0.01 ms, safety: 0.7}\n"                                  // 56
    "output:\n"                                                                         // 57
    "  frames: 20 ms\n"                                                                 // 58
    "  precision: double\n"                                                             // 59
    "  arrays: [displacement, fiber]\n"                                                 // 60
    "  signals: 2 ms\n"                                                                 // 61
    "  cavities: [endo, skin]\n"                                                        // 62
    "  checkpoint: 0.1 s\n";                                                            // 63

static const char minimal[] =
    "mesh: {file: lv.vtu, unit: mm}\n"
    "materials:\n"
    "  - name: tissue\n"
    "    axial: {f: 10 kPa, s: 5 kPa, n: 5 kPa}\n"
    "    angular: {fs: 3 kPa, sn: 3 kPa, nf: 3 kPa}\n"
    "    volume_modulus: 1 MPa\n"
    "time: {end: 10 ms}\n";

static vsc_scene *read_good(const char *name, const char *const *settings, size_t count)
{
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  if (vsc_scene_read(path_of(name), settings, count, &scene, &error) != VSC_OK)
    fail_msg("%s", error.text);
  return scene;
}

static void check_places_and_fibers(const vsc_scene *scene)
{
  const vsc_definition *d = &scene->definition;
  assert_string_equal(scene->mesh_file, path_of("lv.vtu"));
  assert_close(scene->mesh_unit, 0.1, 1e-15, 0);
  assert_string_equal(d->region_array, "region");
  assert_int_equal(d->surface_count, 3);
  assert_int_equal(d->surfaces[0].kind, VSC_SELECT_NODE_ARRAY);
  assert_true(d->surfaces[0].low == 1 && d->surfaces[0].high == 1);
  assert_int_equal(d->surfaces[1].kind, VSC_SELECT_TRIANGLE_ARRAY);
  assert_string_equal(d->surfaces[1].array, "surface");
  assert_true(d->surfaces[1].low == 1.5 && d->surfaces[1].high == 2.5);
  assert_int_equal(d->surfaces[2].kind, VSC_SELECT_BOUNDARY);
  assert_int_equal(d->set_count, 3);
  assert_int_equal(d->sets[0].kind, VSC_SELECT_BOX);
  assert_close(d->sets[0].box_high[2], 30, 1e-14, 0);
  assert_int_equal(d->sets[1].kind, VSC_SELECT_PLANE);
  assert_close(d->sets[1].point[2], 9, 1e-14, 0);
  assert_close(d->sets[1].tolerance, 0.1, 1e-14, 0);
  assert_int_equal(d->sets[2].kind, VSC_SELECT_SURFACE);
  assert_string_equal(d->sets[2].array, "endo");
  const vsc_angle_map_def *map = &scene->fibers.map;
  assert_int_equal(scene->fibers.source, VSC_FIBER_MAP);
  assert_true(scene->fibers.fill);
  assert_string_equal(map->file, path_of("angles.vti"));
  assert_close(map->length_unit, 10, 1e-14, 0);
  assert_string_equal(map->azimuth, "az_x10");
  assert_string_equal(map->elevation, "el_x10");
  assert_close(map->scale, M_PI / 1800, 1e-14, 0);
  assert_close(map->azimuth_zero, M_PI / 2, 1e-14, 0);
  assert_int_equal(map->azimuth_sense, -1);
  assert_int_equal(map->elevation_sense, -1);
  assert_false(map->image_axes);
  assert_string_equal(map->mask, "tissue");
  assert_string_equal(map->weight, "coherence");
  assert_close(scene->fibers.endo_angle, 70 * M_PI / 180, 1e-14, 0);
  assert_close(scene->fibers.epi_angle, -50 * M_PI / 180, 1e-14, 0);
  assert_close(scene->fibers.pitch, M_PI / 9, 1e-14, 0);
  assert_int_equal(scene->fibers.seed, 7);
}

static void check_materials_and_loads(const vsc_scene *scene)
{
  const vsc_definition *d = &scene->definition;
  const vsc_material_def *m = d->materials;
  const double axial[] = {10, 5, 4}, angular[] = {3, 2, 1}, damping[] = {10, 20, 30};
  assert_int_equal(d->material_count, 2);
  assert_int_equal(m->region_count, 2);
  assert_int_equal(m->regions[1], 2);
  assert_close(m->density, 1.05, 1e-14, 0);
  for (int a = 0; a < 3; a++) {
    assert_close(m->axial[a], axial[a], 1e-14, 0);
    assert_close(m->angular[a], angular[a], 1e-14, 0);
    assert_close(m->damping[a], damping[a], 1e-14, 0);
  }
  assert_close(m->volume_modulus, 1000, 1e-14, 0);
  assert_close(m->stabilization, 10, 1e-14, 0);
  assert_int_equal(m->active.kind, VSC_ACTIVE_TENSION);
  assert_close(m->active.tension, 450 * 0.133322387415, 1e-12, 0);
  assert_close(m->active.delay, 5, 1e-14, 0);
  assert_string_equal(m->active.amplitude_array, "amp");
  assert_string_equal(m->active.delay_array, "lat");
  assert_close(m->active.delay_unit, 1000, 1e-14, 0);
  assert_int_equal(m->active.curve.kind, VSC_CURVE_HALF_SINE);
  assert_close(m->active.curve.start, 100, 1e-14, 0);
  assert_close(m->active.curve.duration, 300, 1e-14, 0);
  assert_close(m->active.curve.period, 800, 1e-14, 0);
  assert_int_equal(m[1].region_count, 0);
  assert_close(m[1].density, 1.06, 1e-14, 0);
  assert_int_equal(m[1].active.kind, VSC_ACTIVE_SPRING);
  assert_close(m[1].active.stiffness, 200, 1e-14, 0);
  assert_close(m[1].active.rest_stretch, 0.8, 1e-14, 0);
  assert_int_equal(m[1].active.curve.point_count, 4);
  assert_close(m[1].active.curve.times[2], 200, 1e-14, 0);
  assert_close(m[1].active.curve.values[2], 0.25, 1e-14, 0);
}

static void check_the_rest(const vsc_scene *scene)
{
  const vsc_definition *d = &scene->definition;
  assert_int_equal(d->volume, VSC_VOLUME_ELEMENT);
  assert_int_equal(d->supports[0].held[0], 1);
  assert_int_equal(d->supports[0].held[1], 0);
  assert_int_equal(d->supports[0].held[2], 1);
  assert_close(d->gravity[2], -0.00981, 1e-14, 0);
  assert_int_equal(d->pressure_count, 2);
  assert_close(d->pressures[0].peak, 120 * 0.133322387415, 1e-12, 0);
  assert_int_equal(d->pressures[0].curve.kind, VSC_CURVE_TANH_PAIR);
  assert_close(d->pressures[0].curve.rise, 20, 1e-14, 0);
  assert_int_equal(d->pressures[1].curve.kind, VSC_CURVE_CONSTANT);
  assert_close(d->end_time, 1600, 1e-14, 0);
  assert_close(d->step, 0.01, 1e-14, 0);
  assert_close(d->safety, 0.7, 1e-14, 0);
  assert_close(scene->output.frame_interval, 20, 1e-14, 0);
  assert_true(scene->output.double_precision);
  assert_int_equal(scene->output.array_count, 2);
  assert_string_equal(scene->output.arrays[1], "fiber");
  assert_close(scene->output.signal_interval, 2, 1e-14, 0);
  assert_int_equal(scene->output.cavity_count, 2);
  assert_string_equal(scene->output.cavities[1], "skin");
  assert_close(scene->output.checkpoint_interval, 100, 1e-14, 0);
}

static void every_key_arrives(void **state)
{
  (void)state;
  write_file("scene.yaml", full);
  vsc_scene *scene = read_good("scene.yaml", NULL, 0);
  check_places_and_fibers(scene);
  check_materials_and_loads(scene);
  check_the_rest(scene);
  vsc_scene_free(scene);
}

static void a_written_scene_reads_back(void **state)
{
  (void)state;
  vsc_error error = {.text = ""};
  write_file("scene.yaml", full);
  vsc_scene *scene = read_good("scene.yaml", NULL, 0);
  assert_int_equal(vsc_scene_write(scene, path_of("resolved.yaml"), &error), VSC_OK);
  vsc_scene *again = read_good("resolved.yaml", NULL, 0);
  check_places_and_fibers(again);
  check_materials_and_loads(again);
  check_the_rest(again);
  vsc_scene_free(scene);
  vsc_scene_free(again);
}

static void absent_keys_take_the_defaults(void **state)
{
  (void)state;
  write_file("scene.yaml", minimal);
  vsc_scene *scene = read_good("scene.yaml", NULL, 0);
  const vsc_fiber_def fiber = vsc_default_fiber();
  assert_int_equal(scene->fibers.source, fiber.source);
  assert_true(scene->fibers.endo_angle == fiber.endo_angle);
  assert_string_equal(scene->fibers.map.azimuth, "azimuth");
  assert_true(scene->fibers.map.scale == M_PI / 180);
  assert_close(scene->definition.materials[0].density, 1.06, 1e-15, 0);
  assert_int_equal(scene->definition.materials[0].active.kind, VSC_ACTIVE_NONE);
  assert_int_equal(scene->definition.volume, VSC_VOLUME_NODAL);
  assert_true(scene->definition.step == 0);
  assert_true(scene->definition.safety == 0.8);
  assert_true(scene->output.frame_interval == 10);
  assert_true(scene->output.signal_interval == 1);
  assert_true(scene->output.checkpoint_interval == 0);
  assert_int_equal(scene->output.array_count, 0);
  assert_false(scene->output.double_precision);
  vsc_scene_free(scene);
}

static void written_numbers_keep_every_bit(void **state)
{
  (void)state;
  const char *const odd[] = {"time.end=0.1 us",       "materials[0].axial.f=0.1 MPa",
                             "fibers.pitch=0.3 rad",  "materials[0].name=\"a \\\"b\\\": #c\\\\d\"",
                             "gravity=[1e-7 m/s2, -3.3333333333333333e20 m/s2, 5e-324 mm/ms2]"};
  const char *const texts[] = {full, minimal};
  for (size_t i = 0; i < 2; i++) {
    vsc_error error = {.text = ""};
    write_file("scene.yaml", texts[i]);
    vsc_scene *scene = read_good("scene.yaml", odd, sizeof odd / sizeof *odd);
    assert_int_equal(vsc_scene_write(scene, path_of("resolved.yaml"), &error), VSC_OK);
    vsc_scene *again = read_good("resolved.yaml", NULL, 0);
    const vsc_definition *d = &scene->definition, *e = &again->definition;
    assert_true(d->end_time == e->end_time);
    assert_true(d->materials[0].axial[0] == e->materials[0].axial[0]);
    assert_true(scene->fibers.pitch == again->fibers.pitch);
    for (int k = 0; k < 3; k++) assert_true(d->gravity[k] == e->gravity[k]);
    assert_string_equal(e->materials[0].name, "a \"b\": #c\\d");
    assert_string_equal(again->mesh_file, path_of("lv.vtu"));
    assert_int_equal(vsc_scene_write(again, path_of("again.yaml"), &error), VSC_OK);
    char *first = slurp("resolved.yaml"), *second = slurp("again.yaml");
    assert_string_equal(first, second);
    assert_true(access(path_of("again.yaml.part"), F_OK) != 0);
    free(first);
    free(second);
    vsc_scene_free(scene);
    vsc_scene_free(again);
  }
}

static void an_unwritable_place_is_said(void **state)
{
  (void)state;
  vsc_error error = {.text = ""};
  write_file("scene.yaml", minimal);
  vsc_scene *scene = read_good("scene.yaml", NULL, 0);
  assert_int_equal(vsc_scene_write(scene, path_of("nowhere/x.yaml"), &error), VSC_SYSTEM);
  assert_non_null(strstr(error.text, "nowhere/x.yaml"));
  vsc_scene_free(scene);
}

static void the_template_is_a_scene(void **state)
{
  (void)state;
  FILE *stream = fopen(path_of("schema.yaml"), "w");
  assert_non_null(stream);
  vsc_scene_schema(stream);
  fclose(stream);
  write_file("mesh.vtu", "mesh");
  vsc_scene *scene = read_good("schema.yaml", NULL, 0);
  assert_int_equal(scene->definition.material_count, 1);
  assert_int_equal(scene->definition.materials[0].active.kind, VSC_ACTIVE_TENSION);
  assert_int_equal(scene->fibers.source, VSC_FIBER_CONSTANT);
  vsc_scene_free(scene);
}

static void settings_replace_and_add(void **state)
{
  (void)state;
  const char *const settings[] = {"time.end=0.4 s",
                                  "materials[0].axial.f=12 kPa",
                                  "surfaces[0].name=endo",
                                  "surfaces[0].node_array=mark",
                                  "surfaces[0].value=3",
                                  "output.cavities[0]=endo",
                                  "output.arrays=[velocity, region]",
                                  "output.arrays[1]=normal",
                                  "node_sets=[{name: base, surface: endo}]",
                                  "supports=[{set: base, held: [x, y, z]}]",
                                  "fibers.source=constant",
                                  "fibers.constant.fiber=[0, 1, 0]",
                                  "fibers.arrays.sheet=",
                                  "materials[0].damping={f: 3 Pa s, n: 4 Pa s}",
                                  "time.end=0.5 s"};
  write_file("scene.yaml", minimal);
  vsc_scene *scene = read_good("scene.yaml", settings, sizeof settings / sizeof *settings);
  const vsc_definition *d = &scene->definition;
  assert_close(d->end_time, 500, 1e-14, 0);
  assert_close(d->materials[0].axial[0], 12, 1e-14, 0);
  assert_close(d->materials[0].axial[1], 5, 1e-14, 0);
  assert_close(d->materials[0].damping[2], 4, 1e-14, 0);
  assert_string_equal(d->surfaces[0].array, "mark");
  assert_true(d->surfaces[0].high == 3);
  assert_string_equal(scene->output.cavities[0], "endo");
  assert_string_equal(scene->output.arrays[0], "velocity");
  assert_string_equal(scene->output.arrays[1], "normal");
  assert_int_equal(d->supports[0].held[1], 1);
  assert_string_equal(scene->fibers.sheet_array, "");
  assert_true(scene->fibers.direction[1] == 1);
  vsc_scene_free(scene);
}

static void assert_refused(const char *const *settings, size_t count, const char *place,
                           const char *key, const char *said)
{
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  const vsc_status status = vsc_scene_read(scene_file, settings, count, &scene, &error);
  if (status == VSC_OK) fail_msg("accepted, instead of \"%s\" for %s", said, key);
  if (getenv("VSC_SHOW") != NULL) print_message("%s\n", error.text);
  assert_int_equal(status, VSC_INPUT);
  assert_int_equal(error.status, VSC_INPUT);
  assert_null(scene);
  char start[128];
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
  write_file("scene.yaml", text);
}

static void broken_scenes_end_in_one_clear_line(void **state)
{
  (void)state;
  const struct {
    const char *old, *new;  // in `full`
    const char *line, *key, *said;
  } cases[] = {
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
      {"  seed: 7\n", "  fill: true\n", "13:", "fibers.fill:", "given twice"},
      {"step: 0.01 ms", "end: 1 s", "56:", "time.end:", "given twice"},
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
      {"  - {set: base, held: [x, z]}\n", "  {set: base, held: [x, z]}\n", "50:", "supports:",
       "dashes"},
      {"regions: [1, 2]", "regions: [1, [2]]", "22:", "materials[0].regions[1]:", "single"},
      {"-9.81 m/s2]", "]", "52:", "gravity:", "2 values; expected 3"},
      {"normal: [0, 0, 1]", "normal: []", "9:", "node_sets[1].plane.normal:", "[0, 0, 1]"},
      {"range: [1.5, 2.5]", "range: [1.5]", "4:", "surfaces[1].range:", "expected 2"},
      {"  kind: table\n", "  kind:\n", "46:", "materials[1].active.curve.kind:", "ramp"},
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
       "shorter than the duration"},
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
      {"set: base", "set: bass", "51:", "supports[0].set:", "the nearest is base"},
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
      {"        time_unit: ms\n", "", "45:", "materials[1].active.curve.time_unit:", "missing"},
      {"        file: curve.csv\n", "", "45:", "materials[1].active.curve:", "without file"},
      {"time_unit: ms", "times: [0 ms, 1 ms]", "45:", "materials[1].active.curve:", "both file"},
      {"file: curve.csv\n        time_unit: ms", "times: [0 ms, 1 ms]", "45:",
       "materials[1].active.curve:", "without values"},
      {"file: curve.csv\n        time_unit: ms", "times: [0 ms, 1 ms]\n        values: [1]", "48:",
       "materials[1].active.curve.values:", "as many as of times"},
      {"file: curve.csv\n        time_unit: ms", "times: [0 ms, 0 ms]\n        values: [1, 2]",
       "47:", "materials[1].active.curve.times[1]:", "must rise"},
      // not YAML
      {"  fill: true", "\tfill: true", "13:", "tab", "spaces"},
      {"  checkpoint: 0.1 s\n", "  checkpoint: \"0.1 s\n", "6", "not valid YAML", "schema"},
      {"time: {end: 1.6 s", "time: [end: 1.6 s", "56:", "not valid YAML", "expected"},
      {"volume: element\n", "volume: *whole\n", "49:", "not valid YAML", "alias"},
      {"volume: element\n", "---\nvolume: element\n", "49:", "second", "one document"},
      {"volume: element\n", "? [1, 2]\n: 3\n", "49:", "key", "expected"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    write_changed(cases[i].old, cases[i].new);
    assert_refused(NULL, 0, cases[i].line, cases[i].key, cases[i].said);
  }
}

static void files_that_are_no_scenes(void **state)
{
  (void)state;
  vsc_scene *scene = NULL;
  vsc_error error = {.text = ""};
  assert_int_equal(vsc_scene_read(path_of("none.yaml"), NULL, 0, &scene, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, "none.yaml: No such file"));
  assert_int_equal(vsc_scene_read(folder, NULL, 0, &scene, &error), VSC_INPUT);
  assert_non_null(strstr(error.text, folder));
  write_file("scene.yaml", "");
  assert_refused(NULL, 0, "1:", "empty scene", "schema");
  write_file("scene.yaml", "# nothing\n\n");
  assert_refused(NULL, 0, "1:", "empty scene", "schema");
  write_file("scene.yaml", "{}");
  assert_refused(NULL, 0, "1:", "mesh:", "missing");
  write_file("scene.yaml", "lv.vtu\n");
  assert_refused(NULL, 0, "1:", "expected a group of keys", "mesh, surfaces");
  write_file("scene.yaml", "- 1\n- 2\n");
  assert_refused(NULL, 0, "1:", "a list", "mesh, surfaces");
  write_file("scene.yaml", "&a [*a]\n");
  assert_refused(NULL, 0, "1:", "", "expected");
  write_bytes("scene.yaml", "mesh:\n  file: \0\1\2\377\376", 20);
  assert_refused(NULL, 0, "2:", "not a text file", "YAML scene");
  write_bytes("scene.yaml", "\377\376\0", 3);
  assert_refused(NULL, 0, "1:", "not a text file", "YAML scene");
  char *large = calloc(1, 9 << 20);
  assert_non_null(large);
  memset(large, 'a', 9 << 20);
  write_bytes("scene.yaml", large, 9 << 20);
  assert_refused(NULL, 0, " ", "more than 8 MB", "expected");
  memset(large, '[', 1 << 16);
  write_bytes("scene.yaml", large, 1 << 16);
  assert_refused(NULL, 0, "", "", "expected");
  free(large);
}

// Every prefix of a good scene is a scene or is refused in one line, without a leak or a crash.
static void truncated_scenes(void **state)
{
  (void)state;
  for (size_t size = 0; size < sizeof full - 1; size++) {
    vsc_scene *scene = NULL;
    vsc_error error = {.text = ""};
    write_bytes("scene.yaml", full, size);
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
  write_file("scene.yaml", full);
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
    write_file("bad.csv", cases[i].text);
    write_changed("file: curve.csv", "file: bad.csv");
    assert_refused(NULL, 0, "47:", "materials[1].active.curve.file:", cases[i].said);
  }
  char line[600];
  memset(line, '1', sizeof line);
  write_bytes("bad.csv", line, sizeof line);
  assert_refused(NULL, 0, "47:", "bad.csv", "too long");
}

static void memory_may_run_out(void **state)
{
  (void)state;
  const char *const settings[] = {"time.end=1 s"};
  write_file("scene.yaml", full);
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
  write_file("scene.yaml", full);
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
      cmocka_unit_test(every_key_arrives),
      cmocka_unit_test(absent_keys_take_the_defaults),
      cmocka_unit_test(a_written_scene_reads_back),
      cmocka_unit_test(written_numbers_keep_every_bit),
      cmocka_unit_test(an_unwritable_place_is_said),
      cmocka_unit_test(the_template_is_a_scene),
      cmocka_unit_test(settings_replace_and_add),
      cmocka_unit_test(broken_scenes_end_in_one_clear_line),
      cmocka_unit_test(files_that_are_no_scenes),
      cmocka_unit_test(truncated_scenes),
      cmocka_unit_test(wrong_settings),
      cmocka_unit_test(broken_curve_files),
      cmocka_unit_test(memory_may_run_out),
      cmocka_unit_test(names_of_files_have_an_end),
      cmocka_unit_test(wrong_walls_of_a_helix),
  };
  return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
