// SPDX-License-Identifier: GPL-3.0-or-later
// viscera bench stability: what tissue survives, what is told when it doesn't, and whether steps are as stable
// as is claimed.
#ifndef VSC_TOOLS_BENCH_STABILITY_H
#define VSC_TOOLS_BENCH_STABILITY_H

// argv[0] is the section's name. Exit code 3: some case was silently wrong, or a step longer than stable.
int vsc_bench_stability(int argc, char **argv);

#endif
