// SPDX-License-Identifier: GPL-3.0-or-later
// `key=value` settings of the command line, put where libcyaml would have put them.
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_reading.h"

// Where the walk along a setting's key has come to.
typedef struct place {
  const vsc_group *group;  // whose rows the next word of the key names; NULL: none can follow
  vsc_slot *slots;
  const vsc_row *row;  // the row last named
  vsc_slot *slot;
  bool item;  // at one item of the row's list
  size_t item_number;
} place;

static bool is_groups(const vsc_row *row)
{
  return row->kind == VSC_ROW_GROUPS;
}

static vsc_status step_into_key(vsc_reading *reading, place *at, const char *word)
{
  char hint[400];
  if (at->row != NULL && is_groups(at->row) && !at->item)
    return vsc_reading_fail(reading, "a list; name an item, such as %s[0].%s", reading->key, word);
  if (at->group == NULL) {
    vsc_enter(reading, word);
    return vsc_reading_fail(reading, "unknown key; %s has no keys below it", at->row->key);
  }
  vsc_enter(reading, word);
  const vsc_row *row = vsc_group_find(at->group, word);
  if (row == NULL) {
    vsc_group_hint(at->group, word, hint, sizeof hint);
    return vsc_reading_fail(reading, "unknown key; %s", hint);
  }
  *at = (place){.row = row, .slot = &at->slots[row - at->group->rows], .group = row->group};
  return VSC_OK;
}

// Makes the group that the place is at, if the scene has none, so that the walk can go on inside.
static vsc_status open_group(vsc_reading *reading, place *at)
{
  if (at->row->kind != VSC_ROW_GROUP || at->slots != NULL) return VSC_OK;
  if (at->slot->value == NULL) at->slot->value = calloc(at->group->row_count, sizeof(vsc_slot));
  if (at->slot->value == NULL) return vsc_fail_memory(reading->error, "a setting");
  at->slots = at->slot->value;
  return VSC_OK;
}

static vsc_status step_into_item(vsc_reading *reading, place *at, size_t item)
{
  if (!vsc_row_is_list(at->row) || at->item) return vsc_reading_fail(reading, "no list; leave out [%zu]", item);
  const size_t count = at->slot->count;
  if (item > count)
    return vsc_reading_fail(reading, "no item [%zu]; it has %zu, the next would be [%zu]", item,
                            count, count);
  const size_t size = is_groups(at->row) ? at->group->row_count * sizeof(vsc_slot) : sizeof(char *);
  if (item == count) {
    char *longer = realloc(at->slot->value, (count + 1) * size);
    if (longer == NULL) return vsc_fail_memory(reading->error, "a setting");
    memset(longer + count * size, 0, size);
    at->slot->value = longer;
    at->slot->count = count + 1;
  }
  if (is_groups(at->row)) at->slots = (vsc_slot *)at->slot->value + item * at->group->row_count;
  at->item = true;
  at->item_number = item;
  vsc_enter_item(reading, item);
  return VSC_OK;
}

static vsc_status walk(vsc_reading *reading, place *at, const char *key)
{
  vsc_status status = VSC_OK;
  char word[VSC_SCENE_KEY];
  while (*key != '\0' && status == VSC_OK) {
    if (*key == '[') {
      char *end;
      const bool digits = isdigit((unsigned char)key[1]);
      const size_t item = digits ? strtoul(key + 1, &end, 10) : 0;
      if (!digits || *end != ']' || at->row == NULL)
        return vsc_reading_fail(reading,
                                "expected a number in brackets behind a list, as in "
                                "materials[0].density");
      status = step_into_item(reading, at, item);
      key = end + 1;
    } else {
      if (*key == '.' && at->row != NULL) key++;
      const size_t length = strcspn(key, ".[");
      snprintf(word, sizeof word, "%.*s", (int)length, key);
      status = step_into_key(reading, at, word);
      key += length;
    }
    if (status == VSC_OK) status = open_group(reading, at);
  }
  return status;
}

static vsc_status store(vsc_reading *reading, const place *at, const char *value)
{
  if (at->item && is_groups(at->row))
    return vsc_reading_fail(reading, "set its keys one by one, as in %s.%s=...", reading->key,
                            at->group->rows[0].key);
  if (!at->item) return vsc_scene_load_value(reading, at->row, value, at->slot);
  const vsc_row text = {.key = at->row->key, .kind = VSC_ROW_TEXT, .text = at->row->text};
  char **texts = at->slot->value;
  vsc_slot slot = {.value = texts[at->item_number]};
  const vsc_status status = vsc_scene_load_value(reading, &text, value, &slot);
  texts[at->item_number] = slot.value;
  return status;
}

vsc_status vsc_scene_set(vsc_reading *reading, vsc_slot *slots, vsc_setting *setting)
{
  const char *equals = strchr(setting->text, '=');
  const size_t length = equals != NULL ? (size_t)(equals - setting->text) : 0;
  if (length == 0 || length >= VSC_SCENE_KEY)
    return vsc_fail(reading->error, VSC_INPUT,
                    "%s: --set %.100s: expected key=value, such as time.end=0.4 s", reading->file,
                    setting->text);
  memcpy(setting->key, setting->text, length);
  setting->key[length] = '\0';
  place at = {.group = &vsc_scene_group, .slots = slots};
  vsc_status status = walk(reading, &at, setting->key);
  if (status == VSC_OK) status = store(reading, &at, equals + 1);
  if (status == VSC_OK) vsc_leave(reading, 0);
  return status;
}
