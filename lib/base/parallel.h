// SPDX-License-Identifier: GPL-3.0-or-later
// All threading of the library's numbers. Work is cut into numbered pieces that do not depend on the number of
// threads; who does a piece never changes its result. Threads that have nothing to do sleep, after some ten
// microseconds in which there might have been something.
#ifndef VSC_BASE_PARALLEL_H
#define VSC_BASE_PARALLEL_H

#include <stddef.h>

// Sets the number of threads, at least 1; 0: as many as there are processors (or OMP_NUM_THREADS). To be called before
// anything is made that has scratch memory for each thread (vsc_state_create, vsc_tangent_create); fewer may be set later.
void vsc_parallel_set_threads(int threads);

// The number of threads that vsc_parallel_for uses.
int vsc_parallel_threads(void);

// Does one piece. `thread` in [0, vsc_parallel_threads()) says whose scratch memory to use.
typedef void vsc_piece(void *context, size_t piece, int thread);

// Calls work(context, piece, thread) once for each piece in [0, pieces), and returns when all are
// done. Must not be called from within a piece. Where another thread of the program is calling at the same time, the
// caller does its pieces alone.
void vsc_parallel_for(size_t pieces, vsc_piece *work, void *context);

#endif
