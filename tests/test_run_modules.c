// SPDX-License-Identifier: GPL-3.0-or-later
// What a run loads: explicit steps neither CHOLMOD nor HDF5 nor what these need, before they are wanted.
#include <dlfcn.h>
#include <stdbool.h>

#include "base/module.h"
#include "block_scene.h"
#include "io/checkpoint.h"
#include "run/problem.h"
#include "solve/solve.h"

static bool is_loaded(const char *library)
{
  static char maps[PROGRAM_TEXT];
  FILE *stream = fopen("/proc/self/maps", "r");
  if (stream == NULL) fail_msg("no maps");
  maps[fread(maps, 1, sizeof maps - 1, stream)] = '\0';
  fclose(stream);
  return strstr(maps, library) != NULL;
}

// What CHOLMOD and HDF5 bring with them, as the linker names it.
static void assert_loaded(bool cholmod, bool hdf5)
{
  static const char *const of_cholmod[] = {"/libcholmod", "/libmetis", "/libgomp"};
  for (size_t k = 0; k < sizeof of_cholmod / sizeof of_cholmod[0]; k++)
    if (is_loaded(of_cholmod[k]) != cholmod) fail_msg("%s: loaded %d", of_cholmod[k], !cholmod);
  assert_int_equal(is_loaded("/libhdf5"), hdf5);
}

// The first millisecond of the scene, with one key of it changed.
static void simulate(const char *setting)
{
  vsc_problem *problem;
  vsc_state *state;
  vsc_error error;
  if (vsc_problem_load(in_folder("block.yaml"), &setting, 1, &problem, &error) != VSC_OK ||
      vsc_problem_start(problem, &state, &error) != VSC_OK ||
      vsc_solve_start(problem->model, state, &error) != VSC_OK ||
      vsc_solve_to(problem->model, state, 1, &error) != VSC_OK)
    fail_msg("%s", error.text);
  vsc_state_free(state);
  vsc_problem_free(problem);
}

static void test_explicit_steps_load_neither(void **state)
{
  (void)state;
  assert_loaded(false, false);
  simulate("solve=explicit");
  assert_loaded(false, false);
}

// A start that brings what steps will need, and no step: other threads may run beside these.
static void start(const char *setting)
{
  vsc_problem *problem;
  vsc_state *state;
  vsc_error error;
  if (vsc_problem_load(in_folder("block.yaml"), &setting, 1, &problem, &error) != VSC_OK ||
      vsc_problem_start(problem, &state, &error) != VSC_OK ||
      vsc_solve_start(problem->model, state, &error) != VSC_OK)
    fail_msg("%s", error.text);
  vsc_state_free(state);
  vsc_problem_free(problem);
}

// libgomp takes its limit from the environment, which afterwards is as it was. Kept volumes need it in explicit steps.
static void test_cholmod_comes_alone(void **state)
{
  (void)state;
  unsetenv("OMP_THREAD_LIMIT");
  setenv("OPENBLAS_NUM_THREADS", "1", 1);
  start("keep_volume=total");
  assert_loaded(true, false);
  assert_null(getenv("OMP_THREAD_LIMIT"));
  assert_string_equal(getenv("OPENBLAS_NUM_THREADS"), "1");
  void *gomp = dlopen("libgomp.so.1", RTLD_LAZY | RTLD_NOLOAD);
  assert_non_null(gomp);
  int (*limit)(void);
  *(void **)&limit = dlsym(gomp, "omp_get_thread_limit");
  assert_non_null(limit);
  assert_int_equal(limit(), 1);
  dlclose(gomp);
}

static void test_checkpoints_load_hdf5(void **state)
{
  (void)state;
  double value = 1;
  const vsc_block block = {"block", "1", 1, 1, &value};
  assert_int_equal(vsc_checkpoint_write(in_folder("one.h5"), 1, 1, &block, NULL), VSC_OK);
  assert_loaded(true, true);
}

#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__  // which need all the address space
// With however little address space (kB) a run comes to an end: OpenBLAS would ask for its own for ever.
static void test_short_address_space(void **state)
{
  (void)state;
  int short_ones = 0;
  for (int space = 80000; space <= 400000; space += 20000) {
    char command[256];
    snprintf(command, sizeof command, "ulimit -v %d; timeout -s KILL 60 $V run block.yaml -q -t 1 -o little --set "
             "solve=equilibrium --set solver.linear=direct --set 'time.end=1 ms'", space);
    const int code = shell(command);
    if (code != 0 && code != 4) fail_msg("%d kB: exit code %d: %s", space, code, complained);
    short_ones += strstr(complained, "does not fit into memory") != NULL;
  }
  assert_true(short_ones > 0);
  must("$V run block.yaml -q -t 1 -o little --set solve=equilibrium --set solver.linear=direct --set 'time.end=1 ms'");
}
#endif

static void test_missing_modules_are_named(void **state)
{
  (void)state;
  const void *table = state;
  vsc_error error;
  assert_int_equal(vsc_module_load("nothing", "libnothing-dev", &table, &error), VSC_SYSTEM);
  assert_null(table);
  assert_holds(error.text, "the module nothing cannot be loaded");
  assert_holds(error.text, "viscera/nothing.so: cannot open");
  assert_holds(error.text, "libnothing-dev");
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_explicit_steps_load_neither),
      cmocka_unit_test(test_cholmod_comes_alone),
      cmocka_unit_test(test_checkpoints_load_hdf5),
      cmocka_unit_test(test_missing_modules_are_named),
#if !defined __SANITIZE_ADDRESS__ && !defined __SANITIZE_THREAD__
      cmocka_unit_test(test_short_address_space),
#endif
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
