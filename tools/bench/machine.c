// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/machine.h"

#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "mech/kernel.h"
#include "run/problem.h"

enum { TRIES = 5, LONG = 20000000, ROUNDS = 4000000, CHAINS = 12 };

#ifdef __x86_64__
#define FOR_WIDE_VECTORS __attribute__((target_clones("avx2", "default"), noinline))
#else
#define FOR_WIDE_VECTORS __attribute__((noinline))
#endif

typedef double four __attribute__((vector_size(32)));

FOR_WIDE_VECTORS static void triad(double *a, const double *b, const double *c)
{
  for (size_t i = 0; i < LONG; i++) a[i] = b[i] + 3 * c[i];
}

// Twelve chains of a multiplication and an addition each, so that none waits for the one before.
FOR_WIDE_VECTORS static double multiply_and_add(double factor)
{
  four chain[CHAINS];
  for (int k = 0; k < CHAINS; k++)
    for (int l = 0; l < 4; l++) chain[k][l] = k + l;
  for (long round = 0; round < ROUNDS; round++)
#pragma GCC unroll 12
    for (int k = 0; k < CHAINS; k++) chain[k] = chain[k] * factor + 1.0;
  double sum = 0;
  for (int k = 0; k < CHAINS; k++) sum += chain[k][0] + chain[k][1] + chain[k][2] + chain[k][3];
  return sum;
}

vsc_machine vsc_machine_measure(void)
{
  vsc_machine machine = {0};
  double *memory;
  if (!VSC_NEW(memory, 3 * (size_t)LONG)) return machine;
  volatile double kept = 0.5;
  for (int k = 0; k < TRIES; k++) {
    double start = vsc_cpu_seconds();
    triad(memory, memory + LONG, memory + 2 * (size_t)LONG);
    const double bandwidth = 24.0 * LONG / (vsc_cpu_seconds() - start);
    if (bandwidth > machine.bandwidth) machine.bandwidth = bandwidth;
    start = vsc_cpu_seconds();
    kept = multiply_and_add(kept > 1e300 ? 0.5 : 0.4999);
    const double arithmetic = 8.0 * CHAINS * ROUNDS / (vsc_cpu_seconds() - start);
    if (arithmetic > machine.arithmetic) machine.arithmetic = arithmetic;
  }
  vsc_free(memory);
  return machine;
}

static void processor_name(char *name, size_t size)
{
  snprintf(name, size, "unknown processor");
  FILE *file = fopen("/proc/cpuinfo", "r");
  char line[256];
  while (file != NULL && fgets(line, sizeof line, file) != NULL)
    if (strncmp(line, "model name", 10) == 0 && strchr(line, ':') != NULL) {
      snprintf(name, size, "%s", strchr(line, ':') + 2);
      name[strcspn(name, "\n")] = '\0';
      break;
    }
  if (file != NULL) fclose(file);
}

void vsc_machine_say(FILE *out)
{
  char name[128];
  processor_name(name, sizeof name);
  fprintf(out, "%s; compiler %s; viscera " VISCERA_VERSION ", %s kernels, double precision; %d threads\n",
          name, __VERSION__, vsc_kernel_set(), vsc_parallel_threads());
}
