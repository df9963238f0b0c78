// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera calibrate`: what is measured on a block is what was wanted.
#include "base/vec3.h"
#include "kinds_body.h"
#include "model/calibration.h"
#include "program.h"
#include "tools/calibrate_measure.h"

// An isotropic material has its Young's modulus in 20 random directions: within 0.1 %, in truth to the
// rounding of differences of forces (1e-8).
static void isotropic_springs_measure_alike(void **state)
{
  (void)state;
  uint64_t seed = 3;
  const double ratios[] = {0.3, 0.45, 0.48};
  for (int k = 0; k < 3; k++) {
    const vsc_orthotropic wanted = vsc_isotropic(10, ratios[k]);
    vsc_material_def m = vsc_default_material();
    vsc_sample *sample;
    vsc_error error;
    double residual;
    if (vsc_calibrate(&wanted, VSC_THREE_AXES, &m, &residual, &error) != VSC_OK ||
        vsc_sample_open(&m, VSC_VOLUME_ELEMENT, &sample, &error) != VSC_OK)
      fail_msg("%s", error.text);
    for (int round = 0; round < 20; round++) {
      double R[9];
      random_rotation(&seed, R);
      assert_close(vsc_sample_young(sample, R), 10, 1e-7, 0);
    }
    vsc_sample_close(sample);
  }
}

// Measured and closed form agree for a material of more axes and slanted pairs too.
static void measured_is_the_closed_form(void **state)
{
  (void)state;
  uint64_t seed = 4;
  vsc_axis_def axes[2];
  vsc_pair_def pairs[2];
  const vsc_material_def m = springs_material(axes, pairs);
  vsc_sample *sample;
  vsc_error error;
  double C[36], S[36];
  for (int nodal = 0; nodal < 2; nodal++) {
    const vsc_volume_kind volume = nodal ? VSC_VOLUME_NODAL : VSC_VOLUME_ELEMENT;
    if (vsc_stiffness_of(&m, volume, C, &error) != VSC_OK ||
        vsc_invert_six(C, S, &error) != VSC_OK ||
        vsc_sample_open(&m, volume, &sample, &error) != VSC_OK)
      fail_msg("%s", error.text);
    for (int round = 0; round < 20; round++) {
      double R[9];
      random_rotation(&seed, R);
      assert_close(vsc_sample_young(sample, R), vsc_young(S, R), 1e-7, 0);
    }
    vsc_sample_close(sample);
  }
}

static void the_program_says_it(void **state)
{
  (void)state;
  must("$V calibrate --isotropic '10 kPa,0.45' --random 3");
  assert_holds(said, "axial:   {f: 6.89655 kPa, s: 6.89655 kPa, n: 6.89655 kPa}");
  assert_holds(said, "# exact");
  must("$V calibrate --young '16 kPa,8 kPa,5 kPa' --shear '4 kPa,2 kPa,4 kPa' --poisson 0.3,0.4,0.15");
  assert_holds(said, "as near as springs of positive modulus come");
  // two independent couplings more: the face diagonals bring them
  must("$V calibrate --young '16 kPa,8 kPa,5 kPa' --shear '4 kPa,2 kPa,4 kPa' --poisson 0.3,0.4,0.15 "
       "--axes 9 --picture p.png && test -s p.png");
  assert_holds(said, "# exact");
  must("$V calibrate --young '10 kPa,4 kPa,3 kPa' --shear '2 kPa,1 kPa,2 kPa' --incompressible '100 MPa'");
  assert_holds(said, "f: 9.69");
  must("$V calibrate " VSC_SOURCE_DIR "/data/beat.yaml");
  assert_holds(said, "material myocardium");
  assert_int_equal(shell("$V calibrate"), 2);
  assert_int_equal(shell("$V calibrate --isotropic '10 kPa,0.6'"), 2);
  assert_holds(complained, "0.6");
  assert_int_equal(shell("$V calibrate --isotropic '10,0.3'"), 2);
  assert_int_equal(shell("$V calibrate --axes 4 --isotropic '10 kPa,0.3'"), 2);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(isotropic_springs_measure_alike),
      cmocka_unit_test(measured_is_the_closed_form),
      cmocka_unit_test(the_program_says_it),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
