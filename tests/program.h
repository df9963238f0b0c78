// SPDX-License-Identifier: GPL-3.0-or-later
// Running the program in a folder of its own, and looking at what it says and leaves.
#ifndef VSC_TESTS_PROGRAM_H
#define VSC_TESTS_PROGRAM_H

#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "close.h"

enum { PROGRAM_TEXT = 1 << 20 };

static char program_folder[] = "/tmp/viscera-test-XXXXXX";
static char said[PROGRAM_TEXT], complained[PROGRAM_TEXT];  // stdout and stderr of the last run

// The path of a file in the folder; valid until the fourth next call.
static inline const char *in_folder(const char *name)
{
  static char paths[4][512];
  static int next;
  char *path = paths[next++ % 4];
  snprintf(path, sizeof paths[0], "%s/%s", program_folder, name);
  return path;
}

// Reads a file of the folder into `text`; returns its length. A missing file is an empty text.
static inline size_t load_text(const char *name, char *text, size_t size)
{
  FILE *stream = fopen(in_folder(name), "rb");
  const size_t length = stream != NULL ? fread(text, 1, size - 1, stream) : 0;
  text[length] = '\0';
  if (stream != NULL) fclose(stream);
  return length;
}

static inline void save_text(const char *name, const char *text)
{
  FILE *stream = fopen(in_folder(name), "wb");
  if (stream == NULL || fputs(text, stream) < 0 || fclose(stream) != 0) fail_msg("%s", name);
}

// Runs a shell command in the folder, the program being $V; returns its exit code, -1 after a
// signal.
static inline int shell(const char *command)
{
  char line[4096];
  snprintf(line, sizeof line, "cd %s && V='%s' && (%s) >out.txt 2>err.txt", program_folder,
           VSC_PROGRAM, command);
  const int status = system(line);
  load_text("out.txt", said, sizeof said);
  load_text("err.txt", complained, sizeof complained);
  return WIFEXITED(status) && WEXITSTATUS(status) < 128 ? WEXITSTATUS(status) : -1;
}

// A command that must succeed.
static inline void must(const char *command)
{
  const int code = shell(command);
  if (code != 0) fail_msg("%s: exit code %d: %s", command, code, complained);
}

// The value of a key of a run's summary.json as it stands there, without its comma; good for four more calls.
static inline const char *summary_raw(const char *run, const char *key)
{
  static char text[PROGRAM_TEXT], values[4][1024];
  static int next;
  char name[128], quoted[80], *value = values[next++ % 4];
  snprintf(name, sizeof name, "%.64s/summary.json", run);
  load_text(name, text, sizeof text);
  snprintf(quoted, sizeof quoted, "\"%s\": ", key);
  const char *found = strstr(text, quoted);
  if (found == NULL) fail_msg("%s: no %s in '%s'", name, key, text);
  found += strlen(quoted);
  size_t length = strcspn(found, "\n");
  if (length > 0 && found[length - 1] == ',') length--;
  snprintf(value, sizeof values[0], "%.*s", (int)length, found);
  return value;
}

// The same without quotes.
static inline const char *summary(const char *run, const char *key)
{
  char *value = (char *)(uintptr_t)summary_raw(run, key);
  if (*value != '"') return value;
  value++;
  value[strcspn(value, "\"")] = '\0';
  return value;
}

static inline int line_count(const char *text)
{
  int lines = 0;
  for (; *text != '\0'; text++) lines += *text == '\n';
  return lines;
}

#define assert_holds(text, part) holds_at((text), (part), __FILE__, __LINE__)

static inline void holds_at(const char *text, const char *part, const char *file, int line)
{
  if (strstr(text, part) != NULL) return;
  print_error("expected '%s' in '%s'\n", part, text);
  _fail(file, line);
}

// The line of the last output that begins with `word`; valid until the next call.
static inline const char *line_of(const char *word)
{
  static char line[1024];
  char start[64];
  snprintf(start, sizeof start, "\n%s ", word);
  const char *found = strncmp(said, start + 1, strlen(start) - 1) == 0 ? said : strstr(said, start);
  if (found == NULL) fail_msg("no line '%s' in '%s'", word, said);
  found += *found == '\n';
  snprintf(line, sizeof line, "%.*s", (int)strcspn(found, "\n"), found);
  return line;
}

static inline void same_files_at(const char *a, const char *b, const char *file, int line)
{
  static char first[PROGRAM_TEXT], second[PROGRAM_TEXT];
  const size_t length = load_text(a, first, sizeof first),
               other = load_text(b, second, sizeof second);
  if (length > 0 && length == other && memcmp(first, second, length) == 0) return;
  print_error("%s and %s differ\n", a, b);
  _fail(file, line);
}

// Two files of the folder have the same bytes and are not empty.
#define assert_same_files(a, b) same_files_at((a), (b), __FILE__, __LINE__)

// The number in a column of the last line of a results folder's signals.csv.
static inline double last_signal(const char *folder, const char *column)
{
  static char text[PROGRAM_TEXT];
  char name[64];
  snprintf(name, sizeof name, "%s/signals.csv", folder);
  assert_true(load_text(name, text, sizeof text) > 0);
  const char *place = strstr(text, column);
  assert_non_null(place);
  int number = 0;
  for (const char *c = text; c < place; c++) number += *c == ',';
  text[strlen(text) - 1] = '\0';
  const char *row = strrchr(text, '\n') + 1;
  while (number-- > 0) row = strchr(row, ',') + 1;
  return strtod(row, NULL);
}

static inline int program_open(void **state)
{
  (void)state;
  return mkdtemp(program_folder) == NULL;
}

static inline int program_close(void **state)
{
  (void)state;
  char command[128];
  snprintf(command, sizeof command, "rm -rf %s", program_folder);
  return system(command);
}

#endif
