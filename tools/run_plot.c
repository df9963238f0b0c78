// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/run_plot.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/status.h"

int vsc_become_plot(char **argv)
{
  char path[PATH_MAX];
  const ssize_t length = readlink("/proc/self/exe", path, sizeof path - sizeof "viscera-plot");
  if (length > 0) {
    path[length] = '\0';
    strcpy(strrchr(path, '/') + 1, "viscera-plot");
    execv(path, argv);
  }
  execvp("viscera-plot", argv);
  fprintf(
      stderr,
      "viscera: the program viscera-plot can't be started (%s): it is built where PLplot and cairo "
      "are installed, and belongs beside viscera or in the PATH\n",
      strerror(errno));
  return VSC_SYSTEM;
}

int vsc_run_plot(char **argv)
{
  int state;
  fflush(stdout);
  const pid_t child = fork();
  if (child == 0) _exit(vsc_become_plot(argv));
  if (child < 0 || waitpid(child, &state, 0) < 0) return VSC_SYSTEM;
  return WIFEXITED(state) ? WEXITSTATUS(state) : VSC_SYSTEM;
}
