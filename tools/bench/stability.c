// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/stability.h"

#include <errno.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/parallel.h"
#include "run/problem.h"
#include "solve/explicit.h"
#include "tools/bench/child.h"
#include "tools/bench/machine.h"
#include "tools/bench/output.h"
#include "tools/bench/stability_report.h"
#include "tools/bench/true_step.h"
#include "tools/scene_options.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera bench stability [OPTION]...\n"
    "Puts a block of tissue through what breaks simulations: stiffness ratios, slivers, jumps, crushing loads,\n"
    "for every law, kind of element and method, and says of each case whether it survives with an energy that\n"
    "balances (or does so with elements inside out, or wound round edges), is refused or stops with a message\n"
    "that names element, place and remedy, or is silently wrong.\n"
    "Of explicit cases it compares the step that is claimed with the true limit. Some minutes; the tables go\n"
    "to stdout, DIR gets stability.csv, stability.png and the scenes of the cases that went wrong.\n\n"
    "  -o, --output DIR      [stability]\n"
    "      --whole           every law with every kind of element (an hour)\n"
    "      --only TEXT       cases whose name holds TEXT\n"
    "      --list            only name the cases\n"
    "      --limit SECONDS   of processor time for each case [60]\n"
    "  -t, --threads N       cases at the same time (default: all processors)\n"
    "  -h, --help            this text\n\n"
    "Exit code 3: something was silently wrong, or a claimed step was longer than the true limit.\n\n"
    "Examples:\n"
    "  viscera bench stability\n"
    "  viscera bench stability --only sliver-guccione\n";

#define LONG_WAY 1e5   // steps just below what is claimed
#define SHORT_WAY 2e3  // steps above the true limit
#define COUPLED_STEPS 4  // stable steps in one with coupled masses

typedef struct wish {
  const char *only;
  char output[PATH_MAX - 64];  // absolute
  double limit;
  bool whole, list;
} wish;

static bool next_wanted(const wish *wish, vsc_stress_case *at)
{
  while (vsc_stress_next(at, wish->whole))
    if (wish->only == NULL || strstr(at->name, wish->only) != NULL) return true;
  return false;
}

// ---- one case

// Claimed step (safety aside) and true limit of the body, and whether it is stable below and unstable above: as four
// numbers in FOLDER/steps.txt.
static void measure_step(const char *folder)
{
  vsc_problem *problem;
  vsc_state *state = NULL;
  double step = 0, below = 0, above = 0;
  char file[PATH_MAX], scene[PATH_MAX];
  snprintf(scene, sizeof scene, "%s/rest.yaml", folder);
  vsc_error error;
  if (vsc_problem_load(scene, NULL, 0, &problem, &error) != VSC_OK) return;
  if (vsc_state_create(problem->model, &state, &error) == VSC_OK &&
      vsc_start(problem->model, state, &error) == VSC_OK &&
      vsc_true_step(problem->model, state, &step, &error) == VSC_OK) {
    const double claimed = state->limit.step / problem->model->safety;
    if (vsc_step_growth(problem->model, state, 0.98 * claimed, LONG_WAY, &below, &error) != VSC_OK ||
        vsc_step_growth(problem->model, state, 1.1 * step, SHORT_WAY, &above, &error) != VSC_OK)
      below = above = NAN;
    snprintf(file, sizeof file, "%s/steps.txt", folder);
    FILE *out = fopen(file, "w");
    if (out != NULL) {
      fprintf(out, "%.17g %.17g %g %g\n", claimed, step, below, above);
      fclose(out);
    }
  }
  vsc_state_free(state);
  vsc_problem_free(problem);
}

// As a setting: inertia of neighbours for steps several times as long as the stable one at rest.
static void write_coupling(const char *folder, char *setting, size_t size)
{
  vsc_problem *problem;
  vsc_state *state = NULL;
  char scene[PATH_MAX];
  vsc_error error;
  snprintf(scene, sizeof scene, "%s/scene.yaml", folder);
  snprintf(setting, size, "time.selective_mass_scaling=0 ms");
  if (vsc_problem_load(scene, NULL, 0, &problem, &error) != VSC_OK) return;
  if (vsc_state_create(problem->model, &state, &error) == VSC_OK &&
      vsc_start(problem->model, state, &error) == VSC_OK)
    snprintf(setting, size, "time.selective_mass_scaling=%.9g ms", COUPLED_STEPS * state->limit.step);
  vsc_state_free(state);
  vsc_problem_free(problem);
}

// What runs in a process of its own: argv[1] is the folder, argv[2] says whether steps are measured or masses coupled.
static int do_case(int argc, char **argv)
{
  char run[PATH_MAX], scene[PATH_MAX], setting[64];
  if (argc < 3) return VSC_SYSTEM;
  snprintf(run, sizeof run, "%s/run", argv[1]);
  snprintf(scene, sizeof scene, "%s/scene.yaml", argv[1]);
  vsc_parallel_set_threads(1);
  if (strcmp(argv[2], "steps") == 0) measure_step(argv[1]);
  const bool couples = strcmp(argv[2], "couple") == 0;
  if (couples) write_coupling(argv[1], setting, sizeof setting);
  char *words[] = {"run", "-q", "-t", "1", "-o", run, scene, couples ? "--set" : NULL, setting, NULL};
  optind = 0;
  return vsc_verb_run(couples ? 9 : 7, words);
}

static void read_step(const char *folder, vsc_verdict *verdict)
{
  char file[PATH_MAX];
  snprintf(file, sizeof file, "%s/steps.txt", folder);
  FILE *in = fopen(file, "r");
  if (in == NULL) return;
  if (fscanf(in, "%lf %lf %lf %lf", &verdict->claimed, &verdict->limit, &verdict->below, &verdict->above) != 4)
    verdict->claimed = verdict->limit = 0;
  fclose(in);
}

// Results of the case before must not be taken for this one's.
static void forget_results(const char *folder)
{
  static const char *const files[] = {"run/summary.json", "run/signals.csv", "steps.txt", "log.txt"};
  char file[PATH_MAX];
  for (size_t k = 0; k < sizeof files / sizeof files[0]; k++) {
    snprintf(file, sizeof file, "%s/%s", folder, files[k]);
    unlink(file);
  }
}

static void take_case(const wish *wish, int worker, const vsc_stress_case *at, vsc_verdict *verdict)
{
  char folder[PATH_MAX - 32], kept[PATH_MAX + 64], log[PATH_MAX];
  snprintf(folder, sizeof folder, "%s/worker%d", wish->output, worker);
  mkdir(folder, 0777);
  forget_results(folder);
  // not of kept volumes, which the true limit does not see, nor of law paper, whose stiffness is not symmetric
  const bool steps = at->method == VSC_STRESS_EXPLICIT && vsc_stress_rests(at) &&
                     strcmp(vsc_stress_kinds[at->kind], "kept") != 0 && strcmp(vsc_stress_laws[at->law], "paper") != 0;
  char *words[] = {"case", folder, at->method == VSC_STRESS_COUPLED ? "couple" : steps ? "steps" : "run", NULL};
  snprintf(log, sizeof log, "%s/log.txt", folder);
  vsc_child_cost cost = {0};
  vsc_error error = {0};
  vsc_status status = vsc_stress_write(at, folder, &error);
  if (status == VSC_OK) status = vsc_child(do_case, words, log, wish->limit, &cost, &error);
  *verdict = (vsc_verdict){.cpu_seconds = cost.cpu_seconds};
  vsc_judge(at, folder, status, &error, verdict);
  read_step(folder, verdict);
  if (verdict->kind != VSC_WRONG && verdict->kind != VSC_UNENDED && vsc_step_holds(verdict)) return;
  snprintf(kept, sizeof kept, "%s/%s", wish->output, at->name);
  rename(folder, kept);
}

// ---- all of them

static void work(const wish *wish, int worker, int workers, size_t count, vsc_stability_row *rows)
{
  for (size_t k = (size_t)worker; k < count; k += (size_t)workers) {
    take_case(wish, worker, &rows[k].of, &rows[k].verdict);
    if (worker == 0 && isatty(STDERR_FILENO)) fprintf(stderr, "\r%zu of %zu cases  ", k + 1, count);
  }
}

// The cases in so many processes, each taking every `workers`-th, into memory that they share.
static vsc_status run_all(const wish *wish, int workers, size_t count, vsc_stability_row *rows, vsc_error *error)
{
  vsc_status status = VSC_OK;
  fflush(NULL);
  int started = 0;
  for (; started < workers && status == VSC_OK; started++) {
    const pid_t child = fork();
    if (child < 0) status = vsc_fail(error, VSC_SYSTEM, "no further process: %s", strerror(errno));
    if (child != 0) continue;
    work(wish, started, workers, count, rows);
    _exit(0);
  }
  for (int state = 0; wait(&state) > 0;)
    if (!WIFEXITED(state) && status == VSC_OK)
      status = vsc_fail(error, VSC_SYSTEM, "a process that ran cases ended by signal %d", WTERMSIG(state));
  return status;
}

static size_t count_cases(const wish *wish, bool say)
{
  size_t count = 0;
  for (vsc_stress_case at = {0}; next_wanted(wish, &at); count++)
    if (say) puts(at.name);
  return count;
}

static vsc_status bench(const wish *wish, int workers, vsc_error *error)
{
  const size_t count = count_cases(wish, false), bytes = count * sizeof(vsc_stability_row);
  if (count == 0) return vsc_fail(error, VSC_INPUT, "no case holds '%s'; --list names them", wish->only);
  vsc_stability_row *rows = mmap(NULL, bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (rows == MAP_FAILED) return vsc_fail_memory(error, "the cases");
  vsc_stress_case at = {0};
  for (size_t k = 0; k < count && next_wanted(wish, &at); k++) rows[k].of = at;
  mkdir(wish->output, 0777);
  vsc_machine_say(stdout);
  printf("%zu cases\n", count);
  vsc_status status = run_all(wish, workers, count, rows, error);
  if (status == VSC_OK) status = vsc_stability_write(rows, count, wish->output, error);
  if (status == VSC_OK) {
    vsc_stability_say(rows, count);
    vsc_bench_draw(wish->output, "stability", "--outcomes");
    if (!vsc_stability_holds(rows, count))
      status = vsc_fail(error, VSC_NUMERICAL, "not all is well; %s has the scenes that went wrong", wish->output);
  }
  munmap(rows, bytes);
  return status;
}

enum { WHOLE = 256, ONLY, LIST, LIMIT };

static int keep_option(wish *wish, int option, const char *text)
{
  char here[PATH_MAX] = "";
  switch (option) {
    case 'o':
      if (text[0] != '/' && getcwd(here, sizeof here) == NULL) return VSC_SYSTEM;
      if (snprintf(wish->output, sizeof wish->output, "%s%s%s", here, text[0] != '/' ? "/" : "", text) <
          (int)sizeof wish->output)
        return VSC_OK;
      fprintf(stderr, "viscera: bench stability: --output is too long\n");
      return VSC_INPUT;
    case WHOLE:
      wish->whole = true;
      return VSC_OK;
    case ONLY:
      wish->only = text;
      return VSC_OK;
    case LIST:
      wish->list = true;
      return VSC_OK;
    case LIMIT:
      wish->limit = strtod(text, NULL);
      if (wish->limit >= 1 && wish->limit <= 1e5) return VSC_OK;
      fprintf(stderr, "viscera: bench stability: --limit %s: expected 1 to 1e5 seconds\n", text);
      return VSC_INPUT;
    case 't':
      return vsc_keep_threads(text);
    default:
      return VSC_INPUT;
  }
}

int vsc_bench_stability(int argc, char **argv)
{
  static const struct option options[] = {{"output", required_argument, NULL, 'o'}, {"whole", no_argument, NULL, WHOLE},
                                          {"only", required_argument, NULL, ONLY},  {"list", no_argument, NULL, LIST},
                                          {"limit", required_argument, NULL, LIMIT}, {"threads", required_argument, NULL, 't'},
                                          {"help", no_argument, NULL, 'h'},         {0}};
  wish wish = {.limit = 60};
  int code = keep_option(&wish, 'o', "stability");
  for (int c; code == VSC_OK && (c = getopt_long(argc, argv, "o:t:h", options, NULL)) != -1;) {
    if (c == 'h') return fputs(help, stdout) < 0 ? VSC_SYSTEM : VSC_OK;
    code = keep_option(&wish, c, optarg);
  }
  if (code != VSC_OK) return code;
  if (wish.list) return count_cases(&wish, true) > 0 ? VSC_OK : VSC_INPUT;
  vsc_error error;
  const vsc_status status = bench(&wish, vsc_parallel_threads(), &error);
  if (status != VSC_OK) fprintf(stderr, "viscera: bench stability: %s\n", error.text);
  return (int)status;
}
