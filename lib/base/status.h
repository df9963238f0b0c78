// SPDX-License-Identifier: GPL-3.0-or-later
// How every function of the library reports failure: a status code and one line of text.
#ifndef VSC_BASE_STATUS_H
#define VSC_BASE_STATUS_H

#include <stddef.h>

// The values are the exit codes of the program.
typedef enum vsc_status {
  VSC_OK = 0,         // done
  VSC_INPUT = 2,      // the user's input: file, key, value; the text says what to change
  VSC_NUMERICAL = 3,  // the simulation failed: element or node, time, likely cause
  VSC_SYSTEM = 4,     // memory, disk, a library that refuses to work
} vsc_status;

enum { VSC_ERROR_TEXT = 640 };  // bytes of a message with its terminating zero

// Filled by the function that fails; untouched by one that succeeds.
typedef struct vsc_error {
  vsc_status status;
  char text[VSC_ERROR_TEXT];  // one line: file, key or element, value, remedy; no newline
} vsc_error;

// Writes the printf-style message into `error` (which may be NULL) and returns `status`,
// so that a failing function can say `return vsc_fail(error, VSC_INPUT, "...", ...)`.
// Control characters of the formatted text become spaces; a text that is too long is cut.
vsc_status vsc_fail(vsc_error *error, vsc_status status, const char *format, ...)
    __attribute__((format(printf, 3, 4)));

// Puts "list[index] ", which entry of a scene is meant, before the message of a `status` VSC_INPUT; returns `status`.
vsc_status vsc_in_list(const char *list, size_t index, vsc_status status, vsc_error *error);

// Shorthand for running out of memory while making `what` (a noun phrase).
vsc_status vsc_fail_memory(vsc_error *error, const char *what);

#endif
