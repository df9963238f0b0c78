// SPDX-License-Identifier: GPL-3.0-or-later
// One cheap case for each stress of `viscera bench stability`, through the bench itself: it survives with an energy that
// balances, is refused, or stops with a message that names element or node, place and remedy.
#include "program.h"
#include "tools/bench/stress.h"

enum { MOST_STRESSES = 32 };

// The case of each stress that is tried: between them every method, every kind but kept volumes and most laws, where they
// take seconds at most.
static bool is_tried(const vsc_stress_case *at)
{
  static const char *const cases[] = {
      "nothing-neo_hookean-quadratic-implicit",   "axes-holzapfel_ogden-hexes-implicit",
      "regions-springs-nodal-explicit",           "volume-springs-nodal-explicit",
      "flat-springs-tets-explicit",               "sliver-neo_hookean-nodal-explicit",
      "small-springs-hexes-implicit",             "steps-guccione-nodal-explicit",
      "delays-springs-mixed-explicit",            "periods-fung-tets-explicit",
      "tension-springs-smoothed-explicit",        "pressure-springs-tets-explicit",
      "gravity-mooney_rivlin-tets-equilibrium",   "masses-springs-hexes-coupled",
      "viscosity-veronda_westmann-nodal-implicit", "crush-springs-tets-equilibrium",
      "all-springs-nodal-explicit"};
  for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++)
    if (strcmp(cases[k], at->name) == 0) return true;
  return false;
}

// The bench's own verdict on a case, of its table's only row.
static void judge(const vsc_stress_case *at)
{
  static char table[PROGRAM_TEXT];
  char command[256], start[256], outcome[32] = "";
  snprintf(command, sizeof command, "rm -rf map; $V bench stability --whole --only %s -t 1 -o map", at->name);
  const int code = shell(command);
  load_text("map/stability.csv", table, sizeof table);
  snprintf(start, sizeof start, "\n%s,%s,%s,%s,", vsc_stresses[at->stress].name, vsc_stress_laws[at->law],
           vsc_stress_kinds[at->kind], vsc_stress_methods[at->method]);
  const char *row = strstr(table, start);
  if (row == NULL) fail_msg("%s: no row in '%s': %s", at->name, table, complained);
  sscanf(row + strlen(start), "%31[^,]", outcome);
  // what ends inside out is told with the number
  if (code != 0 || (strcmp(outcome, "survives") != 0 && strcmp(outcome, "inside out") != 0 &&
                    strcmp(outcome, "refused") != 0 && strcmp(outcome, "stops") != 0))
    fail_msg("%s (exit code %d): %.200s", at->name, code, row + 1);
  print_message("%s: %s\n", at->name, outcome);
}

static void each_stress_is_survived_or_told(void **state)
{
  (void)state;
  bool met[MOST_STRESSES] = {false};
  assert_true(vsc_stress_count <= MOST_STRESSES);
  for (vsc_stress_case at = {0}; vsc_stress_next(&at, true);)
    if (is_tried(&at)) {
      judge(&at);
      met[at.stress] = true;
    }
  for (size_t k = 0; k < vsc_stress_count; k++)
    if (!met[k]) fail_msg("no case of %s", vsc_stresses[k].name);
}

int main(void)
{
  const struct CMUnitTest tests[] = {cmocka_unit_test(each_stress_is_survived_or_told)};
  return cmocka_run_group_tests(tests, program_open, program_close);
}
