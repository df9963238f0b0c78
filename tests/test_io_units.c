// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units.h"

#include <pthread.h>
#include <string.h>

#include "close.h"
#include "trap.h"

static double read_good(const char *text, vsc_quantity quantity)
{
  double value = NAN;
  vsc_error error = {.text = ""};
  if (vsc_units_read(text, quantity, &value, &error) != VSC_OK) fail_msg("%s", error.text);
  return value;
}

static void values_of_every_quantity(void **state)
{
  (void)state;
  const struct {
    const char *text;
    vsc_quantity quantity;
    double value;
  } cases[] = {
      {"1.5 cm", VSC_LENGTH, 15},         {"100 um", VSC_LENGTH, 0.1},
      {"-2e-3 m", VSC_LENGTH, -2},        {"0.8 s", VSC_TIME, 800},
      {"10ms", VSC_TIME, 10},             {"  1 min ", VSC_TIME, 60000},
      {"60 kPa", VSC_PRESSURE, 60},       {"120 mmHg", VSC_PRESSURE, 15.9986864898},
      {"1 MPa", VSC_PRESSURE, 1000},      {"5 N/m2", VSC_PRESSURE, 0.005},
      {"1060 kg/m3", VSC_DENSITY, 1.06},  {"1.06 g/cm3", VSC_DENSITY, 1.06},
      {"10 Pa s", VSC_VISCOSITY, 10},     {"2 kPa ms", VSC_VISCOSITY, 2},
      {"9.81 m/s2", VSC_ACCELERATION, 0.00981},
      {"1e8 Pa/m", VSC_BED_STIFFNESS, 100}, {"3 N/mm3", VSC_BED_STIFFNESS, 3000},
      {"5e3 Pa s/m", VSC_BED_DAMPING, 5},
      {"5 N/m^2", VSC_PRESSURE, 0.005},   {"5 N.m-2", VSC_PRESSURE, 0.005},
      {"5 N/m**2", VSC_PRESSURE, 0.005},  {"5 N m^-2", VSC_PRESSURE, 0.005},
      {"5 1/s", VSC_RATE, 0.005},         {"-30 s-1", VSC_RATE, -0.03},
      {"5 Hz", VSC_RATE, 0.005},          {"2 1/ms", VSC_RATE, 2},
      {"180 deg", VSC_ANGLE, M_PI},       {"35 degree", VSC_ANGLE, 35 * M_PI / 180},
      {"0.1 deg", VSC_ANGLE, M_PI / 1800}, {"1 rad", VSC_ANGLE, 1},
      {"90 °", VSC_ANGLE, M_PI / 2},      {"0.8", VSC_NUMBER, 0.8},
      {"-3e4", VSC_NUMBER, -3e4},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++)
    assert_close(read_good(cases[i].text, cases[i].quantity), cases[i].value, 1e-12, 0);
}

static void own_units_keep_every_bit(void **state)
{
  (void)state;
  const double values[] = {0.1, 1.0 / 3, 1e-300, 123456789.123456789, -4.9e-324};
  for (vsc_quantity q = VSC_LENGTH; q <= VSC_NUMBER; q++) {
    for (size_t i = 0; i < sizeof values / sizeof *values; i++) {
      char text[100];
      snprintf(text, sizeof text, "%.17g %s", values[i], vsc_units_name(q));
      assert_true(read_good(text, q) == values[i]);
    }
  }
}

static void wrong_texts_say_what_was_expected(void **state)
{
  (void)state;
  const struct {
    const char *text;
    vsc_quantity quantity;
    const char *said;
  } cases[] = {
      {"60", VSC_PRESSURE, "no unit"},          {"60 kpa", VSC_PRESSURE, "did you mean kPa"},
      {"60 MPA", VSC_PRESSURE, "did you mean"}, {"60 pa", VSC_PRESSURE, "did you mean Pa"},
      {"60 mm", VSC_PRESSURE, "not a pressure"}, {"10 Hz", VSC_TIME, "not a time"},
      {"0.8 wombats", VSC_TIME, "unknown unit wombats"},
      {"kPa", VSC_PRESSURE, "no number"},       {"", VSC_TIME, "no number"},
      {"nan s", VSC_TIME, "not a finite"},      {"inf kPa", VSC_PRESSURE, "not a finite"},
      {"1e999 kPa", VSC_PRESSURE, "not a finite"}, {"1e308 GPa", VSC_PRESSURE, "too large"},
      {"1,5 kPa", VSC_PRESSURE, "decimal point"}, {"3 4 kPa", VSC_PRESSURE, "second number"},
      {"20 kPa 3", VSC_PRESSURE, "second number"}, {"20 kPa*3", VSC_PRESSURE, "second number"},
      {"20 kPa.3", VSC_PRESSURE, "second number"}, {"20 kPa·3", VSC_PRESSURE, "second number"}, {"20 kPa (3)", VSC_PRESSURE, "second number"},
      {"20 kPa/2", VSC_PRESSURE, "second number"}, {"5 1/2 s", VSC_RATE, "second number"},
      {"20 kPa -3", VSC_PRESSURE, "second number"}, {"20 kPa*-3", VSC_PRESSURE, "second number"},
      {"3 kPa)", VSC_PRESSURE, "unknown unit"}, {"3 s @ 5", VSC_TIME, "second number"},
      {"3 s since 2000-01-01", VSC_TIME, "second number"},
      {"60 %", VSC_ANGLE, "not an angle"},      {"5 kPa", VSC_ANGLE, "35 deg"},
      {"5 s", VSC_RATE, "5 1/s"},         {"5 1/1/s", VSC_RATE, "expected a rate"},
      {"3 1/kPa", VSC_PRESSURE, "second number"},
      {"5 mm", VSC_NUMBER, "plain number"},     {"five", VSC_NUMBER, "no number"},
      {"1 kg", VSC_DENSITY, "1.06 g/cm3"},      {"1 Pa", VSC_VISCOSITY, "10 Pa s"},
      {"1 kPa", VSC_BED_STIFFNESS, "1e5 Pa/m"}, {"1 Pa/m", VSC_BED_DAMPING, "5e3 Pa s/m"},
      {"1 m/s", VSC_ACCELERATION, "9.81 m/s2"}, {"1 m2", VSC_LENGTH, "3 mm"},
      {"1 aaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaaa"
       "aaaaaaaaaaaaaaaaaaaaaaaaa", VSC_LENGTH, "too long"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
    double value = 42;
    vsc_error error = {.text = ""};
    trap_off();
    const vsc_status status = vsc_units_read(cases[i].text, cases[i].quantity, &value, &error);
    trap_on();
    if (status != VSC_INPUT)
      fail_msg("\"%s\" gave %g: %s", cases[i].text, value, error.text);
    if (strstr(error.text, cases[i].said) == NULL)
      fail_msg("\"%s\" lacks \"%s\"", error.text, cases[i].said);
    assert_non_null(strstr(error.text, "expected"));
    assert_true(value == 42);
  }
}

static void *read_many(void *wrong)
{
  for (int i = 0; i < 500; i++) {
    double value = 0;
    vsc_status status = vsc_units_read("60 kPa", VSC_PRESSURE, &value, NULL);
    if (status != VSC_OK || value != 60) *(int *)wrong += 1;
    status = vsc_units_read("2 wombats", VSC_TIME, &value, NULL);
    if (status != VSC_INPUT) *(int *)wrong += 1;
  }
  return NULL;
}

static void threads_may_read_at_once(void **state)
{
  (void)state;
  pthread_t threads[4];
  int wrong[4] = {0};
  for (int i = 0; i < 4; i++) pthread_create(&threads[i], NULL, read_many, &wrong[i]);
  for (int i = 0; i < 4; i++) {
    pthread_join(threads[i], NULL);
    assert_int_equal(wrong[i], 0);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(values_of_every_quantity),
      cmocka_unit_test(own_units_keep_every_bit),
      cmocka_unit_test(wrong_texts_say_what_was_expected),
      cmocka_unit_test(threads_may_read_at_once),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
