// SPDX-License-Identifier: GPL-3.0-or-later
// The constants of a tissue law by name: for what checks and prints them.
#ifndef VSC_MODEL_LAW_CONSTANTS_H
#define VSC_MODEL_LAW_CONSTANTS_H

#include "model/definition.h"

enum { VSC_MOST_CONSTANTS = 12 };

typedef struct vsc_law_constant {
  const char *key;   // as the scene writes it: "guccione.bf"
  const char *unit;  // "kPa", or "" for a number
  double value;
  bool positive;     // above zero, else zero or more
  double most;       // INFINITY where any is fine
} vsc_law_constant;

// Fills `list` and returns how many constants the law has; 0 for those that are no tissue laws.
size_t vsc_law_constants(const vsc_material_def *material,
                         vsc_law_constant list[VSC_MOST_CONSTANTS]);

// Whether the law has exponentials, so that it stiffens as it is strained, up to VSC_LARGEST_EXPONENT (model/law_exponential.h).
static inline bool vsc_law_has_exponent(vsc_law law)
{
  return law == VSC_LAW_GUCCIONE || law == VSC_LAW_FUNG || law == VSC_LAW_HOLZAPFEL_OGDEN || law == VSC_LAW_VERONDA_WESTMANN;
}

// Whether springs along the axes with their couplings and K resist every change of length: the leading
// minors of E_a delta_ab + H_ab + K are positive. True without couplings.
bool vsc_couplings_hold(const vsc_material_def *material);

#endif
