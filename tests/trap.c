// SPDX-License-Identifier: GPL-3.0-or-later
// Linked into every test program: arithmetic that makes NaN from numbers, infinity from finite ones or divides
// by zero ends it at the place (tests/trap.h says where that is allowed).
#include "trap.h"

__attribute__((constructor)) static void begin_trapping(void)
{
  trap_on();
}
