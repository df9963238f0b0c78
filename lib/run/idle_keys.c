// SPDX-License-Identifier: GPL-3.0-or-later
#include "run/idle_keys.h"

#include <stdio.h>

typedef struct idle_key {
  const char *name;
  bool given, used;
} idle_key;

int vsc_idle_keys(const vsc_scene *scene, char keys[VSC_IDLE_KEYS])
{
  const vsc_definition *d = &scene->definition, usual = vsc_default_definition();
  const vsc_prestress_def usual_prestress = vsc_default_prestress();
  const vsc_solve_def *solve = &d->solve;
  const bool implicit = solve->kind == VSC_SOLVE_IMPLICIT, rests = solve->kind == VSC_SOLVE_EQUILIBRIUM;
  const bool relaxes = rests && solve->method == VSC_STATICS_RELAXATION, steps = !rests && !implicit;
  // the shape at rest is always found by Newton's method
  const bool newton = implicit || (rests && !relaxes) || scene->prestress.loaded;
  const idle_key all[] = {
      {"solver.method", solve->method != usual.solve.method, rests},
      {"solver.scheme", solve->scheme != usual.solve.scheme, implicit},
      {"solver.rho", solve->rho != usual.solve.rho, implicit && solve->scheme == VSC_SCHEME_GENERALIZED_ALPHA},
      {"solver.accuracy", solve->accuracy != usual.solve.accuracy, implicit && d->step == 0},
      {"solver.linear", solve->linear != usual.solve.linear, newton},
      {"solver.tolerance", solve->tolerance != usual.solve.tolerance, newton || relaxes},
      {"masses", d->masses != usual.masses, !rests},
      {"prestress.time", scene->prestress.time != 0, scene->prestress.loaded},
      {"prestress.tolerance", scene->prestress.tolerance != usual_prestress.tolerance, scene->prestress.loaded},
      {"prestress.iterations", scene->prestress.iterations != usual_prestress.iterations, scene->prestress.loaded},
      {"time.cycle_tolerance", d->cycle_tolerance != usual.cycle_tolerance, d->cycle > 0},
      {"time.most_added_mass", d->most_added_mass != usual.most_added_mass, d->mass_scaling > 0},
      {"time.step", d->step != usual.step, !rests},
      {"time.force", d->force_step != usual.force_step, steps && d->step > 0},
      {"time.safety", d->safety != usual.safety, steps || relaxes},
  };
  int count = 0;
  size_t length = 0;
  keys[0] = '\0';
  for (size_t k = 0; k < sizeof all / sizeof all[0]; k++) {
    if (!all[k].given || all[k].used) continue;
    length += (size_t)snprintf(keys + length, VSC_IDLE_KEYS - length, "%s%s", count > 0 ? ", " : "", all[k].name);
    count++;
  }
  return count;
}
