// SPDX-License-Identifier: GPL-3.0-or-later
// Files of data/ that come with viscera.
#ifndef VSC_TOOLS_SHIPPED_H
#define VSC_TOOLS_SHIPPED_H

#include <stddef.h>

#include "base/status.h"

// Where `name` of data/ lies: under the current folder, in the checkout that the running program was built in, or
// where it was installed to; "data/NAME" when it is nowhere. Fills `path` of `size` bytes and returns it.
const char *vsc_shipped(const char *name, char *path, size_t size);

// VSC_INPUT, saying where it was looked for and that `option` names another, when `path` cannot be read.
vsc_status vsc_shipped_check(const char *path, const char *option, vsc_error *error);

#endif
