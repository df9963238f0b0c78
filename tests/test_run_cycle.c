// SPDX-License-Identifier: GPL-3.0-or-later
// How far a cycle differs from the one before, by hand.
#include "base/mem.h"
#include "run/cycle.h"
#include "small_body.h"

static void put(small_body *body, double place, double speed)
{
  for (size_t n = 0; n < body->model->node_count; n++) {
    body->state->x[4 * n] = body->model->rest[4 * n] + place;
    body->state->v[4 * n] = speed;
  }
}

// Moved as a whole, a body's root of mean squares is the way itself.
static void places_and_velocities_count(void **state)
{
  (void)state;
  small_body body;
  vsc_cycle cycle;
  body_open(&body, block_of(1, 1, 1, 1, 0), 50);
  body_build(&body);
  assert_int_equal(vsc_cycle_begin(body.model, body.state, &cycle, NULL), VSC_OK);
  // place and speed in the middle and at the end of each cycle, and the difference of that
  static const double cycles[][5] = {{2, 3, 0, 1, 1},       // the first one tells nothing
                                     {4, 5, 0, 1, 0},       // the same end
                                     {4, 5, 1, 1, 0.25},    // 1 of 4 mm
                                     {5, 10, 1, 3, 0.2},    // 2 of 10 mm/ms; the stroke is from 1 to 5
                                     {1, 3, 1, 3, 1}};      // nothing has moved
  for (size_t k = 0; k < sizeof cycles / sizeof cycles[0]; k++) {
    const double *c = cycles[k];
    for (int part = 0; part < 2; part++) {
      put(&body, c[2 * part], c[2 * part + 1]);
      vsc_cycle_look(body.model, body.state, &cycle);
    }
    vsc_cycle_end(body.model, body.state, &cycle);
    assert_close(cycle.difference, c[4], 1e-12, 1e-12);
    assert_close(cycle.ended, (double)k + 1, 0, 0);
  }
  vsc_free(cycle.kept);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(places_and_velocities_count)};
  return cmocka_run_group_tests(tests, NULL, NULL);
}
