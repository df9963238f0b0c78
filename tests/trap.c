// SPDX-License-Identifier: GPL-3.0-or-later
// Linked into every test program.
#define _GNU_SOURCE  // feenableexcept
#include "trap.h"

#include <fenv.h>
#include <stdbool.h>

#include "base/parallel.h"

enum { TRAPPED = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

// Each thread has its own traps.
static void set_one(void *context, size_t piece, int thread)
{
  (void)piece;
  (void)thread;
  feclearexcept(FE_ALL_EXCEPT);
  if (*(const bool *)context)
    feenableexcept(TRAPPED);
  else
    fedisableexcept(TRAPPED);
}

static void set_all(bool on)
{
  set_one(&on, 0, 0);
  vsc_parallel_for((size_t)vsc_parallel_threads(), set_one, &on);
}

// Threads that are started later inherit the traps.
__attribute__((constructor)) static void trap_from_the_start(void)
{
  set_one(&(bool){true}, 0, 0);
}

void trap_on(void)
{
  set_all(true);
}

void trap_off(void)
{
  set_all(false);
}
