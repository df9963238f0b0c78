// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/status.h"

#include <stdarg.h>
#include <stdio.h>

vsc_status vsc_fail(vsc_error *error, vsc_status status, const char *format, ...)
{
  if (error == NULL) return status;
  error->status = status;
  va_list arguments;
  va_start(arguments, format);
  vsnprintf(error->text, sizeof error->text, format, arguments);
  va_end(arguments);
  for (char *c = error->text; *c != '\0'; c++)
    if ((unsigned char)*c < ' ') *c = ' ';
  return status;
}

vsc_status vsc_in_list(const char *list, size_t index, vsc_status status, vsc_error *error)
{
  if (status != VSC_INPUT || error == NULL) return status;
  const vsc_error bare = *error;
  return vsc_fail(error, status, "%s[%zu] %s", list, index, bare.text);
}

vsc_status vsc_fail_memory(vsc_error *error, const char *what)
{
  return vsc_fail(error, VSC_SYSTEM,
                  "out of memory for %s: use a smaller mesh or a machine with more memory", what);
}
