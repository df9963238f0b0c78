// SPDX-License-Identifier: GPL-3.0-or-later
// Compiled with -mavx2 (see CMakeLists.txt); without fused multiply-add, so that its bits are the
// baseline's.
#ifdef __AVX2__
#define KERNEL_SET vsc_kernels_avx2
#define KERNEL_NAME "AVX2"
#include "mech/kernel_body.h"
#else
typedef int vsc_no_avx2;  // a source file must not be empty
#endif
