// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/scene.h"

#include <unistd.h>

#include "scene_files.h"

static void check_places_and_fibers(const vsc_scene *scene)
{
  const vsc_definition *d = &scene->definition;
  assert_string_equal(scene->mesh_file, scratch("lv.vtu"));
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
  assert_string_equal(map->file, scratch("angles.vti"));
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
  assert_true(d->supports[0].motion[0] == 0 && d->supports[0].motion[2] == 10);
  assert_int_equal(d->supports[0].curve.kind, VSC_CURVE_RAMP);
  assert_int_equal(d->robin_count, 2);
  assert_string_equal(d->robins[0].surface, "endo");
  assert_close(d->robins[0].stiffness, 100, 1e-14, 0);
  assert_close(d->robins[0].damping, 5, 1e-14, 0);
  assert_true(d->robins[0].normal && !d->robins[1].normal);
  assert_true(d->robins[1].stiffness == 2 && d->robins[1].damping == 0);
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
  scratch_text("scene.yaml", full);
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
  scratch_text("scene.yaml", full);
  vsc_scene *scene = read_good("scene.yaml", NULL, 0);
  assert_int_equal(vsc_scene_write(scene, scratch("resolved.yaml"), &error), VSC_OK);
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
  scratch_text("scene.yaml", minimal);
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
  const char *const odd[] = {"time.end=0.1 us", "materials[0].axial.f=0.30000000000000004 kPa",
                             "fibers.pitch=0.3 rad", "mesh.region_array=\"a \\\"b\\\": #c\\\\d\"",
                             "gravity=[1e-7 m/s2, -3.3333333333333333e20 m/s2, 5e-324 mm/ms2]"};
  const char *const texts[] = {full, minimal};
  for (size_t i = 0; i < 2; i++) {
    vsc_error error = {.text = ""};
    scratch_text("scene.yaml", texts[i]);
    vsc_scene *scene = read_good("scene.yaml", odd, sizeof odd / sizeof *odd);
    assert_int_equal(vsc_scene_write(scene, scratch("resolved.yaml"), &error), VSC_OK);
    vsc_scene *again = read_good("resolved.yaml", NULL, 0);
    const vsc_definition *d = &scene->definition, *e = &again->definition;
    assert_true(d->end_time == e->end_time);
    assert_true(d->materials[0].axial[0] == e->materials[0].axial[0]);
    assert_true(scene->fibers.pitch == again->fibers.pitch);
    for (int k = 0; k < 3; k++) assert_true(d->gravity[k] == e->gravity[k]);
    assert_string_equal(e->region_array, "a \"b\": #c\\d");
    assert_string_equal(again->mesh_file, scratch("lv.vtu"));
    assert_int_equal(vsc_scene_write(again, scratch("again.yaml"), &error), VSC_OK);
    char *first = scratch_load(scratch("resolved.yaml"), NULL);
    char *second = scratch_load(scratch("again.yaml"), NULL);
    assert_string_equal(first, second);
    assert_true(access(scratch("again.yaml.tmp"), F_OK) != 0);
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
  scratch_text("scene.yaml", minimal);
  vsc_scene *scene = read_good("scene.yaml", NULL, 0);
  assert_int_equal(vsc_scene_write(scene, scratch("nowhere/x.yaml"), &error), VSC_SYSTEM);
  assert_non_null(strstr(error.text, "nowhere/x.yaml"));
  vsc_scene_free(scene);
}

static void the_template_is_a_scene(void **state)
{
  (void)state;
  FILE *stream = fopen(scratch("schema.yaml"), "w");
  assert_non_null(stream);
  vsc_scene_schema(stream);
  fclose(stream);
  scratch_text("mesh.vtu", "mesh");
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
  scratch_text("scene.yaml", minimal);
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

// Points come with every bit and go; a reach of 0 is written as the word that stands for it.
static void points_are_read_and_written(void **state)
{
  (void)state;
  vsc_error error = {.text = ""};
  const char *const settings[] = {
      "output.points=[{name: p0, at: [25 mm, 3 cm, -0.1 mm]}]", "output.points[1].name=p1",
      "output.points[1].at=[0 mm, 1 mm, 2 mm]", "output.points[1].reach=20 um"};
  scratch_text("scene.yaml", minimal);
  vsc_scene *scene = read_good("scene.yaml", settings, 4);
  assert_int_equal(vsc_scene_write(scene, scratch("resolved.yaml"), &error), VSC_OK);
  vsc_scene *again = read_good("resolved.yaml", NULL, 0);
  for (int k = 0; k < 2; k++) {
    const vsc_output_def *output = k == 0 ? &scene->output : &again->output;
    assert_int_equal(output->point_count, 2);
    assert_string_equal(output->points[0].name, "p0");
    assert_close(output->points[0].at[1], 30, 1e-15, 0);
    assert_true(output->points[0].at[2] == -0.1);
    assert_true(output->points[0].reach == 0);
    assert_string_equal(output->points[1].name, "p1");
    assert_close(output->points[1].reach, 0.02, 1e-14, 0);
  }
  vsc_scene_free(scene);
  vsc_scene_free(again);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(every_key_arrives),
      cmocka_unit_test(absent_keys_take_the_defaults),
      cmocka_unit_test(a_written_scene_reads_back),
      cmocka_unit_test(points_are_read_and_written),
      cmocka_unit_test(written_numbers_keep_every_bit),
      cmocka_unit_test(an_unwritable_place_is_said),
      cmocka_unit_test(the_template_is_a_scene),
      cmocka_unit_test(settings_replace_and_add),
  };
  return cmocka_run_group_tests(tests, make_files, scratch_close);
}
