// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench: what the program costs and how good it is, in sections.
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "tools/bench/accuracy.h"
#include "tools/bench/first_frame.h"
#include "tools/bench/paper.h"
#include "tools/bench/stability.h"
#include "tools/bench/throughput.h"
#include "tools/bench/work_precision.h"
#include "tools/verbs.h"

typedef struct section {
  const char *name;
  int (*run)(int argc, char **argv);
  bool usual;  // done by `viscera bench` alone
  const char *help;
} section;

static int bench_paper(int argc, char **argv)
{
  (void)argv;
  if (argc > 1) return puts("viscera bench paper: Table 1 of Bourguignon & Cani 2000 as CSV") < 0 ? 4 : 0;
  vsc_error error;
  const vsc_status status = vsc_bench_paper(&error);
  if (status != VSC_OK) fprintf(stderr, "viscera: %s\n", error.text);
  return (int)status;
}

static const section sections[] = {
    {"throughput", vsc_bench_throughput, true, "million element updates per second, and what the machine could do"},
    {"growth", vsc_bench_growth, true, "time and memory from a thousand tets to a million"},
    {"skipping", vsc_bench_skipping, true, "what features cost, used and idle"},
    {"start", vsc_bench_start, true, "shell to first frame, and where the time of a run goes"},
    {"error", vsc_bench_error, true, "error against run time, of a beating ventricle"},
    {"stability", vsc_bench_stability, true, "what survives, what is told when it doesn't, and the stable step"},
    {"accuracy", vsc_bench_accuracy, false, "problems with known answers: errors and costs (half an hour)"},
    {"paper", bench_paper, false, "Table 1 of Bourguignon & Cani 2000 as CSV"},
};
enum { SECTIONS = sizeof sections / sizeof sections[0] };

static void say_help(void)
{
  puts("Usage: viscera bench [SECTION [OPTION]...]\n"
       "Measures this program on this machine. Without a section: those marked *, one after the other.\n");
  for (int k = 0; k < SECTIONS; k++)
    printf("  %-11s%c %s\n", sections[k].name, sections[k].usual ? '*' : ' ', sections[k].help);
  puts("\n  -h, --help    this text; `viscera bench SECTION --help` tells more\n\n"
       "Examples:\n"
       "  viscera bench throughput --elements 100000\n"
       "  viscera bench accuracy --only land_p1");
}

static int run_usual(void)
{
  int worst = 0;
  for (int k = 0; k < SECTIONS; k++) {
    if (!sections[k].usual) continue;
    char name[32], *argv[] = {name, NULL};
    snprintf(name, sizeof name, "%s", sections[k].name);
    printf("%s---- %s: %s\n", k > 0 ? "\n" : "", sections[k].name, sections[k].help);
    fflush(stdout);
    optind = 0;  // getopt begins anew
    const int code = sections[k].run(1, argv);
    if (code > worst) worst = code;
  }
  return worst;
}

int vsc_verb_bench(int argc, char **argv)
{
  // cases are processes that are forked: threads that VTK's TBB has started before are not there in them, and it would
  // wait for them for ever
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1);
  if (argc < 2) return run_usual();
  if (strcmp(argv[1], "--help") == 0 || strcmp(argv[1], "-h") == 0) {
    say_help();
    return 0;
  }
  for (int k = 0; k < SECTIONS; k++)
    if (strcmp(argv[1], sections[k].name) == 0) {
      optind = 0;
      return sections[k].run(argc - 1, argv + 1);
    }
  fprintf(stderr, "viscera bench: %s: no section of that name; `viscera bench --help` lists them\n", argv[1]);
  return 2;
}
