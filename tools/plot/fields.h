// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as CSV, whose fields may stand in quotes.
#ifndef VSC_TOOLS_PLOT_FIELDS_H
#define VSC_TOOLS_PLOT_FIELDS_H

#include <stdbool.h>
#include <stddef.h>

#include "base/status.h"

enum { VSC_MOST_FIELDS = 16 };  // of a line; what is beyond is left out

// Takes one line; false: it is not as it should be.
typedef bool vsc_fields_line(char *const *field, size_t fields, void *context);

// Gives all lines but the first, the heading, to `take`, until one is not as it should be: *good is false then, and where
// there is no heading. VSC_INPUT for a file that cannot be read.
vsc_status vsc_fields_read(const char *csv, vsc_fields_line *take, void *context, bool *good, vsc_error *error);

#endif
