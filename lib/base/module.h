// SPDX-License-Identifier: GPL-3.0-or-later
// Modules: parts of viscera that need a library which most runs do not. They lie in the folder `viscera` beside the
// shared library and are loaded when first needed, and with them what they are linked to.
#ifndef VSC_BASE_MODULE_H
#define VSC_BASE_MODULE_H

#include "base/status.h"

// Loads the module `name`, the file viscera/NAME.so beside the library, which then stays loaded, and gives the table of
// its functions: the constant called vsc_NAME_table. May be called again, by any thread. VSC_SYSTEM when the module or
// a library that it needs is missing or has no such table; the message names it and the Debian `package` to install.
vsc_status vsc_module_load(const char *name, const char *package, const void **table, vsc_error *error);

#endif
