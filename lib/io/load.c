// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/load.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

#include "base/mem.h"

static vsc_status load(const char *file, FILE *stream, char **text, size_t *size, vsc_error *error)
{
  struct stat facts;
  if (fstat(fileno(stream), &facts) != 0 || !S_ISREG(facts.st_mode))
    return vsc_fail(error, VSC_INPUT, "%s: is not a regular file", file);
  *size = (size_t)facts.st_size;
  if (!VSC_NEW(*text, *size + 1)) return vsc_fail_memory(error, "a file's text");
  if (fread(*text, 1, *size, stream) == *size) return VSC_OK;
  vsc_free(*text);
  *text = NULL;
  return vsc_fail(error, VSC_INPUT, "%s: cannot be read: %s", file, strerror(errno));
}

vsc_status vsc_load(const char *file, char **text, size_t *size, vsc_error *error)
{
  *text = NULL;
  FILE *stream = fopen(file, "rb");
  if (stream == NULL)
    return vsc_fail(error, VSC_INPUT, "%s: cannot be opened: %s: check the name", file,
                    strerror(errno));
  const vsc_status status = load(file, stream, text, size, error);
  fclose(stream);
  return status;
}
