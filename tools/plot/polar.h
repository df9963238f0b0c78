// SPDX-License-Identifier: GPL-3.0-or-later
// Young's modulus against direction.
#ifndef VSC_TOOLS_PLOT_POLAR_H
#define VSC_TOOLS_PLOT_POLAR_H

#include "base/status.h"

// Reads the curves that `viscera calibrate` wrote (columns plane, angle, wanted, springs, measured)
// and draws them, one plane beside the other, into a PNG by way of a temporary name. A curve that
// is nan throughout is left out.
vsc_status vsc_polar_draw(const char *csv, const char *title, const char *file, vsc_error *error);

#endif
