// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholmod.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/module.h"

// CHOLMOD gives each of its loops four threads of OpenMP, however short the loop: to wake them and to wait for them can
// take a third of an implicit run. libgomp and OpenBLAS look at their variables once, while they are loaded; afterwards
// the environment is as it was.
static vsc_status load_alone(const void **table, vsc_error *error)
{
  static const char *const limits[] = {"OMP_THREAD_LIMIT", "OPENBLAS_NUM_THREADS"};
  enum { LIMITS = sizeof limits / sizeof limits[0] };
  bool ours[LIMITS];
  for (int k = 0; k < LIMITS; k++) {
    ours[k] = getenv(limits[k]) == NULL;
    if (ours[k]) setenv(limits[k], "1", 0);
  }
  const vsc_status status = vsc_module_load("cholmod", "libsuitesparse-dev", table, error);
  for (int k = 0; k < LIMITS; k++)
    if (ours[k]) unsetenv(limits[k]);
  return status;
}

vsc_status vsc_cholmod_load(const vsc_cholmod **cholmod, vsc_error *error)
{
  static _Atomic(const void *) loaded;
  const void *table = loaded;
  const vsc_status status = table == NULL ? load_alone(&table, error) : VSC_OK;
  if (status == VSC_OK) *cholmod = loaded = table;
  return status;
}
