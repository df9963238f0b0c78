// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <omp.h>

static int thread_count = 0;

void vsc_parallel_set_threads(int threads)
{
  thread_count = threads > 0 ? threads : omp_get_max_threads();
}

int vsc_parallel_threads(void)
{
  if (thread_count == 0) vsc_parallel_set_threads(0);
  return thread_count;
}

#ifdef __SANITIZE_THREAD__
// libgomp's own synchronisation is invisible to the thread sanitizer: tell it of the fork and join.
void __tsan_acquire(void *address);
void __tsan_release(void *address);
#define FORK_JOIN_ACQUIRE(token) __tsan_acquire(token)
#define FORK_JOIN_RELEASE(token) __tsan_release(token)
#define UNCHECKED __attribute__((no_sanitize("thread")))
#else
#define FORK_JOIN_ACQUIRE(token) ((void)(token))
#define FORK_JOIN_RELEASE(token) ((void)(token))
#define UNCHECKED
#endif

UNCHECKED void vsc_parallel_for(size_t pieces, vsc_piece *work, void *context)
{
  const int threads = vsc_parallel_threads();
  if (threads == 1 || pieces < 2) {
    for (size_t piece = 0; piece < pieces; piece++) work(context, piece, 0);
    return;
  }
  static char fork_token, join_token;
  FORK_JOIN_RELEASE(&fork_token);
#pragma omp parallel num_threads(threads)
  {
    FORK_JOIN_ACQUIRE(&fork_token);
    const int thread = omp_get_thread_num();
#pragma omp for schedule(static)
    for (size_t piece = 0; piece < pieces; piece++) work(context, piece, thread);
    FORK_JOIN_RELEASE(&join_token);
  }
  FORK_JOIN_ACQUIRE(&join_token);
}
