// SPDX-License-Identifier: GPL-3.0-or-later
// Floating-point exceptions as signals. Tests whose subject is what happens after numbers are lost (a step above
// the stable one, positions that are no numbers) go between trap_off and trap_on; so do callers of libraries
// that compute with infinities on purpose.
#ifndef VSC_TESTS_TRAP_H
#define VSC_TESTS_TRAP_H

#include <fenv.h>

enum { TRAPPED = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

static inline void trap_on(void)
{
  feclearexcept(FE_ALL_EXCEPT);
  feenableexcept(TRAPPED);
}

static inline void trap_off(void)
{
  fedisableexcept(TRAPPED);
}

#endif
