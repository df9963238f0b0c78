// SPDX-License-Identifier: GPL-3.0-or-later
// A radix sort, the least digit first.
#include "base/sort.h"

#include <string.h>

#include "base/mem.h"
#include "base/wide.h"

enum { DIGIT = 11, WIDTH = 1 << DIGIT };  // bits of a digit at most, and its values

// The bits of a word in which records differ.
static uint32_t differing_bits(const uint32_t *records, size_t count, size_t words, size_t key)
{
  uint32_t some = 0, all = UINT32_MAX;
  for (size_t k = 0; k < count; k++) {
    some |= records[words * k + key];
    all &= records[words * k + key];
  }
  return some ^ all;
}

VSC_INLINE void scatter(const uint32_t *from, size_t count, size_t words, size_t key, int shift, uint32_t mask,
                        size_t *place, uint32_t *to)
{
  for (size_t k = 0; k < count; k++) {
    const uint32_t *record = from + words * k;
    uint32_t *free = to + words * place[record[key] >> shift & mask]++;
    for (size_t w = 0; w < words; w++) free[w] = record[w];
  }
}

// Writes the records to `to` in the order of one digit of a word, its `bits` bits from `shift` on.
static void sort_by_digit(const uint32_t *from, size_t count, size_t words, size_t key, int shift, int bits, uint32_t *to)
{
  size_t place[WIDTH + 1] = {0};
  const uint32_t mask = (1u << bits) - 1;
  for (size_t k = 0; k < count; k++) place[(from[words * k + key] >> shift & mask) + 1]++;
  for (uint32_t i = 0; i < mask; i++) place[i + 1] += place[i];
  // of known size records are copied at once
  switch (words) {
    case 3: scatter(from, count, 3, key, shift, mask, place, to); break;
    case 4: scatter(from, count, 4, key, shift, mask, place, to); break;
    case 6: scatter(from, count, 6, key, shift, mask, place, to); break;
    default: scatter(from, count, words, key, shift, mask, place, to);
  }
}

bool vsc_sort(void *records, size_t count, size_t words, size_t keys)
{
  uint32_t *from = records, *to;
  if (count < 2) return true;
  if (!VSC_NEW(to, words * count)) return false;
  uint32_t *const memory = to;
  for (size_t key = keys; key-- > 0;) {
    const uint32_t differing = differing_bits(from, count, words, key);
    if (differing == 0) continue;
    const int low = __builtin_ctz(differing), high = 32 - __builtin_clz(differing);
    const int digits = (high - low + DIGIT - 1) / DIGIT, bits = (high - low + digits - 1) / digits;
    for (int shift = low; shift < high; shift += bits) {
      sort_by_digit(from, count, words, key, shift, bits, to);
      uint32_t *const sorted = to;
      to = from;
      from = sorted;
    }
  }
  if (from == memory) memcpy(records, from, words * count * sizeof *from);
  vsc_free(memory);
  return true;
}
