// SPDX-License-Identifier: GPL-3.0-or-later
// Springs and dashpots on surfaces: the matrix of a surface.
#ifndef VSC_MODEL_ROBIN_H
#define VSC_MODEL_ROBIN_H

#include "model/model.h"

// Fills area, rows and blocks of `robin`, whose `normal` is set, for the facets of its surface on the
// undeformed body `rest` (mm, four numbers a node). The blocks are symmetric to the bit. VSC_SYSTEM when
// memory is short. The content is the caller's, for vsc_robin_free.
vsc_status vsc_robin_fill(const double *rest, const vsc_facets *facets, vsc_robin *robin, vsc_error *error);

void vsc_robin_free(vsc_robin *robin);  // the content; a zeroed one is fine

#endif
