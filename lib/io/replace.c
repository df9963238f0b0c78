// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/replace.h"

#include <errno.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static vsc_status fail_to_write(const char *file, int reason, vsc_error *error)
{
  return vsc_fail(error, VSC_SYSTEM, "%s: cannot be written: %s: choose another folder, or free some space", file,
                  reason != 0 ? strerror(reason) : "not all of it arrives");
}

vsc_status vsc_replace_begin(const char *file, vsc_replacement *replacement, vsc_error *error)
{
  struct stat facts;
  const bool itself = stat(file, &facts) == 0 && !S_ISREG(facts.st_mode);
  const int length = snprintf(replacement->temporary, VSC_FILE_NAME, "%s.tmp", file);
  if (length < 0 || length >= VSC_FILE_NAME)
    return vsc_fail(error, VSC_INPUT, "%.200s...: the file name is too long: choose a shorter one",
                    file);
  snprintf(replacement->file, VSC_FILE_NAME, "%s", file);
  if (itself) replacement->temporary[0] = '\0';
  errno = 0;  // from here on it is that of writing
  replacement->stream = fopen(itself ? file : replacement->temporary, "wbe");
  return replacement->stream != NULL ? VSC_OK : fail_to_write(file, errno, error);
}

vsc_status vsc_replace_end(vsc_replacement *replacement, bool durable, vsc_error *error)
{
  FILE *stream = replacement->stream;
  bool good = fflush(stream) == 0 && ferror(stream) == 0;
  if (good && durable) good = fsync(fileno(stream)) == 0;
  int reason = errno;
  if (fclose(stream) != 0 && good) good = false, reason = errno;
  const bool itself = replacement->temporary[0] == '\0';
  if (good && (itself || rename(replacement->temporary, replacement->file) == 0)) return VSC_OK;
  if (good) reason = errno;
  if (!itself) unlink(replacement->temporary);
  return fail_to_write(replacement->file, reason, error);
}

void vsc_replace_cancel(vsc_replacement *replacement)
{
  fclose(replacement->stream);
  if (replacement->temporary[0] != '\0') unlink(replacement->temporary);
}

vsc_status vsc_replace_whole(const char *file, const void *bytes, size_t size, bool durable, vsc_error *error)
{
  vsc_replacement replacement;
  const vsc_status status = vsc_replace_begin(file, &replacement, error);
  if (status != VSC_OK) return status;
  fwrite(bytes, 1, size, replacement.stream);
  return vsc_replace_end(&replacement, durable, error);
}
