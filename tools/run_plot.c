// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/run_plot.h"

#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/status.h"
#include "tools/beside.h"

int vsc_become_plot(char **argv)
{
  return vsc_become("viscera-plot", "it is built where PLplot and cairo are installed, and belongs beside viscera or in the PATH",
                    argv);
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
