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

// In messages nodes have their numbers in the file; where these are the mesh's own the model keeps none.
static void nodes_are_called_as_in_the_file(void **state)
{
  (void)state;
  for (uint32_t before = 0; before < 8; before += 7) {
    small_body body;
    char text[VSC_NODE_TEXT], wanted[32];
    vsc_mesh *mesh = block_of(2, 2, 2, 2, 0);
    for (size_t n = 0; n < mesh->node_count; n++) mesh->node_source[n] += before;
    for (size_t e = 0; e < mesh->element_count; e++) mesh->element_source[e] += 2 * before;
    body_open(&body, mesh, 50);
    body_build(&body);
    assert_true((body.model->node_source != NULL) == (before > 0) && (body.model->element_source != NULL) == (before > 0));
    for (size_t n = 0; n < body.model->node_count; n++) {
      snprintf(wanted, sizeof wanted, "node %u, at rest at (", body.model->mesh_node[n] + before);
      assert_memory_equal(vsc_name_node(body.model, n, text, sizeof text), wanted, strlen(wanted));
    }
    body_close(&body);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_node_that_moves_is_told_first),
      cmocka_unit_test(nodes_are_called_as_in_the_file),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
