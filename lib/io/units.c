// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/units.h"

#include <ctype.h>
#include <math.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <udunits2.h>

#include "base/text.h"

enum { COMMON_UNITS = 12, LONGEST_VALUE = 100 };

typedef struct quantity {
  const char *unit;  // the library's own
  const char *noun;
  const char *example;
  const char *common[COMMON_UNITS];  // what people write, to guess what a mistyped one meant
} quantity;

static const quantity quantities[] = {
    [VSC_LENGTH] = {"mm", "a length", "3 mm", {"mm", "cm", "m", "um", "nm", "inch"}},
    [VSC_TIME] = {"ms", "a time", "0.8 s", {"ms", "s", "us", "min", "second", "hour"}},
    [VSC_PRESSURE] = {"kPa",
                      "a pressure",
                      "60 kPa",
                      {"kPa", "Pa", "MPa", "GPa", "mmHg", "N/m2", "N/mm2", "N/cm2", "bar",
                       "cmH2O"}},
    [VSC_DENSITY] = {"mg/mm3",
                     "a density",
                     "1.06 g/cm3",
                     {"g/cm3", "kg/m3", "mg/mm3", "g/mL", "kg/L", "g/mm3"}},
    [VSC_VISCOSITY] = {"kPa ms",
                       "a viscosity",
                       "10 Pa s",
                       {"Pa s", "kPa ms", "kPa s", "mPa s", "MPa ms", "poise"}},
    [VSC_VELOCITY] = {"mm/ms", "a velocity", "0.5 m/s", {"m/s", "mm/ms", "mm/s", "cm/s", "km/h"}},
    [VSC_ACCELERATION] = {"mm/ms2",
                          "an acceleration",
                          "9.81 m/s2",
                          {"m/s2", "mm/ms2", "mm/s2", "cm/s2"}},
    [VSC_STIFFNESS] = {"mN/mm", "a spring's stiffness", "20 N/m", {"N/m", "mN/mm", "N/mm", "kN/m"}},
    [VSC_DAMPER] = {"mN ms/mm",
                    "a damper's constant",
                    "0.01 N s/m",
                    {"N s/m", "mN ms/mm", "kg/s", "mN s/mm"}},
    [VSC_FORCE] = {"mN", "a force", "50 mN", {"mN", "N", "kN", "uN"}},
    [VSC_RIGIDITY] = {"mN mm", "a bending rigidity", "2 mN mm", {"mN mm", "N m", "N mm", "uN m"}},
    [VSC_BED_STIFFNESS] = {"kPa/mm",
                           "a stiffness per area",
                           "1e5 Pa/m",
                           {"Pa/m", "kPa/m", "kPa/mm", "kPa/cm", "N/m3", "N/mm3", "mmHg/mm"}},
    [VSC_BED_DAMPING] = {"kPa ms/mm",
                         "a damping per area",
                         "5e3 Pa s/m",
                         {"Pa s/m", "kPa s/m", "kPa ms/mm", "kPa s/mm", "N s/m3", "N s/mm3"}},
    [VSC_RATE] = {"1/ms", "a rate", "5 1/s", {"1/s", "1/ms", "Hz", "kHz"}},
    [VSC_ANGLE] = {"rad", "an angle", "35 deg", {"deg", "degree", "rad", "radian", "mrad"}},
    [VSC_NUMBER] = {"", "a plain number", "0.8", {NULL}},
};

// udunits2 parses with global state, so one thread at a time.
static pthread_once_t once = PTHREAD_ONCE_INIT;
static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static ut_system *units;

static void read_units(void)
{
  ut_set_error_message_handler(ut_ignore);
  units = ut_read_xml(NULL);
  if (units == NULL) return;
  ut_unit *degree = ut_get_unit_by_name(units, "degree");
  if (degree == NULL || ut_map_name_to_unit("deg", UT_ASCII, degree) != UT_SUCCESS) {
    ut_free_system(units);
    units = NULL;
  }
  ut_free(degree);
}

const char *vsc_units_name(vsc_quantity kind)
{
  return quantities[kind].unit;
}

// `unit` is `own` times a number. (ut_are_convertible would also take 10 Hz for 0.1 s, converters
// would count time from "since 2000-01-01", and to udunits2 an angle is any plain number.)
static bool same_dimension(const ut_unit *unit, const ut_unit *own, vsc_quantity kind)
{
  char text[64];
  const int length = ut_format(unit, text, sizeof text, UT_ASCII | UT_DEFINITION);
  if (length < 0 || (size_t)length >= sizeof text || strchr(text, '@') != NULL) return false;
  if (kind == VSC_ANGLE && strstr(text, "rad") == NULL) return false;
  ut_unit *ratio = ut_divide(unit, own);
  if (ratio == NULL) return false;
  const bool same = ut_is_dimensionless(ratio);
  ut_free(ratio);
  return same;
}

// Whether a digit is an exponent's: behind a letter (or a byte of one), another digit, ^ or **, perhaps with a sign.
static bool is_exponent(const char *unit, const char *digit)
{
  const size_t length = (size_t)(digit - unit);
  const bool is_signed = length > 0 && (digit[-1] == '-' || digit[-1] == '+');
  if (length < 1 + (size_t)is_signed) return false;
  const char *before = digit - 1 - is_signed;
  if (*before == '*') return before > unit && before[-1] == '*';
  if (before > unit && strncmp(before - 1, "·", 2) == 0) return false;
  return isalnum((unsigned char)*before) || (unsigned char)*before > 127 || *before == '^';
}

// What udunits2 would multiply by although no user means it: "3 4 kPa", "20 kPa 3". A rate may begin with 1/.
static bool has_number(const char *unit, vsc_quantity kind)
{
  if (kind == VSC_RATE && strncmp(unit, "1/", 2) == 0) unit += 2;
  for (const char *c = unit; *c != '\0'; c++)
    if (isdigit((unsigned char)*c) && !is_exponent(unit, c)) return true;
  return false;
}

// What else it would take: "kPa)".
static bool is_plain(const char *unit)
{
  int open = 0;
  for (const char *c = unit; *c != '\0' && open >= 0; c++) open += (*c == '(') - (*c == ')');
  return open == 0 && strchr(".+-,", unit[0]) == NULL;
}

typedef enum outcome { CONVERTED, SECOND_NUMBER, UNKNOWN_UNIT, OTHER_DIMENSION } outcome;

static outcome convert(const char *text, vsc_quantity kind, double *value)
{
  if (has_number(text, kind)) return SECOND_NUMBER;
  if (!is_plain(text)) return UNKNOWN_UNIT;
  ut_unit *unit = ut_parse(units, text, UT_UTF8);
  if (unit == NULL) return UNKNOWN_UNIT;
  ut_unit *own = ut_parse(units, quantities[kind].unit, UT_ASCII);
  outcome result = OTHER_DIMENSION;
  if (own != NULL && same_dimension(unit, own, kind)) {
    cv_converter *converter = ut_get_converter(unit, own);
    if (converter != NULL) {
      if (ut_compare(unit, own) != 0) *value = cv_convert_double(converter, *value);
      cv_free(converter);
      result = CONVERTED;
    }
  }
  ut_free(own);
  ut_free(unit);
  return result;
}

static vsc_status refuse_unit(const char *text, const char *unit, vsc_quantity kind, outcome why,
                              vsc_error *error)
{
  const quantity *q = &quantities[kind];
  if (why == SECOND_NUMBER)
    return vsc_fail(error, VSC_INPUT, "\"%s\": a second number; expected %s such as \"%s\"", text, q->noun, q->example);
  size_t count = 0;
  while (count < COMMON_UNITS && q->common[count] != NULL) count++;
  const char *nearest = vsc_nearest(unit, q->common, count);
  return vsc_fail(error, VSC_INPUT, "\"%s\": %s%s%s%s%s; expected %s such as \"%s\"", text,
                  why == UNKNOWN_UNIT ? "unknown unit " : "not ",
                  why == UNKNOWN_UNIT ? unit : q->noun, nearest != NULL ? " (did you mean " : "",
                  nearest != NULL ? nearest : "", nearest != NULL ? "?)" : "", q->noun, q->example);
}

// The number at the head of `text`; *rest is the trimmed remainder.
static vsc_status read_number(const char *text, const quantity *q, double *value, char *rest,
                              vsc_error *error)
{
  if (strlen(text) > LONGEST_VALUE)
    return vsc_fail(error, VSC_INPUT, "\"%.40s...\": too long; expected %s such as \"%s\"", text,
                    q->noun, q->example);
  char *end;
  *value = strtod(text, &end);
  if (end == text)
    return vsc_fail(error, VSC_INPUT, "\"%s\": no number; expected %s such as \"%s\"", text,
                    q->noun, q->example);
  if (!isfinite(*value))
    return vsc_fail(error, VSC_INPUT, "\"%s\": not a finite number; expected %s such as \"%s\"",
                    text, q->noun, q->example);
  if (*end == ',')
    return vsc_fail(error, VSC_INPUT,
                    "\"%s\": a comma; write a decimal point, expected %s such as \"%s\"", text,
                    q->noun, q->example);
  while (isspace((unsigned char)*end)) end++;
  strcpy(rest, end);
  for (size_t n = strlen(rest); n > 0 && isspace((unsigned char)rest[n - 1]); n--) rest[n - 1] = 0;
  return VSC_OK;
}

vsc_status vsc_units_read(const char *text, vsc_quantity kind, double *value, vsc_error *error)
{
  const quantity *q = &quantities[kind];
  char unit[LONGEST_VALUE + 1];
  double number = 0;
  const vsc_status status = read_number(text, q, &number, unit, error);
  if (status != VSC_OK) return status;
  if (kind == VSC_NUMBER) {
    if (unit[0] != '\0')
      return vsc_fail(error, VSC_INPUT,
                      "\"%s\": \"%s\" after the number; expected a plain number such as \"%s\"",
                      text, unit, q->example);
    *value = number;
    return VSC_OK;
  }
  if (unit[0] == '\0')
    return vsc_fail(error, VSC_INPUT, "\"%s\": no unit; expected %s such as \"%s\"", text, q->noun,
                    q->example);
  pthread_once(&once, read_units);
  if (units == NULL)
    return vsc_fail(error, VSC_SYSTEM,
                    "udunits2 cannot read its table of units: install libudunits2-data");
  pthread_mutex_lock(&lock);
  const outcome result = convert(unit, kind, &number);
  pthread_mutex_unlock(&lock);
  if (result != CONVERTED) return refuse_unit(text, unit, kind, result, error);
  if (!isfinite(number))
    return vsc_fail(error, VSC_INPUT, "\"%s\": too large; expected %s such as \"%s\"", text,
                    q->noun, q->example);
  *value = number;
  return VSC_OK;
}
