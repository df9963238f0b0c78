// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/shipped.h"

#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

const char *vsc_shipped(const char *name, char *path, size_t size)
{
  static const char *const from_program[] = {"../../data", "../share/viscera"};
  char program[PATH_MAX];
  snprintf(path, size, "data/%s", name);
  const ssize_t length = access(path, R_OK) == 0 ? 0 : readlink("/proc/self/exe", program, sizeof program - 1);
  if (length <= 0) return path;
  program[length] = '\0';
  *strrchr(program, '/') = '\0';
  for (size_t k = 0; k < sizeof from_program / sizeof from_program[0]; k++) {
    snprintf(path, size, "%s/%s/%s", program, from_program[k], name);
    if (access(path, R_OK) == 0) return path;
  }
  snprintf(path, size, "data/%s", name);
  return path;
}

vsc_status vsc_shipped_check(const char *path, const char *option, vsc_error *error)
{
  if (access(path, R_OK) == 0) return VSC_OK;
  return vsc_fail(error, VSC_INPUT,
                  "%s: cannot be read; what comes with viscera lies in data/ of its sources or in share/viscera beside "
                  "the folder of the installed program: run that one, or name another place by %s",
                  path, option);
}
