// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/bench/machine.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "base/parallel.h"
#include "mech/kernel.h"
#include "run/problem.h"

enum { TRIES = 5, LONG = 20000000, ROUNDS = 4000000, CHAINS = 12 };

#ifdef __x86_64__
#define FOR(...) __attribute__((target_clones(__VA_ARGS__, "default"), noinline))
#else
#define FOR(...) __attribute__((noinline))
#endif

typedef double four __attribute__((vector_size(32)));
typedef double eight __attribute__((vector_size(64)));

FOR("avx2") static void triad(size_t count, double *a, const double *b, const double *c)
{
  for (size_t i = 0; i < count; i++) a[i] = b[i] + 3 * c[i];
}

// Twelve chains of a multiplication and an addition each, so that none waits for the one before.
#define MULTIPLY_AND_ADD(vector)                                                     \
  vector chain[CHAINS];                                                              \
  const size_t lanes = sizeof chain[0] / sizeof(double);                             \
  for (size_t k = 0; k < CHAINS; k++)                                                \
    for (size_t l = 0; l < lanes; l++) chain[k][l] = (double)(k + l);                \
  for (long round = 0; round < ROUNDS; round++)                                      \
    _Pragma("GCC unroll 12") for (int k = 0; k < CHAINS; k++) chain[k] = chain[k] * factor + 1.0; \
  double sum = 0;                                                                    \
  for (int k = 0; k < CHAINS; k++)                                                   \
    for (size_t l = 0; l < lanes; l++) sum += chain[k][l];                           \
  return sum

FOR("avx2") static double of_fours(double factor)
{
  MULTIPLY_AND_ADD(four);
}

FOR("avx512f") static double of_eights(double factor)
{
  MULTIPLY_AND_ADD(eight);
}

// Multiplications and additions a second, of vectors of `lanes`.
static double arithmetic_of(double (*chains)(double), int lanes)
{
  static volatile double kept = 0.5;
  const double start = vsc_cpu_seconds();
  kept = chains(kept > 1e300 ? 0.5 : 0.4999);
  return 2.0 * lanes * CHAINS * ROUNDS / (vsc_cpu_seconds() - start);
}

double vsc_machine_bandwidth(double bytes)
{
  const size_t count = (size_t)fmin(fmax(bytes / 24, 1000), LONG), rounds = 1 + LONG / 4 / count;
  double *memory, best = 0;
  if (!VSC_NEW(memory, 3 * count)) return 0;
  for (int k = 0; k < TRIES; k++) {
    const double start = vsc_cpu_seconds();
    for (size_t round = 0; round < rounds; round++) {
      triad(count, memory, memory + count, memory + 2 * count);
      __asm__ volatile("" : : "r"(memory) : "memory");  // each round is to be done
    }
    best = fmax(best, 24.0 * (double)(rounds * count) / (vsc_cpu_seconds() - start));
  }
  vsc_free(memory);
  return best;
}

vsc_machine vsc_machine_measure(void)
{
  vsc_machine machine = {.bandwidth = vsc_machine_bandwidth(24.0 * LONG)};
  for (int k = 0; k < TRIES; k++)
    machine.arithmetic = fmax(machine.arithmetic, fmax(arithmetic_of(of_fours, 4), arithmetic_of(of_eights, 8)));
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
