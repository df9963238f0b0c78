// SPDX-License-Identifier: GPL-3.0-or-later
// What a Prony series must obey. Internal to model.
#ifndef VSC_MODEL_PRONY_CHECK_H
#define VSC_MODEL_PRONY_CHECK_H

#include "model/definition.h"

// Refuses (VSC_INPUT, with key, value and remedy) series of materials that are no series, or that what
// else the definition asks for cannot step: parts or times not above zero, parts of sum 1 or more, laws
// that are no functions of strain, smoothed tets.
vsc_status vsc_prony_check(const vsc_definition *definition, vsc_error *error);

#endif
