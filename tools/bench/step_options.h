// SPDX-License-Identifier: GPL-3.0-or-later
// Options of the sections of `viscera bench` that time steps of blocks.
#ifndef VSC_TOOLS_BENCH_STEP_OPTIONS_H
#define VSC_TOOLS_BENCH_STEP_OPTIONS_H

#include <stdbool.h>

#include "tools/bench/output.h"

typedef struct vsc_step_wish {
  long elements;  // 0: as the section has it
  bool large;
  vsc_bench_output output;  // begun
} vsc_step_wish;

// Reads the options of section `name`. Returns false, and in *code the exit code, when help was asked for or something
// was wrong, which has been said then.
bool vsc_step_options(const char *name, int argc, char **argv, vsc_step_wish *wish, int *code);

// What ends a section: its table ended, its error said. Returns the exit code.
int vsc_step_finish(vsc_step_wish *wish, vsc_status status, vsc_error *error);

#endif
