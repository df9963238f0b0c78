// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench: what the program costs and how good it is, in sections.
#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tools/bench/accuracy.h"
#include "tools/bench/first_frame.h"
#include "tools/bench/machine.h"
#include "tools/bench/output.h"
#include "tools/bench/paper.h"
#include "tools/bench/skipping.h"
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
  vsc_machine_say(stderr);  // stdout is the table
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
  puts("Usage: viscera bench [-o DIR]\n"
       "       viscera bench SECTION [OPTION]...\n"
       "Measures this program on this machine. Without a section: those marked *, one after the other, each into a\n"
       "folder of its name in DIR: its table (DIR/SECTION/SECTION.csv) and a picture of it (SECTION.png).\n");
  for (int k = 0; k < SECTIONS; k++)
    printf("  %-11s%c %s\n", sections[k].name, sections[k].usual ? '*' : ' ', sections[k].help);
  puts("\n  -o, --output DIR    of all sections [bench, in the current folder]\n"
       "  -h, --help          this text; `viscera bench SECTION --help` tells more\n\n"
       "Examples:\n"
       "  viscera bench -o /tmp/bench\n"
       "  viscera bench throughput --elements 100000\n"
       "  viscera bench accuracy --only land_p1");
}

static void name_folder(const char *folder, int k, char *file, size_t size)
{
  snprintf(file, size, "%s/%s", folder, sections[k].name);
}

// A section in a process of its own: those that fork want one whose threads have not begun to work, or their cases would
// have one thread each.
static int run_apart(const section *it, char *folder)
{
  char name[32], *argv[] = {name, "-o", folder, NULL};
  snprintf(name, sizeof name, "%s", it->name);
  fflush(NULL);
  const pid_t child = fork();
  if (child == 0) {
    optind = 0;  // getopt begins anew
    const int code = it->run(3, argv);
    fflush(NULL);
    _exit(code);
  }
  int state = 0;
  if (child > 0 && waitpid(child, &state, 0) > 0 && WIFEXITED(state)) return WEXITSTATUS(state);
  if (child > 0 && WIFSIGNALED(state))
    fprintf(stderr, "viscera bench %s: ended by signal %d\n", it->name, WTERMSIG(state));
  else
    fprintf(stderr, "viscera bench %s: no further process\n", it->name);
  return 4;
}

static int run_usual(const char *folder)
{
  int worst = 0;
  char own[PATH_MAX];
  if (mkdir(folder, 0777) != 0 && errno != EEXIST) {
    fprintf(stderr, "viscera bench: --output %s: cannot be made: %s\n", folder, strerror(errno));
    return 4;
  }
  for (int k = 0; k < SECTIONS; k++) {
    if (!sections[k].usual) continue;
    name_folder(folder, k, own, sizeof own);
    printf("%s---- %s: %s\n", k > 0 ? "\n" : "", sections[k].name, sections[k].help);
    const int code = run_apart(&sections[k], own);
    if (code > worst) worst = code;
  }
  puts("\n---- tables and pictures");
  for (int k = 0; k < SECTIONS; k++) {
    name_folder(folder, k, own, sizeof own);
    if (sections[k].usual) vsc_bench_say_files(own, sections[k].name);
  }
  return worst;
}

// The options of `viscera bench` without a section.
static int bench_usual(int argc, char **argv)
{
  static const struct option options[] = {
      {"output", required_argument, NULL, 'o'}, {"help", no_argument, NULL, 'h'}, {0}};
  const char *folder = "bench";
  for (int c; (c = getopt_long(argc, argv, "+o:h", options, NULL)) != -1;) {
    if (c == 'h') return say_help(), 0;
    if (c != 'o') return 2;
    folder = optarg;
  }
  if (optind == argc) return run_usual(folder);
  fprintf(stderr, "viscera bench: %s: a section has options of its own and comes first: viscera bench %s -o DIR\n",
          argv[optind], argv[optind]);
  return 2;
}

int vsc_verb_bench(int argc, char **argv)
{
  // cases are processes that are forked: threads that VTK's TBB has started before are not there in them, and it would
  // wait for them for ever
  setenv("VTK_SMP_BACKEND_IN_USE", "Sequential", 1);
  optind = 0;
  if (argc < 2 || argv[1][0] == '-') return bench_usual(argc, argv);
  for (int k = 0; k < SECTIONS; k++)
    if (strcmp(argv[1], sections[k].name) == 0) return sections[k].run(argc - 1, argv + 1);
  fprintf(stderr, "viscera bench: %s: no section of that name; `viscera bench --help` lists them\n", argv[1]);
  return 2;
}
