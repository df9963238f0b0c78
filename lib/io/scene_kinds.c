// SPDX-License-Identifier: GPL-3.0-or-later
// One function for each kind of row that reads it, and one that writes it.
#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/mem.h"
#include "io/scene_reading.h"

typedef vsc_status reader(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                          void *field);
typedef void writer(FILE *stream, const vsc_row *row, const void *field);

// The number that counts the items of a list, given the list's field.
static size_t *count_of(const vsc_row *row, void *field)
{
  return (size_t *)((char *)field - row->offset + row->count_offset);
}

// ---- numbers with units

static vsc_status read_text(vsc_reading *reading, const vsc_row *row, const char *text,
                            double *value)
{
  vsc_error found;
  const vsc_status status = vsc_units_read(text, row->quantity, value, &found);
  if (status == VSC_OK) return VSC_OK;
  if (status == VSC_SYSTEM) return vsc_fail(reading->error, status, "%s", found.text);
  return vsc_reading_fail(reading, "%s%s%s", found.text, row->zero_word != NULL ? ", or " : "",
                          row->zero_word != NULL ? row->zero_word : "");
}

static vsc_status read_texts(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                             double *values)
{
  char *const *texts = slot->value;
  for (size_t i = 0; i < slot->count; i++) {
    const size_t length = vsc_enter_item(reading, i);
    const vsc_status status = read_text(reading, row, texts[i], &values[i]);
    if (status != VSC_OK) return status;
    vsc_leave(reading, length);
  }
  return VSC_OK;
}

static vsc_status read_quantity(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                                void *field)
{
  const char *text = slot->value, *word = row->zero_word;
  double value = 0;
  vsc_status status = VSC_OK;
  if (word == NULL || strcmp(text, word) != 0) {
    status = read_text(reading, row, text, &value);
    if (status == VSC_OK && word != NULL && !(value > 0))
      return vsc_reading_fail(reading, "\"%s\": not above zero; give more, or leave it out (%s)", text, word);
  }
  if (status == VSC_OK) memcpy(field, &value, sizeof value);
  return status;
}

static vsc_status read_unit(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                            void *field)
{
  const char *text = slot->value;
  char with_number[128];
  double value;
  const bool number = text[0] == '\0' || strchr("+-.0123456789", text[0]) != NULL;
  snprintf(with_number, sizeof with_number, "%s%s", number ? "" : "1 ", text);
  const vsc_status status = read_text(reading, row, with_number, &value);
  if (status != VSC_OK) return status;
  if (!(value > 0))
    return vsc_reading_fail(reading, "\"%s\": not above zero; expected a unit such as %s", text,
                            row->text);
  memcpy(field, &value, sizeof value);
  return VSC_OK;
}

static vsc_status read_vector(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                              void *field)
{
  if (slot->count != row->count)
    return vsc_reading_fail(reading, "%zu values; expected %zu, such as %s", (size_t)slot->count,
                            row->count, row->text);
  return read_texts(reading, row, slot, field);
}

static vsc_status read_both(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                            void *field)
{
  double *range = field;
  const vsc_status status = read_quantity(reading, row, slot, range);
  if (status == VSC_OK) range[1] = range[0];
  return status;
}

static vsc_status read_series(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                              void *field)
{
  double *values;
  size_t *count = count_of(row, field);
  if (*count != 0 && *count != slot->count)
    return vsc_reading_fail(reading, "%zu values; expected as many as of times, %zu",
                            (size_t)slot->count, *count);
  if (!VSC_NEW(values, slot->count)) return vsc_fail_memory(reading->error, row->key);
  memcpy(field, &values, sizeof values);
  *count = slot->count;
  return read_texts(reading, row, slot, values);
}

// The shortest text of 15 to 17 digits that reads back to the same bits.
static void write_number(FILE *stream, double value, const char *unit)
{
  char text[40];
  for (int digits = 15; digits <= 17; digits++) {
    snprintf(text, sizeof text, "%.*g", digits, value);
    if (strtod(text, NULL) == value) break;
  }
  fprintf(stream, "%s%s%s", text, unit[0] != '\0' ? " " : "", unit);
}

// An angle in degrees if they read back to the same bits, else in radians.
static void write_angle(FILE *stream, double angle)
{
  char text[48];
  double back;
  snprintf(text, sizeof text, "%.15g deg", angle * (180 / M_PI));
  if (vsc_units_read(text, VSC_ANGLE, &back, NULL) == VSC_OK && back == angle)
    fputs(text, stream);
  else
    write_number(stream, angle, vsc_units_name(VSC_ANGLE));
}

static void write_numbers(FILE *stream, const vsc_row *row, const double *values, size_t count)
{
  for (size_t i = 0; i < count; i++) {
    fputs(i == 0 ? "[" : ", ", stream);
    write_number(stream, values[i], vsc_units_name(row->quantity));
  }
  fputs(count == 0 ? "[]" : "]", stream);
}

static void write_quantity(FILE *stream, const vsc_row *row, const void *field)
{
  const double value = *(const double *)field;
  if (row->zero_word != NULL && value == 0)
    fputs(row->zero_word, stream);
  else if (row->quantity == VSC_ANGLE)
    write_angle(stream, value);
  else
    write_number(stream, value, vsc_units_name(row->quantity));
}

static void write_vector(FILE *stream, const vsc_row *row, const void *field)
{
  write_numbers(stream, row, field, row->count);
}

static void write_series(FILE *stream, const vsc_row *row, const void *field)
{
  const double *values;
  memcpy(&values, field, sizeof values);
  write_numbers(stream, row, values, *count_of(row, (void *)field));
}

// ---- names

static vsc_status check_name(vsc_reading *reading, const vsc_row *row, const char *text,
                             size_t room)
{
  if (text == NULL || (text[0] == '\0' && row->needed != 0))
    return vsc_reading_fail(reading, "empty; expected a name");
  for (const char *c = text; *c != '\0'; c++)
    if ((unsigned char)*c < ' ')
      return vsc_reading_fail(reading, "a name with control characters; use letters and digits");
  if (strlen(text) >= room)
    return vsc_reading_fail(reading, "\"%.40s...\": longer than %zu letters", text, room - 1);
  return VSC_OK;
}

static vsc_status read_name(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                            void *field)
{
  const vsc_status status = check_name(reading, row, slot->value, row->size);
  if (status == VSC_OK) strcpy(field, slot->value);
  return status;
}

static vsc_status read_path(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                            void *field)
{
  const char *text = slot->value;
  const vsc_status status = check_name(reading, row, text, row->size);
  if (status != VSC_OK || text[0] == '\0') return status;
  return vsc_scene_resolve(reading, text, field);
}

static vsc_status read_names(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                             void *field)
{
  char hint[300];
  char(*names)[VSC_NAME] = field;
  char *const *texts = slot->value;
  if (slot->count > row->count)
    return vsc_reading_fail(reading, "%zu names; expected up to %zu", (size_t)slot->count,
                            row->count);
  const vsc_row item = {.needed = VSC_ALWAYS};
  for (size_t i = 0; i < slot->count; i++) {
    const size_t length = vsc_enter_item(reading, i);
    const vsc_status status = check_name(reading, &item, texts[i], VSC_NAME);
    if (status != VSC_OK) return status;
    const vsc_word *word = row->words;
    while (word != NULL && word->word != NULL && strcmp(word->word, texts[i]) != 0) word++;
    if (word != NULL && word->word == NULL) {
      vsc_words_hint(row->words, texts[i], hint, sizeof hint);
      return vsc_reading_fail(reading, "\"%s\": %s", texts[i], hint);
    }
    vsc_copy_name(names[i], texts[i]);
    vsc_leave(reading, length);
  }
  *count_of(row, field) = slot->count;
  return VSC_OK;
}

static void write_text(FILE *stream, const char *text)
{
  bool plain = isalpha((unsigned char)text[0]);
  for (const char *c = text; *c != '\0'; c++)
    plain = plain && (isalnum((unsigned char)*c) || *c == '_');
  if (plain) {
    fputs(text, stream);
    return;
  }
  fputc('"', stream);
  for (; *text != '\0'; text++) {
    if (*text == '"' || *text == '\\') fputc('\\', stream);
    fputc(*text, stream);
  }
  fputc('"', stream);
}

static void write_name(FILE *stream, const vsc_row *row, const void *field)
{
  (void)row;
  write_text(stream, field);
}

static void write_path(FILE *stream, const vsc_row *row, const void *field)
{
  (void)row;
  char *absolute = realpath(field, NULL);
  char *folder = absolute == NULL && *(const char *)field != '/' ? realpath(".", NULL) : NULL;
  char joined[2 * VSC_PATH];
  snprintf(joined, sizeof joined, "%.*s%s%s", VSC_PATH, folder != NULL ? folder : "",
           folder != NULL ? "/" : "", (const char *)field);
  write_text(stream, absolute != NULL ? absolute : joined);
  free(absolute);
  free(folder);
}

static void write_names(FILE *stream, const vsc_row *row, const void *field)
{
  const size_t count = *count_of(row, (void *)field);
  const char(*names)[VSC_NAME] = field;
  fputc('[', stream);
  for (size_t i = 0; i < count; i++) {
    if (i > 0) fputs(", ", stream);
    write_text(stream, names[i]);
  }
  fputc(']', stream);
}

// ---- whole numbers

static vsc_status read_whole(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                             void *field)
{
  const char *text = slot->value;
  char *end;
  errno = 0;
  const unsigned long value = strtoul(text, &end, 10);
  if (!isdigit((unsigned char)text[0]) || *end != '\0' || errno != 0)
    return vsc_reading_fail(reading, "\"%.40s\": expected a whole number such as %s", text,
                            row->text);
  memcpy(field, &value, sizeof value);
  return VSC_OK;
}

static vsc_status read_whole_int(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                                 void *field)
{
  unsigned long value = 0;
  const vsc_status status = read_whole(reading, row, slot, &value);
  if (status != VSC_OK) return status;
  if (value > INT_MAX)
    return vsc_reading_fail(reading, "%lu: expected a smaller number such as %s", value, row->text);
  *(int *)field = (int)value;
  return VSC_OK;
}

static vsc_status read_integers(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                                void *field)
{
  int *values = field;
  char *const *texts = slot->value;
  if (slot->count > row->count)
    return vsc_reading_fail(reading, "%zu numbers; expected up to %zu", (size_t)slot->count,
                            row->count);
  for (size_t i = 0; i < slot->count; i++) {
    char *end;
    errno = 0;
    const long value = strtol(texts[i], &end, 10);
    if (end == texts[i] || *end != '\0' || errno != 0 || value < INT_MIN || value > INT_MAX)
      return vsc_reading_fail(reading, "\"%.40s\": expected whole numbers such as %s", texts[i],
                              row->text);
    values[i] = (int)value;
  }
  *count_of(row, field) = slot->count;
  return VSC_OK;
}

static void write_whole(FILE *stream, const vsc_row *row, const void *field)
{
  (void)row;
  fprintf(stream, "%lu", *(const unsigned long *)field);
}

static void write_whole_int(FILE *stream, const vsc_row *row, const void *field)
{
  (void)row;
  fprintf(stream, "%d", *(const int *)field);
}

static void write_integers(FILE *stream, const vsc_row *row, const void *field)
{
  const size_t count = *count_of(row, (void *)field);
  const int *values = field;
  fputc('[', stream);
  for (size_t i = 0; i < count; i++) fprintf(stream, "%s%d", i == 0 ? "" : ", ", values[i]);
  fputc(']', stream);
}

// ---- words

static const vsc_word truths[] = {{"false", false}, {"true", true}, {NULL, 0}};

static vsc_status find_word(vsc_reading *reading, const vsc_word *words, const char *text,
                            const vsc_word **found)
{
  char hint[300];
  for (*found = words; (*found)->word != NULL; ++*found)
    if (strcmp((*found)->word, text) == 0) return VSC_OK;
  vsc_words_hint(words, text, hint, sizeof hint);
  return vsc_reading_fail(reading, "\"%.60s\": %s", text, hint);
}

static vsc_status read_choice(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                              void *field)
{
  const vsc_word *word;
  const vsc_status status =
      find_word(reading, row->words != NULL ? row->words : truths, slot->value, &word);
  if (status != VSC_OK) return status;
  if (row->size == sizeof(bool))
    *(bool *)field = word->value != 0;
  else
    memcpy(field, &word->value, sizeof word->value);
  return VSC_OK;
}

static vsc_status read_mark(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                            void *field)
{
  (void)field;
  if (strcmp(slot->value, "true") == 0) return VSC_OK;
  return vsc_reading_fail(reading, "\"%.40s\": expected %s: true, or leave it out",
                          (const char *)slot->value, row->key);
}

static vsc_status read_flags(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                             void *field)
{
  int *flags = field;
  char *const *texts = slot->value;
  for (size_t i = 0; i < slot->count; i++) {
    const vsc_word *word;
    const size_t length = vsc_enter_item(reading, i);
    const vsc_status status = find_word(reading, row->words, texts[i], &word);
    if (status != VSC_OK) return status;
    flags[word->value] = 1;
    vsc_leave(reading, length);
  }
  return VSC_OK;
}

static vsc_status read_nothing(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                               void *field)
{
  (void)reading;
  (void)row;
  (void)slot;
  (void)field;
  return VSC_OK;
}

static void write_choice(FILE *stream, const vsc_row *row, const void *field)
{
  int value;
  if (row->size == sizeof(bool))
    value = *(const bool *)field;
  else
    memcpy(&value, field, sizeof value);
  fputs(vsc_word_of(row->words != NULL ? row->words : truths, value), stream);
}

static void write_mark(FILE *stream, const vsc_row *row, const void *field)
{
  (void)row;
  (void)field;
  fputs("true", stream);
}

static void write_flags(FILE *stream, const vsc_row *row, const void *field)
{
  const int *flags = field;
  const char *before = "[";
  for (const vsc_word *word = row->words; word->word != NULL; word++) {
    if (!flags[word->value]) continue;
    fprintf(stream, "%s%s", before, word->word);
    before = ", ";
  }
  fputs(before[0] == '[' ? "[]" : "]", stream);
}

// ----

static const struct {
  reader *read;
  writer *write;
} kinds[] = {
    [VSC_ROW_QUANTITY] = {read_quantity, write_quantity},
    [VSC_ROW_UNIT] = {read_unit, write_quantity},
    [VSC_ROW_VECTOR] = {read_vector, write_vector},
    [VSC_ROW_SERIES] = {read_series, write_series},
    [VSC_ROW_BOTH] = {read_both, write_quantity},
    [VSC_ROW_NAME] = {read_name, write_name},
    [VSC_ROW_PATH] = {read_path, write_path},
    [VSC_ROW_WHOLE] = {read_whole, write_whole},
    [VSC_ROW_WHOLE_INT] = {read_whole_int, write_whole_int},
    [VSC_ROW_INTEGERS] = {read_integers, write_integers},
    [VSC_ROW_BOOL] = {read_choice, write_choice},
    [VSC_ROW_MARK] = {read_mark, write_mark},
    [VSC_ROW_CHOICE] = {read_choice, write_choice},
    [VSC_ROW_NAMES] = {read_names, write_names},
    [VSC_ROW_FLAGS] = {read_flags, write_flags},
    [VSC_ROW_TEXT] = {read_nothing, write_mark},
};

vsc_status vsc_row_read(vsc_reading *reading, const vsc_row *row, const vsc_slot *slot,
                        void *target)
{
  return kinds[row->kind].read(reading, row, slot, (char *)target + row->offset);
}

void vsc_row_write(FILE *stream, const vsc_row *row, const void *target)
{
  kinds[row->kind].write(stream, row, (const char *)target + row->offset);
}
