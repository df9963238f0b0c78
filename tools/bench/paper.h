// SPDX-License-Identifier: GPL-3.0-or-later
#ifndef VSC_TOOLS_BENCH_PAPER_H
#define VSC_TOOLS_BENCH_PAPER_H

#include "base/status.h"

// Table 1 of Bourguignon & Cani 2000 on this machine: prints the processor time of the hundred
// steps of 0.01 s that make a second, and the number of springs, for a block of 222 masses and 804
// tets and one of 216 masses and 125 hexahedra: classical springs, the paper's law, ours, and what
// they cost over the classical ones.
vsc_status vsc_bench_paper(vsc_error *error);

#endif
