// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/accuracy.h"

#include <errno.h>
#include <fnmatch.h>
#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "tools/bench/child.h"
#include "tools/bench/machine.h"
#include "tools/bench/outcome.h"
#include "tools/bench/report.h"
#include "tools/results.h"
#include "tools/run_plot.h"
#include "tools/scene_options.h"
#include "tools/shipped.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera bench accuracy [OPTION]...\n"
    "Runs the benchmarks whose answers are known, with every kind of element: what each is off by, what\n"
    "it costs. The table goes to stdout; DIR gets accuracy.csv, index.html, and each case's mesh, results\n"
    "and log.\n\n"
    "  -o, --output DIR      [accuracy]\n"
    "      --list            only name the cases\n"
    "      --only PATTERN    those whose name holds PATTERN, or is matched by it (* and ?)\n"
    "      --quick           the coarsest mesh of each kind\n"
    "      --scenes DIR      where the scenes are [benchmarks, of the data that come with viscera]\n"
    "      --reference DIR   where curves of others are, to compare with [../shared/benchmarks if it is\n"
    "                        there; else such comparisons are skipped]\n"
    "  -s, --set KEY=VALUE   of every scene, after the cases' own settings\n"
    "      --limit SECONDS   of processor time for each case [3600]\n"
    "      --no-pictures     none of the results\n"
    "  -t, --threads N       number of threads (default: all processors)\n"
    "  -h, --help            this text\n\n"
    "order: the error goes with the size of elements to this power, over the meshes so far; without a\n"
    "reference, with the time step.\n"
    "Exit code 3: a case failed, or missed a target. Meshes too coarse for a target are not judged by it.\n\n"
    "Examples:\n"
    "  viscera bench accuracy --quick\n"
    "  viscera bench accuracy --only land_p1 -o p1\n";

typedef struct wish {
  const char *only, *scenes, *reference;
  const char *settings[VSC_BENCH_SETTINGS];  // of every scene; NULL ends them
  char output[PATH_MAX];  // absolute
  double limit;
  bool list, quick, pictures;
} wish;

static bool is_wanted(const wish *wish, const vsc_bench_case *at)
{
  if (wish->quick && !at->coarsest) return false;
  return wish->only == NULL || strstr(at->name, wish->only) != NULL ||
         fnmatch(wish->only, at->name, 0) == 0;
}

// ---- one case

typedef struct files {
  char mesh[PATH_MAX], folder[PATH_MAX], log[PATH_MAX];
} files;

static vsc_status make_mesh(const wish *wish, const vsc_bench_case *at, files *files,
                            vsc_error *error)
{
  const vsc_bench_problem *problem = at->problem;
  if (problem->shape == NULL) {
    char file[PATH_MAX];
    snprintf(file, sizeof file, "%s/%s", wish->reference != NULL ? wish->reference : ".", problem->mesh);
    if (wish->reference != NULL && realpath(file, files->mesh) != NULL) return VSC_OK;
    return vsc_fail(error, VSC_INPUT, "its mesh %s belongs into the folder --reference", problem->mesh);
  }
  char text[4 * VSC_BENCH_TEXT], *words[VSC_CHILD_WORDS] = {"generate"};
  snprintf(text, sizeof text, "%s %s %s", problem->shape, at->size->shape, at->kind->shape);
  int count = vsc_child_split(text, 1, words);
  words[count++] = "-o";
  words[count++] = files->mesh;
  words[count] = NULL;
  vsc_child_cost cost;
  return vsc_child(vsc_verb_generate, words, files->log, wish->limit, &cost, error);
}

static int add_settings(const char *const settings[VSC_BENCH_SETTINGS], int count,
                        char *words[VSC_CHILD_WORDS])
{
  for (int k = 0; k < VSC_BENCH_SETTINGS && settings[k] != NULL && count + 3 < VSC_CHILD_WORDS; k++) {
    words[count++] = "--set";
    words[count++] = (char *)settings[k];
  }
  return count;
}

static vsc_status run_scene(const wish *wish, const vsc_bench_case *at, files *files,
                            vsc_child_cost *cost, vsc_error *error)
{
  static const char *const always[VSC_BENCH_SETTINGS] = {"output.precision=double"};
  char scene[PATH_MAX], mesh[PATH_MAX + 16];
  snprintf(scene, sizeof scene, "%s/%s", wish->scenes, at->problem->scene);
  snprintf(mesh, sizeof mesh, "mesh.file=%s", files->mesh);
  char *words[VSC_CHILD_WORDS] = {"run", "-o", files->folder, "--set", mesh};
  int count = add_settings(always, 5, words);
  count = add_settings(at->problem->settings, count, words);
  count = add_settings(at->variant->settings, count, words);
  count = add_settings(at->kind->settings, count, words);
  count = add_settings(wish->settings, count, words);
  words[count++] = scene;
  words[count] = NULL;
  return vsc_child(vsc_verb_run, words, files->log, wish->limit, cost, error);
}

// Takes, prints and keeps each quantity of a finished case.
static vsc_status measure(const wish *wish, vsc_outcome *outcome, vsc_bench_row *row,
                          vsc_bench_report *report, vsc_error *error)
{
  const vsc_bench_problem *problem = outcome->of->problem;
  row->elements = outcome->elements;
  row->nodes = outcome->nodes;
  row->unknowns = outcome->unknowns;
  row->iterations = outcome->iterations;
  row->steps = outcome->steps;
  outcome->reference = wish->reference;
  for (size_t k = 0; k < problem->quantity_count; k++) {
    const vsc_bench_quantity *q = &problem->quantities[k];
    vsc_measured measured = {.reference = q->formula != NULL ? q->formula(outcome->of->variant->parameter)
                                                             : q->reference};
    vsc_error why;
    row->quantity = q;
    row->failure[0] = '\0';
    if (q->measure(outcome, q, &measured, &why) != VSC_OK)
      snprintf(row->failure, sizeof row->failure, "%.60s: %.560s", q->name, why.text);
    row->value = measured.value;
    row->reference = measured.reference;
    row->skipped = measured.skipped;
    if (!vsc_bench_keep(report, row)) return vsc_fail_memory(error, "the report");
    vsc_bench_print(&report->rows[report->count - 1]);
  }
  return VSC_OK;
}

static vsc_status run_case(const wish *wish, const vsc_bench_case *at, vsc_bench_report *report,
                           vsc_error *error)
{
  static const char *const names[] = {"%s/meshes/%s.vtu", "%s/runs/%s", "%s/logs/%s.txt"};
  files files;
  char *const paths[] = {files.mesh, files.folder, files.log};
  for (int k = 0; k < 3; k++)
    if (snprintf(paths[k], PATH_MAX, names[k], wish->output, at->name) >= PATH_MAX)
      return vsc_fail(error, VSC_INPUT, "%s: the name is too long", wish->output);
  unlink(files.log);
  vsc_bench_row row = {.of = *at};
  vsc_child_cost cost = {0};
  vsc_error why;
  vsc_outcome outcome = {.of = at};
  vsc_status status = make_mesh(wish, at, &files, &why);
  if (status == VSC_OK) status = run_scene(wish, at, &files, &cost, &why);
  if (status == VSC_OK) status = vsc_outcome_open(files.folder, &outcome, &why);
  row.cpu_seconds = cost.cpu_seconds;
  row.megabytes = cost.megabytes;
  if (status == VSC_OK) {
    status = measure(wish, &outcome, &row, report, error);
    vsc_outcome_close(&outcome);
    return status;
  }
  snprintf(row.failure, sizeof row.failure, "%s", why.text);
  vsc_bench_print(&row);
  return vsc_bench_keep(report, &row) ? VSC_OK : vsc_fail_memory(error, "the report");
}

// ---- all of them

// The last good case of the problem, as it has moved.
static void draw(const wish *wish, const vsc_bench_report *report, const vsc_bench_problem *problem)
{
  const vsc_bench_row *shown = NULL;
  for (size_t k = 0; k < report->count; k++)
    if (report->rows[k].of.problem == problem && report->rows[k].failure[0] == '\0' &&
        (shown == NULL || report->rows[k].of.kind->bit == VSC_BENCH_QUADRATIC))
      shown = &report->rows[k];
  if (shown == NULL) return;
  char result[PATH_MAX + 3 * VSC_BENCH_TEXT], picture[PATH_MAX + VSC_BENCH_TEXT];
  snprintf(result, sizeof result, "%s/runs/%s=%s", wish->output, shown->of.name, shown->of.name);
  snprintf(picture, sizeof picture, "%s/%s.png", wish->output, problem->name);
  char *words[] = {"plot", "--view", "--title", (char *)problem->title, "-o", picture, result, NULL};
  vsc_run_plot(words);
}

static vsc_status make_folders(const wish *wish, vsc_error *error)
{
  static const char *const names[] = {"", "/meshes", "/runs", "/logs"};
  char folder[PATH_MAX + 16];
  for (size_t k = 0; k < sizeof names / sizeof names[0]; k++) {
    snprintf(folder, sizeof folder, "%s%s", wish->output, names[k]);
    if (mkdir(folder, 0777) != 0 && errno != EEXIST)
      return vsc_fail(error, VSC_SYSTEM, "%s: cannot be made: %s", folder, strerror(errno));
  }
  return VSC_OK;
}

static vsc_status run_all(const wish *wish, vsc_bench_report *report, vsc_error *error)
{
  vsc_status status = vsc_shipped_check(wish->scenes, "--scenes", error);
  if (status == VSC_OK) status = make_folders(wish, error);
  if (status != VSC_OK) return status;
  vsc_machine_say(stdout);
  vsc_bench_print_heading();
  for (vsc_bench_case at = {0}; status == VSC_OK && vsc_bench_next(&at);)
    if (is_wanted(wish, &at)) status = run_case(wish, &at, report, error);
  if (status == VSC_OK && report->count == 0)
    status = vsc_fail(error, VSC_INPUT, "no case is called '%s'; --list names them", wish->only);
  for (size_t p = 0; p < vsc_bench_problem_count && status == VSC_OK && wish->pictures; p++)
    draw(wish, report, vsc_bench_problems[p]);
  if (status == VSC_OK) status = vsc_bench_write_csv(report, wish->output, error);
  if (status == VSC_OK) status = vsc_bench_write_page(report, wish->output, wish->reference, error);
  if (status == VSC_OK) printf("written: %s/accuracy.csv, %s/index.html\n", wish->output, wish->output);
  for (size_t k = 0; k < report->count && status == VSC_OK; k++)
    if (vsc_bench_judge(&report->rows[k]) == VSC_BENCH_MISSED)
      status = vsc_fail(error, VSC_NUMERICAL, "some cases failed or missed their targets");
  return status;
}

static void list_cases(const wish *wish)
{
  for (vsc_bench_case at = {0}; vsc_bench_next(&at);)
    if (is_wanted(wish, &at))
      printf("%-36s %s; %s %s %s\n", at.name, at.problem->scene,
             at.problem->shape != NULL ? at.problem->shape : at.problem->mesh, at.size->shape,
             at.kind->shape);
}

static int keep_output(wish *wish, const char *output)
{
  char here[PATH_MAX] = "";
  if (output[0] != '/' && getcwd(here, sizeof here) == NULL) return VSC_SYSTEM;
  if (snprintf(wish->output, sizeof wish->output, "%s%s%s", here, output[0] != '/' ? "/" : "", output) <
      (int)sizeof wish->output)
    return VSC_OK;
  fprintf(stderr, "viscera: bench accuracy: --output is too long\n");
  return VSC_INPUT;
}

static int keep_setting(wish *wish, const char *setting)
{
  for (int k = 0; k < VSC_BENCH_SETTINGS; k++)
    if (wish->settings[k] == NULL) {
      wish->settings[k] = setting;
      return VSC_OK;
    }
  fprintf(stderr, "viscera: bench accuracy: more than %d times --set\n", VSC_BENCH_SETTINGS);
  return VSC_INPUT;
}

enum { LIST = 256, ONLY, QUICK, SCENES, REFERENCE, LIMIT, NO_PICTURES };

static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                        {"list", no_argument, NULL, LIST},
                                        {"only", required_argument, NULL, ONLY},
                                        {"quick", no_argument, NULL, QUICK},
                                        {"scenes", required_argument, NULL, SCENES},
                                        {"reference", required_argument, NULL, REFERENCE},
                                        {"set", required_argument, NULL, 's'},
                                        {"limit", required_argument, NULL, LIMIT},
                                        {"no-pictures", no_argument, NULL, NO_PICTURES},
                                        {"threads", required_argument, NULL, 't'},
                                        {"help", no_argument, NULL, 'h'},
                                        {0}};

static int keep_option(wish *wish, int option, const char *text)
{
  switch (option) {
    case 'o':
      return keep_output(wish, text);
    case LIST:
      wish->list = true;
      return VSC_OK;
    case ONLY:
      wish->only = text;
      return VSC_OK;
    case QUICK:
      wish->quick = true;
      return VSC_OK;
    case SCENES:
      wish->scenes = text;
      return VSC_OK;
    case REFERENCE:
      wish->reference = text;
      return VSC_OK;
    case 's':
      return keep_setting(wish, text);
    case LIMIT:
      wish->limit = strtod(text, NULL);
      if (wish->limit >= 1 && wish->limit <= 1e6) return VSC_OK;
      fprintf(stderr, "viscera: bench accuracy: --limit %s: expected 1 to 1e6 seconds\n", text);
      return VSC_INPUT;
    case NO_PICTURES:
      wish->pictures = false;
      return VSC_OK;
    case 't':
      return vsc_keep_threads(text);
    default:
      return VSC_INPUT;
  }
}

int vsc_bench_accuracy(int argc, char **argv)
{
  char shipped[PATH_MAX];
  wish wish = {.scenes = vsc_shipped("benchmarks", shipped, sizeof shipped), .limit = 3600, .pictures = true};
  int code = keep_output(&wish, "accuracy");
  optind = 0;
  for (int c; code == VSC_OK && (c = getopt_long(argc, argv, "o:s:t:h", options, NULL)) != -1;) {
    if (c == 'h') return fputs(help, stdout) < 0 ? VSC_SYSTEM : VSC_OK;
    code = keep_option(&wish, c, optarg);
  }
  if (code == VSC_OK && optind < argc) {
    fprintf(stderr, "viscera: bench accuracy: '%s' means nothing here\n", argv[optind]);
    code = VSC_INPUT;
  }
  if (code != VSC_OK) return code;
  if (wish.reference == NULL && access("../shared/benchmarks", R_OK) == 0)
    wish.reference = "../shared/benchmarks";
  if (wish.list) {
    list_cases(&wish);
    return VSC_OK;
  }
  vsc_bench_report report = {0};
  vsc_error error;
  const vsc_status status = run_all(&wish, &report, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera: bench accuracy: %s\n", error.text);
  vsc_bench_report_free(&report);
  return (int)status;
}
