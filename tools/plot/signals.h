// SPDX-License-Identifier: GPL-3.0-or-later
// The signals that a simulation left behind: a table of numbers whose columns have names and units.
#ifndef VSC_TOOLS_PLOT_SIGNALS_H
#define VSC_TOOLS_PLOT_SIGNALS_H

#include <stddef.h>

#include "base/status.h"
#include "base/text.h"

typedef struct vsc_signals {
  size_t columns;
  size_t rows;
  char (*names)[VSC_NAME];  // columns: "time", "cavity_lv", ...
  char (*units)[VSC_NAME];  // columns: "s", "ml", ...; empty where there is none
  double *values;           // columns x rows: one column after the other
} vsc_signals;

// Reads a comma-separated file whose first line is `name [unit],name [unit],...`. The last line may lack
// its end; in a file called signals.csv, which a simulation may still write, it is then left out.
// VSC_INPUT with file and line for anything that is wrong. The caller owns *signals.
vsc_status vsc_signals_read(const char *file, vsc_signals **signals, vsc_error *error);

// The values (rows of them, owned by the table) of the column of that name, or NULL.
const double *vsc_signals_find(const vsc_signals *signals, const char *name);

// The number of the first column at or after `from` whose name begins with `prefix`, or
// signals->columns.
size_t vsc_signals_next(const vsc_signals *signals, const char *prefix, size_t from);

void vsc_signals_free(vsc_signals *signals);  // NULL is fine

#endif
