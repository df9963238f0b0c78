// SPDX-License-Identifier: GPL-3.0-or-later
// `viscera bench start`: from the shell to the first frame, and where the time of a run goes.
#ifndef VSC_TOOLS_BENCH_FIRST_FRAME_H
#define VSC_TOOLS_BENCH_FIRST_FRAME_H

int vsc_bench_start(int argc, char **argv);  // the verb's section; returns the exit code

#endif
