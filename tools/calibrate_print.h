// SPDX-License-Identifier: GPL-3.0-or-later
// The tables, the YAML and the curves that `viscera calibrate` makes.
#ifndef VSC_TOOLS_CALIBRATE_PRINT_H
#define VSC_TOOLS_CALIBRATE_PRINT_H

#include <stdio.h>

#include "model/calibration.h"

// One material's compliances: of its springs in closed form, as measured on a mesh, and, unless
// NULL, the one that was wanted.
typedef struct vsc_answer {
  const double *wanted, *springs, *measured;  // 6 x 6
} vsc_answer;

// Prints Young's modulus in 13 directions and in `random` more, shear moduli, Poisson's ratios and
// the extremes over all directions; each line begins with `prefix`.
void vsc_print_table(FILE *stream, const char *prefix, const vsc_answer *answer, int random);

// Prints the springs as the item of a scene's list `materials`.
void vsc_print_material(FILE *stream, const vsc_material_def *material);

// Writes the curves of Young's modulus in the planes f-s, s-n, n-f (0, 1, 2) for `viscera-plot
// --polar`: columns plane, angle (degrees), wanted, springs, measured (kPa; nan where there is
// none).
vsc_status vsc_write_polar(const char *file, const vsc_answer *answer, vsc_error *error);

#endif
