// SPDX-License-Identifier: GPL-3.0-or-later
// Sheets that start crushed to a point or a line, held at two ends: those without angular springs and bending come back,
// others are told to be lost with a node, before the first step.
#include "sheet_body.h"

typedef enum crush { TO_A_POINT, TO_A_LINE_ALONG, TO_A_LINE_ACROSS, CRUSHES } crush;

static void hold_end(small_body *body, size_t k, const char *name, double low, double high)
{
  body->sets[k] = (vsc_selector){.kind = VSC_SELECT_BOX, .box_low = {low, -1, -1}, .box_high = {high, 99, 1}};
  vsc_copy_name(body->sets[k].name, name);
  body->supports[k] = (vsc_support_def){.held = {1, 1, 1}};
  vsc_copy_name(body->supports[k].set, name);
  body->definition.set_count = body->definition.support_count = k + 1;
}

static void open_crushed(small_body *body, vsc_membrane_def *membrane, double angular, double bending, crush how)
{
  open_surface(body, sheet_mesh(6, 5, 1, 1, CUT_BY_TURNS, 0.15, 3), membrane);
  membrane->thickness = 0.2;
  membrane->density = 2;
  membrane->axial[0] = 90;
  membrane->axial[1] = 60;
  membrane->angular = angular;
  membrane->area_modulus = 20;
  membrane->bending = bending;
  membrane->damping[0] = membrane->damping[1] = 3;
  hold_end(body, 0, "near", -1, 0.01);
  hold_end(body, 1, "far", 5.99, 99);
  body_build(body);
  static const double place[3] = {3, 2.5, 0.3};
  for (size_t n = 0; n < body->model->node_count; n++)
    for (int i = 0; i < 3; i++)
      if (body->model->inverse_mass[4 * n + i] > 0 && i != (int)how - 1) body->state->x[4 * n + i] = place[i];
}

static double stretched(small_body *body)
{
  vsc_totals totals;
  vsc_ledger *ledger;
  assert_int_equal(vsc_ledger_create(body->model, &ledger, NULL), VSC_OK);
  vsc_observe(body->model, body->state, ledger, false, &totals);
  vsc_ledger_free(ledger);
  return totals.membrane;
}

// They are at rest in many shapes, since nothing keeps them flat: their springs count.
static void sheets_that_fold_freely_come_back(void **state)
{
  (void)state;
  for (int how = 0; how < CRUSHES; how++) {
    small_body body;
    vsc_membrane_def membrane;
    vsc_error error;
    open_crushed(&body, &membrane, 0, 0, (crush)how);
    const double before = stretched(&body);
    body_start(&body);
    if (vsc_advance(body.model, body.state, 1000, &error) != VSC_OK) fail_msg("%s", error.text);
    assert_true(before > 100 && stretched(&body) < 1e-4 * before);
    body_close(&body);
  }
}

static void others_are_told(void **state)
{
  (void)state;
  for (int how = 0; how < CRUSHES; how++)
    for (int bends = 0; bends < 2; bends++) {
      small_body body;
      vsc_membrane_def membrane;
      vsc_error error;
      open_crushed(&body, &membrane, bends ? 0 : 30, bends ? 5 : 0, (crush)how);
      assert_int_equal(vsc_start(body.model, body.state, &error), VSC_NUMERICAL);
      assert_non_null(strstr(error.text, "at 0 ms the stable step has collapsed from 0.0"));
      assert_non_null(strstr(error.text, "what pulls at node "));
      body_close(&body);
    }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(sheets_that_fold_freely_come_back),
      cmocka_unit_test(others_are_told),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
