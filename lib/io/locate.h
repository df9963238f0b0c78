// SPDX-License-Identifier: GPL-3.0-or-later
// On which line of a YAML text a key stands.
#ifndef VSC_IO_LOCATE_H
#define VSC_IO_LOCATE_H

#include <stddef.h>

#include "base/status.h"

typedef struct vsc_locator vsc_locator;

// Parses `text` (borrowed for the call). Anything but one YAML document that holds something, and no NUL in any key or
// value, fails with VSC_INPUT and "file:line: what is wrong". The caller owns *locator.
vsc_status vsc_locator_open(const char *file, const char *text, size_t size, vsc_locator **locator,
                            vsc_error *error);

// The line, counted from 1, of a key such as "materials[0].axial.f"; where the text lacks it, the
// line of the innermost part of it that is there.
size_t vsc_locator_line(const vsc_locator *locator, const char *key);

// The same of a key that stands twice in its group: of the second.
size_t vsc_locator_line_again(const vsc_locator *locator, const char *key);

void vsc_locator_close(vsc_locator *locator);  // NULL is fine

#endif
