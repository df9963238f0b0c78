// SPDX-License-Identifier: GPL-3.0-or-later
// Young's modulus against direction, for `viscera calibrate --picture`.
#ifndef VSC_TOOLS_PLOT_POLAR_H
#define VSC_TOOLS_PLOT_POLAR_H

// Draws a table of CSV (angle in degrees; then Young's moduli in kPa in the planes f-s, s-n, n-f: three
// in closed form, three measured, perhaps three that were wanted) as three polar diagrams into a PNG.
// Prints why it cannot and returns the exit code.
int vsc_polar_draw(const char *table, const char *picture);

#endif
