// SPDX-License-Identifier: GPL-3.0-or-later
// The material axes of each element at rest: fibre f, sheet s, sheet normal n, right-handed and
// orthonormal. Axes have no sign: f and -f are the same fibre.
#ifndef VSC_MESH_AXES_H
#define VSC_MESH_AXES_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

typedef struct vsc_axes {
  size_t count;    // elements
  double *frames;  // count x 3 x 3: rows f, s, n
  uint8_t *known;  // count: 1 where the fibre is known; 0 where there is none: such an element is
                   // passive and its frame is the global axes
} vsc_axes;

// Axes of `count` elements: global axes, all unknown. NULL when memory is short.
vsc_axes *vsc_axes_create(size_t count);

void vsc_axes_free(vsc_axes *axes);  // NULL is fine

// Completes a frame (rows f, s, n) from a fibre direction and a hint for the sheet, neither of unit
// length. Rule: f is normalised; s is the part of the hint orthogonal to f; when the hint is NULL,
// zero or within 1 degree of f, the hint is the global axis (x, y or z, the first in case of a tie)
// with the smallest |component| of f; n = f x s. Returns 0, leaving the frame alone, when f is
// zero (shorter than 1e-6) or not finite; else 1.
int vsc_axes_complete(const double fiber[3], const double *sheet, double frame[9]);

// True when each frame is orthonormal and right-handed to 1e-9.
int vsc_axes_valid(const vsc_axes *axes);

#endif
