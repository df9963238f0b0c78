// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>

// Arrays from here on ask for large pages, bytes: for less there would be too few whole ones.
#define LARGE ((size_t)4 << 20)
// A small page, or a multiple of one.
#define PAGE ((size_t)1 << 16)

static _Thread_local long allocations_left = -1;

void vsc_alloc_fail_after(long count)
{
  allocations_left = count;
}

// Memory costs most where it is touched for the first time, page by page; large pages are many fewer. Where there are
// none the array stays as it is.
static void ask_for_large_pages(void *array, size_t bytes)
{
#ifdef MADV_HUGEPAGE
  const size_t before = (PAGE - (uintptr_t)array % PAGE) % PAGE;
  madvise((char *)array + before, (bytes - before) / PAGE * PAGE, MADV_HUGEPAGE);
#else
  (void)array, (void)bytes;
#endif
}

void *vsc_alloc(size_t count, size_t size)
{
  if (allocations_left == 0) {
    allocations_left = -1;
    return NULL;
  }
  if (allocations_left > 0) allocations_left--;
  if (size != 0 && count > (SIZE_MAX - VSC_ALIGNMENT) / size) return NULL;
  size_t bytes = (count * size + VSC_ALIGNMENT - 1) / VSC_ALIGNMENT * VSC_ALIGNMENT;
  if (bytes == 0) bytes = VSC_ALIGNMENT;
  void *array = aligned_alloc(VSC_ALIGNMENT, bytes);
  if (array == NULL) return NULL;
  if (bytes >= LARGE) ask_for_large_pages(array, bytes);
  return memset(array, 0, bytes);
}

void vsc_free(void *array)
{
  free(array);
}

bool vsc_grow(void **array, size_t count, size_t longer, size_t size)
{
  void *copy = vsc_alloc(longer, size);
  if (copy == NULL) return false;
  if (*array != NULL) memcpy(copy, *array, count * size);
  vsc_free(*array);
  *array = copy;
  return true;
}
