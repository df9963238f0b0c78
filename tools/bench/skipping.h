// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench skipping: what features cost while they are used, and while they are there but idle.
#ifndef VSC_TOOLS_BENCH_SKIPPING_H
#define VSC_TOOLS_BENCH_SKIPPING_H

// A section of `viscera bench` with options of its own (--help tells them); returns an exit code.
int vsc_bench_skipping(int argc, char **argv);

#endif
