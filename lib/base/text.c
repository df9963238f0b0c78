// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/text.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { LONGEST = 128 };

size_t vsc_edit_distance(const char *a, const char *b)
{
  const size_t m = strnlen(a, LONGEST), n = strnlen(b, LONGEST);
  size_t row[LONGEST + 1];
  for (size_t j = 0; j <= n; j++) row[j] = j;
  for (size_t i = 1; i <= m; i++) {
    size_t diagonal = row[0];
    row[0] = i;
    for (size_t j = 1; j <= n; j++) {
      const size_t above = row[j];
      size_t best =
          diagonal + (tolower((unsigned char)a[i - 1]) != tolower((unsigned char)b[j - 1]));
      if (above + 1 < best) best = above + 1;
      if (row[j - 1] + 1 < best) best = row[j - 1] + 1;
      diagonal = above;
      row[j] = best;
    }
  }
  return row[n];
}

const char *vsc_nearest(const char *word, const char *const *words, size_t count)
{
  const char *nearest = NULL;
  size_t least = 0;
  for (size_t k = 0; k < count; k++) {
    const size_t distance = vsc_edit_distance(word, words[k]);
    const size_t a = strlen(word), b = strlen(words[k]);
    if (2 * distance > (a > b ? a : b)) continue;
    if (nearest != NULL && distance >= least) continue;
    nearest = words[k];
    least = distance;
  }
  return nearest;
}

void vsc_copy_name(char to[VSC_NAME], const char *from)
{
  snprintf(to, VSC_NAME, "%s", from);
}

bool vsc_name_is_plain(const char *name)
{
  for (const char *c = name; *c != '\0'; c++)
    if (strchr(",[]\"\\", *c) != NULL || (unsigned char)*c < ' ' || *c == 0x7f) return false;
  return true;
}
