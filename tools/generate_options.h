// SPDX-License-Identifier: GPL-3.0-or-later
// What `viscera generate` can be asked for.
#ifndef VSC_TOOLS_GENERATE_OPTIONS_H
#define VSC_TOOLS_GENERATE_OPTIONS_H

#include <getopt.h>
#include <stdbool.h>
#include <stdint.h>

#include "tools/shapes_column.h"
#include "tools/shapes_liver.h"
#include "tools/shapes_sheet.h"
#include "tools/shapes_shells.h"

// Shapes with what was said about them; each shape takes what concerns it (vsc_generate_check).
typedef struct vsc_generate_wish {
  const char *shape;
  const char *file;
  vsc_lv_shape lv;                 // its element is that of all shapes
  vsc_block_shape block;           // of a sheet, too: its first two numbers
  int cell_numbers, size_numbers;  // how many were given; 0: none
  vsc_tube_shape tube;
  vsc_shell_shape shell;
  double bend, twist;  // of a column, m/s and rad/s
  double thickness;  // of Cook's membrane, mm; 0: the default
  bool unstructured;
  size_t points;                 // 0: the default
  size_t bricks;  // of a liver, along each side
  vsc_liver_tree tree;
  double endo_angle, epi_angle;  // degrees
  double spacing;                // mm; 0: a quarter of the wall
  uint64_t given;                // a bit for each option that was
} vsc_generate_wish;

extern const struct option vsc_generate_options[];  // for getopt_long, beside -o and -h

void vsc_generate_help(void);  // prints it

// Takes in one option with its text; false when the text does not fit.
bool vsc_generate_option(vsc_generate_wish *wish, int option, const char *text);

// VSC_INPUT for options that the shape does not have, with the shapes that have them. A shape that is not
// known has all.
vsc_status vsc_generate_check(const vsc_generate_wish *wish, vsc_error *error);

#endif
