// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of its own for each test program's files.
#ifndef VSC_TESTS_SCRATCH_H
#define VSC_TESTS_SCRATCH_H

#include <dirent.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char scratch_folder[64];

// Group set-up: makes the folder.
static inline int scratch_open(void **state)
{
  (void)state;
  snprintf(scratch_folder, sizeof scratch_folder, "/tmp/vsc_test_XXXXXX");
  return mkdtemp(scratch_folder) == NULL;
}

// Group tear-down: removes it with its files.
static inline int scratch_close(void **state)
{
  (void)state;
  DIR *folder = opendir(scratch_folder);
  if (folder == NULL) return 1;
  char path[512];
  for (struct dirent *entry; (entry = readdir(folder)) != NULL;) {
    snprintf(path, sizeof path, "%s/%s", scratch_folder, entry->d_name);
    unlink(path);
  }
  closedir(folder);
  return rmdir(scratch_folder);
}

// The path of a file in the folder; valid until the fourth next call.
static inline const char *scratch(const char *name)
{
  static char paths[4][256];
  static int next;
  char *path = paths[next++ % 4];
  snprintf(path, sizeof paths[0], "%s/%s", scratch_folder, name);
  return path;
}

// Writes `bytes` bytes to a file of the folder and returns its path.
static inline const char *scratch_bytes(const char *name, const void *data, size_t bytes)
{
  const char *path = scratch(name);
  FILE *stream = fopen(path, "wb");
  if (stream == NULL || fwrite(data, 1, bytes, stream) != bytes || fclose(stream) != 0) abort();
  return path;
}

static inline const char *scratch_text(const char *name, const char *text)
{
  return scratch_bytes(name, text, strlen(text));
}

// The content of a file with a zero behind it, from calloc; its length goes to *bytes, if any.
static inline char *scratch_load(const char *path, size_t *bytes)
{
  FILE *stream = fopen(path, "rb");
  if (stream == NULL) abort();
  fseek(stream, 0, SEEK_END);
  const long size = ftell(stream);
  rewind(stream);
  char *text = calloc((size_t)size + 1, 1);
  if (text == NULL || fread(text, 1, (size_t)size, stream) != (size_t)size) abort();
  fclose(stream);
  if (bytes != NULL) *bytes = (size_t)size;
  return text;
}

// From here to scratch_unhush what goes to stderr is kept in a file.
static inline int scratch_hush(void)
{
  fflush(stderr);
  const int kept = dup(STDERR_FILENO);
  if (kept < 0 || freopen(scratch("stderr.txt"), "wb", stderr) == NULL) abort();
  return kept;
}

// Ends scratch_hush, which returned `kept`; returns how many bytes went to stderr.
static inline size_t scratch_unhush(int kept)
{
  fflush(stderr);
  dup2(kept, STDERR_FILENO);
  close(kept);
  size_t bytes = 0;
  free(scratch_load(scratch("stderr.txt"), &bytes));
  return bytes;
}

#endif
