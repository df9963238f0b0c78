// SPDX-License-Identifier: GPL-3.0-or-later
// Each piece of work is done once, by a thread that has scratch memory of its own.
#include "base/parallel.h"

#include <pthread.h>
#include <stdatomic.h>

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
      cmocka_unit_test(test_zero_means_all_processors),
  };
  return cmocka_run_group_tests(tests, NULL, NULL);
}
