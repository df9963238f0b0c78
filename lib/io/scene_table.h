// SPDX-License-Identifier: GPL-3.0-or-later
// Every key of the scene file, one row each: what it holds, where it goes, how the template shows
// it. Reading, checking, settings, writing and the template walk these rows: a new key, a new row.
#ifndef VSC_IO_SCENE_TABLE_H
#define VSC_IO_SCENE_TABLE_H

#include <cyaml/cyaml.h>

#include "io/scene.h"
#include "io/units.h"

// What a key holds (in the file; in the struct).
typedef enum vsc_row_kind {
  VSC_ROW_QUANTITY,  // a number with its unit; double
  VSC_ROW_UNIT,      // a positive quantity whose number may be left out ("mm", "0.1 deg"); double
  VSC_ROW_VECTOR,    // `count` quantities; double[count]
  VSC_ROW_SERIES,    // any number of quantities; double * (owned) and size_t
  VSC_ROW_BOTH,      // one plain number for both ends of a range; double[2]
  VSC_ROW_NAME,      // a name; char[VSC_NAME]
  VSC_ROW_PATH,      // a file, relative to the scene's folder; char[VSC_PATH]
  VSC_ROW_WHOLE,     // a whole number from 0; unsigned long
  VSC_ROW_WHOLE_INT, // the same; int
  VSC_ROW_INTEGERS,  // up to `count` whole numbers; int[count] and size_t
  VSC_ROW_BOOL,      // true or false; bool
  VSC_ROW_MARK,      // true only; nothing (the key's presence is its meaning)
  VSC_ROW_CHOICE,    // one of `words`; an integer type of `size` bytes
  VSC_ROW_NAMES,     // up to `count` names, of `words` if any; char[count][VSC_NAME], size_t
  VSC_ROW_FLAGS,     // some of `words`; int[] of 0 and 1
  VSC_ROW_TEXT,      // any text; nothing: the group's `finish` takes it from the slot
  VSC_ROW_GROUP,     // a mapping with the keys of `group`; a part of the struct
  VSC_ROW_GROUPS,    // a list of such mappings; array * (owned) and size_t
} vsc_row_kind;

typedef struct vsc_word {
  const char *word;
  int value;  // for CHOICE
} vsc_word;

enum { VSC_ALWAYS = 0x7fffffff };  // `needed`: whatever the kind

typedef struct vsc_row {
  const char *key;
  vsc_row_kind kind;
  vsc_quantity quantity;       // QUANTITY, UNIT, VECTOR, SERIES
  size_t offset;               // of the value in the struct of the group
  size_t size;                 // bytes of the value
  size_t count;                // VECTOR: numbers; INTEGERS, NAMES: the most there can be
  size_t count_offset;         // SERIES, INTEGERS, NAMES, GROUPS: of the size_t that counts them
  const vsc_word *words;       // CHOICE, NAMES, FLAGS; ended by a NULL word
  const struct vsc_group *group;  // GROUP, GROUPS
  const char *zero_word;       // QUANTITY: a word for what is found by itself, stored as 0; a number must be above 0
  unsigned allowed;            // kinds (bits 1 << kind) of the group that have this key; 0: all
  unsigned needed;             // kinds that cannot do without it
  int selects;                 // 1 + the kind that the key's presence gives the group; 0: none
  bool input_only;             // the same thing is written under another key
  bool commented;              // the template shows it behind a '#'
  void (*after)(void *target); // called when the value has been stored
  const char *text;            // in the template: the default, or an example
  const char *meaning;         // in the template
} vsc_row;

// Whether its value is written as a list.
static inline bool vsc_row_is_list(const vsc_row *row)
{
  return row->kind == VSC_ROW_VECTOR || row->kind == VSC_ROW_SERIES || row->kind == VSC_ROW_INTEGERS ||
         row->kind == VSC_ROW_NAMES || row->kind == VSC_ROW_FLAGS || row->kind == VSC_ROW_GROUPS;
}

// As libcyaml loads it: for each row a slot, NULL where the file lacks the key. A group is an array
// of row_count slots; a list of groups is `count` such arrays in one, other lists are
// char *[count].
typedef struct vsc_slot {
  void *value;
  uint64_t count;
} vsc_slot;

struct vsc_reading;

// The keys of one mapping.
typedef struct vsc_group {
  const vsc_row *rows;
  size_t row_count;
  cyaml_schema_field_t *fields;  // room for row_count + 1, filled from the rows when first needed
  size_t size;                   // GROUPS: bytes of the struct of one item
  int kind_offset;               // of the enum that `allowed` and `needed` speak of; -1: none
  void (*start)(void *target);   // GROUPS: sets the defaults of an item
  vsc_status (*finish)(struct vsc_reading *reading, const vsc_slot *slots,
                       void *target);  // what takes more than one row to do or to check
  const char *example;  // what a text "*" of its rows stands for
} vsc_group;

extern const vsc_group vsc_scene_group;  // the whole file; its struct is vsc_scene
extern const vsc_group vsc_curve_group;  // a curve; its struct is vsc_curve_def

// The value of a key that holds one text, or NULL where it is absent.
const void *vsc_slot_value(const vsc_group *group, const vsc_slot *slots, const char *key);

// The row of that key, or NULL.
const vsc_row *vsc_group_find(const vsc_group *group, const char *key);

// "known here: a, b, c; did you mean b?" for a key that is not there.
void vsc_group_hint(const vsc_group *group, const char *key, char *text, size_t size);

// The group's kind (the enum at kind_offset), or -1 when it has none (yet).
int vsc_group_kind(const vsc_group *group, const void *target);

// Whether the row belongs to the group's present kind.
bool vsc_row_allowed(const vsc_row *row, int kind);

// "expected one of a, b, c; did you mean b?" for a word that is none of them.
void vsc_words_hint(const vsc_word *words, const char *word, char *text, size_t size);

// The text of the row in a template or a message.
const char *vsc_row_text(const vsc_group *group, const vsc_row *row);

// The word that stands for `value`, or "?".
const char *vsc_word_of(const vsc_word *words, int value);

#endif
