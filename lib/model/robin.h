// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dashpots on surfaces: the matrix of a surface.
#ifndef VSC_MODEL_ROBIN_H
#define VSC_MODEL_ROBIN_H

#include "model/model.h"

// Fills faces, area, rows and blocks of `robin`, whose `normal` is set, for `face_count` faces with corners
// triangles (x 3) and mid-edge nodes mid (x 3, or NULL: faces of three nodes) on the undeformed body
// `rest` (mm, four numbers a node). The blocks are symmetric to the bit. VSC_SYSTEM when memory is short.
// The content is the caller's, for vsc_robin_free.
vsc_status vsc_robin_fill(const double *rest, size_t face_count, const uint32_t *triangles,
                          const uint32_t *mid, vsc_robin *robin, vsc_error *error);

void vsc_robin_free(vsc_robin *robin);  // the content; a zeroed one is fine

#endif
