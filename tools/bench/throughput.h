// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench throughput, growth: what a step costs.
#ifndef VSC_TOOLS_BENCH_THROUGHPUT_H
#define VSC_TOOLS_BENCH_THROUGHPUT_H

// Each is a section of `viscera bench` with options of its own (--help tells them); returns an exit code.
int vsc_bench_throughput(int argc, char **argv);
int vsc_bench_growth(int argc, char **argv);

#endif
