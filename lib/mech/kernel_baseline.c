// SPDX-License-Identifier: GPL-3.0-or-later
#define KERNEL_SET vsc_kernels_baseline
#define KERNEL_NAME "baseline"
#include "mech/kernel_body.h"
