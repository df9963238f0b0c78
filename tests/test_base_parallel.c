// SPDX-License-Identifier: GPL-3.0-or-later
// Each piece of work is done once, by a thread that has scratch memory of its own.
#include "base/parallel.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <unistd.h>

#include "close.h"

enum { PIECES = 1000, THREADS = 4 };

typedef struct work {
  atomic_int done[PIECES];
  atomic_int busy[THREADS];          // a thread does one piece at a time
  _Atomic pthread_t owner[THREADS];  // and keeps its number
  atomic_int wrong;
  int threads;
} work;

static void do_piece(void *context, size_t piece, int thread)
{
  work *w = context;
  if (thread < 0 || thread >= w->threads || piece >= PIECES) {
    w->wrong++;
    return;
  }
  pthread_t owner = 0;
  if (!atomic_compare_exchange_strong(&w->owner[thread], &owner, pthread_self()) &&
      !pthread_equal(owner, pthread_self()))
    w->wrong++;
  if (w->busy[thread]++ != 0) w->wrong++;
  w->done[piece]++;
  w->busy[thread]--;
}

static void test_each_piece_once(void **state)
{
  (void)state;
  static const size_t counts[] = {0, 1, 2, 3, 7, PIECES};
  for (int threads = 1; threads <= THREADS; threads++)
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
      static work w;
      w = (work){.threads = threads};
      vsc_parallel_set_threads(threads);
      assert_int_equal(vsc_parallel_threads(), threads);
      vsc_parallel_for(counts[c], do_piece, &w);
      assert_int_equal(w.wrong, 0);
      for (size_t p = 0; p < PIECES; p++) assert_int_equal(w.done[p], p < counts[c]);
    }
}

// What pieces have written is there when the call returns, also without atomics.
static void add_one(void *context, size_t piece, int thread)
{
  (void)thread;
  double *values = context;
  values[piece] += (double)piece;
}

static void test_results_are_complete(void **state)
{
  (void)state;
  double values[PIECES] = {0};
  vsc_parallel_set_threads(THREADS);
  for (int repeat = 0; repeat < 50; repeat++) vsc_parallel_for(PIECES, add_one, values);
  for (size_t p = 0; p < PIECES; p++) assert_close(values[p], 50.0 * (double)p, 0, 0);
}

// Calls follow one another as fast as they can, with other numbers of pieces and of threads: none is lost, and none
// is taken for one of the call before.
static void count_piece(void *context, size_t piece, int thread)
{
  (void)thread;
  atomic_fetch_add(&((atomic_int *)context)[piece], 1);
}

static void test_calls_do_not_mix(void **state)
{
  (void)state;
  enum { MOST = 64, CALLS = 20000 };
  static atomic_int counts[2][MOST];
  for (unsigned call = 0; call < CALLS; call++) {
    const size_t pieces = 2 + call * 2654435761u % (MOST - 2);
    atomic_int *mine = counts[call % 2];
    vsc_parallel_set_threads(2 + (int)(call * 40503u % THREADS));
    for (size_t p = 0; p < MOST; p++) atomic_store(&mine[p], 0);
    vsc_parallel_for(pieces, count_piece, mine);
    for (size_t p = 0; p < MOST; p++) assert_int_equal(mine[p], p < pieces);
  }
}

// A thread that is held up in a piece holds up that piece only: here until all others are done.
typedef struct race {
  atomic_int done;
  atomic_bool held;
} race;

static void do_or_be_held(void *context, size_t piece, int thread)
{
  race *r = context;
  (void)piece;
  if (thread == 0 && !atomic_load(&r->held)) usleep(10);  // so that the other comes in time for a piece
  if (thread == 1 && !atomic_exchange(&r->held, true))
    while (atomic_load(&r->done) < PIECES - 1) sched_yield();
  atomic_fetch_add(&r->done, 1);
}

static void test_a_late_thread_holds_nobody_up(void **state)
{
  (void)state;
  bool held = false;
  vsc_parallel_set_threads(2);
  for (int k = 0; k < 1000 && !held; k++) {  // until the second thread has come in time for a piece
    race r = {0};
    vsc_parallel_for(PIECES, do_or_be_held, &r);
    assert_int_equal(r.done, PIECES);
    held = r.held;
  }
  assert_true(held);
}

// Callers from several threads get all of their own work done.
static void *call_often(void *context)
{
  for (int repeat = 0; repeat < 200; repeat++) vsc_parallel_for(PIECES, add_one, context);
  return NULL;
}

static void test_callers_from_several_threads(void **state)
{
  (void)state;
  static double values[3][PIECES];
  pthread_t callers[3];
  vsc_parallel_set_threads(2);
  for (int c = 0; c < 3; c++) assert_int_equal(pthread_create(&callers[c], NULL, call_often, values[c]), 0);
  for (int c = 0; c < 3; c++) pthread_join(callers[c], NULL);
  for (int c = 0; c < 3; c++)
    for (size_t p = 0; p < PIECES; p++) assert_close(values[c][p], 200.0 * (double)p, 0, 0);
}

static void test_zero_means_all_processors(void **state)
{
  (void)state;
  vsc_parallel_set_threads(0);
  assert_true(vsc_parallel_threads() >= 1);
  vsc_parallel_set_threads(-3);
  assert_true(vsc_parallel_threads() >= 1);
}

int main(void)
{
  const struct CMUnitTest tests[] = {
      cmocka_unit_test(test_each_piece_once),
      cmocka_unit_test(test_results_are_complete),
      cmocka_unit_test(test_calls_do_not_mix),
      cmocka_unit_test(test_a_late_thread_holds_nobody_up),
      cmocka_unit_test(test_callers_from_several_threads),
      cmocka_unit_test(test_zero_means_all_processors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
