// SPDX-License-Identifier: GPL-3.0-or-later
// Linked into every test program.
#define _GNU_SOURCE  // feenableexcept
#include "trap.h"

#include <fenv.h>
#include <pthread.h>
#include <stdbool.h>

#include "base/parallel.h"

enum { TRAPPED = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

typedef struct change {
  bool on;
  pthread_barrier_t all;
} change;

static void set_here(bool on)
{
  feclearexcept(FE_ALL_EXCEPT);
  if (on)
    feenableexcept(TRAPPED);
  else
    fedisableexcept(TRAPPED);
}

// Each thread has its own traps, and waits for the others, so that none takes two pieces.
static void set_one(void *context, size_t piece, int thread)
{
  change *c = context;
  (void)piece;
  (void)thread;
  set_here(c->on);
  pthread_barrier_wait(&c->all);
}

static void set_all(bool on)
{
  change c = {.on = on};
  const int threads = vsc_parallel_threads();
  pthread_barrier_init(&c.all, NULL, (unsigned)threads);
  vsc_parallel_for((size_t)threads, set_one, &c);
  pthread_barrier_destroy(&c.all);
}

// Threads that are started later inherit the traps.
__attribute__((constructor)) static void trap_from_the_start(void)
{
  set_here(true);
}

void trap_on(void)
{
  set_all(true);
}

void trap_off(void)
{
  set_all(false);
}
