// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/work_precision.h"

#include <getopt.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "io/replace.h"
#include "tools/bench/child.h"
#include "tools/bench/machine.h"
#include "tools/bench/output.h"
#include "tools/compare_fields.h"
#include "tools/results.h"
#include "tools/shipped.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera bench error [OPTION]...\n"
    "A beating ventricle: processor seconds for each simulated second against the error, which is the RMS\n"
    "difference of displacements over the beat (by volume) as a part of the stroke, the largest RMS displacement.\n"
    "Error in time: against the same mesh in far shorter steps. Error in space and time: against a finer mesh of\n"
    "curved quadratic tets in short steps. Real time: ten thousand tets on all processors, with steps made longer by\n"
    "added mass and inertia of neighbours against one another. Slivers: a bar of which some elements would make steps\n"
    "short. After each which setting is the cheapest for 1, 0.1 and 0.01 %. Ten minutes of one core; results go to DIR.\n\n"
    "  -o, --output DIR     [error]\n"
    "      --scene FILE     of time and space [data/benchmarks/beating_ventricle.yaml]\n"
    "      --only TABLE     time, space, real_time or slivers\n"
    "      --quick          the coarsest meshes only\n"
    "  -h, --help           this text\n\n"
    "Example:\n"
    "  viscera bench error --quick -o /tmp/error\n";


static const char *const sizes[] = {"lv --around 16 --along 7 --layers 2", "lv --around 24 --along 10 --layers 2",
                                    "lv --around 32 --along 14 --layers 3"};
// What all sizes are compared with: more than twice the elements of the finest, in quick runs of the first.
static const char finer[] = "lv --around 48 --along 22 --layers 3";
enum { QUICK_SIZES = 1, SIZES = sizeof sizes / sizeof sizes[0], MOST_WAYS = 16 };
#define COUNT(array) ((int)(sizeof(array) / sizeof(array)[0]))

// A way to run the beat: settings of the scene, and of the mesh's generator.
typedef struct way {
  const char *name, *generate, *settings[4];
  const char *series;  // that it belongs to in pictures; NULL: its name
  int coarser;     // sizes that it leaves out at the fine end
} way;

// The first way of each table is what the others are compared with. Of one mesh: how the step matters.
#define ROWS "output.signals=20 ms"  // steps end at rows: with these they have the length that is asked for
static const way in_time[] = {
    {.name = "explicit, safety 0.1", .generate = "", .settings = {"time.safety=0.1"}},
    {.name = "explicit, safety 0.95", .series = "explicit", .generate = "", .settings = {"time.safety=0.95"}},
    {.name = "explicit, safety 0.8 (default)", .series = "explicit", .generate = "", .settings = {"time.safety=0.8"}},
    {.name = "explicit, safety 0.4", .series = "explicit", .generate = "", .settings = {"time.safety=0.4"}},
    {.name = "explicit, masses scaled, 1.25 steps", .series = "explicit, masses scaled", .generate = "", .settings = {"time.mass_scaling=0.077 ms", "time.most_added_mass=1"}},
    {.name = "explicit, masses scaled, 1.6 steps", .series = "explicit, masses scaled", .generate = "", .settings = {"time.mass_scaling=0.1 ms", "time.most_added_mass=2"}},
    {.name = "explicit, masses coupled, 1.6 steps", .series = "explicit, masses coupled", .generate = "", .settings = {"time.selective_mass_scaling=0.1 ms"}},
    {.name = "explicit, masses coupled, 3.2 steps", .series = "explicit, masses coupled", .generate = "", .settings = {"time.selective_mass_scaling=0.2 ms"}},
    {.name = "implicit, accuracy 1e-3", .series = "implicit", .generate = "", .settings = {"solve=implicit", "solver.accuracy=1e-3"}},
    {.name = "implicit, accuracy 1e-4 (default)", .series = "implicit", .generate = "", .settings = {"solve=implicit"}},
    {.name = "implicit, accuracy 1e-5", .series = "implicit", .generate = "", .settings = {"solve=implicit", "solver.accuracy=1e-5"}},
    {.name = "implicit, accuracy 1e-6", .series = "implicit", .generate = "", .settings = {"solve=implicit", "solver.accuracy=1e-6"}},
    {.name = "implicit, steps of 4 ms", .series = "implicit, steps given", .generate = "", .settings = {"solve=implicit", "time.step=4 ms", ROWS}},
    {.name = "implicit, steps of 2 ms", .series = "implicit, steps given", .generate = "", .settings = {"solve=implicit", "time.step=2 ms", ROWS}},
    {.name = "implicit, steps of 1 ms", .series = "implicit, steps given", .generate = "", .settings = {"solve=implicit", "time.step=1 ms", ROWS}},
    {.name = "implicit, steps of 0.5 ms", .series = "implicit, steps given", .generate = "", .settings = {"solve=implicit", "time.step=0.5 ms", ROWS}},
};

// Of several meshes: how the element matters.
#define CURVED                                                                                          \
  "mesh.curved=[{surface: endo, ellipsoid: {radii: [26 mm, 26 mm, 66 mm], centre: [0 mm, 0 mm, 0 mm]}}, " \
  "{surface: epi, ellipsoid: {radii: [35.5 mm, 35.5 mm, 73 mm], centre: [0 mm, 0 mm, 0 mm]}}]"
static const way in_space[] = {
    {.name = "quadratic tets, curved, coupled for 0.01 ms", .generate = "", .settings = {"mesh.order=2", "time.selective_mass_scaling=0.01 ms", CURVED}},
    {.name = "quadratic tets, curved, coupled for 0.05 ms", .generate = "", .settings = {"mesh.order=2", "time.selective_mass_scaling=0.05 ms", CURVED}},
    {.name = "quadratic tets, curved, explicit", .generate = "", .settings = {"mesh.order=2", CURVED}, .coarser = 1},
    {.name = "quadratic tets, curved, implicit 1e-5", .generate = "",
     .settings = {"mesh.order=2", "solve=implicit", "solver.accuracy=1e-5", CURVED}, .coarser = 1},
    {.name = "quadratic tets, straight, coupled for 0.05 ms", .generate = "", .settings = {"mesh.order=2", "time.selective_mass_scaling=0.05 ms"}},
    {.name = "tets, node-averaged", .generate = "", .settings = {NULL}},
    {.name = "tets, each alone", .generate = "", .settings = {"volume=element"}},
    {.name = "tets, smoothed", .generate = "", .settings = {"tets=smoothed"}, .coarser = 1},
    {.name = "hexahedra", .generate = "--element hex", .settings = {NULL}},
    {.name = "wedges", .generate = "--element wedge", .settings = {NULL}},
};

// A heart that its sac holds: how much longer added mass, or inertia of neighbours against one another, may make its steps.
static const char heart[] = "lv --around 32 --along 20";
#define LUMPED "time.selective_mass_scaling=0 ms"
_Static_assert(COUNT(in_time) <= MOST_WAYS, "ways of one mesh");
static const way in_real_time[] = {
    {.name = "masses as they are, safety 0.3", .generate = "", .settings = {"time.mass_scaling=0 ms", LUMPED, "time.safety=0.3"}},
    {.name = "masses as they are", .generate = "", .settings = {"time.mass_scaling=0 ms", LUMPED}},
    {.name = "masses scaled for 0.18 ms", .series = "masses scaled", .generate = "", .settings = {"time.mass_scaling=0.18 ms", LUMPED}},
    {.name = "masses scaled for 0.32 ms", .series = "masses scaled", .generate = "", .settings = {"time.mass_scaling=0.32 ms", "time.most_added_mass=3", LUMPED}},
    {.name = "masses coupled for 0.45 ms", .series = "masses coupled", .generate = "", .settings = {"time.mass_scaling=0 ms", "time.selective_mass_scaling=0.45 ms"}},
    {.name = "masses coupled for 0.9 ms", .series = "masses coupled", .generate = "", .settings = {"time.mass_scaling=0 ms"}},
    {.name = "masses scaled for 0.2 ms, coupled for 0.9 ms (as shipped)", .series = "both", .generate = "", .settings = {NULL}},
};

// Forty slivers of 0.3 degrees among ten thousand tets.
static const char bar[] = "block --cells 24,8,8 --size 48,16,16 --tets 6 --slivers 40";
static const way with_slivers[] = {
    {.name = "masses as they are, safety 0.4", .generate = "", .settings = {"time.safety=0.4"}},
    {.name = "masses as they are", .generate = "", .settings = {NULL}},
    {.name = "masses scaled for 1.5 times the step", .series = "masses scaled", .generate = "", .settings = {"time.mass_scaling=0.03 ms", "time.most_added_mass=1"}},
    {.name = "masses scaled for 2.5 times the step", .series = "masses scaled", .generate = "", .settings = {"time.mass_scaling=0.05 ms", "time.most_added_mass=1"}},
    {.name = "masses coupled for 2.5 times the step", .series = "masses coupled", .generate = "", .settings = {"time.selective_mass_scaling=0.05 ms"}},
    {.name = "masses coupled for 5 times the step", .series = "masses coupled", .generate = "", .settings = {"time.selective_mass_scaling=0.1 ms"}},
};

typedef struct measured {
  char name[96], series[96];
  double elements, cost, error;  // processor s a simulated s; percent of the stroke
  double wall;                   // s by the clock a simulated s
} measured;

typedef struct wish {
  const char *output, *scene, *real_time_scene, *slivers_scene, *only;
  bool quick;
  FILE *csv;
} wish;

// Runs that are compared with each other.
typedef struct table {
  const char *name, *scene;
  bool all_processors;  // else one
} table;

// ---- one run

static vsc_status run_verb(int (*verb)(int, char **), char *text, const char *folder, vsc_child_cost *cost,
                           vsc_error *error)
{
  char *words[VSC_CHILD_WORDS], log[PATH_MAX];
  const int count = vsc_child_split(text, 0, words);
  words[count] = NULL;
  snprintf(log, sizeof log, "%s/log.txt", folder);
  return vsc_child(verb, words, log, 2000, cost, error);
}

static vsc_status run(const wish *wish, const table *table, const way *way, const char *size, const char *folder,
                      vsc_child_cost *cost, vsc_error *error)
{
  char text[2 * PATH_MAX], mesh[PATH_MAX], scene[PATH_MAX], setting[PATH_MAX + 16];
  snprintf(mesh, sizeof mesh, "%.4000s.vtu", folder);
  snprintf(text, sizeof text, "generate %s %s -o %s", size, way->generate, mesh);
  vsc_status status = run_verb(vsc_verb_generate, text, wish->output, cost, error);
  if (status != VSC_OK) return status;
  snprintf(scene, sizeof scene, "%s", table->scene);
  snprintf(setting, sizeof setting, "mesh.file=%s", mesh);
  char *words[VSC_CHILD_WORDS] = {"run", "-q", "-o", (char *)folder, "--set", setting};
  int count = 6;
  if (!table->all_processors) {
    words[count++] = "-t";
    words[count++] = "1";
  }
  for (size_t k = 0; k < 4 && way->settings[k] != NULL; k++) {
    words[count++] = "--set";
    words[count++] = (char *)way->settings[k];
  }
  words[count++] = scene;
  words[count] = NULL;
  char log[PATH_MAX];
  snprintf(log, sizeof log, "%s/log.txt", wish->output);
  return vsc_child(vsc_verb_run, words, log, 2000, cost, error);
}

// ---- one error

static const vsc_norms *displacement(const vsc_comparison *all)
{
  for (size_t k = 0; k < all->count; k++)
    if (strcmp(all->arrays[k].name, "displacement") == 0) return &all->arrays[k];
  return NULL;
}

// Percent of the stroke by which the displacements of two results differ over the beat.
static vsc_status compare(const char *folder, const char *reference, double *error_percent, vsc_error *error)
{
  vsc_results a, b;
  vsc_pair pair = {0};
  double squares = 0, volume = 0, stroke = 0;
  vsc_status status = vsc_results_open(folder, &a, error);
  if (status != VSC_OK) return status;
  status = vsc_results_open(reference, &b, error);
  if (status != VSC_OK) {
    vsc_results_close(&a);
    return status;
  }
  for (size_t f = 0; f < vsc_pvd_count(a.series) && status == VSC_OK; f++) {
    char file_a[2 * VSC_RESULT_PATH], file_b[2 * VSC_RESULT_PATH];
    const size_t g = vsc_results_nearest(&b, vsc_pvd_time(a.series, f));
    vsc_comparison all = {0};
    snprintf(file_a, sizeof file_a, "%s/%s", folder, vsc_pvd_frame(a.series, f));
    snprintf(file_b, sizeof file_b, "%s/%s", reference, vsc_pvd_frame(b.series, g));
    status = vsc_compare_files(&all, &pair, file_a, file_b, error);
    const vsc_norms *norms = displacement(&all);
    if (status == VSC_OK && norms != NULL && norms->volume > 0) {
      squares += norms->volume_squares;
      volume += norms->volume;
      stroke = fmax(stroke, sqrt(norms->volume_reference / norms->volume));
    }
    vsc_comparison_free(&all);
  }
  vsc_pair_free(&pair);
  vsc_results_close(&a);
  vsc_results_close(&b);
  *error_percent = volume > 0 && stroke > 0 ? 100 * sqrt(squares / volume) / stroke : NAN;
  return status;
}

// ---- tables

static void say(const wish *wish, const char *table, const measured *m)
{
  printf("  %-46s %8.0f %10.3g %10.3g", m->name, m->elements, m->cost, m->wall);
  if (isnan(m->error))
    printf("   reference\n");
  else
    printf(" %10.3g %%\n", m->error);
  fflush(stdout);
  if (wish->csv != NULL)
    fprintf(wish->csv, "%s,\"%s\",\"%s\",%.0f,%.6g,%.6g,%.6g\n", table, m->series, m->name, m->elements, m->cost,
            m->error, m->wall);
}

static void say_cheapest(const measured *all, size_t count)
{
  static const double wanted[] = {1, 0.1, 0.01};
  for (size_t w = 0; w < sizeof wanted / sizeof wanted[0]; w++) {
    const measured *best = NULL;
    for (size_t k = 0; k < count; k++)
      if (all[k].error <= wanted[w] && (best == NULL || all[k].cost < best->cost)) best = &all[k];
    if (best == NULL)
      printf("  for %g %%: none of these\n", wanted[w]);
    else
      printf("  for %g %%: %s, %.0f elements: %.3g processor s a simulated s\n", wanted[w], best->name, best->elements,
             best->cost);
  }
}

// Runs a way on a mesh of that size, as the table's k-th run, and tells it against the reference (its folder; NULL: it is
// the reference).
static vsc_status take(const wish *wish, const table *table, const way *way, const char *size, int k,
                       const char *reference, char folder[PATH_MAX], measured *m, vsc_error *error)
{
  vsc_child_cost cost;
  snprintf(folder, PATH_MAX, "%.3900s/%s_%d", wish->output, table->name, k);
  *m = (measured){.error = NAN};
  snprintf(m->name, sizeof m->name, "%s", way->name);
  snprintf(m->series, sizeof m->series, "%s", way->series != NULL ? way->series : way->name);
  vsc_status status = run(wish, table, way, size, folder, &cost, error);
  if (status != VSC_OK) return status;
  m->elements = vsc_results_number(folder, "elements");
  m->cost = cost.cpu_seconds / vsc_results_number(folder, "time_s");
  m->wall = vsc_results_number(folder, "wall_seconds") / vsc_results_number(folder, "time_s");
  if (reference != NULL) status = compare(folder, reference, &m->error, error);
  if (status == VSC_OK) say(wish, table->name, m);
  return status;
}

static void say_title(const char *title)
{
  printf("%-49s %8s %10s %10s   %s\n", title, "elements", "CPU s / s", "clock s / s", "error of the stroke");
}

// Several ways on one mesh, the first of which is what the others are compared with.
static vsc_status bench_one_mesh(const wish *wish, const table *table, const char *title, const way *ways, int count,
                                 const char *size, vsc_error *error)
{
  measured all[MOST_WAYS];
  char reference[PATH_MAX], folder[PATH_MAX];
  vsc_status status = VSC_OK;
  say_title(title);
  for (int k = 0; k < count && status == VSC_OK; k++)
    status = take(wish, table, &ways[k], size, k, k > 0 ? reference : NULL, k > 0 ? folder : reference, &all[k], error);
  if (status == VSC_OK) say_cheapest(all + 1, (size_t)count - 1);
  return status;
}

static vsc_status bench_time(const wish *wish, vsc_error *error)
{
  const table table = {"time", wish->scene, false};
  return bench_one_mesh(wish, &table, "error in time, one mesh", in_time, COUNT(in_time), sizes[wish->quick ? 0 : 1],
                        error);
}

static vsc_status bench_real_time(const wish *wish, vsc_error *error)
{
  const table table = {"real_time", wish->real_time_scene, true};
  return bench_one_mesh(wish, &table, "real time, all processors", in_real_time, COUNT(in_real_time), heart, error);
}

static vsc_status bench_slivers(const wish *wish, vsc_error *error)
{
  const table table = {"slivers", wish->slivers_scene, false};
  return bench_one_mesh(wish, &table, "slivers, one mesh", with_slivers, COUNT(with_slivers), bar, error);
}

static vsc_status bench_space(const wish *wish, vsc_error *error)
{
  const table table = {"space", wish->scene, false};
  measured all[COUNT(in_space) * SIZES], m;
  char reference[PATH_MAX], folder[PATH_MAX];
  const char *fine = wish->quick ? sizes[QUICK_SIZES] : finer;
  size_t count = 0;
  say_title("error in space and time");
  vsc_status status = take(wish, &table, &in_space[0], fine, 0, NULL, reference, &m, error);
  for (int k = 1; k < COUNT(in_space) && status == VSC_OK; k++) {
    const int most = wish->quick ? QUICK_SIZES : SIZES - in_space[k].coarser;
    for (int size = 0; size < most && status == VSC_OK; size++) {
      status = take(wish, &table, &in_space[k], sizes[size], k * SIZES + size, reference, folder, &all[count], error);
      count += status == VSC_OK;
    }
  }
  if (status == VSC_OK) say_cheapest(all, count);
  return status;
}

static const struct {
  const char *name;
  vsc_status (*bench)(const wish *wish, vsc_error *error);
} tables[] = {{"time", bench_time}, {"space", bench_space}, {"real_time", bench_real_time},
            {"slivers", bench_slivers}};

static bool is_wanted(const wish *wish, int table)
{
  return wish->only == NULL || strcmp(wish->only, tables[table].name) == 0;
}

static bool is_known(const char *only)
{
  for (int k = 0; k < COUNT(tables); k++)
    if (strcmp(only, tables[k].name) == 0) return true;
  return false;
}

// The tables that are asked for.
static vsc_status bench_all(const wish *wish, vsc_error *error)
{
  vsc_status status = VSC_OK;
  for (int k = 0; k < COUNT(tables) && status == VSC_OK; k++) {
    if (!is_wanted(wish, k)) continue;
    status = tables[k].bench(wish, error);
    if (status == VSC_OK) puts("");
  }
  return status;
}

int vsc_bench_error(int argc, char **argv)
{
  static const struct option options[] = {{"output", required_argument, NULL, 'o'},
                                          {"scene", required_argument, NULL, 's'},
                                          {"only", required_argument, NULL, 'y'},
                                          {"quick", no_argument, NULL, 'q'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  char shipped[3][PATH_MAX];
  wish wish = {.output = "error",
               .scene = vsc_shipped("benchmarks/beating_ventricle.yaml", shipped[0], PATH_MAX),
               .real_time_scene = vsc_shipped("benchmarks/real_time.yaml", shipped[1], PATH_MAX),
               .slivers_scene = vsc_shipped("benchmarks/slivers.yaml", shipped[2], PATH_MAX)};
  for (int c; (c = getopt_long(argc, argv, "o:h", options, NULL)) != -1;) {
    if (c == 'o') wish.output = optarg;
    else if (c == 's') wish.scene = optarg;
    else if (c == 'y') wish.only = optarg;
    else if (c == 'q') wish.quick = true;
    else if (c == 'h') return fputs(help, stdout) < 0 ? 4 : 0;
    else return 2;
  }
  if (optind < argc) {
    fprintf(stderr, "viscera bench error: '%s' means nothing here\n", argv[optind]);
    return 2;
  }
  if (wish.only != NULL && !is_known(wish.only)) {
    fprintf(stderr, "viscera bench error: --only %s: there are the tables time, space, real_time and slivers\n", wish.only);
    return 2;
  }
  char file[PATH_MAX], whole[PATH_MAX];
  vsc_replacement table;
  vsc_error error;
  if (vsc_shipped_check(wish.scene, "--scene", &error) != VSC_OK) {
    fprintf(stderr, "viscera bench error: %s\n", error.text);
    return 2;
  }
  mkdir(wish.output, 0777);
  // names in a scene's settings count from the scene's folder
  if (realpath(wish.output, whole) != NULL) wish.output = whole;
  snprintf(file, sizeof file, "%.4000s/error.csv", wish.output);
  if (vsc_replace_begin(file, &table, &error) != VSC_OK) {
    fprintf(stderr, "viscera bench error: %s\n", error.text);
    return 4;
  }
  wish.csv = table.stream;
  fprintf(wish.csv, "table,series,what,elements,processor seconds a simulated second,percent of the stroke,"
          "seconds by the clock a simulated second\n");
  vsc_machine_say(stdout);
  vsc_status status = bench_all(&wish, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera: %s\n", error.text);
  // what was measured before a failure is worth hours: it is kept
  const vsc_status closed = vsc_replace_end(&table, false, &error);
  if (closed != VSC_OK) fprintf(stderr, "viscera: %s\n", error.text);
  if (closed != VSC_OK && status == VSC_OK) return 4;
  if (status == VSC_OK) vsc_bench_draw(wish.output, "error", "--errors");
  return (int)status;
}
