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

#endif
