// SPDX-License-Identifier: GPL-3.0-or-later
// Collapsed and scrambled starts of every law and kind of element: bodies come back, or are told to be lost with an
// element or a node.
#include "any_body.h"
#include "mesh/wound.h"
#include "solve/explicit.h"
#include "trap.h"

// Viscous tissue, or springs with dampers along the axes, held at both ends.
static void open_held(any_body *body, int law, any_kind kind)
{
  static const size_t cells[2][3] = {{3, 3, 3}, {4, 2, 2}};
  any_open(body, any_mesh(kind, cells[kind == MIXED]), law, kind);
  body->material.volume_modulus = 100;
  body->material.stabilization = 20;
  body->material.viscosity = law == PLAIN_SPRINGS ? 0 : 3;
  for (int a = 0; a < 3 && law == PLAIN_SPRINGS; a++) body->material.damping[a] = 3;
  any_hold(body, 2);
  any_build(body);
}

static double inverted(const any_body *body)
{
  vsc_totals totals;
  vsc_ledger *ledger;
  assert_int_equal(vsc_ledger_create(body->model, &ledger, NULL), VSC_OK);
  vsc_observe(body->model, body->state, ledger, false, &totals);
  vsc_ledger_free(ledger);
  return totals.inverted;
}

static vsc_wound wound_of(const any_body *body)
{
  const size_t nodes = body->model->node_count;
  double *x = vsc_alloc(3 * nodes, sizeof *x);
  vsc_wound wound;
  for (size_t n = 0; n < nodes; n++)
    memcpy(x + 3 * (size_t)body->model->mesh_node[n], body->state->x + 4 * n, 3 * sizeof *x);
  assert_int_equal(vsc_wound_find(body->mesh, x, &wound, NULL), VSC_OK);
  vsc_free(x);
  return wound;
}

static double off_rest(const any_body *body)
{
  double most = 0;
  for (size_t i = 0; i < 4 * body->model->node_count; i++)
    most = fmax(most, fabs(body->state->x[i] - body->model->rest[i]));
  return most;
}

// What came of a start. TOLD: elements are inside out, at their frames, nodes or corners. WOUND: none is, but edges are told
// round which the body lies more than once.
typedef enum outcome { BACK, STOPPED, TOLD, WOUND, OUTCOMES } outcome;

// Steps from where the nodes are to `end` ms: BACK at rest, STOPPED with a message that names a node and its place, TOLD
// or WOUND. Anything else, of which nothing tells, fails, and so does what takes more than 100,000 steps.
static outcome come_back(any_body *body, double end, const char *what, int law, any_kind kind)
{
  vsc_error error;
  trap_off();  // what is torn may pass all numbers before the next look
  vsc_status status = vsc_start(body->model, body->state, &error);
  if (status == VSC_OK) status = vsc_advance(body->model, body->state, end, &error);
  trap_on();
  if (body->state->steps > 1e5) fail_msg("%s, law %d, %s: %g steps", what, law, any_kind_names[kind], body->state->steps);
  if (status != VSC_OK) {
    if (status != VSC_NUMERICAL || strstr(error.text, "node ") == NULL || strstr(error.text, ") mm") == NULL)
      fail_msg("%s, law %d, %s: %s", what, law, any_kind_names[kind], error.text);
    return STOPPED;
  }
  const vsc_wound wound = wound_of(body);
  if (inverted(body) > 0 || wound.folded > 0) return TOLD;
  if (wound.count > 0) return WOUND;
  const double off = off_rest(body);
  if (!(off < 0.01)) fail_msg("%s, law %d, %s: %g mm off", what, law, any_kind_names[kind], off);
  return BACK;
}

static void put_in_point(any_body *body, const double point[3])
{
  for (size_t n = 0; n < body->model->node_count; n++)
    for (size_t i = 0; i < 3; i++)
      if (body->model->inverse_mass[4 * n + i] > 0) body->state->x[4 * n + i] = point[i];
}

static const double middle[3] = {1.5, 1.5, 1.5};

// Springs, with and without couplings, and neo-Hookean tissue come back from the one point: all but one spring body
// of plain tets and one of smoothed ones, which end wound, and the quadratic neo-Hookean one, which ends with elements inside
// out.
static void bodies_come_back_from_one_point(void **state)
{
  (void)state;
  static const int laws[] = {0, COUPLED_SPRINGS, PLAIN_SPRINGS};
  size_t count[OUTCOMES] = {0};
  for (size_t l = 0; l < 3; l++)
    for (int kind = 0; kind < MIXED; kind++) {
      any_body body;
      open_held(&body, laws[l], (any_kind)kind);
      put_in_point(&body, middle);
      assert_true(inverted(&body) >= 9);
      count[come_back(&body, 100, "one point", laws[l], (any_kind)kind)]++;
      any_close(&body);
    }
  assert_int_equal(count[BACK], 12);
  assert_int_equal(count[TOLD], 1);
  assert_int_equal(count[WOUND], 2);
}

// Other points take most bodies to shapes of their own, each of which is told.
static void no_point_leads_to_a_silent_end(void **state)
{
  (void)state;
  static const int laws[] = {0, COUPLED_SPRINGS, PLAIN_SPRINGS};
  static const any_kind kinds[] = {PLAIN, NODAL, SMOOTHED, HEXES, MIXED};
  static const double points[2][3] = {{2.6, 0.6, 1.3}, {0.653, 1.056, 0.714}};
  size_t count[OUTCOMES] = {0};
  for (size_t p = 0; p < 2; p++)
    for (size_t l = 0; l < 3; l++)
      for (size_t k = 0; k < sizeof kinds / sizeof kinds[0]; k++) {
        any_body body;
        open_held(&body, laws[l], kinds[k]);
        put_in_point(&body, points[p]);
        count[come_back(&body, 100, "another point", laws[l], kinds[k])]++;
        any_close(&body);
      }
  print_message("%zu are back, %zu stop, %zu have elements inside out, %zu are wound\n", count[BACK], count[STOPPED], count[TOLD],
                count[WOUND]);
  assert_true(count[BACK] >= 6 && count[TOLD] >= 1 && count[WOUND] >= 4);
}

// Guccione's exponential is so stiff there that the body could not move in any time: told before the first step.
static void a_start_that_cannot_move_is_told(void **state)
{
  (void)state;
  any_body body;
  vsc_error error;
  open_held(&body, 2, NODAL);
  put_in_point(&body, middle);
  assert_int_equal(vsc_start(body.model, body.state, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "at 0 ms the stable step has collapsed from 0.04"));
  assert_non_null(strstr(error.text, " node "));
  assert_true(body.state->steps == 0);
  any_close(&body);
}

// Thrown about by 0.3 of an element: at the usual safety every law brings linear tets back, or stops, and so do springs
// and neo-Hookean tissue every kind of element.
static outcome throw(int law, any_kind kind)
{
  any_body body;
  uint64_t seed = 17;
  open_held(&body, law, kind);
  for (size_t n = 0; n < body.model->node_count; n++)
    for (size_t i = 0; i < 3; i++)
      if (body.model->inverse_mass[4 * n + i] > 0) body.state->x[4 * n + i] += random_between(&seed, -0.3, 0.3);
  const outcome came = come_back(&body, 50, "thrown", law, kind);
  any_close(&body);
  return came;
}

static void thrown_nodes_come_back_under_every_law(void **state)
{
  (void)state;
  for (int law = 0; law < ANY_LAWS; law++)
    for (int kind = PLAIN; kind <= NODAL; kind++) {
      const outcome came = throw(law, (any_kind)kind);
      // fibres of Holzapfel and Ogden's law, stretched by half, throw the nodes further
      if (came != BACK && !(came == STOPPED && (law == 10 || law == 11)))
        fail_msg("law %d, %s: outcome %d", law, any_kind_names[kind], came);
    }
}

static void thrown_nodes_come_back_in_every_kind(void **state)
{
  (void)state;
  for (int kind = SMOOTHED; kind < ANY_KINDS; kind++) {
    assert_int_equal(throw(0, (any_kind)kind), BACK);
    assert_int_equal(throw(COUPLED_SPRINGS, (any_kind)kind), BACK);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(bodies_come_back_from_one_point),
      cmocka_unit_test(no_point_leads_to_a_silent_end),
      cmocka_unit_test(a_start_that_cannot_move_is_told),
      cmocka_unit_test(thrown_nodes_come_back_under_every_law),
      cmocka_unit_test(thrown_nodes_come_back_in_every_kind),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
