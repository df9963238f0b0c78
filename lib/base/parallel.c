// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <unistd.h>

// The pieces of a call lie in one range for each thread, which its thread takes from the front; a thread whose own
// range is empty goes on with those of others. So a thread that comes late, because another program has its
// processor, holds nobody up: the caller waits only for pieces that are being done.
//
// A range is one atomic number, the call's number in the upper half and the next piece in the lower one: a piece is
// taken by exchanging (call, piece) for (call, piece + 1), which fails once the call is over.
enum { MOST_THREADS = 1024, LAST_PIECE = 0xffffffff };
#define SPINS 2000  // looks, some ten microseconds, before a thread sleeps: passes follow one another that fast

typedef struct range {
  _Alignas(64) atomic_uint_least64_t next;
} range;

static struct {
  range ranges[MOST_THREADS];
  _Alignas(64) atomic_size_t done; // on a line of its own: what threads look at for each piece is only read in a call
  _Alignas(64) atomic_uint_least32_t call;  // its number; changes when there is work
  _Alignas(64) atomic_size_t pieces;
  atomic_int threads;              // that take part
  _Atomic(vsc_piece *) work;
  _Atomic(void *) context;
  _Alignas(64) atomic_flag busy;                // somebody is calling
  int workers;                     // threads that have been started
  int most;                        // ranges that have been in use
  atomic_int sleepers[2];          // workers that wait for a call; callers that wait for its end
  pthread_mutex_t lock;
  pthread_cond_t change[2];
} pool = {.busy = ATOMIC_FLAG_INIT,
          .lock = PTHREAD_MUTEX_INITIALIZER,
          .change = {PTHREAD_COND_INITIALIZER, PTHREAD_COND_INITIALIZER}};

static int thread_count = 0;

void vsc_parallel_set_threads(int threads)
{
  const char *wanted = getenv("OMP_NUM_THREADS");
  if (threads <= 0) threads = wanted != NULL ? atoi(wanted) : 0;
  if (threads <= 0) threads = (int)sysconf(_SC_NPROCESSORS_ONLN);
  thread_count = threads < 1 ? 1 : threads > MOST_THREADS ? MOST_THREADS : threads;
}

int vsc_parallel_threads(void)
{
  if (thread_count == 0) vsc_parallel_set_threads(0);
  return thread_count;
}

static void pause_a_moment(void)
{
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

// Whether it is over for a caller, that all pieces are done; for a worker, that there is another call than `known`.
static bool is_over(bool caller, uint32_t known)
{
  return caller ? atomic_load(&pool.done) == atomic_load(&pool.pieces) : atomic_load(&pool.call) != known;
}

// Looks for a while, then sleeps, until that is so.
static void wait_for(bool caller, uint32_t known)
{
  for (int k = 0; k < SPINS; k++) {
    if (is_over(caller, known)) return;
    pause_a_moment();
  }
  pthread_mutex_lock(&pool.lock);
  atomic_fetch_add(&pool.sleepers[caller], 1);
  while (!is_over(caller, known)) pthread_cond_wait(&pool.change[caller], &pool.lock);
  atomic_fetch_sub(&pool.sleepers[caller], 1);
  pthread_mutex_unlock(&pool.lock);
}

static void wake(bool caller)
{
  if (atomic_load(&pool.sleepers[caller]) == 0) return;
  pthread_mutex_lock(&pool.lock);
  pthread_cond_broadcast(&pool.change[caller]);
  pthread_mutex_unlock(&pool.lock);
}

static uint32_t range_end(size_t pieces, int threads, int r)
{
  return (uint32_t)(pieces * ((size_t)r + 1) / (size_t)threads);
}

// Does what is left of range `r` of call `call`; returns how many pieces that were.
static size_t do_range(uint32_t call, int r, int thread)
{
  uint_least64_t next = atomic_load(&pool.ranges[r].next);
  for (size_t count = 0;;) {
    const size_t pieces = atomic_load(&pool.pieces);
    const uint32_t end = range_end(pieces, atomic_load(&pool.threads), r), piece = (uint32_t)next;
    vsc_piece *work = atomic_load(&pool.work);
    void *context = atomic_load(&pool.context);
    if ((uint32_t)(next >> 32) != call || piece >= end) return count;
    if (!atomic_compare_exchange_weak(&pool.ranges[r].next, &next, next + 1)) continue;
    work(context, piece, thread);
    next = atomic_load(&pool.ranges[r].next);
    count++;
  }
}

static void take_part(uint32_t call, int thread)
{
  const int threads = atomic_load(&pool.threads);
  for (int k = 0; k < threads; k++) {
    const size_t count = do_range(call, (thread + k) % threads, thread);
    // the call goes on for as long as these are not counted
    if (count > 0 && atomic_fetch_add(&pool.done, count) + count == atomic_load(&pool.pieces) && thread != 0) wake(true);
  }
}

static void *serve(void *number)
{
  const int thread = (int)(intptr_t)number;
  for (uint32_t call = 0;;) {
    wait_for(false, call);
    call = atomic_load(&pool.call);
    if (thread < atomic_load(&pool.threads)) take_part(call, thread);
  }
  return NULL;
}

// As many workers as can be had: the caller can do everything itself.
static void start_workers(int threads)
{
  for (; pool.workers < threads - 1; pool.workers++) {
    pthread_t thread;
    if (pthread_create(&thread, NULL, serve, (void *)(intptr_t)(pool.workers + 1)) != 0) return;
    pthread_detach(thread);
  }
}

static void call_all(size_t pieces, int threads, vsc_piece *work, void *context)
{
  const uint32_t call = atomic_load(&pool.call) + 1;
  // Nothing can be taken, of the call before or of this one, until all of this one is said: who has seen any of it
  // finds the range closed.
  if (threads > pool.most) pool.most = threads;
  for (int r = 0; r < pool.most; r++)
    atomic_store(&pool.ranges[r].next, (uint64_t)call << 32 | LAST_PIECE);
  atomic_store(&pool.pieces, pieces);
  atomic_store(&pool.threads, threads);
  atomic_store(&pool.work, work);
  atomic_store(&pool.context, context);
  atomic_store(&pool.done, 0);
  for (int r = 0; r < threads; r++)
    atomic_store(&pool.ranges[r].next, (uint64_t)call << 32 | (r > 0 ? range_end(pieces, threads, r - 1) : 0));
  atomic_store(&pool.call, call);
  wake(false);
  take_part(call, 0);
  wait_for(true, 0);
}

void vsc_parallel_for(size_t pieces, vsc_piece *work, void *context)
{
  const int threads = vsc_parallel_threads();
  if (threads == 1 || pieces < 2 || pieces >= LAST_PIECE || atomic_flag_test_and_set(&pool.busy)) {
    for (size_t piece = 0; piece < pieces; piece++) work(context, piece, 0);
    return;
  }
  start_workers(threads);
  call_all(pieces, threads, work, context);
  atomic_flag_clear(&pool.busy);
}
