// SPDX-License-Identifier: GPL-3.0-or-later
// The estimate of the stable step on bodies of many elements, against what it comes to after many more iterations.
#include "base/hash.h"
#include "mech/step_limit.h"
#include "small_body.h"
#include "trap.h"

enum { CELLS = 16, TETS = 6 * CELLS * CELLS * CELLS };

// A regular block of 24,576 tets, of which one node of a tet in the middle has gone `part` of its way to the opposite
// face. Returns the tet.
static size_t open_block(small_body *body, double part, double damping)
{
  vsc_mesh *mesh = block_of(CELLS, CELLS, CELLS, 1, 0);
  const size_t tet = TETS / 2 + CELLS / 2;
  const uint32_t *node = mesh->corners + 4 * tet;
  for (size_t i = 0; i < 3; i++) {
    double centre = 0;
    for (int c = 1; c < 4; c++) centre += mesh->nodes[3 * (size_t)node[c] + i] / 3;
    mesh->nodes[3 * (size_t)node[0] + i] += part * (centre - mesh->nodes[3 * (size_t)node[0] + i]);
  }
  body_open(body, mesh, 100);
  for (int a = 0; a < 3; a++) body->material.damping[a] = damping;
  body->definition.safety = 1;
  body_fibers(body, (double[3]){1, 0, 0});
  body_build(body);
  return tet;
}

static void close_block(small_body *body)
{
  vsc_state_free(body->state);
  vsc_model_free(body->model);
  vsc_axes_free(body->axes);
  vsc_mesh_free(body->mesh);
}

// A first estimate from the `draw`-th random vector.
static double first_estimate(small_body *body, int draw)
{
  vsc_limit *limit = &body->state->limit;
  memset(limit->mode, 0, 4 * body->model->node_count * sizeof *limit->mode);
  limit->step = 0;
  limit->refreshes = 1000 * draw;
  vsc_limit_refresh(body->model, body->state, 0, vsc_limit_enough(body->model));
  return limit->eigenvalue;
}

// What 40 more iterations, three times, make of it.
static double settled_estimate(small_body *body)
{
  for (int k = 0; k < 3; k++) vsc_limit_refresh(body->model, body->state, 0, 40);
  return body->state->limit.eigenvalue;
}

static bool is_corner(const small_body *body, size_t tet, uint32_t mesh_node)
{
  for (int c = 0; c < 4; c++)
    if (body->mesh->corners[4 * tet + (size_t)c] == mesh_node) return true;
  return false;
}

// One stiff element among many, from one that is little stiffer than the others to a sliver: none of a few random
// vectors misses it, and the step is that of its motion. In a random vector its motion has a part of a hundredth.
static void one_stiff_element_is_found_among_many(void **state)
{
  (void)state;
  static const double parts[] = {0.65, 0.75, 0.9, 0.98};
  enum { DRAWS = 3 };
  small_body body;
  open_block(&body, 0, 0);
  const double regular = (first_estimate(&body, 0), settled_estimate(&body));
  close_block(&body);
  for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++) {
    double lowest = INFINITY, highest = 0;
    const size_t tet = open_block(&body, parts[k], 0);
    for (int draw = 0; draw < DRAWS; draw++) {
      const double estimate = first_estimate(&body, draw);
      lowest = fmin(lowest, estimate);
      highest = fmax(highest, estimate);
    }
    const double settled = settled_estimate(&body);
    const size_t stiffest = vsc_largest_node(body.model, body.state->limit.mode);
    printf("%.3g times the regular block's: estimates from %.4f to %.4f of it\n", settled / regular,
           lowest / settled, highest / settled);
    assert_true(settled > 1.1 * regular);
    assert_true(is_corner(&body, tet, body.model->mesh_node[stiffest]));
    assert_true(highest <= settled * (1 + 1e-4));  // displacements are 5e-5 of the height of the sliver
    // 0.909 would be too little for the step
    assert_true(lowest > 0.95 * settled);
    close_block(&body);
  }
}

// Of a regular block, whose stiffest motions are as many as its nodes and nearly as stiff: within a few hundredths.
static void the_first_estimate_is_good_where_many_are_as_stiff(void **state)
{
  (void)state;
  static const double dampings[] = {0, 0.05, 5};
  for (int k = 0; k < 3; k++) {
    small_body body;
    open_block(&body, 0, dampings[k]);
    const double estimate = first_estimate(&body, 0), settled = settled_estimate(&body);
    printf("damping %g: %.4f of what it comes to\n", dampings[k], estimate / settled);
    assert_true(estimate <= settled * (1 + 1e-5) && estimate > 0.97 * settled);
    close_block(&body);
  }
}

// Sums over the nodes go in pieces whose order no thread changes.
static void threads_do_not_change_its_bits(void **state)
{
  (void)state;
  vsc_limit limits[2];
  uint64_t modes[2];
  for (int k = 0; k < 2; k++) {
    small_body body;
    vsc_parallel_set_threads(1 + 2 * k);
    open_block(&body, 0.6, 0.05);
    first_estimate(&body, 0);
    vsc_limit_refresh(body.model, body.state, 0, 4);
    limits[k] = body.state->limit;
    modes[k] = vsc_hash(VSC_HASH_START, limits[k].mode, 4 * body.model->node_count * sizeof(double));
    close_block(&body);
  }
  vsc_parallel_set_threads(1);
  assert_true(limits[0].eigenvalue == limits[1].eigenvalue && limits[0].step == limits[1].step);
  assert_true(modes[0] == modes[1]);
}

// A body ten metres away, where positions are only known to a millionth of what they are moved by: its step is as
// that at home, to what the last bits of so many positions make of its rest shape.
static void far_away_it_is_the_same(void **state)
{
  (void)state;
  double step[2];
  for (int k = 0; k < 2; k++) {
    small_body body;
    vsc_mesh *mesh = block_of(4, 4, 4, 1, 0.2);
    for (size_t i = 0; i < 3 * mesh->node_count; i++) mesh->nodes[i] += k * 1e4;
    body_open(&body, mesh, 100);
    body_fibers(&body, (double[3]){1, 0, 0});
    body_build(&body);
    first_estimate(&body, 0);
    step[k] = (settled_estimate(&body), body.state->limit.step);
    close_block(&body);
  }
  assert_close(step[1], step[0], 1e-6, 0);
}

int main(void)
{
  vsc_parallel_set_threads(1);
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(one_stiff_element_is_found_among_many),
      cmocka_unit_test(the_first_estimate_is_good_where_many_are_as_stiff),
      cmocka_unit_test(threads_do_not_change_its_bits),
      cmocka_unit_test(far_away_it_is_the_same),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
