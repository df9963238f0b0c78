// SPDX-License-Identifier: GPL-3.0-or-later
// FNV-1a (Fowler, Noll, Vo), 64 bits: tells whether two runs have the same bits.
#ifndef VSC_BASE_HASH_H
#define VSC_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>

#define VSC_HASH_START UINT64_C(14695981039346656037)

// The hash `hash` continued over `bytes` bytes of `data`.
static inline uint64_t vsc_hash(uint64_t hash, const void *data, size_t bytes)
{
  const unsigned char *byte = data;
  for (size_t i = 0; i < bytes; i++) hash = (hash ^ byte[i]) * UINT64_C(1099511628211);
  return hash;
}

#endif
