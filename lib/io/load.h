// SPDX-License-Identifier: GPL-3.0-or-later
// A whole file in memory.
#ifndef VSC_IO_LOAD_H
#define VSC_IO_LOAD_H

#include <stddef.h>

#include "base/status.h"

// Reads the regular file `file` into *text, `*size` bytes and a zero behind them; the caller frees it with
// vsc_free. VSC_INPUT when it cannot be opened or read, VSC_SYSTEM when memory is short; *text is NULL then.
vsc_status vsc_load(const char *file, char **text, size_t *size, vsc_error *error);

#endif
