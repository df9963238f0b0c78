// SPDX-License-Identifier: GPL-3.0-or-later
// A radix sort, the least digit first.
#include "base/sort.h"

#include <string.h>

#include "base/mem.h"

enum { DIGIT = 11, WIDTH = 1 << DIGIT, DIGITS = 3 };  // of a word

// Writes the records to `to` in the order of one digit of a word, and returns whether they differ in it: otherwise
// there is nothing to do.
static bool sort_by_digit(const uint32_t *from, size_t count, size_t words, size_t key, int digit, uint32_t *to)
{
  size_t place[WIDTH + 1] = {0};
  const int shift = DIGIT * digit;
  for (size_t k = 0; k < count; k++) place[(from[words * k + key] >> shift & (WIDTH - 1)) + 1]++;
  if (place[(from[key] >> shift & (WIDTH - 1)) + 1] == count) return false;
  for (int i = 0; i < WIDTH; i++) place[i + 1] += place[i];
  for (size_t k = 0; k < count; k++) {
    const uint32_t *record = from + words * k;
    uint32_t *free = to + words * place[record[key] >> shift & (WIDTH - 1)]++;
    for (size_t w = 0; w < words; w++) free[w] = record[w];
  }
  return true;
}

bool vsc_sort(void *records, size_t count, size_t words, size_t keys)
{
  uint32_t *from = records, *to;
  if (count < 2) return true;
  if (!VSC_NEW(to, words * count)) return false;
  uint32_t *const memory = to;
  for (size_t key = keys; key-- > 0;)
    for (int digit = 0; digit < DIGITS; digit++)
      if (sort_by_digit(from, count, words, key, digit, to)) {
        uint32_t *const sorted = to;
        to = from;
        from = sorted;
      }
  if (from == memory) memcpy(records, from, words * count * sizeof *from);
  vsc_free(memory);
  return true;
}
