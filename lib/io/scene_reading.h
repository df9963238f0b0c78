// SPDX-License-Identifier: GPL-3.0-or-later
// What the parts of the scene reader share while one scene is read.
#ifndef VSC_IO_SCENE_READING_H
#define VSC_IO_SCENE_READING_H

#include "io/locate.h"
#include "io/scene_table.h"

enum { VSC_SCENE_KEY = 200 };  // bytes of a key such as "materials[0].active.curve.kind"

// One `key=value` of the command line.
typedef struct vsc_setting {
  char key[VSC_SCENE_KEY];
  const char *text;  // all of it, borrowed
} vsc_setting;

typedef struct vsc_reading {
  const char *file;               // the scene's name as the user gave it
  const vsc_locator *locator;     // finds the line of a key
  const vsc_setting *settings;
  size_t setting_count;
  const vsc_setting *current;     // the setting that is being put in; NULL: the file is being read
  vsc_scene *scene;               // being filled, borrowed
  char key[VSC_SCENE_KEY];        // where the reading is
  vsc_error *error;
} vsc_reading;

// Appends ".key" or "[item]" to reading->key; returns the former length, to which vsc_leave
// goes back.
size_t vsc_enter(vsc_reading *reading, const char *key);
size_t vsc_enter_item(vsc_reading *reading, size_t item);
void vsc_leave(vsc_reading *reading, size_t length);

// VSC_INPUT with "file:line: key: text" for the key where the reading is; for a key that a setting
// gave, "file: --set text: key: text".
vsc_status vsc_reading_fail(const vsc_reading *reading, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// The same for an error whose text begins with "key: ".
vsc_status vsc_reading_locate(const vsc_reading *reading, const vsc_error *found);

// "dir/file" when `file` is relative, dir being the scene's folder; too long a name fails. It becomes one of the
// scene's inputs.
vsc_status vsc_scene_resolve(vsc_reading *reading, const char *file, char resolved[VSC_PATH]);

// Fails unless `file` is a file that can be read.
vsc_status vsc_scene_file_exists(vsc_reading *reading, const char *file);

// Loads the text of a whole scene through libcyaml: *slots (vsc_scene_group.row_count) on success.
vsc_status vsc_scene_load(vsc_reading *reading, const char *text, size_t size, vsc_slot **slots);
void vsc_scene_unload(vsc_slot *slots);

// Loads the value of one row (of a setting) into `slot`, whose former content is released.
vsc_status vsc_scene_load_value(vsc_reading *reading, const vsc_row *row, const char *text,
                                vsc_slot *slot);

// Puts a setting ("key=value") into the slots, and its key into `setting`.
vsc_status vsc_scene_set(vsc_reading *reading, vsc_slot *slots, vsc_setting *setting);

// Turns the slots of a group into the fields of `target`, row by row.
vsc_status vsc_group_convert(vsc_reading *reading, const vsc_group *group, const vsc_slot *slots,
                             void *target);

// One value of any kind but the groups: into its field; and from it, as YAML, to a stream.
vsc_status vsc_row_read(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                        void *target);
void vsc_row_write(FILE *stream, const vsc_row *row, const void *target);

// `finish` of the groups: rules that look at several keys of a curve, of a surface or node set.
vsc_status vsc_curve_finish(vsc_reading *reading, const vsc_slot *slots, void *curve);
vsc_status vsc_selector_finish(vsc_reading *reading, const vsc_slot *slots, void *selector);

// The rules that need the whole scene: files, names, ranges, vsc_definition_check.
vsc_status vsc_scene_check(vsc_reading *reading, const vsc_scene *scene);

#endif
