// SPDX-License-Identifier: GPL-3.0-or-later
// What a section of `viscera bench` leaves: a table for programs, and a picture of it.
#ifndef VSC_TOOLS_BENCH_OUTPUT_H
#define VSC_TOOLS_BENCH_OUTPUT_H

#include "io/replace.h"

// The table, under way.
typedef struct vsc_bench_output {
  FILE *csv;  // to write to; NULL: no table is wished
  const char *folder, *name;
  vsc_replacement table;
} vsc_bench_output;

// Begins FOLDER/NAME.csv, making the folder. With `folder` NULL begins the file `csv` instead, and with that NULL too
// nothing: csv of the output is NULL then. VSC_SYSTEM where they cannot be written. Both names are borrowed until the end.
vsc_status vsc_bench_output_begin(vsc_bench_output *output, const char *folder, const char *name, const char *csv,
                                  vsc_error *error);

// Ends it: of a section of another `status` than VSC_OK nothing is left; else the table is put in its place and, in a
// folder, drawn. Returns the status.
vsc_status vsc_bench_output_end(vsc_bench_output *output, vsc_status status, vsc_error *error);

// Draws FOLDER/NAME.csv into FOLDER/NAME.png with that option of `viscera plot`, and says on stdout which of the two
// there are. Why there is no picture is said on stderr.
void vsc_bench_draw(const char *folder, const char *name, const char *option);

// Says on stdout which of FOLDER/NAME.csv and FOLDER/NAME.png there are; returns how many.
int vsc_bench_say_files(const char *folder, const char *name);

#endif
