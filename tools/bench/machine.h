// SPDX-License-Identifier: GPL-3.0-or-later
// What this machine can do at most, measured in the same run as what the program does.
#ifndef VSC_TOOLS_BENCH_MACHINE_H
#define VSC_TOOLS_BENCH_MACHINE_H

#include <stdio.h>

typedef struct vsc_machine {
  double bandwidth;   // of one core, bytes/s: a_i = b_i + 3 c_i over arrays far larger than any cache
                      // (STREAM's triad; 24 bytes each)
  double arithmetic;  // of one core, additions and multiplications in double precision a second, as
                      // many as can be under way at once, not fused
} vsc_machine;

// Measures both, the best of some tries, by processor time; half a second, 480 MB for the time being.
// Zeros when there is no memory.
vsc_machine vsc_machine_measure(void);

// The same bandwidth over arrays of `bytes` in all, which may lie in a cache, the best of some tries; 0 when there is no
// memory.
double vsc_machine_bandwidth(double bytes);

// One line: processor, compiler, version of the program, threads.
void vsc_machine_say(FILE *out);

#endif
