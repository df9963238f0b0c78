// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera check` says of a scene's method.
#ifndef VSC_RUN_CHECK_METHOD_H
#define VSC_RUN_CHECK_METHOD_H

#include <stdio.h>

#include "run/problem.h"

// Writes to `stream`, of explicit stepping: the stable step, where it is limited, by damping where that rules, and by
// which element if there were only stiffness; what steps cost on this machine, of which it does some. Of other methods:
// how balances are solved, and how large they are. VSC_INPUT and VSC_NUMERICAL as of the method's start; VSC_SYSTEM
// when memory is short.
vsc_status vsc_check_method(const vsc_problem *problem, FILE *stream, vsc_error *error);

#endif
