// SPDX-License-Identifier: GPL-3.0-or-later
// Texts such as "60 kPa" turned into the library's units (mm, ms, mg, kPa, radians) by udunits2.
#ifndef VSC_IO_UNITS_H
#define VSC_IO_UNITS_H

#include "base/status.h"

typedef enum vsc_quantity {
  VSC_LENGTH,        // mm
  VSC_TIME,          // ms
  VSC_PRESSURE,      // kPa (also moduli and tensions)
  VSC_DENSITY,       // mg/mm^3
  VSC_VISCOSITY,     // kPa ms
  VSC_VELOCITY,      // mm/ms
  VSC_ACCELERATION,  // mm/ms^2
  VSC_STIFFNESS,     // mN/mm, of a spring
  VSC_DAMPER,        // mN ms/mm, of a damper
  VSC_FORCE,         // mN
  VSC_RIGIDITY,      // mN mm, of a plate against bending
  VSC_BED_STIFFNESS, // kPa/mm, of springs per area
  VSC_BED_DAMPING,   // kPa ms/mm, of dashpots per area
  VSC_RATE,          // 1/ms
  VSC_ANGLE,         // radians
  VSC_NUMBER,        // no unit
} vsc_quantity;

// Reads `text` as a value of the given quantity. A bare number where a unit is needed, a unit of
// another dimension or an unknown unit fails with VSC_INPUT; the message says what was expected
// with an example, and does not name the key: the caller prefixes it.
vsc_status vsc_units_read(const char *text, vsc_quantity quantity, double *value, vsc_error *error);

// The library's unit of a quantity as text that vsc_units_read reads: "mm", "kPa", ...
const char *vsc_units_name(vsc_quantity quantity);

#endif
