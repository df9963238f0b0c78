// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera plot` does for several results.
#ifndef VSC_TOOLS_PLOT_SEVERAL_H
#define VSC_TOOLS_PLOT_SEVERAL_H

// argv[0] is --view or --curves, its options and results follow; returns the program's exit code.
int vsc_plot_several(int argc, char **argv);

#endif
