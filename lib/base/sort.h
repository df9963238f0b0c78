// SPDX-License-Identifier: GPL-3.0-or-later
// Sorting long lists by whole numbers.
#ifndef VSC_BASE_SORT_H
#define VSC_BASE_SORT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// Sorts `count` records of `words` uint32_t each by their first `keys` words, the first word before the second and so
// on; records with equal keys stay in their order. Its time grows as the count does. False, the records being as they
// were, when memory is short.
bool vsc_sort(void *records, size_t count, size_t words, size_t keys);

// Of numbers (not NaN), ascending: for qsort and bsearch.
static inline int vsc_compare_uint32(const void *a, const void *b)
{
  const uint32_t x = *(const uint32_t *)a, y = *(const uint32_t *)b;
  return (x > y) - (x < y);
}

static inline int vsc_compare_uint64(const void *a, const void *b)
{
  const uint64_t x = *(const uint64_t *)a, y = *(const uint64_t *)b;
  return (x > y) - (x < y);
}

static inline int vsc_compare_doubles(const void *a, const void *b)
{
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

#endif
