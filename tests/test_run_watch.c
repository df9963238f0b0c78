// SPDX-License-Identifier: GPL-3.0-or-later
// When the watch takes a body for coming apart: each of its bounds, just before it and behind it.
#include "block_scene.h"
#include "run/watch.h"

typedef struct watched {
  vsc_problem *problem;
  vsc_state *body;
  vsc_watch *watch;
} watched;

// The block without loads, at rest, after its first two looks: from then on its balance counts.
static watched open_block(const char *setting)
{
  watched w;
  vsc_error error;
  const char *const settings[] = {"pressures=[]", "materials[0].active.tension=0 kPa", setting};
  if (vsc_problem_load(in_folder("block.yaml"), settings, 3, &w.problem, &error) != VSC_OK ||
      vsc_problem_start(w.problem, &w.body, &error) != VSC_OK ||
      vsc_watch_open(w.problem, "/dev/null", -1, &w.watch, &error) != VSC_OK)
    fail_msg("%s", error.text);
  for (int look = 0; look < 2; look++)
    assert_int_equal(vsc_watch_observe(w.problem, w.body, w.watch, &error), VSC_OK);
  return w;
}

static void close_block(watched *w)
{
  vsc_watch_free(w->watch);
  vsc_state_free(w->body);
  vsc_problem_free(w->problem);
}

// The next look, after a part of the energy's scale has gone nowhere.
static vsc_status look_after(watched *w, double part, vsc_error *error)
{
  w->watch->ledger->dissipated += part * w->watch->energy_scale;
  return vsc_watch_observe(w->problem, w->body, w->watch, error);
}

static void the_balance_may_jump_by_a_twentieth(void **state)
{
  (void)state;
  vsc_error error;
  for (int sign = -1; sign < 2; sign += 2) {
    watched w = open_block("time.end=10 ms");
    assert_int_equal(look_after(&w, sign * 0.049, &error), VSC_OK);
    assert_int_equal(look_after(&w, -sign * 0.051, &error), VSC_NUMERICAL);
    assert_holds(error.text, "the energy balance jumped by ");
    close_block(&w);
  }
}

static void the_balance_may_be_off_by_a_tenth(void **state)
{
  (void)state;
  vsc_error error;
  for (int sign = -1; sign < 2; sign += 2) {
    watched w = open_block("time.end=10 ms");
    assert_int_equal(look_after(&w, sign * 0.045, &error), VSC_OK);
    assert_int_equal(look_after(&w, sign * 0.045, &error), VSC_OK);
    assert_int_equal(look_after(&w, sign * 0.009, &error), VSC_OK);
    assert_int_equal(look_after(&w, sign * 0.002, &error), VSC_NUMERICAL);
    assert_holds(error.text, "the energy balance is off by ");
    close_block(&w);
  }
}

// Blown up by `stretch`, or turned inside out.
static vsc_status look_at_stretched(double stretch, vsc_error *error)
{
  watched w = open_block("time={end: 10 ms, step: 0.001 ms, force: true}");
  for (size_t i = 0; i < 4 * w.problem->model->node_count; i++) w.body->x[i] = stretch * w.problem->model->rest[i];
  const vsc_status status = vsc_watch_observe(w.problem, w.body, w.watch, error);
  close_block(&w);
  return status;
}

// Where the balance may jump, as with a forced step, volumes may not be a thousand times what they were.
static void volumes_are_bounded(void **state)
{
  (void)state;
  vsc_error error;
  for (int sign = -1; sign < 2; sign += 2) {
    assert_int_equal(look_at_stretched(9.99 * sign, &error), VSC_OK);
    assert_int_equal(look_at_stretched(10.01 * sign, &error), VSC_NUMERICAL);
    assert_holds(error.text, " times their volume");
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(the_balance_may_jump_by_a_twentieth),
      cmocka_unit_test(the_balance_may_be_off_by_a_tenth),
      cmocka_unit_test(volumes_are_bounded),
  };
  return cmocka_run_group_tests(tests, block_open, program_close);
}
