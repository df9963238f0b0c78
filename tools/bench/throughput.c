// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/throughput.h"

#include <getopt.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/parallel.h"
#include "io/replace.h"
#include "tools/bench/machine.h"
#include "tools/bench/specimen.h"

static const char help[] =
    "Usage: viscera bench throughput [OPTION]...\n"
    "       viscera bench growth [OPTION]...\n"
    "       viscera bench skipping [OPTION]...\n"
    "throughput: million element updates per second, the best of five timings of whole explicit steps on a\n"
    "block, on one thread by processor time, on all threads by the clock; beside it what the processor could\n"
    "do at most, measured in the same run. growth: how time and memory of a step grow with the number of\n"
    "tets. skipping: what each feature costs while it is used, and while it is there but idle.\n\n"
    "  -n, --elements N    one block of about N elements instead of several\n"
    "      --large         6 million tets too (needs 3 GB)\n"
    "      --csv FILE      the table for programs\n"
    "  -h, --help          this text\n\n"
    "Example:\n"
    "  viscera bench throughput --elements 100000\n";

typedef struct wish {
  long elements;
  bool large;
  const char *csv_name;  // or NULL
  FILE *csv;             // or NULL
  vsc_replacement table;  // where it is written until it is whole
} wish;

// Operations: additions, multiplications, divisions and roots on doubles in the kernels' machine code. Bytes:
// a tet's place in its pack, 88, of which the volume pass reads 32 more; and a fifth of a node's traffic
// (5.2 tets share one in a block): positions, velocities, forces, masses, 13 numbers of four doubles with
// damping, 9 without.
#define NODE_BYTES(numbers) (32.0 * (numbers) / 5.2)

static const vsc_specimen specimens[] = {
    {.name = "tets: springs, volume of each", .operations = 318, .bytes = 88 + NODE_BYTES(9)},
    {.name = "the same in random order", .kind = VSC_SPECIMEN_SHUFFLED, .operations = 318,
     .bytes = 88 + NODE_BYTES(9)},
    {.name = "+ damping", .damping = true, .operations = 393, .bytes = 88 + NODE_BYTES(13)},
    {.name = "+ damping, node-averaged volume", .damping = true, .nodal = true, .operations = 426,
     .bytes = 120 + NODE_BYTES(15)},
    {.name = "+ damping, node-averaged, tension", .damping = true, .nodal = true,
     .active = VSC_ACTIVE_TENSION},
    {.name = "tets: Guccione, node-averaged", .law = VSC_LAW_GUCCIONE, .nodal = true},
    {.name = "tets: Holzapfel-Ogden, node-averaged", .law = VSC_LAW_HOLZAPFEL_OGDEN, .nodal = true},
    {.name = "tets, smoothed: Guccione, node-averaged", .law = VSC_LAW_GUCCIONE, .nodal = true,
     .smoothed = true},
    {.name = "tets: classical springs on edges", .law = VSC_LAW_CLASSICAL},
    {.name = "quadratic tets: springs", .kind = VSC_SPECIMEN_QUADRATIC},
    {.name = "quadratic tets: Guccione", .kind = VSC_SPECIMEN_QUADRATIC, .law = VSC_LAW_GUCCIONE},
    {.name = "hexahedra: springs", .kind = VSC_SPECIMEN_HEXES},
};
enum { SPECIMENS = sizeof specimens / sizeof specimens[0], LARGE_SPECIMENS = 4 };

static bool open_csv(wish *wish)
{
  vsc_error error;
  if (wish->csv_name == NULL) return true;
  if (vsc_replace_begin(wish->csv_name, &wish->table, &error) == VSC_OK) wish->csv = wish->table.stream;
  else fprintf(stderr, "viscera bench: --csv %s\n", error.text);
  return wish->csv != NULL;
}

static bool read_options(int argc, char **argv, wish *wish, int *code)
{
  static const struct option options[] = {{"elements", required_argument, NULL, 'n'},
                                          {"large", no_argument, NULL, 'l'},
                                          {"csv", required_argument, NULL, 'c'},
                                          {"help", no_argument, NULL, 'h'},
                                          {0}};
  *wish = (struct wish){0};
  *code = 2;
  for (int c; (c = getopt_long(argc, argv, "n:h", options, NULL)) != -1;) {
    if (c == 'n') {
      char *end;
      wish->elements = strtol(optarg, &end, 10);
      if (*end == '\0' && wish->elements >= 5 && wish->elements <= 100000000) continue;
      fprintf(stderr, "viscera bench: --elements %s: expected a number from 5 to 100000000\n", optarg);
      return false;
    } else if (c == 'l') {
      wish->large = true;
    } else if (c == 'c') {
      wish->csv_name = optarg;
    } else if (c == 'h') {
      *code = fputs(help, stdout) < 0 ? 4 : 0;
      return false;
    } else {
      return false;
    }
  }
  return open_csv(wish);
}

// What ends a section: its file closed, or removed when the section failed, its error told.
static int finish(wish *wish, vsc_status status, vsc_error *error)
{
  if (wish->csv != NULL && status == VSC_OK) {
    status = vsc_replace_end(&wish->table, false, error);
  } else if (wish->csv != NULL) {
    vsc_replace_cancel(&wish->table);
  }
  if (status != VSC_OK) fprintf(stderr, "viscera: %s\n", error->text);
  return (int)status;
}

// ---- throughput

// The part of what the machine could do: operations and bytes at full speed, whichever takes longer.
static double share_of_roof(const vsc_specimen *specimen, const vsc_machine *machine, double seconds)
{
  if (specimen->operations == 0 || machine->bandwidth == 0) return NAN;
  return fmax(specimen->operations / machine->arithmetic, specimen->bytes / machine->bandwidth) / seconds;
}

static void say_throughput(const wish *wish, const vsc_specimen *specimen, const vsc_machine *machine,
                           const vsc_specimen_cost *cost)
{
  const double count = (double)cost->elements, share = share_of_roof(specimen, machine, cost->one / count);
  printf("%8zu  %-40s %7.2f %8.2f %5.2f %8.0f %8.2f", cost->elements, specimen->name,
         1e-6 * count / cost->one, 1e-6 * count / cost->all, cost->one / cost->all, cost->bytes / count,
         1e6 * cost->build / count);
  if (isnan(share))
    printf("       -\n");
  else
    printf(" %6.0f%%\n", 100 * share);
  fflush(stdout);
  if (wish->csv != NULL)
    fprintf(wish->csv, "%zu,\"%s\",%.6g,%.6g,%.6g,%.6g,%.4g\n", cost->elements, specimen->name,
            count / cost->one, count / cost->all, cost->bytes / count, cost->build / count, share);
}

static vsc_status time_size(const wish *wish, size_t elements, size_t specimen_count,
                            const vsc_machine *machine, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  vsc_status status = VSC_OK;
  for (size_t k = 0; k < specimen_count && status == VSC_OK; k++) {
    if (mesh == NULL || specimens[k].kind != specimens[k - 1].kind) {
      vsc_mesh_free(mesh);
      mesh = NULL;
      status = vsc_specimen_mesh(specimens[k].kind, elements, &mesh, error);
    }
    vsc_specimen_cost cost;
    if (status == VSC_OK) status = vsc_specimen_time(&specimens[k], mesh, true, &cost, error);
    if (status == VSC_OK) say_throughput(wish, &specimens[k], machine, &cost);
  }
  vsc_mesh_free(mesh);
  return status;
}

int vsc_bench_throughput(int argc, char **argv)
{
  static const size_t sizes[] = {10000, 100000, 1000000};
  enum { SIZES = sizeof sizes / sizeof sizes[0] };
  wish wish;
  int code;
  if (!read_options(argc, argv, &wish, &code)) return code;
  const vsc_machine machine = vsc_machine_measure();
  vsc_machine_say(stdout);
  printf("one core at most: %.1f GB/s (triad), %.1f thousand million operations/s (multiplications and additions)\n\n",
         1e-9 * machine.bandwidth, 1e-9 * machine.arithmetic);
  printf("                                                    million updates/s             bytes/   build,    of\n");
  printf("elements  what                                     1 thread   %d threads  element   us/el. roofline\n",
         vsc_parallel_threads());
  if (wish.csv != NULL)
    fprintf(wish.csv, "elements,what,updates per second on one thread,on all,bytes per element,"
                      "seconds of building per element,share of roofline\n");
  vsc_error error;
  vsc_status status = VSC_OK;
  if (wish.elements > 0) status = time_size(&wish, (size_t)wish.elements, SPECIMENS, &machine, &error);
  for (int k = 0; wish.elements == 0 && k < SIZES && status == VSC_OK; k++)
    status = time_size(&wish, sizes[k], SPECIMENS, &machine, &error);
  if (wish.large && status == VSC_OK) status = time_size(&wish, 6000000, LARGE_SPECIMENS, &machine, &error);
  return finish(&wish, status, &error);
}

// ---- growth

// The exponent p of y ~ x^p: the slope of log y over log x by least squares.
static double exponent(const double *x, const double *y, int count)
{
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int k = 0; k < count; k++) {
    const double lx = log(x[k]), ly = log(y[k]);
    sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
  }
  return (count * sxy - sx * sy) / (count * sxx - sx * sx);
}

int vsc_bench_growth(int argc, char **argv)
{
  static const size_t sizes[] = {1000, 10000, 100000, 1000000, 6000000};
  enum { SIZES = sizeof sizes / sizeof sizes[0] };
  wish wish;
  int code;
  if (!read_options(argc, argv, &wish, &code)) return code;
  const vsc_specimen specimen = {.name = "tets", .damping = true, .nodal = true};
  double counts[SIZES], seconds[SIZES], bytes[SIZES];
  int done = 0;
  vsc_error error;
  vsc_status status = VSC_OK;
  vsc_machine_say(stdout);
  puts("tets with springs, damping and node-averaged volume, one thread\n"
       "    tets   microseconds a step   ns a tet   bytes a tet   building, us a tet");
  if (wish.csv != NULL) fprintf(wish.csv, "tets,seconds a step,bytes,seconds of building\n");
  for (int k = 0; k < SIZES - !wish.large && status == VSC_OK; k++) {
    vsc_mesh *mesh = NULL;
    vsc_specimen_cost cost;
    status = vsc_specimen_mesh(specimen.kind, sizes[k], &mesh, &error);
    if (status == VSC_OK) status = vsc_specimen_time(&specimen, mesh, false, &cost, &error);
    vsc_mesh_free(mesh);
    if (status != VSC_OK) break;
    counts[done] = (double)cost.elements;
    seconds[done] = cost.one;
    bytes[done++] = cost.bytes;
    printf("%8zu %21.1f %10.1f %13.0f %20.2f\n", cost.elements, 1e6 * cost.one, 1e9 * cost.one / counts[k],
           cost.bytes / counts[k], 1e6 * cost.build / counts[k]);
    fflush(stdout);
    if (wish.csv != NULL)
      fprintf(wish.csv, "%zu,%.6g,%.6g,%.6g\n", cost.elements, cost.one, cost.bytes, cost.build);
  }
  if (done > 2)
    printf("time grows with the number of tets to the power %.3f from %.0f on, memory %.3f\n",
           exponent(counts + 1, seconds + 1, done - 1), counts[1], exponent(counts + 1, bytes + 1, done - 1));
  return finish(&wish, status, &error);
}

// ---- skipping

typedef struct feature {
  vsc_specimen specimen;
  int over;  // the row that it is compared with; -1: none
} feature;

static const feature features[] = {
    {{.name = "springs, volume of each tet"}, -1},
    {{.name = "+ damping", .damping = true}, 0},
    {{.name = "+ node-averaged volume", .nodal = true}, 0},
    {{.name = "+ damping, node-averaged volume", .damping = true, .nodal = true}, 0},
    {{.name = "+ active tension, at work", .active = VSC_ACTIVE_TENSION}, 0},
    {{.name = "+ active tension, at rest", .active = VSC_ACTIVE_TENSION, .resting = true}, 0},
    {{.name = "law Guccione", .law = VSC_LAW_GUCCIONE}, 0},
    {{.name = "law Guccione, active tension at work", .law = VSC_LAW_GUCCIONE, .active = VSC_ACTIVE_TENSION}, 6},
    {{.name = "half of it held", .held = true}, 0},
    {{.name = "half of it held, damping, node-averaged", .held = true, .damping = true, .nodal = true}, 3},
    {{.name = "law Guccione, active tension at rest", .law = VSC_LAW_GUCCIONE, .active = VSC_ACTIVE_TENSION,
      .resting = true}, 6},
};
enum { FEATURES = sizeof features / sizeof features[0] };

int vsc_bench_skipping(int argc, char **argv)
{
  wish wish;
  int code;
  if (!read_options(argc, argv, &wish, &code)) return code;
  const size_t tets = wish.elements > 0 ? (size_t)wish.elements : 100000;
  vsc_mesh *mesh = NULL;
  vsc_error error;
  vsc_specimen_cost cost[FEATURES];
  vsc_status status = vsc_specimen_mesh(VSC_SPECIMEN_TETS, tets, &mesh, &error);
  vsc_machine_say(stdout);
  puts("what a step costs, ns a tet on one thread, and over the row without the feature");
  if (wish.csv != NULL) fprintf(wish.csv, "what,ns a tet,over\n");
  for (int k = 0; k < FEATURES && status == VSC_OK; k++) {
    const feature *f = &features[k];
    status = vsc_specimen_time(&f->specimen, mesh, false, &cost[k], &error);
    if (status != VSC_OK) break;
    const double each = 1e9 * cost[k].one / (double)cost[k].elements;
    const double over = f->over < 0 ? 1 : cost[k].one / cost[f->over].one;
    printf("%-40s %6.1f %6.2f\n", f->specimen.name, each, over);
    fflush(stdout);
    if (wish.csv != NULL) fprintf(wish.csv, "\"%s\",%.4g,%.4g\n", f->specimen.name, each, over);
  }
  vsc_mesh_free(mesh);
  return finish(&wish, status, &error);
}
