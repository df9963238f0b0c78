// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench error: what an error costs.
#ifndef VSC_TOOLS_BENCH_WORK_PRECISION_H
#define VSC_TOOLS_BENCH_WORK_PRECISION_H

// Runs a beating ventricle with many settings, each as a process of its own, and tells the error of each
// against run time; returns an exit code.
int vsc_bench_error(int argc, char **argv);

#endif
