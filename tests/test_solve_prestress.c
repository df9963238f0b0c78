// SPDX-License-Identifier: GPL-3.0-or-later
// The unloaded shape of a hanging chain, whose springs lengthen by a part `soft` for each node below them:
// known in closed form.
#include "solve/prestress.h"

#include <string.h>

#include "close.h"

enum { NODES = 5, MOST_ROWS = 100 };

typedef struct chain {
  double soft;
  double breaks;  // a spring that is longer at rest than this does not bear its load, mm
  vsc_status broken;
  int rows;
  vsc_prestress_row row[MOST_ROWS];
} chain;

static double stretch(const chain *c, int n)
{
  return 1 + c->soft * (NODES - n);
}

static vsc_status hang(void *context, const double *rest, double *x, vsc_error *error)
{
  const chain *c = context;
  memcpy(x, rest, 4 * sizeof *x);
  for (int n = 1; n < NODES; n++)
    for (int k = 0; k < 3; k++) {
      const double length = rest[4 * n + k] - rest[4 * n + k - 4];
      if (length > c->breaks) return vsc_fail(error, c->broken, "spring %d is torn", n);
      x[4 * n + k] = x[4 * n + k - 4] + stretch(c, n) * length;
    }
  return VSC_OK;
}

static void note(void *context, const vsc_prestress_row *row)
{
  chain *c = context;
  assert_true(c->rows < MOST_ROWS);
  c->row[c->rows++] = *row;
}

static vsc_status find(chain *c, double tolerance, int most, double *rest, vsc_error *error)
{
  double target[4 * NODES];
  for (int n = 0; n < NODES; n++)
    for (int k = 0; k < 4; k++) target[4 * n + k] = k < 3 ? n * (1 + 0.5 * k) : 0;
  const vsc_prestress problem = {.node_count = NODES, .target = target, .tolerance = tolerance,
                                 .most = most, .context = c, .load = hang, .watch = note};
  return vsc_prestress_find(&problem, rest, NULL, error);
}

static void assert_found(const chain *c, const double *rest, double allowed)
{
  for (int n = 1; n < NODES; n++)
    for (int k = 0; k < 3; k++)
      assert_close(rest[4 * n + k] - rest[4 * n + k - 4], (1 + 0.5 * k) / stretch(c, n), 0, allowed);
}

// Each iteration leaves a part soft . (nodes below) of the error at most: 0.4.
static void a_stiff_chain_converges_at_its_rate(void **state)
{
  (void)state;
  chain c = {.soft = 0.1, .breaks = 100};
  double rest[4 * NODES];
  assert_int_equal(find(&c, 1e-9, 50, rest, NULL), VSC_OK);
  assert_found(&c, rest, 1e-8);
  const vsc_prestress_row *last = &c.row[c.rows - 1];
  assert_true(last->largest <= 1e-9 && last->mean <= last->largest && last->relaxation == 1);
  assert_close(c.row[0].largest, (0.4 + 0.3 + 0.2 + 0.1) * sqrt(1 + 2.25 + 4), 1e-14, 0);
  assert_close(c.row[1].largest, (0.16 + 0.09 + 0.04 + 0.01) * sqrt(1 + 2.25 + 4), 1e-14, 0);
  for (int k = 0; k < c.rows; k++) assert_int_equal(c.row[k].iteration, k);
  // sums of the errors of the springs: each shrinks by 0.4, the last node's by 0.4 at most
  for (int k = 1; k < c.rows; k++) assert_true(c.row[k].largest <= 0.4 * c.row[k - 1].largest * 1.0001);
}

// With 1.2 and more the full step leads away; half of it converges.
static void a_soft_chain_takes_shorter_steps(void **state)
{
  (void)state;
  chain c = {.soft = 0.5, .breaks = 100};
  double rest[4 * NODES];
  assert_int_equal(find(&c, 1e-9, 60, rest, NULL), VSC_OK);
  assert_found(&c, rest, 1e-8);
  assert_true(c.row[c.rows - 1].relaxation <= 0.5);
}

// What does not bear its load is not gone to; other failures are passed on.
static void shapes_without_equilibrium_are_avoided(void **state)
{
  (void)state;
  chain c = {.soft = 0.1, .breaks = 2.01, .broken = VSC_NUMERICAL};
  double rest[4 * NODES];
  vsc_error error = {.text = ""};
  assert_int_equal(find(&c, 1e-9, 60, rest, &error), VSC_OK);
  chain torn = {.soft = 0.1, .breaks = 1.9, .broken = VSC_NUMERICAL};
  assert_int_equal(find(&torn, 1e-9, 60, rest, &error), VSC_NUMERICAL);
  assert_non_null(strstr(error.text, "does not bear"));
  torn.broken = VSC_SYSTEM;
  assert_int_equal(find(&torn, 1e-9, 60, rest, &error), VSC_SYSTEM);
  assert_string_equal(error.text, "spring 1 is torn");
}

static void too_few_iterations_say_how_far_it_is(void **state)
{
  (void)state;
  chain c = {.soft = 0.1, .breaks = 100};
  double rest[4 * NODES];
  vsc_error error = {.text = ""};
  assert_int_equal(find(&c, 1e-9, 3, rest, &error), VSC_NUMERICAL);
  assert_int_equal(c.rows, 4);
  assert_non_null(strstr(error.text, "mm off"));
  assert_non_null(strstr(error.text, "1e-09 mm"));
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(a_stiff_chain_converges_at_its_rate),
      cmocka_unit_test(a_soft_chain_takes_shorter_steps),
      cmocka_unit_test(shapes_without_equilibrium_are_avoided),
      cmocka_unit_test(too_few_iterations_say_how_far_it_is),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
