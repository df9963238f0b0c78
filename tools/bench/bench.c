// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench: how many element updates a second this machine does.
#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "mech/kernel.h"
#include "run/problem.h"
#include "solve/explicit.h"
#include "tools/bench/accuracy.h"
#include "tools/bench/paper.h"
#include "tools/shapes.h"
#include "tools/verbs.h"

static const char help[] =
    "Usage: viscera bench [OPTION]...\n"
    "       viscera bench accuracy [OPTION]...\n"
    "Million element updates per second: the best of five timings of whole explicit steps on a "
    "block of tets,\n"
    "on one thread by processor time, on all threads by the wall clock. accuracy: instead, problems "
    "with\n"
    "known answers, see `viscera bench accuracy --help`.\n\n"
    "  -n, --tets N      a block of about N tets instead of 10 thousand and 1 million\n"
    "  -s, --shuffle     tets and nodes in random order, as from an unstructured file\n"
    "      --paper       instead, Table 1 of Bourguignon & Cani 2000 as CSV\n"
    "  -h, --help        this text\n\n"
    "Example:\n"
    "  viscera bench --tets 100000\n";

// Which terms a row has.
typedef struct bench_case {
  const char *name;
  bool damping;
  vsc_volume_kind volume;
} bench_case;

static const bench_case cases[] = {
    {"springs + element volume", false, VSC_VOLUME_ELEMENT},
    {"springs + damping + element volume", true, VSC_VOLUME_ELEMENT},
    {"springs + damping + node-averaged volume", true, VSC_VOLUME_NODAL},
};
enum { CASES = sizeof cases / sizeof cases[0], TIMINGS = 5 };

static vsc_material_def tissue(const bench_case *bench)
{
  vsc_material_def material = vsc_default_material();
  for (int a = 0; a < 3; a++) {
    material.axial[a] = 10;
    material.angular[a] = 5;
    material.damping[a] = bench->damping ? 0.1 : 0;
  }
  material.volume_modulus = 100;
  material.stabilization = 10;
  return material;
}

static size_t random_below(size_t count)
{
  return (size_t)(((double)rand() / ((double)RAND_MAX + 1)) * (double)count);
}

static void exchange(void *a, void *b, size_t bytes)
{
  char kept[64];
  memcpy(kept, a, bytes);
  memcpy(a, b, bytes);
  memcpy(b, kept, bytes);
}

// Puts tets and nodes into random order, the same at each call.
static vsc_status shuffle(vsc_mesh *mesh, vsc_error *error)
{
  uint32_t *number, *former;
  const size_t nodes = mesh->node_count;
  if (!VSC_NEW(former, nodes)) return vsc_fail_memory(error, "shuffling");
  if (!VSC_NEW(number, nodes)) {
    vsc_free(former);
    return vsc_fail_memory(error, "shuffling");
  }
  srand(1);
  for (size_t n = 0; n < nodes; n++) former[n] = (uint32_t)n;
  for (size_t n = nodes - 1; n > 0; n--) {
    const size_t other = random_below(n + 1);
    exchange(former + n, former + other, sizeof *former);
    exchange(mesh->nodes + 3 * n, mesh->nodes + 3 * other, 3 * sizeof(double));
  }
  for (size_t n = 0; n < nodes; n++) number[former[n]] = (uint32_t)n;
  for (size_t i = 0; i < 4 * mesh->element_count; i++) mesh->corners[i] = number[mesh->corners[i]];
  for (size_t t = mesh->element_count - 1; t > 0; t--)
    exchange(mesh->corners + 4 * t, mesh->corners + 4 * random_below(t + 1), 4 * sizeof(uint32_t));
  vsc_free(former);
  vsc_free(number);
  return VSC_OK;
}

// Seconds of one step: the least of some timings.
static vsc_status time_steps(const vsc_mesh *mesh, const bench_case *bench, int threads,
                             double *seconds, vsc_error *error)
{
  vsc_material_def material = tissue(bench);
  vsc_definition definition = vsc_default_definition();
  definition.materials = &material;
  definition.material_count = 1;
  definition.volume = bench->volume;
  definition.end_time = 1;
  vsc_parallel_set_threads(threads);
  vsc_model *model;
  vsc_state *state = NULL;
  vsc_status status = vsc_model_build(mesh, NULL, &definition, &model, error);
  if (status == VSC_OK) status = vsc_state_create(model, &state, error);
  if (status == VSC_OK) status = vsc_start(model, state, error);
  const double steps = 2 + floor(2e7 / (double)mesh->element_count);
  *seconds = 1e9;
  for (int k = 0; k < TIMINGS && status == VSC_OK; k++) {
    const double start = threads == 1 ? vsc_cpu_seconds() : vsc_wall_seconds();
    status = vsc_steps(model, state, state->limit.step, steps, error);
    const double passed = (threads == 1 ? vsc_cpu_seconds() : vsc_wall_seconds()) - start;
    if (passed / steps < *seconds) *seconds = passed / steps;
  }
  vsc_state_free(state);
  vsc_model_free(model);
  return status;
}

static vsc_status bench_block(size_t wanted, bool shuffled, vsc_error *error)
{
  vsc_block_shape shape = vsc_block_default();
  size_t cells = 1;
  while (5 * cells * cells * cells < wanted) cells++;
  for (int i = 0; i < 3; i++) {
    shape.cells[i] = cells;
    shape.size[i] = (double)cells;
  }
  vsc_mesh *mesh;
  vsc_status status = vsc_block_mesh(&shape, &mesh, error);
  if (status != VSC_OK) return status;
  if (shuffled) status = shuffle(mesh, error);
  vsc_parallel_set_threads(0);
  const int all = vsc_parallel_threads();
  for (int k = 0; k < CASES && status == VSC_OK; k++) {
    double one, many;
    status = time_steps(mesh, &cases[k], 1, &one, error);
    if (status == VSC_OK) status = time_steps(mesh, &cases[k], all, &many, error);
    if (status != VSC_OK) break;
    const double tets = 1e-6 * (double)mesh->element_count;
    printf("%9zu tets  %-42s %6.1f on one thread  %6.1f on %d\n", mesh->element_count, cases[k].name,
           tets / one, tets / many, all);
    fflush(stdout);
  }
  vsc_mesh_free(mesh);
  return status;
}

int vsc_verb_bench(int argc, char **argv)
{
  static const struct option options[] = {{"tets", required_argument, NULL, 'n'},
                                          {"shuffle", no_argument, NULL, 's'},
                                          {"paper", no_argument, NULL, 'p'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  if (argc > 1 && strcmp(argv[1], "accuracy") == 0) return vsc_bench_accuracy(argc - 1, argv + 1);
  long tets = 0;
  bool shuffled = false, paper = false;
  for (int c; (c = getopt_long(argc, argv, "n:sh", options, NULL)) != -1;) {
    if (c == 'n')
      tets = strtol(optarg, NULL, 10);
    else if (c == 's')
      shuffled = true;
    else if (c == 'p')
      paper = true;
    else if (c == 'h')
      return fputs(help, stdout) < 0 ? 4 : 0;
    else
      return 2;
    if (c == 'n' && (tets < 5 || tets > 100000000)) {
      fprintf(stderr, "viscera bench: --tets %s: expected a number from 5 to 100000000\n", optarg);
      return 2;
    }
  }
  vsc_error error;
  if (paper) {
    const vsc_status done = vsc_bench_paper(&error);
    if (done != VSC_OK) fprintf(stderr, "viscera: %s\n", error.text);
    return (int)done;
  }
  printf("million element updates per second, %s kernels, double precision\n", vsc_kernel_set());
  vsc_status status = bench_block(tets > 0 ? (size_t)tets : 10000, shuffled, &error);
  if (status == VSC_OK && tets == 0) status = bench_block(1000000, shuffled, &error);
  if (status != VSC_OK) fprintf(stderr, "viscera: %s\n", error.text);
  return (int)status;
}
