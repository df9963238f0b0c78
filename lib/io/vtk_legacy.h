// SPDX-License-Identifier: GPL-3.0-or-later
// What must hold in a legacy .vtk file before VTK may read it.
#ifndef VSC_IO_VTK_LEGACY_H
#define VSC_IO_VTK_LEGACY_H

#include "base/status.h"

// Checks a legacy file, ASCII or binary, of a grid, an image or polydata, for what VTK takes as it is and then reads past
// an end or allocates without bound:
// - lists of cells in the format before VTK 9 (a line "CELLS n size", then for each cell its number of points and the
//   points; of polydata VERTICES, LINES, POLYGONS and TRIANGLE_STRIPS): the n lists must fill the `size` numbers
//   exactly, and name points that there are; CELL_TYPES and lists come behind what they belong to, and
//   lists of offsets in a version that has them;
// - the counts of points, cells and of each array: not more numbers than the bytes that follow have bits.
// VSC_INPUT if any of this does not hold, or the file cannot be read; other files pass.
vsc_status vsc_legacy_check(const char *file, vsc_error *error);

#endif
