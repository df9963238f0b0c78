// SPDX-License-Identifier: GPL-3.0-or-later
// A verb of the program in a process of its own: what it costs can be told apart, what it prints goes
// into a file, and one that dies or takes too long takes nothing with it.
#ifndef VSC_TOOLS_BENCH_CHILD_H
#define VSC_TOOLS_BENCH_CHILD_H

#include "base/status.h"

enum { VSC_CHILD_WORDS = 96 };  // of a command, with the NULL behind them

typedef struct vsc_child_cost {
  double cpu_seconds;  // of all threads, from start to end
  double megabytes;    // largest resident memory, 1e6 bytes
} vsc_child_cost;

// Runs verb(words) with NULL behind the last of `words` (words[0] is the verb's name), both outputs going
// to the end of the file `log`, for at most `limit` seconds of processor time. Returns the verb's own
// status with the last line that it printed; VSC_NUMERICAL for one that ran into the limit, VSC_SYSTEM
// for one that died. Must not be called by a process whose threads have begun to work.
vsc_status vsc_child(int (*verb)(int argc, char **argv), char **words, const char *log, double limit,
                     vsc_child_cost *cost, vsc_error *error);

// Appends the words of `text` (separated by blanks) behind the `count` words there are; they point into
// `text`, which is cut up. Returns the new count; at most VSC_CHILD_WORDS - 1.
int vsc_child_split(char *text, int count, char *words[VSC_CHILD_WORDS]);

#endif
