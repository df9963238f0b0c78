// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are complete or absent: written under a temporary name beside their own, then renamed.
#ifndef VSC_IO_REPLACE_H
#define VSC_IO_REPLACE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

enum { VSC_FILE_NAME = 4096 };  // bytes of a file name with its terminating zero

// The new content of a file, under way.
typedef struct vsc_replacement {
  char file[VSC_FILE_NAME];
  char temporary[VSC_FILE_NAME];
  FILE *stream;  // to write to
} vsc_replacement;

// Opens a stream for the new content of `file`. What is there and no file, a device or a pipe, is written to itself;
// `temporary` is then empty. VSC_SYSTEM with the reason (missing folder, no permission, full
// disk), VSC_INPUT when the name is too long; then nothing is left.
vsc_status vsc_replace_begin(const char *file, vsc_replacement *replacement, vsc_error *error);

// Closes the stream and gives the file its own name, replacing what was there. With `durable` its content is on the
// disk before that, should the machine stop. VSC_SYSTEM when not all could be written: then the temporary file is
// removed, and `file` is as it was.
vsc_status vsc_replace_end(vsc_replacement *replacement, bool durable, vsc_error *error);

// Closes the stream and removes the temporary file: `file` stays as it was.
void vsc_replace_cancel(vsc_replacement *replacement);

// Begins and ends with `size` bytes.
vsc_status vsc_replace_whole(const char *file, const void *bytes, size_t size, bool durable, vsc_error *error);

#endif
