// SPDX-License-Identifier: GPL-3.0-or-later
// The rows as a libcyaml schema, and libcyaml's complaints as our one-line messages.
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "io/scene_reading.h"

enum { MOST_STEPS = 16, STEP = 80 };

// What libcyaml logged: the first message, then the way out of the place where it stopped.
typedef struct complaint {
  char message[160];
  size_t line;  // 1-based; 0: not said
  size_t step_count;
  char steps[MOST_STEPS][STEP];  // ".key" or "[item]", the innermost first
} complaint;

static const cyaml_schema_value_t text_value = {
    .type = CYAML_STRING,
    .flags = CYAML_FLAG_POINTER,
    .data_size = 1,
    .string = {.max = CYAML_UNLIMITED},
};

static cyaml_schema_value_t group_value(const vsc_group *group, enum cyaml_flag flags)
{
  return (cyaml_schema_value_t){.type = CYAML_MAPPING,
                                .flags = flags,
                                .data_size = (uint32_t)(group->row_count * sizeof(vsc_slot)),
                                .mapping = {.fields = group->fields}};
}

// The schema of one item of a list of groups lies behind the group's fields, in the end mark.
static cyaml_schema_value_t *item_value(const vsc_group *group)
{
  return &group->fields[group->row_count].value;
}

static cyaml_schema_value_t row_value(const vsc_row *row)
{
  const enum cyaml_flag flags = (enum cyaml_flag)(CYAML_FLAG_POINTER | CYAML_FLAG_OPTIONAL);
  cyaml_schema_value_t value = text_value;
  if (row->kind == VSC_ROW_GROUP) value = group_value(row->group, flags);
  if (vsc_row_is_list(row)) {
    const bool groups = row->kind == VSC_ROW_GROUPS;
    const cyaml_schema_value_t *entry = groups ? item_value(row->group) : &text_value;
    const bool filled =
        row->kind == VSC_ROW_VECTOR || row->kind == VSC_ROW_SERIES || row->kind == VSC_ROW_FLAGS;
    value = (cyaml_schema_value_t){
        .type = CYAML_SEQUENCE,
        .data_size = groups ? entry->data_size : (uint32_t)sizeof(char *),
        .sequence = {.entry = entry, .min = filled, .max = CYAML_UNLIMITED},
    };
  }
  value.flags = flags;
  return value;
}

static void fill_fields(const vsc_group *group)
{
  *item_value(group) = group_value(group, CYAML_FLAG_DEFAULT);
  for (size_t i = 0; i < group->row_count; i++) {
    if (group->rows[i].group != NULL) fill_fields(group->rows[i].group);
    group->fields[i] = (cyaml_schema_field_t){
        .key = group->rows[i].key,
        .data_offset = (uint32_t)(i * sizeof(vsc_slot) + offsetof(vsc_slot, value)),
        .count_offset = (uint32_t)(i * sizeof(vsc_slot) + offsetof(vsc_slot, count)),
        .count_size = sizeof(uint64_t),
        .value = row_value(&group->rows[i]),
    };
  }
}

static void fill_all(void)
{
  fill_fields(&vsc_scene_group);
}

static pthread_once_t filled = PTHREAD_ONCE_INIT;

static void hear(cyaml_log_t level, void *context, const char *format, va_list arguments)
{
  (void)level;
  complaint *heard = context;
  char text[160], key[STEP - 2];
  unsigned long line;
  unsigned item;
  const int length = vsnprintf(text, sizeof text, format, arguments);
  if (length > 0 && (size_t)length < sizeof text && text[length - 1] == '\n') text[length - 1] = 0;
  if (strncmp(text, "Load: Backtrace", 15) == 0) return;
  if (strncmp(text, "Load: ", 6) == 0) {
    if (heard->message[0] == '\0') strcpy(heard->message, text + 6);
    return;
  }
  const char *at = strstr(text, "(line: ");
  if (at != NULL && heard->line == 0 && sscanf(at, "(line: %lu", &line) == 1) heard->line = line;
  if (heard->step_count == MOST_STEPS) return;
  char *step = heard->steps[heard->step_count];
  if (sscanf(text, "  in mapping field '%77[^']'", key) == 1) {
    snprintf(step, STEP, ".%s", key);
    heard->step_count++;
  } else if (sscanf(text, "  in sequence entry '%u'", &item) == 1) {
    snprintf(step, STEP, "[%u]", item > 0 ? item - 1 : 0);
    heard->step_count++;
  }
}

static void *allocate(void *context, void *memory, size_t size)
{
  (void)context;
  if (size > 0) return realloc(memory, size);
  free(memory);
  return NULL;
}

static cyaml_config_t config_for(complaint *heard)
{
  return (cyaml_config_t){
      .log_fn = hear, .log_ctx = heard, .mem_fn = allocate, .log_level = CYAML_LOG_WARNING};
}

// Follows the steps, but for the `left` innermost, from `row` (NULL: from the whole scene); returns
// the last row and appends the steps to the reading's key.
static const vsc_row *follow(vsc_reading *reading, const complaint *heard, size_t left,
                             const vsc_row *row)
{
  const vsc_group *group = row != NULL ? row->group : &vsc_scene_group;
  for (size_t s = heard->step_count; s-- > left;) {
    const char *step = heard->steps[s];
    if (step[0] == '[') {
      vsc_enter_item(reading, strtoul(step + 1, NULL, 10));
      continue;
    }
    vsc_enter(reading, step + 1);
    row = group != NULL ? vsc_group_find(group, step + 1) : NULL;
    group = row != NULL ? row->group : NULL;
  }
  return row;
}

// What stands in the file in the place of what `row` holds.
static vsc_status fail_shape(const vsc_reading *reading, const vsc_row *row, bool item,
                             const char *got)
{
  const char *found = strstr(got, "SEQUENCE") != NULL  ? "a list"
                      : strstr(got, "MAPPING") != NULL ? "a group of keys"
                                                       : "a single value or nothing";
  if (row == NULL || row->kind == VSC_ROW_GROUP || (item && row->kind == VSC_ROW_GROUPS)) {
    char hint[400];
    vsc_group_hint(row != NULL ? row->group : &vsc_scene_group, "", hint, sizeof hint);
    return vsc_reading_fail(reading, "%s; expected a group of keys, %s", found, hint);
  }
  if (row->kind == VSC_ROW_GROUPS)
    return vsc_reading_fail(reading, "%s; expected a list, its items behind dashes", found);
  if (item) return vsc_reading_fail(reading, "%s; expected a single value", found);
  return vsc_reading_fail(reading, "%s; expected %s such as %s", found,
                          vsc_row_is_list(row) ? "a list" : "one value", row->text);
}

static vsc_status explain(vsc_reading *reading, const complaint *heard, const vsc_row *start,
                          cyaml_err_t code)
{
  static const char unknown[] = "Unexpected key: ", seen[] = "Mapping field already seen: ";
  char hint[400];
  if (code == CYAML_ERR_OOM) return vsc_fail_memory(reading->error, "the scene");
  const bool item = heard->step_count > 0 && heard->steps[0][0] == '[';
  const bool empty = code == CYAML_ERR_SEQUENCE_ENTRIES_MIN;
  const vsc_row *row = follow(reading, heard, item && empty, start);
  if (strncmp(heard->message, unknown, strlen(unknown)) == 0) {
    const char *key = heard->message + strlen(unknown);
    const vsc_group *group = row != NULL ? row->group : &vsc_scene_group;
    vsc_group_hint(group, key, hint, sizeof hint);
    vsc_enter(reading, key);
    return vsc_reading_fail(reading, "unknown key; %s", hint);
  }
  if (strncmp(heard->message, seen, strlen(seen)) == 0)
    return vsc_reading_fail(reading, "given twice, again on line %zu; keep one",
                            reading->current != NULL ? heard->line : vsc_locator_line_again(reading->locator, reading->key));
  if (strncmp(heard->message, "Expecting ", 10) == 0)
    return fail_shape(reading, row, item, strstr(heard->message, "got event: "));
  if (empty)
    return vsc_reading_fail(reading, "an empty list; expected values such as %s", row->text);
  return vsc_reading_fail(reading, "%s (%s)",
                          heard->message[0] != '\0' ? heard->message : "cannot be read",
                          cyaml_strerror(code));
}

vsc_status vsc_scene_load(vsc_reading *reading, const char *text, size_t size, vsc_slot **slots)
{
  pthread_once(&filled, fill_all);
  complaint heard = {.line = 0};
  const cyaml_config_t config = config_for(&heard);
  const cyaml_schema_value_t schema = group_value(&vsc_scene_group, CYAML_FLAG_POINTER);
  cyaml_data_t *loaded = NULL;
  const cyaml_err_t code =
      cyaml_load_data((const uint8_t *)text, size, &config, &schema, &loaded, NULL);
  if (code != CYAML_OK) return explain(reading, &heard, NULL, code);
  if (loaded == NULL) loaded = calloc(vsc_scene_group.row_count, sizeof(vsc_slot));
  if (loaded == NULL) return vsc_fail_memory(reading->error, "the scene");
  *slots = loaded;
  return VSC_OK;
}

void vsc_scene_unload(vsc_slot *slots)
{
  complaint heard = {.line = 0};
  const cyaml_config_t config = config_for(&heard);
  const cyaml_schema_value_t schema = group_value(&vsc_scene_group, CYAML_FLAG_POINTER);
  if (slots != NULL) cyaml_free(&config, &schema, slots, 0);
}

vsc_status vsc_scene_load_value(vsc_reading *reading, const vsc_row *row, const char *text,
                                vsc_slot *slot)
{
  pthread_once(&filled, fill_all);
  complaint heard = {.line = 0};
  const cyaml_config_t config = config_for(&heard);
  const cyaml_schema_value_t schema = row_value(row);
  cyaml_data_t *loaded = NULL;
  unsigned count = 0;
  if (text[0] == '\0') text = "\"\"";
  const size_t length = vsc_enter(reading, "");
  const cyaml_err_t code = cyaml_load_data((const uint8_t *)text, strlen(text), &config, &schema,
                                           &loaded, vsc_row_is_list(row) ? &count : NULL);
  if (code != CYAML_OK) return explain(reading, &heard, row, code);
  vsc_leave(reading, length);
  cyaml_free(&config, &schema, slot->value, (unsigned)slot->count);
  *slot = (vsc_slot){.value = loaded, .count = count};
  return VSC_OK;
}
