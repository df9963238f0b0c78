// SPDX-License-Identifier: GPL-3.0-or-later
// The picture program, viscera-plot, which lies beside this one or in the PATH.
#ifndef VSC_TOOLS_RUN_PLOT_H
#define VSC_TOOLS_RUN_PLOT_H

// Becomes the picture program with these arguments (argv[0] to NULL); returns the exit code, having
// printed why, only when it cannot be started.
int vsc_become_plot(char **argv);

// Runs it and waits; returns its exit code.
int vsc_run_plot(char **argv);

#endif
