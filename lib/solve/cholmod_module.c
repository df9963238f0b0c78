// SPDX-License-Identifier: GPL-3.0-or-later
// The module `cholmod`: what is linked to CHOLMOD, so that the library need not be.
#define _GNU_SOURCE  // RTLD_NEXT
#include "solve/cholmod.h"

#include <dlfcn.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

// OpenBLAS takes as much address space, bytes, when it is first at work, and asks for ever where there is not so much.
#define BLAS_BUFFER ((size_t)128 << 20)

// METIS takes SIGTERM for an error of its own and jumps out of its work, whichever thread hears it. It finds these functions
// before its own of the same names, which set its handlers and put back what was there: SIGTERM keeps the handler that it has.
static int spare_termination(const char *name)
{
  int (*theirs)(void);
  sigset_t held, mask;
  struct sigaction handler;
  *(void **)&theirs = dlsym(RTLD_NEXT, name);
  sigemptyset(&held);
  sigaddset(&held, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &held, &mask);
  sigaction(SIGTERM, NULL, &handler);
  const int done = theirs != NULL && theirs();
  sigaction(SIGTERM, &handler, NULL);
  pthread_sigmask(SIG_SETMASK, &mask, NULL);
  return done;
}

int gk_sigtrap(void);
int gk_siguntrap(void);

int gk_sigtrap(void)
{
  return spare_termination(__func__);
}

int gk_siguntrap(void)
{
  return spare_termination(__func__);
}

// Whether there is memory for the numbers of a factor that has none yet, and then for OpenBLAS.
static bool has_room(const cholmod_factor *L)
{
  static atomic_bool ready;
  if (ready || !L->is_super) return true;
  void *trial = malloc(BLAS_BUFFER + (L->xsize + L->maxcsize) * sizeof(double));
  ready = trial != NULL;
  free(trial);
  return ready;
}

static int factorize_p(cholmod_sparse *A, double beta[2], int *set, size_t size, cholmod_factor *L, cholmod_common *common)
{
  if (has_room(L)) return cholmod_factorize_p(A, beta, set, size, L, common);
  common->status = CHOLMOD_OUT_OF_MEMORY;
  return false;
}

const vsc_cholmod vsc_cholmod_table = {
    .start = cholmod_start,
    .finish = cholmod_finish,
    .allocate_sparse = cholmod_allocate_sparse,
    .allocate_dense = cholmod_allocate_dense,
    .allocate_triplet = cholmod_allocate_triplet,
    .zeros = cholmod_zeros,
    .free_sparse = cholmod_free_sparse,
    .free_dense = cholmod_free_dense,
    .free_factor = cholmod_free_factor,
    .free_triplet = cholmod_free_triplet,
    .triplet_to_sparse = cholmod_triplet_to_sparse,
    .transpose = cholmod_transpose,
    .metis = cholmod_metis,
    .analyze = cholmod_analyze,
    .analyze_p = cholmod_analyze_p,
    .factorize = cholmod_factorize,
    .factorize_p = factorize_p,
    .solve = cholmod_solve,
    .solve2 = cholmod_solve2,
};
