// SPDX-License-Identifier: GPL-3.0-or-later
#include "model/definition.h"

#include <string.h>

#include "base/mem.h"
#include "close.h"
#include "model/fiber_def.h"

// A definition that obeys every rule: two materials, an active one with a table, one surface,
// two node sets, a support, a pressure, and springs on the surface.
static vsc_definition make_good(void)
{
  vsc_definition d = vsc_default_definition();
  assert_true(VSC_NEW(d.materials, 2) && VSC_NEW(d.surfaces, 1) && VSC_NEW(d.sets, 2) &&
              VSC_NEW(d.supports, 1) && VSC_NEW(d.pressures, 1) && VSC_NEW(d.robins, 1));
  d.material_count = 2;
  d.surface_count = d.support_count = d.pressure_count = d.robin_count = 1;
  d.set_count = 2;
  for (int i = 0; i < 2; i++) {
    d.materials[i] = vsc_default_material();
    vsc_copy_name(d.materials[i].name, i == 0 ? "muscle" : "scar");
    d.materials[i].volume_modulus = 1000;
    for (int a = 0; a < 3; a++) d.materials[i].axial[a] = d.materials[i].angular[a] = 5;
  }
  d.materials[0].region_count = 1;
  d.materials[0].regions[0] = 3;
  vsc_active_def *active = &d.materials[0].active;
  active->kind = VSC_ACTIVE_TENSION;
  active->tension = 60;
  active->curve = vsc_default_curve(VSC_CURVE_TABLE);
  assert_true(VSC_NEW(active->curve.times, 3) && VSC_NEW(active->curve.values, 3));
  active->curve.point_count = 3;
  for (int i = 0; i < 3; i++) active->curve.times[i] = 100 * i;
  d.surfaces[0] = (vsc_selector){.name = "endo", .kind = VSC_SELECT_NODE_ARRAY, .array = "endo",
                                 .low = 1, .high = 1};
  d.sets[0] = (vsc_selector){.name = "base", .kind = VSC_SELECT_PLANE, .normal = {0, 0, 1},
                             .tolerance = 0.1};
  d.sets[1] = (vsc_selector){.name = "inside", .kind = VSC_SELECT_SURFACE, .array = "endo"};
  d.supports[0] = (vsc_support_def){.set = "base", .held = {0, 0, 1}};
  d.pressures[0] = (vsc_pressure_def){.surface = "endo", .peak = 16,
                                      .curve = vsc_default_curve(VSC_CURVE_HALF_SINE)};
  d.robins[0] = (vsc_robin_def){.surface = "endo", .stiffness = 1};
  d.end_time = 100;
  return d;
}

static void defaults_are_as_documented(void **state)
{
  (void)state;
  const vsc_curve_def hill = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
  const vsc_curve_def tanh_pair = vsc_default_curve(VSC_CURVE_TANH_PAIR);
  assert_int_equal(hill.kind, VSC_CURVE_DOUBLE_HILL);
  assert_true(hill.rise == 100 && hill.fall == 300 && hill.rise_power == 2 &&
              hill.fall_power == 20 && hill.period == 0 && hill.duration == 300);
  assert_true(tanh_pair.rise == 20 && tanh_pair.fall == 20 && tanh_pair.start == 0);
  const vsc_material_def material = vsc_default_material();
  assert_true(material.density == 1.06 && material.active.rest_stretch == 1 &&
              material.active.delay_unit == 1 && material.volume_modulus == 0);
  assert_int_equal(material.active.kind, VSC_ACTIVE_NONE);
  const vsc_definition definition = vsc_default_definition();
  assert_true(definition.safety == 0.8 && definition.step == 0 && definition.gravity[2] == 0);
  assert_int_equal(definition.volume, VSC_VOLUME_NODAL);
  const vsc_fiber_def fiber = vsc_default_fiber();
  assert_int_equal(fiber.source, VSC_FIBER_NONE);
  assert_string_equal(fiber.map.azimuth, "azimuth");
  assert_string_equal(fiber.map.elevation, "elevation");
  assert_string_equal(fiber.fiber_array, "fiber");
  assert_close(fiber.map.scale, M_PI / 180, 1e-15, 0);
  assert_close(fiber.endo_angle, M_PI / 3, 1e-15, 0);
  assert_close(fiber.epi_angle, -M_PI / 3, 1e-15, 0);
  assert_close(fiber.pitch, M_PI / 6, 1e-15, 0);
  assert_true(fiber.map.image_axes && fiber.map.azimuth_sense == 1 && fiber.seed == 1 &&
              fiber.map.elevation_sense == 1 && fiber.map.length_unit == 1 &&
              fiber.long_axis[2] == 1 && !fiber.fill);
}

static void a_good_definition_passes(void **state)
{
  (void)state;
  vsc_definition d = make_good();
  vsc_error error = {.text = ""};
  if (vsc_definition_check(&d, &error) != VSC_OK) fail_msg("%s", error.text);
  vsc_copy_name(d.pressures[0].surface, "boundary");
  vsc_copy_name(d.sets[1].array, "boundary");
  d.materials[1].region_count = 1;
  d.materials[1].regions[0] = 4;
  assert_int_equal(vsc_definition_check(&d, &error), VSC_OK);
  vsc_definition_free(&d);
  assert_int_equal(d.material_count, 0);
  vsc_definition_free(&d);
}

typedef void spoil(vsc_definition *d);

#define SPOIL(name, ...) \
  static void name(vsc_definition *d) \
  { \
    __VA_ARGS__; \
  }
SPOIL(no_material, d->material_count = 0)
SPOIL(axial, d->materials[1].axial[2] = -5)
SPOIL(axial_nan, d->materials[0].axial[0] = NAN)
SPOIL(angular, d->materials[0].angular[1] = -1e-9)
SPOIL(damping, d->materials[0].damping[0] = -1)
SPOIL(material_name, vsc_copy_name(d->materials[1].name, "a,b"))
SPOIL(surface_name, vsc_copy_name(d->surfaces[0].name, "in \"quotes\""))
SPOIL(set_name, vsc_copy_name(d->sets[1].name, "a\\b"))
SPOIL(density, d->materials[0].density = 0)
SPOIL(no_volume, d->materials[1].volume_modulus = 0)
SPOIL(huge_volume, d->materials[1].volume_modulus = INFINITY)
SPOIL(stabilization, d->materials[0].stabilization = -1)
SPOIL(tension, d->materials[0].active.tension = -60)
SPOIL(length_factor, d->materials[0].active.length_factor = NAN)
SPOIL(sheet_fraction, d->materials[0].active.sheet_fraction = -0.1)
SPOIL(viscosity, d->materials[0].viscosity = -1)
SPOIL(coupling, d->materials[0].coupling[0] = -1100)
SPOIL(coupling_nan, d->materials[0].coupling[2] = NAN)
SPOIL(neo_hookean, d->materials[1].law = VSC_LAW_NEO_HOOKEAN)
SPOIL(guccione, d->materials[1].law = VSC_LAW_GUCCIONE;
      d->materials[1].guccione = (vsc_guccione_def){2, 8, -2, 4})
SPOIL(fung, d->materials[1].law = VSC_LAW_FUNG;
      d->materials[1].fung = (vsc_fung_def){1, {1, 1, 1, 1, 0, 1}})
SPOIL(dispersion, d->materials[1].law = VSC_LAW_HOLZAPFEL_OGDEN;
      d->materials[1].holzapfel_ogden = (vsc_holzapfel_ogden_def){.a = 1, .b = 1, .kappa_f = 0.4})
SPOIL(fibre_exponent, d->materials[1].law = VSC_LAW_HOLZAPFEL_OGDEN;
      d->materials[1].holzapfel_ogden = (vsc_holzapfel_ogden_def){.a = 1, .b = 1, .a_f = 1})
SPOIL(rivlin, d->materials[1].law = VSC_LAW_MOONEY_RIVLIN;
      d->materials[1].mooney_rivlin = (vsc_invariants_def){1, -0.5})
SPOIL(westmann, d->materials[1].law = VSC_LAW_VERONDA_WESTMANN;
      d->materials[1].veronda_westmann = (vsc_invariants_def){1, 0})
SPOIL(active_tissue, d->materials[0].law = VSC_LAW_NEO_HOOKEAN; d->materials[0].shear = 1;
      d->materials[0].active.kind = VSC_ACTIVE_SPRING)
SPOIL(rest_stretch, d->materials[1].active.kind = VSC_ACTIVE_SPRING;
      d->materials[1].active.rest_stretch = 0)
SPOIL(stiffness, d->materials[1].active.kind = VSC_ACTIVE_SPRING;
      d->materials[1].active.stiffness = -1)
SPOIL(delay, d->materials[0].active.delay = NAN)
SPOIL(delay_unit, d->materials[0].active.delay_unit = 0)
SPOIL(one_point, d->materials[0].active.curve.point_count = 1)
SPOIL(falling, d->materials[0].active.curve.times[2] = 100)
SPOIL(table_nan, d->materials[0].active.curve.values[1] = NAN)
SPOIL(velocity_of_equilibrium, vsc_copy_name(d->velocity.array, "v");
      d->solve.kind = VSC_SOLVE_EQUILIBRIUM)
SPOIL(velocity_unit, vsc_copy_name(d->velocity.array, "v"); d->velocity.unit = 0)
SPOIL(duration, d->pressures[0].curve.duration = 0)
SPOIL(period, d->pressures[0].curve.period = 200)
SPOIL(cut_off, d->pressures[0].curve.start = 600; d->pressures[0].curve.period = 800)
SPOIL(early_start, d->pressures[0].curve.start = -10; d->pressures[0].curve.period = 800)
SPOIL(long_table, d->materials[0].active.curve.period = 100)
SPOIL(late_hill, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
      d->pressures[0].curve.start = 800; d->pressures[0].curve.period = 800)
SPOIL(short_end, d->end_time = 1e-320)
SPOIL(negative_period, d->pressures[0].curve.period = -1)
SPOIL(rise, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
      d->pressures[0].curve.rise = 0)
SPOIL(fall, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_TANH_PAIR);
      d->pressures[0].curve.fall = -20)
SPOIL(power, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_DOUBLE_HILL);
      d->pressures[0].curve.fall_power = 0)
SPOIL(stop, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_BESTEL);
      d->pressures[0].curve.start = 500)
SPOIL(width, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_BESTEL);
      d->pressures[0].curve.width = 0)
SPOIL(rate_up, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_BESTEL);
      d->pressures[0].curve.rate_up = 0)
SPOIL(rate_down, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_BESTEL);
      d->pressures[0].curve.rate_down = 0.03)
SPOIL(filling, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_BESTEL_PRESSURE);
      d->pressures[0].curve.filling = -1)
SPOIL(driver_period, d->pressures[0].curve = vsc_default_curve(VSC_CURVE_BESTEL_PRESSURE);
      d->pressures[0].curve.period = 480)
SPOIL(start, d->pressures[0].curve.start = INFINITY)
SPOIL(peak, d->pressures[0].peak = NAN)
SPOIL(many_regions, d->materials[1].region_count = 33)
SPOIL(shared_region, d->materials[1].region_count = 1; d->materials[1].regions[0] = 3)
SPOIL(two_rests, d->materials[0].region_count = 0)
SPOIL(range, d->surfaces[0].low = 2)
SPOIL(box, d->sets[0].kind = VSC_SELECT_BOX; d->sets[0].box_low[1] = 1)
SPOIL(normal, d->sets[0].normal[2] = 0)
SPOIL(tolerance, d->sets[0].tolerance = -0.1)
SPOIL(same_name, vsc_copy_name(d->sets[1].name, "base"))
SPOIL(no_name, d->surfaces[0].name[0] = '\0')
SPOIL(set_of_surface, vsc_copy_name(d->sets[1].array, "edo"))
SPOIL(support_set, vsc_copy_name(d->supports[0].set, "bse"))
SPOIL(boundary_set, vsc_copy_name(d->supports[0].set, "boundary"))
SPOIL(held, d->supports[0].held[2] = 0)
SPOIL(free_motion, d->supports[0].motion[1] = 2)
SPOIL(motion_nan, d->supports[0].motion[2] = NAN)
SPOIL(motion_curve, d->supports[0].curve = vsc_default_curve(VSC_CURVE_RAMP);
      d->supports[0].curve.duration = 0)
SPOIL(kept_motion, d->supports[0].motion[2] = 1; d->kept_volume = VSC_KEEP_TOTAL)
SPOIL(robin_surface, vsc_copy_name(d->robins[0].surface, "edo"))
SPOIL(robin_stiffness, d->robins[0].stiffness = -1)
SPOIL(robin_damping, d->robins[0].damping = NAN)
SPOIL(robin_nothing, d->robins[0].stiffness = 0)
SPOIL(pressure_surface, vsc_copy_name(d->pressures[0].surface, "endocard"))
SPOIL(gravity, d->gravity[1] = NAN)
SPOIL(end_time, d->end_time = 0)
SPOIL(step, d->step = -0.1)
SPOIL(safety, d->safety = 0)
SPOIL(masses, d->masses = VSC_MASS_CONSISTENT)
SPOIL(kind_of_law, d->materials[1].law = (vsc_law)99)
SPOIL(kind_of_compression, d->materials[1].compression = (vsc_fibre_switch)3)
SPOIL(kind_of_activity, d->materials[0].active.kind = (vsc_active_kind)3)
SPOIL(kind_of_active_curve, d->materials[1].active.curve.kind = (vsc_curve_kind)8)
SPOIL(kind_of_support_curve, d->supports[0].curve.kind = (vsc_curve_kind)-1)
SPOIL(kind_of_pressure_curve, d->pressures[0].curve.kind = (vsc_curve_kind)8)
SPOIL(kind_of_surface, d->surfaces[0].kind = (vsc_select_kind)6)
SPOIL(kind_of_set, d->sets[1].kind = (vsc_select_kind)6)
SPOIL(kind_of_volume, d->volume = (vsc_volume_kind)2)
SPOIL(kind_of_tets, d->tets = (vsc_tets_kind)2)
SPOIL(kind_of_keeping, d->kept_volume = (vsc_kept_volume)5)
SPOIL(kind_of_masses, d->masses = (vsc_mass_kind)4)
SPOIL(kind_of_solve, d->solve.kind = (vsc_solve_kind)3)
SPOIL(kind_of_method, d->solve.method = (vsc_statics)2)
SPOIL(kind_of_linear, d->solve.linear = (vsc_linear_kind)3)
SPOIL(kind_of_scheme, d->solve.scheme = (vsc_scheme)3)
SPOIL(kind_of_obstacle, assert_true(VSC_NEW(d->obstacles, 1)); d->obstacle_count = 1;
      d->obstacles[0] = vsc_default_obstacle(); d->obstacles[0].kind = (vsc_obstacle_kind)2)
SPOIL(kind_of_obstacle_curve, assert_true(VSC_NEW(d->obstacles, 1)); d->obstacle_count = 1;
      d->obstacles[0] = vsc_default_obstacle(); d->obstacles[0].curve.kind = (vsc_curve_kind)8)

static const struct {
  spoil *apply;
  const char *start, *said;
} rules[] = {
    {no_material, "materials: ", "at least one"},
    {axial, "materials[1].axial.n: -5 kPa: ", "zero or more"},
    {axial_nan, "materials[0].axial.f: ", "zero or more"},
    {angular, "materials[0].angular.sn: ", "zero or more"},
    {damping, "materials[0].damping.f: ", "zero or more"},
    {material_name, "materials[1].name: \"a,b\": ", "without commas"},
    {surface_name, "surfaces[0].name: ", "without commas, brackets, quotes"},
    {set_name, "node_sets[1].name: ", "backslashes"},
    {density, "materials[0].density: 0 mg/mm3: ", "above zero"},
    {no_volume, "materials[1].volume_modulus: 0 kPa: ", "10 to 100 times"},
    {huge_volume, "materials[1].volume_modulus: ", "above zero"},
    {stabilization, "materials[0].stabilization: ", "zero or more"},
    {tension, "materials[0].active.tension: -60 kPa: ", "zero or more"},
    {length_factor, "materials[0].active.length_factor: ", "finite"},
    {sheet_fraction, "materials[0].active.sheet_fraction: -0.1: ", "zero or more"},
    {viscosity, "materials[0].viscosity: -1 kPa ms: ", "zero or more"},
    {coupling, "materials[0].coupling.fs: -1100 kPa: ", "smaller couplings"},
    {coupling_nan, "materials[0].coupling.nf: ", "finite"},
    {neo_hookean, "materials[1].neo_hookean.shear: 0 kPa: ", "above zero"},
    {guccione, "materials[1].guccione.bt: -2: ", "above zero"},
    {fung, "materials[1].fung.bsn: 0: ", "above zero"},
    {dispersion, "materials[1].holzapfel_ogden.kappa_f: 0.4: ", "1/3"},
    {fibre_exponent, "materials[1].holzapfel_ogden.bf: 0: ", "above zero"},
    {rivlin, "materials[1].mooney_rivlin.c2: -0.5 kPa: ", "zero or more"},
    {westmann, "materials[1].veronda_westmann.c2: 0: ", "above zero"},
    {active_tissue, "materials[0].active.kind: \"spring\": ", "kind: tension"},
    {masses, "masses: consistent: ", "masses: lumped"},
    {rest_stretch, "materials[1].active.rest_stretch: 0: ", "up to 1"},
    {stiffness, "materials[1].active.stiffness: ", "zero or more"},
    {delay, "materials[0].active.delay: ", "finite"},
    {delay_unit, "materials[0].active.delay_unit: ", "above zero"},
    {one_point, "materials[0].active.curve.times: 1 points: ", "at least two"},
    {falling, "materials[0].active.curve.times[2]: 100 ms: ", "rise"},
    {table_nan, "materials[0].active.curve.values[1]: ", "finite"},
    {duration, "pressures[0].curve.duration: ", "above zero"},
    {period, "pressures[0].curve.period: 200 ms: ", "shorter than start + duration (300 ms): "},
    {cut_off, "pressures[0].curve.period: 800 ms: ", "shorter than start + duration (900 ms): "},
    {early_start, "pressures[0].curve.start: -10 ms: ", "0 ms or later"},
    {long_table, "materials[0].active.curve.period: 100 ms: ", "shorter than the table's last time ("},
    {late_hill, "pressures[0].curve.start: 800 ms: ", "its period (800 ms) is over"},
    {negative_period, "pressures[0].curve.period: ", "zero or more"},
    {rise, "pressures[0].curve.rise: ", "above zero"},
    {fall, "pressures[0].curve.fall: -20 ms: ", "above zero"},
    {power, "pressures[0].curve.fall_power: 0: ", "above zero"},
    {stop, "pressures[0].curve.stop: 484 ms: ", "after the start"},
    {width, "pressures[0].curve.width: 0 ms: ", "above zero"},
    {rate_up, "pressures[0].curve.rate_up: 0 1/ms: ", "above zero"},
    {rate_down, "pressures[0].curve.rate_down: 0.03 1/ms: ", "below zero"},
    {filling, "pressures[0].curve.filling: -1 1/ms: ", "zero or more"},
    {driver_period, "pressures[0].curve.period: 480 ms: ", "shorter than stop (484 ms): "},
    {start, "pressures[0].curve.start: ", "finite"},
    {peak, "pressures[0].peak: ", "finite"},
    {many_regions, "materials[1].regions: 33 32 at most", "another material"},
    {shared_region, "materials[1].regions: 3: ", "muscle"},
    {two_rests, "materials[1].regions: ", "list regions"},
    {range, "surfaces[0].range: ", "not be above"},
    {box, "node_sets[0].box.low: 1 mm: ", "box.high"},
    {normal, "node_sets[0].plane.normal: ", "not zero"},
    {tolerance, "node_sets[0].plane.tolerance: ", "zero or more"},
    {same_name, "node_sets[1].name: ", "node_sets[0] already"},
    {no_name, "surfaces[0].name: ", "give it a name"},
    {set_of_surface, "node_sets[1].surface: ", "the nearest is endo"},
    {support_set, "supports[0].set: ", "the nearest is base"},
    {boundary_set, "supports[0].set: ", "under node_sets"},
    {held, "supports[0].held: ", "x, y, z"},
    {free_motion, "supports[0].motion: 2 mm: ", "`held`"},
    {motion_nan, "supports[0].motion: ", "finite"},
    {motion_curve, "supports[0].curve.duration: ", "above zero"},
    {kept_motion, "supports[0].motion: 1 mm: ", "keep_volume"},
    {robin_surface, "robin[0].surface: ", "the nearest is endo"},
    {robin_stiffness, "robin[0].stiffness: -1 kPa/mm: ", "zero or more"},
    {robin_damping, "robin[0].damping: ", "zero or more"},
    {robin_nothing, "robin[0].stiffness: 0 kPa/mm: ", "above zero"},
    {pressure_surface, "pressures[0].surface: ", "the nearest is endo"},
    {velocity_of_equilibrium, "initial_velocity.node_array: \"v\": ", "explicit or implicit"},
    {velocity_unit, "initial_velocity.unit: 0 m/s: ", "not zero"},
    {gravity, "gravity: ", "finite"},
    {end_time, "time.end: 0 ms: ", "above zero"},
    {short_end, "time.end: ", "1e-9 ms at least"},
    {step, "time.step: -0.1 ms: ", "zero or more"},
    {safety, "time.safety: 0: ", "up to 1"},
    {kind_of_law, "materials[1].law: 99: ", "no such kind"},
    {kind_of_compression, "materials[1].compression: 3: ", "no such kind"},
    {kind_of_activity, "materials[0].active.kind: 3: ", "no such kind"},
    {kind_of_active_curve, "materials[1].active.curve.kind: 8: ", "no such kind"},
    {kind_of_support_curve, "supports[0].curve.kind: -1: ", "no such kind"},
    {kind_of_pressure_curve, "pressures[0].curve.kind: 8: ", "no such kind"},
    {kind_of_surface, "surfaces[0].kind: 6: ", "no such kind"},
    {kind_of_set, "node_sets[1].kind: 6: ", "no such kind"},
    {kind_of_volume, "volume: 2: ", "no such kind"},
    {kind_of_tets, "tets: 2: ", "no such kind"},
    {kind_of_keeping, "keep_volume: 5: ", "no such kind"},
    {kind_of_masses, "masses: 4: ", "no such kind"},
    {kind_of_solve, "solve: 3: ", "no such kind"},
    {kind_of_method, "solver.method: 2: ", "no such kind"},
    {kind_of_linear, "solver.linear: 3: ", "no such kind"},
    {kind_of_scheme, "solver.scheme: 3: ", "no such kind"},
    {kind_of_obstacle, "obstacles[0].kind: 2: ", "no such kind"},
    {kind_of_obstacle_curve, "obstacles[0].curve.kind: 8: ", "no such kind"},
};

static void every_rule_names_its_key(void **state)
{
  (void)state;
  for (size_t i = 0; i < sizeof rules / sizeof *rules; i++) {
    vsc_definition d = make_good();
    vsc_error error = {.text = ""};
    rules[i].apply(&d);
    if (vsc_definition_check(&d, &error) != VSC_INPUT)
      fail_msg("accepted, without \"%s\"", rules[i].start);
    if (strncmp(error.text, rules[i].start, strlen(rules[i].start)) != 0)
      fail_msg("\"%s\" does not begin with \"%s\"", error.text, rules[i].start);
    if (strstr(error.text, rules[i].said) == NULL)
      fail_msg("\"%s\" lacks \"%s\"", error.text, rules[i].said);
    if (rules[i].apply == no_material) d.material_count = 2;
    vsc_definition_free(&d);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(defaults_are_as_documented),
      cmocka_unit_test(a_good_definition_passes),
      cmocka_unit_test(every_rule_names_its_key),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
