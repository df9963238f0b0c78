// SPDX-License-Identifier: GPL-3.0-or-later
// Small helps for names and messages.
#ifndef VSC_BASE_TEXT_H
#define VSC_BASE_TEXT_H

#include <stdbool.h>
#include <stddef.h>

enum { VSC_NAME = 64 };  // bytes of a name (array, region, set, surface) with its terminating zero

// Number of letters to insert, delete or replace to turn `a` into `b` (Levenshtein), letters
// compared without case.
size_t vsc_edit_distance(const char *a, const char *b);

// The word of `words` (count of them) nearest to `word`, or NULL when none is near
// (distance above half of the longer one's length).
const char *vsc_nearest(const char *word, const char *const *words, size_t count);

// Copies `from` into the name field `to` (VSC_NAME bytes), cut if it is longer.
void vsc_copy_name(char to[VSC_NAME], const char *from);

// Whether a name can stand in the header of a table and in JSON as it is: no comma, bracket, quote, backslash or
// control character in it.
bool vsc_name_is_plain(const char *name);

#endif
