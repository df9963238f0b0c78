// SPDX-License-Identifier: GPL-3.0-or-later
#define _GNU_SOURCE  // dladdr
#include "base/module.h"

#include <dlfcn.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

// The folder of the shared library that holds this function, links followed; empty where the file is gone.
static const char *find_folder(char folder[PATH_MAX])
{
  static const char here;
  Dl_info info;
  if (dladdr(&here, &info) == 0 || realpath(info.dli_fname, folder) == NULL) return "";
  *strrchr(folder, '/') = '\0';
  return folder;
}

vsc_status vsc_module_load(const char *name, const char *package, const void **table, vsc_error *error)
{
  char folder[PATH_MAX], file[PATH_MAX + 128], symbol[128];
  snprintf(file, sizeof file, "%s/viscera/%.64s.so", find_folder(folder), name);
  snprintf(symbol, sizeof symbol, "vsc_%.64s_table", name);
  *table = NULL;
  void *module = dlopen(file, RTLD_LAZY | RTLD_LOCAL);
  if (module != NULL) *table = dlsym(module, symbol);
  if (*table != NULL) return VSC_OK;
  return vsc_fail(error, VSC_SYSTEM, "the module %s cannot be loaded (%s): install the package %s, or viscera anew",
                  name, dlerror(), package);
}
