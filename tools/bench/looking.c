// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/looking.h"

#include <limits.h>
#include <math.h>

#include "io/replace.h"
#include "tools/bench/child.h"
#include "tools/results.h"
#include "tools/verbs.h"

enum { TURNS = 4, MOST_TETS = 20000 };

static const char scene[] =
    "mesh: {file: block.vtu, unit: mm}\n"
    "node_sets: [{name: foot, node_array: x0, value: 1}]\n"
    "materials: [{name: tissue, axial: {f: 10 kPa, s: 10 kPa, n: 10 kPa}, angular: {fs: 5 kPa, sn: 5 kPa, nf: 5 kPa},\n"
    "  volume_modulus: 100 kPa}]\n"
    "volume: element\n"
    "supports: [{set: foot, held: [x, y, z]}]\n"
    "time: {end: 60 ms}\n"
    "output: {frames: 60 ms, signals: 60 ms}\n";

#define POINT(name, part) "{name: " name ", at: [" part " mm, " part " mm, " part " mm]}"
static const char points[] = "output.points=[" POINT("a", "0.2") ", " POINT("b", "0.5") ", " POINT("c", "0.8") "]";

static const struct {
  const char *name, *points, *signals;
} looks[] = {
    {"a whole run, signals once", "output.points=[]", "output.signals=60 ms"},
    {"a whole run, three points, signals once", points, "output.signals=60 ms"},
    {"a whole run, three points, signals 10 times", points, "output.signals=6 ms"},
};
enum { LOOKS = sizeof looks / sizeof looks[0] };

static vsc_status prepare(const char *folder, size_t tets, vsc_error *error)
{
  char file[PATH_MAX], log[PATH_MAX], mesh[PATH_MAX], cells[96], size[96];
  const int side = (int)fmax(1, round(cbrt((double)(tets < MOST_TETS ? tets : MOST_TETS) / 5)));
  snprintf(file, sizeof file, "%.4000s/block.yaml", folder);
  snprintf(log, sizeof log, "%.4000s/log.txt", folder);
  snprintf(mesh, sizeof mesh, "%.4000s/block.vtu", folder);
  snprintf(cells, sizeof cells, "%d,%d,%d", side, side, side);
  snprintf(size, sizeof size, "%s", cells);
  char *words[] = {"generate", "block", "--tets", "5", "--cells", cells, "--size", size, "-o", mesh, NULL};
  vsc_child_cost cost;
  const vsc_status status = vsc_replace_whole(file, scene, sizeof scene - 1, false, error);
  return status == VSC_OK ? vsc_child(vsc_verb_generate, words, log, 100, &cost, error) : status;
}

static vsc_status run(const char *folder, int look, double *seconds, vsc_error *error)
{
  char file[PATH_MAX], log[PATH_MAX], result[PATH_MAX];
  snprintf(file, sizeof file, "%.4000s/block.yaml", folder);
  snprintf(log, sizeof log, "%.4000s/log.txt", folder);
  snprintf(result, sizeof result, "%.4000s/run", folder);
  char *words[] = {"run", "-q", "-t", "1", "--set", (char *)looks[look].points, "--set", (char *)looks[look].signals,
                   "-o", result, file, NULL};
  vsc_child_cost cost;
  const vsc_status status = vsc_child(vsc_verb_run, words, log, 1000, &cost, error);
  if (status != VSC_OK) return status;
  *seconds = fmin(*seconds, cost.cpu_seconds / vsc_results_number(result, "steps") / vsc_results_number(result, "elements"));
  return VSC_OK;
}

vsc_status vsc_bench_looking(FILE *csv, const char *folder, size_t tets, vsc_error *error)
{
  double seconds[LOOKS] = {INFINITY, INFINITY, INFINITY};
  vsc_status status = prepare(folder, tets, error);
  for (int k = 0; k < TURNS * LOOKS && status == VSC_OK; k++) status = run(folder, k % LOOKS, &seconds[k % LOOKS], error);
  for (int k = 0; k < LOOKS && status == VSC_OK; k++) {
    const char *without = k > 0 ? looks[0].name : "";
    printf("%-44s %6.1f %6.2f  %s\n", looks[k].name, 1e9 * seconds[k], seconds[k] / seconds[0], without);
    fprintf(csv, "\"%s\",%.4g,%.4g,\"%s\"\n", looks[k].name, 1e9 * seconds[k], seconds[k] / seconds[0], without);
  }
  return status;
}
