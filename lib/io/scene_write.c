// SPDX-License-Identifier: GPL-3.0-or-later
// The scene as understood, and the template: both walk the rows.
#include <stdio.h>
#include <string.h>

#include "io/replace.h"
#include "io/scene_reading.h"

static void write_group(FILE *stream, const vsc_group *group, const void *target, int depth,
                        const char *first);

// ---- as understood

static void write_items(FILE *stream, const vsc_row *row, const void *target, int depth)
{
  const char *items;
  size_t count;
  memcpy(&items, (const char *)target + row->offset, sizeof items);
  memcpy(&count, (const char *)target + row->count_offset, sizeof count);
  fprintf(stream, count == 0 ? "%*s%s: []\n" : "%*s%s:\n", depth, "", row->key);
  for (size_t i = 0; i < count; i++)
    write_group(stream, row->group, items + i * row->group->size, depth + 4, "- ");
}

static bool is_written(const vsc_row *row, int kind, const void *target)
{
  if (row->input_only || !vsc_row_allowed(row, kind)) return false;
  if (row->selects != 0 && row->selects != kind + 1) return false;
  return row->kind != VSC_ROW_PATH || ((const char *)target)[row->offset] != '\0';
}

// Writes a group at column `depth`; `first` ("- " or nothing) stands before its first key.
static void write_group(FILE *stream, const vsc_group *group, const void *target, int depth,
                        const char *first)
{
  const int kind = vsc_group_kind(group, target);
  for (size_t i = 0; i < group->row_count; i++) {
    const vsc_row *row = &group->rows[i];
    if (!is_written(row, kind, target)) continue;
    if (row->kind == VSC_ROW_GROUPS) {
      write_items(stream, row, target, depth);
    } else if (row->kind == VSC_ROW_GROUP) {
      fprintf(stream, "%*s%s:\n", depth, "", row->key);
      write_group(stream, row->group, (const char *)target + row->offset, depth + 2, "");
    } else {
      fprintf(stream, "%*s%s%s: ", depth - (int)strlen(first), "", first, row->key);
      vsc_row_write(stream, row, target);
      fputc('\n', stream);
    }
    first = "";
  }
}

vsc_status vsc_scene_write(const vsc_scene *scene, const char *file, vsc_error *error)
{
  vsc_replacement replacement;
  const vsc_status status = vsc_replace_begin(file, &replacement, error);
  if (status != VSC_OK) return status;
  fputs(VSC_SCENE_UNDERSTOOD ", with every default filled in.\n", replacement.stream);
  write_group(replacement.stream, &vsc_scene_group, scene, 0, "");
  return vsc_replace_end(&replacement, false, error);
}

// ---- template

enum { COMMENT_COLUMN = 44 };

// Prints a group at column `depth`; where `hidden`, behind a '#'.
static void show_group(FILE *stream, const vsc_group *group, int depth, const char *first,
                       bool hidden)
{
  for (size_t i = 0; i < group->row_count; i++) {
    const vsc_row *row = &group->rows[i];
    const bool hide = hidden || row->commented;
    const bool inner = row->group != NULL;
    const int length =
        fprintf(stream, "%s%*s%s%s:%s%s", hide ? "# " : "", depth - (int)strlen(first), "", first,
                row->key, inner ? "" : " ", inner ? "" : vsc_row_text(group, row));
    const int gap = length < COMMENT_COLUMN ? COMMENT_COLUMN - length : 1;
    fprintf(stream, "%*s# %s\n", gap, "", row->meaning);
    first = "";
    if (row->kind == VSC_ROW_GROUP) show_group(stream, row->group, depth + 2, "", hide);
    if (row->kind == VSC_ROW_GROUPS) show_group(stream, row->group, depth + 4, "- ", hide);
  }
}

void vsc_scene_schema(FILE *stream)
{
  fputs(
      "# A viscera scene. Every key is here, with its default or an example; lines that\n"
      "# begin with '# ' are other ways to say the same or what other kinds take: delete the '# '\n"
      "# to use one. Values carry their unit: 60 kPa, 120 mmHg, 0.8 s, 35 deg.\n",
      stream);
  show_group(stream, &vsc_scene_group, 0, "", false);
}
