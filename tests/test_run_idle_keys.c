// SPDX-License-Identifier: GPL-3.0-or-later
// Which keys each method does not look at.
#include <string.h>

#include "close.h"
#include "run/idle_keys.h"

// Every key with a value of its own.
static vsc_scene busy_scene(vsc_solve_kind kind)
{
  vsc_scene scene = {.definition = vsc_default_definition(), .prestress = vsc_default_prestress()};
  vsc_definition *d = &scene.definition;
  d->solve = (vsc_solve_def){.kind = kind, .method = VSC_STATICS_RELAXATION, .linear = VSC_LINEAR_DIRECT,
                             .scheme = VSC_SCHEME_TRAPEZOID, .rho = 0.1, .accuracy = 1e-3, .tolerance = 1e-5};
  d->masses = VSC_MASS_EQUAL;
  d->step = 0.1;
  d->force_step = true;
  d->safety = 0.5;
  return scene;
}

static void assert_idle(const vsc_scene *scene, int count, const char *expected)
{
  char keys[VSC_IDLE_KEYS];
  assert_int_equal(vsc_idle_keys(scene, keys), count);
  assert_string_equal(keys, expected);
}

static void what_explicit_steps_do_not_look_at(void **state)
{
  (void)state;
  vsc_scene scene = busy_scene(VSC_SOLVE_EXPLICIT);
  assert_idle(&scene, 6, "solver.method, solver.scheme, solver.rho, solver.accuracy, solver.linear, solver.tolerance");
  scene.prestress.loaded = true;  // found by Newton's method
  assert_idle(&scene, 4, "solver.method, solver.scheme, solver.rho, solver.accuracy");
}

static void what_implicit_steps_do_not_look_at(void **state)
{
  (void)state;
  vsc_scene scene = busy_scene(VSC_SOLVE_IMPLICIT);
  assert_idle(&scene, 5, "solver.method, solver.rho, solver.accuracy, time.force, time.safety");
  scene.definition.solve.scheme = VSC_SCHEME_GENERALIZED_ALPHA;
  scene.definition.step = 0;
  assert_idle(&scene, 3, "solver.method, time.force, time.safety");
}

static void what_equilibria_do_not_look_at(void **state)
{
  (void)state;
  vsc_scene scene = busy_scene(VSC_SOLVE_EQUILIBRIUM);
  assert_idle(&scene, 7, "solver.scheme, solver.rho, solver.accuracy, solver.linear, masses, time.step, time.force");
  scene.definition.solve.method = VSC_STATICS_NEWTON;
  assert_idle(&scene, 7, "solver.scheme, solver.rho, solver.accuracy, masses, time.step, time.force, time.safety");
}

static void keys_of_what_is_not_asked_for(void **state)
{
  (void)state;
  vsc_scene scene = {.definition = vsc_default_definition(), .prestress = {.time = 5, .tolerance = 1, .iterations = 3}};
  scene.definition.cycle_tolerance = scene.definition.most_added_mass = 0.5;
  scene.definition.force_step = true;
  assert_idle(&scene, 6, "prestress.time, prestress.tolerance, prestress.iterations, time.cycle_tolerance, "
                         "time.most_added_mass, time.force");
  scene.prestress.loaded = true;
  scene.definition.cycle = scene.definition.mass_scaling = scene.definition.step = 1;
  assert_idle(&scene, 0, "");
}

static void nothing_is_idle_that_is_not_given(void **state)
{
  (void)state;
  vsc_scene scene = {.definition = vsc_default_definition(), .prestress = vsc_default_prestress()};
  for (int kind = VSC_SOLVE_EXPLICIT; kind <= VSC_SOLVE_EQUILIBRIUM; kind++) {
    scene.definition.solve.kind = (vsc_solve_kind)kind;
    assert_idle(&scene, 0, "");
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(what_explicit_steps_do_not_look_at),
      cmocka_unit_test(what_implicit_steps_do_not_look_at),
      cmocka_unit_test(what_equilibria_do_not_look_at),
      cmocka_unit_test(keys_of_what_is_not_asked_for),
      cmocka_unit_test(nothing_is_idle_that_is_not_given),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
