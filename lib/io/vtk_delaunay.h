// SPDX-License-Identifier: GPL-3.0-or-later
// The Delaunay tetrahedralisation of points, by VTK.
#ifndef VSC_IO_VTK_DELAUNAY_H
#define VSC_IO_VTK_DELAUNAY_H

#include <stddef.h>
#include <stdint.h>

#include "base/status.h"

// The tets of `count` points (count x 3): *tets has 4 x *tet_count point numbers, right-handed, to
// be released with vsc_free. Among them may be flat ones on plane parts of the hull. Points of
// which five or more lie on one sphere may leave holes or overlaps: the caller has to look.
// VSC_NUMERICAL when VTK makes no tets of them.
vsc_status vsc_vtk_delaunay(size_t count, const double *points, size_t *tet_count, uint32_t **tets,
                            vsc_error *error);

#endif
