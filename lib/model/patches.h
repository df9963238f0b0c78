// SPDX-License-Identifier: GPL-3.0-or-later
// Cutting the mesh into patches. Internal to the model room.
#ifndef VSC_MODEL_PATCHES_H
#define VSC_MODEL_PATCHES_H

#include "mesh/axes.h"
#include "mesh/mesh.h"
#include "model/model.h"

// Orders elements by material (material_of[tet]) and along a space-filling curve, cuts them into
// patches, numbers the nodes, and fills the "order" and "elements" fields of the model but for
// amplitude and delay. `axes` may be NULL.
vsc_status vsc_patches_build(const vsc_mesh *mesh, const vsc_axes *axes,
                             const uint32_t *material_of, vsc_model *model, vsc_error *error);

#endif
