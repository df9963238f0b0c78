// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera calibrate`: what it prints, draws and refuses; moduli measured on a mesh.
#include "base/vec3.h"
#include "kinds_body.h"
#include "model/elasticity.h"
#include "program.h"
#include "tools/calibrate_measure.h"

// Measured and closed form agree for more axes and slanted pairs too, with own and shared volumes:
// all of S, so that no direction is left out.
static void test_measured_is_the_closed_form(void **state)
{
  (void)state;
  vsc_axis_def axes[2];
  vsc_pair_def pairs[2];
  const vsc_material_def material = springs_material(axes, pairs);
  for (int nodal = 0; nodal < 2; nodal++) {
    const vsc_volume_kind volume = nodal ? VSC_VOLUME_NODAL : VSC_VOLUME_ELEMENT;
    double C[36], S[36], measured[36];
    vsc_error error;
    if (vsc_stiffness_of(&material, volume, C, &error) != VSC_OK ||
        vsc_invert_six(C, S, &error) != VSC_OK ||
        vsc_measure_compliance(&material, volume, measured, &error) != VSC_OK)
      fail_msg("%s", error.text);
    // rounding of central differences, 1e-11 of K, times K over the softest modulus
    for (int i = 0; i < 36; i++) assert_close(measured[i], S[i], 0, 1e-8 * S[7]);
  }
}

// The numbers of the table's line that begins with `name`, up to three: returns how many.
static int read_line(const char *name, double value[3])
{
  const char *line = strstr(said, name);
  if (line == NULL) fail_msg("no line '%s' in '%s'", name, said);
  return sscanf(line + strlen(name), "%lf %lf %lf", &value[0], &value[1], &value[2]);
}

// The wanted, closed and measured Young's modulus of each line "Young ..." is E; returns how many.
static int check_young(double E)
{
  int lines = 0;
  for (const char *at = said; (at = strstr(at, "Young ")) != NULL; lines++) {
    double value[3];
    char name[64];
    assert_int_equal(sscanf(at, "Young %63s %lf %lf %lf", name, &value[0], &value[1], &value[2]),
                     4);
    for (int k = 0; k < 3; k++) assert_close(value[k], E, 1e-4, 0);  // five digits are printed
    at++;
  }
  return lines;
}

static void test_isotropic_in_twenty_directions(void **state)
{
  (void)state;
  must("$V calibrate --isotropic 10kPa,0.3 --random 20");
  assert_int_equal(check_young(10), 33);
  must("$V calibrate --isotropic 10kPa,0.45 --random 20");
  assert_int_equal(check_young(10), 33);
  assert_holds(said, "matched exactly");
  assert_holds(said, "alike in all directions");
  // the differences themselves, from a material of a scene
  must("$V calibrate " VSC_SOURCE_DIR "/data/block.yaml --random 20");
  int lines = 0;
  for (const char *at = said; (at = strstr(at, "Young ")) != NULL; at++, lines++) {
    double springs, measured, percent;
    assert_int_equal(sscanf(at, "Young %*s %lf %lf %lf", &springs, &measured, &percent), 3);
    // central differences, 1e-11 of K over E
    assert_true(fabs(percent) < 1e-5);
  }
  assert_int_equal(lines, 33);
}

// The printed material, pasted into a scene, is what it said.
static void test_prints_a_material_of_a_scene(void **state)
{
  (void)state;
  double wanted[3], value[3];
  must(
      "$V calibrate --young 10kPa,4kPa,3kPa --shear 3kPa,2kPa,3.5kPa --poisson 0.3,0.2,0.1 "
      ">material.yaml && cat material.yaml");
  assert_holds(said, "not matched exactly");
  assert_int_equal(read_line("Young f+s ", wanted), 3);
  must("(echo 'mesh: {file: \"" VSC_SOURCE_DIR
       "/data/block.vtu\", unit: mm}'; echo 'materials:'; "
       "cat material.yaml; echo 'volume: element'; echo 'time: {end: 1 ms}') >scene.yaml; "
       "$V calibrate scene.yaml");
  read_line("Young f+s ", value);
  assert_close(value[0], wanted[1], 2e-5, 0);
  assert_close(value[1], wanted[1], 2e-5, 0);
  read_line("shear nf", value);
  assert_close(value[1], 3.5, 1e-5, 0);
  must("$V check scene.yaml");
}

static void test_says_what_it_cannot_match(void **state)
{
  (void)state;
  double value[3];
  // softest along the fibre: no spring is negative
  must("$V calibrate --young 3kPa,8kPa,8kPa --shear 2kPa,3kPa,2kPa --incompressible");
  assert_holds(said, "axial: {f: 0 kPa");
  assert_holds(said, "not matched exactly");
  assert_int_equal(read_line("Young f ", value), 3);
  assert_close(value[0], 3, 1e-4, 0);
  assert_true(value[1] > 3.3);
  assert_holds(said, "+19 %");
}

// Liver: shear modulus 2.14 kPa by magnetic resonance elastography (Venkatesh 2014), Y = 3 G;
// E = 1.6 kPa, nu = 0.48 (AMSES 2015). Myocardium: Guccione's law at small strain (Land 2015).
static void test_published_values_fit(void **state)
{
  (void)state;
  double value[3];
  must("$V calibrate --young 6.42kPa --shear 2.14kPa --incompressible");
  assert_holds(said, "axial: {f: 4.28 kPa, s: 4.28 kPa, n: 4.28 kPa}");
  read_line("Young f+s+n", value);
  assert_close(value[2], 6.42, 2e-3, 0);  // what K leaves
  must("$V calibrate --isotropic '1.6 kPa,0.48'");
  assert_holds(said, "matched exactly");
  must("$V calibrate --young 18kPa,7.2kPa,7.2kPa --shear 4kPa,2kPa,4kPa --incompressible");
  assert_holds(said, "axial: {f: 16 kPa, s: 4 kPa, n: 4 kPa}");
}

// A law with constants per element has no stiffness of its own; the other materials have.
static void test_other_laws_are_left_out(void **state)
{
  (void)state;
  must("(echo 'mesh: {file: \"" VSC_SOURCE_DIR
       "/data/block.vtu\", unit: mm}'; echo 'time: {end: 1 ms}'; "
       "echo 'materials:'; echo '  - {name: wire, regions: [7], law: classical, classical: "
       "{stiffness: 2 N/m}}'; "
       "$V calibrate --isotropic 10kPa,0.3) >two.yaml; $V calibrate two.yaml");
  assert_holds(complained, "material wire: only law: springs");
  assert_holds(said, "tissue, at rest");
  assert_int_equal(shell("$V calibrate two.yaml --material wire"), 2);
  assert_holds(complained, "wire");
  assert_int_equal(shell("$V calibrate " VSC_SOURCE_DIR "/data/paper/hanging_paper.yaml"), 2);
  assert_holds(complained, "only law: springs");
  assert_int_equal(shell("$V calibrate --isotropic 10kPa,0.3 --material tissue"), 2);
  assert_holds(complained, "belong to a scene");
  assert_int_equal(shell("$V calibrate two.yaml --axes 9"), 2);
  assert_holds(complained, "--axes");
  assert_int_equal(shell("$V calibrate two.yaml --picture p.png"), 2);
  assert_holds(complained, "--material");
}

static void test_draws_a_picture(void **state)
{
  (void)state;
  static char csv[PROGRAM_TEXT];
  unsigned char head[24] = {0};
  must("$V calibrate " VSC_SOURCE_DIR "/data/beat.yaml --picture heart.png");
  FILE *stream = fopen(in_folder("heart.png"), "rb");
  assert_non_null(stream);
  assert_int_equal(fread(head, 1, sizeof head, stream), sizeof head);
  assert_memory_equal(head, "\x89PNG", 4);
  assert_int_equal(fseek(stream, 0, SEEK_END), 0);
  assert_true(ftell(stream) > 30000);  // more than white paper
  fclose(stream);
  load_text("heart.csv", csv, sizeof csv);
  assert_int_equal(line_count(csv), 1 + 3 * 361);
  double springs, measured;
  const char *row = strstr(csv, "\n2,15,nan,");  // nothing was wanted
  assert_non_null(row);
  assert_int_equal(sscanf(row, "\n2,15,nan,%lf,%lf", &springs, &measured), 2);
  assert_close(measured, springs, 1e-6, 0);
  // what was written can be drawn again, and nothing else is taken for it
  must("$V plot --polar heart.csv --title myocardium -o again.png");
  assert_same_files("heart.png", "again.png");
  assert_int_equal(shell("$V plot --polar " VSC_SOURCE_DIR "/README.md -o no.png"), 2);
  save_text("other.csv", "time [s],step [ms]\n1,2\n");
  assert_int_equal(shell("$V plot --polar other.csv -o no.png"), 2);
  assert_holds(complained, "other.csv");
  assert_int_equal(shell("$V plot --polar heart.csv"), 2);
}

static void refused(const char *arguments, const char *part)
{
  char command[512];
  snprintf(command, sizeof command, "$V calibrate %s", arguments);
  assert_int_equal(shell(command), 2);
  assert_holds(complained, part);
}

static void test_refusals_name_the_number(void **state)
{
  (void)state;
  refused("", "give a scene");
  refused("--isotropic 10,0.3", "--isotropic 10,0.3");
  refused("--isotropic 10kPa,0.5", "0.5");
  refused("--isotropic 10kPa", "expected 2");
  refused("--isotropic 10kPa,0.3 --incompressible", "--isotropic");
  refused("--young 1kPa,2kPa --shear 1kPa --incompressible", "2 values, expected 3");
  refused("--young 1kPa --incompressible", "--shear");
  refused("--young 1kPa --shear 1kPa", "--poisson or --incompressible");
  refused("--young 1kPa --shear 1kPa --poisson 0.3 --volume-modulus 9kPa", "--volume-modulus");
  refused("--young 4kPa,16kPa,3kPa --shear 1kPa --poisson 0.6,0,0", "ratio fs, 0.6");
  refused("--young 1kPa,9kPa,9kPa --shear 1kPa --incompressible", "along f, 1 kPa");
  refused("--isotropic 10kPa,0.3 --axes 4", "--axes 4");
  refused("--isotropic 10kPa,0.3 --random many", "--random many");
  refused("--isotropic 10kPa,0.3 --picture heart.jpg", "heart.jpg");
  refused("--isotropic 10kPa,0.3 " VSC_SOURCE_DIR "/data/block.yaml", "not both");
  refused(VSC_SOURCE_DIR "/data/block.yaml --material bone", "bone");
  refused("none.yaml", "none.yaml");
}

static void test_help_has_examples(void **state)
{
  (void)state;
  must("$V calibrate --help");
  assert_holds(said, "Examples:");
  must("$V help calibrate");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_measured_is_the_closed_form),
      cmocka_unit_test(test_isotropic_in_twenty_directions),
      cmocka_unit_test(test_prints_a_material_of_a_scene),
      cmocka_unit_test(test_says_what_it_cannot_match),
      cmocka_unit_test(test_published_values_fit),
      cmocka_unit_test(test_other_laws_are_left_out),
      cmocka_unit_test(test_draws_a_picture),
      cmocka_unit_test(test_refusals_name_the_number),
      cmocka_unit_test(test_help_has_examples),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
