// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers without pattern that are the same everywhere.
#ifndef VSC_BASE_RANDOM_H
#define VSC_BASE_RANDOM_H

#include <stdint.h>

// The next number in [-1, 1) of the series in *seed (a 64-bit linear congruential generator, Knuth's MMIX).
static inline double vsc_next_random(uint64_t *seed)
{
  *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
  return (double)(int64_t)*seed * 0x1p-63;
}

#endif
