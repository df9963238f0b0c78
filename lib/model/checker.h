// SPDX-License-Identifier: GPL-3.0-or-later
// What the checks of a definition are made of. Internal to model.
#ifndef VSC_MODEL_CHECKER_H
#define VSC_MODEL_CHECKER_H

#include <math.h>
#include <stdio.h>

#include "model/definition.h"

// Where the check is, and the first failure, after which further demands are not looked at.
typedef struct vsc_checker {
  char where[160];  // prefix of the keys: "materials[0]"
  vsc_error *error;
  vsc_status status;
} vsc_checker;

static inline void enter(vsc_checker *c, const char *list, size_t item, const char *rest)
{
  snprintf(c->where, sizeof c->where, "%s[%zu]%s", list, item, rest);
}

// Demands that `fine` holds for the number `value` (in `unit`) of `key`.
static inline void need(vsc_checker *c, bool fine, const char *key, double value, const char *unit,
                 const char *remedy)
{
  if (c->status != VSC_OK || fine) return;
  c->status =
      vsc_fail(c->error, VSC_INPUT, "%s%s%s: %g%s%s: %s", c->where, c->where[0] != '\0' ? "." : "",
               key, value, unit[0] != '\0' ? " " : "", unit, remedy);
}

// Demands that `value` is one of an enumeration from 0 to `last`: callers in C can miss it.
static inline void need_kind(vsc_checker *c, const char *key, int value, int last)
{
  need(c, value >= 0 && value <= last, key, value, "", "no such kind; take one that its header names");
}

static inline void need_positive(vsc_checker *c, const char *key, double value, const char *unit,
                          const char *remedy)
{
  need(c, isfinite(value) && value > 0, key, value, unit, remedy);
}

static inline void need_not_negative(vsc_checker *c, const char *key, double value, const char *unit)
{
  need(c, isfinite(value) && value >= 0, key, value, unit, "give a value of zero or more");
}

static inline void need_finite(vsc_checker *c, const char *key, double value, const char *unit)
{
  need(c, isfinite(value), key, value, unit, "give a finite value");
}

static inline void need_finite3(vsc_checker *c, const char *key, const double value[3], const char *unit)
{
  for (int i = 0; i < 3; i++) need_finite(c, key, value[i], unit);
}

// Demands that `name`, which `key` has, is one of `count` selectors: surfaces, of which "boundary" is always one, or node sets.
void vsc_check_known(vsc_checker *c, const char *key, const char *name, const vsc_selector *selectors,
                     size_t count, bool surface);

void vsc_check_curve(vsc_checker *c, const vsc_curve_def *curve);  // below the key where the checker is

// Supports, robin, pressures, obstacles, gravity, the initial velocity.
void vsc_check_loads(vsc_checker *c, const vsc_definition *definition);

#endif
