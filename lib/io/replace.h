// SPDX-License-Identifier: GPL-3.0-or-later
// Files that are complete or absent: written under a temporary name beside their own, then renamed.
#ifndef VSC_IO_REPLACE_H
#define VSC_IO_REPLACE_H

#include <stdbool.h>
#include <stdio.h>

#include "base/status.h"

enum { VSC_FILE_NAME = 4096 };  // bytes of a file name with its terminating zero

// Puts into `temporary` the name under which the new content of `file` is to be written and creates
// it, empty. VSC_SYSTEM with the reason (missing folder, no permission, full disk) when that fails.
vsc_status vsc_replace_begin(const char *file, char temporary[VSC_FILE_NAME], vsc_error *error);

// Gives the written and closed temporary file its own name, replacing what was there. With
// `durable` its content is on the disk before that, should the machine stop.
vsc_status vsc_replace_end(const char *file, const char *temporary, bool durable, vsc_error *error);

// Removes the temporary file after a failure.
void vsc_replace_cancel(const char *temporary);

// The same for a text: opens a stream to write the new content of `file` to. What is there and no file, a
// device or a pipe, is written to itself; `temporary` is then empty. NULL, with *error of status VSC_SYSTEM
// or (a name too long) VSC_INPUT, when that fails.
FILE *vsc_replace_open(const char *file, char temporary[VSC_FILE_NAME], vsc_error *error);

// Closes that stream and gives the content its name; VSC_SYSTEM when not all could be written: what was
// there before then stays.
vsc_status vsc_replace_close(FILE *stream, const char *file, const char *temporary, vsc_error *error);

#endif
