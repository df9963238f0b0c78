// SPDX-License-Identifier: GPL-3.0-or-later
#include "solve/cholmod.h"

#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

#include "base/module.h"
#include "base/parallel.h"

// CHOLMOD gives each of its loops four threads of OpenMP, however short the loop: their waking and waiting cost a third
// of an implicit run. libgomp looks at its variables once, while it is loaded.
static vsc_status load_alone(const void **table, vsc_error *error)
{
  const bool ours = getenv("OMP_THREAD_LIMIT") == NULL;
  if (ours) setenv("OMP_THREAD_LIMIT", "1", 0);
  const vsc_status status = vsc_module_load("cholmod", "libsuitesparse-dev", table, error);
  if (ours) unsetenv("OMP_THREAD_LIMIT");
  return status;
}

vsc_status vsc_cholmod_load(const vsc_cholmod **cholmod, vsc_error *error)
{
  static _Atomic(const void *) loaded;
  const void *table = loaded;
  if (table == NULL) {
    const vsc_status status = load_alone(&table, error);
    if (status != VSC_OK) return status;
    loaded = table;
  }
  *cholmod = table;
  if (getenv("OPENBLAS_NUM_THREADS") == NULL) (*cholmod)->set_blas_threads(vsc_parallel_threads());
  return VSC_OK;
}
