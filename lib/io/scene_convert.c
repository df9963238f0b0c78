// SPDX-License-Identifier: GPL-3.0-or-later
// From libcyaml's texts to the fields of the scene, row by row.
#include <stdio.h>
#include <string.h>

#include "base/mem.h"
#include "io/scene_reading.h"

static vsc_status convert_groups(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                                 void *target)
{
  char *items = vsc_alloc(slot->count, row->group->size);
  if (items == NULL) return vsc_fail_memory(reading->error, row->key);
  memcpy((char *)target + row->offset, &items, sizeof items);
  memcpy((char *)target + row->count_offset, &(size_t){slot->count}, sizeof(size_t));
  const vsc_slot *slots = slot->value;
  for (size_t i = 0; i < slot->count; i++) {
    void *item = items + i * row->group->size;
    const size_t length = vsc_enter_item(reading, i);
    if (row->group->start != NULL) row->group->start(item);
    const vsc_status status =
        vsc_group_convert(reading, row->group, slots + i * row->group->row_count, item);
    if (status != VSC_OK) return status;
    vsc_leave(reading, length);
  }
  return VSC_OK;
}

// A row whose presence chooses the kind of its group: a second such row contradicts the first.
static vsc_status select_kind(vsc_reading *reading, const vsc_group *group, const vsc_row *row,
                              void *target)
{
  const int chosen = vsc_group_kind(group, target);
  for (size_t i = 0; chosen >= 0 && i < group->row_count; i++)
    if (group->rows[i].selects == chosen + 1)
      return vsc_reading_fail(reading, "%s is given too; keep one of the two", group->rows[i].key);
  const int kind = row->selects - 1;
  memcpy((char *)target + group->kind_offset, &kind, sizeof kind);
  return VSC_OK;
}

static vsc_status refuse_for_kind(vsc_reading *reading, const vsc_group *group, const void *target)
{
  const int kind = vsc_group_kind(group, target);
  for (size_t i = 0; i < group->row_count; i++)
    if (group->rows[i].kind == VSC_ROW_CHOICE && (int)group->rows[i].offset == group->kind_offset)
      return vsc_reading_fail(reading, "means nothing for %s: %s; leave it out", group->rows[i].key,
                              vsc_word_of(group->rows[i].words, kind));
  return vsc_reading_fail(reading, "means nothing without an array; leave it out");
}

static vsc_status convert_row(vsc_reading *reading, const vsc_group *group, const vsc_row *row,
                              const vsc_slot *slot, void *target)
{
  if (!vsc_row_allowed(row, vsc_group_kind(group, target)))
    return refuse_for_kind(reading, group, target);
  vsc_status status = VSC_OK;
  if (row->selects != 0) status = select_kind(reading, group, row, target);
  if (status != VSC_OK) return status;
  if (row->kind == VSC_ROW_GROUP)
    status = vsc_group_convert(reading, row->group, slot->value, (char *)target + row->offset);
  else if (row->kind == VSC_ROW_GROUPS)
    status = convert_groups(reading, row, slot, target);
  else
    status = vsc_row_read(reading, row, slot, target);
  if (status == VSC_OK && row->after != NULL) row->after(target);
  return status;
}

static bool is_needed(const vsc_row *row, int kind)
{
  return row->needed == VSC_ALWAYS || (kind >= 0 && (row->needed >> kind & 1) != 0);
}

static vsc_status fail_missing(vsc_reading *reading, const vsc_group *group, const vsc_row *row)
{
  char hint[200];
  if (row->group == NULL)
    return vsc_reading_fail(reading, "missing; write such as \"%s: %s\" (%s)", row->key,
                            vsc_row_text(group, row), row->meaning);
  vsc_group_hint(row->group, "", hint, sizeof hint);
  return vsc_reading_fail(reading, "missing (%s); %s", row->meaning, hint);
}

vsc_status vsc_group_convert(vsc_reading *reading, const vsc_group *group, const vsc_slot *slots,
                             void *target)
{
  vsc_status status = VSC_OK;
  for (size_t i = 0; i < group->row_count; i++) {
    const vsc_row *row = &group->rows[i];
    const bool missing = slots[i].value == NULL;
    if (missing && !is_needed(row, vsc_group_kind(group, target))) continue;
    const size_t length = vsc_enter(reading, row->key);
    status = missing ? fail_missing(reading, group, row)
                     : convert_row(reading, group, row, &slots[i], target);
    if (status != VSC_OK) return status;
    vsc_leave(reading, length);
  }
  return group->finish != NULL ? group->finish(reading, slots, target) : VSC_OK;
}
