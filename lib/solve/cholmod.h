// SPDX-License-Identifier: GPL-3.0-or-later
// CHOLMOD, loaded when first needed: with it come METIS, LAPACK, BLAS and libgomp, which explicit runs need not load.
#ifndef VSC_SOLVE_CHOLMOD_H
#define VSC_SOLVE_CHOLMOD_H

#include <suitesparse/cholmod.h>

#include "base/status.h"

// CHOLMOD's functions of these names, as its manual describes them. METIS, which takes SIGTERM for an error of
// its own, leaves that to the handler that it has.
// factorize_p finds memory short, too, where OpenBLAS would not get its own.
typedef struct vsc_cholmod {
  __typeof__(cholmod_start) *start;
  __typeof__(cholmod_finish) *finish;
  __typeof__(cholmod_allocate_sparse) *allocate_sparse;
  __typeof__(cholmod_allocate_dense) *allocate_dense;
  __typeof__(cholmod_allocate_triplet) *allocate_triplet;
  __typeof__(cholmod_zeros) *zeros;
  __typeof__(cholmod_free_sparse) *free_sparse;
  __typeof__(cholmod_free_dense) *free_dense;
  __typeof__(cholmod_free_factor) *free_factor;
  __typeof__(cholmod_free_triplet) *free_triplet;
  __typeof__(cholmod_triplet_to_sparse) *triplet_to_sparse;
  __typeof__(cholmod_transpose) *transpose;
  __typeof__(cholmod_metis) *metis;
  __typeof__(cholmod_analyze) *analyze;
  __typeof__(cholmod_analyze_p) *analyze_p;
  __typeof__(cholmod_factorize) *factorize;
  __typeof__(cholmod_factorize_p) *factorize_p;
  __typeof__(cholmod_solve) *solve;
  __typeof__(cholmod_solve2) *solve2;
} vsc_cholmod;

// Gives CHOLMOD's functions. It runs on the calling thread alone, unless OMP_THREAD_LIMIT allows it more threads, or
// OPENBLAS_NUM_THREADS its BLAS, or the program had libgomp or OpenBLAS loaded before. With threads of OpenBLAS
// results have other bits for each number of them. VSC_SYSTEM when CHOLMOD is not there.
vsc_status vsc_cholmod_load(const vsc_cholmod **cholmod, vsc_error *error);

#endif
