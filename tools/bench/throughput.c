// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/throughput.h"

#include <math.h>
#include <stdio.h>

#include "base/parallel.h"
#include "tools/bench/machine.h"
#include "tools/bench/specimen.h"
#include "tools/bench/step_options.h"

// Next to no volume energy: the program refuses to have none, and no kernel is without.
static void axial_alone(vsc_specimen_scene *scene)
{
  vsc_material_def *tissue = &scene->material[0];
  for (int a = 0; a < 3; a++) tissue->angular[a] = 0;
  tissue->volume_modulus = 1e-6;
  tissue->stabilization = 0;
}

// Operations: additions, subtractions, multiplications, divisions and roots on doubles, each once for each number of its
// vector, of everything that ten steps of a block of eight thousand elements do: `valgrind --tool=callgrind
// --dump-instr=yes` counts how often each instruction is done, `objdump -d` tells which are [v](add|sub|mul|div|sqrt)(p|s)d
// and how wide. With AVX2 kernels, which do the same to each element as those for AVX-512.
static const vsc_specimen specimens[] = {
    {.name = "tets: axial springs alone", .operations = 254, .feature = axial_alone},
    {.name = "tets: springs, volume of each", .operations = 326},
    {.name = "the same, unstructured, in random order", .operations = 326, .kind = VSC_SPECIMEN_CLOUD},
    {.name = "+ damping", .operations = 405, .damping = true},
    {.name = "+ damping, node-averaged volume", .operations = 444, .damping = true, .nodal = true},
    {.name = "+ damping, node-averaged, tension", .operations = 447, .damping = true, .nodal = true,
     .active = VSC_ACTIVE_TENSION},
    {.name = "tets: Guccione, node-averaged", .operations = 398, .law = VSC_LAW_GUCCIONE, .nodal = true},
    {.name = "tets: Holzapfel-Ogden, node-averaged", .operations = 548, .law = VSC_LAW_HOLZAPFEL_OGDEN, .nodal = true},
    {.name = "tets, smoothed: Guccione, node-averaged", .operations = 1028, .law = VSC_LAW_GUCCIONE, .nodal = true,
     .smoothed = true},
    {.name = "tets: classical springs on edges", .operations = 44, .law = VSC_LAW_CLASSICAL},
    {.name = "quadratic tets: springs", .operations = 2704, .kind = VSC_SPECIMEN_QUADRATIC},
    {.name = "quadratic tets: Guccione", .operations = 2831, .kind = VSC_SPECIMEN_QUADRATIC, .law = VSC_LAW_GUCCIONE},
    {.name = "hexahedra: springs", .operations = 2910, .kind = VSC_SPECIMEN_HEXES},
};
enum { SPECIMENS = sizeof specimens / sizeof specimens[0] };

// ---- throughput

// The part of what the machine could do: operations and bytes at full speed, whichever takes longer; bytes as fast as a
// triad over as many as the block has in all goes, since small blocks lie in caches.
static double share_of_roof(const vsc_specimen *specimen, const vsc_machine *machine, const vsc_specimen_cost *cost)
{
  const double operations = specimen->operations * (double)cost->elements;
  const double bandwidth = vsc_machine_bandwidth(cost->bytes);
  if (bandwidth == 0) return NAN;
  return fmax(operations / machine->arithmetic, cost->traffic / bandwidth) / cost->one;
}

static void say_heading(FILE *csv)
{
  printf("                                                         million updates/s         bytes/   us/element     of\n");
  printf("elements  what                                     1 thread %2d threads        element  read  build  roofline\n",
         vsc_parallel_threads());
  if (csv != NULL)
    fprintf(csv, "elements,what,updates per second on one thread,on all,bytes per element,"
                 "seconds of reading per element,seconds of building per element,share of roofline\n");
}

static void say_throughput(FILE *csv, const vsc_specimen *specimen, const vsc_machine *machine,
                           const vsc_specimen_cost *cost, double read)
{
  const double count = (double)cost->elements, share = share_of_roof(specimen, machine, cost);
  printf("%8zu  %-40s %8.2f %10.2f %5.2f %8.0f", cost->elements, specimen->name, 1e-6 * count / cost->one,
         1e-6 * count / cost->all, cost->one / cost->all, cost->bytes / count);
  if (isnan(read))
    printf("     -");
  else
    printf(" %5.2f", 1e6 * read / count);
  printf(" %6.2f %8.0f%%\n", 1e6 * cost->build / count, 100 * share);
  fflush(stdout);
  if (csv == NULL) return;
  fprintf(csv, "%zu,\"%s\",%.6g,%.6g,%.6g,", cost->elements, specimen->name, count / cost->one, count / cost->all,
          cost->bytes / count);
  if (!isnan(read)) fprintf(csv, "%.6g", read / count);
  fprintf(csv, ",%.6g,%.4g\n", cost->build / count, share);
}

// How many elements of a kind have about as many nodes as `tets` tets: a cube of five tets has one node, as quadratic tets
// seven, as a hexahedron one.
static size_t with_nodes_of(size_t tets, vsc_specimen_kind kind)
{
  return kind == VSC_SPECIMEN_QUADRATIC ? tets / 7 : kind == VSC_SPECIMEN_HEXES ? tets / 5 : tets;
}

// All specimens of that size; with `by_nodes` those of other kinds than tets have as many nodes, not elements.
static vsc_status time_size(FILE *csv, size_t elements, bool by_nodes, const vsc_machine *machine, vsc_error *error)
{
  vsc_mesh *mesh = NULL;
  vsc_status status = VSC_OK;
  double read = NAN;
  for (size_t k = 0; k < SPECIMENS && status == VSC_OK; k++) {
    const vsc_specimen_kind kind = specimens[k].kind;
    if (mesh == NULL || kind != specimens[k - 1].kind) {
      vsc_mesh_free(mesh);
      status = vsc_specimen_mesh(kind, by_nodes ? with_nodes_of(elements, kind) : elements, &mesh, &read, error);
    }
    vsc_specimen_cost cost;
    if (status == VSC_OK) status = vsc_specimen_time(&specimens[k], mesh, true, &cost, error);
    if (status == VSC_OK) say_throughput(csv, &specimens[k], machine, &cost, read);
  }
  vsc_mesh_free(mesh);
  return status;
}

static vsc_status time_large(FILE *csv, const vsc_machine *machine, vsc_error *error)
{
  puts("six million tets; of quadratic tets and hexahedra as many as have as many nodes");
  return time_size(csv, 6000000, true, machine, error);
}

int vsc_bench_throughput(int argc, char **argv)
{
  static const size_t sizes[] = {10000, 100000, 1000000};
  enum { SIZES = sizeof sizes / sizeof sizes[0] };
  vsc_step_wish wish;
  int code;
  if (!vsc_step_options("throughput", argc, argv, &wish, &code)) return code;
  const vsc_machine machine = vsc_machine_measure();
  vsc_machine_say(stdout);
  printf("one core at most: %.1f GB/s (triad), %.1f thousand million operations/s (multiplications and additions)\n\n",
         1e-9 * machine.bandwidth, 1e-9 * machine.arithmetic);
  FILE *csv = wish.output.csv;
  say_heading(csv);
  vsc_error error;
  vsc_status status = VSC_OK;
  if (wish.elements > 0) status = time_size(csv, (size_t)wish.elements, false, &machine, &error);
  for (int k = 0; wish.elements == 0 && k < SIZES && status == VSC_OK; k++)
    status = time_size(csv, sizes[k], false, &machine, &error);
  if (wish.large && status == VSC_OK) status = time_large(csv, &machine, &error);
  return vsc_step_finish(&wish, status, &error);
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
  vsc_step_wish wish;
  int code;
  if (!vsc_step_options("growth", argc, argv, &wish, &code)) return code;
  const vsc_specimen specimen = {.name = "tets", .damping = true, .nodal = true};
  double counts[SIZES], seconds[SIZES], bytes[SIZES], read;
  int done = 0;
  vsc_error error;
  vsc_status status = VSC_OK;
  vsc_machine_say(stdout);
  puts("tets with springs, damping and node-averaged volume, one thread\n"
       "    tets   microseconds a step   ns a tet   bytes a tet   building, us a tet");
  if (wish.output.csv != NULL) fprintf(wish.output.csv, "tets,seconds a step,bytes,seconds of building\n");
  for (int k = 0; k < SIZES - !wish.large && status == VSC_OK; k++) {
    if (wish.elements > 0 && sizes[k] > (size_t)wish.elements) break;
    vsc_mesh *mesh = NULL;
    vsc_specimen_cost cost;
    status = vsc_specimen_mesh(specimen.kind, sizes[k], &mesh, &read, &error);
    if (status == VSC_OK) status = vsc_specimen_time(&specimen, mesh, false, &cost, &error);
    vsc_mesh_free(mesh);
    if (status != VSC_OK) break;
    counts[done] = (double)cost.elements;
    seconds[done] = cost.one;
    bytes[done++] = cost.bytes;
    printf("%8zu %21.1f %10.1f %13.0f %20.2f\n", cost.elements, 1e6 * cost.one, 1e9 * cost.one / counts[k],
           cost.bytes / counts[k], 1e6 * cost.build / counts[k]);
    fflush(stdout);
    if (wish.output.csv != NULL)
      fprintf(wish.output.csv, "%zu,%.6g,%.6g,%.6g\n", cost.elements, cost.one, cost.bytes, cost.build);
  }
  if (done > 2)
    printf("time grows with the number of tets to the power %.3f from %.0f on, memory %.3f\n",
           exponent(counts + 1, seconds + 1, done - 1), counts[1], exponent(counts + 1, bytes + 1, done - 1));
  return vsc_step_finish(&wish, status, &error);
}
