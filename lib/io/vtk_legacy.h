// SPDX-License-Identifier: GPL-3.0-or-later
// What must hold in a legacy .vtk file before VTK may read it.
#ifndef VSC_IO_VTK_LEGACY_H
#define VSC_IO_VTK_LEGACY_H

#include "base/status.h"

// Checks the list of cells of a legacy file, ASCII or binary, in the format before VTK 9 (a line
// "CELLS n size", then for each cell its number of points and the points): the n lists must fill
// the `size` numbers exactly, because VTK takes them as they are and reads past their end. Likewise
// the lists VERTICES, LINES, POLYGONS and TRIANGLE_STRIPS of polydata.
// VSC_INPUT if they don't, or if CELL_TYPES come without a list; other files pass.
vsc_status vsc_legacy_check_cells(const char *file, vsc_error *error);

#endif
