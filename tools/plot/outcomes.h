// SPDX-License-Identifier: GPL-3.0-or-later
// The map of `viscera bench stability`: what became of each stress with each kind of element and method.
#ifndef VSC_TOOLS_PLOT_OUTCOMES_H
#define VSC_TOOLS_PLOT_OUTCOMES_H

#include "base/status.h"

// Draws stability.csv into the PNG `file`: a field for each stress (down), method and kind of element (across),
// filled with the outcomes' colours by their shares and with the number of cases written into it. VSC_INPUT when
// the CSV is not of that kind, VSC_SYSTEM when the picture cannot be written.
vsc_status vsc_outcomes_draw(const char *csv, const char *file, vsc_error *error);

#endif
