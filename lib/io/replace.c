// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/replace.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

vsc_status vsc_replace_begin(const char *file, char temporary[VSC_FILE_NAME], vsc_error *error)
{
  const int length = snprintf(temporary, VSC_FILE_NAME, "%s.tmp", file);
  if (length < 0 || length >= VSC_FILE_NAME)
    return vsc_fail(error, VSC_INPUT, "%.200s...: the file name is too long: choose a shorter one",
                    file);
  const int handle = open(temporary, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (handle < 0)
    return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s: choose another folder", file,
                    strerror(errno));
  close(handle);
  return VSC_OK;
}

static int sync_file(const char *file)
{
  const int handle = open(file, O_RDONLY | O_CLOEXEC);
  if (handle < 0) return -1;
  const int result = fsync(handle);
  const int reason = errno;
  close(handle);
  errno = reason;
  return result;
}

vsc_status vsc_replace_end(const char *file, const char *temporary, bool durable, vsc_error *error)
{
  if ((!durable || sync_file(temporary) == 0) && rename(temporary, file) == 0) return VSC_OK;
  const int reason = errno;
  vsc_replace_cancel(temporary);
  return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s: choose another folder", file,
                  strerror(reason));
}

void vsc_replace_cancel(const char *temporary)
{
  unlink(temporary);
}

FILE *vsc_replace_open(const char *file, char temporary[VSC_FILE_NAME], vsc_error *error)
{
  struct stat facts;
  temporary[0] = '\0';
  const bool aside = stat(file, &facts) != 0 || S_ISREG(facts.st_mode);
  if (aside && vsc_replace_begin(file, temporary, error) != VSC_OK) return NULL;
  FILE *stream = fopen(aside ? temporary : file, "w");
  if (stream == NULL)
    vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s: choose another file", file, strerror(errno));
  return stream;
}

vsc_status vsc_replace_close(FILE *stream, const char *file, const char *temporary, vsc_error *error)
{
  const bool bad = ferror(stream) != 0, aside = temporary[0] != '\0';
  if (fclose(stream) == 0 && !bad)
    return aside ? vsc_replace_end(file, temporary, false, error) : VSC_OK;
  const int reason = errno;
  if (aside) vsc_replace_cancel(temporary);
  return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s: choose another folder", file,
                  strerror(reason));
}
