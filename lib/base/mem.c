// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/mem.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

static _Thread_local long allocations_left = -1;

void vsc_alloc_fail_after(long count)
{
  allocations_left = count;
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
  if (array != NULL) memset(array, 0, bytes);
  return array;
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
