// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/beside.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

int vsc_become(const char *program, const char *remedy, char **argv)
{
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path - strlen(program) - 1);
  if (length > 0) {
    path[length] = '\0';
    strcpy(strrchr(path, '/') + 1, program);
    execv(path, argv);
  }
  execvp(program, argv);
  fprintf(stderr, "viscera: the program %s can't be started (%s): %s\n", program, strerror(errno), remedy);
  return 4;
}
