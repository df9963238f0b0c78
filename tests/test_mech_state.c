// SPDX-License-Identifier: GPL-3.0-or-later
// Which node is told when numbers are lost.
#include "small_body.h"

// The first that can move, although forces carry what is lost to held ones, which are numbered before it; else a held one.
static void a_node_that_moves_is_told_first(void **state)
{
  (void)state;
  small_body body;
  body_open(&body, block_of(3, 3, 3, 3, 0.2), 50);
  body_hold(&body, "z0", 1, 1, 1);
  body_hold(&body, "x0", 1, 0, 0);
  body_build(&body);
  const vsc_model *model = body.model;
  const size_t count = model->node_count;
  size_t held = count, slides = count, last = count;
  for (size_t n = 0; n < count; n++) {
    const double *inverse = model->inverse_mass + 4 * n;
    if (inverse[2] > 0 && held < count) last = n;
    if (inverse[2] > 0 && inverse[0] == 0 && held < count && slides == count) slides = n;
    if (inverse[2] == 0 && held == count) held = n;
  }
  assert_true(held < slides && slides < last && last < count);
  assert_int_equal(vsc_state_find_bad(model, body.state), count);
  body.state->v[4 * held + 1] = NAN;
  assert_int_equal(vsc_state_find_bad(model, body.state), held);
  body.state->x[4 * last] = INFINITY;
  assert_int_equal(vsc_state_find_bad(model, body.state), last);
  body.state->v[4 * slides + 2] = NAN;
  assert_int_equal(vsc_state_find_bad(model, body.state), slides);
  body_close(&body);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_node_that_moves_is_told_first),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
