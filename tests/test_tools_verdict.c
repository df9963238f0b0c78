// SPDX-License-Identifier: GPL-3.0-or-later
// What a case of `viscera bench stability` is taken for, by what its run has left and said.
#include "program.h"
#include "tools/bench/verdict.h"

// A run of two rows that balances, with elements inside out at its end, of which its summary tells `told`, and of
// corners inside out and edges with the body wound round them `wound`.
static void leave_run(int inverted, int told, const char *wound)
{
  char text[1024];
  snprintf(text, sizeof text,
           "time [s],J_min [1],J_max [1],inverted_elements [1],energy_kinetic [mJ],energy_axial [mJ],energy_angular [mJ],"
           "energy_volume [mJ],balance_error [mJ]\n0,1,1,0,0,0,0,0,0\n1,%s,1.1,%d,1,1,1,1,0.01\n",
           inverted > 0 ? "-0.5" : "0.5", inverted);
  save_text("run/signals.csv", text);
  snprintf(text, sizeof text, "{\n  \"steps\": 7,\n  \"inverted_elements\": %d,\n  \"most_inverted_elements\": 9%s\n}\n", told, wound);
  save_text("run/summary.json", text);
}

static const char not_wound[] = ",\n  \"folded_elements\": 0,\n  \"wound_edges\": 0";

static vsc_verdict judged(vsc_status status, const char *message)
{
  const vsc_stress_case at = {.name = "nothing"};
  vsc_verdict verdict = {0};
  vsc_error error;
  if (status != VSC_OK) vsc_fail(&error, status, "%s", message);
  vsc_judge(&at, program_folder, status, &error, &verdict);
  return verdict;
}

static void elements_inside_out_are_no_survival_like_others(void **state)
{
  (void)state;
  must("mkdir run");
  leave_run(0, 0, not_wound);
  assert_int_equal(judged(VSC_OK, "").kind, VSC_SURVIVES);
  leave_run(3, 3, not_wound);
  const vsc_verdict verdict = judged(VSC_OK, "");
  assert_int_equal(verdict.kind, VSC_INSIDE_OUT);
  assert_close(verdict.inverted, 3, 0, 0);
  assert_string_equal(verdict.why, "3 elements inside out in the end");
  assert_string_equal(vsc_verdict_names[verdict.kind], "inside out");
  leave_run(3, 0, not_wound);
  assert_int_equal(judged(VSC_OK, "").kind, VSC_WRONG);
}

static void neither_is_a_body_that_is_wound_or_folded_at_corners(void **state)
{
  (void)state;
  leave_run(0, 0, ",\n  \"folded_elements\": 0,\n  \"wound_edges\": 2");
  vsc_verdict verdict = judged(VSC_OK, "");
  assert_int_equal(verdict.kind, VSC_INSIDE_OUT);
  assert_close(verdict.wound, 2, 0, 0);
  assert_string_equal(verdict.why, "0 elements inside out at a corner, the body wound round 2 edges in the end");
  leave_run(0, 0, ",\n  \"folded_elements\": 1,\n  \"wound_edges\": 0");
  verdict = judged(VSC_OK, "");
  assert_int_equal(verdict.kind, VSC_INSIDE_OUT);
  assert_close(verdict.folded, 1, 0, 0);
  leave_run(0, 0, ",\n  \"wound_edges\": 0");
  assert_int_equal(judged(VSC_OK, "").kind, VSC_WRONG);
  leave_run(0, 0, "");
  assert_int_equal(judged(VSC_OK, "").kind, VSC_WRONG);
}

// Each thing that a message of a failure must name is missed when it is not there.
static void messages_name_what_they_should(void **state)
{
  (void)state;
  static const struct {
    const char *message, *missing;
  } cases[] = {
      {"at 3 ms the energy balance jumped by 2 mJ, 7 % of the largest energy so far, most in the axial energy; element 3 at "
       "(1, 2, 3) mm has the smallest volume; take a smaller load", NULL},
      {"at 3 ms the energy balance jumped by 2 mJ; element 3 at (1, 2, 3) mm; take a smaller load", "no energy in: "},
      {"at 3 ms node 3 at (1, 2, 3) mm is lost; take a smaller load", NULL},
      {"at 3 ms node 3 at (1, 2, 3) mm is no longer a finite number; the largest force on it, 2 mN, is that of volume; take "
       "a smaller load", NULL},
      {"at 3 ms node 3 at (1, 2, 3) mm is no longer a finite number; take a smaller load", "no term in: "},
      {"at 3 ms furthest out of balance, by 2 mN, is node 3 at (1, 2, 3) mm; take a smaller load", "no term in: "},
      {"node 3, (1, 2, 3) mm, is lost; take a smaller load", "no time in: "},
      {"at 3 ms (1, 2, 3) mm is lost; take a smaller load", "no element or node in: "},
      {"at 3 ms node 3 is lost; take a smaller load", "no place in: "},
      {"at 3 ms node 3 at (1, 2, 3) mm is lost", "no remedy in: "},
  };
  leave_run(0, 0, not_wound);
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
    const vsc_verdict verdict = judged(VSC_NUMERICAL, cases[k].message);
    assert_int_equal(verdict.kind, cases[k].missing == NULL ? VSC_STOPS : VSC_WRONG);
    assert_holds(verdict.why, cases[k].missing == NULL ? cases[k].message : cases[k].missing);
  }
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(elements_inside_out_are_no_survival_like_others),
      cmocka_unit_test(neither_is_a_body_that_is_wound_or_folded_at_corners),
      cmocka_unit_test(messages_name_what_they_should),
  };
  return cmocka_run_group_tests(tests, program_open, program_close);
}
