// SPDX-License-Identifier: GPL-3.0-or-later
// The block of tools/shapes.h in elements of other kinds.
#ifndef VSC_TOOLS_SHAPES_BLOCK_H
#define VSC_TOOLS_SHAPES_BLOCK_H

#include "tools/shapes.h"

// The mesh of the box, nodes (on the corners of bricks), arrays and errors as those of
// vsc_block_mesh; VSC_INPUT also for a mixed block of fewer than four bricks along x. The centres
// of the pyramids' bricks come behind the other nodes. The caller owns *mesh.
vsc_status vsc_block_of(const vsc_block_shape *shape, vsc_block_kind kind, vsc_mesh **mesh,
                        vsc_error *error);

#endif
