// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays: zeroed, aligned to a cache line, with the overflow of count * size checked.
#ifndef VSC_BASE_MEM_H
#define VSC_BASE_MEM_H

#include <stdbool.h>
#include <stddef.h>

enum { VSC_ALIGNMENT = 64 };  // bytes; one cache line

// A zeroed array of `count` items of `size` bytes, aligned to VSC_ALIGNMENT. Never NULL for an
// empty array; NULL when there is not enough memory. Release with vsc_free.
void *vsc_alloc(size_t count, size_t size);

// Releases an array of vsc_alloc; NULL is fine.
void vsc_free(void *array);

// `*array` (of `count` items of `size` bytes, or NULL) replaced by a longer copy of `longer` items,
// the new ones zeroed. Returns false, leaving the array as it was, when there is not enough memory.
bool vsc_grow(void **array, size_t count, size_t longer, size_t size);

// For tests: the allocation after `count` more successful ones fails, once; a negative count
// switches the failing off.
void vsc_alloc_fail_after(long count);

// pointer = zeroed array of `count` of what it points to; true when there was memory.
#define VSC_NEW(pointer, count) (((pointer) = vsc_alloc((count), sizeof *(pointer))) != NULL)

#endif
