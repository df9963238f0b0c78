// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef VSC_TOOLS_BENCH_ACCURACY_H
#define VSC_TOOLS_BENCH_ACCURACY_H

// `viscera bench accuracy`: runs the cases of tools/bench/problem.h, each in a process of its own, prints
// what they are off by and what they cost, and leaves accuracy.csv and index.html. argv[0] is
// "accuracy"; returns the program's exit code: 3 when a case failed or missed a target.
int vsc_bench_accuracy(int argc, char **argv);

#endif
